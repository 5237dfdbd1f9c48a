/* Bodies that change in time: uniform ones against one material point of the same tissue, and others against closed
   forms, balances and fresh runs. */
#include "support/test.h"
#include <lamella/lamella.h>
#include "support/told_body.h"
#include <stdio.h>
#include <string.h>

/* A square that may only stretch: uniform. `load`: on its top; `changes`: the block process without its program. */
#define SQUARE(load)                                                                                                   \
  "macro:\n"                                                                                                           \
  "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"                                                                  \
  "  boundary:\n"                                                                                                      \
  "    - {on: left, symmetry: true}\n"                                                                                 \
  "    - {on: bottom, symmetry: true}\n" load
#define STRETCHED SQUARE("    - {on: top, displacement: [free, 1 mm]}\n")
/* Sheared between grips: not uniform. */
#define SHEARED                                                                                                        \
  "macro:\n"                                                                                                           \
  "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"                                                                  \
  "  boundary:\n"                                                                                                      \
  "    - {on: bottom, displacement: [0 mm, 0 mm]}\n"                                                                   \
  "    - {on: top, grip: [2 mm, free]}\n"

#define WATER "  water: {permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"

/* Turgor, water and walls at all times of the output are those of the point, to `accuracy` of the first turgor. */
static void AssertAlike(const Told *body, const Told *point, PetscReal accuracy)
{
  PetscInt i = 0;

  for (PetscInt k = 0; k < body->count; k++) {
    const LamBodyState *b = &body->bodies[k];

    if (b->event != LAM_EVENT_COUNT) continue;
    while (point->points[i].event != LAM_EVENT_COUNT) i++;
    const LamProcessState *p = &point->points[i++];

    assert_near(b->time, p->time, 1e-9 * p->time);
    assert_near(b->step.turgor_mean, p->turgor, accuracy * point->points[0].turgor);
    assert_near(b->walls, p->walls, accuracy);
    assert_near(b->factor[LAM_CHANGING_LAMELLA], p->factor[LAM_CHANGING_LAMELLA], accuracy);
    if (body->scene->process.has_water) assert_near(b->water, p->water / point->points[0].water, accuracy);
  }
  while (i < point->count && point->points[i].event != LAM_EVENT_COUNT) i++;
  assert_int_equal(i, point->count);
}

/* ---- uniform bodies ---- */

TEST(a_free_body_is_its_material_point)
{
#define CHANGES                                                                                                        \
  "process:\n"                                                                                                         \
  "  duration: 2 h\n" WATER "  surroundings:\n"                                                                        \
  "    - {time: 0 h, outside: 0.45 MPa, temperature: 4 degC}\n"                                                        \
  "    - {time: 1 h, outside: 0.42 MPa}\n"                                                                             \
  "    - {time: 1 h, temperature: 30 degC}\n"                                                                          \
  "  kinetics:\n"                                                                                                      \
  "    - {of: lamella, law: first_order, rate: 0.1 /h, activation: 60 kJ/mol}\n"                                       \
  "    - {of: walls, law: autocatalytic, rate: 0.2 /h, second_rate: 2 /h, enzyme: 0.1, plateau: 0.6}\n"
  TOLD point = FollowPoint(CHANGES, 1e-7);
  TOLD body = FollowBodyToEnd(SQUARE("") CHANGES, 1e-7);

  AssertAlike(&body, &point, 5e-6);
#undef CHANGES
}

#define RELAXATION                                                                                                     \
  "process:\n"                                                                                                         \
  "  duration: 30 min\n" WATER "  surroundings: [{time: 0 s, outside: 0.45 MPa}]\n"

/* The square is stretched by 0.1 of its edge before inflation; at the point deformation counts from the inflated one.
 */
