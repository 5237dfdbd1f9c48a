/* Sealed answers from prescribed turgor: those of the solve with sealed lumens, from whatever responder, and
   derivatives of one energy. */
#include "support/rve_fixture.h"
#include "support/sealed_cells.h"
#include "support/synthetic_responder.h"
#include <lamella/heterogeneous.h>
#include <lamella/sealed.h>

#define POINTS 3
static const PetscInt points[POINTS] = {0, 1, 2};

static void Ask(LamResponder responder, const LamLoad loads[POINTS], LamResponse responses[POINTS])
{
  assert_int_equal(LamResponderRespond(responder, POINTS, loads, points, responses), 0);
}

/* Points that are inflated at different F, so that each has water of its own. */
static void Inflate(LamResponder responder, double turgor, double cohesion)
{
  LamResponse responses[POINTS];
  LamLoad loads[POINTS];

  for (int i = 0; i < POINTS; i++) {
    loads[i] = PlaneLoad(1 + 0.02 * i, 0, 0, 1, turgor);
    loads[i].cohesion = cohesion;
  }
  Ask(responder, loads, responses);
  for (int i = 0; i < POINTS; i++) assert_int_equal(responses[i].status, LAM_CONVERGED);
  assert_int_equal(LamResponderAccept(responder), 0);
}

static void AssertSameAnswer(const LamResponse *a, const LamResponse *b, double tolerance)
{
  const double scale = TangentScale(b);

  assert_int_equal(a->status, LAM_CONVERGED);
  assert_near(a->turgor_mean, b->turgor_mean, tolerance);
  assert_near(a->energy, b->energy, tolerance);
  assert_near(a->load.turgor, b->load.turgor, 0);
  for (int i = 0; i < 5; i++) {
    const int c = contact_components[i];

    assert_near(a->P[c], b->P[c], tolerance);
    assert_near(a->P_turgor[c], b->P_turgor[c], tolerance);
    assert_near(a->P_cohesion[c], b->P_cohesion[c], 100 * tolerance);
    for (int j = 0; j < 5; j++)
      assert_near(a->tangent[9 * c + contact_components[j]], b->tangent[9 * c + contact_components[j]],
                  tolerance * scale);
  }
  assert_near(a->energy_turgor, b->energy_turgor, tolerance);
  assert_near(a->energy_turgor2, b->energy_turgor2, tolerance);
  assert_near(a->energy_turgor_cohesion, b->energy_turgor_cohesion, tolerance);
  assert_near(a->energy_cohesion2, b->energy_cohesion2, 100 * tolerance);
}

/* The pressure found outside of the solve, and inside. */
TEST(BothWaysAgree)
{
  for (int contact = 0; contact < 2; contact++) {
    const LamMicrostructure micro = contact ? ContactTissue(6, 2) : DefaultTissue();
    const double turgor = 0.02 / TISSUE_STRESS, cohesion = contact ? 0.005 / TISSUE_STRESS : 0;
    OWNED(LamRVE, LamRVEDestroy) rve = NewSealable(&micro);
    LamResponder inside, open, outside;
    LamResponse in[POINTS], out[POINTS];
    LamLoad loads[POINTS];

    for (int i = 0; i < POINTS; i++) {
      loads[i] = PlaneLoad(1 + 0.02 * i, 0.1, 0, 1 - 0.001 * i, turgor);
      loads[i].cohesion = cohesion;
    }
    assert_int_equal(LamRVEResponderCreate(rve, POINTS, &inside), 0);
    assert_int_equal(LamRVEResponderCreate(rve, POINTS, &open), 0);
    assert_int_equal(LamSealedResponderCreate(PETSC_COMM_SELF, open, POINTS, &outside), 0);
    Inflate(inside, turgor, cohesion);
    Inflate(outside, turgor, cohesion);
    assert_int_equal(LamResponderSeal(inside, SEALED_WATER), 0);
    assert_int_equal(LamResponderSeal(outside, SEALED_WATER), 0);
    Ask(inside, loads, in);
    Ask(outside, loads, out);
    for (int i = 0; i < POINTS; i++) AssertSameAnswer(&out[i], &in[i], 1e-8);
    assert_true(fabs(in[0].turgor_mean - in[2].turgor_mean) > 0.01); /* each has its own water */
    assert_true(LamResponderGetCounters(outside).queries == LamResponderGetCounters(open).queries &&
                LamResponderGetCounters(outside).solves == LamResponderGetCounters(open).solves);
    assert_int_equal(LamResponderDestroy(&inside), 0);
    assert_int_equal(LamResponderDestroy(&outside), 0);
    assert_int_equal(LamResponderDestroy(&open), 0);
  }
}

