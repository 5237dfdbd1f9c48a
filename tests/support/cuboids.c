#include "cuboids.h"

#define CUBOIDS_C4 1.0      /* MPa */
#define CUBOIDS_GRADING 0.7 /* elements at the sides are 1 - this of the mean width */
#define CUBOIDS_TOLERANCE 1e-10
#define CUBOIDS_SMALLEST_STEP (1.0 / 64.0) /* of the shear, when steps are halved */
#define CUBOIDS_MARGIN 0.1                 /* next to the grips, where corners are singular: left out of what follows */
#define CUBOIDS_OPEN 1e-3                  /* a gap that counts as open */
/* The wall of the paper's eq. 4.1, C1 = 0.1, C2 = 0.01, C4 = 1 MPa, kappa = 1000 (C1 + C2). */
static LamWall CuboidsWall(PetscReal C4)
{
  return (LamWall){.law = LAM_WALL_FIBRE_MOONEY_RIVLIN,
                   .fibres = LAM_FIBRES_BOTH,
                   .C1 = 0.1 / CUBOIDS_STRESS,
                   .C2 = 0.01 / CUBOIDS_STRESS,
                   .C4 = C4 / CUBOIDS_STRESS,
                   .bulk_modulus = 1000.0};
}

CuboidsSetup CuboidsDefault(PetscInt n, PetscReal shear, PetscReal pressure)
{
  return (CuboidsSetup){.n = n,
                        .top = {shear, shear},
                        .pressure = pressure / CUBOIDS_STRESS,
                        .wall = {CuboidsWall(CUBOIDS_C4), CuboidsWall(CUBOIDS_C4)}};
}

CuboidsSetup CuboidsUnequal(PetscInt n, PetscReal shear, PetscReal pressure)
{
  CuboidsSetup setup = CuboidsDefault(n, shear, pressure);

  setup.wall[1] = CuboidsWall(0.1 * CUBOIDS_C4);
  return setup;
}

/* Places 0..1 of n elements, finer at both ends; middle nodes are in the middle. */
static PetscReal CuboidsNode(PetscInt n, PetscInt i)
{
  const PetscReal t = (PetscReal)(i / 2) / (PetscReal)n;

  if (i % 2) return 0.5 * (CuboidsNode(n, i - 1) + CuboidsNode(n, i + 1));
  return t - CUBOIDS_GRADING * PetscSinReal(2.0 * PETSC_PI * t) / (2.0 * PETSC_PI);
}

typedef struct {
  PetscInt n;
  PetscReal left;
} CuboidsGrid;

static void CuboidsPlace(void *ctx, PetscInt i, PetscInt j, PetscReal X[2])
{
  const CuboidsGrid *grid = (const CuboidsGrid *)ctx;

  X[0] = grid->left + CuboidsNode(grid->n, i);
  X[1] = CuboidsNode(grid->n, j);
}

/* Pressure outside, suction of the cohesion at the interface. */
static void CuboidsPress(Cuboids *c)
{
  const PetscInt n = c->setup.n;

  for (PetscInt body = 0; body < 2; ++body)
    for (PetscInt j = 0; j < n; ++j) {
      const PetscInt left = body * n * n + j * n, right = left + n - 1;

      c->blocks.pressure[body == 0 ? left : right][body == 0 ? 3 : 1] = c->load.pressure;
      c->blocks.pressure[body == 0 ? right : left][body == 0 ? 1 : 3] = -c->setup.cohesion;
    }
}

/* The interface: up along the left body, down along the right one; closed under pressure to begin with. */
static void CuboidsJoin(Cuboids *c)
{
  const PetscInt n = c->setup.n, nodes = 2 * n + 1;
  const PetscReal closing = c->setup.pressure + c->setup.cohesion;
  Blocks *b = &c->blocks;

  for (PetscInt j = 0; j < nodes; ++j) {
    b->chain[j] = c->first[0] + j * nodes + 2 * n;
    b->chain[nodes + j] = c->first[1] + (2 * n - j) * nodes;
    b->lambda[j] = closing;
  }
  for (PetscInt e = 0; e < n; ++e) b->J0[e] = CuboidsNode(n, 2 * e + 2) - CuboidsNode(n, 2 * e);
  b->ends_held = PETSC_TRUE;
}

