/* What tests of the RVE share: the default tissue, loads, solving from the reference state. */
#ifndef LAM_RVE_FIXTURE_H
#define LAM_RVE_FIXTURE_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <math.h>
#include <cmocka.h>
#include <lamella/lamella.h>

#define TISSUE_STRESS 0.11 /* C1 + C2 of the default tissue, MPa */

/* The default tissue (C1 = 0.1, C2 = 0.01, C4 = 1 MPa) with one cell and the coarse mesh. */
static inline LamMicrostructure DefaultTissue(void)
{
  LamMicrostructure micro = {.wall_thickness = 0.15, .cells = {1, 1}, .along = 6, .through = 2};

  micro.wall.C1 = 0.1 / TISSUE_STRESS;
  micro.wall.C2 = 0.01 / TISSUE_STRESS;
  micro.wall.C4 = 1.0 / TISSUE_STRESS;
  micro.wall.bulk_modulus = 1000.0;
  return micro;
}

static inline LamLoad PlaneLoad(double F11, double F12, double F21, double F22, double turgor)
{
  LamLoad load = {.F = {F11, F12, 0, F21, F22, 0, 0, 0, 1}, .turgor = turgor};

  return load;
}

static inline LamRVE NewRVE(const LamMicrostructure *micro)
{
  LamRVE rve;

  assert_int_equal(LamRVECreate(PETSC_COMM_SELF, &rve), 0);
  assert_int_equal(LamRVESetMicrostructure(rve, micro), 0);
  assert_int_equal(LamRVESetUp(rve), 0);
  return rve;
}

/* Solves from F = I in one go. */
static inline LamResponse SolveFromReference(LamRVE rve, LamLoad load)
{
  LamResponse response;
  LamRVEState state;

  assert_int_equal(LamRVEStateCreate(rve, &state), 0);
  assert_int_equal(LamRVESolve(rve, &load, state, &response), 0);
  assert_int_equal(LamRVEStateDestroy(&state), 0);
  return response;
}

static inline LamResponse SolveTissue(const LamMicrostructure *micro, LamLoad load)
{
  LamRVE rve = NewRVE(micro);
  const LamResponse response = SolveFromReference(rve, load);

  assert_int_equal(LamRVEDestroy(&rve), 0);
  return response;
}

static inline int RunWithPetsc(int argc, char **argv, int (*run)(void))
{
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = run();
  if (PetscFinalize()) return 1;
  return failed;
}

#endif
