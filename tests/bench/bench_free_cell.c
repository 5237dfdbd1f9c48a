/*
  How well cells that touch no one are known; prints figures, asserts nothing.

    bench_free_cell [--random N]     states of the box; default 300

  Default tissue of one cell, 6 x 2 elements a face, cohesion 0.0025 MPa; 17 knots of suction between 0.005 and 0.06
  MPa. First the functions of suction against solves between the knots at another spacing; then states with random
  lattice strains in the box -0.02 to 0.25 that are all above a(s), every second one by at most 0.01 in one direction,
  s denser where it is small: how many touch all the same, and how wrong P = g J F^-T is there. Last a sheared
  state moved apart bit by bit.
*/
#include <stdio.h>
#include <petsctime.h>
#include "support/contact_tissue.h"
#include "support/tissue.h"
#include "free_cell.h"
#include "lattice_strain.h"
#include "options.h"
#include "support/random_reals.h"

#define KNOTS 17
#define PLACES 3 /* between two knots */
#define COHESION (0.0025 / TISSUE_STRESS)
#define SUCTION_MIN (0.005 / TISSUE_STRESS)
#define SUCTION_MAX (0.06 / TISSUE_STRESS)
#define SCALE (SUCTION_MAX / 32.0)

static LamLoad LoadOf(const double x[3], double s)
{
  const LamLatticeAxes axes = LamLatticeAxesOf(0.0);
  double U[4] = {0};
  LamLoad load;

  LamLatticeStretch(&axes, x, U); /* where there is none, U = 0 is refused */
  load = PlaneLoad(U[0], U[1], U[2], U[3], s - COHESION);
  load.cohesion = COHESION;
  return load;
}

static PetscErrorCode Solve(LamResponder solver, const double x[3], double s, LamResponse *r)
{
  const LamLoad load = LoadOf(x, s);
  const PetscInt point = -1;

  PetscFunctionBeginUser;
  PetscCall(LamResponderRespond(solver, 1, &load, &point, r));
  PetscFunctionReturn(0);
}

static PetscErrorCode CompareBetweenKnots(LamResponder solver, const LamFreeCell *cell)
{
  static const double x[3] = {0.35, 0.35, 0.35};
  const double J = exp(2 * x[0]);
  double worst[6] = {0};

  PetscFunctionBeginUser;
  for (int k = 0; k < PLACES * (KNOTS - 1); k++) {
    const double *knot = &cell->suction[k / PLACES];
    const double s = knot[0] + (knot[1] - knot[0]) * (k % PLACES + 1) / (PLACES + 1.0);
    double a[3], energy[3], turgor[2][3];
    LamResponse r;

    LamFreeCellStrain(cell, s, a);
    LamFreeCellEnergy(cell, 0, s, energy, turgor);
    PetscCall(Solve(solver, x, s, &r));
    worst[0] = fmax(worst[0], fabs(a[0] - log(exp(x[0]) - 0.5 * r.min_gap)));
    worst[1] = fmax(worst[1], fabs(energy[0] - (r.energy - COHESION * J)));
    worst[2] = fmax(worst[2], fabs(energy[1] - r.energy_turgor));
    worst[3] = fmax(worst[3], fabs(energy[2] - r.energy_turgor2));
    worst[4] = fmax(worst[4], fabs(turgor[0][0] - (r.energy_turgor - r.energy_cohesion + J)));
    worst[5] =
        fmax(worst[5], fabs(turgor[1][0] - (r.energy_turgor2 - 2 * r.energy_turgor_cohesion + r.energy_cohesion2)));
  }
  printf("largest error between the knots: a %.1e, Phi %.1e, dPhi/ds %.1e, d2Phi/ds2 %.1e, dPhi/dp %.1e, d2Phi/dp2 "
         "%.1e\n",
         worst[0], worst[1], worst[2], worst[3], worst[4], worst[5]);
  PetscFunctionReturn(0);
}