PetscErrorCode CuboidsCreate(const CuboidsSetup *setup, Cuboids *c)
{
  const PetscInt n = setup->n, nodes = 2 * n + 1;
  Blocks *b = &c->blocks;

  PetscFunctionBeginUser;
  *c = (Cuboids){.setup = *setup, .load = {0.0, setup->pressure}};
  PetscCall(BlocksCreate(2 * nodes * nodes, 2 * n * n, n, n, b));
  PetscCall(LamWallLawGet(LAM_WALL_FIBRE_MOONEY_RIVLIN, &b->law));
  b->plane_stress = setup->plane_stress;
  b->fibre[0] = 0.0;
  b->fibre[1] = 1.0;
  for (PetscInt body = 0; body < 2; ++body) {
    CuboidsGrid grid = {n, (PetscReal)body - 1.0};

    b->wall = setup->wall[body];
    PetscCall(BlocksAddGrid(b, n, n, CuboidsPlace, &grid, &c->first[body]));
  }
  c->first[2] = b->node_count;
  for (PetscInt a = 0; a < b->node_count; ++a)
    b->held[a][0] = b->held[a][1] = (PetscBool)(b->X[a][1] == 0.0 || b->X[a][1] == 1.0);
  CuboidsPress(c);
  CuboidsJoin(c);
  BlocksStartUnder(b, setup->pressure);
  PetscFunctionReturn(0);
}

PetscErrorCode CuboidsDestroy(Cuboids *c)
{
  PetscFunctionBeginUser;
  PetscCall(BlocksDestroy(&c->blocks));
  PetscFunctionReturn(0);
}

/* Moves the tops and everything below in proportion to its height; the same for the pressure. */
static void CuboidsMove(Cuboids *c, CuboidsLoad load)
{
  for (PetscInt body = 0; body < 2; ++body)
    for (PetscInt a = c->first[body]; a < c->first[body + 1]; ++a)
      c->blocks.x[a][0] += (load.share - c->load.share) * c->setup.top[body] * c->blocks.X[a][1];
  c->load = load;
  CuboidsPress(c);
}

/* What a failed step is taken back to. */
typedef struct {
  PetscReal (*x)[2], *lambda, *F33;
  LamElementStress *stress;
  CuboidsLoad load;
} CuboidsState;

static PetscErrorCode CuboidsSave(const Cuboids *c, CuboidsState *state)
{
  const Blocks *b = &c->blocks;

  PetscFunctionBeginUser;
  state->load = c->load;
  PetscCall(PetscArraycpy(state->x, b->x, b->node_count));
  PetscCall(PetscArraycpy(state->lambda, b->lambda, 2 * b->n + 1));
  PetscCall(PetscArraycpy(state->F33, b->F33, b->element_count));
  PetscCall(PetscArraycpy(state->stress, b->stress, b->element_count));
  PetscFunctionReturn(0);
}

static PetscErrorCode CuboidsRestore(Cuboids *c, const CuboidsState *state)
{
  Blocks *b = &c->blocks;

  PetscFunctionBeginUser;
  c->load = state->load;
  PetscCall(PetscArraycpy(b->x, state->x, b->node_count));
  PetscCall(PetscArraycpy(b->lambda, state->lambda, 2 * b->n + 1));
  PetscCall(PetscArraycpy(b->F33, state->F33, b->element_count));
  PetscCall(PetscArraycpy(b->stress, state->stress, b->element_count));
  CuboidsPress(c);
  PetscFunctionReturn(0);
}

PetscBool CuboidsIsStable(const Cuboids *c)
{
  PetscInt active = 0;

  for (PetscInt A = 0; A < 2 * c->blocks.n + 1; ++A) active += c->blocks.active[A];
  return (PetscBool)(c->blocks.negative == active);
}

