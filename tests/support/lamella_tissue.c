#include "lamella_tissue.h"
#include "load.h"

LamMicrostructure LamellaTissue(double range)
{
  LamMicrostructure micro = DefaultTissue();

  micro.along = 4;
  micro.through = 1;
  micro.interface = LAM_INTERFACE_LAMELLA;
  micro.lamella.stiffness = 1000.0;
  micro.lamella.strength = micro.lamella.shear_strength = 0.2;
  micro.lamella.energy = micro.lamella.shear_energy = 0.5 * 0.2 * range;
  return micro;
}

PetscErrorCode SpecimenCreate(const LamMicrostructure *micro, Specimen *s)
{
  const LamLoad rest = PlaneLoad(1, 0, 0, 1, 0);

  PetscFunctionBeginUser;
  PetscCall(NewTissue(micro, &s->rve, &s->state));
  PetscCall(LamRVESetWanted(s->rve, (LamWanted)(LAM_WANT_ALL | LAM_WANT_JUMPS)));
  PetscCall(LamRVESolve(s->rve, &rest, s->state, &s->response));
  PetscFunctionReturn(0);
}

PetscErrorCode SpecimenDestroy(Specimen *s)
{
  return DestroyTissue(&s->rve, &s->state);
}

PetscErrorCode SpecimenFollow(Specimen *s, const LamLoad *to, int steps, double *work)
{
  const LamLoad from = s->response.load;

  PetscFunctionBeginUser;
  for (int k = 1; k <= steps; k++) {
    const LamLoad load = k == steps ? *to : LamLoadBetween(&from, to, (double)k / steps);
    const LamResponse before = s->response;

    PetscCall(LamRVESolve(s->rve, &load, s->state, &s->response));
    PetscCheck(s->response.status == LAM_CONVERGED, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "state %d of %d: %s", k,
               steps, s->response.reason);
    for (int i = 0; i < 9; i++) *work += 0.5 * (before.P[i] + s->response.P[i]) * (load.F[i] - before.load.F[i]);
    *work += 0.5 * (before.energy_turgor + s->response.energy_turgor) * (load.turgor - before.load.turgor);
  }
  PetscFunctionReturn(0);
}
