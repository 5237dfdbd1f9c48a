/* Water that moves through a body: against series solutions of diffusion, the bath, balances, and finite differences.
 */
#include "support/test.h"
#include "support/gmsh_writer.h"
#include "support/told_body.h"
#include "transport_impl.h"
#include "body_impl.h"
#include <stdio.h>
#include <string.h>

/* A slab between smooth walls, 5 mm thick, of which the right side meets a bath. */
#define SLAB(transport)                                                                                                \
  "macro:\n"                                                                                                           \
  "  mesh: {box: [5 mm, 0.5 mm], elements: [10, 1]}\n"                                                                 \
  "  boundary:\n"                                                                                                      \
  "    - {on: left, symmetry: true}\n"                                                                                 \
  "    - {on: bottom, symmetry: true}\n"                                                                               \
  "    - {on: top, symmetry: true}\n"                                                                                  \
  "process:\n" transport
#define EXPOSED "surface: [{on: right}]"

/* ---- series ---- */

/* d psi_c / dV of the tissue at the turgor of the start, held but for F11 (count 1), or F11 = F33 (count 2). */
static PetscReal ModulusOf(const Told *told, int count)
{
  const LamWaterSpec *water = &told->scene->process.water;
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = told->scene->turgor};
  Synthetic material = {.mu = 1, .lambda = 2, .phi = 0.7, .c = 0.05};
  LamResponse r;

  PetscReal pull = 0, stiffness = 1, by_turgor = 0;
  for (int it = 0; it < 20; it++) {
    for (int k = 0; k < count; k++) load.F[8 * k] -= pull / stiffness;
    assert_int_equal(LamResponseInit(&load, &r), 0);
    SyntheticEvaluate(&material, &load, &r);
    pull = stiffness = by_turgor = 0;
    for (int k = 0; k < count; k++) {
      pull += r.P[8 * k];
      by_turgor += r.P_turgor[8 * k];
      for (int l = 0; l < count; l++) stiffness += r.tangent[72 * k + 8 * l];
    }
  }
  const PetscReal compliance = -r.energy_turgor2 + by_turgor * by_turgor / stiffness;
  const PetscReal room = -r.energy_turgor * (1 - water->non_osmotic);

  return 1 / compliance + water->reflection * water->osmotic / room;
}

/* Of a slab: free across it. */
static PetscReal Modulus(const Told *told)
{
  return ModulusOf(told, 1);
}

typedef struct {
  int axis; /* across the slab */
  PetscReal modulus, exchange[2], conductivity[2]; /* of the potentials */
  PetscReal largest;                               /* error over the change of the bath */
  PetscInt states;
} Series;

/* psi_c - psi_out over their difference at the start, at x of a slab of the thickness 1. */
static PetscReal Remains(const Series *s, PetscReal x, PetscReal time)
{
  PetscReal sum = 0;

  for (int n = 0; n < 400; n++) {
    const PetscReal q = (n + 0.5) * PETSC_PI;
    PetscReal rate = 0;

    for (int f = 0; f < 2; f++)
      if (s->conductivity[f] > 0)
        rate += s->exchange[f] * s->conductivity[f] * q * q / (s->exchange[f] + s->conductivity[f] * q * q);
    sum += 2 * (n % 2 ? -1 : 1) / q * cos(q * x) * exp(-s->modulus * rate * time);
  }
  return sum;
}

static void Compare(Told *told)
{
  const LamBodyState *state = LastBody(told);
  Series *s = (Series *)told->seen;
  PetscInt points;

  if (state->time < 0.05 * told->scene->process.duration) return;
  s->states++;
  assert_int_equal(LamMacroGetPointCount(told->macro, &points), 0);
  for (PetscInt p = 0; p < points; p++) {
    const PetscReal sigma = told->scene->process.water.reflection, was = told->scene->process.surroundings[0].outside;
    LamMacroPoint point;

    assert_int_equal(LamMacroGetPoint(told->macro, p, &point), 0);
    const PetscReal remains = (point.field[LAM_POINT_POTENTIAL] + sigma * state->outside) / (state->outside - was);
    s->largest = fmax(s->largest, fabs(remains - Remains(s, point.place[s->axis], state->time)));
  }
}

