/* Tissue that changes in time at a material point, against closed forms, fresh solves and balances. */
#include "support/rve_fixture.h"
#include <lamella/study.h>
#include <stdio.h>

/* ---- a scene's process, followed with direct solves ---- */

enum { FOLLOWED_STATES = 4000 };

/* The default tissue of one cell, which all scenes begin with. */
#define PROCESS_CELL                                                                                                   \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  mesh: {along: 4, through: 1}\n"
typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamResponder direct;
  LamProcess process;
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE];
  PetscInt count;
  LamProcessState *states; /* [FOLLOWED_STATES] */
} Followed;

static PetscErrorCode KeepState(const LamProcessState *state, void *ctx)
{
  Followed *f = (Followed *)ctx;

  assert_true(f->count < FOLLOWED_STATES);
  f->states[f->count++] = *state;
  return 0;
}

static PetscErrorCode ChangeTissue(void *ctx, const LamTissueFactors *factors)
{
  Followed *f = (Followed *)ctx;
  LamMicrostructure micro = f->scene->micro;

  LamWallMultiply(&micro.wall, factors->walls);
  return LamRVEChangeTissue(f->rve, &micro);
}

static Followed Follow(const char text[])
{
  char whole[4096];
  Followed f = {0};

  snprintf(whole, sizeof(whole), PROCESS_CELL "%s", text);
  assert_int_equal(LamSceneReadText("process.yaml", whole, &f.scene), 0);
  f.states = (LamProcessState *)calloc(FOLLOWED_STATES, sizeof(LamProcessState));
  assert_non_null(f.states);
  assert_int_equal(NewTissue(&f.scene->micro, &f.rve, NULL), 0);
  assert_int_equal(LamRVEResponderCreate(f.rve, 1, &f.direct), 0);
  assert_int_equal(LamProcessCreate(f.scene, &f.process), 0);
  assert_int_equal(LamProcessSetResponder(f.process, f.direct), 0);
  assert_int_equal(LamProcessSetTissue(f.process, ChangeTissue, &f), 0);
  assert_int_equal(LamProcessSetMonitor(f.process, KeepState, &f), 0);
  assert_int_equal(LamProcessRun(f.process, &f.reason, f.message), 0);
  return f;
}

/* The same, where it must come to its end. */
static Followed FollowToEnd(const char text[])
{
  const Followed f = Follow(text);

  if (f.reason != LAM_PROCESS_DONE) fail_msg("%s", f.message);
  return f;
}

static void Forget(Followed *f)
{
  assert_int_equal(LamProcessDestroy(&f->process), 0);
  assert_int_equal(LamResponderDestroy(&f->direct), 0);
  assert_int_equal(LamRVEDestroy(&f->rve), 0);
  assert_int_equal(LamSceneDestroy(&f->scene), 0);
  free(f->states);
}

static const LamProcessState *LastState(const Followed *f)
{
  return &f->states[f->count - 1];
}

/* The first state at an event; NULL: it did not happen. */
static const LamProcessState *FindEvent(const Followed *f, LamEvent event)
{
  for (PetscInt k = 0; k < f->count; k++)
    if (f->states[k].event == event) return &f->states[k];
  return NULL;
}

/* FOLLOWED f = Follow(text): forgotten where the block ends. */
#define FOLLOWED OWNED(Followed, Forget)

/* ---- water ---- */

/* The lumen over V0 of tissue free of stress in the plane. */
static PetscReal FreeLumen(LamRVE rve, PetscReal turgor)
{
  const LamStressControl control = {.given = {1, 1, 0, 0, 1}, .share = 1};
  LamLoad load = PlaneLoad(1, 0, 0, 1, turgor);
  LamResponse response;
  OWNED(LamRVEState, LamRVEStateDestroy) state;

  assert_int_equal(LamRVEStateCreate(rve, &state), 0);
  assert_int_equal(LamRVESolveMixed(rve, &load, &control, state, &response), 0);
  assert_int_equal(response.status, LAM_CONVERGED);
  return response.lumen_fraction;
}

