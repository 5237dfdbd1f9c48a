#include "tissue.h"

LamMicrostructure DefaultTissue(void)
{
  LamMicrostructure micro = {.wall_thickness = 0.15, .cells = {1, 1}, .along = 6, .through = 2};

  micro.wall.C1 = 0.1 / TISSUE_STRESS;
  micro.wall.C2 = 0.01 / TISSUE_STRESS;
  micro.wall.C4 = 1.0 / TISSUE_STRESS;
  micro.wall.bulk_modulus = 1000.0;
  micro.lamella = LAM_LAMELLA_UNIFORM; /* of law `lamella`; a program sets its own */
  micro.lamella.stiffness = 5000.0;
  micro.lamella.strength = micro.lamella.shear_strength = 0.2;
  micro.lamella.energy = micro.lamella.shear_energy = 0.05;
  return micro;
}

PetscReal StressError(const PetscReal P[9], const PetscReal P_ref[9])
{
  const LamMicrostructure micro = DefaultTissue();

  return LamStressError(LamStressScaleOf(&micro), P, P_ref);
}

LamLoad PlaneLoad(double F11, double F12, double F21, double F22, double turgor)
{
  LamLoad load = {.F = {F11, F12, 0, F21, F22, 0, 0, 0, 1}, .turgor = turgor};

  return load;
}

LamMicrostructure TissueLeft(LamMicrostructure micro, double left)
{
  const double bulk = micro.wall.bulk_modulus;

  LamWallScale(&micro.wall, left, 1.0);
  micro.wall.bulk_modulus = bulk;
  return micro;
}

LamLoad StretchedLoad(void)
{
  LamLoad load = PlaneLoad(1.06, 0.08, -0.02, 1.01, 0.3);

  load.F[8] = 1.03;
  return load;
}

PetscErrorCode NewTissue(const LamMicrostructure *micro, LamRVE *rve, LamRVEState *state)
{
  return NewSealableTissue(micro, PETSC_FALSE, rve, state);
}

PetscErrorCode NewSealableTissue(const LamMicrostructure *micro, PetscBool sealable, LamRVE *rve, LamRVEState *state)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, rve));
  PetscCall(LamRVESetMicrostructure(*rve, micro));
  PetscCall(LamRVESetSealable(*rve, sealable));
  PetscCall(LamRVESetUp(*rve));
  if (state) PetscCall(LamRVEStateCreate(*rve, state));
  PetscFunctionReturn(0);
}

PetscErrorCode DestroyTissue(LamRVE *rve, LamRVEState *state)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(state));
  PetscCall(LamRVEDestroy(rve));
  PetscFunctionReturn(0);
}

PetscErrorCode SolveOnce(const LamMicrostructure *micro, const LamLoad *load, LamResponse *response)
{
  LamRVE rve;
  LamRVEState state;

  PetscFunctionBeginUser;
  PetscCall(NewTissue(micro, &rve, &state));
  PetscCall(LamRVESolve(rve, load, state, response));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}
