/* Times of answers from the table, part by part, and of whole queries with and without the axis F33; the net work of
   closed cycles and the order of convergence for a known potential. Prints figures, asserts nothing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <petsctime.h>
#include "support/random_reals.h"
#include "support/tissue.h"
#include <hermite_cell.h>
#include "measure.h"
#include "support/test.h"

#include "support/strain_cycle.h"

#define CELLS 32 /* they stay in the nearest cache: the arithmetic alone is timed */
#define CALLS 200000
#define REPEATS 7
#define EDGE 0.05

typedef struct {
  LamJet corner[8];
  PetscReal t[3];
} Cell;

static void RandomCells(Cell cells[CELLS])
{
  uint64_t seed = 1;

  for (int n = 0; n < CELLS; n++) {
    for (int k = 0; k < 3; k++) cells[n].t[k] = RandomReal(&seed, 0, 1);
    for (int c = 0; c < 8; c++) {
      LamJet *jet = &cells[n].corner[c];

      jet->value = RandomReal(&seed, -1, 1);
      for (int i = 0; i < 3; i++) jet->gradient[i] = RandomReal(&seed, -1, 1);
      for (int i = 0; i < 6; i++) jet->hessian[i] = RandomReal(&seed, -1, 1);
      jet->third = RandomReal(&seed, -1, 1);
    }
  }
}

static void Quintic(const Cell *cell, LamJet *sum)
{
  LamHermiteQuintic(cell->corner, EDGE, cell->t, sum);
}

static void Sizes(const Cell *cell, LamJet *sum)
{
  PetscReal bend[3], spread[3];

  LamHermiteSizes(cell->corner, EDGE, bend, spread);
  sum->value += bend[0] + spread[0];
}

static void Cubic(const Cell *cell, LamJet *sum)
{
  LamHermiteCubic(cell->corner, EDGE, cell->t, sum);
}

static void Edges(const Cell *cell, LamJet *sum)
{
  PetscReal value, gradient[3];

  LamHermiteEdges(cell->corner, EDGE, cell->t, &value, gradient);
  sum->value += value + gradient[0];
}

static PetscErrorCode TimeKernel(const char name[], void (*kernel)(const Cell *cell, LamJet *sum))
{
  double times[REPEATS];
  Cell cells[CELLS];
  LamJet sum = {0};

  PetscFunctionBeginUser;
  RandomCells(cells);
  for (int r = 0; r < REPEATS; r++) {
    PetscLogDouble start, stop;

    PetscCall(PetscTime(&start));
    for (int n = 0; n < CALLS; n++) kernel(&cells[n % CELLS], &sum);
    PetscCall(PetscTime(&stop));
    times[r] = (stop - start) / CALLS;
  }
  if (!isfinite(sum.value)) printf("not finite: "); /* the sum is used: no call can be left out */
  printf("%-44s %8.1f %8.1f\n", name, 1e9 * Quantile(times, REPEATS, 0), 1e9 * Quantile(times, REPEATS, 0.5));
  PetscFunctionReturn(0);
}

static PetscErrorCode Kernels(void)
{
  PetscFunctionBeginUser;
  printf("one cell, ns per call                           least   median\n");
  PetscCall(TimeKernel("quintic: value, gradient, Hessian", Quintic));
  PetscCall(TimeKernel("sizes of gradient and bubbles, for the estimate", Sizes));
  PetscCall(TimeKernel("cubic: value, gradient, Hessian", Cubic));
  PetscCall(TimeKernel("edges: value, gradient", Edges));
  PetscFunctionReturn(0);
}

/* ---- of a known potential ---- */

#define CYCLES 20
#define CYCLE_LENGTH 6
#define STATES 500
enum { LEVELS = 3 };

static PetscErrorCode Work(PetscBool contact)
{
  double work[CYCLES];
  uint64_t seed = 1;

  PetscFunctionBeginUser;
  for (int c = 0; c < CYCLES; c++) {
    AnalyticTable t = AnalyticTableOpen(contact, 0.2);
    LamLoad corners[CYCLE_LENGTH];

    AddRough(&t, 2, 0, &seed);
    CycleCorners(&t, CYCLE_LENGTH, &seed, corners);
    work[c] = CycleWork(&t, CYCLE_LENGTH, corners);
    AnalyticTableClose(&t);
  }
  printf("%-44s %8.1e %8.1e\n", contact ? "contact" : "bonded", Quantile(work, CYCLES, 0.5), Quantile(work, CYCLES, 1));
  PetscFunctionReturn(0);
}

