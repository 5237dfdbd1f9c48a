/*
  Ellipticity of the tissue at the material points of a converged state. Where it is lost, the body localises in bands
  as narrow as its elements.

  With sealed cells the tangent includes their water. The water at each point is constant, so the tangent in a band is
    A - dP/dp (x) dP/dp / (w' + d2Psi/dp2),   w' = -v/K_w (sealed.c),
  (condensed pressure).

  An interpolated tangent has an error dA, and the least value of n m A n m over unit vectors one of at most |dA|: a
  point counts as localised where that value is below 0 by more than the estimate of |dA|.
*/
#include <lamella/ellipticity.h>
#include <math.h>
#include "macro_impl.h"

static void PointTangent(LamMacro macro, PetscInt p, PetscReal A[16])
{
  const LamMacroSeal *seal = macro->seal;

  for (int i = 0; i < 16; i++) A[i] = macro->accepted[p].A[macro->strains * (i / 4) + i % 4];
  if (!seal || !seal->closed) return;
  const LamSealedPoint *sealed = &seal->accepted[p];
  const PetscReal share = -1 / (LamMacroWaterSlope(macro, p) + sealed->curvature);

  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) A[4 * i + j] += share * sealed->P_turgor[i] * sealed->P_turgor[j];
}

static PetscReal Size(const PetscReal A[16])
{
  PetscReal sum = 0;

  for (int i = 0; i < 16; i++) sum += A[i] * A[i];
  return PetscSqrtReal(sum);
}

/* Reduces to the smallest value of all ranks (among equal ones that of the lowest rank), with its normal and location.
 */
static PetscErrorCode Share(LamMacro macro, LamMacroStep *step)
{
  PetscReal found[5] = {step->ellipticity, step->localisation_normal[0], step->localisation_normal[1],
                        step->localisation_place[0], step->localisation_place[1]};
  PetscMPIInt rank = 0;
  PetscBool mine = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(LamMacroFindRank(macro, isnan(found[0]) ? INFINITY : found[0], &rank, &mine));
  PetscCallMPI(MPI_Bcast(found, 5, MPIU_REAL, rank, macro->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &step->localised_points, 1, MPIU_INT, MPI_SUM, macro->comm));
  step->ellipticity = found[0];
  for (int i = 0; i < 2; i++) {
    step->localisation_normal[i] = found[1 + i];
    step->localisation_place[i] = found[3 + i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFindLocalisation(LamMacro macro, LamMacroStep *step)
{
  PetscFunctionBeginUser;
  PetscAssert(macro->dim == 2, PETSC_COMM_SELF, PETSC_ERR_PLIB, "bands are those of a plane");
  step->ellipticity = step->localisation_normal[0] = step->localisation_normal[1] = NAN;
  step->localisation_place[0] = step->localisation_place[1] = NAN;
  step->localised_points = 0;
  for (PetscInt p = 0; p < macro->point_count; p++) {
    LamBand band = {.value = NAN};
    PetscReal A[16];

    PointTangent(macro, p, A);
    if (macro->accepted[p].known) LamBandFind(A, &band);
    macro->accepted[p].field[LAM_POINT_ELLIPTICITY] = band.value;
    if (LamEllipticityIsLost(band.value + macro->accepted[p].tangent_error * Size(A))) step->localised_points++;
    if (isnan(band.value) || band.value >= step->ellipticity) continue;
    step->ellipticity = band.value;
    for (int i = 0; i < 2; i++) {
      step->localisation_normal[i] = band.normal[i];
      step->localisation_place[i] = macro->place[macro->dim * p + i];
    }
  }
  PetscCall(Share(macro, step));
  PetscFunctionReturn(0);
}
