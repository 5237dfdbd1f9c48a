#include "strain_cycle.h"
#include "test.h"

enum { CYCLE_SAMPLES = 400, CYCLE_CROSSINGS = 512, CYCLE_PARTS = 4, CYCLE_FINEST = 16 /* units of the finest nodes */ };

static LamLoad CycleLoad(const LamLoad ends[2], double t)
{
  LamLoad load = ends[0];

  for (int i = 0; i < 9; i++) load.F[i] += t * (ends[1].F[i] - ends[0].F[i]);
  return load;
}

/* Face number f crosses where the function changes sign: places of three coordinates, differences of pairs of them. */
static double CycleFace(const AnalyticTable *t, const LamLoad *load, int k, int pair)
{
  const PetscReal F[4] = {load->F[0], load->F[1], load->F[3], load->F[4]};
  const LamLatticeState at = LamLatticeStateOf(&t->grid->axes, F);
  PetscReal a[3] = {0};

  if (pair) return (at.x[k] - at.x[(k + 1) % 3]) / t->grid->step;
  if (t->grid->free.n) LamFreeCellStrain(&t->grid->free, load->turgor + load->cohesion, a);
  return (at.x[k] - a[0] - t->grid->origin) / t->grid->step * LAM_ROOT / CYCLE_FINEST;
}

/* Where the straight way between two loads crosses faces, sorted, with 0 and 1. */
static int CycleCrossings(const AnalyticTable *t, const LamLoad ends[2], double at[CYCLE_CROSSINGS])
{
  int n = 2;

  at[0] = 0;
  at[1] = 1;
  for (int f = 0; f < 6; f++)
    for (int k = 0; k < CYCLE_SAMPLES && n < CYCLE_CROSSINGS; k++) {
      double low = (double)k / CYCLE_SAMPLES, high = (k + 1.0) / CYCLE_SAMPLES;
      const LamLoad first = CycleLoad(ends, low), last = CycleLoad(ends, high);
      const double from = CycleFace(t, &first, f % 3, f / 3), to = CycleFace(t, &last, f % 3, f / 3);
      const double face = floor(fmax(from, to));

      if (floor(from) == floor(to)) continue;
      for (int half = 0; half < 60; half++) {
        const LamLoad middle = CycleLoad(ends, 0.5 * (low + high));
        const PetscBool beyond = (PetscBool)(CycleFace(t, &middle, f % 3, f / 3) >= face);

        *(beyond == (from >= face) ? &low : &high) = 0.5 * (low + high);
      }
      at[n++] = 0.5 * (low + high);
    }
  CHECK(PetscSortReal(n, at));
  return n;
}

/* Of the part from..to of an edge: adds to the work, widens range[2] of the energy. */
static void CycleAddPart(const AnalyticTable *t, LamTable table, const LamLoad ends[2], double from, double to,
                         double *work, double range[2])
{
  static const double place[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
  static const double weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                   0.2369268850561891};

  for (int g = 0; g < 5; g++) {
    const LamLoad load = CycleLoad(ends, 0.5 * (from + to) + 0.5 * (to - from) * place[g]);
    LamResponse r;

    CHECK(LamTableQuery(table, &load, PETSC_INFINITY, &r));
    for (int i = 0; i < 9; i++) *work += 0.5 * (to - from) * weight[g] * r.P[i] * (ends[1].F[i] - ends[0].F[i]);
    range[0] = fmin(range[0], r.energy);
    range[1] = fmax(range[1], r.energy);
  }
}

double CycleWork(const AnalyticTable *t, int n, const LamLoad loads[])
{
  double work = 0, range[2] = {INFINITY, -INFINITY}, at[CYCLE_CROSSINGS];
  LamTable table;

  CHECK(LamDatabaseGetTable(t->database, &table));
  for (int k = 0; k < n; k++) {
    const LamLoad ends[2] = {loads[k], loads[(k + 1) % n]};
    const int crossings = CycleCrossings(t, ends, at);

    for (int c = 0; c + 1 < crossings; c++)
      for (int part = 0; part < CYCLE_PARTS; part++)
        CycleAddPart(t, table, ends, at[c] + (at[c + 1] - at[c]) * part / CYCLE_PARTS,
                     at[c] + (at[c + 1] - at[c]) * (part + 1) / CYCLE_PARTS, &work, range);
  }
  CHECK(LamTableDestroy(&table));
  return fabs(work) / (range[1] - range[0]);
}

void CycleCorners(const AnalyticTable *t, int n, uint64_t *seed, LamLoad loads[])
{
  const double low = t->grid->contact ? -1.7 * LAM_ROOT : 0.3 * LAM_ROOT, v = 1.3 * LAM_ROOT;

  for (int k = 0; k < n; k++) {
    const double u[3] = {RandomReal(seed, low, low + 1.4 * LAM_ROOT), RandomReal(seed, low, low + 1.4 * LAM_ROOT),
                         RandomReal(seed, low, low + 1.4 * LAM_ROOT)};

    loads[k] = LoadAt(t, u, v, RandomReal(seed, -0.1, 0.1));
    loads[k].turgor += 0.03; /* a step in turgor at the same suction */
    if (t->grid->contact) loads[k].cohesion -= 0.03;
  }
  if (t->grid->contact) { /* one corner among the cells that touch no one */
    const double apart[3] = {0.1 * LAM_ROOT, 0.2 * LAM_ROOT, 0.3 * LAM_ROOT};
    const LamLoad floating = LoadAt(t, apart, v, 0);

    memcpy(loads[0].F, floating.F, sizeof(floating.F));
  }
}
