/* Answers from records of a known potential with the symmetry of the hexagon. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "assert_near.h"
#include <lamella/database.h>
#include <math.h>
#include <string.h>

#define THETA 0.2 /* orientation of the lattice */

typedef struct {
  PetscReal value, gradient[4], hessian[4][4];
} Potential;

static PetscReal cubic = 1; /* factor of the terms beyond the second order */

/* ---- the potential: Phi(c0, c1, c2, p) - p J, invariant under the group of the hexagon ---- */

static void Invariants(const PetscReal F[9], PetscReal p, PetscReal x[4])
{
  const PetscReal C11 = F[0] * F[0] + F[3] * F[3], C22 = F[1] * F[1] + F[4] * F[4];

  x[0] = 0.5 * (C11 + C22);
  x[1] = 0.5 * (C11 - C22);
  x[2] = F[0] * F[1] + F[3] * F[4];
  x[3] = p;
}

static void AddSmooth(const PetscReal x[4], Potential *W)
{
  const PetscReal u = x[0] - 1, a = x[1], b = x[2], p = x[3], k = cubic;
  const PetscReal c = k * 1.5 * cos(6 * THETA), s = k * 1.5 * sin(6 * THETA); /* of Re and Im (a + ib)^3 */

  W->value += 0.65 * u * u + 0.9 * (a * a + b * b) + k * 2 * u * (a * a + b * b) + c * (a * a * a - 3 * a * b * b) +
              s * (3 * a * a * b - b * b * b) + 0.3 * p * u - 0.01 * p * p + k * 0.05 * p * u * u;
  W->gradient[0] += 1.3 * u + k * 2 * (a * a + b * b) + 0.3 * p + k * 0.1 * p * u;
  W->gradient[1] += 1.8 * a + k * 4 * u * a + 3 * c * (a * a - b * b) + 6 * s * a * b;
  W->gradient[2] += 1.8 * b + k * 4 * u * b - 6 * c * a * b + 3 * s * (a * a - b * b);
  W->gradient[3] += 0.3 * u - 0.02 * p + k * 0.05 * u * u;
  W->hessian[0][0] += 1.3 + k * 0.1 * p;
  W->hessian[0][1] += k * 4 * a;
  W->hessian[0][2] += k * 4 * b;
  W->hessian[0][3] += 0.3 + k * 0.1 * u;
  W->hessian[1][1] += 1.8 + k * 4 * u + 6 * c * a + 6 * s * b;
  W->hessian[1][2] += -6 * c * b + 6 * s * a;
  W->hessian[2][2] += 1.8 + k * 4 * u - 6 * c * a - 6 * s * b;
  W->hessian[3][3] += -0.02;
}

static void AddFluid(const PetscReal x[4], Potential *W)
{
  const PetscReal J = sqrt(x[0] * x[0] - x[1] * x[1] - x[2] * x[2]), sign[3] = {1, -1, -1};

  W->value -= x[3] * J;
  W->gradient[3] -= J;
  for (int a = 0; a < 3; a++) {
    W->gradient[a] -= x[3] * sign[a] * x[a] / J;
    W->hessian[a][3] -= sign[a] * x[a] / J;
    for (int b = a; b < 3; b++)
      W->hessian[a][b] -= x[3] * ((a == b ? sign[a] : 0) - sign[a] * x[a] * sign[b] * x[b] / (J * J)) / J;
  }
}

/* K_a = F D_a as 3x3: the derivative of c_a with respect to F. */
static void Slopes(const PetscReal F[9], PetscReal K[3][9])
{
  const PetscReal D[3][2][2] = {{{1, 0}, {0, 1}}, {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}};

  memset(K, 0, 3 * 9 * sizeof(PetscReal));
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) K[a][3 * i + j] = F[3 * i] * D[a][0][j] + F[3 * i + 1] * D[a][1][j];
}

static void TangentOf(const Potential *W, PetscReal K[3][9], PetscReal A[81])
{
  const PetscReal S[2][2] = {{W->gradient[0] + W->gradient[1], W->gradient[2]},
                             {W->gradient[2], W->gradient[0] - W->gradient[1]}};

  for (int i = 0; i < 81; i++) A[i] = NAN;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) {
          PetscReal *entry = &A[27 * i + 9 * j + 3 * k + l];

          *entry = i == k ? S[j][l] : 0;
          for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) *entry += W->hessian[a][b] * K[a][3 * i + j] * K[b][3 * k + l];
        }
}

