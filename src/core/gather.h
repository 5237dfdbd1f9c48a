/*
  Lists that all ranks share. Collective over `comm`.
*/
#ifndef LAM_GATHER_H
#define LAM_GATHER_H

#include <petscsys.h>

/* As of qsort. */
typedef int (*LamCompare)(const void *, const void *);

/* Sorts items of `size` bytes and leaves out what comes twice; *n becomes their number. Of one rank. */
void LamSortUnique(PetscInt *n, void *items, size_t size, LamCompare compare);
int LamCompareKeys(const void *a, const void *b); /* of PetscInt64 */
/* The place of a key in keys[n], which are sorted; -1: it is not there. */
PetscInt LamFindKey(PetscInt n, const PetscInt64 keys[], PetscInt64 key);
/* Items of `size` bytes from all ranks on all ranks; starts[ranks + 1] counts items. The caller frees both. */
PetscErrorCode LamGather(MPI_Comm comm, size_t size, PetscInt n, const void *items, PetscMPIInt **starts, void **all);
/* The items of all ranks, sorted, each once. The caller frees *all. */
PetscErrorCode LamGatherUnion(MPI_Comm comm, size_t size, LamCompare compare, PetscInt n, const void *items,
                              PetscInt *total, void **all);

#endif
