/*
  Bodies of wall elements in frictionless contact along one pair of chains, for tests of the mortar kernel in mechanics
  that has nothing to do with cells. Energy: walls minus sum lambda G; held components keep their starting positions.

    BlocksCreate(nodes, elements, n, m, &blocks); BlocksAddGrid(...) for every body; slave, master, J0, held, x;
    BlocksSolve(blocks, &iterations); BlocksDestroy(blocks);
*/
#ifndef LAM_BLOCK_FIXTURE_H
#define LAM_BLOCK_FIXTURE_H

#include <petscmat.h>
#include "element.h"
#include "mortar.h"

#define BLOCKS_ITERATIONS 40
#define BLOCKS_SCALE 1.0 /* weighs gaps against multipliers in the active set */

typedef struct {
  PetscInt node_count, element_count, n, m;
  PetscReal (*X)[2], (*x)[2];              /* [node] reference and current positions */
  PetscBool (*held)[2];                    /* [node] */
  PetscInt (*elements)[LAM_ELEMENT_NODES]; /* [element] node order of LamMesh */
  LamElementGeometry *geometry;            /* [element] */
  LamElementStress *stress;                /* [element] */
  PetscInt *chain;                         /* nodes of both chains: slave [2n+1], then master [2m+1] */
  PetscReal (*chain_x)[2], *J0, *lambda;   /* J0[n], lambda[2n+1] */
  PetscBool *active;                       /* [2n+1] */
  LamWall wall;
  const LamWallLaw *law;
  LamMortarSegments segments;
  LamMortarResult result;
} Blocks;

/* Room for nodes and elements; walls of the plain law, C1 = 0.9, C2 = 0.1. */
static inline PetscErrorCode BlocksCreate(PetscInt nodes, PetscInt elements, PetscInt n, PetscInt m, Blocks *b)
{
  const PetscInt chain = 2 * (n + m + 1);

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(b, sizeof(*b)));
  b->n = n;
  b->m = m;
  b->wall.C1 = 0.9;
  b->wall.C2 = 0.1;
  b->wall.bulk_modulus = 1000.0;
  PetscCall(LamWallLawGet(LAM_WALL_MOONEY_RIVLIN, &b->law));
  PetscCall(PetscCalloc3(nodes, &b->X, nodes, &b->x, nodes, &b->held));
  PetscCall(PetscCalloc3(elements, &b->elements, elements, &b->geometry, elements, &b->stress));
  PetscCall(
      PetscCalloc5(chain, &b->chain, chain, &b->chain_x, n, &b->J0, 2 * n + 1, &b->lambda, 2 * n + 1, &b->active));
  PetscCall(LamMortarSegmentsCreate(n, m, &b->segments));
  PetscCall(LamMortarResultCreate(n, m, &b->result));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode BlocksDestroy(Blocks *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(b->X, b->x, b->held));
  PetscCall(PetscFree3(b->elements, b->geometry, b->stress));
  PetscCall(PetscFree5(b->chain, b->chain_x, b->J0, b->lambda, b->active));
  PetscCall(LamMortarSegmentsDestroy(&b->segments));
  PetscCall(LamMortarResultDestroy(&b->result));
  PetscFunctionReturn(0);
}

/* Adds nx x ny elements whose node (i, j), i <= 2 nx, j <= 2 ny, lies at place(ctx, i, j); its number is
   first + j (2 nx + 1) + i. */
static inline PetscErrorCode BlocksAddGrid(Blocks *b, PetscInt nx, PetscInt ny,
                                           void (*place)(void *ctx, PetscInt i, PetscInt j, PetscReal X[2]), void *ctx,
                                           PetscInt *first)
{
  static const PetscInt at[LAM_ELEMENT_NODES][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0},
                                                    {2, 1}, {1, 2}, {0, 1}, {1, 1}};
  const PetscReal axis[2] = {1.0, 0.0};

  PetscFunctionBeginUser;
  *first = b->node_count;
  for (PetscInt j = 0; j <= 2 * ny; ++j)
    for (PetscInt i = 0; i <= 2 * nx; ++i) {
      const PetscInt node = b->node_count++;

      place(ctx, i, j, b->X[node]);
      for (PetscInt d = 0; d < 2; ++d) b->x[node][d] = b->X[node][d];
    }
  for (PetscInt e = 0; e < nx * ny; ++e) {
    const PetscInt element = b->element_count++;
    PetscReal X[LAM_ELEMENT_NODES][2];

    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
      const PetscInt node = *first + (2 * (e / nx) + at[a][1]) * (2 * nx + 1) + 2 * (e % nx) + at[a][0];

      b->elements[element][a] = node;
      for (PetscInt d = 0; d < 2; ++d) X[a][d] = b->X[node][d];
    }
    PetscCall(LamElementSetGeometry((const PetscReal(*)[2])X, axis, &b->geometry[element]));
  }
  PetscFunctionReturn(0);
}

