/*
  Time and memory of merging databases: shards of different nodes, and, of each shard, some that the one before it has
  too; the same shards once more by salvage; and, for comparison, the bytes of the result copied and synced. The numbers
  in the records are synthetic. The files are removed at the end. Prints figures, asserts nothing.
    bench_merge [--shards N] [--n RECORDS PER SHARD] [--folder FOR THE FILES]
*/
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <petsctime.h>
#include "synthetic_nodes.h"

static char folder[128], out[192];

static void ShardPath(PetscInt shard, char path[192])
{
  snprintf(path, 192, "%s/%" PetscInt_FMT ".h5", folder, shard);
}

static double FileMB(const char path[])
{
  struct stat info;

  return stat(path, &info) ? 0 : (double)info.st_size / 1e6;
}

/* ---- shards ---- */

/* Node number `number` of the finest level. */
static PetscInt64 KeyOf(PetscInt64 number)
{
  const LamNodePlace place = {.i = {(int)(number % 256), (int)(256 + number / 256 % 256), (int)(512 + number / 65536)}};

  return LamNodeKeyOf(&place);
}

/* Records first .. first + n - 1. */
static PetscErrorCode WriteShard(const LamScene *scene, LamGrid grid, PetscInt shard, PetscInt64 first, PetscInt n)
{
  LamRecordWriter writer;
  LamResponse *responses;
  PetscInt64 *keys;
  char path[192];

  PetscFunctionBeginUser;
  ShardPath(shard, path);
  PetscCall(PetscMalloc2(n, &responses, n, &keys));
  for (PetscInt i = 0; i < n; i++) {
    keys[i] = KeyOf(first + i);
    PetscCall(Synthetic(grid, keys[i], first + i, &responses[i]));
  }
  PetscCall(OpenNodes(path, scene, grid, &writer));
  PetscCall(LamRecordWriterCommit(writer, n, keys, responses));
  PetscCall(LamRecordWriterClose(&writer));
  PetscCall(PetscFree2(responses, keys));
  PetscFunctionReturn(0);
}

/* A hundredth of each shard is in the one before it, too. */
static PetscErrorCode WriteShards(PetscInt shards, PetscInt n)
{
  LamScene *scene;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamSceneReadText("bench_merge", scene_text, &scene));
  PetscCall(LamGridCreate(scene, NULL, &grid));
  for (PetscInt s = 0; s < shards; s++) PetscCall(WriteShard(scene, grid, s, (PetscInt64)s * (n - n / 100), n));
  PetscCall(LamGridDestroy(&grid));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

/* ---- what is timed ---- */

static PetscErrorCode MergeAll(PetscInt shards, PetscBool salvage)
{
  const LamMergeOptions options = {.salvage = salvage};
  const char **files;
  char(*paths)[192];
  LamMergeReport report;
  PetscLogDouble start, end;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(shards, &files, shards, &paths));
  for (PetscInt s = 0; s < shards; s++) {
    ShardPath(s, paths[s]);
    files[s] = paths[s];
  }
  PetscCall(PetscTime(&start));
  PetscCall(LamDatabaseMerge(out, shards, files, &options, &report));
  PetscCall(PetscTime(&end));
  printf("  %-8s %6.2f s, processor %.2f s, at most %.0f MB   %" PetscInt_FMT " records, %lld duplicates, %.0f MB/s\n",
         salvage ? "salvage" : "merge", end - start, ProcessorSeconds(), Memory("VmHWM"), report.records,
         (long long)report.duplicates, FileMB(out) / (end - start));
  PetscCall(PetscFree2(files, paths));
  PetscFunctionReturn(0);
}

/* In a process of its own, for its memory. */
static void MergeApart(PetscInt shards, PetscBool salvage)
{
  pid_t child;

  unlink(out);
  fflush(stdout);
  child = fork();
  if (child == 0) {
    const PetscErrorCode ierr = MergeAll(shards, salvage);

    fflush(stdout);
    _exit(ierr ? 1 : 0);
  }
  waitpid(child, NULL, 0);
}

/* The least that a merge can take: its bytes read and written, and on the disk. */
static PetscErrorCode CopyAndSync(void)
{
  char command[1024], copy[200];
  PetscLogDouble start, end;

  PetscFunctionBeginUser;
  snprintf(copy, sizeof(copy), "%s/copy", folder);
  snprintf(command, sizeof(command), "cp '%s' '%s' && sync '%s'", out, copy, copy);
  PetscCall(PetscTime(&start));
  PetscCheck(!system(command), PETSC_COMM_SELF, PETSC_ERR_SYS, "%s", command);
  PetscCall(PetscTime(&end));
  printf("  %-8s %6.2f s, %.0f MB/s\n", "cp, sync", end - start, FileMB(out) / (end - start));
  unlink(copy);
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PetscInt shards, PetscInt n)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCheck(mkdtemp(folder), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: cannot be made", folder);
  snprintf(out, sizeof(out), "%s/out.h5", folder);
  printf("%" PetscInt_FMT " shards of %" PetscInt_FMT " records\n", shards, n);
  ierr = WriteShards(shards, n);
  sync();
  if (!ierr) {
    MergeApart(shards, PETSC_FALSE);
    ierr = CopyAndSync();
    MergeApart(shards, PETSC_TRUE);
  }
  for (PetscInt s = 0; s < shards; s++) {
    char path[192];

    ShardPath(s, path);
    unlink(path);
  }
  unlink(out);
  rmdir(folder);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt shards = 10, n = 1000;
  const char *parent = "/tmp";

  for (int i = 1; i + 1 < argc; i += 2) {
    if (!strcmp(argv[i], "--shards")) shards = atoi(argv[i + 1]);
    if (!strcmp(argv[i], "--n")) n = atoi(argv[i + 1]);
    if (!strcmp(argv[i], "--folder")) parent = argv[i + 1];
  }
  if (argc % 2 == 0 || shards < 1 || n < 1 || (double)shards * n > 256.0 * 65536) {
    fprintf(stderr, "usage: bench_merge [--shards N] [--n RECORDS PER SHARD] [--folder FOR THE FILES]\n");
    return 2;
  }
  snprintf(folder, sizeof(folder), "%s/lamella-bench-XXXXXX", parent);
  return Run(shards, n) ? 1 : 0; /* record files need neither PetscInitialize nor MPI */
}
