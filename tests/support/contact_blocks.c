#include "contact_blocks.h"
#include "kernels.h"

/* ---- patch ---- */
#define PATCH_SLAVE 2 /* elements along the interface */
#define PATCH_MASTER 3
#define PATCH_ROWS 2
#define PATCH_STRETCH 0.9 /* of the height */
typedef struct {
  const double *x; /* [2 nx + 1] along the interface */
  int nx;
  double bottom;
  uint64_t seed;
} PatchGrid;

static void PatchPlace(void *ctx, PetscInt i, PetscInt j, PetscReal X[2])
{
  PatchGrid *grid = (PatchGrid *)ctx;
  const PetscBool inside = (PetscBool)(i > 0 && i < 2 * grid->nx && j > 0 && j < 2 * PATCH_ROWS);

  X[0] = grid->x[i] + (inside ? RandomReal(&grid->seed, -0.03, 0.03) : 0.0);
  X[1] = grid->bottom + j / (2.0 * PATCH_ROWS) + (inside ? RandomReal(&grid->seed, -0.03, 0.03) : 0.0);
}

/* Rollers at the left side, below and above, where the blocks are pressed together. */
static void PatchHold(Blocks *b)
{
  for (PetscInt a = 0; a < b->node_count; ++a) {
    const double height = b->X[a][1];

    b->held[a][0] = (PetscBool)(b->X[a][0] == 0.0);
    b->held[a][1] = (PetscBool)(height == 0.0 || height == 2.0);
    b->x[a][1] = PATCH_STRETCH * height;
  }
}

PetscErrorCode PatchCreate(Blocks *b)
{
  static const double lower[2 * PATCH_SLAVE + 1] = {0.0, 0.2, 0.4, 0.7, 1.0};
  static const double upper[2 * PATCH_MASTER + 1] = {0.0, 0.125, 0.25, 0.45, 0.65, 0.825, 1.0};
  PatchGrid grids[2] = {{lower, PATCH_SLAVE, 0.0, 3}, {upper, PATCH_MASTER, 1.0, 4}};
  PetscInt first[2];

  PetscFunctionBeginUser;
  PetscCall(BlocksCreate((2 * PATCH_ROWS + 1) * (2 * (PATCH_SLAVE + PATCH_MASTER) + 2),
                         PATCH_ROWS * (PATCH_SLAVE + PATCH_MASTER), PATCH_SLAVE, PATCH_MASTER, b));
  for (int k = 0; k < 2; k++) PetscCall(BlocksAddGrid(b, grids[k].nx, PATCH_ROWS, PatchPlace, &grids[k], &first[k]));
  for (int i = 0; i <= 2 * PATCH_SLAVE; i++) b->chain[i] = first[1] - 1 - i; /* the top of the lower block, leftwards */
  for (int i = 0; i <= 2 * PATCH_MASTER; i++) b->chain[2 * PATCH_SLAVE + 1 + i] = first[1] + i;
  for (int e = 0; e < PATCH_SLAVE; e++) b->J0[e] = b->X[b->chain[2 * e]][0] - b->X[b->chain[2 * e + 2]][0];
  PatchHold(b);
  PetscFunctionReturn(0);
}

/* In-plane deformation gradient and first Piola-Kirchhoff stress P22 at a Gauss point. */
static void PatchFields(const Blocks *b, PetscInt e, PetscInt g, double F[4], double *P22)
{
  double x[LAM_ELEMENT_NODES][2];
  MatrixPoint matrix;
  KernelPoint u;

  BlocksGather(b, e, x);
  for (int c = 0; c < 4; c++) {
    F[c] = 0.0;
    for (int a = 0; a < LAM_ELEMENT_NODES; a++) F[c] += x[a][c / 2] * b->geometry[e].dN[2 * g + c % 2][a];
  }
  matrix = MatrixAt(b->law, &b->wall, F, 1.0);
  u = VolumetricAt(&b->wall, F[0] * F[3] - F[1] * F[2] - 1.0);
  *P22 = matrix.P[3] + u.d * F[0];
}

