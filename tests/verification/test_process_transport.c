/* Water that moves through a body: against series solutions of diffusion, the bath, balances, and finite differences.
 */
#include "support/test.h"
#include "support/told_body.h"
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

/* d psi_c / dV of the slab's tissue at the turgor of the start: free across the slab, held along it. */
static PetscReal Modulus(const Told *told)
{
  const LamWaterSpec *water = &told->scene->process.water;
  LamLoad load = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, told->scene->turgor, 0};
  Synthetic material = {.mu = 1, .lambda = 2, .phi = 0.7, .c = 0.05};
  LamResponse r;

  for (int it = 0; it < 20; it++) {
    assert_int_equal(LamResponseInit(&load, &r), 0);
    SyntheticEvaluate(&material, &load, &r);
    load.F[0] -= r.P[0] / r.tangent[0];
  }
  const PetscReal compliance = -r.energy_turgor2 + r.P_turgor[0] * r.P_turgor[0] / r.tangent[0];
  const PetscReal room = -r.energy_turgor * (1 - water->non_osmotic);

  return 1 / compliance + water->reflection * water->osmotic / room;
}

typedef struct {
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
    s->largest = fmax(s->largest, fabs(remains - Remains(s, point.place[0], state->time)));
  }
}

/* The largest error of a run. */
static Series Follow(const char text[])
{
  Series s = {0};
  TOLD told;

  ReadScene(text, 1e-6, &told);
  const LamTransportSpec *spec = &told.scene->process.transport;

  assert_near(told.scene->scales.macro_length, 5e-3, 1e-12);
  s.modulus = Modulus(&told);
  s.conductivity[0] = spec->apoplast;
  s.conductivity[1] = spec->cell_to_cell;
  s.exchange[0] = told.scene->process.water.permeability * LamMembraneArea(&told.scene->micro);
  s.exchange[1] = 4 * spec->cell_to_cell * PetscSqr(told.scene->scales.macro_length / told.scene->scales.length);
  told.look = Compare;
  told.seen = &s;
  RunBody(&told);
  if (told.reason != LAM_PROCESS_DONE) fail_msg("%s", told.message);
  for (PetscInt k = 0; k < told.count; k++) assert_near(told.bodies[k].water_balance, 0, 1e-10);
  if (getenv("SHOW"))
    printf("error %.2e in %d states; balance %.1e; steps %d\n", s.largest, (int)s.states,
           LastBody(&told)->water_balance, (int)told.counts.steps);
  return s;
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

TEST_GROUP(.petsc = 1);
