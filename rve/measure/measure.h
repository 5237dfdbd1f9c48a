/*
  Measures of a state.

    homogenise.c   stress, tangent and couplings by static condensation
    section.c      stress and tangent with an index 3
    traction.c     largest means along faces; interface tractions of bonded faces
    failure.c      stretch, energy and tension of the walls, and whether they kink (wall_ellipticity.h)
    indicators.c   debonding: separation of cells
    bonds.c        the lamella: energies and damage
    bond_rates.c   how its jumps change with the load
    lumen.c        collapsed lumens
    fields.c       fields for pictures
*/
#ifndef LAM_RVE_MEASURE_H
#define LAM_RVE_MEASURE_H

#include "rve_impl.h"

#define LAM_F_COUNT 5                             /* components of F in plane strain: F11 F12 F21 F22 F33 */
extern const PetscInt LamFComponent[LAM_F_COUNT]; /* their indices in a row-major 3 x 3 */

/* Writes " between 0.25 and 0.26 of the way"; empty if the second fraction is not above the first, i.e. unknown. */
void LamBracketText(const PetscReal between[2], char text[], size_t length);

/* ---- homogenise.c, traction.c, failure.c ---- */
/* L_q, L_qq and R = L_yq [LAM_F_COUNT][n] for the components of F at rve->y, after LamAssemble there. R has rows for
   all multipliers, as if all were active. */
PetscErrorCode LamAssembleGradient(LamRVE rve, const LamLoad *load, PetscReal Lq[LAM_F_COUNT],
                                   PetscReal Lqq[LAM_F_COUNT][LAM_F_COUNT], PetscReal R[]);
/* Copies a column [n], with zeros for multipliers that are not active. */
void LamCopyActive(LamRVE rve, const PetscReal column[], PetscReal copy[]);
/* Sets energy, P and lumen fraction at rve->y, where the consistent tangent is assembled and factored, and, if
   requested, tangent and couplings. */
PetscErrorCode LamHomogenise(LamRVE rve, const LamLoad *load, LamResponse *response);
/* ---- section.c ---- */
#define LAM_MOST_COLUMNS 8 /* of q: F11 F12 F21 F22 F33, turgor, cohesion, width of the smooth law; then ... */
#define LAM_AXIAL_G LAM_MOST_COLUMNS /* ... F31, F32 */
/* What z and G add to L_q and H = d2L/dq2, not divided by V0. ok: the state is stable against displacements along the
   cells; else they are 0. */
typedef struct {
  PetscReal Lq[LAM_MOST_COLUMNS + 2], H[LAM_MOST_COLUMNS + 2][LAM_MOST_COLUMNS + 2];
  PetscBool ok;
} LamAxialDerivatives;
/* At rve->y, whose consistent tangent is factored. solutions [nq][n]: K^-1 L_yq of the first nq columns; nq = 0: none.
 */
PetscErrorCode LamCondenseAxial(LamRVE rve, const LamLoad *load, PetscInt nq, const PetscReal solutions[],
                                LamAxialDerivatives *out);

/* Whether a value exceeds that of the location reported so far by more than rounding (C1 + C2 or apothems). Among
   locations that are equal by symmetry the first one is reported, regardless of the last digits. Every value exceeds
   -PETSC_MAX_REAL. */
static inline PetscBool LamExceeds(PetscReal value, PetscReal named)
{
  return (PetscBool)(value > named + 1e-8 * PetscAbsReal(named) + 1e-10);
}
/* Largest mean over a segment of a face whose length is the wall thickness of its cell, and the location of that
   segment. */
typedef struct {
  PetscReal value, named; /* named: value at `place` */
  PetscReal
      place[3]; /* cell, face, middle of the segment as a fraction of the face, counter-clockwise around the cell */
} LamLargestMean;
#define LAM_NO_MEAN ((LamLargestMean){-PETSC_MAX_REAL, -PETSC_MAX_REAL, {NAN, NAN, NAN}})
/* Value of the largest mean; NaN in a patch of one cell, which has no face between cells. */
static inline PetscReal LamLargestMeanValue(const LamLargestMean *largest)
{
  return largest->value > -PETSC_MAX_REAL ? largest->value : NAN;
}
/* Updates the largest mean with one face, for windows of length `thickness`. integral, length: running integrals [count
   + 1] over sub-intervals; all elements along the face have equally many. */
void LamTakeLargestMean(const LamMesh *mesh, PetscReal thickness, PetscInt face, PetscInt count,
                        const PetscReal integral[], const PetscReal length[], LamLargestMean *largest);
/* Bonded tissue: mean normal traction per face family, largest normal and shear traction (Cauchy) and their locations.
 */
