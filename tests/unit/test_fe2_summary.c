/* The summary of a macroscale run: where tissue fails first, slopes of the curve, the largest force. */
#include "support/test.h"
#include <string.h>
#include "fe2_summary.h"

enum { POINTS = 4 }; /* two elements of two points each */

typedef struct {
  LamScene scene;
  LamSummary summary;
  LamMacroStep step;
  LamMacroFields fields;
  PetscInt first_point[3];
  PetscReal point[POINTS][LAM_POINT_FIELD_COUNT], place[POINTS][2], volume[POINTS];
} Run;

/* A body of 20 x 10 mm, C1 + C2 = 0.1 MPa, whose top is moved. */
static void Begin(Run *run, LamInterfaceLawType interface, LamStrength strength)
{
  memset(run, 0, sizeof(*run));
  run->scene.scales = (LamScales){.length = 75e-6, .stress = 0.1e6, .macro_length = 0.02};
  run->scene.macro.box[0] = 1;
  run->scene.macro.box[1] = 0.5;
  run->scene.micro.interface = interface;
  run->scene.strength = strength;
  run->step.boundary_count = 2;
  strcpy(run->step.boundary[0], "bottom");
  strcpy(run->step.boundary[1], "top");
  run->fields = (LamMacroFields){.element_count = 2,
                                 .point_count = POINTS,
                                 .first_point = run->first_point,
                                 .point = &run->point[0][0],
                                 .place = &run->place[0][0],
                                 .volume = run->volume};
  for (int p = 0; p < POINTS; p++) {
    run->place[p][0] = 0.1 * p;
    run->volume[p] = 1 + p;
    run->point[p][LAM_POINT_BROKEN] = run->point[p][LAM_POINT_BROKEN_FACE] = NAN; /* of no lamella */
  }
  run->step.broken_fraction = NAN;
  run->first_point[1] = 2;
  run->first_point[2] = POINTS;
  assert_int_equal(LamSummaryCreate(&run->scene, &run->summary), 0);
}

/* A step in which the top has been moved by `u` mm along X1, against a force of R N/mm. */
static void Add(Run *run, PetscReal u, PetscReal R)
{
  run->step.displacement[1][0] = u / 20;
  run->step.displacement[1][1] = NAN;
  run->step.reaction[1][0] = R / 2;
  run->step.load_factor = u / 4;
  assert_int_equal(LamSummaryAdd(&run->summary, &run->step, &run->fields), 0);
  run->step.step++;
}

static const LamStrength none = {NAN, NAN, NAN}, walls = {.wall = 2, .lamella_normal = NAN, .lamella_shear = NAN};

/* A test with a `Run *run` of such a body. */
#define RUN_TEST(name, interface, strength)                                                                            \
  TEST_ON(name, Run, run, Begin(run, interface, strength), CHECK(LamSummaryDestroy(&run->summary)))

/* Of two points that tear between the same two steps the one that does so first, at the interpolated share. */
RUN_TEST(the_first_point_is_found_between_steps, LAM_INTERFACE_BONDED, walls)
{
  const PetscReal before[POINTS] = {0, 1, 1.2, 0}, after[POINTS] = {1, 3, 4.2, 1}; /* strength 2: at 1/2, at 4/15 */
  const LamSummaryOnset *onset = &run->summary.onset[LAM_SUMMARY_WALL];
  LamSummaryCriterion criterion;

  for (int p = 0; p < POINTS; p++) run->point[p][LAM_POINT_WALL] = before[p];
  Add(run, 1, 0);
  assert_false(onset->reached);
  for (int p = 0; p < POINTS; p++) run->point[p][LAM_POINT_WALL] = after[p];
  Add(run, 2, 0);
  assert_true(onset->reached);
  assert_int_equal(onset->row, 1);
  assert_near(onset->share, 0.8 / 3, 1e-14);
  assert_int_equal(onset->element, 1);
  assert_int_equal(onset->point, 0);
  assert_near(onset->place[0], 4, 1e-12); /* mm */
  assert_ptr_equal(LamSummaryFirst(&run->summary, LAM_SUMMARY_RUPTURE, &criterion), onset);
  assert_null(LamSummaryFirst(&run->summary, LAM_SUMMARY_SEPARATION, &criterion));
}

/* Points 1 and 2 are torn: volumes 2 and 3 of 10. Nothing is judged without a strength. */
RUN_TEST(shares_are_of_the_volume, LAM_INTERFACE_BONDED, walls)
{
  run->point[1][LAM_POINT_WALL] = run->point[2][LAM_POINT_WALL] = 2;
  Add(run, 1, 0);
  assert_near(run->summary.curve.rows[0].value[LAM_CURVE_RUPTURED], 0.5, 1e-14);
  assert_true(isnan(run->summary.curve.rows[0].value[LAM_CURVE_SEPARATED]));
}

/* A gap that opens between two steps is told with the step that has it; what is there at the first step, with that. */
RUN_TEST(what_cannot_be_interpolated_is_not, LAM_INTERFACE_CONTACT, walls)
{
  const LamSummaryOnset *onset = run->summary.onset;

  run->point[3][LAM_POINT_WALL] = 3;
  Add(run, 1, 0);
  assert_true(onset[LAM_SUMMARY_WALL].reached && onset[LAM_SUMMARY_WALL].share == 1);
  assert_false(onset[LAM_SUMMARY_GAP].reached);
  run->point[2][LAM_POINT_GAP] = 0.01;
  Add(run, 2, 0);
  assert_true(onset[LAM_SUMMARY_GAP].reached && onset[LAM_SUMMARY_GAP].share == 1);
  assert_int_equal(onset[LAM_SUMMARY_GAP].row, 1);
}

