#include "derivative_checks.h"
#include "tissue.h"

LamMicrostructure RandomTissue(uint64_t *seed)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall_thickness = RandomReal(seed, 0.06, 0.25);
  micro.orientation = RandomReal(seed, 0.0, 1.0);
  micro.grading = 0.7 * micro.orientation; /* any */
  return micro;
}

LamLoad RandomLoad(uint64_t *seed)
{
  LamLoad load = PlaneLoad(1, 0, 0, 1, 0);

  load.F[0] += RandomReal(seed, 0.0, 0.12);
  load.F[1] += RandomReal(seed, -0.12, 0.12);
  load.F[3] += RandomReal(seed, -0.12, 0.12);
  load.F[4] += RandomReal(seed, 0.0, 0.12);
  load.F[8] += RandomReal(seed, -0.02, 0.04);
  load.turgor = RandomReal(seed, 0.1, 0.4);
  return load;
}

static PetscErrorCode SweepColumn(LamRVE rve, LamRVEState centre, LamRVEState state, int column, Sweep *sweep)
{
  static const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
  const double h = 1e-3;

  PetscFunctionBeginUser;
  for (int k = 0; k < 4; k++) {
    LamLoad load = sweep->response.load;
    LamResponse moved;

    if (column == SWEEP_TURGOR)
      load.turgor += step[k] * h;
    else
      load.F[column] += step[k] * h;
    PetscCall(LamRVEStateCopy(centre, state));
    PetscCall(LamRVESolve(rve, &load, state, &moved));
    sweep->energy[column] += weight[k] * moved.energy / (12.0 * h);
    sweep->lumen[column] += weight[k] * moved.lumen_fraction / (12.0 * h);
    for (int i = 0; i < 9; i++) sweep->P[column][i] += weight[k] * moved.P[i] / (12.0 * h);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SweepLoads(const LamMicrostructure *micro, const LamLoad *load, Sweep *sweep)
{
  LamRVE rve;
  LamRVEState centre, state;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(sweep, sizeof(*sweep)));
  PetscCall(NewTissue(micro, &rve, &centre));
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(LamRVESolve(rve, load, centre, &sweep->response));
  for (int c = 0; c < 6; c++) PetscCall(SweepColumn(rve, centre, state, sweep_columns[c], sweep));
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(DestroyTissue(&rve, &centre));
  PetscFunctionReturn(0);
}
