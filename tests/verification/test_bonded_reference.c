/* The bonded cell against values of independent programs, same mesh and law (data/bonded.json). */
#include "support/rve_fixture.h"
#include "support/reference_values.h"

#define DATA LAMELLA_SOURCE_DIR "/tests/verification/data/bonded.json"

static ReferenceError errors[REFERENCE_CASES_MAX];
static int count;

static int SolveAll(void **state)
{
  return CompareWithReference(DATA, &count, errors) ? 1 : 0;
}

#define AGREES(name, member, bound) TEST_IS(name, for (int k = 0; k < count; k++) assert_true(errors[k].member < bound))
AGREES(EnergyAgrees, energy, 1e-9);
AGREES(StressAgrees, stress, 1e-9);
AGREES(TangentAgrees, tangent, 1e-8);
AGREES(LumenFractionAgrees, lumen, 1e-9);

/* FEBio 4, another element and a finer mesh: within 1.5 % in simple shear, where its own mesh error is 1 %, and within
   0.5 % in stretch. */
TEST(StressAgreesWithFEBio)
{
  double error[OTHERS_CASES];

  assert_int_equal(CompareWithOthers(DATA, error), 0);
  assert_true(error[0] < 0.015);
  assert_true(error[1] < 0.005);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
