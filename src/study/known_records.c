/*
  Responses that the file of a database already contains, used instead of a solve.
*/
#include "known_records.h"
#include <stdlib.h>

static int CompareKeys(const void *first, const void *second)
{
  const LamKnownKey *a = first, *b = second;

  return (a->key > b->key) - (a->key < b->key);
}

PetscErrorCode LamKnownRecordsSet(LamKnownRecords *known, PetscInt first, PetscInt n, PetscInt64 keys[],
                                  LamResponse records[])
{
  PetscFunctionBeginUser;
  known->first = first;
  known->n = n;
  known->keys = keys;
  known->records = records;
  PetscCall(PetscMalloc1(n, &known->sorted));
  for (PetscInt k = 0; k < n; k++) known->sorted[k] = (LamKnownKey){keys[k], k};
  if (n) qsort(known->sorted, (size_t)n, sizeof(*known->sorted), CompareKeys);
  PetscFunctionReturn(0);
}

PetscErrorCode LamKnownRecordsDestroy(LamKnownRecords *known)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(known->keys));
  PetscCall(PetscFree(known->records));
  PetscCall(PetscFree(known->sorted));
  PetscFunctionReturn(0);
}

static PetscBool SameLoad(const LamLoad *a, const LamLoad *b)
{
  for (int k = 0; k < 9; k++) {
    if (a->F[k] != b->F[k]) return PETSC_FALSE;
  }
  return (PetscBool)(a->turgor == b->turgor && a->cohesion == b->cohesion);
}

PetscInt LamKnownRecordsFind(const LamKnownRecords *known, PetscInt64 key, const LamLoad *load)
{
  const LamKnownKey wanted = {.key = key};
  const LamKnownKey *found;

  if (!known->n) return -1;
  if (LamKeyIsNode(key)) {
    found = bsearch(&wanted, known->sorted, (size_t)known->n, sizeof(*found), CompareKeys);
    return found ? known->first + found->at : -1;
  }
  for (PetscInt k = 0; k < known->n; k++) {
    if (!LamKeyIsNode(known->keys[k]) && SameLoad(&known->records[k].load, load)) return known->first + k;
  }
  return -1;
}

const LamResponse *LamKnownRecordsGet(const LamKnownRecords *known, PetscInt64 key, const LamLoad *load)
{
  const PetscInt row = LamKnownRecordsFind(known, key, load);

  return row >= 0 ? &known->records[row - known->first] : NULL;
}

PetscErrorCode LamKnownRecordsSolve(void *ctx, PetscInt64 key, LamResponse *response)
{
  const LamKnownRecords *known = ctx;
  const LamResponse *record = LamKnownRecordsGet(known, key, NULL);

  PetscFunctionBeginUser;
  if (record)
    *response = *record;
  else
    PetscCall(known->solver->solve(known->solver->ctx, key, response));
  PetscFunctionReturn(0);
}

PetscErrorCode LamKnownRecordsSolveNear(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response)
{
  const LamKnownRecords *known = ctx;
  const LamResponse *record = LamKnownRecordsGet(known, LAM_CACHE_KEY, load);

  PetscFunctionBeginUser;
  if (record)
    *response = *record;
  else
    PetscCall(known->solver->solve_near(known->solver->ctx, key, load, response));
  PetscFunctionReturn(0);
}
