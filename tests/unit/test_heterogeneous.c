/* Claims about bodies of different tissue: turned, scaled and blended answers are those of one potential. */
#include "support/test.h"
#include <lamella/heterogeneous.h>
#include "support/random_reals.h"
#include "support/synthetic_responder.h"

enum { TISSUES = 3, POINTS = 4 };

typedef struct {
  LamResponder responder[TISSUES], heterogeneous;
  Synthetic *material[TISSUES];
  LamHeterogeneousTissue tissues[TISSUES];
} Fixture;

static const LamHeterogeneousPoint points[POINTS] = {
    {1, {{0, 1, 1, 1}}, 0},
    {1, {{1, 1, 1, 1}}, 0.4},
    {3, {{0, -0.1, 0.3, 0}, {1, 0.8, 0.7, 0.75}, {2, 0.3, 0, 0.25}}, -0.7},
    {1, {{2, 1, 1, 1}}, 1.2},
};

/* A neo-Hookean material is isotropic: this one is stiffer in its first direction of reference. */
static PetscErrorCode StiffRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt numbers[],
                                   LamResponse responses[])
{
  PetscFunctionBeginUser;
  PetscCall(SyntheticRespond(ctx, n, loads, numbers, responses));
  for (PetscInt q = 0; q < n; q++) { /* + (|F e1|^2 - 1)^2 / 4 */
    const PetscReal *F = loads[q].F, stretch = F[0] * F[0] + F[3] * F[3] + F[6] * F[6];
    LamResponse *r = &responses[q];

    if (!LamResponseHasFields(r)) continue;
    r->energy += 0.25 * PetscSqr(stretch - 1);
    for (int i = 0; i < 3; i++) {
      r->P[3 * i] += (stretch - 1) * F[3 * i];
      for (int k = 0; k < 3; k++) r->tangent[9 * (3 * i) + 3 * k] += 2 * F[3 * i] * F[3 * k] + (i == k) * (stretch - 1);
    }
  }
  PetscFunctionReturn(0);
}

static void SetUp(Fixture *fixture)
{
  static const char *const names[TISSUES] = {"", "skin", "core"};
  static const PetscReal stress[TISSUES] = {1, 2.5, 0.4};

  for (int t = 0; t < TISSUES; t++) {
    const PetscInt count = LamHeterogeneousPointCount(POINTS, points, t);

    assert_int_equal(count, 2);
    assert_int_equal(SyntheticCreate(count, &fixture->responder[t], &fixture->material[t]), 0);
    fixture->material[t]->respond = StiffRespond;
    fixture->material[t]->mu = 1 + t;
    fixture->tissues[t] = (LamHeterogeneousTissue){names[t], stress[t], {1, 1}, fixture->responder[t]};
  }
  assert_int_equal(LamHeterogeneousCreate(TISSUES, fixture->tissues, POINTS, points, &fixture->heterogeneous), 0);
}

static void TearDown(Fixture *fixture)
{
  assert_int_equal(LamResponderDestroy(&fixture->heterogeneous), 0);
  for (int t = 0; t < TISSUES; t++) assert_int_equal(LamResponderDestroy(&fixture->responder[t]), 0);
}

#define MOSAIC_TEST(name) TEST_ON(name, Fixture, fixture, SetUp(fixture), TearDown(fixture))

static LamResponse Ask(Fixture *fixture, PetscInt point, LamLoad load)
{
  LamResponse response;

  assert_int_equal(LamResponderRespond(fixture->heterogeneous, 1, &load, &point, &response), 0);
  assert_int_equal(response.status, LAM_CONVERGED);
  return response;
}

static LamLoad RandomLoad(uint64_t *seed)
{
  LamLoad load = {.turgor = RandomReal(seed, 0, 0.4), .cohesion = 0};

  for (int k = 0; k < 9; k++) load.F[k] = (k % 4 == 0) + (k == 2 || k > 4 ? 0 : RandomReal(seed, -0.2, 0.2));
  return load;
}

