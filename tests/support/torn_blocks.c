#include "torn_blocks.h"

#define TORN_ITERATIONS 600
#define TORN_HALVINGS 12
#define TORN_TOLERANCE 1e-9 /* of residuals, in the largest force of loads or lamella */
#define TORN_SPRING 0.02    /* the weakest, in strength over range; then doubled */
#define TORN_PATIENCE 25    /* iterations; just beyond a limit point descent is slow, and the target goes on by ... */
#define TORN_FURTHER 0.1    /* ... this share of the step, then twice it and so on */
#define TORN_EVEN 1e-12     /* energies that differ by less, relatively, are rounding */

void TornGauss(PetscInt count, TornRule *rule)
{
  rule->count = count;
  for (PetscInt q = 0; q < count; ++q) {
    PetscReal x = PetscCosReal(PETSC_PI * (q + 0.75) / (count + 0.5)), slope = 1.0;

    for (PetscInt k = 0; k < 10; ++k) { /* Newton's method on Legendre's polynomial */
      PetscReal p = 1.0, before = 0.0;

      for (PetscInt n = 1; n <= count; ++n) {
        const PetscReal next = ((2.0 * n - 1.0) * x * p - (n - 1.0) * before) / n;

        before = p;
        p = next;
      }
      slope = count * (before - x * p) / (1.0 - x * x);
      x -= p / slope;
    }
    rule->place[q] = 0.5 * (1.0 - x);
    rule->weight[q] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
}

static PetscInt TornSize(const Torn *torn)
{
  return 2 * torn->blocks->node_count + 1;
}

PetscErrorCode TornCreate(Blocks *blocks, PetscInt edges, const TornRule *rule, Torn *torn)
{
  const PetscInt points = edges * rule->count;

  PetscFunctionBeginUser;
  *torn = (Torn){.blocks = blocks, .rule = *rule, .edges = edges};
  PetscCall(PetscCalloc5(edges, &torn->edge, edges, &torn->length, points, &torn->history, points, &torn->bond,
                         blocks->node_count, &torn->load));
  for (PetscInt p = 0; p < points; ++p) torn->history[p] = LAM_UNDAMAGED;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, TornSize(torn), TornSize(torn), 80, NULL, &torn->K));
  PetscCall(MatSetOption(torn->K, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(MatSetOption(torn->K, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode TornDestroy(Torn *torn)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(torn->edge, torn->length, torn->history, torn->bond, torn->load));
  PetscCall(MatDestroy(&torn->K));
  PetscCall(MatDestroy(&torn->factor));
  PetscFunctionReturn(0);
}

static void TornGather(const Torn *torn, PetscInt e, PetscReal X[][2], PetscReal u[][2])
{
  for (PetscInt k = 0; k < LAM_EDGE_NODES; ++k)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscInt node = torn->edge[e][k];

      X[k][d] = torn->blocks->X[node][d];
      u[k][d] = torn->blocks->x[node][d] - X[k][d];
    }
}

/* Springs against faces that are pressed together: a lamella without strength in shear that never breaks, between the
   faces in exchanged roles, whose opening is then positive. */
static void TornAddPressed(const Torn *torn, PetscInt e, LamCohesiveSum *sum)
{
  const LamBond springs = {.now = {.stiffness = torn->contact, .strength = 1.0, .energy = 1.0, .onset = 1.0},
                           .kappa = 1.0};
  PetscReal X[LAM_EDGE_NODES][2], u[LAM_EDGE_NODES][2];
  LamCohesiveSum exchanged = {0};

  TornGather(torn, e, X, u);
  for (PetscInt k = 0; k < 3; ++k)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal X_k = X[k][d], u_k = u[k][d];

      X[k][d] = X[3 + k][d];
      u[k][d] = u[3 + k][d];
      X[3 + k][d] = X_k;
      u[3 + k][d] = u_k;
    }
  for (PetscInt q = 0; q < torn->rule.count; ++q)
    LamEdgeAdd((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, torn->rule.place[q],
               torn->length[e] * torn->rule.weight[q], &springs, PETSC_FALSE, &exchanged);
  sum->energy += exchanged.energy;
  for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) {
    sum->f[i] += exchanged.f[(i + 6) % LAM_EDGE_DOFS];
    for (PetscInt j = 0; j < LAM_EDGE_DOFS; ++j)
      sum->K[i][j] += exchanged.K[(i + 6) % LAM_EDGE_DOFS][(j + 6) % LAM_EDGE_DOFS];
  }
}

