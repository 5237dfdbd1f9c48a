/* lamella tradeoff: spread of times, which settings are the best, errors, and which settings a scene has. */
#include "support/test.h"
#include "support/tissue.h"
#include <string.h>
#include "tradeoff.h"

TEST_GROUP(.petsc = 1);

/* ---- times ---- */

TEST(test_spread_of_one_run)
{
  const PetscReal times[] = {2};
  const LamSpread spread = LamSpreadOf(1, times);

  assert_true(spread.median == 2 && spread.low == 2 && spread.high == 2);
}

TEST(test_spread_is_median_and_range)
{
  const PetscReal times[] = {3, 1, 10, 2};
  LamSpread spread = LamSpreadOf(4, times);

  assert_true(spread.median == 2.5 && spread.low == 1 && spread.high == 10);
  spread = LamSpreadOf(3, times);
  assert_true(spread.median == 3);
}

TEST_IS(test_no_run_has_no_spread, assert_true(isnan(LamSpreadOf(0, NULL).median)));

/* ---- the best ---- */

TEST(test_pareto_front)
{
  const PetscReal cost[] = {1, 2, 3, 3, 4}, error[] = {5, 6, 2, 2, 1};
  const PetscBool expected[] = {PETSC_TRUE, PETSC_FALSE, PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  PetscBool optimal[5];

  LamParetoMark(5, cost, error, optimal);
  for (int i = 0; i < 5; i++) assert_int_equal(optimal[i], expected[i]);
}

TEST(test_what_failed_is_never_the_best)
{
  const PetscReal cost[] = {NAN, 2, 3}, error[] = {0, NAN, 7};
  PetscBool optimal[3];

  LamParetoMark(3, cost, error, optimal);
  assert_false(optimal[0]);
  assert_false(optimal[1]);
  assert_true(optimal[2]);
}

/* ---- errors ---- */

static LamResponse Response(PetscReal stress, PetscReal tangent, PetscReal opening, PetscReal lumen)
{
  LamResponse r;
  const LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

  CHECK(LamResponseInit(&load, &r));
  for (int i = 0; i < 9; i++) r.P[i] = i ? 0 : stress;
  r.tangent[0] = tangent; /* the others stay unknown, as in plane strain */
  r.opening_fraction = opening;
  r.lumen_fraction = lumen;
  r.status = LAM_CONVERGED;
  return r;
}

TEST(test_errors_of_an_answer)
{
  const LamResponse one = Response(1.1, 9, 0.2, 0.6), reference = Response(1, 10, 0.5, 0.5);
  const LamMicrostructure bonded = DefaultTissue();
  LamMicrostructure contact = bonded;

  contact.interface = LAM_INTERFACE_CONTACT;
  assert_true(LamErrorOf(LAM_ERROR_P, &bonded, &one, &reference) == StressError(one.P, reference.P));
  assert_true(fabs(LamErrorOf(LAM_ERROR_TANGENT, &bonded, &one, &reference) - 0.1) < 1e-12);
  assert_true(fabs(LamErrorOf(LAM_ERROR_OPENING, &contact, &one, &reference) - 0.3) < 1e-12);
  assert_true(fabs(LamErrorOf(LAM_ERROR_OPENING, &bonded, &one, &reference) - 0.1) < 1e-12);
}

TEST(test_errors_of_a_body)
{
  const LamMacroOutcome reference = {.boundaries = 2, .reaction = {{3, 0}, {0, 4}}, .work = 2};
  LamMacroOutcome one = reference;
  PetscReal errors[2];

  one.reaction[1][1] = 4.5;
  one.work = 1.8;
  LamMacroErrors(&one, &reference, errors);
  assert_true(fabs(errors[0] - 0.1) < 1e-12);
  assert_true(fabs(errors[1] - 0.1) < 1e-12);
}

/* Two meshes, of which one is as good as the reference. */
TEST(test_an_error_near_the_references_does_not_rank)
{
  LamResponse exact = Response(1, 10, 0, 0.5), good = Response(1.001, 10, 0, 0.5), bad = Response(1.1, 10, 0, 0.5);
  PetscBool used = PETSC_TRUE, skip = PETSC_FALSE;
  LamReference reference = {.micro = {.along = 28, .through = 6},
                            .responses = &exact,
                            .used = &used,
                            .used_count = 1,
                            .error = {[LAM_ERROR_P] = 0.001}};
  const LamStates states = {.n = 1, .skip = &skip};
  PetscReal time[] = {1};
  LamMeasurement m[2] = {{.runs = 1, .cpu = time, .wall = time, .responses = &good},
                         {.runs = 1, .cpu = time, .wall = time, .responses = &bad}};

  m[1].setting.planned = PETSC_TRUE;
  CHECK(LamJudge(&reference, &states, 2, m));
  assert_false(m[0].error[LAM_ERROR_P].resolved);
  assert_false(m[0].error[LAM_ERROR_P].optimal);
  assert_true(m[1].error[LAM_ERROR_P].resolved);
  assert_true(m[1].error[LAM_ERROR_P].optimal);
  assert_true(m[1].from_plan == 0);
  assert_true(m[0].from_plan == StressError(good.P, bad.P));

  m[1].setting.micro.along = 28; /* a mesh as fine as the reference */
  m[1].setting.micro.through = 6;
  CHECK(LamJudge(&reference, &states, 2, m));
  assert_false(m[1].error[LAM_ERROR_P].resolved);
}

TEST(test_what_was_not_measured_has_no_error)
{
  LamReference reference = {0};
  const LamStates states = {0};
  LamMeasurement m = {.reason = "stopped"};

  CHECK(LamJudge(&reference, &states, 1, &m));
  assert_true(isnan(m.error[LAM_ERROR_P].largest));
  assert_false(m.error[LAM_ERROR_P].optimal);
}

/* ---- repeats ---- */

/* runs 0: cut short after a step. */
static LamMeasurement Measured(PetscInt runs, PetscReal time, PetscReal work)
{
  LamMeasurement m;

  CHECK(LamMeasurementInit(&(LamSetting){.knob = LAM_KNOB_MACRO}, &m));
  m.runs = runs;
  m.cpu[0] = m.wall[0] = m.state_cpu[0] = time;
  m.outcome = (LamMacroOutcome){.boundaries = 1, .reaction = {{1, work}}, .work = work};
  if (!runs) strcpy(m.reason, "stopped: the time was over");
  return m;
}

/* The outcome of a body is the reference of others: what is unfinished must not replace it. */
TEST(test_a_repeat_cut_short_changes_nothing)
{
  OWNED(LamMeasurement, LamMeasurementDestroy) m = Measured(1, 5, 2), repeat = Measured(0, 0, 0.5);
  const LamMacroOutcome outcome = m.outcome;

  CHECK(LamMeasurementTake(&repeat, &m));
  assert_int_equal(m.runs, 1);
  assert_string_equal(m.reason, "");
  assert_memory_equal(&m.outcome, &outcome, sizeof(outcome));
}

TEST(test_a_repeat_adds_its_times)
{
  OWNED(LamMeasurement, LamMeasurementDestroy) m = Measured(1, 5, 2), repeat = Measured(1, 4, 2);

  CHECK(LamMeasurementTake(&repeat, &m));
  assert_int_equal(m.runs, 2);
  assert_true(m.cpu[0] == 5 && m.cpu[1] == 4);
}

TEST(test_a_first_run_says_why_there_is_none)
{
  LamMeasurement m, first = Measured(0, 0, 0.5);

  CHECK(LamMeasurementInit(&first.setting, &m));
  CHECK(LamMeasurementTake(&first, &m));
  assert_int_equal(m.runs, 0);
  assert_string_equal(m.reason, "stopped: the time was over");
  CHECK(LamMeasurementDestroy(&m));
}

/* ---- settings ---- */

static LamScene *Scene(const char interface[], const char more[])
{
  char text[1024];
  LamScene *scene;

  snprintf(text, sizeof(text),
           "version: 1\n"
           "rve:\n"
           "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
           "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
           "  interface: {law: %s}\n"
           "  mesh: {along: 7, through: 2}\n%s",
           interface, more);
  CHECK(LamSceneReadText("test", text, &scene));
  return scene;
}

static PetscBool Applies(const LamScene *scene, LamKnob knob)
{
  const char *why;
  const PetscBool applies = LamKnobApplies(scene, knob, &why);

  assert_true(applies == (why == NULL));
  return applies;
}

TEST(test_knobs_of_bonded_tissue)
{
  OWNED(LamScene *, LamSceneDestroy) scene = Scene("bonded", "");

  assert_true(Applies(scene, LAM_KNOB_MESH));
  assert_true(Applies(scene, LAM_KNOB_CELLS));
  assert_true(Applies(scene, LAM_KNOB_TOLERANCE));
  assert_false(Applies(scene, LAM_KNOB_STRATEGY));
  assert_false(Applies(scene, LAM_KNOB_DATABASE));
  assert_false(Applies(scene, LAM_KNOB_MACRO));
}

TEST(test_knobs_of_contact_with_a_sample_box)
{
  OWNED(LamScene *, LamSceneDestroy) scene = Scene("contact", "sample: {stretch: {min: 0, max: 0.1}}\n");

  assert_true(Applies(scene, LAM_KNOB_STRATEGY));
  assert_true(Applies(scene, LAM_KNOB_DATABASE));
}

/* Every family has the planned setting once, whatever it is; settings of one family differ in name. */
TEST(test_each_family_has_the_plan_once)
{
  const LamKnob knobs[] = {LAM_KNOB_MESH, LAM_KNOB_STRATEGY, LAM_KNOB_CELLS, LAM_KNOB_TOLERANCE};
  OWNED(LamScene *, LamSceneDestroy) scene = Scene("contact", "  cells: [3, 1]\n  tolerance: 0.001\n");

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(knobs); k++) {
    LamSetting *settings;
    PetscInt n, planned = 0;

    CHECK(LamSettingsMake(scene, knobs[k], &n, &settings));
    for (PetscInt i = 0; i < n; i++) {
      planned += settings[i].planned;
      for (PetscInt j = 0; j < i; j++) assert_string_not_equal(settings[i].label, settings[j].label);
    }
    assert_int_equal(planned, 1);
    CHECK(PetscFree(settings));
  }
}

/* ---- the study ---- */

static PetscErrorCode Count(void *ctx, const LamTradeoffSetting *setting)
{
  PetscInt *counts = (PetscInt *)ctx;

  assert_string_equal(setting->family, "tolerance");
  assert_true(setting->runs == 1 && setting->core_seconds > 0);
  assert_true(setting->P >= 0 && isnan(setting->reaction));
  counts[0]++;
  counts[1] += setting->planned;
  return 0;
}

TEST(test_a_study_reports_the_settings_of_a_family)
{
  PetscInt counts[2] = {0};
  const LamTradeoffOptions options = {
      .family = "tolerance", .repeats = 1, .seconds = 10, .reporter.ctx = counts, .setting = Count};
  PetscBool solved = PETSC_FALSE;

  CHECK(LamStudyTradeoff(LAMELLA_SOURCE_DIR "/tests/scenes/shear-bonded.yaml", &options, &solved));
  assert_true(solved);
  assert_int_equal(counts[0], 7);
  assert_int_equal(counts[1], 1);
}
