/*
  Solvers for equilibrium states of the RVE.

    newton.c newton_flow.c descent.c      one equilibrium from an initial guess: fast, flow and safe tiers
    border.c border.h                     components of F as unknowns, for prescribed stress
    path.c                                initial guess, load substeps, escape from saddles, failure reasons
    contact_step.c contact_update.c contact_newton.c contact_safe.c     one contact equilibrium from an initial guess
    contact_start.c contact_try.c contact_walk.c contact_path.c         initial guesses, acceptance, load paths
    nested.c                              initial guess from the solution on a coarser mesh
    mixed.c mixed_fast.c mixed_safe.c     states with some components of P prescribed
    estimate.c                            error estimate of P from a mesh with half as many elements
    rve.c state.c responder.c             the public interface
*/
#ifndef LAM_RVE_SOLVE_H
#define LAM_RVE_SOLVE_H

#include "border.h"
#include "load.h"
#include "measure.h"

/* ---- newton.c ---- */
typedef enum { LAM_NEWTON_CONVERGED, LAM_NEWTON_NEAR_SADDLE, LAM_NEWTON_STALLED } LamNewtonOutcome;
/* Solves for equilibrium at `load`, starting from rve->y. Fast: full Newton steps. Safe: inertia-corrected steps that
   lower the energy and leave saddles; never returns NEAR_SADDLE. border: NULL, or the free components of F; the load is
   then border->load. */
PetscErrorCode LamNewtonFast(LamRVE rve, const LamLoad *load, LamBorder *border, LamNewtonOutcome *outcome);
PetscErrorCode LamNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
/* The same for unstable initial guesses: the residual may grow. shut: the cell whose lumen closed during the iteration,
   which ends it; -1: none. */
PetscErrorCode LamNewtonFlow(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome, PetscInt *shut);
/* Tolerance on the residual norm: the larger of 1e-11, rve->tolerance and the rounding error of the stiff forces. */
PetscReal LamNewtonTolerance(LamRVE rve);
/* Factors K + shift 1 with the first shift of an increasing sequence that leaves no more negative eigenvalues than
   expected: *shift; `next` after one that is at most `base`; then `growth` times the last one. */
PetscErrorCode LamFactorShifted(LamRVE rve, PetscReal base, PetscReal next, PetscReal growth, PetscReal *shift,
                                PetscBool *ok);
/* The same for bonded tissue, from 0. least: first nonzero shift tried, if below 1e-7 of the largest diagonal entry;
   last_shift: in, of the previous factorisation, an eighth of which is tried first if larger; out, of this one. */
PetscErrorCode LamFactorPositive(LamRVE rve, PetscReal least, PetscReal *last_shift, PetscBool *ok);
/* rve->step := -K^-1 residual with the current factorisation, or the step of the bordered system; zero for the held
   class. */
PetscErrorCode LamSolveStep(LamRVE rve, LamBorder *border);
/* rve->trial := positions rve->y + alpha rve->step */
static inline void LamTrialPosition(LamRVE rve, PetscReal alpha)
{
  for (PetscInt i = 0; i < rve->ndof; ++i) rve->trial[i] = rve->y[i] + alpha * rve->step[i];
}
/* The first of alpha, alpha/2, ... for which rve->y + alpha rve->step inverts no element volume; 0: none above `least`.
 */
#define LAM_LEAST_STEP 0.01 /* least share of a step of bonded tissue */
PetscReal LamValidStep(LamRVE rve, const LamLoad *load, const LamBorder *border, PetscReal alpha, PetscReal least);
/* Updates positions, independent stresses and the border by alpha times the step. */
void LamTakeStep(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal alpha);
/* Whether a step is at rounding level, so that the iteration ends although the residual, in which large stresses
   cancel, may stay above the tolerance. largest: of the step's entries. */
PetscBool LamAtRounding(LamRVE rve, PetscReal norm, PetscReal tolerance, PetscReal largest);
/* Prints one line if the monitor is on. */
PetscErrorCode LamReportIteration(LamRVE rve, const char tier[], PetscInt iteration, PetscReal residual, PetscReal step,
                                  PetscReal shift);
