/* Walls with memory at homogeneous deformations: closed forms of relaxation, of steady and cyclic straining, of creep;
   limits; the stress and tangent of a step as derivatives of its potential. */
#include "support/test.h"
#include "support/random_reals.h"
#include "wall_memory.h"

enum { TERMS = 2 };
static const LamRelaxation two = {.terms = TERMS, .share = {0.35, 0.2}, .time = {1.0, 20.0}};
static const LamRelaxation one = {.terms = 1, .share = {0.6}, .time = {2.0}};
static const LamWall wall = {.C1 = 0.7, .C2 = 0.3, .C4 = 3.0, .bulk_modulus = 1000.0};
static const LamWall matrix = {.law = LAM_WALL_MOONEY_RIVLIN, .C1 = 0.7, .C2 = 0.3, .bulk_modulus = 1000.0};
static const double at_rest[4] = {1, 0, 0, 1};

/* A parallelogram with straight sides. */
typedef struct {
  LamElementGeometry geometry;
  const LamWallLaw *law;
  const LamWall *wall;
  double X[9][2];
  LamMemoryPair past[1 + LAM_RELAXATION_TERMS];
} Wall;

static Wall NewWall(const LamWall *of)
{
  static const int grid[9][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}};
  const double fibre[2] = {0.8, 0.6};
  Wall w = {.wall = of};

  for (int a = 0; a < 9; a++) {
    w.X[a][0] = 0.2 * grid[a][0] + 0.03 * grid[a][1];
    w.X[a][1] = 0.1 * grid[a][1];
  }
  CHECK(LamWallLawGet(of->law, &w.law));
  CHECK(LamElementSetGeometry((const double(*)[2])w.X, fibre, &w.geometry));
  return w;
}

typedef struct {
  double u[9][2];
} Moved;

static Moved Move(const Wall *w, const double F[4])
{
  Moved m;

  for (int a = 0; a < 9; a++)
    for (int i = 0; i < 2; i++) m.u[a][i] = F[2 * i] * w->X[a][0] + F[2 * i + 1] * w->X[a][1] - w->X[a][i];
  return m;
}

/* A step to F: the second Piola-Kirchhoff stress of matrix and fibres at its end, 11 12 22 33. */
static LamMemoryWork Advance(Wall *w, const LamRelaxation *r, const double F[4], double F33, double duration,
                             double S[4])
{
  const LamMemoryStep step = LamMemoryStepOf(r, duration);
  const Moved m = Move(w, F);
  LamPoints history[4];
  LamMemoryPair now, next[1 + LAM_RELAXATION_TERMS];
  LamMemoryWork work;

  LamMemoryHistory(&step, w->past, 1.0, history);
  LamElementElastic(&w->geometry, w->law, w->wall, (const double(*)[2])m.u, F33, 1.0, &now);
  LamMemoryAdvance(&step, &w->geometry, w->past, &now, 1.0, next, &work);
  for (int c = 0; c < 4; c++) S[c] = step.scale * now.S[c][4] + history[c][4];
  memcpy(w->past, next, sizeof(next));
  return work;
}

static double Left(const LamRelaxation *r, double t)
{
  double G = 1;

  for (int i = 0; i < r->terms; i++) G -= r->share[i] * (1 - exp(-t / r->time[i]));
  return G;
}

TEST(a_strain_that_is_held_relaxes_as_the_series_says)
{
  const double F[4] = {1.2, 0.3, -0.1, 0.95}, steps[] = {1e-6, 0.3, 1.7, 11, 200, 1e9};
  Wall w = NewWall(&wall);
  double first[4], S[4], t = 0;

  Advance(&w, &two, F, 1.1, 0, first);
  for (size_t k = 0; k < sizeof(steps) / sizeof(steps[0]); k++) {
    t += steps[k];
    Advance(&w, &two, F, 1.1, steps[k], S);
    for (int c = 0; c < 4; c++) assert_near(S[c], Left(&two, t) * first[c], 1e-12);
  }
}