/* ln 2 V / (A Lp (epsilon + pi)) of a free cell, epsilon = V dp/dV, by differences of fresh solves. */
TEST(turgor_relaxes_with_the_half_time_of_a_free_cell)
{
  FOLLOWED f = FollowToEnd("  turgor: {pressure: 0.1 MPa}\n"
                           "process:\n"
                           "  duration: 5 h\n"
                           "  output: 50 s\n"
                           "  tolerance: 1e-9\n"
                           "  water: {permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.5 MPa}\n"
                           "  surroundings:\n"
                           "    - {time: 0 s, outside: 0.4 MPa}\n"
                           "    - {time: 0 s, outside: 0.4001 MPa}\n");
  const PetscReal p = f.scene->turgor, dp = 1e-3 * p, MPa = f.scene->scales.stress;
  const PetscReal v = FreeLumen(f.rve, p), epsilon = v * 2 * dp / (FreeLumen(f.rve, p + dp) - FreeLumen(f.rve, p - dp));
  const PetscReal pi = 0.5e6 / MPa, area = 2 * (1 - 0.15), Lp = 1e-13 * MPa / f.scene->scales.length;
  const PetscReal half_time = log(2) * v / (area * Lp * (epsilon + pi));
  const PetscReal end = LastState(&f)->turgor, first = f.states[2].turgor - end, second = f.states[12].turgor - end;
  const PetscReal found = log(2) * (f.states[12].time - f.states[2].time) / log(first / second);

  assert_near(found / half_time, 1, 1e-3);
}

TEST(solutes_are_conserved_and_the_flow_makes_up_the_volume)
{
  FOLLOWED f = FollowToEnd("  turgor: {pressure: 0.1 MPa}\n"
                           "process:\n"
                           "  duration: 20 min\n"
                           "  output: 2 s\n"
                           "  tolerance: 1e-8\n"
                           "  water: {permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.5 MPa, "
                           "non_osmotic: 0.1}\n"
                           "  surroundings:\n"
                           "    - {time: 0 s, outside: 0.4 MPa, temperature: 20 degC}\n"
                           "    - {time: 600 s, outside: 0.2 MPa, temperature: 40 degC}\n");
  const PetscReal start = f.states[0].water, dead = 0.1 * start, k = f.scene->process.water.permeability * 2 * 0.85;
  PetscReal flowed = 0;

  assert_int_equal(f.count, 601);
  for (PetscInt i = 0; i < f.count; i++) {
    const LamProcessState *s = &f.states[i];

    assert_near(s->osmotic * (s->water - dead) / s->temperature / (f.states[0].osmotic * (start - dead) / 293.15), 1,
                1e-10);
  }
  for (PetscInt i = 0; i + 2 < f.count; i += 2) { /* Simpson's rule */
    const LamProcessState *s = &f.states[i];
    PetscReal flow[3];

    for (int j = 0; j < 3; j++) flow[j] = k * (s[j].osmotic - s[j].outside - s[j].turgor);
    flowed += (s[2].time - s[0].time) / 6 * (flow[0] + 4 * flow[1] + flow[2]);
  }
  assert_near(LastState(&f)->water - start, flowed, 1e-6 * start);
  assert_true(LastState(&f)->water > 1.05 * start);
}

#define BATH(permeability)                                                                                             \
  "  turgor: {pressure: 0.1 MPa}\n"                                                                                    \
  "process:\n"                                                                                                         \
  "  duration: 10 h\n"                                                                                                 \
  "  tolerance: 1e-8\n"                                                                                                \
  "  water: {permeability: " permeability ", osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"                           \
  "  surroundings:\n"                                                                                                  \
  "    - {time: 0 h, outside: 0.4 MPa}\n"                                                                              \
  "    - {time: 1 h, outside: 0.4 MPa}\n"                                                                              \
  "    - {time: 1 h, outside: 1.5 MPa}\n"                                                                              \
  "    - {time: 5 h, outside: 1.5 MPa}\n"                                                                              \
  "    - {time: 5 h, outside: 0.3 MPa}\n"