/* Current positions of the chains. */
static inline LamMortarChains BlocksChains(Blocks *b)
{
  for (PetscInt i = 0; i < 2 * (b->n + b->m + 1); ++i)
    for (PetscInt d = 0; d < 2; ++d) b->chain_x[i][d] = b->x[b->chain[i]][d];
  return (LamMortarChains){
      b->n, b->m, (const PetscReal(*)[2])b->chain_x, (const PetscReal(*)[2])(b->chain_x + 2 * b->n + 1), b->J0, 0.0};
}

static inline void BlocksGather(const Blocks *b, PetscInt e, PetscReal x[LAM_ELEMENT_NODES][2])
{
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt d = 0; d < 2; ++d) x[a][d] = b->x[b->elements[e][a]][d];
}

/* Row of a component in the system, -1: held. */
static inline PetscInt BlocksRow(const Blocks *b, PetscInt node, PetscInt d)
{
  return b->held[node][d] ? -1 : 2 * node + d;
}

/* Adds the walls' residual and tangent. */
static inline PetscErrorCode BlocksAddWalls(Blocks *b, Mat K, PetscReal residual[], PetscBool *valid)
{
  PetscFunctionBeginUser;
  *valid = PETSC_TRUE;
  for (PetscInt e = 0; e < b->element_count && *valid; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2];
    PetscInt row[LAM_ELEMENT_DOFS];
    LamElementResult element;

    BlocksGather(b, e, x);
    LamElementEvaluate(&b->geometry[e], b->law, &b->wall, (const PetscReal(*)[2])x, 1.0, &b->stress[e], &element,
                       valid);
    for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; ++i) {
      row[i] = BlocksRow(b, b->elements[e][i / 2], i % 2);
      if (row[i] >= 0) residual[row[i]] += element.f[i];
    }
    PetscCall(MatSetValues(K, LAM_ELEMENT_DOFS, row, LAM_ELEMENT_DOFS, row, &element.K[0][0], ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

/* Weighted gaps, active set (its changes are returned), and their part of the tangent. */
static inline PetscErrorCode BlocksAddContact(Blocks *b, Mat K, PetscInt *changes)
{
  const LamMortarChains chains = BlocksChains(b);
  const PetscInt hats = 2 * b->n + 1, dofs = LamMortarDofs(b->n, b->m);
  PetscInt *row;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(dofs, &row));
  LamMortarFindSegments(&chains, &b->segments);
  LamMortarEvaluate(&chains, &b->segments, b->lambda, LAM_MORTAR_POINTS, &b->result);
  for (PetscInt i = 0; i < dofs; ++i) row[i] = BlocksRow(b, b->chain[i / 2], i % 2);
  for (PetscInt i = 0; i < dofs * dofs; ++i) b->result.hessian[i] *= -1.0;
  PetscCall(MatSetValues(K, dofs, row, dofs, row, b->result.hessian, ADD_VALUES));
  *changes = 0;
  for (PetscInt A = 0; A < hats; ++A) {
    const PetscInt multiplier = 2 * b->node_count + A;
    const PetscReal gap = b->result.gap[A] / b->result.weight[A];
    const PetscBool active = (PetscBool)(b->lambda[A] - BLOCKS_SCALE * gap > 0.0);

    *changes += active != b->active[A];
    b->active[A] = active;
    if (!active) PetscCall(MatSetValue(K, multiplier, multiplier, 1.0, ADD_VALUES));
    for (PetscInt i = 0; i < dofs && active; ++i) {
      PetscCall(MatSetValue(K, row[i], row[i] < 0 ? -1 : multiplier, -b->result.dgap[A * dofs + i], ADD_VALUES));
      PetscCall(MatSetValue(K, row[i] < 0 ? -1 : multiplier, row[i], -b->result.dgap[A * dofs + i], ADD_VALUES));
    }
  }
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* Largest residual of equilibrium and of the active gaps; residual: of the walls. */
static inline PetscReal BlocksError(const Blocks *b, const PetscReal residual[])
{
  const PetscInt dofs = LamMortarDofs(b->n, b->m);
  PetscReal largest = 0.0, *r;

  if (PetscMalloc1(2 * b->node_count, &r)) return PETSC_INFINITY;
  for (PetscInt i = 0; i < 2 * b->node_count; ++i) r[i] = residual[i];
  for (PetscInt A = 0; A < 2 * b->n + 1; ++A) {
    for (PetscInt i = 0; i < dofs; ++i) r[2 * b->chain[i / 2] + i % 2] -= b->lambda[A] * b->result.dgap[A * dofs + i];
    if (b->active[A]) largest = PetscMax(largest, PetscAbsReal(b->result.gap[A]));
  }
  for (PetscInt i = 0; i < 2 * b->node_count; ++i)
    if (!b->held[i / 2][i % 2]) largest = PetscMax(largest, PetscAbsReal(r[i]));
  (void)PetscFree(r);
  return largest;
}

/* solution := K^-1 rhs. */
static inline PetscErrorCode BlocksFactorAndSolve(Mat K, PetscInt size, PetscReal rhs[], PetscReal solution[])
{
  MatFactorInfo info;
  Mat factor;
  Vec right, left;

  PetscFunctionBeginUser;
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, rhs, &right));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, solution, &left));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(K, MATSOLVERMUMPS, MAT_FACTOR_LU, &factor));
  PetscCall(MatLUFactorSymbolic(factor, K, NULL, NULL, &info));
  PetscCall(MatLUFactorNumeric(factor, K, &info));
  PetscCall(MatSolve(factor, right, left));
  PetscCall(MatDestroy(&factor));
  PetscCall(VecDestroy(&right));
  PetscCall(VecDestroy(&left));
  PetscFunctionReturn(0);
}

