/*
  Ways to a state.

    newton.c newton_flow.c newton.h       one equilibrium from a start: fast, flow and safe tier
    border.c border.h                     components of F that join the unknowns where stress is prescribed
    path.c                                start, substeps, leaving a saddle, what ends a path
    contact_step.c contact_update.c contact_newton.c contact_safe.c     one contact equilibrium from a start
    contact_start.c contact_try.c contact_walk.c contact_path.c         starts, judging a solution, paths to it
    nested.c                              a start from the solution of a coarser mesh
    mixed.c mixed_fast.c mixed_safe.c     states of which some components of P are prescribed
    estimate.c                            error of P from half as many elements
    rve.c state_bytes.c responder.c       the public interface
*/
#ifndef LAM_RVE_SOLVE_H
#define LAM_RVE_SOLVE_H

#include "border.h"
#include "measure.h"

/* ---- newton.c ---- */
typedef enum { LAM_NEWTON_CONVERGED, LAM_NEWTON_NEAR_SADDLE, LAM_NEWTON_STALLED } LamNewtonOutcome;
/* From rve->y to equilibrium at `load`. Fast: full steps. Safe: inertia-corrected steps that lower the energy and leave
   saddles; never ends NEAR_SADDLE. border: NULL, or the free components of F; the load is then border->load. */
PetscErrorCode LamNewtonFast(LamRVE rve, const LamLoad *load, LamBorder *border, LamNewtonOutcome *outcome);
PetscErrorCode LamNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
/* The same by patience, from unstable starts; shut: the cell whose lumen it came down to shut, -1: none. */
PetscErrorCode LamNewtonFlow(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome, PetscInt *shut);
/* Tolerance of the residual norm: the rounding error of the stiff forces, but at least 1e-11. */
PetscReal LamNewtonTolerance(LamRVE rve);

/* ---- path.c ---- */
/* Rotation angle of the polar decomposition of the in-plane part of F. */
PetscReal LamRotationAngle(const PetscReal F[9]);
/* Rotates positions y[n] and the deformation gradient they belong to about the origin. */
void LamRotatePositions(PetscInt n, PetscReal y[], PetscReal F[9], PetscReal angle);
/* rve->y := from [length] + (F_to - F_from) X, with the independent stresses and pressures of `from`. */
void LamMoveAffinely(LamRVE rve, const PetscReal from[], const LamLoad *load_from, const LamLoad *load_to);
/* The load at the share t of the straight way from a to b. */
LamLoad LamLoadBetween(const LamLoad *a, const LamLoad *b, PetscReal t);
/* Finds a stable equilibrium at `load` from `state`; leaves it in rve->y with the consistent tangent factored. */
PetscErrorCode LamFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, PetscInt *branch, PetscInt *negative,
                             LamStatus *status, char reason[], size_t length);


/* ---- contact_step.c ---- */
#define LAM_CONTACT_PROXIMAL 1e-8 /* shift of every contact step: a cell that nothing holds must not be singular */
/* Of max |min(lambda, c gap)|. */
static inline PetscReal LamGapTolerance(LamRVE rve)
{
  return PetscMax(1e-10, rve->tolerance);
}
typedef struct {
  PetscReal *rhs, *solution, *image; /* work space */
  PetscReal *lambda;                 /* [multipliers] after the step */
  PetscReal *first;                  /* the solution with the last factor, ... */
  PetscBool *factored;               /* ... and its active set, [multipliers] */
  PetscBool updates;                 /* other sets may be solved with that factor */
  PetscReal shift;                   /* of the last factor */
  PetscReal floor;                   /* least shift: the larger, the shorter the step */
  PetscReal before;                  /* largest entry of the step before */
  LamBorder *border;                 /* borrowed; NULL: F is prescribed */
} LamContactStep;
PetscErrorCode LamContactStepCreate(LamRVE rve, LamContactStep *step);
PetscErrorCode LamContactStepDestroy(LamContactStep *step);
/* After LamAssemble: takes the held forces off rve->residual; norm: of the residual with contact forces. */
void LamContactResidual(LamRVE rve, LamContactStep *step, PetscReal *norm);
/* solution [n] of the present active set from `first`, that of the set `before`, whose matrix is factored. *ok is
   PETSC_FALSE where the sets differ in too many hats, or the new matrix has too many negative eigenvalues. */
PetscErrorCode LamContactUpdateStep(LamRVE rve, const PetscBool before[], const PetscReal first[], PetscReal compliance,
                                    PetscReal solution[], PetscBool *ok);
/* rve->step and step->lambda from the assembled state with its contact curvature; norm: of its residual. *ok is
   PETSC_FALSE where no shift helps. */
PetscErrorCode LamContactSolveStep(LamRVE rve, PetscReal norm, PetscReal compliance, LamContactStep *step,
                                   PetscBool *ok);
/* Moves positions, wall stresses, multipliers and a free F by alpha. */
void LamContactTakeStep(LamRVE rve, const LamLoad *load, PetscReal alpha, const LamContactStep *step);

/* ---- contact_newton.c, contact_safe.c, contact_path.c ---- */
/* From rve->y, contact->lambda and the independent stresses to equilibrium at `load`. Fast: full steps; one larger than
   `reach` (apothems) ends it as stalled; LAM_FAR: the start may be far from contact, steps are shortened. Safe: descent
   on the energy, from consistent stresses. border: as in LamNewtonFast. */
#define LAM_FAR 0.0
PetscErrorCode LamContactNewton(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal reach,
                                LamNewtonOutcome *outcome);
PetscErrorCode LamContactNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
/* As LamFollowPath; the solution is in rve->y and contact->lambda. */
PetscErrorCode LamContactFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/* ---- nested.c ---- */
/* Whether a solve from `state` is to start from a coarser mesh. */
PetscBool LamIsNested(LamRVE rve, const LamRVEState state);
/* Solves on a coarser mesh, whose response is given; where it converged, `start` becomes its solution on this one. */
PetscErrorCode LamNestedStart(LamRVE rve, const LamLoad *load, LamRVEState start, LamResponse *coarse_response);

/* ---- rve.c ---- */
/* Empty where the load can be asked of plane-strain tissue, else why not. */
PetscErrorCode LamCheckLoad(const LamLoad *load, char reason[], size_t length);
/* A response without answer, no work yet, and nothing left of the solve before: a solve depends on load and state
 * alone. */
PetscErrorCode LamBeginResponse(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);
/* Fills the fields of a response whose status says that rve->y (and the multipliers) are a solution at `load`, with its
   consistent tangent factored, and stores it in `state`; refuses it where a lumen has collapsed. */
PetscErrorCode LamAcceptSolution(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);
/* The solution that rve holds becomes the state. */
void LamKeepState(LamRVE rve, const LamLoad *load, PetscInt branch, LamRVEState state);

#endif
