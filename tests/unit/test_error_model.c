/* The planner's error of a mesh, and the mesh that it takes for an accuracy. */
#include "support/rve_fixture.h"
#include "error_model.h"

static const LamErrorCase usual = {LAM_INTERFACE_BONDED, 0.15, 10, 0.2};

TEST(StrainIsThatOfTheStretchAlone)
{
  const double c = cos(0.7), s = sin(0.7), e = 0.1;
  const PetscReal turned[9] = {c, -s, 0, s, c, 0, 0, 0, 1}, stretched[9] = {exp(e), 0, 0, 0, exp(-2 * e), 0, 0, 0, 1};
  const PetscReal sheared[9] = {1, 0.2, 0, 0, 1, 0, 0, 0, 1};

  assert_near(LamStrainSize(turned), 0, 1e-15);
  assert_near(LamStrainSize(stretched), sqrt(5.0) * e, 1e-14);
  assert_near(LamStrainSize(sheared), sqrt(2.0) * asinh(0.1), 1e-14);
}

TEST(FinerMeshesHaveSmallerErrors)
{
  for (int i = 0; i < 2; i++) {
    LamErrorCase c = usual;

    c.interface = (LamInterfaceLawType)i;
    assert_true(LamErrorOfMesh(&c, 12, 2) < LamErrorOfMesh(&c, 6, 2));
    assert_true(LamErrorOfMesh(&c, 6, 4) < LamErrorOfMesh(&c, 6, 2));
  }
}

TEST(ChosenMeshMeetsTheAccuracyAndIsEven)
{
  static const double accuracy[4] = {0.1, 0.01, 0.005, 0.002};

  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 4; k++) {
      LamErrorCase c = usual;
      PetscInt along, through;
      PetscReal grading;

      c.interface = (LamInterfaceLawType)i;
      LamCheapestMesh(&c, accuracy[k], &along, &through, &grading);
      assert_true(LamErrorOfMesh(&c, along, through) <= accuracy[k]);
      assert_int_equal(along % 2, 0);
    }
}

/* What nothing meets gets the finest mesh, not an endless search. */
TEST(ImpossibleAccuracyGetsTheFinest)
{
  PetscInt along, through;
  PetscReal grading;

  LamCheapestMesh(&usual, 1e-12, &along, &through, &grading);
  assert_int_equal(along, 28);
}
