/*
  Comparison of a database with fresh solves at random states.
*/
#ifndef LAM_AUDIT_H
#define LAM_AUDIT_H

#include "query_source.h"
#include "dispatch.h"

/* The box from which states are drawn; [0] smallest, [1] largest value. */
typedef struct {
  PetscReal strain[2]; /* principal logarithmic strains */
  PetscReal turgor[2], cohesion, F33[2];
  const char *origin; /* "sample box of its scene", "what its records span" */
} LamAuditBox;

/* One response compared with a fresh solve. A quantity that either of them lacks is NaN. */
typedef struct {
  PetscBool compared;
  PetscReal estimate, error; /* of P: error estimate of the response; LamStressError between response and solve */
  PetscReal axial;           /* LamAxialError; NaN: F33 is 1 alone */
  PetscReal tangent, tangent_estimate; /* LamTangentError, and the estimate of the response */
  PetscReal opening, lumen;  /* absolute differences of opening_fraction and lumen_fraction */
  PetscReal query_seconds, solve_seconds;
} LamAudited;

typedef struct {
  const LamQuerySource *from; /* borrowed */
  LamAuditBox box;
  PetscReal accuracy;
  PetscInt seed, wanted;
  PetscInt asked, answered; /* queries; those with a response. At most MOST_ASKED * wanted queries */
  LamLoad *loads;           /* [answered]; owned */
  LamAudited *results;      /* [answered]; owned */
  PetscInt solved;          /* completed solves, including failed ones */
  json_t *refused;          /* queries without a response, counted by reason (numbers removed); owned */
  json_t *unsolved;         /* failed solves, counted by status; owned */
} LamAudit;

/* ---- audit.c ---- */
/* Draws states and queries the database at them, until `samples` queries have a response. */
PetscErrorCode LamAuditCreate(const LamQuerySource *from, PetscReal accuracy, PetscInt samples, PetscInt seed,
                              LamAudit *audit);
PetscErrorCode LamAuditDestroy(LamAudit *audit);
/* Compares response i with the fresh solve of its load. */
PetscErrorCode LamAuditCompare(LamAudit *audit, PetscInt i, const LamResponse *fresh);

/* ---- audit_run.c; collective ---- */

typedef struct {
  const char *path;
  PetscInt samples, seed;
  PetscReal accuracy; /* 0: accuracy of the database */
  LamReporter reporter;

  LamDispatch dispatch;
  PetscMPIInt rank, ranks;
  PetscReal start;

  /* every rank */
  LamMicrostructure micro; /* rank 0: cells borrowed from the database; else owned */
  LamStrategy strategy;
  LamLoad *loads; /* of the audit; rank 0: borrowed, else owned */
  LamRVE rve;
  LamRVEState state;

  /* rank 0 */
  LamQuerySource from;
  LamAudit audit;
} LamVerification;

PetscErrorCode LamVerificationRun(LamVerification *verification);
PetscErrorCode LamVerificationDestroy(LamVerification *verification);

#endif