MOSAIC_TEST(stress_and_tangent_are_derivatives_of_the_energy)
{
  const PetscReal h = 1e-5;
  uint64_t seed = 7;

  for (PetscInt p = 0; p < POINTS; p++) {
    const LamLoad load = RandomLoad(&seed);
    const LamResponse at = Ask(fixture, p, load);

    for (int kl = 0; kl < 9; kl++) {
      LamLoad plus = load, minus = load;
      LamResponse after, before;

      plus.F[kl] += h;
      minus.F[kl] -= h;
      after = Ask(fixture, p, plus);
      before = Ask(fixture, p, minus);
      assert_near(at.P[kl], (after.energy - before.energy) / (2 * h), 1e-8);
      for (int ij = 0; ij < 9; ij++) assert_near(at.tangent[9 * ij + kl], (after.P[ij] - before.P[ij]) / (2 * h), 1e-7);
    }
  }
}

MOSAIC_TEST(turgor_is_in_the_units_of_the_body)
{
  const PetscReal h = 1e-5;
  uint64_t seed = 8;

  for (PetscInt p = 0; p < POINTS; p++) {
    LamLoad load = RandomLoad(&seed);
    const LamResponse at = Ask(fixture, p, load);
    LamResponse after, before;

    load.turgor += h;
    after = Ask(fixture, p, load);
    load.turgor -= 2 * h;
    before = Ask(fixture, p, load);
    assert_near(at.energy_turgor, (after.energy - before.energy) / (2 * h), 1e-9);
    for (int k = 0; k < 9; k++) assert_near(at.P_turgor[k], (after.P[k] - before.P[k]) / (2 * h), 1e-9);
    assert_near(at.lumen_fraction, -at.energy_turgor, 1e-12);
  }
}

TEST(the_angle_turns_the_stiff_direction)
{
  const PetscReal stretch = 1.1, angle = points[3].angle, c = cos(angle), s = sin(angle);
  const LamLoad own = {.F = {stretch, 0, 0, 0, 1, 0, 0, 0, 1}};
  /* the same stretch along the stiff direction where it now lies, F = R U R^T, so that F Q = R U */
  const LamLoad turned = {.F = {1 + (stretch - 1) * c * c, (stretch - 1) * c * s, 0, (stretch - 1) * c * s,
                                1 + (stretch - 1) * s * s, 0, 0, 0, 1}};
  LamResponse plain;
  PetscInt number = 0;
  Fixture fixture;

  SetUp(&fixture);
  assert_int_equal(LamResponderRespond(fixture.responder[2], 1, &own, &number, &plain), 0);
  assert_near(Ask(&fixture, 3, turned).energy, 0.4 * plain.energy, 1e-12);
  TearDown(&fixture);
}

MOSAIC_TEST(each_tissue_is_asked_once_and_told_of_the_end)
{
  const PetscInt all[POINTS] = {0, 1, 2, 3};
  LamResponse responses[POINTS];
  LamLoad loads[POINTS];
  uint64_t seed = 9;

  for (int p = 0; p < POINTS; p++) loads[p] = RandomLoad(&seed);
  assert_int_equal(LamResponderRespond(fixture->heterogeneous, POINTS, loads, all, responses), 0);
  assert_int_equal(LamResponderRespond(fixture->heterogeneous, 0, NULL, NULL, NULL), 0);
  assert_int_equal(LamResponderAccept(fixture->heterogeneous), 0);
  assert_int_equal(LamResponderReject(fixture->heterogeneous), 0);
  for (int t = 0; t < TISSUES; t++) {
    assert_int_equal(fixture->material[t]->calls, 2);
    assert_int_equal(fixture->material[t]->accepts, 1);
    assert_int_equal(fixture->material[t]->rejects, 1);
  }
  assert_int_equal(LamResponderGetCounters(fixture->heterogeneous).queries,
                   6); /* the blended point asks three tissues */
  assert_int_equal(LamResponderGetCounters(fixture->heterogeneous).solves, 6);
}

MOSAIC_TEST(a_term_without_answer_is_named)
{
  const LamLoad load = {.F = {1, 0.5, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.1};
  const PetscInt blended = 2;
  LamResponse response;

  fixture->material[1]->largest_strain = 0.1;
  assert_int_equal(LamResponderRespond(fixture->heterogeneous, 1, &load, &blended, &response), 0);
  assert_int_equal(response.status, LAM_NOT_CONVERGED);
  assert_string_equal(response.reason, "skin: too far");
  for (int k = 0; k < 9; k++) assert_true(response.load.F[k] == load.F[k]);
}