/* The slab is a tenth as high as thick. */
static void Flat(double X[2])
{
  X[1] *= 0.1;
}

/* The largest error of a run; of triangles: on a mesh of 10 x 1 pairs of them. */
static Series FollowOn(const char text[], PetscBool triangles)
{
  Series s = {0};
  TOLD told;

  ReadScene(text, 1e-6, &told);
  const LamTransportSpec *spec = &told.scene->process.transport;

  assert_near(told.scene->scales.macro_length, 5e-3, 1e-12);
  s.axis = told.scene->macro.symmetry == LAM_AXISYMMETRIC;
  s.modulus = Modulus(&told);
  s.conductivity[0] = spec->apoplast;
  s.conductivity[1] = spec->cell_to_cell;
  s.exchange[0] = told.scene->process.water.permeability * LamMembraneArea(&told.scene->micro);
  s.exchange[1] = 4 * spec->cell_to_cell * PetscSqr(told.scene->scales.macro_length / told.scene->scales.length);
  told.look = Compare;
  told.seen = &s;
  if (triangles) {
    told.scene->macro.source = LAM_MESH_GMSH;
    GmshWrite(told.scene->macro.gmsh, 10, 1, GMSH_TRIANGLES, Flat);
  }
  RunBody(&told);
  if (triangles) unlink(told.scene->macro.gmsh);
  if (told.reason != LAM_PROCESS_DONE) fail_msg("%s", told.message);
  for (PetscInt k = 0; k < told.count; k++) assert_near(told.bodies[k].water_balance, 0, 1e-10);
  if (getenv("SHOW"))
    printf("error %.2e in %d states; balance %.1e; steps %d\n", s.largest, (int)s.states,
           LastBody(&told)->water_balance, (int)told.counts.steps);
  return s;
}

static Series Follow(const char text[])
{
  return FollowOn(text, PETSC_FALSE);
}

#define A_LITTLE "  surroundings: [{time: 0 s, outside: 0.45 MPa}, {time: 0 s, outside: 0.4505 MPa}]\n"

TEST(turgor_diffuses_where_cells_are_in_equilibrium_with_their_walls)
{
  const Series s = Follow(SLAB("  duration: 2 day\n  output: 0.2 day\n" A_LITTLE
                               "  water: {permeability: 1e-5 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"
                               "  transport: {apoplast: 1e-10 m^2/s/MPa, " EXPOSED "}\n"));

  assert_int_equal(s.states, 10);
  assert_true(s.largest < 0.005);
}

TEST(turgor_diffuses_through_triangles_with_bubbles)
{
  const Series s = FollowOn(SLAB("  duration: 2 day\n  output: 0.2 day\n" A_LITTLE
                                 "  water: {permeability: 1e-5 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"
                                 "  transport: {apoplast: 1e-10 m^2/s/MPa, " EXPOSED "}\n"),
                            PETSC_TRUE);

  assert_int_equal(s.states, 10);
  assert_true(s.largest < 0.005);
}

#define SLOW_MEMBRANES "  water: {permeability: 1e-8 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"

/* Water goes 0.7 mm along the walls before a cell has taken it up. */
TEST(cells_far_from_equilibrium_with_their_walls_take_water_up_at_the_rate_of_their_membranes)
{
  const Series s = Follow(SLAB("  duration: 2 day\n  output: 0.2 day\n" A_LITTLE SLOW_MEMBRANES
                               "  transport: {apoplast: 1e-10 m^2/s/MPa, " EXPOSED "}\n"));

  assert_int_equal(s.states, 10);
  assert_true(s.largest < 0.005);
}

