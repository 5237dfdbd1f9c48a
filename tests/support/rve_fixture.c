#include "rve_fixture.h"

LamRVE NewRVE(const LamMicrostructure *micro)
{
  LamRVE rve;

  assert_int_equal(LamRVECreate(PETSC_COMM_SELF, &rve), 0);
  assert_int_equal(LamRVESetMicrostructure(rve, micro), 0);
  assert_int_equal(LamRVESetUp(rve), 0);
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
  LamRVE rve = NewRVE(micro);
  const LamResponse response = SolveFromReference(rve, load);

  assert_int_equal(LamRVEDestroy(&rve), 0);
  return response;
}