/* A run that goes on from the bytes of its points has their water, too. */
TEST(BytesKeepTheWater)
{
  for (int outside = 0; outside < 2; outside++) {
    const LamMicrostructure micro = DefaultTissue();
    OWNED(LamRVE, LamRVEDestroy) rve = NewSealable(&micro);
    LamResponder direct[2], sealed[2], r[2];
    LamResponse before[POINTS], after[POINTS];
    LamLoad loads[POINTS];
    size_t size;
    char *bytes;

    for (int k = 0; k < 2; k++) {
      assert_int_equal(LamRVEResponderCreate(rve, POINTS, &direct[k]), 0);
      assert_int_equal(LamSealedResponderCreate(PETSC_COMM_SELF, direct[k], POINTS, &sealed[k]), 0);
      r[k] = outside ? sealed[k] : direct[k];
    }
    Inflate(r[0], 0.2, 0);
    assert_int_equal(LamResponderSeal(r[0], SEALED_WATER), 0);
    assert_int_equal(LamResponderGetStateSize(r[0], &size), 0);
    assert_int_equal(PetscMalloc1(size, &bytes), 0);
    for (int i = 0; i < POINTS; i++) {
      assert_int_equal(LamResponderSave(r[0], i, bytes), 0);
      assert_int_equal(LamResponderLoad(r[1], i, bytes), 0);
      loads[i] = PlaneLoad(1 + 0.02 * i, 0.1, 0, 1, 0.2);
    }
    Ask(r[0], loads, before);
    Ask(r[1], loads, after);
    for (int i = 0; i < POINTS; i++) assert_memory_equal(before[i].P, after[i].P, sizeof(before[i].P));
    assert_int_equal(PetscFree(bytes), 0);
    for (int k = 0; k < 2; k++) {
      assert_int_equal(LamResponderDestroy(&sealed[k]), 0);
      assert_int_equal(LamResponderDestroy(&direct[k]), 0);
    }
  }
}

static LamResponse AskOne(LamResponder responder, const LamLoad *load)
{
  LamResponse response;

  assert_int_equal(LamResponderRespond(responder, 1, load, points, &response), 0);
  return response;
}

/* Points of a material with known answers, behind the responder that seals them at turgor 0.3. */
typedef struct {
  LamResponder open, sealed;
  Synthetic *material;
} Sealed;

static void SealedOpen(double bulk_modulus, Sealed *s)
{
  CHECK(SyntheticCreate(POINTS, &s->open, &s->material));
  CHECK(LamSealedResponderCreate(PETSC_COMM_SELF, s->open, POINTS, &s->sealed));
  Inflate(s->sealed, 0.3, 0);
  CHECK(LamResponderSeal(s->sealed, bulk_modulus));
}

static void SealedClose(Sealed *s)
{
  CHECK(LamResponderDestroy(&s->sealed));
  CHECK(LamResponderDestroy(&s->open));
}

#define SEALED_TEST(name, bulk_modulus) TEST_ON(name, Sealed, s, SealedOpen(bulk_modulus, s), SealedClose(s))

