#include "load_increments.h"
#include "support/tissue.h"
#include "tissue.h"

#define INCREMENT_WATER (2200.0 / TISSUE_STRESS)
static PetscBool IncrementIsContact(IncrementKind kind)
{
  return (PetscBool)(kind >= INCREMENT_CONTACT);
}

static PetscErrorCode IncrementSeal(IncrementTissue *t, const LamLoad *load)
{
  LamLoad start = *load;
  PetscReal water[1];

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++) start.F[i] = i % 4 == 0;
  PetscCall(LamRVESolve(t->rve, &start, t->base, &t->at));
  PetscCall(LamRVEGetLumens(t->rve, t->base, water));
  PetscCall(LamRVESeal(t->rve, INCREMENT_WATER, water));
  PetscFunctionReturn(0);
}

PetscErrorCode IncrementCreate(IncrementKind kind, IncrementTissue *t)
{
  const PetscBool sealed = (PetscBool)(kind == INCREMENT_SEALED || kind == INCREMENT_CONTACT_SEALED);
  const PetscBool mixed = (PetscBool)(kind == INCREMENT_MIXED || kind == INCREMENT_CONTACT_MIXED);
  LamLoad load = PlaneLoad(1.01, 0.08, 0.01, 1.02, kind == INCREMENT_DRY ? 0.0 : 0.2);
  LamMicrostructure micro = DefaultTissue();

  PetscFunctionBeginUser;
  *t = (IncrementTissue){.kind = kind};
  if (IncrementIsContact(kind)) micro.interface = LAM_INTERFACE_CONTACT;
  if (IncrementIsContact(kind)) load.cohesion = 0.05;
  PetscCall(NewSealableTissue(&micro, sealed, &t->rve, &t->state));
  PetscCall(LamRVEStateCreate(t->rve, &t->base));
  if (sealed) PetscCall(IncrementSeal(t, &load));
  PetscCall(LamRVESolve(t->rve, &load, t->base, &t->at));
  if (mixed) { /* from here on the normal stresses are prescribed */
    t->control = (LamStressControl){.given = {1, 0, 0, 0, 1, 0, 0, 0, 0}};
    PetscCall(PetscArraycpy(t->control.P, t->at.P, 9));
    PetscCall(LamRVESolveMixed(t->rve, &load, &t->control, t->base, &t->at));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode IncrementDestroy(IncrementTissue *t)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&t->base));
  PetscCall(DestroyTissue(&t->rve, &t->state));
  PetscFunctionReturn(0);
}

/* Direction of the increments of F, or of P where that is prescribed; of length 1. */
static const double increment_direction[9] = {0.2, 0.8, 0, -0.4, 0.4, 0, 0, 0, 0};

/* From t->state to the base moved by h along the direction. */
static PetscErrorCode IncrementSolve(IncrementTissue *t, double h, LamResponse *response)
{
  LamStressControl control = t->control;
  LamLoad load = t->at.load;

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++)
    if (control.given[i]) {
      control.P[i] += h * increment_direction[i];
      load.F[i] = t->state->load.F[i];
    } else {
      load.F[i] += h * increment_direction[i];
    }
  PetscCall(LamRVESolveMixed(t->rve, &load, &control, t->state, response));
  PetscFunctionReturn(0);
}

/* |P1 - P0 - A dF| in C1 + C2, A the mean of the two tangents, dF between the rounded loads; *size: |A dF|. */
static double IncrementError(const LamResponse *from, const LamResponse *to, double *size)
{
  static const int in_plane[4] = {0, 1, 3, 4};
  double error = 0;

  *size = 0;
  for (int a = 0; a < 4; a++) {
    const int i = in_plane[a];
    double predicted = 0;

    for (int b = 0; b < 4; b++) {
      const int k = in_plane[b];

      predicted += 0.5 * (from->tangent[9 * i + k] + to->tangent[9 * i + k]) * (to->load.F[k] - from->load.F[k]);
    }
    error += PetscSqr(to->P[i] - from->P[i] - predicted);
    *size += PetscSqr(predicted);
  }
  *size = sqrt(*size);
  return sqrt(error);
}

PetscErrorCode IncrementWalkBy(IncrementTissue *t, double h, IncrementWalk *walk)
{
  LamResponse last = t->at, r;

  PetscFunctionBeginUser;
  *walk = (IncrementWalk){.fewest = PETSC_MAX_INT};
  PetscCall(LamRVEStateCopy(t->base, t->state));
  for (int k = 1; k <= INCREMENT_STEPS; k++) {
    double error, size;

    PetscCall(IncrementSolve(t, h * k, &r));
    if (r.status == LAM_CONVERGED) ++walk->solved;
    error = IncrementError(&last, &r, &size);
    walk->error = PetscMax(walk->error, error);
    walk->size = PetscMax(walk->size, size);
    for (int i = 0; i < 9; i++)
      if (t->control.given[i])
        walk->stress = PetscMax(walk->stress, PetscAbsReal(r.P[i] - t->control.P[i] - h * k * increment_direction[i]));
    walk->iterations = PetscMax(walk->iterations, r.newton_iterations);
    walk->fewest = PetscMin(walk->fewest, r.newton_iterations);
    walk->factorisations = PetscMax(walk->factorisations, r.factorisations);
    walk->seconds += r.seconds;
    last = r;
  }
  PetscFunctionReturn(0);
}

/* ---- steps that are too large ---- */

PetscErrorCode LargeStepSolve(LamRVE rve, const LargeStep *step, double turgor, int steps, LargeResult *l)
{
  const LamLoad to = PlaneLoad(step->F[0], step->F[1], step->F[2], step->F[3], turgor);
  LamRVEState state;

  PetscFunctionBeginUser;
  *l = (LargeResult){.steps = steps};
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(LamRVESolve(rve, &to, state, &l->once));
  PetscCall(LamRVEStateReset(rve, state));
  for (int k = 1; k <= steps && !l->failed; k++) {
    const double s = (double)k / steps;
    const LamLoad load =
        PlaneLoad(1 + s * (step->F[0] - 1), s * step->F[1], s * step->F[2], 1 + s * (step->F[3] - 1), turgor);

    PetscCall(LamRVESolve(rve, &load, state, &l->small));
    l->small_seconds += l->small.seconds;
    l->small_iterations += l->small.newton_iterations;
    if (l->small.status != LAM_CONVERGED) l->failed = k;
  }
  l->apart = StressError(l->once.P, l->small.P);
  PetscCall(LamRVEStateDestroy(&state));
  PetscFunctionReturn(0);
}