/* In a bath that draws more than the turgor the membranes leave the walls; the protoplast then is an osmometer. */
TEST(a_plasmolysed_protoplast_follows_boyle_and_van_t_hoff)
{
  FOLLOWED f = FollowToEnd(BATH("4e-7 m/s/MPa"));
  const LamProcessState *lost = FindEvent(&f, LAM_EVENT_TURGOR_LOST), *found = FindEvent(&f, LAM_EVENT_TURGOR_FOUND),
                        *before = NULL;
  const PetscReal v = f.states[0].water;

  for (PetscInt i = 0; i < f.count; i++)
    if (f.states[i].time <= 5 * 3600.0 * (1 + 1e-12)) before = &f.states[i];
  assert_non_null(lost);
  assert_non_null(found);
  assert_near(lost->turgor, 0, 1e-6);
  assert_near(before->turgor, 0, 0);
  assert_near((before->water - 0.1 * v) / (0.9 * v), 0.5 / 1.5, 1e-5);
  assert_true(found->time > 5 * 3600.0);
  assert_near(LastState(&f)->turgor, LastState(&f)->osmotic - LastState(&f)->outside, 1e-5);
  assert_true(LastState(&f)->turgor > f.states[0].turgor);
}

TEST(membranes_that_let_nothing_pass_keep_the_water)
{
  FOLLOWED f = FollowToEnd(BATH("0 m/s/MPa"));

  for (PetscInt i = 0; i < f.count; i++) {
    assert_near(f.states[i].water / f.states[0].water, 1, 1e-9);
    assert_near(f.states[i].turgor, f.states[0].turgor, 1e-7);
  }
}

TEST(membranes_without_resistance_are_in_equilibrium_at_any_time)
{
  FOLLOWED f = FollowToEnd(BATH("infinite"));

  for (PetscInt i = 0; i < f.count; i++) {
    const LamProcessState *s = &f.states[i];

    if (s->event == LAM_EVENT_COUNT) assert_near(s->turgor, s->osmotic - s->outside, 1e-5);
  }
  assert_non_null(FindEvent(&f, LAM_EVENT_TURGOR_LOST));
  assert_non_null(FindEvent(&f, LAM_EVENT_TURGOR_FOUND));
}

/* ---- kinetics ---- */

#define CHANGES                                                                                                        \
  "  interface: {law: contact, cohesion: 0.02 MPa}\n"                                                                  \
  "  turgor: {pressure: 0.05 MPa}\n"                                                                                   \
  "process:\n"                                                                                                         \
  "  duration: 4 day\n"                                                                                                \
  "  output: 1 day\n"                                                                                                  \
  "  tolerance: 1e-7\n"                                                                                                \
  "  inflate: false\n"                                                                                                 \
  "  program: [{for: 0 s, F: [[1.02, 0], [0, 1.02]]}]\n"                                                               \
  "  surroundings:\n"                                                                                                  \
  "    - {time: 0 day, temperature: 20 degC}\n"                                                                        \
  "    - {time: 2 day, temperature: 20 degC}\n"                                                                        \
  "    - {time: 2 day, temperature: 30 degC}\n"                                                                        \
  "  kinetics:\n"

/* k(30 degC) / k(20 degC) of 60 kJ/mol */
static PetscReal Speed(void)
{
  return exp(-60e3 / LAM_GAS_CONSTANT * (1 / 303.15 - 1 / 293.15));
}

