/* States that follow each other by small and large increments: what the test asserts and the bench program prints. */
#ifndef LAM_FIGURES_INCREMENTS_H
#define LAM_FIGURES_INCREMENTS_H

#include <math.h>
#include "solve.h"
#include "tissue.h"

#define INCREMENT_WATER (2200.0 / TISSUE_STRESS) /* bulk modulus of water, C1 + C2 */

#define INCREMENT_KINDS(X)                                                                                             \
  X(INCREMENT_BONDED, "bonded")                                                                                        \
  X(INCREMENT_DRY, "bonded, dry")                                                                                      \
  X(INCREMENT_SEALED, "bonded, sealed")                                                                                \
  X(INCREMENT_MIXED, "bonded, mixed control")                                                                          \
  X(INCREMENT_CONTACT, "contact")                                                                                      \
  X(INCREMENT_CONTACT_SEALED, "contact, sealed")                                                                       \
  X(INCREMENT_CONTACT_MIXED, "contact, mixed control")
typedef enum { INCREMENT_KINDS(LAM_ENUM_ENTRY) INCREMENT_KIND_COUNT } IncrementKind;
static const char *const increment_names[] = {INCREMENT_KINDS(LAM_NAME_ENTRY)};

/* A tissue in a state from which increments start. */
typedef struct {
  IncrementKind kind;
  LamRVE rve;
  LamRVEState base, state;
  LamStressControl control; /* gives nothing where F is prescribed */
  LamResponse at;           /* the base */
} IncrementTissue;

static inline PetscBool IncrementIsContact(IncrementKind kind)
{
  return (PetscBool)(kind >= INCREMENT_CONTACT);
}

static inline PetscErrorCode IncrementSeal(IncrementTissue *t, const LamLoad *load)
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

static inline PetscErrorCode IncrementCreate(IncrementKind kind, IncrementTissue *t)
{
  const PetscBool sealed = (PetscBool)(kind == INCREMENT_SEALED || kind == INCREMENT_CONTACT_SEALED);
  const PetscBool mixed = (PetscBool)(kind == INCREMENT_MIXED || kind == INCREMENT_CONTACT_MIXED);
  LamLoad load = PlaneLoad(1.01, 0.08, 0.01, 1.02, kind == INCREMENT_DRY ? 0.0 : 0.2);
  LamMicrostructure micro = DefaultTissue();

  PetscFunctionBeginUser;
  *t = (IncrementTissue){.kind = kind};
  if (IncrementIsContact(kind)) micro.interface = LAM_INTERFACE_CONTACT;
  if (IncrementIsContact(kind)) load.cohesion = 0.05;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &t->rve));
  PetscCall(LamRVESetMicrostructure(t->rve, &micro));
  PetscCall(LamRVESetSealable(t->rve, sealed));
  PetscCall(LamRVESetUp(t->rve));
  PetscCall(LamRVEStateCreate(t->rve, &t->base));
  PetscCall(LamRVEStateCreate(t->rve, &t->state));
  if (sealed) PetscCall(IncrementSeal(t, &load));
  PetscCall(LamRVESolve(t->rve, &load, t->base, &t->at));
  if (mixed) { /* from here on the normal stresses are prescribed */
    t->control = (LamStressControl){.given = {1, 0, 0, 0, 1, 0, 0, 0, 0}};
    PetscCall(PetscArraycpy(t->control.P, t->at.P, 9));
    PetscCall(LamRVESolveMixed(t->rve, &load, &t->control, t->base, &t->at));
  }
  PetscFunctionReturn(0);
}

static inline PetscErrorCode IncrementDestroy(IncrementTissue *t)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&t->base));
  PetscCall(LamRVEStateDestroy(&t->state));
  PetscCall(LamRVEDestroy(&t->rve));
  PetscFunctionReturn(0);
}

/* Direction of the increments of F, or of P where that is prescribed; of length 1. */
static const double increment_direction[9] = {0.2, 0.8, 0, -0.4, 0.4, 0, 0, 0, 0};

/* From t->state to the base moved by h along the direction. */
static inline PetscErrorCode IncrementSolve(IncrementTissue *t, double h, LamResponse *response)
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

/* |P1 - P0 - A dF| in C1 + C2, A the mean of the two tangents, dF between the loads as they are rounded; *size: |A dF|.
 */
static inline double IncrementError(const LamResponse *from, const LamResponse *to, double *size)
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

#define INCREMENT_STEPS 10

typedef struct {
  PetscInt solved;
  PetscInt iterations, factorisations; /* most of a step */
  PetscInt fewest;                     /* iterations of a step */
  double error, size;                  /* largest of a step: |P1 - P0 - A dF|, |A dF|, C1 + C2 */
  double stress;                       /* |P - prescribed P|, largest */
  double seconds;                      /* all of them */
} IncrementWalk;

/* INCREMENT_STEPS steps of h, one after the other. */
static inline PetscErrorCode IncrementWalkBy(IncrementTissue *t, double h, IncrementWalk *walk)
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

typedef struct {
  const char *name;
  double F[4];
} LargeStep;

static const LargeStep large_steps[] = {
    {"shear 0.5", {1, 0.5, 0, 1}},
    {"shear 1", {1, 1, 0, 1}},
    {"shear 2", {1, 2, 0, 1}},
    {"shear 3", {1, 3, 0, 1}},
    {"log strain 1 along 1", {2.718281828459045, 0, 0, 1}},
    {"log strain 0.5 along both", {1.6487212707001282, 0, 0, 1.6487212707001282}},
    {"log strain 1, -0.5", {2.718281828459045, 0, 0, 0.6065306597126334}},
    {"log strain -0.5 along 2", {1, 0, 0, 0.6065306597126334}},
    {"log strain -0.25 along both", {0.7788007830714049, 0, 0, 0.7788007830714049}},
};
#define LARGE_STEPS ((int)PETSC_STATIC_ARRAY_LENGTH(large_steps))

typedef struct {
  LamResponse once, small; /* in one go; in `steps`, the last one that was solved */
  int steps, failed;       /* failed: the step at which the small ones ended, 0: none */
  double small_seconds;
  PetscInt small_iterations;
  double apart; /* LamStressError between the two */
} LargeResult;

static inline PetscErrorCode LargeStepSolve(LamRVE rve, const LargeStep *step, double turgor, int steps, LargeResult *l)
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
  l->apart = LamStressError(l->once.P, l->small.P);
  PetscCall(LamRVEStateDestroy(&state));
  PetscFunctionReturn(0);
}

#endif