/* A state above a(s) in all three directions. */
static void Draw(const LamFreeCell *cell, uint64_t *seed, PetscBool is_close, double *s, double x[3], double a[3])
{
  double least;

  do {
    const double share = RandomReal(seed, 0, 1);

    *s = SUCTION_MIN + (SUCTION_MAX - SUCTION_MIN) * share * share;
    LamFreeCellStrain(cell, *s, a);
    for (int i = 0; i < 3; i++) x[i] = RandomReal(seed, -0.02, 0.25);
    least = fmin(x[0], fmin(x[1], x[2])) - a[0];
  } while (least < 0 || (is_close && least > 0.01));
}

/* One state, told of where it touches; *touches, *failed are counted up. */
static PetscErrorCode Try(LamResponder solver, double s, const double x[3], double a, int *touches, int *failed)
{
  double P[9] = {0};
  LamResponse r;

  PetscFunctionBeginUser;
  PetscCall(Solve(solver, x, s, &r));
  *failed += r.status != LAM_CONVERGED;
  if (r.status != LAM_CONVERGED || r.floating_cells == 1) PetscFunctionReturn(0);
  ++*touches;
  P[0] = COHESION * r.load.F[4];
  P[1] = -COHESION * r.load.F[3];
  P[3] = -COHESION * r.load.F[1];
  P[4] = COHESION * r.load.F[0];
  P[8] = r.P[8];
  printf("touches: s %.4f MPa, strains above a(s) %.4f %.4f %.4f, error of P %.1e\n", s * TISSUE_STRESS, x[0] - a,
         x[1] - a, x[2] - a, StressError(P, r.P));
  PetscFunctionReturn(0);
}

static PetscErrorCode CountTouching(LamResponder solver, const LamFreeCell *cell, int count)
{
  uint64_t seed = 1;
  int touches = 0, failed = 0, ignored = 0;
  const double sheared = 0.0052 / TISSUE_STRESS;
  double s, x[3], a[3];

  PetscFunctionBeginUser;
  for (int k = 0; k < count; k++) {
    Draw(cell, &seed, (PetscBool)(k % 2 == 0), &s, x, a);
    PetscCall(Try(solver, s, x, a[0], &touches, &failed));
  }
  printf("%d of %d random states above a(s) touch, %d have no answer\n", touches, count, failed);
  printf("a state of strong shear, two directions close to a(s):\n");
  LamFreeCellStrain(cell, sheared, a);
  for (int k = 0; k < 4; k++) {
    const double above = 0.002 * k;

    PetscCall(Try(solver, sheared, (double[3]){a[0] + 0.006 + above, a[0] + 0.195 + above, a[0] + above}, a[0],
                  &touches, &ignored));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(int count)
{
  const LamMicrostructure micro = ContactTissue(6, 2);
  LamResponder solver;
  LamFreeCell cell;
  LamRVE rve;
  PetscLogDouble start, end;

  PetscFunctionBeginUser;
  PetscCall(NewTissue(&micro, &rve, NULL));
  PetscCall(LamRVEResponderCreate(rve, 0, &solver));
  PetscCall(PetscTime(&start));
  PetscCall(LamFreeCellMake(&micro, COHESION, SUCTION_MIN, SUCTION_MAX, SCALE, KNOTS, NULL, solver, &cell));
  PetscCall(PetscTime(&end));
  printf("%d knots from %d solves in %.2f s\n", (int)cell.n, (int)LamResponderGetCounters(solver).solves, end - start);
  PetscCall(CompareBetweenKnots(solver, &cell));
  PetscCall(CountTouching(solver, &cell, count));
  PetscCall(LamFreeCellDestroy(&cell));
  PetscCall(LamResponderDestroy(&solver));
  PetscCall(LamRVEDestroy(&rve));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Run(NumberOption("--random", 300, 1, PETSC_MAX_INT)));
  return EndBench();
}