/* Largest error of the stress at random states in one root cell, all of its nodes of a level solved. */
static double WorstError(PetscBool contact, int level)
{
  AnalyticTable t = AnalyticTableOpen(contact, 0.2);
  const int corner = contact ? -2 * LAM_ROOT : LAM_ROOT, first[3] = {corner, corner, corner};
  double worst = 0;
  uint64_t seed = 2;

  for (int l = 0; l <= level; l++) AddBlock(&t, l, first, 1 << l, LAM_ROOT >> l);
  for (int n = 0; n < STATES; n++) {
    const double u[3] = {corner + RandomReal(&seed, 0, LAM_ROOT), corner + RandomReal(&seed, 0, LAM_ROOT),
                         corner + RandomReal(&seed, 0, LAM_ROOT)};
    const LamLoad load = LoadAt(&t, u, RandomReal(&seed, 0, LAM_ROOT), 0);
    const LamResponse r = Ask(&t, &load), exact = TissueAnswer(&t.tissue, &load);

    worst = fmax(worst, StressError(r.P, exact.P));
  }
  AnalyticTableClose(&t);
  return worst;
}

static void Convergence(PetscBool contact)
{
  double before = 0;

  for (int level = 0; level < LEVELS; level++) {
    const double error = WorstError(contact, level);

    printf("%-8s level %d                             %8.1e", contact ? "contact" : "bonded", level, error);
    if (level) printf(" %8.2f", log2(before / error));
    printf("\n");
    before = error;
  }
}

#define QUERIES 2000

/* Microseconds of a query to root cells and some of two finer levels, warm; the least of some passes. */
static double QueryTime(PetscBool contact, PetscBool axial)
{
  const AnalyticTissue tissue = {contact, 0.2, axial};
  AnalyticTable t = AnalyticTableOpenScene(tissue, AnalyticScene(&tissue));
  const double low = contact ? -2 * LAM_ROOT : 0;
  double least = INFINITY;
  LamLoad loads[QUERIES];
  uint64_t seed = 3;
  LamTable table;

  AddRough(&t, 2, 0, &(uint64_t){1});
  for (int n = 0; n < QUERIES; n++) {
    const double u[3] = {low + RandomReal(&seed, 0, 2 * LAM_ROOT), low + RandomReal(&seed, 0, 2 * LAM_ROOT),
                         low + RandomReal(&seed, 0, 2 * LAM_ROOT)};

    loads[n] = LoadAtF33(&t, u, RandomReal(&seed, 0, LAM_ROOT * (double)t.grid->tau_cells),
                         RandomReal(&seed, 0, (double)t.grid->z_cells), 0);
  }
  CHECK(LamDatabaseGetTable(t.database, &table));
  for (int pass = 0; pass < REPEATS; pass++) {
    const double start = ProcessorSeconds();
    LamResponse r;

    for (int n = 0; n < QUERIES; n++) CHECK(LamTableQuery(table, &loads[n], PETSC_INFINITY, &r));
    least = fmin(least, 1e6 * (ProcessorSeconds() - start) / QUERIES);
  }
  CHECK(LamTableDestroy(&table));
  AnalyticTableClose(&t);
  return least;
}

static void QueryTimes(PetscBool contact)
{
  const double plane = QueryTime(contact, PETSC_FALSE), axial = QueryTime(contact, PETSC_TRUE);

  printf("%-32s %8.2f %8.2f %8.2f\n", contact ? "contact" : "bonded", plane, axial, axial / plane);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (Kernels()) return 1;
  printf("\ntime of a query, us           F33 = 1      axis    ratio\n");
  QueryTimes(PETSC_FALSE);
  QueryTimes(PETSC_TRUE);
  printf("\nnet work of closed cycles / range of energy       median    worst\n");
  if (Work(PETSC_FALSE) || Work(PETSC_TRUE)) return 1;
  printf("\nworst error of P, refined alike everywhere         error    order\n");
  Convergence(PETSC_FALSE);
  Convergence(PETSC_TRUE);
  return PetscFinalize() ? 1 : 0;
}