/* From the present load to another one: in one step, or where that fails in smaller ones. */
static PetscErrorCode CuboidsSteps(Cuboids *c, CuboidsLoad to, CuboidsState *state, PetscBool *converged)
{
  const CuboidsLoad from = c->load;
  PetscReal step = 1.0, reached = 0.0;

  PetscFunctionBeginUser;
  *converged = PETSC_FALSE;
  while (reached < 1.0 && step >= CUBOIDS_SMALLEST_STEP) {
    const PetscReal t = PetscMin(1.0, reached + step);
    PetscInt iterations;

    CuboidsMove(c, (CuboidsLoad){(1.0 - t) * from.share + t * to.share, (1.0 - t) * from.pressure + t * to.pressure});
    PetscCall(BlocksTry(&c->blocks, CUBOIDS_TOLERANCE, &iterations, converged));
    c->iterations += iterations;
    if (*converged) {
      PetscCall(CuboidsSave(c, state));
      reached = t;
    } else {
      PetscCall(CuboidsRestore(c, state));
      step *= 0.5;
    }
  }
  *converged = (PetscBool)(reached >= 1.0);
  PetscFunctionReturn(0);
}

PetscErrorCode CuboidsSolve(Cuboids *c, PetscReal share, PetscReal pressure, PetscBool *converged)
{
  PetscLogDouble start, end;
  CuboidsState state;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(PetscMalloc4(c->blocks.node_count, &state.x, 2 * c->blocks.n + 1, &state.lambda, c->blocks.element_count,
                         &state.F33, c->blocks.element_count, &state.stress));
  PetscCall(CuboidsSave(c, &state));
  PetscCall(CuboidsSteps(c, (CuboidsLoad){share, pressure}, &state, converged));
  PetscCall(PetscFree4(state.x, state.lambda, state.F33, state.stress));
  PetscCall(PetscTime(&end));
  c->seconds += end - start;
  PetscFunctionReturn(0);
}

/* Place on the slave chain of a height: elements are straight in the reference state. */
static PetscReal CuboidsChainPlace(PetscInt n, PetscReal X2)
{
  PetscInt e = 0;

  while (e < n - 1 && CuboidsNode(n, 2 * e + 2) < X2) ++e;
  return (PetscReal)e + (X2 - CuboidsNode(n, 2 * e)) / (CuboidsNode(n, 2 * e + 2) - CuboidsNode(n, 2 * e));
}

/* The contact edge opposite of a place. */
static PetscInt CuboidsOpposite(const LamMortarSegments *segments, PetscReal s)
{
  PetscInt k = 0;

  while (k < segments->count - 2 && segments->s[k + 1] < s) ++k;
  return segments->master[k];
}

/* Nominal multiplier, piecewise linear between hats. */
static PetscReal CuboidsMultiplier(const Blocks *b, PetscReal s)
{
  const PetscInt A = PetscMin((PetscInt)(2.0 * s), 2 * b->n - 1);
  const PetscReal t = 2.0 * s - (PetscReal)A;

  return (1.0 - t) * b->lambda[A] + t * b->lambda[A + 1];
}

static PetscBool CuboidsIsWithin(PetscInt k)
{
  const PetscReal X2 = (PetscReal)k / (CUBOIDS_SAMPLES - 1);

  return (PetscBool)(X2 >= CUBOIDS_MARGIN - PETSC_SMALL && X2 <= 1.0 - CUBOIDS_MARGIN + PETSC_SMALL);
}

/* Everything in a profile that follows from gap and pressure. */
static void CuboidsSumUp(CuboidsProfile *profile)
{
  for (PetscInt k = 0; k < CUBOIDS_SAMPLES; ++k) {
    const PetscReal weight = (k == 0 || k == CUBOIDS_SAMPLES - 1 ? 0.5 : 1.0) / (CUBOIDS_SAMPLES - 1);

    if (!CuboidsIsWithin(k)) continue;
    if (profile->pressure[k] == 0.0) profile->apart += weight;
    if (profile->gap[k] > CUBOIDS_OPEN) profile->open += weight;
    profile->depth = PetscMax(profile->depth, -profile->gap[k]);
    if (profile->gap[k] <= profile->largest) continue;
    profile->largest = profile->gap[k];
    profile->at = (PetscReal)k / (CUBOIDS_SAMPLES - 1);
  }
}