/* The membrane at the surface is large against cell to cell. */
TEST(water_diffuses_from_cell_to_cell_without_an_apoplast)
{
  const Series s = Follow(SLAB("  duration: 2 day\n  output: 0.2 day\n" A_LITTLE
                               "  water: {permeability: 1e-4 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"
                               "  transport: {cell_to_cell: 1e-10 m^2/s/MPa, " EXPOSED "}\n"));

  assert_int_equal(s.states, 10);
  assert_true(s.largest < 0.005);
}

TEST(both_paths_carry_together_what_they_carry_alone)
{
  const Series s =
      Follow(SLAB("  duration: 2 day\n  output: 0.2 day\n" A_LITTLE
                  "  water: {permeability: 1e-5 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"
                  "  transport: {apoplast: 4e-11 m^2/s/MPa, cell_to_cell: 6e-11 m^2/s/MPa, " EXPOSED "}\n"));

  assert_int_equal(s.states, 10);
  assert_true(s.largest < 0.005);
}

/* A cylinder between a smooth bottom and a bath on top, held at its rim: along its axis it is a slab. */
TEST(turgor_diffuses_along_the_axis_of_a_cylinder)
{
  const Series s = Follow("macro:\n"
                          "  symmetry: axisymmetric\n"
                          "  mesh: {box: [5 mm, 5 mm], elements: [2, 10]}\n"
                          "  boundary:\n"
                          "    - {on: bottom, symmetry: true}\n"
                          "    - {on: right, symmetry: true}\n"
                          "process:\n  duration: 2 day\n  output: 0.2 day\n" A_LITTLE
                          "  water: {permeability: 1e-5 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"
                          "  transport: {apoplast: 1e-10 m^2/s/MPa, surface: [{on: top}]}\n");

  assert_int_equal(s.states, 10);
  assert_true(s.largest < 0.005);
}

/* ---- limits ---- */

/* Turgor and water of two runs at all their states. */
static void AssertSame(const Told *a, const Told *b, PetscReal tolerance)
{
  assert_int_equal(a->count, b->count);
  for (PetscInt k = 0; k < a->count; k++) {
    const LamBodyState *one = &a->bodies[k], *other = &b->bodies[k];

    assert_near(one->water, other->water, tolerance);
    assert_near(one->turgor_min, other->turgor_min, tolerance);
    assert_near(one->turgor_max, other->turgor_max, tolerance);
    assert_near(one->step.turgor_mean, other->step.turgor_mean, tolerance);
  }
}

/* Not uniform: sheared between grips, one of which is free; with plasmolysis. */
#define SHEARED                                                                                                        \
  "macro:\n"                                                                                                           \
  "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"                                                                  \
  "  boundary:\n"                                                                                                      \
  "    - {on: bottom, displacement: [0 mm, 0 mm]}\n"                                                                   \
  "    - {on: top, grip: [2 mm, free]}\n"                                                                              \
  "process:\n"                                                                                                         \
  "  duration: 2 h\n"                                                                                                  \
  "  program: [{for: 1 h, load: 1}]\n"                                                                                 \
  "  water: {permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"
#define BATHS "  surroundings: [{time: 0 h, outside: 0.45 MPa}, {time: 1 h, outside: 0.8 MPa}]\n"
#define ALL_SIDES "surface: [{on: left}, {on: right}, {on: bottom}, {on: top}]"

TEST(an_apoplast_without_resistance_is_the_bath)
{
  TOLD direct = FollowBodyToEnd(SHEARED BATHS, 1e-5);
  TOLD infinite = FollowBodyToEnd(SHEARED BATHS "  transport: {apoplast: infinite, " ALL_SIDES "}\n", 1e-5);
  TOLD large = FollowBodyToEnd(SHEARED BATHS "  transport: {apoplast: 1e-2 m^2/s/MPa, " ALL_SIDES "}\n", 1e-5);

  AssertSame(&direct, &infinite, 0);
  AssertSame(&direct, &large, 3e-5);
  assert_true(isnan(LastBody(&infinite)->water_balance));
  assert_near(LastBody(&large)->water_balance, 0, 1e-10);
}