/* Adds a downhill multiple of the softest mode to rve->step, if the mode has negative curvature. Used for small Newton
   steps of an indefinite matrix: near a saddle the residual has almost no component along that mode, and Newton alone
   is slow. iterations: inverse iterations, from `mode` [n]; image [n]: work space. */
#define LAM_ESCAPE_STEP 0.01 /* largest entry of that multiple, in apothems */
PetscErrorCode LamAddNegativeCurvature(LamRVE rve, PetscInt iterations, const PetscReal residual[], PetscReal mode[],
                                       PetscReal image[]);

/* ---- descent.c ---- */
#define LAM_DESCENT_LIMIT 0.05 /* of a step of a safe tier, in apothems */
typedef struct {
  PetscReal energy, violation; /* of walls, turgor and cohesion; sum D max(0, -gap) */
} LamMerit;
typedef struct {
  PetscReal *y, *lambda; /* the best point so far */
  LamMerit merit;        /* its merit, if `known` */
  PetscReal mu, limit;   /* weight of the violation; limit of the step length, lower after a return, apothems */
  PetscReal rounding;    /* of the energy */
  PetscInt without_decrease;
  PetscBool monotone, known; /* monotone: line search on the next step */
} LamDescent;
PetscErrorCode LamDescentCreate(LamRVE rve, LamDescent *descent);
PetscErrorCode LamDescentDestroy(LamDescent *descent);
/* Merit of the contact state last evaluated. */
LamMerit LamMeritOf(LamRVE rve, PetscReal energy);
/* If a line search is due: halves the step until the merit decreases sufficiently; *alpha = 0 if it does not. */
PetscErrorCode LamDescentSearch(LamRVE rve, const LamLoad *load, LamMerit now, LamDescent *descent, PetscReal *alpha);
/* Stores the present point as the best one. */
void LamDescentKeep(LamRVE rve, LamMerit merit, LamDescent *descent);
/* Stores the point of least merit; returns to it after too many steps without decrease. *moved: rve->y was reset. */
PetscErrorCode LamDescentWatch(LamRVE rve, const LamLoad *load, LamMerit now, PetscBool valid, LamDescent *descent,
                               PetscBool *moved);

/* ---- path.c ---- */
/* Rotation angle of the polar decomposition of the in-plane part of F. */
PetscReal LamRotationAngle(const PetscReal F[9]);
/* Rotates positions y[n] and their deformation gradient F by `angle` about the origin. */
void LamRotatePositions(PetscInt n, PetscReal y[], PetscReal F[9], PetscReal angle);
/* Creates a copy of `state` rotated by the difference between the rotations of the two F. */
PetscErrorCode LamTurnedState(LamRVE rve, LamRVEState state, const LamLoad *load, LamRVEState *turned);
/* rve->y := from [length] + (F_to - F_from) X, with the independent wall stresses and the pressures of `from`. */
void LamMoveAffinely(LamRVE rve, const PetscReal from[], const LamLoad *load_from, const LamLoad *load_to);
/* Finds a stable equilibrium at `load` by continuation from `state`; returns it in rve->y with the consistent tangent
   factored. */
PetscErrorCode LamFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/* Leaves saddles until the state is stable; if the mode of one leads to no other equilibrium, returns to it. branch:
   counts those left. On return the consistent tangent is factored. */
PetscErrorCode LamLeaveSaddles(LamRVE rve, const LamLoad *load, PetscInt *branch, PetscInt *negative, PetscBool *ok);
PetscErrorCode LamRefuseSaddle(LamRVE rve, PetscInt negative, LamResponse *response);

