#include "relaxation.h"

#define SERIES 1e-3 /* x below which series are used: both errors are then below 1e-9 of the values */

LamMemoryStep LamMemoryStepOf(const LamRelaxation *relaxation, PetscReal duration)
{
  LamMemoryStep step = {.terms = relaxation->terms, .scale = 1.0};

  for (PetscInt i = 0; i < step.terms; ++i) {
    const PetscReal x = duration / relaxation->time[i], gone = -expm1(-x);
    const PetscReal phi = x > 0.0 ? gone / x : 1.0;

    step.share[i] = relaxation->share[i];
    step.decay[i] = PetscExpReal(-x);
    step.phi[i] = phi;
    step.psi[i] = x > SERIES ? (1.0 - phi) / x : 0.5 - x / 6.0 + x * x / 24.0;
    step.loss[i][0] = gone * (1.0 - 0.5 * gone);
    step.loss[i][1] = 0.5 * phi * gone;
    step.loss[i][2] = x > SERIES ? (1.0 - phi - 0.5 * phi * gone) / x : x * (1.0 / 3.0 - x * (0.25 - x * 7.0 / 60.0));
    step.scale -= step.share[i] * (1.0 - phi);
  }
  return step;
}
