/* Load paths to contact equilibrium: contact_start.c, contact_try.c, contact_walk.c, contact_path.c. */
#ifndef LAM_RVE_CONTACT_PATH_H
#define LAM_RVE_CONTACT_PATH_H

#include "solve.h"

/* ---- contact_start.c ---- */
/* Initial guess: a solution moved affinely to the new load. */
void LamContactStartNear(LamRVE rve, LamRVEState from, const LamLoad *load);
/* Initial guess: rve->y := F X with cells swollen by their clearance, stress-free walls, and multipliers that balance
   turgor and cohesion. */
void LamContactStartAffine(LamRVE rve, const LamLoad *load);
/* Initial guess: rve->y := the last solution of rve->bonded, which must have the same F; multipliers fitted to the
   bonding forces; contact->held := the bonding forces that the multipliers do not represent. */
PetscErrorCode LamContactStartBonded(LamRVE rve, const LamLoad *load, PetscBool *ok);

/* ---- contact_try.c ---- */
typedef enum {
  LAM_NOT_REFUSED,
  LAM_WALLS_OVERLAP, /* facing walls overlap: contact acts between nodes only, and the mesh is too coarse */
  LAM_CELLS_OVERLAP, /* a wall overlaps one that it does not face; such contact is not modelled */
  LAM_WALLS_PASSED,  /* facing walls have slid past each other, beyond the end of one of them */
  LAM_SADDLE,        /* stable states of a load path end: only a saddle was found beyond, ... */
  LAM_CROSSING,      /* ... or an eigenvalue crosses zero, ... */
  LAM_LOOSENING,     /* ... or it jumps below zero as walls open, ... */
  LAM_JUMP,          /* ... or as the end of an overlap passes a node */
  LAM_LUMEN_COLLAPSED
} LamRefusal;
typedef enum { LAM_WAY_FROM_BEFORE, LAM_WAY_FROM_REST, LAM_WAY_OF_TURGOR } LamWay;
/* Result of an attempt to solve at one load, or of a load path. */
typedef struct {
  PetscBool converged;
  PetscInt negative;    /* eigenvalues; > 0: a saddle */
  PetscInt branch;      /* number of saddles left */
  LamRefusal refusal;   /* why a solution was rejected; converged is then PETSC_FALSE */
  PetscInt cell[2];     /* the cells concerned */
  PetscReal eigenvalue; /* lowest eigenvalue at the last stable state of a load path, C1 + C2 */
  PetscReal depth;      /* depth of the first cell's wall inside the second, apothems */
  PetscBool coarse;     /* too deep to accept, but within the mesh error: allowed as an intermediate state of a path */
  PetscReal between[2]; /* path parameters of the last stable state and of the failure after it; equal: unknown */
  LamWay way;
  LamKinking kinking; /* of walls on that path */
} LamContactOutcome;
#define LAM_NO_OUTCOME ((LamContactOutcome){.kinking = LAM_NO_KINKING})
/* Solve from the current initial guess, by full Newton steps no longer than `reach`, or by descent. Saddles are left;
   unacceptable solutions are rejected. A converged result has its consistent tangent factored. */
#define LAM_DESCENT -1.0
PetscErrorCode LamContactTry(LamRVE rve, const LamLoad *load, PetscReal reach, LamContactOutcome *out);
/* The same from a solution at another load. */
PetscErrorCode LamContactTryFrom(LamRVE rve, LamRVEState from, const LamLoad *load, PetscReal reach,
                                 LamContactOutcome *out);
/* LamContactTry with free components of F; saddles are not left. */
PetscErrorCode LamContactTryMixed(LamRVE rve, LamBorder *border, PetscReal reach, LamContactOutcome *out);
static inline PetscBool LamContactIsStable(const LamContactOutcome *out)
{
  return (PetscBool)(out->converged && out->negative <= 0);
}
/* Rejects a solution that is acceptable only as an intermediate state of a path. */
static inline void LamContactSettle(LamContactOutcome *out)
{
  if (!out->converged || !out->coarse) return;
  out->converged = PETSC_FALSE;
  out->refusal = LAM_WALLS_OVERLAP;
}

/* ---- contact_walk.c ---- */
/* Continuation along the straight load path from *at to `load`. On return *at is the last stable solution; if the path
   ends before `load`, *out gives the reason. */
PetscErrorCode LamContactWalk(LamRVE rve, LamRVEState at, const LamLoad *load, LamContactOutcome *out);

/* ---- contact_path.c ---- */
/* Whether the loads are near enough for Newton to start from a solution at `from`. */
PetscBool LamContactIsNear(const LamLoad *from, const LamLoad *load);
/* Sets status and reason of an outcome that is not a stable state. */
PetscErrorCode LamContactRefuse(LamRVE rve, const LamContactOutcome *out, LamResponse *response);

#endif