TEST(stress_that_relaxes_is_that_of_the_point)
{
  TOLD free = FollowPoint(RELAXATION, 1e-7);
  const PetscReal inflated = free.points[0].response.load.F[4];
  char text[2000];

  snprintf(text, sizeof(text), "%s  program: [{for: 20 s, F: [[free, 0], [0, %.17g]], P: [[0 MPa, x], [x, x]]}]\n",
           RELAXATION, 1 + 0.1 / inflated);
  TOLD point = FollowPoint(text, 1e-7);
  TOLD body = FollowBodyToEnd(STRETCHED RELAXATION "  program: [{for: 20 s, load: 1}]\n", 1e-7);

  AssertAlike(&body, &point, 5e-6);
  assert_near(BodyReaction(LastBody(&body), "top")[1], point.points[point.count - 1].response.P[4], 1e-6);
}

/* Loaded at once, with a speed, held, and let back: reactions at all outputs. */
TEST(walls_that_relax_are_those_of_the_point)
{
#define HELD BODY_RELAXES "process:\n  output: 5 s\n  program: [%s]\n"
  TOLD free = FollowPoint("process: {duration: 1 s}\n" BODY_RELAXES, 1e-7);
  const PetscReal inflated = free.points[0].response.load.F[4];
  char text[2000], program[1000];
  PetscInt i = 0;

  snprintf(
      program, sizeof(program),
      "{for: 0 s, F: [[free, 0], [0, %.17g]], P: [[0 MPa, x], [x, x]]}, {for: 20 s, F: [[free, 0], [0, "
      "%.17g]], P: [[0 MPa, x], [x, x]]}, {for: 50 s}, {for: 10 s, F: [[free, 0], [0, 1]], P: [[0 MPa, x], [x, x]]}",
      1 + 0.05 / inflated, 1 + 0.1 / inflated);
  snprintf(text, sizeof(text), HELD, program);
  TOLD point = FollowPoint(text, 1e-7);
  snprintf(text, sizeof(text), STRETCHED HELD,
           "{for: 0 s, load: 0.5}, {for: 20 s, load: 1}, {for: 50 s}, {for: 10 s, load: 0}");
  TOLD body = FollowBodyToEnd(text, 1e-7);

  assert_true(point.points[4].response.P[4] > 1.1 * point.points[14].response.P[4]); /* while it is held */
  for (PetscInt k = 0; k < body.count; k++) {
    if (body.bodies[k].event != LAM_EVENT_COUNT) continue;
    while (point.points[i].event != LAM_EVENT_COUNT) i++;
    assert_near(body.bodies[k].time, point.points[i].time, 1e-9);
    assert_near(BodyReaction(&body.bodies[k], "top")[1], point.points[i++].response.P[4], 1e-6);
  }
  assert_true(i >= 16);
#undef HELD
}

TEST(a_jump_of_the_load_leaves_water_no_time)
{
  TOLD body = FollowBodyToEnd(STRETCHED RELAXATION "  program: [{for: 10 min}, {for: 0 s, load: 1}]\n", 1e-6);
  TOLD sudden = FollowBodyToEnd(STRETCHED RELAXATION "  program: [{for: 10 min}, {for: 1 ms, load: 1}]\n", 1e-6);
  const LamBodyState *a = LastBody(&body), *b = LastBody(&sudden);
  PetscInt k = 0;

  while (body.bodies[k].load < 1) k++;
  assert_near(body.bodies[k].time, 600, 20);
  assert_near(a->step.turgor_mean, b->step.turgor_mean, 1e-5);
  assert_near(BodyReaction(a, "top")[1], BodyReaction(b, "top")[1], 1e-5);
}

/* The mean change of F since the start is 0.9: what goes astray is judged from the last state, not from the start. */
TEST(a_body_that_is_sheared_far_goes_on_over_bends)
{
  TOLD body = FollowBodyToEnd("macro:\n"
                              "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"
                              "  boundary:\n"
                              "    - {on: bottom, displacement: [0 mm, 0 mm]}\n"
                              "    - {on: top, displacement: [9 mm, 0 mm]}\n"
                              "process:\n"
                              "  duration: 3 h\n"
                              "  kinetics: [{of: walls, law: table, time_unit: h, table: [[0, 1], [2.5, "
                              "0.8], [3, 0.7]]}]\n"
                              "  program: [{for: 1 h, load: 1}, {for: 1 h}, {for: 1 h, load: 0.9}]\n",
                              1e-4);

  assert_near(LastBody(&body)->load, 0.9, 1e-12);
  assert_near(LastBody(&body)->walls, 0.7, 1e-12);
}

