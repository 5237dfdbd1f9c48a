/* Figures of patches between grips that the tests assert and the bench program prints: the block of Section 4.2 of the
   source paper in simple shear, by both strategies, and the directions in which its cells come apart. Turgor and
   cohesion in MPa, angles in degrees. */
#ifndef LAM_SUPPORT_CELL_PATCH_H
#define LAM_SUPPORT_CELL_PATCH_H

#include "contact_tissue.h"

#define DEGREE (PETSC_PI / 180.0)
#define PATCH_SHEAR 0.2
#define PATCH_TURGORS 5
static const double patch_turgors[PATCH_TURGORS] = {0, 0.01, 0.05, 0.1, 0.3};

LamMicrostructure PatchTissue(PetscInt columns, PetscInt rows, double orientation, LamInterfaceLawType interface);
/* n x n cells in contact, as in the paper. */
LamMicrostructure PaperPatch(PetscInt n);
PetscErrorCode PatchCreate(const LamMicrostructure *micro, LamStrategy strategy, LamRVE *rve, LamRVEState *state);

/* ---- derivatives ---- */

#define PATCH_STATES 5
void ListPatchStates(ContactState list[PATCH_STATES]);

/* ---- the limit of many cells ---- */

#define PATCH_SIZES 3
static const int patch_sizes[PATCH_SIZES] = {2, 4, 8};

/* Errors of the stress of bonded n x n cells under turgor against the periodic tissue, on a coarse mesh; *limit: of the
   extrapolation in 1/n from the last two. */
PetscErrorCode BondedPatchErrors(double error[PATCH_SIZES], double *limit);

/* ---- Section 4.2 of the source paper ---- */

/* The states of 3 x 3 cells by both strategies, each from F = I in one go. */
PetscErrorCode SolvePatchStates(LamResponse list[PATCH_TURGORS][LAM_STRATEGY_COUNT]);
/* First axis of a symmetric tensor 11, 22, 12, from X1. */
double FirstAxis(const double moment[3]);
/* Of the larger principal stretch in simple shear: tan 2 theta = 2/shear. */
double StretchAxis(double shear);
/* Between two axes, which have no sign. */
double AngleBetweenAxes(double a, double b);
/* Second moment n(x)n of the normals of a state's interfaces, weighted with the gap: 11, 22, 12. */
PetscErrorCode GapWeightedNormals(LamRVE rve, LamRVEState state, double moment[3]);

#endif