TEST(the_first_stress_is_that_of_the_moduli_and_the_last_that_of_what_is_left)
{
  const double F[4] = {1.2, 0.3, -0.1, 0.95};
  Wall w = NewWall(&wall), slow = NewWall(&wall);
  LamMemoryPair elastic;
  double S[4], S_slow[4];

  LamElementElastic(&w.geometry, w.law, w.wall, (const double(*)[2])Move(&w, F).u, 1.1, 1.0, &elastic);
  Advance(&w, &two, F, 1.1, 0, S);
  for (int c = 0; c < 4; c++) assert_near(S[c], elastic.S[c][4], 1e-15);
  Advance(&slow, &two, F, 1.1, INFINITY, S_slow);
  for (int c = 0; c < 4; c++) assert_near(S_slow[c], Left(&two, INFINITY) * elastic.S[c][4], 1e-14);
}

/* Simple shear of a matrix: S12 = gamma to first order; straining at the rate 1 relaxes as int G. */
TEST(steady_straining_has_the_stress_of_the_convolution)
{
  const double small = 1e-6;
  Wall w = NewWall(&matrix);
  double S[4];

  for (int k = 1; k <= 4; k++) {
    const double t = 1.5 * k, F[4] = {1, small * t, 0, 1};
    double expected = Left(&two, INFINITY) * t;

    for (int i = 0; i < TERMS; i++) expected += two.share[i] * two.time[i] * (1 - exp(-t / two.time[i]));
    Advance(&w, &two, F, 1, 1.5, S);
    assert_near(S[1] / small, expected, 1e-6);
  }
}

/* P12 of simple shear, J = 1: P12 = F_1K S_K2, of which the volumetric part is none. */
static double Shear(Wall *w, const LamMemoryStep *step, double gamma)
{
  const double F[4] = {1, gamma, 0, 1};
  LamPoints history[4];
  LamMemoryPair now;

  LamMemoryHistory(step, w->past, 1.0, history);
  LamElementElastic(&w->geometry, w->law, w->wall, (const double(*)[2])Move(w, F).u, 1.0, 1.0, &now);
  return step->scale * (now.S[1][4] + gamma * now.S[2][4]) + history[1][4] + gamma * history[2][4];
}

/* Shear strain over the stress 1e-6 after the time 3 in n equal steps. */
static double Creep(int n)
{
  const double stress = 1e-6;
  Wall w = NewWall(&matrix);
  double gamma = stress, S[4];

  Advance(&w, &one, (const double[4]){1, gamma, 0, 1}, 1, 0, S);
  for (int k = 0; k < n; k++) {
    const LamMemoryStep step = LamMemoryStepOf(&one, 3.0 / n);

    for (int it = 0; it < 4; it++) gamma += (stress - Shear(&w, &step, gamma)) / step.scale;
    Advance(&w, &one, (const double[4]){1, gamma, 0, 1}, 1, 3.0 / n, S);
  }
  return gamma / stress;
}

/* A standard linear solid with modulus 1: J(t) = 1/g - (1/g - 1) exp(-g t/tau), g what is left. */
TEST(creep_is_that_of_the_standard_linear_solid_with_an_error_of_second_order)
{
  const double g = 1 - one.share[0], J = 1 / g - (1 / g - 1) * exp(-g * 3.0 / one.time[0]);

  assert_near(Creep(1000), J, 1e-6);
  assert_near((Creep(50) - J) / (Creep(100) - J), 4.0, 0.05);
}

/* In a cycle of small shear springs end as they began: all work is dissipated. */
TEST(what_a_steady_cycle_costs_is_dissipated)
{
  const double small = 1e-4;
  Wall w = NewWall(&matrix);
  double dissipated = 0, retarded = 0, S[4];

  Advance(&w, &one, at_rest, 1, 0, S);
  for (int k = 1; k <= 400 * 40; k++) { /* many cycles, of which the last one counts */
    const double phase = fmod(k / 400.0, 1), wave = phase < 0.5 ? 4 * phase - 1 : 3 - 4 * phase;
    const LamMemoryWork work = Advance(&w, &one, (const double[4]){1, small * wave, 0, 1}, 1, 0.01, S);

    if (k <= 400 * 39) continue;
    dissipated += work.dissipated;
    retarded += work.retarded;
  }
  assert_true(dissipated > 0);
  assert_near(retarded / dissipated, 1.0, 1e-6);
}

