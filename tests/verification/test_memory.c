/* Tissue whose walls have a memory: limits, derivatives of a step, the correspondence principle, energies, states. */
#include "support/rve_fixture.h"

#define SHARE 0.4
#define TIME 10.0 /* s */

static LamMicrostructure Relaxing(LamMicrostructure micro)
{
  micro.relaxation = (LamRelaxation){.terms = 2, .share = {SHARE, 0.2}, .time = {TIME, 10 * TIME}};
  return micro;
}

static LamLoad After(LamLoad load, double duration)
{
  load.duration = duration;
  return load;
}

static LamResponse Step(LamRVE rve, LamLoad load, double duration, LamRVEState state)
{
  const LamLoad asked = After(load, duration);
  LamResponse response;

  CHECK(LamRVESolve(rve, &asked, state, &response));
  assert_int_equal(response.status, LAM_CONVERGED);
  return response;
}

static void AssertClose(const LamResponse *a, const LamResponse *b, double tolerance)
{
  assert_true(StressError(a->P, b->P) <= tolerance);
}

typedef struct {
  const char *name;
  LamMicrostructure micro;
} Tissue;

static int ListTissues(Tissue list[3])
{
  list[0] = (Tissue){"bonded", Relaxing(DefaultTissue())};
  list[1] = (Tissue){"contact", Relaxing(ContactTissue(6, 1))};
  list[1].micro.sharpness = LAM_SHARPNESS_SMOOTH;
  list[2] = (Tissue){"fibres that stiffen", Relaxing(DefaultTissue())};
  list[2].micro.wall.law = LAM_WALL_FIBRE_EXPONENTIAL;
  list[2].micro.wall.k1 = 0.5 * list[2].micro.wall.C4;
  list[2].micro.wall.k2 = 3.0;
  list[2].micro.wall.dispersion = 0.1;
  list[2].micro.wall.C4 = 0.0;
  return 3;
}

TEST(at_once_walls_have_their_moduli_and_in_the_end_what_is_left_of_them)
{
  Tissue list[3];

  for (int k = ListTissues(list); k-- > 0;) {
    LamMicrostructure elastic = list[k].micro;
    OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&list[k].micro);
    OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
    LamResponse r, expected;

    elastic.relaxation.terms = 0;
    r = Step(rve, StretchedLoad(), 0, at);
    expected = SolveTissue(&elastic, StretchedLoad());
    AssertClose(&r, &expected, 1e-9);
    elastic = TissueLeft(elastic, 0.4);
    expected = SolveTissue(&elastic, StretchedLoad());
    r = Step(rve, StretchedLoad(), PETSC_INFINITY, at); /* held */
    AssertClose(&r, &expected, 1e-8);
    CHECK(LamRVEStateReset(rve, at));
    r = Step(rve, StretchedLoad(), 1e12, at); /* got there slowly */
    AssertClose(&r, &expected, 1e-8);
  }
}

/* tau -> 0 and tau -> infinity */
TEST(short_and_long_times_of_the_series_are_the_same_limits)
{
  LamMicrostructure micro = Relaxing(DefaultTissue()), elastic = DefaultTissue();

  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < 2; i++) micro.relaxation.time[i] = k ? 1e-12 : 1e15;
    {
      OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
      OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
      const LamMicrostructure left = TissueLeft(elastic, k ? 0.4 : 1.0);
      const LamResponse expected = SolveTissue(&left, StretchedLoad());
      const LamResponse r = Step(rve, StretchedLoad(), TIME, at);

      AssertClose(&r, &expected, 1e-8);
    }
  }
}

/* The state before: at another F, half relaxed. */
static void Precede(LamRVE rve, LamRVEState state)
{
  LamLoad load = StretchedLoad();

  load.F[0] += 0.03;
  load.F[1] -= 0.05;
  (void)Step(rve, load, 0.3 * TIME, state);
}

TEST(stress_and_tangent_are_derivatives_of_the_step)
{
  const double h = 1e-4;
  Tissue list[3];

  for (int k = ListTissues(list); k-- > 0;) {
    OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&list[k].micro);
    OWNED(LamRVEState, LamRVEStateDestroy) before = NewState(rve);
    OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
    LamResponse r;

    Precede(rve, before);
    CHECK(LamRVEStateCopy(before, at));
    r = Step(rve, StretchedLoad(), 0.7 * TIME, at);
    for (int c = 0; c < 6; c++) {
      LamResponse side[4];

      for (int s = 0; s < 4; s++) { /* of fourth order */
        LamLoad load = StretchedLoad();

        *(c < 5 ? &load.F[contact_components[c]] : &load.turgor) += h * (s < 2 ? s - 2 : s - 1);
        CHECK(LamRVEStateCopy(before, at));
        side[s] = Step(rve, load, 0.7 * TIME, at);
      }
#define DIFFERENCE(member)                                                                                             \
  (((side[0].member) - (side[3].member) + 8 * ((side[2].member) - (side[1].member))) / (12 * h))
      assert_near(c < 5 ? r.P[contact_components[c]] : r.energy_turgor, DIFFERENCE(energy), 1e-7);
      for (int i = 0; i < 5; i++) {
        const int p = contact_components[i];

        assert_near(c < 5 ? r.tangent[9 * p + contact_components[c]] : r.P_turgor[p], DIFFERENCE(P[p]),
                    1e-6 * TangentScale(&r));
      }
    }
  }
}

/* At small strain a hold after a jump is an elastic solve with moduli times G(t): exact as long as strains are small,
   also within the cell, whose walls relax alike but for volume. */