/* Moves positions, independent stresses and multipliers by the solution of the system. */
static inline void BlocksStep(Blocks *b, const PetscReal solution[])
{
  for (PetscInt e = 0; e < b->element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2], dx[LAM_ELEMENT_NODES][2];

    BlocksGather(b, e, x);
    for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; ++i) dx[i / 2][i % 2] = solution[2 * b->elements[e][i / 2] + i % 2];
    LamElementUpdateStress(&b->geometry[e], (const PetscReal(*)[2])x, (const PetscReal(*)[2])dx, 1.0, 1.0,
                           &b->stress[e]);
  }
  for (PetscInt i = 0; i < 2 * b->node_count; ++i) b->x[i / 2][i % 2] += solution[i];
  for (PetscInt A = 0; A < 2 * b->n + 1; ++A) b->lambda[A] = b->active[A] ? solution[2 * b->node_count + A] : 0.0;
}

/* One Newton step, or none where the residuals are below `tolerance`. */
static inline PetscErrorCode BlocksIterate(Blocks *b, PetscReal tolerance, PetscBool *done)
{
  const PetscInt positions = 2 * b->node_count, size = positions + 2 * b->n + 1;
  PetscReal *rhs, *solution;
  PetscInt changes = 0;
  PetscBool valid = PETSC_TRUE;
  Mat K;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(size, &rhs, size, &solution));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, size, size, 120, NULL, &K));
  PetscCall(MatSetOption(K, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(MatSetOption(K, MAT_IGNORE_ZERO_ENTRIES, PETSC_TRUE));
  for (PetscInt i = 0; i < positions; ++i)
    if (b->held[i / 2][i % 2]) PetscCall(MatSetValue(K, i, i, 1.0, ADD_VALUES));
  PetscCall(BlocksAddWalls(b, K, rhs, &valid));
  PetscCheck(valid, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "an element is inside out");
  PetscCall(BlocksAddContact(b, K, &changes));
  PetscCall(MatAssemblyBegin(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(K, MAT_FINAL_ASSEMBLY));
  *done = (PetscBool)(changes == 0 && BlocksError(b, rhs) <= tolerance);
  if (!*done) {
    for (PetscInt i = 0; i < positions; ++i) rhs[i] *= -1.0;
    for (PetscInt A = 0; A < 2 * b->n + 1; ++A) rhs[positions + A] = b->active[A] ? b->result.gap[A] : 0.0;
    PetscCall(BlocksFactorAndSolve(K, size, rhs, solution));
    BlocksStep(b, solution);
  }
  PetscCall(MatDestroy(&K));
  PetscCall(PetscFree2(rhs, solution));
  PetscFunctionReturn(0);
}

/* Newton's method with active sets from the present positions and multipliers; an error where it does not converge. */
static inline PetscErrorCode BlocksSolve(Blocks *b, PetscReal tolerance, PetscInt *iterations)
{
  PetscBool done = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (*iterations = 0; *iterations < BLOCKS_ITERATIONS; ++*iterations) {
    PetscCall(BlocksIterate(b, tolerance, &done));
    if (done) break;
  }
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "no contact equilibrium of the blocks in %d iterations",
             BLOCKS_ITERATIONS);
  PetscFunctionReturn(0);
}

#endif