TEST(a_plasmolysed_body_keeps_its_balance_and_follows_boyle_and_van_t_hoff)
{
  TOLD body =
      FollowBodyToEnd(SHEARED "  surroundings:\n"
                              "    - {time: 0 h, outside: 0.45 MPa}\n"
                              "    - {time: 0 h, outside: 0.8 MPa}\n"
                              "  transport: {apoplast: 1e-7 m^2/s/MPa, cell_to_cell: 1e-8 m^2/s/MPa, " ALL_SIDES "}\n",
                      1e-5);

  for (PetscInt k = 0; k < body.count; k++) assert_near(body.bodies[k].water_balance, 0, 1e-10);
  assert_near(LastBody(&body)->plasmolysed, 1, 1e-12);
  assert_near(LastBody(&body)->water, 0.1 + 0.9 * 0.5 / 0.8, 1e-5);
}

/* The largest difference of water potential in the body. */
static void SpreadOfPotential(Told *told)
{
  PetscReal least = PETSC_INFINITY, most = -PETSC_INFINITY;
  PetscInt points;

  assert_int_equal(LamMacroGetPointCount(told->macro, &points), 0);
  for (PetscInt p = 0; p < points; p++) {
    LamMacroPoint point;

    assert_int_equal(LamMacroGetPoint(told->macro, p, &point), 0);
    least = fmin(least, point.field[LAM_POINT_POTENTIAL]);
    most = fmax(most, point.field[LAM_POINT_POTENTIAL]);
  }
  *(PetscReal *)told->seen = most - least;
}

TEST(sealed_sides_keep_the_water_of_a_body_in_which_potentials_even_out)
{
  PetscReal spread = 0;
  TOLD body;

  ReadScene(SHEARED "  transport: {apoplast: 1e-7 m^2/s/MPa, cell_to_cell: 1e-7 m^2/s/MPa}\n"
                    "  surroundings: [{time: 0 h, outside: 0.45 MPa}]\n",
            1e-5, &body);
  body.look = SpreadOfPotential;
  body.seen = &spread;
  RunBody(&body);
  for (PetscInt k = 0; k < body.count; k++) {
    assert_near(body.bodies[k].water, 1, 1e-10);
    assert_near(body.bodies[k].inflow, 0, 1e-12);
  }
  assert_true(LastBody(&body)->turgor_max - LastBody(&body)->turgor_min > 1e-2);
  if (getenv("SHOW")) printf("spread %g\n", spread);
  assert_true(spread < 1e-4);
}

TEST(nothing_moves_without_a_path_or_without_membranes)
{
  TOLD none = FollowBodyToEnd(SHEARED BATHS "  transport: {" ALL_SIDES "}\n", 1e-5);

  for (PetscInt k = 0; k < none.count; k++) assert_near(none.bodies[k].water, 1, 1e-12);
}

/* A skin that is the only resistance: the body follows the bath with one time. area: of the skin over the volume, in
   1/macro length; free: components of F that are. */
static void FollowBath(const char text[], PetscReal area, int free)
{
  TOLD body;

  ReadScene(text, 1e-7, &body);
  RunBody(&body);
  if (body.reason != LAM_PROCESS_DONE) fail_msg("%s", body.message);
  const PetscReal g = body.scene->process.transport.surface[0].conductance * body.scene->scales.length /
                      body.scene->scales.macro_length;
  const PetscReal rate = area * g * ModulusOf(&body, free);
  const PetscReal all = LastBody(&body)->water - 1;

  for (PetscInt k = 0; k < body.count; k++) {
    const PetscReal end = all / (1 - exp(-rate * LastBody(&body)->time));

    assert_near((body.bodies[k].water - 1) / end, 1 - exp(-rate * body.bodies[k].time), 0.003);
    assert_near(body.bodies[k].water_balance, 0, 1e-10);
  }
}