TEST(laws_follow_their_closed_forms_over_a_step_of_temperature)
{
  FOLLOWED f = FollowToEnd(CHANGES "    - {of: lamella, law: first_order, rate: 0.3 /day, activation: 60 kJ/mol}\n"
                                   "    - {of: walls, law: fractional_conversion, rate: 0.2 /day, plateau: 1.5, "
                                   "activation: 60 kJ/mol}\n");
  const PetscReal days = 2 + 2 * Speed();

  assert_near(LastState(&f)->time, 4 * 86400.0, 1e-6);
  assert_near(f.states[1].factor[LAM_CHANGING_LAMELLA], exp(-0.3), 1e-6);
  assert_near(LastState(&f)->factor[LAM_CHANGING_LAMELLA], exp(-0.3 * days), 1e-6);
  assert_near(LastState(&f)->factor[LAM_CHANGING_WALLS], 1.5 - 0.5 * exp(-0.2 * days), 1e-6);
}

TEST(two_fractions_and_enzymes_follow_theirs)
{
  FOLLOWED f = FollowToEnd(CHANGES "    - {of: lamella, law: two_fractions, rate: 2 /day, second_rate: 0.1 /day, "
                                   "share: 0.6, activation: 60 kJ/mol, second_activation: 0 kJ/mol}\n"
                                   "    - {of: walls, law: autocatalytic, rate: 0.5 /day, second_rate: 1 /day, "
                                   "enzyme: 0.02, plateau: 0.3, activation: 60 kJ/mol}\n");
  const PetscReal days = 2 + 2 * Speed();

  assert_near(LastState(&f)->factor[LAM_CHANGING_LAMELLA], 0.6 * exp(-2 * days) + 0.4 * exp(-0.1 * 4), 1e-6);
  /* int E dt = ln(1 + E0 (e^(k2 t) - 1)) / k2 */
  assert_near(LastState(&f)->factor[LAM_CHANGING_WALLS], 0.3 + 0.7 * pow(1 + 0.02 * (exp(days) - 1), -0.5), 1e-6);
}

/* ---- properties and responses ---- */

/* Walls whose moduli are all halved bear what half of the pressure does in those of the start, half as much. */
TEST(softened_walls_respond_as_such)
{
  FOLLOWED f = FollowToEnd("  turgor: {pressure: 0.05 MPa}\n"
                           "process:\n"
                           "  duration: 1 day\n"
                           "  tolerance: 1e-8\n"
                           "  kinetics: [{of: walls, law: table, time_unit: day, table: [[0, 1], [1, 0.5]]}]\n");
  LamMicrostructure soft = f.scene->micro;
  const LamProcessState *last = LastState(&f);

  soft.wall.C1 *= 0.5;
  soft.wall.C2 *= 0.5;
  soft.wall.C4 *= 0.5;
  soft.wall.bulk_modulus *= 0.5;
  const LamResponse fresh = SolveTissue(&soft, last->response.load);

  for (int i = 0; i < 9; i++) assert_near(last->response.P[i], fresh.P[i], 1e-7);
  assert_near(fresh.P[0], 0, 1e-6);
  assert_near(last->response.energy, fresh.energy, 1e-8);
}

/* Walls that lose their fibres alone are another tissue; the responder is told. */
TEST(walls_may_change_in_their_proportions)
{
  FOLLOWED f = FollowToEnd("  turgor: {pressure: 0.05 MPa}\n"
                           "process:\n"
                           "  duration: 1 day\n"
                           "  tolerance: 1e-6\n"
                           "  kinetics:\n"
                           "    - {of: C4, law: first_order, rate: 1 /day}\n"
                           "    - {of: C1, law: first_order, rate: 0.2 /day}\n");
  LamMicrostructure soft = f.scene->micro;
  const LamProcessState *last = LastState(&f);

  soft.wall.C4 *= exp(-1);
  soft.wall.C1 *= exp(-0.2);
  soft.wall.bulk_modulus *= soft.wall.C1 + soft.wall.C2;
  const LamResponse fresh = SolveTissue(&soft, last->response.load);

  for (int i = 0; i < 9; i++) assert_near(last->response.P[i], fresh.P[i], 1e-5);
  assert_near(fresh.P[0], 0, 1e-5);
}