/* Cells that are pressed together have separated when a face has lost that, not when they open at a junction. */
RUN_TEST(an_opening_is_no_separation, LAM_INTERFACE_CONTACT, none)
{
  LamSummaryCriterion criterion = LAM_SUMMARY_CRITERION_COUNT;

  run->point[0][LAM_POINT_UNLOADING] = 0.5;
  run->point[0][LAM_POINT_GAP] = 0.01;
  Add(run, 1, 0);
  assert_non_null(LamSummaryFirst(&run->summary, LAM_SUMMARY_OPENING, &criterion));
  assert_null(LamSummaryFirst(&run->summary, LAM_SUMMARY_SEPARATION, &criterion));
  run->point[0][LAM_POINT_UNLOADING] = 1.499;
  Add(run, 2, 0);
  assert_non_null(LamSummaryFirst(&run->summary, LAM_SUMMARY_SEPARATION, &criterion));
  assert_int_equal(criterion, LAM_SUMMARY_UNLOADED);
  assert_near(run->summary.onset[criterion].share, 0.499 / 0.999, 1e-14);
}

/* Where nothing presses cells together a gap separates them. */
RUN_TEST(dry_cells_separate_by_a_gap, LAM_INTERFACE_CONTACT, none)
{
  LamSummaryCriterion criterion;

  for (int p = 0; p < POINTS; p++) run->point[p][LAM_POINT_UNLOADING] = NAN;
  Add(run, 1, 0);
  assert_null(LamSummaryFirst(&run->summary, LAM_SUMMARY_SEPARATION, &criterion));
  run->point[2][LAM_POINT_GAP] = 0.01;
  Add(run, 2, 0);
  assert_non_null(LamSummaryFirst(&run->summary, LAM_SUMMARY_SEPARATION, &criterion));
  assert_near(run->summary.curve.rows[1].value[LAM_CURVE_SEPARATED], 0.3, 1e-14);
}

/* Of R = 3 u + u^2 the tangents are exact, whatever the steps are; moduli are over 10 mm across and 20 mm along the
 * top. */
RUN_TEST(tangents_of_a_parabola_are_exact, LAM_INTERFACE_BONDED, none)
{
  const PetscReal u[] = {0, 0.5, 0.8, 1.7, 2};

  for (int k = 0; k < 5; k++) Add(run, u[k], 3 * u[k] + u[k] * u[k]);
  assert_int_equal(run->summary.side, 1);
  assert_near(run->summary.stiffness.initial, 3, 1e-12);
  assert_near(run->summary.stiffness.final, 7, 1e-12);
  assert_near(run->summary.stiffness.secant, 5, 1e-12);
  assert_near(run->summary.height / run->summary.length, 0.5, 1e-14);
}

/* Loading and unloading: the secant goes to the turning point, the final tangent is that of the way back. */
RUN_TEST(a_cycle_has_its_turning_point, LAM_INTERFACE_BONDED, none)
{
  const PetscReal u[] = {0, 1, 2, 1}, R[] = {0, 3, 4, 2};

  for (int k = 0; k < 4; k++) Add(run, u[k], R[k]);
  assert_near(run->summary.stiffness.secant, 2, 1e-12);
  assert_near(run->summary.stiffness.final, 2, 1e-12);
  assert_int_equal(run->summary.firmest, 2);
}

/* A lamella separates where that of a face family is broken; it has gaps and unloaded faces long before. From the step
   at which ellipticity is lost the curve is marked. */
RUN_TEST(a_lamella_separates_where_it_is_broken, LAM_INTERFACE_LAMELLA, none)
{
  const LamSummaryOnset *onset = &run->summary.onset[LAM_SUMMARY_BROKEN];
  json_t *summary;

  for (int p = 0; p < POINTS; p++) {
    run->point[p][LAM_POINT_GAP] = 100 * LAM_VISIBLE_GAP;
    run->point[p][LAM_POINT_UNLOADING] = 1;
    run->point[p][LAM_POINT_BROKEN] = 0.1;
    run->point[p][LAM_POINT_BROKEN_FACE] = 0.2;
  }
  run->step.broken_fraction = 0.1;
  Add(run, 1, 0);
  assert_false(run->summary.onset[LAM_SUMMARY_GAP].judged || run->summary.onset[LAM_SUMMARY_UNLOADED].judged);
  assert_true(onset->judged && !onset->reached);
  run->point[2][LAM_POINT_BROKEN_FACE] = 1;
  run->step.mesh_dependent = PETSC_TRUE;
  run->step.broken_fraction = 0.3;
  Add(run, 2, 0);
  assert_true(onset->reached);
  assert_near(onset->share, 0.79 / 0.8, 1e-12);
  assert_near(run->summary.curve.rows[1].value[LAM_CURVE_SEPARATED], 0.3, 1e-14);
  summary = LamSummaryToJSON(&run->summary);
  assert_int_equal(json_integer_value(json_object_get(json_object_get(summary, "mesh_dependent"), "step")), 1);
  assert_near(json_number_value(json_object_get(summary, "broken_fraction")), 0.3, 0);
  json_decref(summary);
}
