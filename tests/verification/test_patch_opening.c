/* slow: Fig. 9 of the source paper: empty cells come apart along the direction of the larger principal stretch. */
#include "rve_fixture.h"
#include "assert_near.h"
#include "figures_patch.h"

static void CellsComeApartAlongTheFirstPrincipalStretch(void **state)
{
  const LamMicrostructure micro = PaperPatch(6);
  const LamResponse r = SolveTissue(&micro, ContactLoad(1, PATCH_SHEAR, 0, 1, 0, 0));

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_near(AngleBetweenAxes(FirstAxis(r.opening_moment), StretchAxis(PATCH_SHEAR)), 0.0, 15.0);
}

static int Run(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(CellsComeApartAlongTheFirstPrincipalStretch),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv)
{
  return RunWithPetsc(argc, argv, Run);
}