/* ---- contact_step.c ---- */
#define LAM_CONTACT_PROXIMAL 1e-8 /* shift of every contact step; keeps the matrix regular if a cell has no contact */
/* Tolerance on max |min(lambda, c gap)|. */
static inline PetscReal LamGapTolerance(LamRVE rve)
{
  return PetscMax(1e-10, rve->tolerance);
}
typedef struct {
  PetscReal *rhs, *solution, *image; /* work space */
  PetscReal *lambda;                 /* [multipliers] after the step */
  PetscReal *first;                  /* solution computed with the last factorisation */
  PetscBool *factored;               /* [multipliers] active set of the last factorisation */
  PetscBool updates;                 /* systems of other active sets may be solved by updating that factorisation */
  PetscReal shift;                   /* of the last factorisation */
  PetscReal floor;                   /* minimum shift; a larger one gives shorter steps */
  PetscReal before;                  /* largest entry of the previous step */
  LamBorder *border;                 /* borrowed; NULL: F is prescribed */
} LamContactStep;
PetscErrorCode LamContactStepCreate(LamRVE rve, LamBorder *border, LamContactStep *step);
PetscErrorCode LamContactStepDestroy(LamContactStep *step);
/* Call after LamAssemble. Subtracts the held forces from rve->residual; norm: of the residual including contact
   forces. */
void LamContactResidual(LamRVE rve, LamContactStep *step, PetscReal *norm);
/* Computes solution [n] for the current active set from `first`, the solution for the active set `before`, whose matrix
   is factored. *ok is PETSC_FALSE if the sets differ in too many hats or the new matrix has too many negative
   eigenvalues. */
PetscErrorCode LamContactUpdateStep(LamRVE rve, const PetscBool before[], const PetscReal first[], PetscReal compliance,
                                    PetscReal solution[], PetscBool *ok);
/* Computes rve->step and step->lambda at the assembled state, after LamContactAddCurvature; norm: of its residual. *ok
   is PETSC_FALSE if no shift gives a matrix with the expected inertia. */
PetscErrorCode LamContactSolveStep(LamRVE rve, PetscReal norm, PetscReal compliance, LamContactStep *step,
                                   PetscBool *ok);
/* Updates positions, wall stresses, multipliers and free components of F by alpha times the step. */
void LamContactTakeStep(LamRVE rve, const LamLoad *load, PetscReal alpha, const LamContactStep *step);

/* ---- contact_newton.c, contact_safe.c, contact_path.c ---- */
/* Solves for contact equilibrium at `load`, starting from rve->y, contact->lambda and the independent stresses. Fast:
   full steps; a step larger than `reach` (apothems) returns STALLED; reach = LAM_FAR: the initial guess may be far from
   contact, and steps are shortened. Safe: descent on the energy, starting from consistent stresses. border: as in
   LamNewtonFast. */
#define LAM_FAR 0.0
#define LAM_NEAR_REACH 0.5 /* from a near initial guess */
PetscErrorCode LamContactNewton(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal reach,
                                LamNewtonOutcome *outcome);
PetscErrorCode LamContactNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
/* As LamFollowPath, for contact tissue; returns the solution in rve->y and contact->lambda. */
PetscErrorCode LamContactFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/* ---- nested.c ---- */
/* Whether a solve from `state` should start from the solution on a coarser mesh. */
PetscBool LamIsNested(LamRVE rve, const LamRVEState state);
/* Solves on a coarser mesh and returns its response. If it and Newton from its interpolated solution converge, `start`
   becomes the solution on this mesh. */
PetscErrorCode LamNestedStart(LamRVE rve, const LamLoad *load, LamRVEState start, LamResponse *coarse_response);

/* ---- rve.c ---- */
/* Checks a load for plane-strain tissue; an invalid one is refused. */
PetscErrorCode LamCheckLoad(const LamLoad *load, LamResponse *response);
/* Initialises the response and the solver's work data. Resets everything left by the previous solve, so that a result
   depends on load and state alone. */
PetscErrorCode LamBeginResponse(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);
/* Completes a response. If its status says that rve->y (and the multipliers) solve `load`, with the consistent tangent
   factored: fills its fields and stores the solution in `state`. Rejects the solution if a lumen has collapsed. */
PetscErrorCode LamEndResponse(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);
/* A set-up RVE with another microstructure or mesh and, apart from `wanted`, the settings of `rve`. */
PetscErrorCode LamRVECreateLike(LamRVE rve, const LamMicrostructure *micro, LamWanted wanted, LamRVE *like);

/* ---- state.c ---- */
#define LAM_REFERENCE_LOAD ((LamLoad){.F = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}})
/* Stores the solution held by rve in `state`. */
void LamKeepState(LamRVE rve, const LamLoad *load, PetscInt branch, LamRVEState state);

#endif
