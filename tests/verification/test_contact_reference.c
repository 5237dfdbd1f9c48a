/* Contact tissue against values of an independent mortar program (data/contact.json). */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"

#define DATA LAMELLA_SOURCE_DIR "/tests/verification/data/contact.json"
#define MESHES 2

static ContactReferenceCase cases[MESHES][CONTACT_CASES_MAX];
static int count;

static int SolveAll(void **state)
{
  static const int along[MESHES] = {12, 24};

  for (int m = 0; m < MESHES; m++)
    if (CompareContact(DATA, along[m], 4, &count, cases[m])) return 1;
  return 0;
}

/* Without turgor there are several discrete solutions: those values are not asserted. */
TEST(StressAgrees)
{
  for (int m = 0; m < MESHES; m++)
    for (int k = 0; k < count; k++)
      if (cases[m][k].turgor > 0.0) assert_near(cases[m][k].error, 0.0, cases[m][k].allowed);
}

TEST(LumenFractionAgrees)
{
  for (int m = 0; m < MESHES; m++)
    for (int k = 0; k < count; k++)
      if (cases[m][k].turgor > 0.0) assert_near(cases[m][k].lumen, 0.0, 1e-4);
}

TEST(DryStateIsAnswered)
{
  for (int k = 0; k < count; k++)
    if (cases[0][k].turgor == 0.0) assert_int_equal(cases[0][k].response.status, LAM_CONVERGED);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