PetscErrorCode ComputePatch(PatchError *error)
{
  PetscInt iterations;
  double F0[4], P0;
  Blocks b;

  PetscFunctionBeginUser;
  *error = (PatchError){0};
  PetscCall(PatchCreate(&b));
  PetscCall(BlocksSolve(&b, 1e-12, &iterations));
  PatchFields(&b, 0, 0, F0, &P0);
  error->pressure = -P0;
  for (PetscInt e = 0; e < b.element_count; ++e)
    for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
      double F[4], P22;

      PatchFields(&b, e, g, F, &P22);
      for (int c = 0; c < 4; c++) error->gradient = PetscMax(error->gradient, PetscAbsReal(F[c] - F0[c]));
      error->stress = PetscMax(error->stress, PetscAbsReal(P22 - P0));
    }
  for (int A = 0; A <= 2 * PATCH_SLAVE; A++)
    error->multiplier = PetscMax(error->multiplier, PetscAbsReal(b.lambda[A] + P0));
  PetscCall(BlocksDestroy(&b));
  PetscFunctionReturn(0);
}

/* ---- Hertz ---- */
#define HERTZ_APPROACH 2.5e-4 /* of the hub towards a flat base; b is then about 0.0097 */
#define HERTZ_CONTACT 0.013   /* angle that is meshed evenly, and may be in contact */
#define HERTZ_HUB 0.3         /* radius of the rigid hub */
#define HERTZ_ANGLE 1.2       /* of the sector that is meshed on one side */
#define HERTZ_GROWTH 1.25     /* of elements away from the contact */
#define HERTZ_BASE 7          /* edges of the base, which match nothing */
#define HERTZ_BASE_WIDTH 0.04 /* half of it */
#define HERTZ_NODES_MAX 256   /* in one direction */
/* Numbers of nodes 2 n + 1 at `even` equal elements from 0 to `start`, then growing ones to `end`. Returns n. */
static int GradedNodes(double start, int even, double end, double size, double at[])
{
  int n = even;

  for (int i = 0; i <= 2 * even; i++) at[i] = even ? start * i / (2.0 * even) : 0.0;
  for (; at[2 * n] < end && 2 * n + 2 < HERTZ_NODES_MAX; n++) {
    size *= HERTZ_GROWTH;
    at[2 * n + 2] = at[2 * n] + size > end - 0.5 * size ? end : at[2 * n] + size;
    at[2 * n + 1] = 0.5 * (at[2 * n] + at[2 * n + 2]);
  }
  return n;
}

typedef struct {
  double angle[HERTZ_NODES_MAX], depth[HERTZ_NODES_MAX];
  int columns, rows; /* elements: around, inwards */
} HertzGrid;

static void HertzPlace(void *ctx, PetscInt i, PetscInt j, PetscReal X[2])
{
  const HertzGrid *grid = (const HertzGrid *)ctx;
  const double r = 1.0 - grid->depth[j];

  X[0] = r * PetscSinReal(grid->angle[i]);
  X[1] = 1.0 - r * PetscCosReal(grid->angle[i]);
}

/* The rigid base runs leftwards under the cylinder. */
static void HertzAddBase(double curvature, PetscInt chain[], Blocks *b)
{
  for (PetscInt i = 0; i <= 2 * HERTZ_BASE; ++i) {
    const PetscInt node = b->node_count++;
    const double x = HERTZ_BASE_WIDTH * (1.0 - (double)i / HERTZ_BASE), kx = curvature * x;

    chain[i] = node;
    b->x[node][0] = x;
    b->x[node][1] = -curvature * x * x / (1.0 + PetscSqrtReal(1.0 - kx * kx));
    b->held[node][0] = b->held[node][1] = PETSC_TRUE;
  }
}

