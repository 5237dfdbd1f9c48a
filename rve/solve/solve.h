/*
  Solvers for equilibrium states of the RVE.

    newton.c                              one bonded equilibrium from an initial guess by full Newton steps
    minimise.c                            a minimum of the energy, with contact or without
    border.c border.h                     components of F as unknowns, for prescribed stress
    path.c                                initial guess, load substeps, escape from saddles, failure reasons
    sharpen.c                             equilibrium with the exact law of contact, from a state near it
    contact_start.c contact_find.c contact_path.c     contact: initial guesses, a state at a load, load paths
    contact_jump.c                        whether the branch of the state before has ended
    lamella_step.c                        work and jumps of steps that break the lamella
    dissipate.c dissipate_*.c dissipate.h paths of F that are controlled by what the lamella dissipates
    nested.c                              initial guess from the solution on a coarser mesh
    out_of_plane.c                        any F: the third component of positions
    mixed.c mixed_fast.c mixed_safe.c     states with some components of P prescribed
    estimate.c                            error estimate of P from a finer mesh
    rve.c state.c responder.c             the public interface
*/
#ifndef LAM_RVE_SOLVE_H
#define LAM_RVE_SOLVE_H

#include "border.h"
#include "load.h"
#include "measure.h"

/* ---- newton.c ---- */
typedef enum { LAM_NEWTON_CONVERGED, LAM_NEWTON_NEAR_SADDLE, LAM_NEWTON_STALLED } LamNewtonOutcome;
/* Solves for equilibrium at `load`, starting from rve->y, by full Newton steps. border: NULL, or the free components of
   F; the load is then border->load. */
PetscErrorCode LamNewtonFast(LamRVE rve, const LamLoad *load, LamBorder *border, LamNewtonOutcome *outcome);
#define LAM_ROUNDING_MARGIN 1e3 /* times the tolerance: residual that rounding of large stresses may leave */
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
#define LAM_PROXIMAL 1e-7        /* shift of every step of contact tissue: keeps free cells from turning by rounding */
#define LAM_SADDLE_RESIDUAL 1e-3 /* norm below which small steps of an indefinite contact state mean a saddle */
#define LAM_CREEPING 0.6         /* the same for small steps longer than this share of the previous one */
#define LAM_ESCAPE_STEP 0.01     /* largest entry of that multiple, in apothems */
PetscErrorCode LamAddNegativeCurvature(LamRVE rve, PetscInt iterations, const PetscReal residual[], PetscReal mode[],
                                       PetscReal image[]);

/* ---- minimise.c ---- */
/* Finds a minimum of the energy, of contact tissue with the smooth law, from rve->y and the independent stresses, to
   the tolerance of the residual norm. border: as in LamNewtonFast. */
PetscErrorCode LamMinimise(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal tolerance,
                           LamNewtonOutcome *outcome);

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

/* ---- contact_path.c ---- */
/* As LamFollowPath, for contact tissue; returns the solution in rve->y, with the multipliers and active set of the
   indicators. */
PetscErrorCode LamContactFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/* ---- contact_jump.c ---- */
/* Stores energy and first derivatives of a response with fields in its state, in that of walls with memory what is
   stored or dissipated. */
void LamKeepEnergy(const LamResponse *response, LamRVEState state);
/* Between two states, per V0: work of the derivatives of Psi by the trapezoidal rule, the sum of the absolute values of
   what their changes contribute to it, change of Psi less work, and the largest change of a component of the load. */
typedef struct {
  PetscReal work, turnover, defect, largest;
} LamStepWork;
LamStepWork LamStepWorkOf(const LamRVEState from, const LamRVEState to);
#define LAM_LEAST_LOSS 1e-7 /* C1 + C2: below it Psi has few digits */
/* Sets jumped and energy_released of the response of `state`, which was solved from `before`. */
PetscErrorCode LamSeeJump(LamRVE rve, LamRVEState before, LamRVEState state, LamResponse *response);

/* ---- lamella_step.c ---- */
/* Completes a step of tissue with a history: that of a lamella, as follows, or the work of walls with memory. */
PetscErrorCode LamHistoryStep(LamRVE rve, LamRVEState before, const LamStressControl *control, LamRVEState state,
                              LamResponse *response);
/* Completes a step of tissue with a lamella from `before`: work and jumps, in state and response. A step that is too
   long is taken again in smaller ones, which replace `state` and its response. control: prescribed stress, or NULL. */
PetscErrorCode LamLayerStep(LamRVE rve, LamRVEState before, const LamStressControl *control, LamRVEState state,
                            LamResponse *response);

/* ---- nested.c ---- */
/* Whether a solve from `state` should start from the solution on a coarser mesh. */
PetscBool LamIsNested(LamRVE rve, const LamRVEState state);
/* Solves on a finer mesh, whose response was begun, from the interpolated solution that `coarse` holds, which is that
   of `from`; `to` is set if that converges. */
PetscErrorCode LamProlong(LamRVE coarse, LamRVEState from, LamRVE rve, LamRVEState to);
/* Solves on a coarser mesh and returns its response. If it and Newton from its interpolated solution converge, `start`
   becomes the solution on this mesh. */
PetscErrorCode LamNestedStart(LamRVE rve, const LamLoad *load, LamRVEState start, LamResponse *coarse_response);

/* ---- out_of_plane.c ---- */
/* Whether load (in the frame of the section), state or walls have a third component of positions. */
PetscBool LamIsOutOfPlane(LamRVE rve, const LamLoad *load, const LamRVEState state);
/* Sets z and G to those of a state; stores them. */
void LamTakeAxial(LamRVE rve, const LamRVEState state);
void LamKeepAxial(LamRVE rve, LamRVEState state);
/* As LamFollowPath and LamContactFollowPath, with z. */
PetscErrorCode LamSolveOutOfPlane(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/* ---- rve.c ---- */
/* Checks a load; an invalid one is refused. */
PetscErrorCode LamCheckLoad(LamRVE rve, const LamLoad *load, LamResponse *response);
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
/* Copies the history of the lamella alone; that of walls with memory. */
PetscErrorCode LamCopyHistory(LamRVEState from, LamRVEState to);
PetscErrorCode LamCopyMemory(LamRVEState from, LamRVEState to);

#endif