/* Of a material with known answers, whose whole volume is lumen: p = p0 + K_w (1 - J / J0) exactly. */
SEALED_TEST(PressureAndDerivativesAreExact, 50)
{
  const double h = 1e-4;
  LamLoad load = {.F = {1.05, 0.1, 0, -0.02, 0.98, 0, 0, 0, 1.01}, .turgor = 0.3};
  LamResponse r;
  double J;

  r = AskOne(s->sealed, &load);
  J = (1.05 * 0.98 + 0.1 * 0.02) * 1.01;
  assert_near(r.turgor_mean, 0.3 + 50 * (1 - J), 1e-9);
  for (int k = 0; k < 9; k++) {
    LamResponse plus, minus;

    load.F[k] += h;
    plus = AskOne(s->sealed, &load);
    load.F[k] -= 2 * h;
    minus = AskOne(s->sealed, &load);
    load.F[k] += h;
    assert_near(r.P[k], (plus.energy - minus.energy) / (2 * h), 1e-6);
    for (int i = 0; i < 9; i++) assert_near(r.tangent[9 * i + k], (plus.P[i] - minus.P[i]) / (2 * h), 1e-5);
  }
}

/* Tissues of other units have the same water: the pressure is as exact as of one. */
TEST(WaterIsTheSameInAllTissues)
{
  static const LamHeterogeneousPoint mosaic_points[2] = {{1, {{0, 1, 1, 1}}, 0}, {1, {{1, 1, 1, 1}}, 0.5}};
  const LamLoad load = PlaneLoad(1.01, 0.1, 0, 1, 0.3), start = PlaneLoad(1, 0, 0, 1, 0.3);
  const LamLoad loads[2] = {load, load}, starts[2] = {start, start};
  LamResponder open[2], sealed[2], heterogeneous;
  LamHeterogeneousTissue tissues[2];
  Synthetic *material;
  LamResponse r[2];

  for (int t = 0; t < 2; t++) {
    assert_int_equal(SyntheticCreate(1, &open[t], &material), 0);
    assert_int_equal(LamSealedResponderCreate(PETSC_COMM_SELF, open[t], 1, &sealed[t]), 0);
    tissues[t] = (LamHeterogeneousTissue){"", 1 + 1.5 * t, {1, 1}, sealed[t]};
  }
  assert_int_equal(LamHeterogeneousCreate(2, tissues, 2, mosaic_points, &heterogeneous), 0);
  assert_int_equal(LamResponderRespond(heterogeneous, 2, starts, points, r), 0);
  assert_int_equal(LamResponderAccept(heterogeneous), 0);
  assert_int_equal(LamResponderSeal(heterogeneous, 50), 0);
  assert_int_equal(LamResponderRespond(heterogeneous, 2, loads, points, r), 0);
  for (int t = 0; t < 2; t++) {
    assert_near(r[t].turgor_mean, 0.3 - 50 * 0.01, 1e-9);
    assert_int_equal(LamResponderDestroy(&sealed[t]), 0);
    assert_int_equal(LamResponderDestroy(&open[t]), 0);
  }
  assert_int_equal(LamResponderDestroy(&heterogeneous), 0);
}

/* A rejected step leaves no trace in the pressures that questions start from. */
SEALED_TEST(RejectedStepIsForgotten, 50)
{
  const LamLoad load = PlaneLoad(1.01, 0, 0, 1, 0.3), far = PlaneLoad(1.2, 0, 0, 1, 0.3);
  LamResponse before, after;

  before = AskOne(s->sealed, &load);
  assert_int_equal(LamResponderReject(s->sealed), 0);
  (void)AskOne(s->sealed, &far);
  assert_int_equal(LamResponderReject(s->sealed), 0);
  after = AskOne(s->sealed, &load);
  assert_memory_equal(before.P, after.P, sizeof(before.P));
  assert_int_equal(s->material->rejects, 2);
}

/* Where the tissue has no answer, that is the answer, with its reason and the pressure. */
SEALED_TEST(WhatHasNoAnswerIsTold, 50)
{
  const LamLoad load = PlaneLoad(1.2, 0, 0, 1, 0.3);
  LamResponse r;

  s->material->largest_strain = 0.1;
  r = AskOne(s->sealed, &load);
  assert_int_equal(r.status, LAM_NOT_CONVERGED);
  assert_non_null(strstr(r.reason, "sealed, at a pressure of 0.3 (C1+C2): too far"));
  assert_true(r.load.turgor == 0.3 && LamResponderGetCounters(s->sealed).failures == 1);
}

/* A database of (F, turgor) that is filled as it is asked; ctx of the responders on it. */
typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamDatabase database;
  LamResponder solver, direct, cache, sealed;
} Tabulated;

