/*
  Lists shared by all ranks.
*/
#include "gather.h"
#include <stdlib.h>
#include <string.h>

void LamSortUnique(PetscInt *n, void *items, size_t size, LamCompare compare)
{
  char *item = (char *)items;
  PetscInt kept = 0;

  if (!*n) return; /* `items` may be NULL */
  qsort(items, (size_t)*n, size, compare);
  for (PetscInt k = 0; k < *n; k++) {
    if (kept && !compare(item + (kept - 1) * size, item + k * size)) continue;
    memmove(item + kept++ * size, item + k * size, size);
  }
  *n = kept;
}

int LamCompareKeys(const void *a, const void *b)
{
  const PetscInt64 x = *(const PetscInt64 *)a, y = *(const PetscInt64 *)b;

  return (x > y) - (x < y);
}

PetscInt LamFindKey(PetscInt n, const PetscInt64 keys[], PetscInt64 key)
{
  const PetscInt64 *found = n ? bsearch(&key, keys, (size_t)n, sizeof(key), LamCompareKeys) : NULL;

  return found ? (PetscInt)(found - keys) : -1;
}

PetscErrorCode LamGather(MPI_Comm comm, size_t size, PetscInt n, const void *items, PetscMPIInt **starts, void **all)
{
  PetscMPIInt ranks, bytes, count, *counts;
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCall(PetscMPIIntCast((PetscInt)size, &bytes));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCall(PetscMalloc1(ranks, &counts));
  PetscCall(PetscMalloc1(ranks + 1, starts));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  (*starts)[0] = 0;
  for (PetscMPIInt r = 0; r < ranks; r++) (*starts)[r + 1] = (*starts)[r] + counts[r];
  PetscCall(PetscMalloc(size * (*starts)[ranks], all));
  PetscCallMPI(MPI_Type_contiguous(bytes, MPI_BYTE, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCallMPI(MPI_Allgatherv(items, count, type, *all, counts, *starts, type, comm));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(PetscFree(counts));
  PetscFunctionReturn(0);
}

PetscErrorCode LamGatherUnion(MPI_Comm comm, size_t size, LamCompare compare, PetscInt n, const void *items,
                              PetscInt *total, void **all)
{
  PetscMPIInt ranks, *starts;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCall(LamGather(comm, size, n, items, &starts, all));
  *total = starts[ranks];
  LamSortUnique(total, *all, size, compare);
  PetscCall(PetscFree(starts));
  PetscFunctionReturn(0);
}
