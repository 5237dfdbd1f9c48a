#include "rve_fixture.h"

TEST_FIXTURE_NEEDS_PETSC;

LamRVE NewRVE(const LamMicrostructure *micro)
{
  LamRVE rve;

  CHECK(NewTissue(micro, &rve, NULL));
  return rve;
}

LamRVE NewSealable(const LamMicrostructure *micro)
{
  LamRVE rve;

  CHECK(NewSealableTissue(micro, PETSC_TRUE, &rve, NULL));
  return rve;
}

LamRVEState NewState(LamRVE rve)
{
  LamRVEState state;

  CHECK(LamRVEStateCreate(rve, &state));
  return state;
}

LamResponse SolveFromReference(LamRVE rve, LamLoad load)
{
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);
  LamResponse response;

  CHECK(LamRVESolve(rve, &load, state, &response));
  return response;
}

LamResponse SolveTissue(const LamMicrostructure *micro, LamLoad load)
{
  LamResponse response;

  CHECK(SolveOnce(micro, &load, &response));
  return response;
}

LamResponse SolveDefaultTissue(LamLoad load)
{
  const LamMicrostructure micro = DefaultTissue();

  return SolveTissue(&micro, load);
}

LamResponse SolveContactTissue(LamLoad load)
{
  const LamMicrostructure micro = ContactTissue(6, 2);

  return SolveTissue(&micro, load);
}

void CopyPacked(LamRVEState from, LamRVEState to)
{
  size_t size;
  char *bytes;

  CHECK(LamRVEStateSize(from, &size));
  CHECK(PetscMalloc1(size, &bytes));
  CHECK(LamRVEStatePack(from, bytes));
  CHECK(LamRVEStateUnpack(bytes, to));
  CHECK(PetscFree(bytes));
}
