/* Large meshes start from the solution of a coarser one, and give what they give from elsewhere. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"
#include <string.h>

enum { ALONG = 36, THROUGH = 10 }; /* 2,160 elements: large enough */

static LamMicrostructure Tissue(LamInterfaceLawType interface)
{
  LamMicrostructure micro = ContactTissue(ALONG, THROUGH);

  micro.interface = interface;
  return micro;
}

/* By way of another state, from which the solve at the load starts: it is a state before, so no coarser mesh is. */
static LamResponse SolveInTwoSteps(const LamMicrostructure *micro, LamLoad first, LamLoad load)
{
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(micro);
  LamResponse response;
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);

  assert_int_equal(LamRVESolve(rve, &first, state, &response), 0);
  assert_int_equal(response.status, LAM_CONVERGED);
  assert_int_equal(LamRVESolve(rve, &load, state, &response), 0);
  return response;
}

static void AssertSameAnswer(LamInterfaceLawType interface, double tolerance)
{
  const LamMicrostructure micro = Tissue(interface);
  const LamLoad load = ContactLoad(1, 0.15, 0, 1.05, 0.02, 0.005);
  const LamResponse nested = SolveTissue(&micro, load);
  const LamResponse other = SolveInTwoSteps(&micro, ContactLoad(1, 0.1, 0, 1.05, 0.02, 0.005), load);

  assert_int_equal(nested.status, LAM_CONVERGED);
  assert_int_equal(other.status, LAM_CONVERGED);
  for (int i = 0; i < 9; i++) assert_near(nested.P[i], other.P[i], tolerance);
  assert_near(nested.energy, other.energy, tolerance);
}

TEST_IS(BondedTissueHasTheSameAnswer, AssertSameAnswer(LAM_INTERFACE_BONDED, 1e-9));

/* To what the hysteresis of the junction status leaves open. */
TEST_IS(ContactTissueHasTheSameAnswer, AssertSameAnswer(LAM_INTERFACE_CONTACT, 1e-4));

TEST(FewIterationsAreLeftForTheFineMesh)
{
  const LamMicrostructure micro = Tissue(LAM_INTERFACE_BONDED);

  assert_in_range(SolveTissue(&micro, PlaneLoad(1, 0.1, 0, 1, 0.02)).newton_iterations, 1, 5);
}

TEST(ReasonNamesTheMeshThatItIsOf)
{
  const LamMicrostructure micro = Tissue(LAM_INTERFACE_BONDED);
  const LamResponse r = SolveTissue(&micro, PlaneLoad(0.7, 0, 0, 1.4, -0.2));

  assert_int_equal(r.status, LAM_NO_EQUILIBRIUM);
  assert_non_null(strstr(r.reason, "on 18 x 5 elements: the lumen of cell 0 collapses between"));
}