/* ---- water ---- */

TEST(membranes_that_let_nothing_pass_keep_the_water_of_a_body)
{
  TOLD body = FollowBodyToEnd(SHEARED "process:\n"
                                      "  duration: 1 h\n"
                                      "  water: {permeability: 0 m/s/MPa, osmotic_pressure: 0.5 MPa}\n"
                                      "  program: [{for: 1 h, load: 1}]\n",
                              1e-5);

  for (PetscInt k = 0; k < body.count; k++) assert_near(body.bodies[k].water, 1, 1e-12);
  assert_true(LastBody(&body)->turgor_max > body.bodies[0].turgor_max);
}

TEST(membranes_of_a_body_without_resistance_are_in_equilibrium)
{
  TOLD body = FollowBodyToEnd(SQUARE("") "process:\n"
                                         "  duration: 1 h\n"
                                         "  water: {permeability: infinite, osmotic_pressure: 0.5 MPa, "
                                         "non_osmotic: 0.1}\n"
                                         "  surroundings:\n"
                                         "    - {time: 0 h, outside: 0.45 MPa}\n"
                                         "    - {time: 0.5 h, outside: 0.4 MPa}\n"
                                         "    - {time: 0.5 h, outside: 0.44 MPa}\n",
                              1e-6);
  const PetscReal stress = body.scene->scales.stress, osmotic = 0.5e6 / stress;

  for (PetscInt k = 0; k < body.count; k++) {
    const LamBodyState *b = &body.bodies[k];

    assert_near(b->step.turgor_mean, osmotic * 0.9 / (b->water - 0.1) - b->outside, 1e-8);
  }
}

/* In the end V - V_b = N / pi_out; back in the first bath the walls are met again. */
TEST(a_plasmolysed_body_follows_boyle_and_van_t_hoff)
{
  TOLD body = FollowBodyToEnd(SHEARED "process:\n"
                                      "  duration: 4 h\n" WATER "  surroundings:\n"
                                      "    - {time: 0 h, outside: 0.45 MPa}\n"
                                      "    - {time: 0 h, outside: 0.8 MPa}\n"
                                      "    - {time: 2 h, outside: 0.8 MPa}\n"
                                      "    - {time: 2 h, outside: 0.45 MPa}\n"
                                      "  program: [{for: 10 s, load: 1}]\n",
                              1e-5);
  const LamBodyState *lost = FindBodyEvent(&body, LAM_EVENT_TURGOR_LOST),
                     *found = FindBodyEvent(&body, LAM_EVENT_TURGOR_FOUND);
  PetscInt k = 0;

  assert_non_null(lost);
  assert_non_null(found);
  assert_true(lost->element >= 0 && lost->time < 7200 && found->time > 7200);
  while (body.bodies[k].time < 7100) k++;
  assert_near(body.bodies[k].plasmolysed, 1, 1e-12);
  assert_near(body.bodies[k].turgor_max, 0, 1e-4);
  assert_near(body.bodies[k].water, 0.1 + 0.9 * 0.5 / 0.8, 1e-5);
  assert_near(LastBody(&body)->plasmolysed, 0, 1e-12);
  assert_true(LastBody(&body)->turgor_min > 0.3);
}

/* ---- walls ---- */

/* Free of load s Psi(F, p / s) is stationary at the same F where p / s is as before. */
TEST(turgor_that_falls_with_the_walls_leaves_the_shape)
{
  TOLD body = FollowBodyToEnd(STRETCHED "process:\n"
                                        "  duration: 1 h\n"
                                        "  surroundings:\n"
                                        "    - {time: 0 h, turgor: 0.05 MPa}\n"
                                        "    - {time: 1 h, turgor: 0.02 MPa}\n"
                                        "  kinetics:\n"
                                        "    - {of: walls, law: table, time_unit: h, table: [[0, 1], [1, "
                                        "0.4]]}\n"
                                        "  program: [{for: 0 s, load: 1}]\n",
                              1e-7);
  const LamBodyState *first = &body.bodies[0], *last = LastBody(&body);

  assert_near(last->walls, 0.4, 1e-12);
  assert_near(BodyReaction(last, "top")[1], 0.4 * BodyReaction(first, "top")[1], 1e-8);
}