/* ---- program ---- */

TEST(stress_relaxes_at_constant_strain_as_water_flows)
{
  FOLLOWED f = FollowToEnd("  turgor: {pressure: 0.1 MPa}\n"
                           "process:\n"
                           "  duration: 40 min\n"
                           "  output: 10 s\n"
                           "  water: {permeability: 4e-7 m/s/MPa, osmotic_pressure: 0.5 MPa}\n"
                           "  surroundings: [{time: 0 s, outside: 0.4 MPa}]\n"
                           "  program:\n"
                           "    - {for: 1 s, F: [[0.95, 0], [0, free]], P: [[x, x], [x, 0 MPa]]}\n"
                           "    - {for: 1 h}\n");
  const LamProcessState *pressed = &f.states[1], *last = LastState(&f);

  assert_near(pressed->F[0], 0.95, 1e-12);
  assert_near(last->F[0], 0.95, 1e-12);
  assert_near(last->response.P[4], 0, 1e-6);
  assert_true(pressed->turgor > 1.02 * f.states[0].turgor);
  assert_true(fabs(last->response.P[0]) < 0.9 * fabs(pressed->response.P[0]));
  assert_near(last->turgor, last->osmotic - last->outside, 1e-3 * last->turgor);
}

TEST(a_load_that_is_held_creeps_as_walls_soften)
{
  FOLLOWED f = FollowToEnd("  turgor: {pressure: 0.02 MPa}\n"
                           "process:\n"
                           "  duration: 2 day\n"
                           "  output: 1 day\n"
                           "  program:\n"
                           "    - {for: 10 s, F: [[free, 0], [0, free]], P: [[0.01 MPa, x], [x, 0 MPa]]}\n"
                           "  kinetics: [{of: walls, law: first_order, rate: 0.5 /day}]\n");
  const PetscReal MPa = f.scene->scales.stress * 1e-6;

  assert_near(LastState(&f)->response.P[0] * MPa, 0.01, 1e-6);
  assert_true(LastState(&f)->F[0] > f.states[1].F[0] && f.states[1].F[0] > 1.001);
}

/* Cells without turgor take up water from where they are. */
TEST(empty_cells_fill)
{
  FOLLOWED f = FollowToEnd("process:\n"
                           "  duration: 20 h\n"
                           "  water: {permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.3 MPa}\n");

  assert_near(f.states[0].turgor, 0, 0);
  assert_near(LastState(&f)->turgor, LastState(&f)->osmotic, 1e-5);
  assert_true(LastState(&f)->turgor > 0.1);
}

TEST(a_program_that_repeats_comes_back)
{
  FOLLOWED f = FollowToEnd("process:\n"
                           "  duration: 40 s\n"
                           "  output: 5 s\n"
                           "  program:\n"
                           "    - {for: 5 s, F: [[1, 0.1], [0, 1]]}\n"
                           "    - {for: 5 s, F: [[1, 0], [0, 1]]}\n"
                           "  repeat: 3\n");

  assert_int_equal(f.count, 9);
  for (PetscInt i = 0; i < f.count; i++) assert_near(f.states[i].F[1], i % 2 && i < 6 ? 0.1 : 0, 1e-12);
}

/* Ten times 0.1 s is not 1 s in binary numbers. */
TEST(ends_that_rounding_keeps_apart_are_one)
{
  FOLLOWED f = FollowToEnd("process:\n"
                           "  duration: 1 s\n"
                           "  output: 0.5 s\n"
                           "  program: [{for: 0.1 s}]\n"
                           "  repeat: 10\n"
                           "  kinetics: [{of: walls, law: table, time_unit: s, table: [[0, 1], [0.3, 0.9]]}]\n");

  assert_int_equal(f.count, 3);
  assert_near(LastState(&f)->time, 1, 0);
}