static PetscErrorCode HertzCreate(int even, double curvature, HertzGrid *grid, Blocks *b)
{
  const double size = HERTZ_CONTACT / even;
  PetscInt first;

  PetscFunctionBeginUser;
  grid->columns = GradedNodes(HERTZ_CONTACT, even, HERTZ_ANGLE, size, grid->angle);
  grid->rows = GradedNodes(0.0, 0, 1.0 - HERTZ_HUB, size, grid->depth);
  PetscCall(BlocksCreate((2 * grid->columns + 1) * (2 * grid->rows + 1) + 2 * HERTZ_BASE + 1,
                         grid->columns * grid->rows, even, HERTZ_BASE, b));
  PetscCall(BlocksAddGrid(b, grid->columns, grid->rows, HertzPlace, grid, &first));
  for (PetscInt a = 0; a < b->node_count; ++a) {
    const PetscBool hub = (PetscBool)(a / (2 * grid->columns + 1) == 2 * grid->rows);

    b->x[a][1] -= HERTZ_APPROACH * (1.0 + curvature);
    b->held[a][0] = (PetscBool)(hub || a % (2 * grid->columns + 1) == 0);
    b->held[a][1] = hub;
  }
  for (int i = 0; i <= 2 * even; i++) b->chain[i] = i;
  HertzAddBase(curvature, b->chain + 2 * even + 1, b);
  for (int e = 0; e < even; e++) b->J0[e] = size;
  PetscFunctionReturn(0);
}

/*
  p0 and b from a straight line through p^2 over x^2, least squares over the hats within 0.9 b: Cauchy pressures
  lambda J0 / |dX/ds| at current positions. The hats at the edge of the contact are left out, because the mesh smears
  it.
*/
static void FitHertz(Blocks *b, double within, Hertz *hertz)
{
  const LamMortarChains chains = BlocksChains(b);
  double sum[5] = {0, 0, 0, 0, 0}, slope, level;

  for (int A = 0; A <= 2 * b->n; A++) {
    double X[2], Xs[2], p, u, v;

    LamMortarSlavePoint(&chains, 0.5 * A, X, Xs);
    if (X[0] > within) continue;
    p = b->lambda[A] * b->J0[0] / PetscSqrtReal(Xs[0] * Xs[0] + Xs[1] * Xs[1]);
    u = X[0] * X[0];
    v = p * p;
    sum[0] += 1.0;
    sum[1] += u;
    sum[2] += u * u;
    sum[3] += v;
    sum[4] += u * v;
  }
  slope = (sum[0] * sum[4] - sum[1] * sum[3]) / (sum[0] * sum[2] - sum[1] * sum[1]);
  level = (sum[3] - slope * sum[1]) / sum[0];
  hertz->peak = PetscSqrtReal(level);
  hertz->half_width = PetscSqrtReal(-level / slope);
}

/* Vertical force on the slave, both halves. */
static double HertzForce(const Blocks *b)
{
  const PetscInt hats = 2 * b->n + 1, dofs = LamMortarDofs(b->n, b->m);
  double force = 0.0;

  for (PetscInt A = 0; A < hats; ++A)
    for (PetscInt a = 0; a < hats; ++a) force += 2.0 * b->lambda[A] * b->result.dgap[A * dofs + 2 * a + 1];
  return force;
}

PetscErrorCode ComputeHertz(int even, double curvature, Hertz *hertz)
{
  const double R = 1.0 / (1.0 + curvature);
  HertzGrid grid;
  Blocks b;
  double modulus;

  PetscFunctionBeginUser;
  PetscCall(HertzCreate(even, curvature, &grid, &b));
  PetscCall(BlocksSolve(&b, 1e-10, &hertz->iterations));
  modulus = BlocksPlaneStrainModulus(&b.wall);
  hertz->nodes = b.node_count;
  hertz->force = HertzForce(&b);
  hertz->peak_theory = PetscSqrtReal(hertz->force * modulus / (PETSC_PI * R));
  hertz->half_width_theory = PetscSqrtReal(4.0 * hertz->force * R / (PETSC_PI * modulus));
  FitHertz(&b, 0.9 * hertz->half_width_theory, hertz);
  PetscCall(BlocksDestroy(&b));
  PetscFunctionReturn(0);
}