/* P33 = 0.4 (c0 - 1) + 0.1 p - p J: linear besides the fluid, so that the first order is exact. */
static void Thickness(const PetscReal x[4], PetscReal K[3][9], LamResponse *r)
{
  const PetscReal J = sqrt(x[0] * x[0] - x[1] * x[1] - x[2] * x[2]), sign[3] = {1, -1, -1};

  r->P[8] = 0.4 * (x[0] - 1) + 0.1 * x[3] - x[3] * J;
  r->P_turgor[8] = 0.1 - J;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      PetscReal *entry = &r->tangent[72 + 3 * i + j];

      *entry = 0.4 * K[0][3 * i + j];
      for (int a = 0; a < 3; a++) *entry -= x[3] * sign[a] * x[a] / J * K[a][3 * i + j];
      r->tangent[27 * i + 9 * j + 8] = *entry;
    }
  r->tangent[80] = 2.5;
}

/* The exact response. Face tractions n_k . C n_k stand for any quantity that belongs to a face. */
static LamResponse Exact(const LamLoad *load)
{
  Potential W = {0};
  LamResponse r;
  PetscReal x[4], K[3][9];

  LamResponseInit(load, &r);
  Invariants(load->F, load->turgor, x);
  AddSmooth(x, &W);
  AddFluid(x, &W);
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < a; b++) W.hessian[a][b] = W.hessian[b][a];
  Slopes(load->F, K);
  r.energy = W.value;
  r.lumen_fraction = -W.gradient[3];
  r.energy_turgor = W.gradient[3];
  r.energy_turgor2 = W.hessian[3][3];
  for (int i = 0; i < 9; i++) {
    r.P[i] = r.P_turgor[i] = 0;
    for (int a = 0; a < 3; a++) {
      r.P[i] += W.gradient[a] * K[a][i];
      r.P_turgor[i] += W.hessian[a][3] * K[a][i];
    }
  }
  TangentOf(&W, K, r.tangent);
  Thickness(x, K, &r);
  for (int k = 0; k < 3; k++) {
    const PetscReal angle = 2 * (THETA + k * PETSC_PI / 3);

    r.mean_face_traction[k] = x[0] + x[1] * cos(angle) + x[2] * sin(angle);
  }
  r.status = LAM_CONVERGED;
  r.stable = PETSC_TRUE;
  return r;
}

/* ---- fixtures ---- */

static LamDatabase Make(PetscInt cells0, PetscInt cells1)
{
  LamScene scene = {.micro = {.wall_thickness = 0.15,
                              .orientation = THETA,
                              .cells = {cells0, cells1},
                              .along = 6,
                              .through = 2,
                              .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9, .bulk_modulus = 1000}},
                    .scales = {.length = 75e-6, .stress = 0.11e6},
                    .accuracy = 0.01};
  LamDatabase db;

  assert_int_equal(LamDatabaseCreateEmpty(&scene, &db), 0);
  return db;
}

static LamLoad Load(PetscReal F11, PetscReal F12, PetscReal F21, PetscReal F22, PetscReal turgor)
{
  return (LamLoad){{F11, F12, 0, F21, F22, 0, 0, 0, 1}, turgor, 0};
}

static void AddExact(LamDatabase db, LamLoad load)
{
  const LamResponse r = Exact(&load);

  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &r), 0);
}

/* A few records that are not symmetric stretches. */
static LamDatabase MakeFilled(void)
{
  LamDatabase db = Make(1, 1);

  AddExact(db, Load(1.05, 0.03, -0.02, 1.01, 0.1));
  AddExact(db, Load(1.1, 0.1, 0, 1, 0.3));
  AddExact(db, Load(0.98, 0, 0.15, 1.12, 0.2));
  return db;
}

