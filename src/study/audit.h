/*
  A database compared with fresh solves: which states it is queried at, what is compared.
*/
#ifndef LAM_AUDIT_H
#define LAM_AUDIT_H

#include "query_source.h"
#include "dispatch.h"

/* The states that questions are drawn from; [0] the smallest, [1] the largest. */
typedef struct {
  PetscReal strain[2]; /* principal logarithmic strains */
  PetscReal turgor[2], cohesion;
  const char *origin; /* "sample box of its scene", "what its records span" */
} LamAuditBox;

/* One answer beside a fresh solve. What is not known of both is NaN. */
typedef struct {
  PetscBool compared;
  PetscReal estimate, error; /* of P: the answer's, and LamStressError of the answer against the solve */
  PetscReal tangent;         /* |A - A_ref| / (|A_ref| + 0.0227 (C1 + C2)), in-plane entries, Frobenius */
  PetscReal opening, lumen;  /* differences of the two fractions, without sign */
  PetscReal query_seconds, solve_seconds;
} LamAudited;

typedef struct {
  const LamQuerySource *from; /* borrowed */
  LamAuditBox box;
  PetscReal accuracy;
  PetscInt seed, wanted;
  PetscInt asked, answered; /* asked until `wanted` have been answered, or MOST_ASKED times as many */
  LamLoad *loads;           /* [answered]; owned */
  LamAudited *results;      /* [answered]; owned */
  PetscInt solved;          /* solves made, failed ones included */
  json_t *refused;          /* how often by reason, numbers in it left out; owned */
  json_t *unsolved;         /* fresh solves that failed, by status; owned */
} LamAudit;

/* ---- audit.c ---- */
/* Draws and asks. */
PetscErrorCode LamAuditCreate(const LamQuerySource *from, PetscReal accuracy, PetscInt samples, PetscInt seed,
                              LamAudit *audit);
PetscErrorCode LamAuditDestroy(LamAudit *audit);
/* Compares answer i with the solve of its load. */
PetscErrorCode LamAuditCompare(LamAudit *audit, PetscInt i, const LamResponse *fresh);

/* ---- audit_run.c; collective ---- */

typedef struct {
  const char *path;
  PetscInt samples, seed;
  PetscReal accuracy; /* 0: that of the database */
  LamReporter reporter;

  LamDispatch dispatch;
  PetscMPIInt rank, ranks;
  PetscReal start;

  /* every rank */
  LamMicrostructure micro;
  LamStrategy strategy;
  PetscInt count;
  LamLoad *loads; /* [count] */
  LamRVE rve;
  LamRVEState state;

  /* rank 0 */
  LamQuerySource from;
  LamAudit audit;
} LamVerification;

PetscErrorCode LamVerificationRun(LamVerification *verification);
PetscErrorCode LamVerificationDestroy(LamVerification *verification);

#endif
