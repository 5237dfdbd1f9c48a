/*
  Records of a database's file that a run which goes on finds there: what it, or another run, has solved since the state
  it goes on from. They are not known until they are asked for, as if they were solved then.
*/
#ifndef LAM_KNOWN_RECORDS_H
#define LAM_KNOWN_RECORDS_H

#include <lamella/cache.h>

typedef struct {
  PetscInt64 key;
  PetscInt at; /* in the records */
} LamKnownKey;

typedef struct {
  PetscInt first, n;           /* rows first .. first + n - 1 of the file */
  PetscInt64 *keys;            /* [n] owned */
  LamResponse *records;        /* [n] owned */
  LamKnownKey *sorted;         /* [n] by key; owned */
  const LamNodeSolver *solver; /* of what is not there; borrowed */
} LamKnownRecords;

/* Takes over keys and records. */
PetscErrorCode LamKnownRecordsSet(LamKnownRecords *known, PetscInt first, PetscInt n, PetscInt64 keys[],
                                  LamResponse records[]);
PetscErrorCode LamKnownRecordsDestroy(LamKnownRecords *known);
/* The row of the file with this node, or with this state of no grid; -1: none. */
PetscInt LamKnownRecordsFind(const LamKnownRecords *known, PetscInt64 key, const LamLoad *load);
/* A LamNodeSolver's functions, ctx a LamKnownRecords: the record that is there, else the solver's answer. */
PetscErrorCode LamKnownRecordsSolve(void *ctx, PetscInt64 key, LamResponse *response);
PetscErrorCode LamKnownRecordsSolveNear(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response);

#endif
