/* slow: Fig. 9 of the source paper: empty cells come apart along the direction of the larger principal stretch. */
#include "support/rve_fixture.h"
#include "support/cell_patch.h"

TEST(CellsComeApartAlongTheFirstPrincipalStretch)
{
  const LamMicrostructure micro = PaperPatch(6);
  const LamResponse r = SolveTissue(&micro, ContactLoad(1, PATCH_SHEAR, 0, 1, 0, 0));

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_near(AngleBetweenAxes(FirstAxis(r.opening_moment), StretchAxis(PATCH_SHEAR)), 0.0, 15.0);
}
