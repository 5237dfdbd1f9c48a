/*
  What damage beside the records does to a small database: each bit there is flipped in turn, and two processes of their
  own open the file: one takes all that lamella answers from, one is `info --check`. Prints how many are read as before,
  refused, read otherwise without a word, and how many end or hold up the process. The file is removed at the end.
    bench_damage [--stride BITS] [--zero BYTES] [--list 1]
  --zero sets so many bytes to zero instead of flipping a bit; --list 1 names the place of each damage that is neither
  refused nor without effect.
*/
#include <fcntl.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include "support/error_message.h"
#include "synthetic_nodes.h"

#define RECORDS 150 /* three chunks */
#define SECONDS 10  /* an open takes some milliseconds */

static char directory[64], path[96];

/* ---- the file ---- */

static PetscErrorCode WriteNodes(LamGrid grid, LamRecordWriter writer)
{
  LamResponse responses[RECORDS];
  PetscInt64 keys[RECORDS];
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (int i = 0; n < RECORDS; i++)
    for (int j = 0; j <= i && n < RECORDS; j++) {
      const LamNodePlace place = {.i = {j, j, i}};

      keys[n] = LamNodeKeyOf(&place);
      PetscCall(Synthetic(grid, keys[n], n, &responses[n]));
      n++;
    }
  PetscCall(LamRecordWriterCommit(writer, n, keys, responses));
  PetscFunctionReturn(0);
}

static PetscErrorCode Write(void)
{
  LamRecordWriter writer;
  LamScene *scene;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamSceneReadText("bench_damage", scene_text, &scene));
  PetscCall(LamGridCreate(scene, NULL, &grid));
  PetscCall(OpenNodes(path, scene, grid, &writer));
  PetscCall(WriteNodes(grid, writer));
  PetscCall(LamRecordWriterClose(&writer));
  PetscCall(LamGridDestroy(&grid));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

/* Marks the bytes that are records: each has a checksum. */
static void MarkRecords(unsigned char *marked)
{
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), dataset = H5Dopen2(file, "/records", H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  hsize_t chunks, offset, bytes;
  unsigned filters;
  haddr_t address;

  H5Dget_num_chunks(dataset, space, &chunks);
  for (hsize_t i = 0; i < chunks; i++) {
    H5Dget_chunk_info(dataset, space, i, &offset, &filters, &address, &bytes);
    memset(marked + address, 1, bytes);
  }
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
}

/* ---- reading it ---- */

static uint64_t Hash(uint64_t hash, const void *bytes, size_t n)
{
  for (size_t i = 0; i < n; i++) hash = (hash ^ ((const unsigned char *)bytes)[i]) * 1099511628211u;
  return hash;
}

/* FNV-1a of all that lamella answers from. */
static PetscErrorCode Digest(uint64_t *digest)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamDatabase database;
  const char *json;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseOpen(path, &database));
  PetscCall(LamDatabaseGetRecords(database, &n, &records, &keys));
  PetscCall(LamDatabaseGetInfo(database, &json));
  *digest = Hash(Hash(14695981039346656037u, json, strlen(json)), keys, (size_t)n * sizeof(*keys));
  for (PetscInt i = 0; i < n; i++)
    for (const LamMember *m = LamResponseMembers; m->name; m++) {
      const size_t size = m->type == LAM_MEMBER_REAL ? sizeof(PetscReal) : m->type == LAM_MEMBER_TEXT ? 1 : sizeof(int);

      *digest = Hash(*digest, (const char *)&records[i] + m->offset, size * (size_t)m->count);
    }
  PetscCall(LamDatabaseClose(&database));
  PetscFunctionReturn(0);
}

static PetscErrorCode Inspect(PetscBool *sound)
{
  char *json;

  PetscFunctionBeginUser;
  PetscCall(LamFileCheck(path, NULL, sound, &json));
  PetscCall(PetscFree(json));
  PetscFunctionReturn(0);
}

typedef enum { SAME, REFUSED, UNNAMED, DIFFERENT, CRASH, HANG, OUTCOMES } Outcome;
static const char *const outcomes[OUTCOMES] = {"read as before", "refused, file named", "refused, not named",
                                               "read otherwise", "process ended",       "process held up"};

static Outcome Open(uint64_t wanted)
{
  uint64_t found;

  if (Digest(&found)) return strstr(ErrorMessage, path) ? REFUSED : UNNAMED;
  return found == wanted ? SAME : DIFFERENT;
}

static Outcome Check(uint64_t unused)
{
  PetscBool sound;

  if (Inspect(&sound)) return strstr(ErrorMessage, path) ? REFUSED : UNNAMED;
  return sound ? SAME : REFUSED;
}

