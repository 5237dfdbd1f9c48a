/* The mesh that the planner takes, against the errors of a much finer one at loads that it has not tried. */
#include "support/rve_fixture.h"
#include "mesh_choice.h"

static LamScene Scene(LamInterfaceLawType interface, PetscReal accuracy, PetscInt count, LamLoad loads[])
{
  LamScene scene = {.micro = DefaultTissue(), .accuracy = accuracy, .load_count = count, .loads = loads};

  scene.micro.interface = interface;
  scene.micro.along = scene.micro.through = 0;
  scene.micro.grading = -1;
  return scene;
}

/* States of a shear with turgor. */
static void Shear(PetscInt n, LamLoad loads[])
{
  for (PetscInt k = 0; k < n; k++) loads[k] = PlaneLoad(1, 0.3 * (double)(k + 1) / (double)n, 0, 1, 0.2);
}

static PetscReal Unknowns(const LamMicrostructure *micro)
{
  return (PetscReal)(micro->along * micro->through);
}

#define STATES 5

static void ErrorsAreBelow(LamInterfaceLawType interface, PetscReal accuracy)
{
  LamLoad loads[STATES];
  LamScene scene = Scene(interface, accuracy, STATES, loads);
  LamMicrostructure fine;
  LamMeshTrial trial;

  Shear(STATES, loads);
  assert_int_equal(LamChooseMesh(&scene, &trial), 0);
  assert_true(trial.tried && trial.loads >= 3 && trial.error <= accuracy);
  fine = scene.micro;
  fine.along = 24;
  fine.through = 4;
  for (int k = 0; k < STATES; k++) {
    const LamResponse r = SolveTissue(&scene.micro, loads[k]), truth = SolveTissue(&fine, loads[k]);

    assert_true(LamStressError(LamStressScaleOf(&fine), r.P, truth.P) <= accuracy);
  }
}

TEST_IS(BondedErrorsAreBelowTheAccuracy, ErrorsAreBelow(LAM_INTERFACE_BONDED, 0.01));
TEST_IS(ContactErrorsAreBelowTheAccuracy, ErrorsAreBelow(LAM_INTERFACE_CONTACT, 0.02));

TEST(SmallerAccuracyTakesFinerMeshes)
{
  static const PetscReal accuracy[] = {0.05, 0.005};
  PetscReal last = 0;

  for (int k = 0; k < 2; k++) {
    LamLoad loads[2];
    LamScene scene = Scene(LAM_INTERFACE_BONDED, accuracy[k], 2, loads);

    Shear(2, loads);
    assert_int_equal(LamChooseMesh(&scene, NULL), 0);
    assert_true(Unknowns(&scene.micro) > last);
    last = Unknowns(&scene.micro);
  }
}

/* What nothing reaches gets the finest mesh and its error, not an endless search. */
TEST(ImpossibleAccuracyGetsTheFinest)
{
  LamLoad loads[1];
  LamScene scene = Scene(LAM_INTERFACE_BONDED, 1e-9, 1, loads);
  LamMeshTrial trial;

  Shear(1, loads);
  assert_int_equal(LamChooseMesh(&scene, &trial), 0);
  assert_int_equal(trial.along, 28);
  assert_true(trial.error > 1e-9 && trial.error < 1e-3);
}

/* A load that inverts tissue has no solution on any mesh. */
TEST(LoadsWithoutSolutionPromiseNothing)
{
  LamLoad loads[1] = {PlaneLoad(0.3, 0, 0, 0.3, 0)};
  LamScene scene = Scene(LAM_INTERFACE_BONDED, 0.01, 1, loads);
  LamMeshTrial trial;

  assert_int_equal(LamChooseMesh(&scene, &trial), 0);
  assert_true(trial.tried && !trial.loads && isnan(trial.error) && scene.micro.along > 0);
}

TEST(GivenMeshIsNotTried)
{
  LamScene scene = Scene(LAM_INTERFACE_BONDED, 0.01, 0, NULL);
  LamMeshTrial trial;

  scene.micro.along = 5;
  scene.micro.through = 1;
  assert_int_equal(LamChooseMesh(&scene, &trial), 0);
  assert_true(!trial.tried && scene.micro.along == 5 && scene.micro.grading == 0);
}
