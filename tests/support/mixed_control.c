#include "mixed_control.h"
#include "tissue.h"

void MixedLoad(const MixedCase *c, const double before[9], LamLoad *load, LamStressControl *control)
{
  *load = PlaneLoad(c->F[0], c->F[1], c->F[2], c->F[3], c->turgor / TISSUE_STRESS);
  load->cohesion = c->cohesion / TISSUE_STRESS;
  load->F[8] = c->F33;
  *control = (LamStressControl){.P = {c->P[0], c->P[1], 0, c->P[2], c->P[3], 0, 0, 0, c->P33}};
  for (int i = 0; i < 9; i++) {
    control->P[i] /= TISSUE_STRESS;
    control->given[i] = (PetscBool)isnan(load->F[i]);
  }
  *load = LamLoadAfter(load, control, before);
}

PetscErrorCode SolveMixedCase(const MixedCase *c, MixedResult *result)
{
  static const double undeformed[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const LamMicrostructure micro = c->contact ? ContactTissue(6, 2) : DefaultTissue();
  LamRVEState state;
  LamStressControl control;
  LamLoad load;
  LamRVE rve;

  PetscFunctionBeginUser;
  MixedLoad(c, undeformed, &load, &control);
  PetscCall(NewTissue(&micro, &rve, &state));
  PetscCall(LamRVESolveMixed(rve, &load, &control, state, &result->mixed));
  PetscCall(LamRVEStateReset(rve, state));
  PetscCall(LamRVESolve(rve, &result->mixed.load, state, &result->plain));
  PetscCall(DestroyTissue(&rve, &state));
  result->stress = result->apart = 0.0;
  for (int i = 0; i < 9; i++) {
    if (control.given[i]) result->stress = fmax(result->stress, fabs(result->mixed.P[i] - control.P[i]));
    result->apart = fmax(result->apart, fabs(result->mixed.P[i] - result->plain.P[i]));
  }
  result->extra = (int)(result->mixed.factorisations - result->plain.factorisations);
  PetscFunctionReturn(0);
}