#define SKIN                                                                                                           \
  "  duration: 10 h\n  output: 1 h\n" A_LITTLE                                                                         \
  "  water: {permeability: 1e-5 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"                               \
  "  transport: {apoplast: 1e-5 m^2/s/MPa, surface: [{on: right, conductance: 1e-7 m/s/MPa}]}\n"

TEST_IS(behind_a_skin_the_whole_slab_follows_the_bath_at_the_rate_of_the_skin, FollowBath(SLAB(SKIN), 1, 1));

/* Its rim has twice the area over the volume. */
TEST_IS(behind_a_skin_a_cylinder_follows_the_bath_twice_as_fast_as_a_slab,
        FollowBath("macro:\n"
                   "  symmetry: axisymmetric\n"
                   "  mesh: {box: [5 mm, 0.5 mm], elements: [4, 1]}\n"
                   "  boundary:\n"
                   "    - {on: bottom, symmetry: true}\n"
                   "    - {on: top, symmetry: true}\n"
                   "process:\n" SKIN,
                   2, 2));

/* Air of a relative humidity of 0.995 is as a bath of 0.68 MPa. */
TEST(a_block_dries_from_its_skin_inwards_and_ends_in_equilibrium_with_the_air)
{
  TOLD body = FollowBodyToEnd(SHEARED "  surroundings: [{time: 0 h, humidity: 0.995}]\n"
                                      "  transport: {apoplast: 5e-8 m^2/s/MPa, surface: [{on: right, conductance: 1e-5 "
                                      "m/s/MPa}]}\n",
                              1e-5);
  const PetscReal MPa = body.scene->scales.stress * 1e-6, outside = LastBody(&body)->outside * MPa;
  const LamBodyState *lost = FindBodyEvent(&body, LAM_EVENT_TURGOR_LOST);

  assert_near(outside, -LAM_GAS_CONSTANT * 293.15 / 18.05e-6 * log(0.995) * 1e-6, 1e-9);
  assert_non_null(lost);
  assert_true(lost->place[0] > 0.9 && lost->plasmolysed < 0.2);
  for (PetscInt k = 1; k < body.count; k++) {
    assert_true(body.bodies[k].inflow <= body.bodies[k - 1].inflow);
    assert_near(body.bodies[k].water_balance, 0, 1e-10);
  }
  assert_near(LastBody(&body)->water, 0.1 + 0.9 * 0.5 / outside, 0.02);
}

/* ---- the tangent ---- */

/* Unbalanced force at a displacement, with the pressures and potentials that belong to it. */
static void ForceAt(LamMacro macro, Vec u, Vec force)
{
  PetscReal scale, water, flow;
  PetscBool ok;

  for (int it = 0; it < 12; it++) {
    CHECK(LamMacroEvaluate(macro, u, &ok));
    assert_true(ok);
    CHECK(LamMacroAssembleForce(macro, force, &scale));
    CHECK(LamMacroFlowReduce(macro, force, &ok));
    assert_true(ok);
    CHECK(LamMacroSealedResidual(macro, &water));
    CHECK(LamMacroFlowResidual(macro, &flow));
    if (water < 1e-14 && flow < 1e-15) return;
    CHECK(LamMacroMovePressures(macro, u));
  }
  fail_msg("residuals %g and %g", water, flow);
}

/* y = tangent d, with pressures and potentials eliminated, at the state evaluated last; row . d is that of `weight`. */
static void Tangent(LamMacro macro, Vec d, Vec weight, Vec y, PetscReal *along)
{
  LamMacroFlow *flow = macro->flow;
  Vec t, s, row;

  CHECK(VecDuplicate(flow->psi, &t));
  CHECK(VecDuplicate(flow->psi, &s));
  CHECK(VecDuplicate(d, &row));
  CHECK(LamMacroAssembleTangent(macro, macro->tangent));
  CHECK(MatMult(flow->from_u, d, t));
  CHECK(KSPSolve(flow->own_solver, t, s));
  CHECK(VecScale(s, -1));
  CHECK(MatMult(macro->tangent, d, y));
  CHECK(MatMultAdd(flow->to_force, s, y, y));
  CHECK(MatMultTranspose(macro->tangent, weight, row));
  CHECK(LamMacroFlowTranspose(macro, weight, row));
  CHECK(VecDot(row, d, along));
  CHECK(VecDestroy(&row));
  CHECK(VecDestroy(&s));
  CHECK(VecDestroy(&t));
}

