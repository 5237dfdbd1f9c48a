/*
  Loads: straight paths, admissible loads in plane strain.
*/
#include "load.h"
#include <math.h>
#include <stdio.h>

LamLoad LamLoadBetween(const LamLoad *a, const LamLoad *b, PetscReal t)
{
  LamLoad load = *b;

  for (int i = 0; i < 9; i++) load.F[i] = (1 - t) * a->F[i] + t * b->F[i];
  load.turgor = (1 - t) * a->turgor + t * b->turgor;
  load.cohesion = (1 - t) * a->cohesion + t * b->cohesion;
  return load;
}

LamLoad LamLoadOfStrains(PetscReal first, PetscReal second, PetscReal angle, PetscReal turgor, PetscReal cohesion)
{
  const PetscReal e0 = exp(first), e1 = exp(second), c = cos(angle), s = sin(angle);
  const PetscReal U11 = c * c * e0 + s * s * e1, U12 = c * s * (e0 - e1), U22 = s * s * e0 + c * c * e1;

  return (LamLoad){.F = {U11, U12, 0, U12, U22, 0, 0, 0, 1}, .turgor = turgor, .cohesion = cohesion};
}

static PetscBool NoShear(const PetscReal F[9])
{
  return (PetscBool)(fabs(F[2]) <= LAM_ROUNDED_F && fabs(F[5]) <= LAM_ROUNDED_F && fabs(F[6]) <= LAM_ROUNDED_F &&
                     fabs(F[7]) <= LAM_ROUNDED_F);
}

void LamRoundToPlane(PetscReal F[9])
{
  if (NoShear(F)) F[2] = F[5] = F[6] = F[7] = 0;
}

PetscBool LamPlaneStrain(const PetscReal F[9])
{
  return (PetscBool)(NoShear(F) && fabs(F[8] - 1) <= LAM_ROUNDED_F);
}

PetscBool LamLoadValidateInPlane(const LamLoad *load, LamResponse *r)
{
  const PetscReal *F = load->F;
  PetscReal sum = load->turgor + load->cohesion, J;

  for (int i = 0; i < 9; i++) sum += F[i];
  J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  if (!isfinite(sum) || !(J > 0)) {
    r->status = LAM_INVALID_F;
    snprintf(r->reason, sizeof(r->reason), "det F = %g; a deformation gradient needs det F > 0", (double)J);
    return PETSC_FALSE;
  }
  if (NoShear(F)) return PETSC_TRUE;
  r->status = LAM_OUT_OF_REACH;
  snprintf(r->reason, sizeof(r->reason), "the records are of no out-of-plane shear; F13, F23, F31 and F32 must be 0");
  return PETSC_FALSE;
}

PetscBool LamLoadValidate(const LamLoad *load, LamResponse *r)
{
  if (!LamLoadValidateInPlane(load, r)) return PETSC_FALSE;
  if (LamPlaneStrain(load->F)) return PETSC_TRUE;
  r->status = LAM_OUT_OF_REACH;
  snprintf(r->reason, sizeof(r->reason), "F33 = %g; the records are of plane strain, and F33 must be 1",
           (double)load->F[8]);
  return PETSC_FALSE;
}