TEST(a_jump_dissipates_nothing_and_a_hold_what_its_springs_lose)
{
  const double gamma = 1e-4, F[4] = {1, gamma, 0, 1};
  Wall w = NewWall(&matrix);
  double area = 0, S[4];
  LamMemoryWork work = Advance(&w, &one, F, 1, 0, S);

  for (int k = 0; k < LAM_GAUSS; k++) area += w.geometry.weight[k];
  assert_near(work.dissipated, 0, 1e-20);
  assert_near(work.retarded, 0, 1e-20);
  work = Advance(&w, &one, F, 1, 3.0, S);
  assert_near(work.retarded, 0, 1e-20);
  /* the spring's energy share/2 gamma^2 exp(-2 t/tau) */
  assert_near(work.dissipated / (0.5 * one.share[0] * gamma * gamma * area), 1 - exp(-2 * 3.0 / one.time[0]), 1e-6);
}

/* Series and closed forms of the coefficients meet. */
TEST(coefficients_are_smooth_where_series_end)
{
  const LamRelaxation unit = {.terms = 1, .share = {0.5}, .time = {1.0}};
  const LamMemoryStep below = LamMemoryStepOf(&unit, 1e-3 * (1 - 1e-9)),
                      above = LamMemoryStepOf(&unit, 1e-3 * (1 + 1e-9));

  assert_near(above.psi[0], below.psi[0], 1e-9);
  for (int k = 0; k < 3; k++) assert_near(above.loss[0][k], below.loss[0][k], 1e-8 * fabs(below.loss[0][k]) + 1e-11);
}

/* Residual and tangent of an element with a history, by differences of its energy. */
TEST(stress_and_tangent_of_a_step_are_derivatives_of_its_potential)
{
  uint64_t seed = 7;
  Wall w = NewWall(&wall);
  LamElementStress stress = {0};
  LamElementResult result, other[2];
  LamPoints history[4];
  double x[9][2], h = 1e-6, force, ff, fx[18], forces[2], scratch[18];
  PetscBool valid;

  for (int c = 0; c < 4; c++)
    for (int g = 0; g < LAM_POINTS; g++) history[c][g] = g < 9 ? RandomReal(&seed, -0.5, 0.5) : 0;
  for (int a = 0; a < 9; a++)
    for (int i = 0; i < 2; i++) x[a][i] = 0.1 * w.X[a][i] + RandomReal(&seed, -0.005, 0.005);
#define SET(u, f) LamElementSetConsistentStress(&w.geometry, w.law, &wall, (const double(*)[2])u, f, &stress)
#define EVALUATE(u, f, out)                                                                                            \
  LamElementEvaluate(&w.geometry, w.law, &wall, (const LamPoints *)history, (const double(*)[2])u, f, &stress, out,    \
                     &valid)
#define STRETCH(u, f, out, mixed, second)                                                                              \
  LamElementStretch33(&w.geometry, w.law, &wall, (const LamPoints *)history, (const double(*)[2])u, f, &stress, out,   \
                      mixed, second)
  assert_true(SET(x, 1.05));
  EVALUATE(x, 1.05, &result);
  STRETCH(x, 1.05, &force, fx, &ff);
  for (int d = 0; d < 18; d++) {
    for (int side = 0; side < 2; side++) {
      x[d / 2][d % 2] += side ? -2 * h : h;
      assert_true(SET(x, 1.05));
      EVALUATE(x, 1.05, &other[side]);
      STRETCH(x, 1.05, &forces[side], scratch, &scratch[0]);
    }
    x[d / 2][d % 2] += h;
    assert_near(result.f[d], (other[0].energy - other[1].energy) / (2 * h), 1e-6);
    assert_near(fx[d], (forces[0] - forces[1]) / (2 * h), 1e-5);
    for (int e = 0; e < 18; e++) assert_near(result.K[e][d], (other[0].f[e] - other[1].f[e]) / (2 * h), 2e-4);
  }
  for (int side = 0; side < 2; side++) {
    const double f = 1.05 + (side ? -h : h);

    assert_true(SET(x, f));
    EVALUATE(x, f, &other[side]);
    STRETCH(x, f, &forces[side], scratch, &scratch[0]);
  }
  assert_near(force, (other[0].energy - other[1].energy) / (2 * h), 1e-6);
  assert_near(ff, (forces[0] - forces[1]) / (2 * h), 1e-5);
}
