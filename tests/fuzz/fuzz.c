/* Errors, memory and files of a target. */
#define _GNU_SOURCE /* nftw */
#include "fuzz.h"
#include <fcntl.h>
#include <ftw.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void FuzzFail(const char file[], int line, const char format[], ...)
{
  va_list arguments;

  dprintf(STDERR_FILENO, "%s:%d: ", file, line);
  va_start(arguments, format);
  vdprintf(STDERR_FILENO, format, arguments);
  va_end(arguments);
  dprintf(STDERR_FILENO, "\n");
  abort();
}

/* ---- errors ---- */

static char message[2048];

static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *text, void *ctx)
{
  if (type == PETSC_ERROR_INITIAL) snprintf(message, sizeof(message), "%s", text ? text : "");
  return code;
}

const char *FuzzMessage(void)
{
  return message;
}

/* ---- memory: all blocks in a ring ---- */

typedef struct Block {
  struct Block *before, *after;
  size_t size;
  size_t unused; /* what follows is aligned as malloc's */
} Block;

/* HDF5 asks for as much memory as a changed file says, and takes a no. */
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
  return "allocator_may_return_null=1";
}

/* Where leaks are looked for. These libraries keep memory; the resident set shows that it does not grow. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
  return "leak:libhdf5\nleak:libmpi\nleak:libopen-pal\nleak:libopen-rte\nleak:libpetsc\n";
}

__attribute__((visibility("default"))) const char *__lsan_default_options(void);
const char *__lsan_default_options(void)
{
  return "print_suppressions=0";
}

static Block ring = {&ring, &ring, 0, 0};

static void Link(Block *block)
{
  block->before = &ring;
  block->after = ring.after;
  ring.after->before = block;
  ring.after = block;
}

static void Unlink(Block *block)
{
  block->before->after = block->after;
  block->after->before = block->before;
}

static PetscErrorCode Allocate(size_t size, PetscBool clear, int line, const char function[], const char file[],
                               void **memory)
{
  Block *block;

  *memory = NULL;
  if (!size) return 0;
  block = clear ? calloc(1, sizeof(*block) + size) : malloc(sizeof(*block) + size);
  if (!block) return PetscError(PETSC_COMM_SELF, line, function, file, PETSC_ERR_MEM, PETSC_ERROR_INITIAL, "no memory");
  block->size = size;
  Link(block);
  *memory = block + 1;
  return 0;
}

static PetscErrorCode Release(void *memory, int line, const char function[], const char file[])
{
  if (!memory) return 0;
  Unlink((Block *)memory - 1);
  free((Block *)memory - 1);
  return 0;
}

static PetscErrorCode Reallocate(size_t size, int line, const char function[], const char file[], void **memory)
{
  void *larger;
  PetscErrorCode ierr = Allocate(size, PETSC_FALSE, line, function, file, &larger);

  if (ierr) return ierr;
  if (*memory && size) memcpy(larger, *memory, PetscMin(size, ((Block *)*memory - 1)->size));
  Release(*memory, line, function, file);
  *memory = larger;
  return 0;
}

size_t FuzzMemoryLeft(void)
{
  size_t bytes = 0;

  for (const Block *block = ring.after; block != &ring; block = block->after) bytes += block->size;
  return bytes;
}

#ifdef LAMELLA_FUZZ
int __lsan_do_recoverable_leak_check(void);

void FuzzLookForLeaks(void)
{
  FuzzCheck(!__lsan_do_recoverable_leak_check(), "an input, this one or one before, has left memory");
}
#else
void FuzzLookForLeaks(void) {}
#endif

void FuzzCountMemory(void)
{
  FuzzCheck(!PetscMallocSet(Allocate, Release, Reallocate), "PETSc takes no other memory");
}

void FuzzMemoryKeep(void)
{
  while (ring.after != &ring) {
    Block *block = ring.after;

    Unlink(block);
    block->before = block->after = block; /* so that it can be unlinked again */
  }
}

void FuzzMemoryFree(void)
{
  while (ring.after != &ring) Release(ring.after + 1, __LINE__, __func__, __FILE__);
}

/* libFuzzer reads its options behind this. */
static void KeepInputsHere(int *argc, char ***argv)
{
  static const char option[] = "-artifact_prefix=";
  static char *more[64], prefix[PETSC_MAX_PATH_LEN];
  char here[PETSC_MAX_PATH_LEN / 2] = "", *given = NULL;

  FuzzCheck(*argc + 1 < (int)PETSC_STATIC_ARRAY_LENGTH(more), "too many arguments");
  for (int i = 0; i < *argc; i++) {
    more[i] = (*argv)[i];
    if (!strncmp(more[i], option, strlen(option))) given = more[i] + strlen(option);
  }
  if (given && given[0] == '/') return;
  FuzzCheck(getcwd(here, sizeof(here)), "the working folder has no name");
  snprintf(prefix, sizeof(prefix), "%s%s/%.1000s", option, here, given ? given : "");
  more[(*argc)++] = prefix;
  *argv = more;
}

void FuzzStart(int *argc, char ***argv)
{
  KeepInputsHere(argc, argv);
  PetscErrorHandlingInitialized = PETSC_TRUE; /* else PETSc calls no handler before PetscInitialize */
  FuzzCheck(!PetscPushErrorHandler(KeepMessage, NULL), "PETSc takes no error handler");
}

/* ---- files ---- */

void FuzzSilence(void)
{
  stdout = stderr = fopen("/dev/null", "w");
  FuzzCheck(stdout, "/dev/null cannot be opened");
}

static char folder[64];
static int outside = -1;

static int RemoveOne(const char path[], const struct stat *status, int kind, struct FTW *place)
{
  return remove(path);
}

static void RemoveFolder(void)
{
  nftw(folder, RemoveOne, 8, FTW_DEPTH | FTW_PHYS);
}

static void MakeFolder(void)
{
  snprintf(folder, sizeof(folder), "/dev/shm/lamella-fuzz-XXXXXX");
  if (!mkdtemp(folder)) {
    snprintf(folder, sizeof(folder), "/tmp/lamella-fuzz-XXXXXX");
    FuzzCheck(mkdtemp(folder), "%s cannot be made", folder);
  }
  outside = open(".", O_RDONLY | O_CLOEXEC);
  FuzzCheck(outside >= 0, "the working folder cannot be opened");
  atexit(RemoveFolder);
}

void FuzzEnterFolder(void)
{
  if (!folder[0]) MakeFolder();
  FuzzCheck(!chdir(folder), "%s cannot be entered", folder);
}

void FuzzLeaveFolder(void)
{
  FuzzCheck(!fchdir(outside), "the working folder is gone");
}

void FuzzWriteFile(const char name[], const void *bytes, size_t size)
{
  FILE *file = fopen(name, "wb");

  FuzzCheck(file && fwrite(bytes, 1, size, file) == size && !fclose(file), "%s cannot be written", name);
}