static void TornEdge(const Torn *torn, PetscInt e, LamCohesiveSum *sum)
{
  PetscReal X[LAM_EDGE_NODES][2], u[LAM_EDGE_NODES][2];

  *sum = (LamCohesiveSum){0};
  TornAddPressed(torn, e, sum);
  TornGather(torn, e, X, u);
  for (PetscInt q = 0; q < torn->rule.count; ++q)
    LamEdgeAdd((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, torn->rule.place[q],
               torn->length[e] * torn->rule.weight[q], &torn->bond[e * torn->rule.count + q], PETSC_FALSE, sum);
}

/* Of the walls, and with the independent stresses at the present positions: Newton's tangent is then that of the
   energy. Infinite where an element is inside out. */
static PetscReal TornWalls(Torn *torn)
{
  Blocks *b = torn->blocks;
  PetscReal sum = 0.0;

  for (PetscInt e = 0; e < b->element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2], energy;
    PetscBool valid;

    BlocksGather(b, e, x);
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      for (PetscInt d = 0; d < 2; ++d) x[a][d] -= b->X[b->elements[e][a]][d];
    LamElementEnergy(&b->geometry[e], b->law, &b->wall_of[e], NULL, (const PetscReal(*)[2])x, b->F33[e], &energy,
                     &valid);
    if (!valid || !LamElementSetConsistentStress(&b->geometry[e], b->law, &b->wall_of[e], (const PetscReal(*)[2])x,
                                                 b->F33[e], &b->stress[e]))
      return PETSC_INFINITY;
    sum += energy;
  }
  return sum;
}

static PetscReal TornEnergy(Torn *torn)
{
  PetscReal energy = TornWalls(torn);

  for (PetscInt e = 0; e < torn->edges; ++e) {
    LamCohesiveSum sum;

    TornEdge(torn, e, &sum);
    energy += sum.energy;
  }
  return energy;
}

/* Row of a component, -1: held. */
static PetscInt TornRow(const Torn *torn, PetscInt node, PetscInt d)
{
  return torn->blocks->held[node][d] ? -1 : 2 * node + d;
}