static LamResponse Ask(LamDatabase db, LamLoad load)
{
  LamResponse r;

  assert_int_equal(LamDatabaseQuery(db, &load, PETSC_INFINITY, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

static void AssertClose(PetscInt n, const PetscReal a[], const PetscReal b[], PetscReal tolerance)
{
  for (PetscInt i = 0; i < n; i++) {
    if (isnan(a[i]) && isnan(b[i])) continue;
    if (!(fabs(a[i] - b[i]) <= tolerance)) fail_msg("entry %d: %.15g, wanted %.15g", (int)i, a[i], b[i]);
  }
}

/* out = in R^T for a rotation in the plane, 3x3. */
static void TurnRight(const PetscReal in[9], PetscReal c, PetscReal s, PetscReal mirror, PetscReal out[9])
{
  const PetscReal R[9] = {c, -s * mirror, 0, s, c * mirror, 0, 0, 0, 1};

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      out[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) out[3 * i + j] += in[3 * i + k] * R[3 * j + k];
    }
}

static const LamLoad probe = {{1.06, 0.06, 0, 0.01, 1.02, 0, 0, 0, 1}, 0.15, 0};

/* ---- tests ---- */

static void a_record_answers_for_itself(void **state)
{
  LamDatabase db = MakeFilled();
  const LamLoad load = Load(1.1, 0.1, 0, 1, 0.3);
  const LamResponse exact = Exact(&load), r = Ask(db, load);

  AssertClose(1, &r.energy, &exact.energy, 1e-14);
  AssertClose(9, r.P, exact.P, 1e-13);
  AssertClose(81, r.tangent, exact.tangent, 1e-12);
  AssertClose(9, r.P_turgor, exact.P_turgor, 1e-13);
  AssertClose(1, &r.lumen_fraction, &exact.lumen_fraction, 1e-14);
  assert_near(r.distance, 0, 1e-12);
  LamDatabaseClose(&db);
}

static void stress_is_the_gradient_of_the_answered_energy(void **state)
{
  LamDatabase db = MakeFilled();
  const LamResponse r = Ask(db, probe);
  const PetscReal h = 1e-5;
  const int in_plane[4] = {0, 1, 3, 4};

  for (int i = 0; i < 4; i++) {
    LamLoad plus = probe, minus = probe;

    plus.F[in_plane[i]] += h;
    minus.F[in_plane[i]] -= h;
    assert_near((Ask(db, plus).energy - Ask(db, minus).energy) / (2 * h), r.P[in_plane[i]], 1e-9);
  }
  LamDatabaseClose(&db);
}

static void the_tangent_is_the_gradient_of_the_answered_stress(void **state)
{
  LamDatabase db = MakeFilled();
  const LamResponse r = Ask(db, probe);
  const PetscReal h = 1e-5;
  const int in_plane[4] = {0, 1, 3, 4};

  for (int i = 0; i < 4; i++) {
    LamLoad plus = probe, minus = probe;
    LamResponse a, b;

    plus.F[in_plane[i]] += h;
    minus.F[in_plane[i]] -= h;
    a = Ask(db, plus);
    b = Ask(db, minus);
    for (int j = 0; j < 4; j++)
      assert_near((a.P[in_plane[j]] - b.P[in_plane[j]]) / (2 * h), r.tangent[9 * in_plane[j] + in_plane[i]], 1e-8);
    assert_near((a.P[8] - b.P[8]) / (2 * h), r.tangent[72 + in_plane[i]], 1e-8);
  }
  LamDatabaseClose(&db);
}

static void turgor_derivatives_belong_to_the_answered_energy(void **state)
{
  LamDatabase db = MakeFilled();
  const LamResponse r = Ask(db, probe);
  const PetscReal h = 1e-4;
  LamLoad plus = probe, minus = probe;
  LamResponse a, b;

  plus.turgor += h;
  minus.turgor -= h;
  a = Ask(db, plus);
  b = Ask(db, minus);
  assert_near((a.energy - b.energy) / (2 * h), -r.lumen_fraction, 1e-10);
  for (int i = 0; i < 9; i++) assert_near((a.P[i] - b.P[i]) / (2 * h), r.P_turgor[i], 1e-10);
  LamDatabaseClose(&db);
}

static void the_tangent_has_major_symmetry(void **state)
{
  LamDatabase db = MakeFilled();
  const LamResponse r = Ask(db, probe);

  for (int i = 0; i < 9; i++)
    for (int j = 0; j < i; j++)
      if (!isnan(r.tangent[9 * i + j])) assert_near(r.tangent[9 * i + j], r.tangent[9 * j + i], 1e-14);
  LamDatabaseClose(&db);
}

static void tangent_entries_of_the_out_of_plane_shear_are_unknown(void **state)
{
  LamDatabase db = MakeFilled();
  const LamResponse r = Ask(db, probe);

  assert_true(isnan(r.tangent[9 * 2 + 2]) && isnan(r.tangent[9 * 0 + 5]) && isnan(r.tangent[9 * 8 + 7]));
  LamDatabaseClose(&db);
}

static void a_rotation_of_space_rotates_the_stress(void **state)
{
  LamDatabase db = MakeFilled();
  const LamResponse r = Ask(db, probe);

  for (PetscReal angle = 0.1; angle < 6; angle += 0.37) {
    const PetscReal c = cos(angle), s = sin(angle);
    LamLoad turned = probe;
    LamResponse t;
    PetscReal P[9];

    for (int j = 0; j < 2; j++) {
      turned.F[j] = c * probe.F[j] - s * probe.F[3 + j];
      turned.F[3 + j] = s * probe.F[j] + c * probe.F[3 + j];
    }
    t = Ask(db, turned);
    memcpy(P, r.P, sizeof(P));
    for (int j = 0; j < 2; j++) {
      P[j] = c * r.P[j] - s * r.P[3 + j];
      P[3 + j] = s * r.P[j] + c * r.P[3 + j];
    }
    AssertClose(9, t.P, P, 1e-12);
    AssertClose(1, &t.energy, &r.energy, 1e-12);
  }
  LamDatabaseClose(&db);
}

static void images_of_the_lattice_have_the_same_answer(void **state)
{
  LamDatabase db = MakeFilled();
  const LamResponse r = Ask(db, probe);

  for (int image = 0; image < 12; image++) {
    const PetscReal mirror = image < 6 ? 1 : -1;
    const PetscReal angle = image * PETSC_PI / 3 + (mirror < 0 ? 2 * THETA : 0);
    LamLoad turned = probe;
    LamResponse t;
    PetscReal P[9];

    TurnRight(probe.F, cos(angle), sin(angle), mirror, turned.F);
    if (mirror < 0) /* a mirrored sample is seen with a mirrored frame, or det F < 0 */
      for (int j = 0; j < 3; j++) turned.F[3 + j] *= -1;
    t = Ask(db, turned);
    TurnRight(r.P, cos(angle), sin(angle), mirror, P);
    if (mirror < 0)
      for (int j = 0; j < 3; j++) P[3 + j] *= -1;
    AssertClose(9, t.P, P, 1e-12);
    AssertClose(1, &t.energy, &r.energy, 1e-12);
  }
  LamDatabaseClose(&db);
}

static void faces_are_renamed_with_the_image(void **state)
{
  for (int image = 0; image < 12; image++) {
    const PetscReal mirror = image < 6 ? 1 : -1;
    const PetscReal angle = image * PETSC_PI / 3 + (mirror < 0 ? 2 * THETA : 0);
    LamDatabase db = Make(1, 1);
    LamLoad turned = probe;
    LamResponse exact, r;

    AddExact(db, probe);
    TurnRight(probe.F, cos(angle), sin(angle), mirror, turned.F);
    if (mirror < 0)
      for (int j = 0; j < 3; j++) turned.F[3 + j] *= -1;
    exact = Exact(&turned);
    r = Ask(db, turned);
    assert_near(r.distance, 0, 1e-12);
    AssertClose(3, r.mean_face_traction, exact.mean_face_traction, 1e-12);
    LamDatabaseClose(&db);
  }
}

/* ---- contact ---- */

static const PetscReal g = 0.2; /* cohesion of the records */

/* The exact response with a gap whose volume is linear in C and p: 0.05 + 0.2 (c0 - 1) - 0.03 p. */
static LamResponse ExactContact(LamLoad load)
{
  LamResponse r;
  PetscReal x[4], K[3][9];

  load.cohesion = g;
  r = Exact(&load);
  Invariants(load.F, load.turgor, x);
  Slopes(load.F, K);
  r.opening_fraction = r.energy_cohesion = 0.05 + 0.2 * (x[0] - 1) - 0.03 * x[3];
  for (int i = 0; i < 9; i++) r.P_cohesion[i] = 0.2 * K[0][i];
  r.energy_turgor_cohesion = -0.03;
  r.energy_cohesion2 = -0.5;
  r.max_gap = 0.01;
  r.cell_clusters = 1;
  for (int k = 0; k < 3; k++) r.fabric[k] = 0.1 * k;
  return r;
}

static LamDatabase MakeContact(LamLoad load)
{
  LamScene scene = {.micro = {.wall_thickness = 0.15,
                              .orientation = THETA,
                              .cells = {1, 1},
                              .along = 6,
                              .through = 2,
                              .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9, .bulk_modulus = 1000},
                              .interface = LAM_INTERFACE_CONTACT},
                    .scales = {.length = 75e-6, .stress = 0.11e6},
                    .accuracy = 0.01};
  const LamResponse r = ExactContact(load);
  LamDatabase db;

  assert_int_equal(LamDatabaseCreateEmpty(&scene, &db), 0);
  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &r), 0);
  return db;
}