TEST(a_body_whose_walls_dissolve_ends_with_a_reason)
{
  TOLD body = FollowBody(SHEARED "process:\n"
                                 "  duration: 1 h\n"
                                 "  kinetics: [{of: walls, law: table, time_unit: h, table: [[0, 1], [0.9, "
                                 "0], [1, 0]]}]\n",
                         1e-5);

  assert_int_equal(body.reason, LAM_PROCESS_ENDED);
  assert_true(strlen(body.message) > 20);
  assert_true(isfinite(LastBody(&body)->step.turgor_mean));
}

/* ---- precision ---- */

#define STORAGE                                                                                                        \
  "process:\n"                                                                                                         \
  "  duration: 7 day\n"                                                                                                \
  "  output: 0.5 day\n" WATER "  surroundings: [{time: 0 day, outside: 0.45 MPa}, {time: 7 day, outside: 0.42 MPa}]\n" \
  "  kinetics:\n"                                                                                                      \
  "    - {of: walls, law: fractional_conversion, rate: 0.3 /day, plateau: 0.5}\n"                                      \
  "    - {of: lamella, law: first_order, rate: 0.3 /day}\n"                                                            \
  "  program: [{for: 3 day, load: 0.5}, {for: 10 s, load: 1}]\n"

TEST(errors_of_a_body_follow_the_tolerance)
{
  TOLD exact = FollowBodyToEnd(SHEARED STORAGE, 1e-9);

  for (PetscReal tolerance = 1e-3; tolerance > 0.5e-7; tolerance /= 10) {
    TOLD body = FollowBodyToEnd(SHEARED STORAGE, tolerance);
    PetscReal error = 0;
    PetscInt i = 0;

    for (PetscInt k = 0; k < body.count; k++) {
      const LamBodyState *a = &body.bodies[k];

      if (a->event != LAM_EVENT_COUNT) continue;
      while (exact.bodies[i].event != LAM_EVENT_COUNT) i++;
      const LamBodyState *b = &exact.bodies[i++];
      error = fmax(error, fabs(a->turgor_min - b->turgor_min) / exact.bodies[0].turgor_min);
      error = fmax(error, fabs(a->factor[LAM_CHANGING_LAMELLA] - b->factor[LAM_CHANGING_LAMELLA]));
      error = fmax(error, fabs(BodyReaction(a, "top")[0] - BodyReaction(b, "top")[0]));
    }
    if (error > 20 * tolerance) fail_msg("tolerance %g: error %g", tolerance, error);
  }
}

/* Largest traction over the strength at a time, by a fresh run to there. */
static PetscReal Excess(PetscReal time)
{
  TOLD body;

  ReadScene(SHEARED STORAGE, 1e-8, &body);
  body.scene->process.duration = body.scene->process.output = time;
  RunBody(&body);
  return LastBody(&body)->ratio[LAM_RATIO_LAMELLA_NORMAL] - 1;
}

TEST(an_event_of_a_body_is_where_bisection_with_fresh_runs_finds_it)
{
  TOLD body = FollowBodyToEnd(SHEARED STORAGE, 1e-7);
  const LamBodyState *event = FindBodyEvent(&body, LAM_EVENT_LAMELLA_NORMAL);
  PetscReal low, high;

  assert_non_null(event);
  low = 0.9 * event->time;
  high = 1.05 * event->time;
  assert_true(Excess(low) < 0 && Excess(high) > 0);
  while (high - low > 1e-6 * event->time) {
    const PetscReal middle = 0.5 * (low + high);

    *(Excess(middle) > 0 ? &high : &low) = middle;
  }
  assert_near(event->time / low, 1, 1e-5);
  assert_near(event->ratio[LAM_RATIO_LAMELLA_NORMAL], 1, 1e-5);
}

TEST_GROUP(.petsc = 1);
