/* Answers do not depend on the units in which a scene is written, nor, but for a factor, on the size and stiffness of
   the tissue, from picometres and gigapascals to kilometres and micropascals. */
#include "support/rve_fixture.h"
#include <stdio.h>

#define SAME 1e-9      /* relative, of results */
#define ROUNDING 1e-14 /* relative, of what is read */
#define TEXT_SIZE 4096

typedef struct {
  const char *name;
  double si;
} Unit;

static const Unit lengths[] = {{"pm", 1e-12}, {"nm", 1e-9}, {"um", 1e-6}, {"mm", 1e-3}, {"m", 1}, {"km", 1e3}};
static const Unit stresses[] = {{"uPa", 1e-6}, {"Pa", 1}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}, {"TPa", 1e12}};
#define COUNT(list) PETSC_STATIC_ARRAY_LENGTH(list)

typedef enum { BONDED, CONTACT, SEALED, TISSUES } Tissue;

/* The units it is written in, and how many times as large and as stiff it is. */
typedef struct {
  Unit length, stress;
  double size, stiffness;
} System;

static const System usual = {{"um", 1e-6}, {"MPa", 1e6}, 1, 1};

/* A quantity that is `um` or `MPa` in the usual tissue. The texts live until 24 more are made. */
static const char *Quantity(double usual_value, double usual_si, Unit unit, double factor)
{
  static char texts[24][48];
  static int next = 0;
  char *text = texts[next++ % 24];

  snprintf(text, sizeof(texts[0]), "%.17g %s", usual_value * usual_si / unit.si * factor, unit.name);
  return text;
}
#define LENGTH(um) Quantity(um, 1e-6, s->length, s->size)
#define STRESS(MPa) Quantity(MPa, 1e6, s->stress, s->stiffness)

static int WriteTissue(const System *s, Tissue tissue, char text[TEXT_SIZE])
{
  int n = snprintf(text, TEXT_SIZE,
                   "version: 1\nrve:\n  cell: {apothem: %s, wall_thickness: %s}\n"
                   "  wall: {law: fibre_mooney_rivlin, C1: %s, C2: %s, C4: %s, bulk_modulus: %s}\n"
                   "  mesh: {along: 4, through: 2}\n",
                   LENGTH(75), LENGTH(11.25), STRESS(0.1), STRESS(0.01), STRESS(1), STRESS(110));

  if (tissue == CONTACT)
    n += snprintf(text + n, TEXT_SIZE - (size_t)n, "  interface: {law: contact, cohesion: %s, clearance: %s}\n",
                  STRESS(0.004), LENGTH(0.075));
  n += snprintf(text + n, TEXT_SIZE - (size_t)n, "  turgor: {mode: %s, pressure: %s",
                tissue == SEALED ? "sealed" : "prescribed", STRESS(0.02));
  if (tissue == SEALED) n += snprintf(text + n, TEXT_SIZE - (size_t)n, ", water_bulk_modulus: %s", STRESS(2200));
  return n + snprintf(text + n, TEXT_SIZE - (size_t)n, "}\n");
}

/* One state of given F, one of prescribed stress and of another turgor. */
static LamScene *ReadSystem(const System *s, Tissue tissue)
{
  char text[TEXT_SIZE];
  LamScene *scene;
  int n = WriteTissue(s, tissue, text);

  if (tissue != CONTACT)
    n += snprintf(text + n, TEXT_SIZE - (size_t)n, "strength: {wall: %s, lamella_normal: %s, lamella_shear: %s}\n",
                  STRESS(0.5), STRESS(0.1), STRESS(0.05));
  n += snprintf(text + n, TEXT_SIZE - (size_t)n,
                "load:\n  - {F: [[1.01, 0.1], [0, 1]]}\n  - {F: [[free, 0.1], [0, 1.01]], P: [[%s, x], [x, x]]%s%s}\n",
                STRESS(-0.012), tissue == SEALED ? "" : ", turgor: ", tissue == SEALED ? "" : STRESS(0.022));
  assert_in_range(n, 0, TEXT_SIZE - 1);
  if (LamSceneReadText("units.yaml", text, &scene)) fail_msg("%s is refused", text);
  return scene;
}

/* ---- what is read ---- */

static void AssertSameNumber(double value, double expected)
{
  if (isnan(expected))
    assert_true(isnan(value));
  else
    assert_near(value, expected, ROUNDING * fabs(expected));
}

static void AssertSameScene(const LamScene *a, const LamScene *b)
{
  AssertSameNumber(a->micro.wall_thickness, b->micro.wall_thickness);
  AssertSameNumber(a->micro.clearance, b->micro.clearance);
  AssertSameNumber(a->micro.wall.C1, b->micro.wall.C1);
  AssertSameNumber(a->micro.wall.C2, b->micro.wall.C2);
  AssertSameNumber(a->micro.wall.C4, b->micro.wall.C4);
  AssertSameNumber(a->micro.wall.bulk_modulus, b->micro.wall.bulk_modulus);
  if (a->sealed) AssertSameNumber(a->water_bulk_modulus, b->water_bulk_modulus); /* else that of water */
  AssertSameNumber(a->strength.wall, b->strength.wall);
  AssertSameNumber(a->strength.lamella_normal, b->strength.lamella_normal);
  AssertSameNumber(a->strength.lamella_shear, b->strength.lamella_shear);
  AssertSameNumber(a->accuracy, b->accuracy);
  for (int k = 0; k < 2; k++) {
    AssertSameNumber(a->loads[k].turgor, b->loads[k].turgor);
    AssertSameNumber(a->loads[k].cohesion, b->loads[k].cohesion);
  }
  AssertSameNumber(a->controls[1].P[0], b->controls[1].P[0]);
}