TEST(relaxation_is_that_of_the_correspondence_principle)
{
  const double times[] = {0.5, 3, 30, 1000};
  LamMicrostructure micro = Relaxing(DefaultTissue()), elastic = DefaultTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  const LamLoad small = PlaneLoad(1 + 1e-6, 2e-6, 0, 1 - 1e-6, 0);
  double passed = 0;

  (void)Step(rve, small, 0, at);
  for (size_t k = 0; k < sizeof(times) / sizeof(times[0]); k++) {
    const double t = times[k], G = 1 - SHARE * (1 - exp(-t / TIME)) - 0.2 * (1 - exp(-t / (10 * TIME)));
    const LamMicrostructure left = TissueLeft(elastic, G);
    const LamResponse expected = SolveTissue(&left, small), r = Step(rve, small, t - passed, at);

    passed = t;
    for (int i = 0; i < 5; i++) {
      const int p = contact_components[i];

      assert_near(r.P[p], expected.P[p], 5e-3 * fabs(expected.P[0]));
    }
  }
}

/* Work of a triangle of shear, n steps up and n down, less what is stored and dissipated, over what is dissipated. */
static double Imbalance(const LamMicrostructure *micro, int n)
{
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(micro);
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);
  LamResponse r = {.dissipated = 0};

  for (int k = 1; k <= 2 * n; k++) {
    const double dissipated = r.dissipated;

    r = Step(rve, PlaneLoad(1, 0.1 * (k <= n ? k : 2 * n - k) / n, 0, 1, 0), TIME / n, state);
    assert_true(r.dissipated > dissipated);
  }
  assert_near(r.dissipated_walls, r.dissipated, 0);
  return (r.work - r.stored - r.dissipated) / r.dissipated;
}

TEST(work_is_stored_or_dissipated_with_an_error_of_second_order)
{
  const LamMicrostructure micro = Relaxing(DefaultTissue());
  const double coarse = Imbalance(&micro, 8), fine = Imbalance(&micro, 16);

  assert_true(fabs(fine) < 5e-3);
  assert_near(coarse / fine, 4, 0.6);
}

TEST(a_state_from_its_bytes_goes_on_bit_for_bit)
{
  const LamMicrostructure micro = Relaxing(DefaultTissue());
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  OWNED(LamRVEState, LamRVEStateDestroy) copy = NewState(rve);
  LamResponse a, b;

  Precede(rve, at);
  CopyPacked(at, copy);
  a = Step(rve, StretchedLoad(), TIME, at);
  b = Step(rve, StretchedLoad(), TIME, copy);
  assert_memory_equal(a.P, b.P, sizeof(a.P));
  assert_memory_equal(&a.stored, &b.stored, sizeof(a.stored));
  assert_memory_equal(&a.work, &b.work, sizeof(a.work));
}

TEST(a_state_without_memory_does_not_grow)
{
  const LamMicrostructure micro = DefaultTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);

  assert_null(rve->memory);
  assert_int_equal(at->pairs, 0);
}

/* The same step, turned: P(R F) = R P(F). */
TEST(a_rotation_turns_the_stress_and_leaves_the_memory)
{
  const double c = cos(0.7), s = sin(0.7);
  Tissue list[3];

  for (int k = ListTissues(list); k-- > 0;) {
    OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&list[k].micro);
    OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
    OWNED(LamRVEState, LamRVEStateDestroy) turned = NewState(rve);
    const LamLoad load = StretchedLoad();
    LamLoad other = load;
    LamResponse a, b;
    double P[9] = {0};

    Precede(rve, at);
    CHECK(LamRVEStateCopy(at, turned));
    for (int j = 0; j < 2; j++) {
      other.F[j] = c * load.F[j] - s * load.F[3 + j];
      other.F[3 + j] = s * load.F[j] + c * load.F[3 + j];
    }
    a = Step(rve, load, TIME, at);
    b = Step(rve, other, TIME, turned);
    for (int j = 0; j < 2; j++) {
      P[j] = c * a.P[j] - s * a.P[3 + j];
      P[3 + j] = s * a.P[j] + c * a.P[3 + j];
    }
    P[8] = a.P[8];
    assert_true(StressError(b.P, P) < 1e-8);
    a = Step(rve, load, TIME, at); /* and the histories are the same */
    b = Step(rve, load, TIME, turned);
    AssertClose(&a, &b, 1e-8);
  }
}

/* Under a constant stress strain grows; a solve at the F found gives that stress. */
TEST(creep_under_prescribed_stress_is_the_step_at_its_strain)
{
  const LamMicrostructure micro = Relaxing(DefaultTissue());
  const LamStressControl control = {.given = {1, 0, 0, 0, 1}, .P = {0.2}, .share = 1};
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  OWNED(LamRVEState, LamRVEStateDestroy) before = NewState(rve);
  double last = 1;

  for (int k = 0; k < 6; k++) {
    LamLoad load = After(at->load, k ? TIME : 0);
    LamResponse r, again;

    CHECK(LamRVEStateCopy(at, before));
    CHECK(LamRVESolveMixed(rve, &load, &control, at, &r));
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_true(r.load.F[0] > last);
    last = r.load.F[0];
    again = Step(rve, r.load, load.duration, before);
    AssertClose(&again, &r, 1e-8);
    assert_near(again.stored, r.stored, 1e-10);
  }
}

TEST(an_instant_later_nothing_has_changed)
{
  const LamMicrostructure micro = Relaxing(ContactTissue(6, 1));
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  LamResponse a, b;

  Precede(rve, at);
  a = Step(rve, StretchedLoad(), TIME, at);
  b = Step(rve, StretchedLoad(), 0, at);
  AssertClose(&a, &b, 1e-9);
  assert_near(b.stored, a.stored, 1e-9);
  assert_near(b.dissipated, a.dissipated, 1e-12);
}