PetscErrorCode LamFaceTractions(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Sets the wall measures of the response from rve->y. */
PetscErrorCode LamWallMeasures(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Loss of ellipticity of the walls (wall_ellipticity.h) along a load path: the path fractions between which it first
   occurs, and the volume fraction affected at the last stable state. If walls kink, the end of the path is attributed
   to that: where it ends then depends on the mesh. */
typedef struct {
  PetscReal between[2]; /* equal: no loss; the first below 0: lost before the path starts */
  PetscReal share;      /* volume fraction of the walls */
} LamKinking;
#define LAM_NO_KINKING ((LamKinking){.between = {-1.0, -1.0}})
#define LAM_KINKED_SUBSTEP (1.0 / 64.0) /* smallest substep if walls kink */
static inline PetscBool LamIsKinking(const LamKinking *kinking)
{
  return (PetscBool)(kinking->between[1] > kinking->between[0]);
}
/* Records a stable state y at fraction t of the path. */
void LamWatchKinks(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal t, LamKinking *kinking);
/* reached: path fraction of the last stable state. */
PetscErrorCode LamRefuseKinks(const LamKinking *kinking, PetscReal reached, LamStatus status, LamResponse *response);

/* ---- indicators.c ---- */
/* Sets the debonding indicators from rve->y and the multipliers; for contact tissue also the tractions. */
PetscErrorCode LamContactIndicators(LamRVE rve, const LamLoad *load, LamResponse *response);
void LamBondedIndicators(LamRVE rve, const LamLoad *load, LamResponse *response);

/* ---- bonds.c ---- */
/* Sets energies and broken fractions of tissue with a lamella; after LamHomogenise. */
void LamLayerMeasures(LamRVE rve, const LamLoad *load, LamResponse *response);
/* ---- crack.c ---- */
/* Sets faces and length of the crack; of a patch without a notch they stay unknown. */
PetscErrorCode LamCrackMeasure(LamRVE rve, const LamLoad *load, LamResponse *response);

/* ---- bonds.c ---- */
/* Sums over the points of the lamella. */
typedef struct {
  PetscReal dissipated;             /* in this step */
  PetscReal spent[3], toughness[3]; /* of the lamella, by face family: energy spent, and that of fracture */
  PetscReal torn;                   /* energy spent in cuts of walls */
} LamDamage;
void LamDamageAdd(LamRVE rve, const LamBond *bond, const LamBondPoint *point, LamDamage *damage);
/* Sets the broken fractions. */
void LamDamageFill(const LamDamage *damage, LamResponse *response);
/* Forces per reference thickness at the points of the lamella, tension and the direction along the slave's wall being
   positive, and the reference length about each hat that is not broken. Without a lamella all are NULL. */
typedef struct {
  PetscReal *normal, *shear; /* [point] */
  PetscReal *held;           /* [hat] */
} LamLayerForces;
PetscErrorCode LamLayerForcesCreate(LamRVE rve, const LamLoad *load, LamLayerForces *forces);
PetscErrorCode LamLayerForcesDestroy(LamLayerForces *forces);
/* Force of a face, whose points are force[], between two places, in edges, of the same edge. */
PetscReal LamLayerForceBetween(const PetscReal force[], PetscReal a, PetscReal b);

/* ---- bond_rates.c ---- */
/* Fills rve->rates; columns: K^-1 L_yq for q = F11, F12, F21, F22, p. */
PetscErrorCode LamBondRatesFind(LamRVE rve, const LamLoad *load, const PetscReal *const columns[LAM_BOND_RATES]);
/* A layer with the history `before` whose jumps have changed at their rates. */
typedef struct {
  LamDamage damage;
  PetscReal error; /* stress by which the law at these jumps and its tangent differ */
} LamLayerPrediction;
/* change: of F11, F12, F21, F22, p from the state of the rates. after: the history there, may be `before`; NULL: not
   wanted. */
void LamLayerPredict(LamRVE rve, const LamBondRate rates[], const PetscReal change[LAM_BOND_RATES],
                     const LamBondHistory before[], LamBondHistory after[], LamLayerPrediction *prediction);

/* ---- lumen.c ---- */
/* The first cell whose inner loop at positions y intersects itself or is inverted; -1: none. */
PetscErrorCode LamFindCollapsedLumen(LamRVE rve, const PetscReal y[], PetscInt *cell);
/* between: path fractions between which the lumen's walls first touch, as in LamBracketText. */
PetscErrorCode LamRefuseCollapse(PetscInt cell, const PetscReal between[2], LamStatus status, LamResponse *response);

/* ---- fields.c ---- */
/* Restores the solution of a state in the RVE, with its active set and junction status. */
PetscErrorCode LamTakeState(LamRVE rve, LamRVEState state);
/* Coefficients of 1, xi, eta, xi eta in the least-squares fit to the values at the Gauss points of an element. */
void LamFitBilinear(const PetscReal gauss[LAM_GAUSS], PetscReal c[4]);

#endif