/* Compares the scene that a system gives with the usual one. */
static void CheckSystem(const System *s, Tissue tissue)
{
  OWNED(LamScene *, LamSceneDestroy) scene = ReadSystem(s, tissue);
  OWNED(LamScene *, LamSceneDestroy) expected = ReadSystem(&usual, tissue);

  AssertSameScene(scene, expected);
  AssertSameNumber(scene->scales.length, expected->scales.length * s->size);
  AssertSameNumber(scene->scales.stress, expected->scales.stress * s->stiffness);
}

/* The tissue itself, written in each pair of units; and one that has as many of them as it has um and MPa. */
TEST(AllUnitsAreRead)
{
  for (size_t l = 0; l < COUNT(lengths); l++)
    for (size_t p = 0; p < COUNT(stresses); p++)
      for (int tissue = 0; tissue < TISSUES; tissue++) {
        const System same = {lengths[l], stresses[p], 1, 1};
        const System other = {lengths[l], stresses[p], lengths[l].si / 1e-6, stresses[p].si / 1e6};

        CheckSystem(&same, (Tissue)tissue);
        CheckSystem(&other, (Tissue)tissue);
      }
}

/* ---- what is answered ---- */

static void SolveSystem(const System *s, Tissue tissue, LamResponse r[2])
{
  OWNED(LamScene *, LamSceneDestroy) scene = ReadSystem(s, tissue);
  LamLoad start = scene->loads[0], load;
  PetscReal water[1];
  OWNED(LamRVE, LamRVEDestroy) rve = scene->sealed ? NewSealable(&scene->micro) : NewRVE(&scene->micro);
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);

  for (int i = 0; i < 9; i++) start.F[i] = i % 4 == 0;
  if (scene->sealed) {
    assert_int_equal(LamRVESolve(rve, &start, state, &r[0]), 0);
    assert_int_equal(LamRVEGetLumens(rve, state, water), 0);
    assert_int_equal(LamRVESeal(rve, scene->water_bulk_modulus, water), 0);
  }
  assert_int_equal(LamRVESolve(rve, &scene->loads[0], state, &r[0]), 0);
  load = LamLoadAfter(&scene->loads[1], &scene->controls[1], r[0].load.F);
  assert_int_equal(LamRVESolveMixed(rve, &load, &scene->controls[1], state, &r[1]), 0);
}

/* Of all real members, against the largest of an array; small ones against 1, C1 + C2 or apothem. */
static void AssertSameResponse(const LamResponse *a, const LamResponse *b)
{
  assert_int_equal(a->status, LAM_CONVERGED);
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const PetscReal *x = (const PetscReal *)(const void *)((const char *)a + m->offset);
    const PetscReal *y = (const PetscReal *)(const void *)((const char *)b + m->offset);
    double largest = 1;

    if (m->type != LAM_MEMBER_REAL || !strcmp(m->name, "seconds")) continue;
    for (PetscInt i = 0; i < m->count; i++) largest = fmax(largest, isnan(y[i]) ? 0 : fabs(y[i]));
    for (PetscInt i = 0; i < m->count; i++)
      if (isnan(y[i]) != isnan(x[i]) || fabs(x[i] - y[i]) > SAME * largest)
        fail_msg("%s[%d] is %.17g, expected %.17g", m->name, (int)i, x[i], y[i]);
  }
}

static void CheckAnswers(const System *s, int count)
{
  for (int tissue = 0; tissue < TISSUES; tissue++) {
    LamResponse expected[2], r[2];

    SolveSystem(&usual, (Tissue)tissue, expected);
    for (int k = 0; k < count; k++) {
      SolveSystem(&s[k], (Tissue)tissue, r);
      for (int i = 0; i < 2; i++) AssertSameResponse(&r[i], &expected[i]);
    }
  }
}

TEST(EndsOfTheUnitsAnswerAlike)
{
  const System ends[] = {{lengths[0], stresses[4], 1, 1},
                         {lengths[0], stresses[0], 1, 1},
                         {lengths[5], stresses[0], 1, 1},
                         {lengths[5], stresses[5], 1, 1}};

  CheckAnswers(ends, COUNT(ends));
}

TEST(EndsOfSizeAndStiffnessAnswerAlike)
{
  const System ends[] = {{lengths[2], stresses[3], 1e-6, 1e3},
                         {lengths[2], stresses[3], 1e9, 1e-12},
                         {lengths[2], stresses[3], 1, 1e30},
                         {lengths[2], stresses[3], 1e30, 1e-30}};

  CheckAnswers(ends, COUNT(ends));
}

/* Beyond them digits would be lost, or results not be numbers. */
static void AssertRefused(double size, double stiffness)
{
  const System system = {lengths[2], stresses[3], size, stiffness}, *s = &system;
  char text[TEXT_SIZE];
  LamScene *scene;

  WriteTissue(s, BONDED, text);
  PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  assert_int_not_equal(LamSceneReadText("units.yaml", text, &scene), 0);
  PetscPopErrorHandler();
}

TEST(BeyondAllMeasureIsRefused)
{
  AssertRefused(1e110, 1);
  AssertRefused(1e-110, 1);
  AssertRefused(1, 1e110);
  AssertRefused(1, 1e-110);
  AssertRefused(1, 1e-310);
}