static PetscErrorCode TornAddLamella(Torn *torn, PetscReal residual[])
{
  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < torn->edges; ++e) {
    PetscInt row[LAM_EDGE_DOFS];
    LamCohesiveSum sum;

    TornEdge(torn, e, &sum);
    for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) {
      row[i] = TornRow(torn, torn->edge[e][i / 2], i % 2);
      residual[2 * torn->edge[e][i / 2] + i % 2] += sum.f[i];
    }
    PetscCall(MatSetValues(torn->K, LAM_EDGE_DOFS, row, LAM_EDGE_DOFS, row, &sum.K[0][0], ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

/* The tangent with the constraint, and rhs := -(residual of equilibrium, load.u - target). *error: largest residual. */
static PetscErrorCode TornAssemble(Torn *torn, PetscReal rhs[], PetscReal *error)
{
  const Blocks *b = torn->blocks;
  const PetscInt last = 2 * b->node_count;
  PetscReal size = torn->law.strength * torn->length[0] / 6.0; /* of a node's force at the strength */
  PetscBool valid;

  PetscFunctionBeginUser;
  *error = 0.0;
  PetscCall(PetscArrayzero(rhs, last + 1));
  PetscCall(MatZeroEntries(torn->K));
  PetscCall(TornAddLamella(torn, rhs));
  for (PetscInt i = 0; i < last; ++i) size = PetscMax(size, PetscAbsReal(rhs[i]));
  PetscCall(BlocksAddWalls(torn->blocks, torn->K, rhs, &valid));
  PetscCheck(valid, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "an element is inside out");
  rhs[last] = torn->target;
  for (PetscInt i = 0; i < last; ++i) {
    const PetscReal load = torn->load[i / 2][i % 2];
    const PetscInt row = TornRow(torn, i / 2, i % 2);

    rhs[last] -= load * (b->x[i / 2][i % 2] - b->X[i / 2][i % 2]);
    rhs[i] = row < 0 ? 0.0 : torn->lambda * load - rhs[i];
    size = PetscMax(size, PetscAbsReal(torn->lambda * load));
    *error = PetscMax(*error, PetscAbsReal(rhs[i]));
    if (row < 0) PetscCall(MatSetValue(torn->K, i, i, 1.0, ADD_VALUES));
    if (row < 0 || load == 0.0) continue;
    PetscCall(MatSetValue(torn->K, row, last, -load, ADD_VALUES));
    PetscCall(MatSetValue(torn->K, last, row, -load, ADD_VALUES));
  }
  rhs[last] = -rhs[last];
  PetscCall(MatSetValue(torn->K, last, last, 0.0, ADD_VALUES));
  PetscCall(MatAssemblyBegin(torn->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(torn->K, MAT_FINAL_ASSEMBLY));
  *error /= size;
  PetscFunctionReturn(0);
}

/* Adds springs to the nodes of the lamella. */
static PetscErrorCode TornShift(Torn *torn, PetscReal spring)
{
  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < torn->edges; ++e)
    for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) {
      const PetscInt row = TornRow(torn, torn->edge[e][i / 2], i % 2);

      PetscCall(MatSetValue(torn->K, row, row, spring * torn->length[e], ADD_VALUES));
    }
  PetscCall(MatAssemblyBegin(torn->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(torn->K, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* solution := K^-1 rhs. The pattern stays, so that it is analysed once. */
static PetscErrorCode TornFactorAndSolve(Torn *torn, PetscReal rhs[], PetscReal solution[], PetscInt *negative)
{
  MatFactorInfo info;
  Vec right, left;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  if (!torn->factor) {
    PetscCall(MatGetFactor(torn->K, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &torn->factor));
    PetscCall(MatMumpsSetIcntl(torn->factor, 14, 50)); /* workspace margin, per cent */
    PetscCall(MatCholeskyFactorSymbolic(torn->factor, torn->K, NULL, &info));
  }
  PetscCall(MatCholeskyFactorNumeric(torn->factor, torn->K, &info));
  PetscCall(MatGetInertia(torn->factor, negative, NULL, NULL));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, TornSize(torn), rhs, &right));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, TornSize(torn), solution, &left));
  PetscCall(MatSolve(torn->factor, right, left));
  PetscCall(VecDestroy(&right));
  PetscCall(VecDestroy(&left));
  PetscFunctionReturn(0);
}

/* The step at which all but one eigenvalue are positive, with as few springs as that needs. */
static PetscErrorCode TornDirection(Torn *torn, PetscReal rhs[], PetscReal solution[], PetscBool *helped)
{
  const LamEnvelope envelope = LamEnvelopeOf(&torn->law, 0.0);
  PetscReal springs = 0.0, added = 0.0;
  PetscInt negative;

  PetscFunctionBeginUser;
  do {
    PetscCheck(springs <= 1e6 * envelope.stiffness, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "no springs help");
    PetscCall(TornShift(torn, added));
    PetscCall(TornFactorAndSolve(torn, rhs, solution, &negative));
    *helped = (PetscBool)(springs > 0.0);
    added = springs > 0.0 ? springs : PetscMax(0.25 * torn->springs, TORN_SPRING * envelope.strength / envelope.range);
    springs += added;
  } while (negative != 1);
  torn->springs = *helped ? springs - added : 0.0;
  PetscFunctionReturn(0);
}

static void TornMove(Torn *torn, PetscReal share, const PetscReal solution[])
{
  for (PetscInt i = 0; i < 2 * torn->blocks->node_count; ++i) torn->blocks->x[i / 2][i % 2] += share * solution[i];
}

/* Halves the step until the energy falls, or doubles it as long as it falls; *energy at its end. slope: its derivative
   along the step. */
static void TornDescend(Torn *torn, const PetscReal solution[], PetscReal slope, PetscBool lengthen, PetscReal *energy)
{
  const PetscReal start = *energy;
  PetscReal share = 1.0;

  TornMove(torn, 1.0, solution);
  for (PetscInt k = 0; k < TORN_HALVINGS; ++k) {
    *energy = TornEnergy(torn);
    if (*energy <= start + 1e-4 * share * slope + TORN_EVEN * PetscAbsReal(start)) break;
    lengthen = PETSC_FALSE;
    share *= 0.5;
    TornMove(torn, -share, solution);
  }
  for (PetscInt k = 0; k < TORN_HALVINGS && lengthen; ++k, share *= 2.0) {
    PetscReal further;

    TornMove(torn, share, solution);
    further = TornEnergy(torn);
    if (further >= *energy) {
      TornMove(torn, -share, solution);
      *energy = TornEnergy(torn);
      return;
    }
    *energy = further;
  }
}

static PetscErrorCode TornSolve(Torn *torn, PetscReal moved, PetscReal rhs[], PetscReal solution[],
                                PetscInt *iterations)
{
  const PetscInt last = TornSize(torn) - 1;
  PetscReal energy = TornEnergy(torn), error;
  PetscBool met = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (*iterations = 0; *iterations < TORN_ITERATIONS; ++*iterations) {
    PetscReal slope = 0.0;
    PetscBool springs = PETSC_FALSE;

    if (*iterations % TORN_PATIENCE == TORN_PATIENCE - 1) {
      torn->target += TORN_FURTHER * (*iterations / TORN_PATIENCE + 1) * moved;
      met = PETSC_FALSE;
    }
    PetscCall(TornAssemble(torn, rhs, &error));
    if (met && error <= TORN_TOLERANCE) PetscFunctionReturn(0);
    if (getenv("TT")) printf("   it %d error %g energy %.15g springs\n", (int)*iterations, error, energy);
    PetscCall(TornDirection(torn, rhs, solution, &springs));
    for (PetscInt i = 0; i < last; ++i) slope -= rhs[i] * solution[i];
    torn->lambda += solution[last];
    if (met) {
      TornDescend(torn, solution, slope, springs, &energy);
      continue;
    }
    TornMove(torn, 1.0, solution);
    energy = TornEnergy(torn);
    met = PETSC_TRUE;
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "no equilibrium at %g: residual %g", (double)torn->target,
          (double)error);
}

/* Energies of the state, and its history. */
static void TornKeep(Torn *torn, TornStep *step)
{
  step->walls = TornWalls(torn);
  for (PetscInt e = 0; e < torn->edges; ++e) {
    PetscReal X[LAM_EDGE_NODES][2], u[LAM_EDGE_NODES][2];

    TornGather(torn, e, X, u);
    for (PetscInt q = 0; q < torn->rule.count; ++q) {
      const PetscInt p = e * torn->rule.count + q;
      const PetscReal weight = torn->length[e] * torn->rule.weight[q];
      LamCohesiveStep at;
      LamJump jump;

      LamEdgePlaceEvaluate((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, torn->rule.place[q], &torn->bond[p],
                           &jump, &at);
      step->spent += weight * LamBondSpent(&torn->bond[p], &at);
      step->stored += weight * (at.phi + 0.5 * torn->bond[p].pressing * jump.r - LamBondSpent(&torn->bond[p], &at));
      torn->history[p] = LamBondKeep(&torn->bond[p], &jump, &at);
    }
  }
}

PetscErrorCode TornPull(Torn *torn, PetscReal target, TornStep *step)
{
  const PetscReal lambda = torn->lambda, before = torn->target, moved = target - before;
  PetscReal *rhs, *solution;

  PetscFunctionBeginUser;
  *step = (TornStep){0};
  torn->target = target;
  for (PetscInt p = 0; p < torn->edges * torn->rule.count; ++p) {
    torn->bond[p].law = torn->law;
    LamBondTake(&torn->history[p], &torn->bond[p]);
  }
  PetscCall(PetscCalloc2(TornSize(torn), &rhs, TornSize(torn), &solution));
  PetscCall(TornSolve(torn, moved, rhs, solution, &step->iterations));
  PetscCall(PetscFree2(rhs, solution));
  TornKeep(torn, step);
  step->lambda = torn->lambda;
  step->target = torn->target;
  step->work = 0.5 * (lambda + torn->lambda) * (torn->target - before);
  PetscFunctionReturn(0);
}

LamJump TornJump(const Torn *torn, PetscInt edge, PetscInt q)
{
  PetscReal X[LAM_EDGE_NODES][2], u[LAM_EDGE_NODES][2];
  LamCohesiveStep step;
  LamJump jump;

  TornGather(torn, edge, X, u);
  LamEdgePlaceEvaluate((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, torn->rule.place[q],
                       &torn->bond[edge * torn->rule.count + q], &jump, &step);
  return jump;
}
