/* Shared by the files that lead to contact equilibrium: contact_start.c, contact_try.c,
   contact_walk.c, contact_path.c. */
#ifndef LAM_RVE_CONTACT_PATH_H
#define LAM_RVE_CONTACT_PATH_H

#include "solve.h"

/* A solution, to start from or to come back to. */
typedef struct {
  LamLoad load;
  PetscReal *y, *lambda;
  PetscInt (*hats)[2]; /* [face]: first and last hat of the junction status */
} LamContactSolution;

/* ---- contact_start.c ---- */
PetscErrorCode LamContactSolutionCreate(LamRVE rve, LamContactSolution *solution);
PetscErrorCode LamContactSolutionDestroy(LamContactSolution *solution);
PetscErrorCode LamContactSave(LamRVE rve, const LamLoad *load, LamContactSolution *solution);
/* Back to a solution, with its active set and junction status. */
PetscErrorCode LamContactRestore(LamRVE rve, const LamContactSolution *solution);
/* The solution that `state` holds, turned as the new load turns. */
PetscErrorCode LamContactTurnState(LamRVE rve, LamRVEState state, const LamLoad *load, LamContactSolution *solution);
/* From a solution, moved affinely to the new load. */
PetscErrorCode LamContactStartNear(LamRVE rve, const LamContactSolution *from, const LamLoad *load);
/* rve->y := F X, the cells swollen by their clearance, stress-free walls, multipliers that balance turgor and
   cohesion. */
PetscErrorCode LamContactStartAffine(LamRVE rve, const LamLoad *load);
/* rve->y: the positions last solved for by rve->bonded, which belong to the same F; contact->held: what bonding carries
   and the multipliers fitted to it do not. */
PetscErrorCode LamContactStartBonded(LamRVE rve, const LamLoad *load, PetscBool *ok);

/* ---- contact_try.c ---- */
typedef enum {
  LAM_NOT_REFUSED,
  LAM_WALLS_OVERLAP, /* walls that face each other: contact acts between nodes only, and the mesh is too coarse */
  LAM_CELLS_OVERLAP, /* a wall has met one that it does not face: contact does not know of that */
  LAM_WALLS_PASSED,  /* walls that face each other have passed each other at once, past the end of one of them */
  LAM_SADDLE,        /* on a way: the stable states end there, ... */
  LAM_CROSSING,      /* ... or in an eigenvalue that crosses zero, ... */
  LAM_LOOSENING,     /* ... or jumps below it, as walls open, ... */
  LAM_JUMP,          /* ... or as the end of an overlap passes a node */
  LAM_LUMEN_COLLAPSED
} LamRefusal;
typedef enum { LAM_WAY_FROM_BEFORE, LAM_WAY_FROM_REST, LAM_WAY_OF_TURGOR } LamWay;
/* What a try at one load ended in. */
typedef struct {
  PetscBool converged;
  PetscInt negative;    /* eigenvalues; > 0: a saddle */
  PetscInt branch;      /* saddles left on the way */
  LamRefusal refusal;   /* why a solution is no answer; it then counts as not converged */
  PetscInt cell[2];     /* the cells concerned */
  PetscReal eigenvalue; /* lowest, of the last stable state of a way */
  PetscReal depth;      /* of the wall of the first inside the second */
  PetscBool coarse;     /* it is too deep for an answer, but the mesh explains it: a way may lead over it */
  PetscReal between[2]; /* shares of a way: the last stable state, the next that is none; equal: not known */
  LamWay way;
  LamKinking kinking; /* on that way */
} LamContactOutcome;
#define LAM_NO_OUTCOME ((LamContactOutcome){.kinking = LAM_NO_KINKING})
#define LAM_NEAR_REACH 0.5 /* apothems: a larger step from a near start leads nowhere */
/* Newton from the present start, by full steps or by descent; saddles are left, what is no answer is refused. Ends with
   the consistent tangent factored. */
PetscErrorCode LamContactTry(LamRVE rve, const LamLoad *load, PetscReal reach, LamContactOutcome *out);
PetscErrorCode LamContactDescend(LamRVE rve, const LamLoad *load, LamContactOutcome *out);
/* The same with free components of F; saddles are not left. */
PetscErrorCode LamContactTryMixed(LamRVE rve, LamBorder *border, PetscReal reach, LamContactOutcome *out);
static inline PetscBool LamContactIsStable(const LamContactOutcome *out)
{
  return (PetscBool)(out->converged && out->negative <= 0);
}
/* What a way may lead over is no answer yet. */
static inline void LamContactSettle(LamContactOutcome *out)
{
  if (!out->converged || !out->coarse) return;
  out->converged = PETSC_FALSE;
  out->refusal = LAM_WALLS_OVERLAP;
}

/* ---- contact_walk.c ---- */
/* Continuation from the solution *at, which becomes the last stable one on the straight way to `load`; where the way
   ends before, *out says in what. */
PetscErrorCode LamContactWalk(LamRVE rve, LamContactSolution *at, const LamLoad *load, LamContactOutcome *out);

/* ---- contact_path.c ---- */
/* Whether Newton may start from a solution at the load `from`. */
PetscBool LamContactIsNear(const LamLoad *from, const LamLoad *load);
/* Why an outcome is not a stable state. */
PetscErrorCode LamContactReason(LamRVE rve, const LamContactOutcome *out, char reason[], size_t length);

#endif