static Outcome Try(Outcome (*function)(uint64_t), uint64_t wanted)
{
  const pid_t child = fork();
  int status;

  if (child == 0) {
    const struct rlimit memory = {(rlim_t)4 << 30, (rlim_t)4 << 30}, none = {0, 0};

    setrlimit(RLIMIT_AS, &memory);
    setrlimit(RLIMIT_CORE, &none);
    alarm(SECONDS);
    _exit(function(wanted));
  }
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) return WEXITSTATUS(status) < CRASH ? (Outcome)WEXITSTATUS(status) : CRASH;
  return WTERMSIG(status) == SIGALRM ? HANG : CRASH;
}

/* ---- damage ---- */

typedef struct {
  int fd;
  off_t size;
  unsigned char *bytes, *marked; /* [size] of the sound file; of its records */
  PetscInt stride, zeros;
  PetscBool list;
  PetscInt beside, tried, open[OUTCOMES], check[OUTCOMES];
} Run;

static void WriteBytes(const Run *run, off_t from, off_t n, const unsigned char *bytes)
{
  if (pwrite(run->fd, bytes, (size_t)n, from) != n) exit(1);
}

/* The bytes from `byte` on that are no records. */
static off_t Width(const Run *run, off_t byte)
{
  off_t n = 1;

  while (n < run->zeros && byte + n < run->size && !run->marked[byte + n]) n++;
  return n;
}

static void Damage(Run *run, off_t byte, int bit, uint64_t wanted)
{
  const off_t n = Width(run, byte);
  unsigned char *damaged = calloc((size_t)n, 1);
  Outcome open, check;

  if (!run->zeros) *damaged = (unsigned char)(run->bytes[byte] ^ 1 << bit);
  WriteBytes(run, byte, n, damaged);
  open = Try(Open, wanted);
  check = Try(Check, 0);
  if (check == SAME && open != SAME) check = DIFFERENT;
  WriteBytes(run, byte, n, run->bytes + byte);
  free(damaged);
  run->tried++;
  run->open[open]++;
  run->check[check]++;
  if (run->list && (open > REFUSED || check > REFUSED))
    printf("  byte %lld bit %d: %s; --check: %s\n", (long long)byte, bit, outcomes[open], outcomes[check]);
}

static void DamageAll(Run *run, uint64_t wanted)
{
  for (off_t bit = 0; bit < 8 * run->size; bit++) {
    if (run->marked[bit / 8]) continue;
    if (run->beside++ % run->stride == 0) Damage(run, bit / 8, (int)(bit % 8), wanted);
  }
  printf("%" PetscInt_FMT " bytes beside %d records; %" PetscInt_FMT " cases\n", run->beside / 8, RECORDS, run->tried);
  printf("  %-20s %8s %8s\n", "", "open", "--check");
  for (int i = 0; i < OUTCOMES; i++)
    printf("  %-20s %8" PetscInt_FMT " %8" PetscInt_FMT "\n", outcomes[i], run->open[i], run->check[i]);
}

static PetscErrorCode Prepare(Run *run, uint64_t *wanted)
{
  struct stat info;

  PetscFunctionBeginUser;
  snprintf(directory, sizeof(directory), "/tmp/lamella-bench-XXXXXX");
  PetscCheck(mkdtemp(directory), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: cannot be made", directory);
  snprintf(path, sizeof(path), "%s/nodes.h5", directory);
  PetscCall(Write());
  PetscCall(Digest(wanted));
  run->fd = open(path, O_RDWR);
  PetscCheck(run->fd >= 0 && !fstat(run->fd, &info), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", path);
  run->size = info.st_size;
  PetscCall(PetscCalloc2(run->size, &run->marked, run->size, &run->bytes));
  PetscCheck(pread(run->fd, run->bytes, (size_t)run->size, 0) == run->size, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s",
             path);
  MarkRecords(run->marked);
  PetscFunctionReturn(0);
}

static void Tidy(Run *run)
{
  close(run->fd);
  unlink(path);
  rmdir(directory);
  (void)PetscFree2(run->marked, run->bytes);
}

int main(int argc, char **argv)
{
  Run run = {.stride = 997};
  uint64_t wanted = 0;
  PetscErrorCode ierr;

  for (int i = 1; i + 1 < argc; i += 2) {
    if (!strcmp(argv[i], "--stride")) run.stride = atoi(argv[i + 1]);
    if (!strcmp(argv[i], "--zero")) run.zeros = atoi(argv[i + 1]);
    if (!strcmp(argv[i], "--list")) run.list = (PetscBool)(atoi(argv[i + 1]) > 0);
  }
  if (argc % 2 == 0 || run.stride < 1 || run.zeros < 0) {
    fprintf(stderr, "usage: bench_damage [--stride BITS] [--zero BYTES] [--list 1]\n");
    return 2;
  }
  KeepErrorMessages();
  ierr = Prepare(&run, &wanted);
  if (!ierr) DamageAll(&run, wanted);
  Tidy(&run);
  return ierr ? 1 : 0;
}
