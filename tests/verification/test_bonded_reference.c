/* The bonded cell against values of independent programs, same mesh and law (data/bonded.json). */
#include "rve_fixture.h"
#include "figures_reference.h"

#define DATA LAMELLA_SOURCE_DIR "/tests/verification/data/bonded.json"

static ReferenceError errors[REFERENCE_CASES_MAX];
static int count;

static int SolveAll(void **state)
{
  return CompareWithReference(DATA, &count, errors) ? 1 : 0;
}

static void EnergyAgrees(void **state)
{
  for (int k = 0; k < count; k++) assert_true(errors[k].energy < 1e-9);
}

static void StressAgrees(void **state)
{
  for (int k = 0; k < count; k++) assert_true(errors[k].stress < 1e-9);
}

static void TangentAgrees(void **state)
{
  for (int k = 0; k < count; k++) assert_true(errors[k].tangent < 1e-8);
}

static void LumenFractionAgrees(void **state)
{
  for (int k = 0; k < count; k++) assert_true(errors[k].lumen < 1e-9);
}

/* FEBio 4, another element and a finer mesh: within 1.5 % in simple shear, where its own mesh error is 1 %, and within
   0.5 % in stretch. */
static void StressAgreesWithFEBio(void **state)
{
  double error[OTHERS_CASES];

  assert_int_equal(CompareWithOthers(DATA, error), 0);
  assert_true(error[0] < 0.015);
  assert_true(error[1] < 0.005);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(EnergyAgrees),        cmocka_unit_test(StressAgrees),          cmocka_unit_test(TangentAgrees),
      cmocka_unit_test(LumenFractionAgrees), cmocka_unit_test(StressAgreesWithFEBio),
  };
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, SolveAll, NULL);
  return PetscFinalize() || failed;
}