void CuboidsFindProfile(Cuboids *c, CuboidsProfile *profile)
{
  Blocks *b = &c->blocks;
  const LamMortarChains chains = BlocksChains(b);
  PetscReal last[2] = {0.0, 0.0};

  *profile = (CuboidsProfile){0};
  LamMortarFindSegments(&chains, &b->segments);
  for (PetscInt k = 0; k < CUBOIDS_SAMPLES; ++k) {
    const PetscReal X2 = (PetscReal)k / (CUBOIDS_SAMPLES - 1), s = CuboidsChainPlace(c->setup.n, X2);
    PetscReal nearest[2], X[2], Xs[2];

    profile->gap[k] = LamMortarGap(&chains, s, CuboidsOpposite(&b->segments, s), nearest);
    profile->pressure[k] = CuboidsMultiplier(b, s);
    LamMortarSlavePoint(&chains, s, X, Xs);
    if (k > 0)
      profile->area += 0.5 * (profile->gap[k] + profile->gap[k - 1]) *
                       PetscSqrtReal(PetscSqr(X[0] - last[0]) + PetscSqr(X[1] - last[1]));
    for (PetscInt d = 0; d < 2; ++d) last[d] = X[d];
  }
  CuboidsSumUp(profile);
}

PetscErrorCode CuboidsCompute(const CuboidsSetup *setup, Cuboids *c, CuboidsProfile *profile)
{
  PetscBool converged;

  PetscFunctionBeginUser;
  PetscCall(CuboidsCreate(setup, c));
  PetscCall(CuboidsSolve(c, 1.0, setup->pressure, &converged));
  PetscCheck(converged && CuboidsIsStable(c), PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED,
             "no stable equilibrium of the cuboids beyond %g of the shear", (double)c->load.share);
  CuboidsFindProfile(c, profile);
  PetscFunctionReturn(0);
}

PetscReal CuboidsGapError(const CuboidsProfile *profile, const CuboidsProfile *reference)
{
  PetscReal error = 0.0;

  for (PetscInt k = 0; k < CUBOIDS_SAMPLES; ++k)
    if (CuboidsIsWithin(k)) error = PetscMax(error, PetscAbsReal(profile->gap[k] - reference->gap[k]));
  return error / reference->largest;
}

PetscErrorCode CuboidsGripForce(Cuboids *c, PetscInt body, PetscReal force[2])
{
  Blocks *b = &c->blocks;
  const PetscInt dofs = LamMortarDofs(b->n, b->m);
  const PetscReal chord = (body == 0 ? -1.0 : 1.0) * (c->load.pressure + c->setup.cohesion);
  PetscReal *residual;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * b->node_count, &residual));
  PetscCall(BlocksAddWalls(b, NULL, residual, &valid));
  BlocksFindGaps(b);
  for (PetscInt A = 0; A < 2 * b->n + 1; ++A)
    for (PetscInt i = 0; i < dofs; ++i)
      residual[2 * b->chain[i / 2] + i % 2] -= b->lambda[A] * b->result.dgap[A * dofs + i];
  force[0] = force[1] = 0.0;
  for (PetscInt a = c->first[body]; a < c->first[body + 1]; ++a)
    for (PetscInt d = 0; d < 2; ++d)
      if (b->held[a][d]) force[d] += residual[2 * a + d];
  force[0] += 0.5 * chord;
  force[1] -= 0.5 * chord * c->load.share * c->setup.top[body];
  PetscCall(PetscFree(residual));
  PetscFunctionReturn(0);
}

void CuboidsContactForce(Cuboids *c, PetscReal force[2])
{
  const LamMortarChains chains = BlocksChains(&c->blocks);
  const PetscInt parts = 8, count = 2 * c->blocks.n * parts;

  force[0] = force[1] = 0.0;
  for (PetscInt k = 0; k < count; ++k) {
    const PetscReal s = ((PetscReal)k + 0.5) / (2.0 * (PetscReal)parts);
    const PetscReal length = c->blocks.J0[(PetscInt)s] / (2.0 * (PetscReal)parts);
    PetscReal X[2], Xs[2], weight;

    LamMortarSlavePoint(&chains, s, X, Xs);
    weight = CuboidsMultiplier(&c->blocks, s) * length / PetscSqrtReal(Xs[0] * Xs[0] + Xs[1] * Xs[1]);
    force[0] -= weight * Xs[1];
    force[1] += weight * Xs[0];
  }
}
