#include "cell_patch.h"
#include "support/tissue.h"
#include "tissue.h"

#define PATCH_ORIENTATION 30.0 /* cells stand on an edge */
LamMicrostructure PatchTissue(PetscInt columns, PetscInt rows, double orientation, LamInterfaceLawType interface)
{
  LamMicrostructure micro = DefaultTissue();

  micro.is_patch = PETSC_TRUE;
  micro.cells[0] = columns;
  micro.cells[1] = rows;
  micro.orientation = orientation * DEGREE;
  micro.interface = interface;
  return micro;
}

LamMicrostructure PaperPatch(PetscInt n)
{
  return PatchTissue(n, n, PATCH_ORIENTATION, LAM_INTERFACE_CONTACT);
}

PetscErrorCode PatchCreate(const LamMicrostructure *micro, LamStrategy strategy, LamRVE *rve, LamRVEState *state)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, rve));
  PetscCall(LamRVESetMicrostructure(*rve, micro));
  PetscCall(LamRVESetStrategy(*rve, strategy));
  PetscCall(LamRVESetUp(*rve));
  PetscCall(LamRVEStateCreate(*rve, state));
  PetscFunctionReturn(0);
}

static ContactState PatchState(const char *name, PetscInt columns, PetscInt rows, double orientation,
                               LamInterfaceLawType interface, LamPatchSides sides)
{
  ContactState state = {.name = name,
                        .micro = PatchTissue(columns, rows, orientation, interface),
                        .load = ContactLoad(1.02, 0.08, -0.03, 1.01, 0.02, 0),
                        .step = CONTACT_STEP_LARGE_RVE};

  state.load.F[8] = 1.01;
  state.micro.sides = sides;
  state.micro.along = 4;
  if (interface == LAM_INTERFACE_CONTACT) state.load.cohesion = 0.005 / TISSUE_STRESS;
  return state;
}

void ListPatchStates(ContactState list[PATCH_STATES])
{
  list[0] = PatchState("bonded", 2, 2, 30, LAM_INTERFACE_BONDED, LAM_SIDES_AFFINE);
  list[1] = PatchState("bonded, free sides", 2, 2, 0, LAM_INTERFACE_BONDED, LAM_SIDES_FREE);
  list[2] = PatchState("contact, on a corner", 2, 3, 0, LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE);
  list[3] = PatchState("contact, on an edge", 3, 2, 30, LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE);
  list[4] = PatchState("contact, free sides", 2, 3, 30, LAM_INTERFACE_CONTACT, LAM_SIDES_FREE);
}

PetscErrorCode BondedPatchErrors(double error[PATCH_SIZES], double *limit)
{
  const LamLoad load = ContactLoad(1.03, 0.1, -0.02, 1.01, 0.02, 0);
  LamMicrostructure micro = PatchTissue(1, 1, PATCH_ORIENTATION, LAM_INTERFACE_BONDED);
  LamResponse periodic, r;
  double last[9] = {0}, extrapolated[9] = {0};

  PetscFunctionBeginUser;
  micro.along = 4;
  micro.through = 1;
  micro.is_patch = PETSC_FALSE;
  PetscCall(SolveOnce(&micro, &load, &periodic));
  micro.is_patch = PETSC_TRUE;
  for (int k = 0; k < PATCH_SIZES; k++) {
    micro.cells[0] = micro.cells[1] = patch_sizes[k];
    PetscCall(SolveOnce(&micro, &load, &r));
    error[k] = StressError(r.P, periodic.P);
    for (int i = 0; i < 9; i++) {
      extrapolated[i] = 2.0 * r.P[i] - last[i]; /* sizes double */
      last[i] = r.P[i];
    }
  }
  *limit = StressError(extrapolated, periodic.P);
  PetscFunctionReturn(0);
}

PetscErrorCode SolvePatchStates(LamResponse list[PATCH_TURGORS][LAM_STRATEGY_COUNT])
{
  const LamMicrostructure micro = PaperPatch(3);

  PetscFunctionBeginUser;
  for (int strategy = 0; strategy < LAM_STRATEGY_COUNT; strategy++) {
    LamRVE rve;
    LamRVEState state;

    PetscCall(PatchCreate(&micro, (LamStrategy)strategy, &rve, &state));
    for (int p = 0; p < PATCH_TURGORS; p++) {
      const LamLoad load = ContactLoad(1, PATCH_SHEAR, 0, 1, patch_turgors[p], 0);

      PetscCall(LamRVEStateReset(rve, state));
      PetscCall(LamRVESolve(rve, &load, state, &list[p][strategy]));
    }
    PetscCall(DestroyTissue(&rve, &state));
  }
  PetscFunctionReturn(0);
}

double FirstAxis(const double moment[3])
{
  return 0.5 * atan2(2.0 * moment[2], moment[0] - moment[1]) / DEGREE;
}

double StretchAxis(double shear)
{
  return 0.5 * atan2(2.0, shear) / DEGREE;
}

double AngleBetweenAxes(double a, double b)
{
  const double angle = fabs(fmod(a - b, 180.0));

  return fmin(angle, 180.0 - angle);
}

PetscErrorCode GapWeightedNormals(LamRVE rve, LamRVEState state, double moment[3])
{
  PetscInt faces, points;
  double *from, *gap;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetInterfaceSize(rve, &faces, &points));
  PetscCall(PetscMalloc2(2 * faces * points, &from, faces * points, &gap));
  PetscCall(LamRVEGetInterface(rve, state, from, NULL, gap, NULL));
  moment[0] = moment[1] = moment[2] = 0.0;
  for (PetscInt k = 0; k < faces * points; k++) {
    const double *x = &from[2 * k];
    double chord[2], weight;

    if (k % points == points - 1 || !(gap[k] > 0.0)) continue; /* NaN: it faces no wall */
    for (int d = 0; d < 2; d++) chord[d] = x[2 + d] - x[d];
    weight = gap[k] / hypot(chord[0], chord[1]);
    moment[0] += weight * chord[1] * chord[1];
    moment[1] += weight * chord[0] * chord[0];
    moment[2] -= weight * chord[0] * chord[1];
  }
  PetscCall(PetscFree2(from, gap));
  PetscFunctionReturn(0);
}