/* At the last state, in an implicit step of time. */
static void Differentiate(Told *told)
{
  LamMacro macro = told->macro;
  LamBody body = told->body;
  const PetscReal h = 1e-6;
  PetscInt n;
  PetscReal *rates, *start, along, expected, norm, error;
  Vec d, u, force[2], y, weight;
  PetscScalar *values;

  if (LastBody(told)->time < told->scene->process.duration) return;
  n = body->sizes.points;
  CHECK(PetscMalloc2(n, &rates, n, &start));
  Vec *const vectors[] = {&d, &u, &force[0], &force[1], &y, &weight};
  for (int k = 0; k < 6; k++) CHECK(VecDuplicate(macro->u, vectors[k]));
  for (PetscInt p = 0; p < n; p++) {
    rates[p] = 1e-4 * sin(3.0 * (double)p);
    start[p] = body->water[p];
  }
  body->mode = LAM_WATER_PASSES;
  body->cj = *(PetscReal *)told->seen;
  body->start = start;
  body->slope = rates;
  CHECK(VecSetRandom(weight, NULL));
  CHECK(VecGetArray(d, &values));
  for (PetscInt k = 0; k < body->sizes.displacements; k++) values[k] = 0.01 * cos(7.0 * (double)k);
  CHECK(VecRestoreArray(d, &values));
  for (int side = 0; side < 2; side++) {
    CHECK(VecWAXPY(u, side ? h : -h, d, macro->u));
    ForceAt(macro, u, force[side]);
  }
  CHECK(VecAXPY(force[1], -1, force[0]));
  CHECK(VecScale(force[1], 0.5 / h));
  ForceAt(macro, macro->u, force[0]);
  Tangent(macro, d, weight, y, &along);
  CHECK(VecDot(weight, y, &expected));
  assert_near(along, expected, 1e-10 * fabs(expected));
  CHECK(VecNorm(y, NORM_2, &norm));
  CHECK(VecAXPY(y, -1, force[1]));
  CHECK(VecNorm(y, NORM_2, &error));
  if (getenv("SHOW")) printf("tangent: error %.1e of %.1e\n", error, norm);
  assert_true(error < 1e-7 * norm);
  body->mode = LamBodyAtOnce(body);
  for (int k = 0; k < 6; k++) CHECK(VecDestroy(vectors[k]));
  CHECK(PetscFree2(rates, start));
}

static void AssertTangent(const char text[], PetscReal coefficient)
{
  TOLD told;

  ReadScene(text, 1e-4, &told);
  told.look = Differentiate;
  told.seen = &coefficient;
  RunBody(&told);
  if (told.reason != LAM_PROCESS_DONE) fail_msg("%s", told.message);
}

TEST(the_tangent_of_a_step_of_time_is_the_derivative_of_its_forces)
{
  const char scene[] = SHEARED "  surroundings: [{time: 0 h, outside: 0.45 MPa}, {time: 1 h, outside: 0.48 MPa}]\n"
                               "  transport: {apoplast: 1e-8 m^2/s/MPa, cell_to_cell: 1e-9 m^2/s/MPa, surface: "
                               "[{on: left}, {on: right, conductance: 1e-8 m/s/MPa}]}\n";

  for (PetscReal coefficient = 1e-5; coefficient < 2; coefficient *= 1e2) AssertTangent(scene, coefficient);
}

TEST_GROUP(.petsc = 1);