/* ---- events ---- */

TEST(prescribed_turgor_that_jumps_below_0_is_lost)
{
  FOLLOWED f = FollowToEnd("process:\n"
                           "  duration: 2 h\n"
                           "  surroundings:\n"
                           "    - {time: 0 h, turgor: 0.02 MPa}\n"
                           "    - {time: 1 h, turgor: 0.02 MPa}\n"
                           "    - {time: 1 h, turgor: -0.0005 MPa}\n");

  assert_non_null(FindEvent(&f, LAM_EVENT_TURGOR_LOST));
  assert_near(FindEvent(&f, LAM_EVENT_TURGOR_LOST)->time, 3600, 1e-6);
}

#define ONSET(duration)                                                                                                \
  "  turgor: {pressure: 0.1 MPa}\n"                                                                                    \
  "strength: {lamella_normal: 0.3 MPa}\n"                                                                              \
  "process:\n"                                                                                                         \
  "  duration: " duration "\n"                                                                                         \
  "  tolerance: 1e-8\n"                                                                                                \
  "  water: {permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.5 MPa}\n"                                                 \
  "  surroundings: [{time: 0 s, outside: 0.4 MPa}, {time: 2 day, outside: 0.45 MPa}]\n"                                \
  "  kinetics: [{of: lamella, law: first_order, rate: 0.5 /day}]\n"

/* Traction over strength in the last state of a process that ends at this time, of a fresh solve. */
static PetscReal RatioAt(PetscReal time)
{
  char text[2000], duration[40];

  snprintf(duration, sizeof(duration), "%.17g s", (double)time);
  snprintf(text, sizeof(text), ONSET("%s"), duration);
  FOLLOWED f = FollowToEnd(text);
  const LamProcessState *last = LastState(&f);
  const LamResponse fresh = SolveTissue(&f.scene->micro, last->response.load);
  const PetscReal ratio = fresh.max_traction / (last->factor[LAM_CHANGING_LAMELLA] * f.scene->strength.lamella_normal);

  return ratio;
}

TEST(an_event_is_where_bisection_with_fresh_solves_finds_it)
{
  FOLLOWED f = FollowToEnd(ONSET("2 day"));
  const LamProcessState *event = FindEvent(&f, LAM_EVENT_LAMELLA_NORMAL);
  PetscReal low = 60, high = 2 * 86400.0;

  assert_non_null(event);
  assert_true(RatioAt(low) < 1 && RatioAt(high) > 1);
  while (high - low > 1e-5 * high) {
    const PetscReal middle = 0.5 * (low + high);

    if (RatioAt(middle) < 1)
      low = middle;
    else
      high = middle;
  }
  assert_near(event->time / (0.5 * (low + high)), 1, 1e-4);
}

TEST(stress_over_strength_is_1_at_the_event)
{
  FOLLOWED f = FollowToEnd(ONSET("2 day"));
  const LamProcessState *event = FindEvent(&f, LAM_EVENT_LAMELLA_NORMAL);

  assert_near(event->ratio[LAM_RATIO_LAMELLA_NORMAL], 1, 1e-6);
  assert_true(isnan(event->ratio[LAM_RATIO_WALL]));
}

