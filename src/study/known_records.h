/*
  Records that a resumed run finds in the file of its database: solved by this run or another one after the state from
  which it resumes. A record is used when it is requested, as if it were solved then.
*/
#ifndef LAM_KNOWN_RECORDS_H
#define LAM_KNOWN_RECORDS_H

#include <lamella/cache.h>

typedef struct {
  PetscInt64 key;
  PetscInt at; /* index in records */
} LamKnownKey;

typedef struct {
  PetscInt first, n;           /* rows first .. first + n - 1 of the file */
  PetscInt64 *keys;            /* [n] owned */
  LamResponse *records;        /* [n] owned */
  LamKnownKey *sorted;         /* [n] sorted by key; owned */
  const LamNodeSolver *solver; /* for nodes that are not in the file; borrowed */
} LamKnownRecords;

/* Takes ownership of keys and records. */
PetscErrorCode LamKnownRecordsSet(LamKnownRecords *known, PetscInt first, PetscInt n, PetscInt64 keys[],
                                  LamResponse records[]);
PetscErrorCode LamKnownRecordsDestroy(LamKnownRecords *known);
/* Row of the file with this node, or with this off-grid state; -1: none. */
PetscInt LamKnownRecordsFind(const LamKnownRecords *known, PetscInt64 key, const LamLoad *load);
/* That record; NULL: none. */
const LamResponse *LamKnownRecordsGet(const LamKnownRecords *known, PetscInt64 key, const LamLoad *load);
/* Functions of a LamNodeSolver, ctx a LamKnownRecords: return the record if there is one, else call the solver. */
PetscErrorCode LamKnownRecordsSolve(void *ctx, PetscInt64 key, LamResponse *response);
PetscErrorCode LamKnownRecordsSolveNear(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response);

#endif
