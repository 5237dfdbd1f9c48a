/*
  What is measured of a state.

    homogenise.c   stress, tangent and couplings by static condensation
    traction.c     largest means along faces; interface tractions of bonded faces
    failure.c      stretch, energy and tension of the walls, and whether they kink (wall_ellipticity.h)
    indicators.c   how far cells have come apart
    lumen.c        lumens whose walls have met
    fields.c       fields for pictures
*/
#ifndef LAM_RVE_MEASURE_H
#define LAM_RVE_MEASURE_H

#include "rve_impl.h"

#define LAM_F_COUNT 5                             /* components of F in plane strain: F11 F12 F21 F22 F33 */
extern const PetscInt LamFComponent[LAM_F_COUNT]; /* their places in a row-major 3 x 3 */

/* " between 0.25 and 0.26 of the way"; empty where the second share is not above the first: not known. */
PetscErrorCode LamBracketText(const PetscReal between[2], char text[], size_t length);

/* ---- homogenise.c, traction.c, failure.c ---- */
/* L_q, L_qq and R = L_yq [LAM_F_COUNT][n] of the components of F at rve->y, after LamAssemble there; rows of R for all
   multipliers, as if they were active. */
PetscErrorCode LamAssembleGradient(LamRVE rve, const LamLoad *load, PetscReal Lq[LAM_F_COUNT],
                                   PetscReal Lqq[LAM_F_COUNT][LAM_F_COUNT], PetscReal R[]);
/* Copies a column [n] with zeros for multipliers that are not active. */
void LamCopyActive(LamRVE rve, const PetscReal column[], PetscReal copy[]);
/* Fills energy, P and lumen fraction from rve->y and, where they are wanted, tangent and couplings with the factored
   consistent tangent. */
PetscErrorCode LamHomogenise(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Whether a value is larger than that of the place named so far by more than rounding (C1 + C2 or apothems): of places
   that symmetry makes alike the first one is named, whatever the last digits. Anything exceeds -PETSC_MAX_REAL. */
static inline PetscBool LamExceeds(PetscReal value, PetscReal named)
{
  return (PetscBool)(value > named + 1e-8 * PetscAbsReal(named) + 1e-10);
}
/* The largest mean over a stretch of a face that is as long as the wall of its cell is thick, and where it is. */
typedef struct {
  PetscReal value, named; /* named: at the place */
  PetscReal place[3]; /* cell, face, middle of the stretch as a share of the face, counter-clockwise around the cell */
} LamLargestMean;
#define LAM_NO_MEAN                                                                                                    \
  {                                                                                                                    \
    .value = -PETSC_MAX_REAL, .named = -PETSC_MAX_REAL, .place = { NAN, NAN, NAN }                                     \
  }
/* A patch of one cell has no face between cells: its largest mean is unknown. */
static inline PetscReal LamLargestMeanValue(const LamLargestMean *largest)
{
  return largest->value > -PETSC_MAX_REAL ? largest->value : NAN;
}
/* Takes a face into account, with windows of length `thickness`: running integrals [count + 1] over sub-intervals, of
   which all elements along the face have as many. */
void LamTakeLargestMean(const LamMesh *mesh, PetscReal thickness, PetscInt cell, PetscInt face, PetscInt count,
                        const PetscReal integral[], const PetscReal length[], LamLargestMean *largest);
/* Bonded tissue: mean normal traction per face family, largest normal and shear traction (Cauchy) and their places. */
PetscErrorCode LamFaceTractions(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Fills the measures of the walls from rve->y. */
PetscErrorCode LamWallMeasures(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Share of the walls' volume that has lost ellipticity at positions y (wall_ellipticity.h). */
void LamFindKinks(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *share);
/* Walls along a way of loads: between which shares of it they lose their ellipticity, and how many have at the last
   stable state. Walls that kink answer for the end of a way, wherever the mesh lets it be. */
typedef struct {
  PetscReal between[2]; /* equal: they do not; the first below 0: they had lost it before */
  PetscReal share;      /* of the walls' volume */
} LamKinking;
#define LAM_NO_KINKING                                                                                                 \
  {                                                                                                                    \
    .between = { -1.0, -1.0 }                                                                                          \
  }
#define LAM_KINKED_SUBSTEP (1.0 / 64.0) /* then this is the smallest substep */
static inline PetscBool LamIsKinking(const LamKinking *kinking)
{
  return (PetscBool)(kinking->between[1] > kinking->between[0]);
}
/* Takes note of a stable state y, a share t of the way. */
void LamWatchKinks(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal t, LamKinking *kinking);
/* reached: the share of the last stable state. */
PetscErrorCode LamKinkReason(const LamKinking *kinking, PetscReal reached, char reason[], size_t length);

/* ---- indicators.c ---- */
/* Fills the debonding indicators from rve->y and the multipliers; of contact tissue the tractions, too. */
PetscErrorCode LamContactIndicators(LamRVE rve, const LamLoad *load, LamResponse *response);
PetscErrorCode LamBondedIndicators(LamRVE rve, const LamLoad *load, LamResponse *response);

/* ---- lumen.c ---- */
/* The first cell whose inner loop crosses itself or is inside out at positions y, -1: none. */
PetscErrorCode LamFindCollapsedLumen(LamRVE rve, const PetscReal y[], PetscInt *cell);
/* between: shares of the way to the load between which its walls first touch, as LamBracketText. */
PetscErrorCode LamCollapseReason(PetscInt cell, const PetscReal between[2], char reason[], size_t length);
/* ---- fields.c ---- */
/* Coefficients of 1, xi, eta, xi eta in the least-squares fit to the values at the Gauss points of an element. */
void LamFitBilinear(const PetscReal gauss[LAM_GAUSS], PetscReal c[4]);

#endif