/* Cells that are held by cohesion alone come apart in a snap; behind it the tissue is what a fresh solve finds. */
TEST(tissue_that_snaps_goes_on_behind)
{
  const LamStressControl control = {.given = {1, 1, 0, 0, 1}, .share = 1};
  FOLLOWED f = FollowToEnd("  interface: {law: contact, cohesion: 0.02 MPa}\n"
                           "  turgor: {pressure: 0.05 MPa}\n"
                           "process:\n"
                           "  duration: 2 day\n"
                           "  output: 1 day\n"
                           "  kinetics: [{of: lamella, law: first_order, rate: 1 /day}]\n");
  const LamProcessState *snap = FindEvent(&f, LAM_EVENT_SNAP), *last = LastState(&f);
  LamLoad load = last->response.load;
  LamResponse fresh;
  OWNED(LamRVEState, LamRVEStateDestroy) start;

  assert_non_null(snap);
  assert_near(snap->time / 86400, 0.5757, 0.002);
  assert_int_equal(LamRVEStateCreate(f.rve, &start), 0);
  assert_int_equal(LamRVESolveMixed(f.rve, &load, &control, start, &fresh), 0);
  assert_int_equal(fresh.status, LAM_CONVERGED);
  assert_near(last->response.load.F[0], fresh.load.F[0], 1e-3);
}

TEST(walls_that_dissolve_to_nothing_end_it_with_a_reason)
{
  FOLLOWED f = Follow("  turgor: {pressure: 0.02 MPa}\n"
                      "process:\n"
                      "  duration: 100 day\n"
                      "  kinetics: [{of: walls, law: first_order, rate: 1 /day}]\n");

  assert_int_equal(f.reason, LAM_PROCESS_ENDED);
  assert_true(strlen(f.message) > 20);
  assert_true(LastState(&f)->time > 0);
}

/* Nothing holds turgid cells together but g: where that is gone the tissue neither spans nor resists. */
TEST(a_lamella_that_dissolves_lets_the_cells_float)
{
  FOLLOWED f = Follow("  interface: {law: contact, cohesion: 0.05 MPa}\n"
                      "  turgor: {pressure: 0.02 MPa}\n"
                      "process:\n"
                      "  duration: 2 day\n"
                      "  kinetics: [{of: lamella, law: table, time_unit: day, table: [[0, 1], [1, 0]]}]\n");

  assert_int_equal(f.reason, LAM_PROCESS_ENDED);
  assert_non_null(FindEvent(&f, LAM_EVENT_LIMIT));
  assert_near(FindEvent(&f, LAM_EVENT_LIMIT)->time, 86400, 86400 * 1e-6);
}

TEST(cells_that_are_pulled_apart_no_longer_span_the_tissue)
{
  FOLLOWED f = Follow("  interface: {law: contact, cohesion: 0.01 MPa}\n"
                      "  turgor: {pressure: 0.02 MPa}\n"
                      "process:\n"
                      "  duration: 1 min\n"
                      "  program: [{for: 1 min, F: [[1.3, 0], [0, 1.3]]}]\n");
  const LamProcessState *event = FindEvent(&f, LAM_EVENT_PERCOLATION);

  assert_non_null(event);
  assert_true(f.states[0].response.percolating_directions == 2);
  assert_true(event->response.percolating_directions < 2);
  assert_true(event->response.opening_fraction > f.states[0].response.opening_fraction + 0.01);
}

/* ---- the study ---- */

static PetscErrorCode NoteEvent(void *ctx, const LamScales *scales, const LamProcessState *state)
{
  if (state->event == LAM_EVENT_LAMELLA_NORMAL) *(PetscReal *)ctx = state->ratio[LAM_RATIO_LAMELLA_NORMAL];
  return 0;
}

/* As `lamella process`: the lamella reaches its strength. */
TEST(a_study_reports_states_and_events)
{
  PetscReal ratio = 0;
  const LamProcessOptions options = {.reporter.ctx = &ratio, .point = NoteEvent};
  char message[LAM_PROCESS_MESSAGE];
  LamProcessReason reason = LAM_PROCESS_ENDED;

  assert_int_equal(LamStudyProcess(LAMELLA_SOURCE_DIR "/tests/scenes/ripening.yaml", &options, &reason, message), 0);
  assert_int_equal(reason, LAM_PROCESS_DONE);
  assert_near(ratio, 1, 1e-3);
}
