/*
  Lists shared by all ranks. Collective over `comm`.
*/
#ifndef LAM_GATHER_H
#define LAM_GATHER_H

#include <petscsys.h>

/* As for qsort. */
typedef int (*LamCompare)(const void *, const void *);

/* Sorts items of `size` bytes and removes duplicates; *n becomes their number. Not collective. */
void LamSortUnique(PetscInt *n, void *items, size_t size, LamCompare compare);
int LamCompareKeys(const void *a, const void *b); /* compares PetscInt64 */
/* Index of a key in the sorted keys[n]; -1: not found. */
PetscInt LamFindKey(PetscInt n, const PetscInt64 keys[], PetscInt64 key);
/* Gathers items of `size` bytes from all ranks on all ranks; starts[ranks + 1] counts items. The caller frees both. */
PetscErrorCode LamGather(MPI_Comm comm, size_t size, PetscInt n, const void *items, PetscMPIInt **starts, void **all);
/* The sorted union of the items of all ranks. The caller frees *all. */
PetscErrorCode LamGatherUnion(MPI_Comm comm, size_t size, LamCompare compare, PetscInt n, const void *items,
                              PetscInt *total, void **all);

#endif