static LamResponse AskContact(LamDatabase db, LamLoad load)
{
  load.cohesion = g;
  return Ask(db, load);
}

static void the_opening_follows_its_derivatives(void **state)
{
  LamDatabase db = MakeContact(Load(1.1, 0.1, 0, 1, 0.3));
  const LamResponse exact = ExactContact(probe), r = AskContact(db, probe);

  AssertClose(1, &r.opening_fraction, &exact.opening_fraction, 1e-14);
  AssertClose(9, r.P_cohesion, exact.P_cohesion, 1e-14);
  AssertClose(1, &r.energy_turgor_cohesion, &exact.energy_turgor_cohesion, 1e-14);
  LamDatabaseClose(&db);
}

static void gaps_are_known_in_the_state_of_a_record_alone(void **state)
{
  LamDatabase db = MakeContact(probe);
  LamLoad near = probe, turned = probe;
  LamResponse r = AskContact(db, probe);

  assert_near(r.max_gap, 0.01, 1e-15);
  assert_near(r.fabric[2], 0.2, 1e-15);
  assert_int_equal(r.cell_clusters, 1);
  near.F[1] += 1e-3;
  r = AskContact(db, near);
  assert_true(isnan(r.max_gap) && isnan(r.fabric[2]) && isnan(r.debonded_fraction) && isnan(r.max_traction));
  assert_int_equal(r.cell_clusters, LAM_UNKNOWN_COUNT);
  for (int j = 0; j < 3; j++) { /* turned by a right angle in space: the same gaps elsewhere */
    turned.F[j] = -probe.F[3 + j];
    turned.F[3 + j] = probe.F[j];
  }
  r = AskContact(db, turned);
  assert_near(r.max_gap, 0.01, 1e-15);
  assert_true(isnan(r.fabric[2]));
  LamDatabaseClose(&db);
}