static void OpenTable(const char interface[], Tabulated *t)
{
  char text[512];
  LamGrid grid;

  snprintf(text, sizeof(text),
           "version: 1\nrve:\n  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
           "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n  interface: {%s}\n"
           "  turgor: {pressure: 0.02 MPa}\n  mesh: {along: 6, through: 2}\nsample: {stretch: {min: -0.2, max: 0.2}}\n",
           interface);
  assert_int_equal(LamSceneReadText("scene", text, &t->scene), 0);
  t->rve = NewSealable(&t->scene->micro);
  assert_int_equal(LamRVEResponderCreate(t->rve, 0, &t->solver), 0);
  assert_int_equal(LamRVEResponderCreate(t->rve, POINTS, &t->direct), 0);
  assert_int_equal(LamDatabaseCreateEmpty(t->scene, &t->database), 0);
  assert_int_equal(LamGridCreate(t->scene, t->solver, &grid), 0);
  assert_int_equal(LamDatabaseSetGrid(t->database, &grid), 0);
  assert_int_equal(LamCacheResponderCreate(PETSC_COMM_SELF, t->database, t->solver, NULL, LAM_OUTSIDE_SOLVE,
                                           t->scene->accuracy, POINTS, &t->cache),
                   0);
  assert_int_equal(LamSealedResponderCreate(PETSC_COMM_SELF, t->cache, POINTS, &t->sealed), 0);
}

static void CloseTable(Tabulated *t)
{
  assert_int_equal(LamResponderDestroy(&t->sealed), 0);
  assert_int_equal(LamResponderDestroy(&t->cache), 0);
  assert_int_equal(LamResponderDestroy(&t->direct), 0);
  assert_int_equal(LamResponderDestroy(&t->solver), 0);
  assert_int_equal(LamDatabaseClose(&t->database), 0);
  assert_int_equal(LamRVEDestroy(&t->rve), 0);
  assert_int_equal(LamSceneDestroy(&t->scene), 0);
}

#define TABULATED_TEST(name, interface) TEST_ON(name, Tabulated, t, OpenTable(interface, t), CloseTable(t))

/* Volumes that hardly change: a table made for stress to 1 % gives the pressure, too. */
TABULATED_TEST(TableOfBondedCellsGivesThePressure, "law: bonded")
{
  LamResponse solved[POINTS], answered[POINTS];
  LamLoad loads[POINTS];

  Inflate(t->direct, t->scene->turgor, 0);
  Inflate(t->sealed, t->scene->turgor, 0);
  assert_int_equal(LamResponderSeal(t->direct, SEALED_WATER), 0);
  assert_int_equal(LamResponderSeal(t->sealed, SEALED_WATER), 0);
  for (int i = 0; i < POINTS; i++)
    loads[i] = PlaneLoad(1.05, 0.1 - 0.05 * i, 0, (1 + 0.02 * i) / 1.05, t->scene->turgor);
  Ask(t->direct, loads, solved);
  Ask(t->sealed, loads, answered);
  for (int i = 0; i < POINTS; i++) {
    assert_int_equal(answered[i].source, LAM_SOURCE_DATABASE);
    assert_true(StressError(answered[i].P, solved[i].P) < 0.003);
    assert_near(answered[i].turgor_mean, solved[i].turgor_mean, 0.002);
    assert_near(answered[i].tangent[0] / solved[i].tangent[0], 1, 0.002);
  }
}

/* Where cells part a table does not know their lumens well enough. */
TABULATED_TEST(TableOfCellsThatPartIsRefused, "law: contact, cohesion: 0.02 MPa")
{
  LamLoad load = PlaneLoad(1, 0, 0, 1, 0.02 / TISSUE_STRESS);
  LamResponse r;

  load.cohesion = t->scene->cohesion;
  Inflate(t->sealed, t->scene->turgor, t->scene->cohesion);
  assert_int_equal(LamResponderSeal(t->sealed, SEALED_WATER), 0);
  r = AskOne(t->sealed, &load);
  assert_int_equal(r.source, LAM_SOURCE_DATABASE);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_non_null(strstr(r.reason, "solve directly"));
}
