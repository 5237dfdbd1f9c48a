#include "effective_stress.h"

void EffectiveStress(const LamResponse *r, double S[9])
{
  const double *F = r->load.F, p = r->load.turgor;
  const double cofactor[9] = {F[4], -F[3], 0, -F[1], F[0], 0, 0, 0, F[0] * F[4] - F[1] * F[3]};

  for (int i = 0; i < 9; i++) S[i] = r->P[i] + p * cofactor[i];
}

PetscErrorCode EffectiveStressRemainder(double bulk_modulus, double *remainder)
{
  const double p = 0.05 / TISSUE_STRESS;
  const LamLoad loads[3] = {PlaneLoad(1, 0.2, 0, 1, p), PlaneLoad(1.1, 0.05, 0, 1.05, p),
                            PlaneLoad(1.15, 0, 0.1, 0.98, p)};
  LamMicrostructure micro = DefaultTissue();

  PetscFunctionBeginUser;
  micro.wall.bulk_modulus = bulk_modulus;
  *remainder = 0.0;
  for (int k = 0; k < 3; k++) {
    LamLoad dry = loads[k];
    LamResponse wet_response, dry_response;
    double wet[9], reference[9], difference = 0.0, norm = 0.0;

    dry.turgor = 0.0;
    PetscCall(SolveOnce(&micro, &loads[k], &wet_response));
    PetscCall(SolveOnce(&micro, &dry, &dry_response));
    EffectiveStress(&wet_response, wet);
    EffectiveStress(&dry_response, reference);
    for (int i = 0; i < 9; i++) {
      difference += (wet[i] - reference[i]) * (wet[i] - reference[i]);
      norm += reference[i] * reference[i];
    }
    *remainder = PetscMax(*remainder, PetscSqrtReal(difference / norm));
  }
  PetscFunctionReturn(0);
}
