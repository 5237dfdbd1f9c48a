/* Runs a target on files: `fuzz_NAME FOLDER`, without libFuzzer. Options that libFuzzer would take are passed over. */
#include "fuzz.h"
#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

static void RunFile(const char path[])
{
  FILE *file = fopen(path, "rb");
  unsigned char *bytes = NULL;
  long size;

  FuzzCheck(file && !fseek(file, 0, SEEK_END) && (size = ftell(file)) >= 0, "%s cannot be read", path);
  rewind(file);
  bytes = malloc((size_t)size + !size); /* no byte more: a read behind the end shows */
  FuzzCheck(bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size, "%s cannot be read", path);
  fclose(file);
  (void)LLVMFuzzerTestOneInput(bytes, (size_t)size);
  free(bytes);
}

static int RunFolder(const char path[])
{
  struct dirent **entries;
  const int n = scandir(path, &entries, NULL, alphasort);
  int runs = 0;

  FuzzCheck(n >= 0, "%s is no folder", path);
  for (int i = 0; i < n; i++) {
    char name[PATH_MAX];

    if (entries[i]->d_name[0] != '.') {
      snprintf(name, sizeof(name), "%s/%s", path, entries[i]->d_name);
      RunFile(name);
      runs++;
    }
    free(entries[i]);
  }
  free(entries);
  return runs;
}

int main(int argc, char *argv[])
{
  int runs = 0;

  LLVMFuzzerInitialize(&argc, &argv);
  for (int i = 1; i < argc; i++)
    if (argv[i][0] != '-') runs += RunFolder(argv[i]);
  FuzzCheck(runs, "no input has been run");
  return 0;
}
