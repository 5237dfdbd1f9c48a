/* The step of an active set that differs in a few hats, from the factor of another one, is that of its own factor. */
#include "support/rve_fixture.h"
#include "solve.h"

typedef struct {
  LamRVE rve;
  LamRVEState state;
  LamLoad load;
  PetscReal *rhs, *first, *updated, *direct;
  PetscBool *before;
} System;

/* A contact state under pressure, assembled again a little beside its solution and factored with its own active set. */
static System NewSystem(void)
{
  LamMicrostructure micro = DefaultTissue();
  System s = {.load = PlaneLoad(1, 0.1, 0, 1, 0.18)};
  LamResponse response;
  PetscReal energy;
  PetscBool valid;

  micro.interface = LAM_INTERFACE_CONTACT;
  s.rve = NewRVE(&micro);
  assert_int_equal(LamRVEStateCreate(s.rve, &s.state), 0);
  assert_int_equal(LamRVESolve(s.rve, &s.load, s.state, &response), 0);
  assert_int_equal(response.status, LAM_CONVERGED);
  for (PetscInt i = 2; i < s.rve->ndof; i++) s.rve->y[i] += 1e-5 * sin((double)i);
  assert_int_equal(LamContactEvaluate(s.rve, &s.load, s.rve->y, PETSC_FALSE), 0);
  assert_int_equal(LamAssemble(s.rve, &s.load, s.rve->y, &energy, s.rve->residual, &valid), 0);
  assert_true(valid);
  LamContactAddCurvature(s.rve);
  assert_int_equal(PetscMalloc5(s.rve->linear->n, &s.rhs, s.rve->linear->n, &s.first, s.rve->linear->n, &s.updated,
                                s.rve->linear->n, &s.direct, s.rve->contact->count, &s.before),
                   0);
  return s;
}

static void Destroy(System *s)
{
  assert_int_equal(PetscFree5(s->rhs, s->first, s->updated, s->direct, s->before), 0);
  assert_int_equal(LamRVEStateDestroy(&s->state), 0);
  assert_int_equal(LamRVEDestroy(&s->rve), 0);
}

/* Factors the present active set and solves the step; returns the number of negative eigenvalues. */
static PetscInt Solve(System *s, PetscReal compliance, PetscReal solution[])
{
  const LamContact *contact = s->rve->contact;
  const PetscInt positions = s->rve->linear->positions;
  PetscInt negative;
  PetscBool ok;

  LamContactSetRows(s->rve, compliance);
  assert_int_equal(LamLinearFactor(s->rve->linear, LAM_CONTACT_PROXIMAL, &negative, &ok), 0);
  assert_true(ok);
  for (PetscInt i = 0; i < positions; i++) s->rhs[i] = -s->rve->residual[i + 2];
  for (PetscInt h = 0; h < contact->count; h++)
    s->rhs[positions + h] = contact->active[h] ? contact->gap[h] * contact->weight[h] : 0.0;
  assert_int_equal(LamLinearSolveOnce(s->rve->linear, 1, s->rhs, solution), 0);
  return negative;
}

/* Lets `dropped` active hats go and takes `taken` others in, both as they come. */
static void ChangeSet(const System *s, int dropped, int taken)
{
  const LamContact *contact = s->rve->contact;

  for (PetscInt h = 0; h < contact->count; h++) {
    const PetscInt j = h % contact->hats;

    if (s->before[h] && dropped > 0 && j > 3) {
      contact->active[h] = PETSC_FALSE;
      dropped--;
    } else if (!s->before[h] && taken > 0 && contact->weight[h] > 1e-3) {
      contact->active[h] = PETSC_TRUE;
      taken--;
    }
  }
  assert_int_equal(dropped, 0);
}

static void AssertUpdates(int dropped, int taken, PetscReal compliance)
{
  System s = NewSystem();
  const PetscInt n = s.rve->linear->n;
  PetscReal size;
  PetscBool ok;

  assert_int_equal(PetscArraycpy(s.before, s.rve->contact->active, s.rve->contact->count), 0);
  (void)Solve(&s, compliance, s.first);
  ChangeSet(&s, dropped, taken);
  assert_int_equal(LamContactUpdateStep(s.rve, s.before, s.first, compliance, s.updated, &ok), 0);
  assert_int_equal(ok, Solve(&s, compliance, s.direct) <= LamExpectedNegative(s.rve));
  size = LamLargestEntry(n, s.direct);
  for (PetscInt i = 0; i < n && ok; i++) assert_true(fabs(s.updated[i] - s.direct[i]) < 1e-8 * size);
  Destroy(&s);
}

TEST(HatsLetGo)
{
  AssertUpdates(1, 0, 0.0);
  AssertUpdates(4, 0, 0.0);
}

TEST(HatsTakenIn)
{
  AssertUpdates(0, 1, 0.0);
  AssertUpdates(0, 2, 0.0);
}

TEST_IS(BothWithCompliance, AssertUpdates(2, 1, 0.01));

TEST(TooManyChangesAreRefused)
{
  System s = NewSystem();
  PetscBool ok;

  assert_int_equal(PetscArraycpy(s.before, s.rve->contact->active, s.rve->contact->count), 0);
  (void)Solve(&s, 0.0, s.first);
  ChangeSet(&s, 9, 0);
  assert_int_equal(LamContactUpdateStep(s.rve, s.before, s.first, 0.0, s.updated, &ok), 0);
  assert_false(ok);
  Destroy(&s);
}
