#include "rve_fixture.h"

LamRVE NewRVE(const LamMicrostructure *micro)
{
  LamRVE rve;

  CHECK(NewTissue(micro, &rve, NULL));
  return rve;
}

LamResponse SolveFromReference(LamRVE rve, LamLoad load)
{
  LamResponse response;
  LamRVEState state;

  assert_int_equal(LamRVEStateCreate(rve, &state), 0);
  assert_int_equal(LamRVESolve(rve, &load, state, &response), 0);
  assert_int_equal(LamRVEStateDestroy(&state), 0);
  return response;
}

LamResponse SolveTissue(const LamMicrostructure *micro, LamLoad load)
{
  LamResponse response;

  CHECK(SolveOnce(micro, &load, &response));
  return response;
}