static void contact_tissue_is_answered_at_the_cohesion_of_its_records(void **state)
{
  LamDatabase db = MakeContact(probe);
  LamLoad load = probe;
  LamResponse r;

  load.cohesion = g + 1e-10; /* a cache rounds so much */
  assert_int_equal(LamDatabaseQuery(db, &load, 0.01, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  load.cohesion = 0;
  assert_int_equal(LamDatabaseQuery(db, &load, 0.01, &r), 0);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  LamDatabaseClose(&db);
}

static void a_record_without_a_tangent_does_not_answer(void **state)
{
  LamResponse floating = ExactContact(probe);
  LamDatabase db = MakeContact(Load(1.1, 0.1, 0, 1, 0.3));
  LamLoad load = probe;

  for (int i = 0; i < 81; i++) floating.tangent[i] = NAN;
  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &floating), 0);
  load.cohesion = g;
  assert_true(Ask(db, load).distance > 0.01);
  LamDatabaseClose(&db);
}

static void unequal_cell_counts_have_no_sixfold_symmetry(void **state)
{
  LamDatabase db = Make(2, 1);
  LamLoad turned = probe;

  AddExact(db, probe);
  TurnRight(probe.F, 0.5, sqrt(0.75), 1, turned.F);
  assert_true(Ask(db, turned).distance > 0.01);
  LamDatabaseClose(&db);
}

/* Without terms of third order nothing is left out, however far the record: the fluid term is exact. */
static void a_quadratic_potential_is_answered_exactly(void **state)
{
  LamDatabase db = Make(1, 1);
  LamResponse exact, r;

  cubic = 0;
  AddExact(db, Load(1.02, 0.3, -0.1, 0.9, 0));
  exact = Exact(&probe);
  r = Ask(db, probe);
  cubic = 1;
  AssertClose(9, r.P, exact.P, 1e-13);
  AssertClose(81, r.tangent, exact.tangent, 1e-12);
  LamDatabaseClose(&db);
}

static PetscReal StressErrorAt(PetscReal step)
{
  LamDatabase db = Make(1, 1);
  const LamLoad near = Load(1.1 + step, 0.1 - step, step, 1 + 0.5 * step, 0.3 + step);
  LamResponse exact = Exact(&near), r;

  AddExact(db, Load(1.1, 0.1, 0, 1, 0.3));
  r = Ask(db, near);
  LamDatabaseClose(&db);
  return LamStressError(r.P, exact.P);
}

static void the_stress_error_falls_with_the_square_of_the_distance(void **state)
{
  const PetscReal ratio = StressErrorAt(0.02) / StressErrorAt(0.01);

  assert_true(ratio > 3.5 && ratio < 4.5);
}

