/*
  Memory limit for each call of HDF5, and the reason if it fails.

  Method
    A damaged file can make HDF5 allocate and fill any amount of memory: one wrong bit in the record type costs 8 GB
    and half a minute. The address space of the process is therefore limited during each call; malloc then fails, HDF5
    returns an error, and the file is reported as damaged.
*/
#include "h5check.h"
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define MOST_MEMORY ((rlim_t)256 << 20) /* bytes per call */

/* ---- memory ---- */

/* Address space in use, in bytes; 0: unknown. */
static rlim_t Addressed(void)
{
  FILE *file = fopen("/proc/self/statm", "r");
  unsigned long long pages = 0;

  if (!file) return 0;
  if (fscanf(file, "%llu", &pages) != 1) pages = 0;
  fclose(file);
  return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

LamMemoryBound LamMemoryBoundBegin(void)
{
  LamMemoryBound bound = {.is_set = PETSC_FALSE};
#ifndef __SANITIZE_ADDRESS__ /* AddressSanitizer reserves most of the address space, and aborts if malloc fails */
  const rlim_t addressed = Addressed();
  struct rlimit lower;

  if (!addressed || getrlimit(RLIMIT_AS, &bound.before)) return bound;
  lower = bound.before;
  lower.rlim_cur = PetscMin(lower.rlim_cur, addressed + MOST_MEMORY);
  bound.is_set = (PetscBool)!setrlimit(RLIMIT_AS, &lower);
#endif
  return bound;
}

void LamMemoryBoundEnd(const LamMemoryBound *bound)
{
  if (bound->is_set) setrlimit(RLIMIT_AS, &bound->before);
}

/* ---- reasons ---- */

static herr_t KeepInnermost(unsigned n, const H5E_error2_t *error, void *ctx)
{
  if (n == 0) snprintf(ctx, LAM_HDF5_REASON_LENGTH, "%s", error->desc ? error->desc : "");
  return 0;
}

void LamHDF5Reason(char reason[LAM_HDF5_REASON_LENGTH])
{
  static const char mark[] = "error message = '";
  char *words, *end;

  snprintf(reason, LAM_HDF5_REASON_LENGTH, "HDF5 gives no reason");
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, KeepInnermost, reason);
  words = strstr(reason, mark);
  if (!words) return;
  words += sizeof(mark) - 1;
  end = strchr(words, '\'');
  if (end) *end = '\0';
  memmove(reason, words, strlen(words) + 1);
}

/* ---- closing ---- */

static herr_t Close(hid_t object)
{
  switch (H5Iget_type(object)) {
  case H5I_FILE:
    return H5Fclose(object);
  case H5I_DATASET:
    return H5Dclose(object);
  case H5I_DATASPACE:
    return H5Sclose(object);
  case H5I_DATATYPE:
    return H5Tclose(object);
  case H5I_ATTR:
    return H5Aclose(object);
  default:
    return H5Pclose(object);
  }
}

static herr_t CloseAll(size_t n, const hid_t objects[])
{
  herr_t worst = 0;

  for (size_t i = 0; i < n; i++)
    if (objects[i] >= 0 && Close(objects[i]) < 0) worst = -1;
  return worst;
}

PetscErrorCode LamCloseListHDF5(const char path[], size_t n, const hid_t objects[])
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, CloseAll(n, objects));
  PetscFunctionReturn(0);
}
