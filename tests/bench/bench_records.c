/*
  Time and memory of record files with many nodes of a grid: to write them, to open the file, to give the first answer
  (which makes the table), to load whole responses. The nodes fill the grid level by level; the numbers in them are
  synthetic. The file is removed at the end. Prints figures, asserts nothing.
    bench_records [--n NODES] [--block RECORDS PER COMMIT]
*/
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <petsctime.h>
#include "synthetic_nodes.h"

static char directory[64], path[96];

/* Sorted places in three root cells a side, coarse levels first. The caller frees the keys. */
static PetscErrorCode Places(PetscInt *n, PetscInt64 **keys)
{
  const int side = 3 * LAM_ROOT;
  PetscInt count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(*n, keys));
  for (int level = 0; level <= LAM_FINEST; level++) {
    const int size = LAM_ROOT >> level;

    for (int i = 0; i <= side; i += size)
      for (int j = i; j <= side; j += size)
        for (int k = j; k <= side && count < *n; k += size) {
          const LamNodePlace place = {.i = {i, j, k}};

          if (LamNodeLevel(&place) == level) (*keys)[count++] = LamNodeKeyOf(&place);
        }
  }
  *n = count;
  PetscFunctionReturn(0);
}

static PetscErrorCode Write(const LamScene *scene, PetscInt n, const PetscInt64 keys[], PetscInt block)
{
  double processor = 0;
  PetscLogDouble start, end, seconds = 0;
  LamRecordWriter writer;
  LamResponse *responses;
  struct stat info;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(scene, NULL, &grid));
  PetscCall(PetscMalloc1(block, &responses));
  PetscCall(OpenNodes(path, scene, grid, &writer));
  for (PetscInt first = 0; first < n; first += block) {
    const PetscInt count = PetscMin(block, n - first);

    for (PetscInt i = 0; i < count; i++) PetscCall(Synthetic(grid, keys[first + i], first + i, &responses[i]));
    processor -= ProcessorSeconds();
    PetscCall(PetscTime(&start));
    PetscCall(LamRecordWriterCommit(writer, count, keys + first, responses));
    PetscCall(PetscTime(&end));
    processor += ProcessorSeconds();
    seconds += end - start;
  }
  PetscCall(LamRecordWriterClose(&writer));
  PetscCall(PetscFree(responses));
  PetscCall(LamGridDestroy(&grid));
  if (stat(path, &info)) info.st_size = 0;
  printf("  write           %6.2f s, processor %.2f s   %.0f MB, %" PetscInt_FMT " a commit\n", seconds, processor,
         (double)info.st_size / 1e6, block);
  PetscFunctionReturn(0);
}

/* Prints what has happened since `start` and `processor`; `before`: memory of the empty process. */
static void Print(const char what[], PetscLogDouble start, double processor, double before)
{
  PetscLogDouble now;

  (void)PetscTime(&now);
  printf("  %-15s %6.2f s, processor %.2f s   %.0f MB, at most %.0f MB\n", what, now - start,
         ProcessorSeconds() - processor, Memory("VmRSS") - before, Memory("VmHWM") - before);
}

static PetscErrorCode Read(void)
{
  const LamLoad load = {.F = {1.05, 0.02, 0, 0.01, 1.08, 0, 0, 0, 1}, .turgor = 0.15};
  const double before = Memory("VmRSS"), processor = ProcessorSeconds();
  const LamResponse *records;
  PetscLogDouble start;
  LamDatabase database;
  LamResponse answer;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(LamDatabaseOpen(path, &database));
  Print("open", start, processor, before);
  PetscCall(LamDatabaseQuery(database, &load, PETSC_INFINITY, &answer));
  Print("first answer", start, processor, before);
  PetscCall(LamDatabaseGetRecords(database, NULL, &records, NULL));
  Print("whole responses", start, processor, before);
  PetscCall(LamDatabaseClose(&database));
  PetscFunctionReturn(0);
}

/* In a process of its own, so that no memory of another one is left to be used again. */
static void ReadApart(void)
{
  const pid_t child = fork();

  if (child == 0) {
    const PetscErrorCode ierr = Read();

    fflush(stdout);
    _exit(ierr ? 1 : 0);
  }
  waitpid(child, NULL, 0);
}

static PetscErrorCode Run(PetscInt n, PetscInt block)
{
  PetscInt64 *keys;
  LamScene *scene;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamSceneReadText("bench_records", scene_text, &scene));
  snprintf(directory, sizeof(directory), "/tmp/lamella-bench-XXXXXX");
  PetscCheck(mkdtemp(directory), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: cannot be made", directory);
  snprintf(path, sizeof(path), "%s/nodes.h5", directory);
  PetscCall(Places(&n, &keys));
  printf("%" PetscInt_FMT " nodes; seconds and memory since the beginning\n", n);
  ierr = Write(scene, n, keys, block);
  fflush(stdout);
  for (int k = 0; k < 3 && !ierr; k++) ReadApart();
  unlink(path);
  rmdir(directory);
  PetscCall(PetscFree(keys));
  PetscCall(LamSceneDestroy(&scene));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt n = 20000, block = 2048;

  for (int i = 1; i + 1 < argc; i += 2) {
    if (!strcmp(argv[i], "--n")) n = atoi(argv[i + 1]);
    if (!strcmp(argv[i], "--block")) block = atoi(argv[i + 1]);
  }
  if (argc % 2 == 0 || n < 1 || block < 1) {
    fprintf(stderr, "usage: bench_records [--n NODES] [--block RECORDS PER COMMIT]\n");
    return 2;
  }
  return Run(n, block) ? 1 : 0; /* record files need neither PetscInitialize nor MPI */
}