static void what_is_too_far_is_out_of_reach(void **state)
{
  LamDatabase db = MakeFilled();
  LamLoad load = Load(1.5, 0, 0, 1.5, 0.1);
  LamResponse r;

  assert_int_equal(LamDatabaseQuery(db, &load, 0.04, &r), 0);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_true(r.distance > 0.04 && isnan(r.energy) && strlen(r.reason) > 0);
  LamDatabaseClose(&db);
}

static void an_inverted_state_is_invalid(void **state)
{
  LamDatabase db = MakeFilled();
  const LamLoad bad[2] = {Load(-1, 0, 0, 1, 0), Load(NAN, 0, 0, 1, 0)};

  for (int i = 0; i < 2; i++) {
    LamResponse r;

    assert_int_equal(LamDatabaseQuery(db, &bad[i], PETSC_INFINITY, &r), 0);
    assert_int_equal(r.status, LAM_INVALID_F);
  }
  LamDatabaseClose(&db);
}

static void a_stretch_of_the_thickness_is_out_of_reach(void **state)
{
  LamDatabase db = MakeFilled();
  LamLoad load = probe;
  LamResponse r;

  load.F[8] = 1.01;
  assert_int_equal(LamDatabaseQuery(db, &load, PETSC_INFINITY, &r), 0);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  LamDatabaseClose(&db);
}

static void unstable_and_failed_records_do_not_answer(void **state)
{
  LamDatabase db = Make(1, 1);
  LamResponse records[2] = {Exact(&probe), Exact(&probe)}, r;

  records[0].status = LAM_NOT_CONVERGED;
  records[1].stable = PETSC_FALSE;
  assert_int_equal(LamDatabaseAdd(db, 2, NULL, records), 0);
  assert_int_equal(LamDatabaseQuery(db, &probe, PETSC_INFINITY, &r), 0);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  LamDatabaseClose(&db);
}

static void the_hinted_record_is_kept_while_in_reach(void **state)
{
  LamDatabase db = Make(1, 1);
  LamResponse r;
  PetscInt hint = -1, kept;
  const LamLoad first = Load(1.08, 0.06, 0.01, 1.02, 0.15);

  AddExact(db, Load(1.08, 0.06, 0.01, 1.02, 0.15));
  AddExact(db, probe);
  assert_int_equal(LamDatabaseQuery(db, &first, 0.05, &r), 0);
  kept = hint;
  assert_int_equal(LamDatabaseQuery(db, &probe, 0.05, &r), 0);
  assert_true(hint == kept && r.distance > 0.01);
  assert_int_equal(LamDatabaseQuery(db, &probe, 0.01, &r), 0);
  assert_true(hint != kept && r.distance < 1e-12);
  LamDatabaseClose(&db);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_record_answers_for_itself),
      cmocka_unit_test(stress_is_the_gradient_of_the_answered_energy),
      cmocka_unit_test(the_tangent_is_the_gradient_of_the_answered_stress),
      cmocka_unit_test(turgor_derivatives_belong_to_the_answered_energy),
      cmocka_unit_test(the_tangent_has_major_symmetry),
      cmocka_unit_test(tangent_entries_of_the_out_of_plane_shear_are_unknown),
      cmocka_unit_test(a_rotation_of_space_rotates_the_stress),
      cmocka_unit_test(images_of_the_lattice_have_the_same_answer),
      cmocka_unit_test(faces_are_renamed_with_the_image),
      cmocka_unit_test(the_opening_follows_its_derivatives),
      cmocka_unit_test(gaps_are_known_in_the_state_of_a_record_alone),
      cmocka_unit_test(contact_tissue_is_answered_at_the_cohesion_of_its_records),
      cmocka_unit_test(a_record_without_a_tangent_does_not_answer),
      cmocka_unit_test(unequal_cell_counts_have_no_sixfold_symmetry),
      cmocka_unit_test(a_quadratic_potential_is_answered_exactly),
      cmocka_unit_test(the_stress_error_falls_with_the_square_of_the_distance),
      cmocka_unit_test(what_is_too_far_is_out_of_reach),
      cmocka_unit_test(an_inverted_state_is_invalid),
      cmocka_unit_test(a_stretch_of_the_thickness_is_out_of_reach),
      cmocka_unit_test(unstable_and_failed_records_do_not_answer),
      cmocka_unit_test(the_hinted_record_is_kept_while_in_reach),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
