/* A known potential with the symmetry of the hexagon, its exact responses, and databases of them. */
#ifndef LAM_QUERY_FIXTURE_H
#define LAM_QUERY_FIXTURE_H

#include "support/test.h"
#include <lamella/database.h>
#include <string.h>

#define THETA 0.2 /* orientation of the lattice */

typedef struct {
  PetscReal value, gradient[4], hessian[4][4];
} Potential;

static PetscReal cubic = 1; /* factor of the terms beyond the second order */

/* ---- the potential: Phi(c0, c1, c2, p) - p J, invariant under the group of the hexagon ---- */

static inline void Invariants(const PetscReal F[9], PetscReal p, PetscReal x[4])
{
  const PetscReal C11 = F[0] * F[0] + F[3] * F[3], C22 = F[1] * F[1] + F[4] * F[4];

  x[0] = 0.5 * (C11 + C22);
  x[1] = 0.5 * (C11 - C22);
  x[2] = F[0] * F[1] + F[3] * F[4];
  x[3] = p;
}

static inline void AddSmooth(const PetscReal x[4], Potential *W)
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

static inline void AddFluid(const PetscReal x[4], Potential *W)
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
static inline void Slopes(const PetscReal F[9], PetscReal K[3][9])
{
  const PetscReal D[3][2][2] = {{{1, 0}, {0, 1}}, {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}};

  memset(K, 0, 3 * 9 * sizeof(PetscReal));
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) K[a][3 * i + j] = F[3 * i] * D[a][0][j] + F[3 * i + 1] * D[a][1][j];
}

static inline void TangentOf(const Potential *W, PetscReal K[3][9], PetscReal A[81])
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
static inline void Thickness(const PetscReal x[4], PetscReal K[3][9], LamResponse *r)
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
static inline LamResponse Exact(const LamLoad *load)
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

static inline LamDatabase MakeOf(PetscInt cells0, PetscInt cells1, LamInterfaceLawType interface)
{
  const LamScene scene = {.micro = {.wall_thickness = 0.15,
                                    .orientation = THETA,
                                    .cells = {cells0, cells1},
                                    .along = 6,
                                    .through = 2,
                                    .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9, .bulk_modulus = 1000},
                                    .interface = interface},
                          .scales = {.length = 75e-6, .stress = 0.11e6},
                          .accuracy = 0.01};
  LamDatabase db;

  assert_int_equal(LamDatabaseCreateEmpty(&scene, &db), 0);
  return db;
}

static inline LamDatabase Make(PetscInt cells0, PetscInt cells1)
{
  return MakeOf(cells0, cells1, LAM_INTERFACE_BONDED);
}

static inline LamLoad Load(PetscReal F11, PetscReal F12, PetscReal F21, PetscReal F22, PetscReal turgor)
{
  return (LamLoad){.F = {F11, F12, 0, F21, F22, 0, 0, 0, 1}, .turgor = turgor};
}

static inline void AddExact(LamDatabase db, LamLoad load)
{
  const LamResponse r = Exact(&load);

  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &r), 0);
}

/* Records around `probe`, in reach of it, that are not symmetric stretches. */
static inline LamDatabase MakeFilled(void)
{
  LamDatabase db = Make(1, 1);

  AddExact(db, Load(1.05, 0.03, -0.02, 1.01, 0.1));
  AddExact(db, Load(1.08, 0.09, 0.02, 1.05, 0.3));
  AddExact(db, Load(1.03, 0.05, 0.03, 0.99, 0.2));
  AddExact(db, Load(1.09, 0.04, -0.01, 1.04, 0.15));
  return db;
}

static inline LamResponse AssertStatus(LamDatabase db, LamLoad load, LamStatus status)
{
  LamResponse r;

  assert_int_equal(LamDatabaseQuery(db, &load, PETSC_INFINITY, &r), 0);
  assert_int_equal(r.status, status);
  return r;
}

static inline LamResponse Ask(LamDatabase db, LamLoad load)
{
  return AssertStatus(db, load, LAM_CONVERGED);
}

static inline void AssertClose(PetscInt n, const PetscReal a[], const PetscReal b[], PetscReal tolerance)
{
  for (PetscInt i = 0; i < n; i++) {
    if (isnan(a[i]) && isnan(b[i])) continue;
    if (!(fabs(a[i] - b[i]) <= tolerance)) fail_msg("entry %d: %.15g, wanted %.15g", (int)i, a[i], b[i]);
  }
}

/* out = in R^T for a rotation in the plane, 3x3. */
static inline void TurnRight(const PetscReal in[9], PetscReal c, PetscReal s, PetscReal mirror, PetscReal out[9])
{
  const PetscReal R[9] = {c, -s * mirror, 0, s, c * mirror, 0, 0, 0, 1};

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      out[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) out[3 * i + j] += in[3 * i + k] * R[3 * j + k];
    }
}

/* A test on a database `db` that `make` gives. */
#define QUERY_TEST(name, make)                                                                                         \
  static void name##_on(LamDatabase db);                                                                               \
  TEST(name)                                                                                                           \
  {                                                                                                                    \
    LamDatabase db = make;                                                                                             \
                                                                                                                       \
    name##_on(db);                                                                                                     \
    LamDatabaseClose(&db);                                                                                             \
  }                                                                                                                    \
  static void name##_on(LamDatabase db)

static const LamLoad probe = {.F = {1.06, 0.06, 0, 0.01, 1.02, 0, 0, 0, 1}, .turgor = 0.15};

#endif
