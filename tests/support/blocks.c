#include "blocks.h"

/* Sides of an element in the grid: below, right, above, left; counter-clockwise. */
static const PetscInt blocks_side[BLOCKS_SIDES][3] = {{0, 4, 1}, {1, 5, 2}, {2, 6, 3}, {3, 7, 0}};

PetscErrorCode BlocksCreate(PetscInt nodes, PetscInt elements, PetscInt n, PetscInt m, Blocks *b)
{
  const PetscInt chain = 2 * (n + m + 1);

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(b, sizeof(*b)));
  b->n = n;
  b->m = m;
  b->wall.C1 = 0.9;
  b->wall.C2 = 0.1;
  b->wall.bulk_modulus = 1000.0;
  b->fibre[0] = 1.0;
  b->scale = 1.0;
  PetscCall(LamWallLawGet(LAM_WALL_MOONEY_RIVLIN, &b->law));
  PetscCall(PetscCalloc3(nodes, &b->X, nodes, &b->x, nodes, &b->held));
  PetscCall(PetscCalloc7(elements, &b->elements, elements, &b->geometry, elements, &b->stress, elements, &b->wall_of,
                         elements, &b->F33, elements, &b->thickness, elements, &b->pressure));
  PetscCall(
      PetscCalloc5(chain, &b->chain, chain, &b->chain_x, n, &b->J0, 2 * n + 1, &b->lambda, 2 * n + 1, &b->active));
  PetscCall(LamMortarSegmentsCreate(n, m, &b->segments));
  PetscCall(LamMortarResultCreate(n, m, &b->result));
  PetscFunctionReturn(0);
}

PetscReal BlocksPlaneStrainModulus(const LamWall *wall)
{
  const PetscReal shear = wall->C1 + wall->C2, bulk = wall->bulk_modulus;
  const PetscReal E = 9.0 * bulk * shear / (3.0 * bulk + shear);
  const PetscReal nu = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));

  return E / (1.0 - nu * nu);
}

PetscErrorCode BlocksDestroy(Blocks *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(b->X, b->x, b->held));
  PetscCall(PetscFree7(b->elements, b->geometry, b->stress, b->wall_of, b->F33, b->thickness, b->pressure));
  PetscCall(PetscFree5(b->chain, b->chain_x, b->J0, b->lambda, b->active));
  PetscCall(LamMortarSegmentsDestroy(&b->segments));
  PetscCall(LamMortarResultDestroy(&b->result));
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksAddGrid(Blocks *b, PetscInt nx, PetscInt ny,
                             void (*place)(void *ctx, PetscInt i, PetscInt j, PetscReal X[2]), void *ctx,
                             PetscInt *first)
{
  static const PetscInt at[LAM_ELEMENT_NODES][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0},
                                                    {2, 1}, {1, 2}, {0, 1}, {1, 1}};

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
    PetscCall(LamElementSetGeometry((const PetscReal(*)[2])X, b->fibre, &b->geometry[element]));
    b->wall_of[element] = b->wall;
    b->F33[element] = 1.0;
  }
  PetscFunctionReturn(0);
}

LamMortarChains BlocksChains(Blocks *b)
{
  for (PetscInt i = 0; i < 2 * (b->n + b->m + 1); ++i)
    for (PetscInt d = 0; d < 2; ++d) b->chain_x[i][d] = b->x[b->chain[i]][d];
  return (LamMortarChains){b->n, b->m, (const PetscReal(*)[2])b->chain_x,
                           (const PetscReal(*)[2])(b->chain_x + 2 * b->n + 1), b->J0};
}

void BlocksGather(const Blocks *b, PetscInt e, PetscReal x[LAM_ELEMENT_NODES][2])
{
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt d = 0; d < 2; ++d) x[a][d] = b->x[b->elements[e][a]][d];
}

static NodeVectors BlocksDisplaced(const Blocks *b, PetscInt e, const PetscReal x[][2])
{
  PetscReal X[LAM_ELEMENT_NODES][2];

  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt d = 0; d < 2; ++d) X[a][d] = b->X[b->elements[e][a]][d];
  return Displaced((const PetscReal(*)[2])X, x);
}

/* Row of a component in the system, -1: held. */
static PetscInt BlocksRow(const Blocks *b, PetscInt node, PetscInt d)
{
  return b->held[node][d] ? -1 : 2 * node + d;
}

static void BlocksEvaluate(Blocks *b, PetscInt e, const PetscReal x[][2], LamElementResult *element, PetscBool *valid)
{
  LamElementEvaluate(&b->geometry[e], b->law, &b->wall_of[e], NULL, (const PetscReal(*)[2])BlocksDisplaced(b, e, x).u,
                     b->F33[e], &b->stress[e], element, valid);
}

/* Plane stress: residual and tangent of an element without its stretch F33, whose own equation is force = 0. */
static void BlocksReleaseThickness(Blocks *b, PetscInt e, const PetscReal x[][2], LamElementResult *element)
{
  BlocksThickness *t = &b->thickness[e];

  LamElementStretch33(&b->geometry[e], b->law, &b->wall_of[e], NULL, (const PetscReal(*)[2])BlocksDisplaced(b, e, x).u,
                      b->F33[e], &b->stress[e], &t->force, t->fx, &t->ff);
  for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; ++i) {
    element->f[i] -= t->fx[i] * t->force / t->ff;
    for (PetscInt j = 0; j < LAM_ELEMENT_DOFS; ++j) element->K[i][j] -= t->fx[i] * t->fx[j] / t->ff;
  }
}

/* Step of F33 that goes with dx, and of the element pressures with it: dp = H int psi det F dF33. */
static void BlocksStepThickness(Blocks *b, PetscInt e, const PetscReal x[][2], const PetscReal dx[][2])
{
  const BlocksThickness *t = &b->thickness[e];
  const LamElementGeometry *geometry = &b->geometry[e];
  PetscReal dF33 = -t->force / t->ff, dc[LAM_PRESSURES] = {0.0};

  for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; ++i) dF33 -= t->fx[i] * dx[i / 2][i % 2] / t->ff;
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    PetscReal F[4] = {0.0};

    for (PetscInt c = 0; c < 4; ++c)
      for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) F[c] += x[a][c / 2] * geometry->dN[2 * g + c % 2][a];
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k)
      dc[k] += geometry->weight[g] * geometry->psi[k][g] * (F[0] * F[3] - F[1] * F[2]) * dF33;
  }
  for (PetscInt k = 0; k < LAM_PRESSURES; ++k)
    for (PetscInt l = 0; l < LAM_PRESSURES; ++l) b->stress[e].p[k] += b->stress[e].H[k][l] * dc[l];
  b->F33[e] += dF33;
}

/* Residual and tangent of an element with the pressures on its sides. */
static void BlocksElement(Blocks *b, PetscInt e, LamElementResult *element, PetscBool *valid)
{
  PetscReal x[LAM_ELEMENT_NODES][2];

  BlocksGather(b, e, x);
  BlocksEvaluate(b, e, (const PetscReal(*)[2])x, element, valid);
  if (!*valid) return;
  if (b->plane_stress) BlocksReleaseThickness(b, e, (const PetscReal(*)[2])x, element);
  for (PetscInt side = 0; side < BLOCKS_SIDES; ++side)
    if (b->pressure[e][side] != 0.0)
      LamAddEdgeArea(blocks_side[side], (const PetscReal(*)[2])x, b->pressure[e][side], element->f, element->K);
}

PetscErrorCode BlocksAddWalls(Blocks *b, Mat K, PetscReal residual[], PetscBool *valid)
{
  PetscFunctionBeginUser;
  *valid = PETSC_TRUE;
  for (PetscInt e = 0; e < b->element_count && *valid; ++e) {
    PetscInt row[LAM_ELEMENT_DOFS];
    LamElementResult element;

    BlocksElement(b, e, &element, valid);
    for (PetscInt i = 0; i < LAM_ELEMENT_DOFS && *valid; ++i) {
      row[i] = BlocksRow(b, b->elements[e][i / 2], i % 2);
      residual[2 * b->elements[e][i / 2] + i % 2] += element.f[i];
    }
    if (K && *valid)
      PetscCall(MatSetValues(K, LAM_ELEMENT_DOFS, row, LAM_ELEMENT_DOFS, row, &element.K[0][0], ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

void BlocksStartUnder(Blocks *b, PetscReal pressure)
{
  for (PetscInt e = 0; e < b->element_count; ++e)
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
      b->stress[e].p[k] = 0.0;
      for (PetscInt g = 0; g < LAM_GAUSS; ++g)
        b->stress[e].p[k] -= pressure * b->geometry[e].weight[g] * b->geometry[e].psi[k][g];
    }
}

/* Adds the row of hat `from` to that of hat `to` and clears it. */
static void BlocksMergeHat(Blocks *b, PetscInt from, PetscInt to)
{
  const PetscInt dofs = LamMortarDofs(b->n, b->m);

  b->result.gap[to] += b->result.gap[from];
  b->result.weight[to] += b->result.weight[from];
  b->result.gap[from] = 0.0;
  for (PetscInt i = 0; i < dofs; ++i) {
    b->result.dgap[to * dofs + i] += b->result.dgap[from * dofs + i];
    b->result.dgap[from * dofs + i] = 0.0;
  }
}

static PetscBool BlocksHatIsMerged(const Blocks *b, PetscInt A)
{
  return (PetscBool)(b->ends_held && (A == 0 || A == 2 * b->n));
}

void BlocksFindGaps(Blocks *b)
{
  const LamMortarChains chains = BlocksChains(b);

  LamMortarFindSegments(&chains, &b->segments);
  LamMortarEvaluate(&chains, &b->segments, b->lambda, LAM_MORTAR_POINTS, &b->result);
  if (!b->ends_held) return;
  BlocksMergeHat(b, 0, 1);
  BlocksMergeHat(b, 2 * b->n, 2 * b->n - 1);
}

/* Weighted gaps, active set (its changes are returned), and their part of the tangent. */
static PetscErrorCode BlocksAddContact(Blocks *b, Mat K, PetscInt *changes)
{
  const PetscInt hats = 2 * b->n + 1, dofs = LamMortarDofs(b->n, b->m);
  PetscInt *row;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(dofs, &row));
  BlocksFindGaps(b);
  for (PetscInt i = 0; i < dofs; ++i) row[i] = BlocksRow(b, b->chain[i / 2], i % 2);
  for (PetscInt i = 0; i < dofs * dofs; ++i) b->result.hessian[i] *= -1.0;
  PetscCall(MatSetValues(K, dofs, row, dofs, row, b->result.hessian, ADD_VALUES));
  *changes = 0;
  for (PetscInt A = 0; A < hats; ++A) {
    const PetscInt multiplier = 2 * b->node_count + A;
    const PetscReal gap = b->result.gap[A] / b->result.weight[A];
    const PetscBool active = (PetscBool)(!BlocksHatIsMerged(b, A) && b->lambda[A] - b->scale * gap > 0.0);

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

/* Largest residual of equilibrium, in the plane and across, and of the active gaps; residual: of the walls. */
static PetscReal BlocksError(const Blocks *b, const PetscReal residual[])
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
  for (PetscInt e = 0; e < b->element_count; ++e) largest = PetscMax(largest, PetscAbsReal(b->thickness[e].force));
  (void)PetscFree(r);
  return largest;
}

PetscErrorCode BlocksFactorAndSolve(Mat K, PetscInt size, PetscReal rhs[], PetscReal solution[], PetscInt *negative)
{
  MatFactorInfo info;
  Mat factor;
  Vec right, left;

  PetscFunctionBeginUser;
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, rhs, &right));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, solution, &left));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(K, MATSOLVERMUMPS, negative ? MAT_FACTOR_CHOLESKY : MAT_FACTOR_LU, &factor));
  PetscCall(MatMumpsSetIcntl(factor, 14, 50)); /* workspace margin, per cent */
  if (negative) {
    PetscCall(MatCholeskyFactorSymbolic(factor, K, NULL, &info));
    PetscCall(MatCholeskyFactorNumeric(factor, K, &info));
    PetscCall(MatGetInertia(factor, negative, NULL, NULL));
  } else {
    PetscCall(MatLUFactorSymbolic(factor, K, NULL, NULL, &info));
    PetscCall(MatLUFactorNumeric(factor, K, &info));
  }
  PetscCall(MatSolve(factor, right, left));
  PetscCall(MatDestroy(&factor));
  PetscCall(VecDestroy(&right));
  PetscCall(VecDestroy(&left));
  PetscFunctionReturn(0);
}

void BlocksStep(Blocks *b, const PetscReal solution[])
{
  for (PetscInt e = 0; e < b->element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2], dx[LAM_ELEMENT_NODES][2];

    BlocksGather(b, e, x);
    for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; ++i) dx[i / 2][i % 2] = solution[2 * b->elements[e][i / 2] + i % 2];
    LamElementUpdateStress(&b->geometry[e], &b->wall_of[e],
                           (const PetscReal(*)[2])BlocksDisplaced(b, e, (const PetscReal(*)[2])x).u,
                           (const PetscReal(*)[2])dx, b->F33[e], 0.0, 1.0, &b->stress[e]);
    if (b->plane_stress) BlocksStepThickness(b, e, (const PetscReal(*)[2])x, (const PetscReal(*)[2])dx);
  }
  for (PetscInt i = 0; i < 2 * b->node_count; ++i) b->x[i / 2][i % 2] += solution[i];
  for (PetscInt A = 0; A < 2 * b->n + 1; ++A) b->lambda[A] = b->active[A] ? solution[2 * b->node_count + A] : 0.0;
  if (!b->ends_held) return;
  b->lambda[0] = b->lambda[1];
  b->lambda[2 * b->n] = b->lambda[2 * b->n - 1];
}

static PetscErrorCode BlocksMatrix(const Blocks *b, PetscInt size, Mat *K)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, size, size, 120, NULL, K));
  PetscCall(MatSetOption(*K, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(MatSetOption(*K, MAT_IGNORE_ZERO_ENTRIES, PETSC_TRUE));
  PetscCall(MatSetOption(*K, MAT_SYMMETRIC, PETSC_TRUE));
  for (PetscInt i = 0; i < 2 * b->node_count; ++i)
    if (b->held[i / 2][i % 2]) PetscCall(MatSetValue(*K, i, i, 1.0, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* Residuals and tangent at the present positions; `done` where the residuals are below `tolerance`. */
static PetscErrorCode BlocksAssemble(Blocks *b, PetscReal tolerance, Mat K, PetscReal rhs[], PetscBool *valid,
                                     PetscBool *done)
{
  const PetscInt positions = 2 * b->node_count;
  PetscInt changes = 0;

  PetscFunctionBeginUser;
  PetscCall(BlocksAddWalls(b, K, rhs, valid));
  if (!*valid) PetscFunctionReturn(0);
  PetscCall(BlocksAddContact(b, K, &changes));
  PetscCall(MatAssemblyBegin(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(K, MAT_FINAL_ASSEMBLY));
  *done = (PetscBool)(changes == 0 && BlocksError(b, rhs) <= tolerance);
  for (PetscInt i = 0; i < positions; ++i) rhs[i] *= b->held[i / 2][i % 2] ? 0.0 : -1.0;
  for (PetscInt A = 0; A < 2 * b->n + 1; ++A) rhs[positions + A] = b->active[A] ? b->result.gap[A] : 0.0;
  PetscFunctionReturn(0);
}

/* One Newton step, or none where the residuals are below `tolerance` or an element is inside out (not valid). */
static PetscErrorCode BlocksIterate(Blocks *b, PetscReal tolerance, PetscBool *valid, PetscBool *done)
{
  const PetscInt size = 2 * b->node_count + 2 * b->n + 1;
  PetscReal *rhs, *solution;
  Mat K;

  PetscFunctionBeginUser;
  *done = PETSC_FALSE;
  PetscCall(PetscCalloc2(size, &rhs, size, &solution));
  PetscCall(BlocksMatrix(b, size, &K));
  PetscCall(BlocksAssemble(b, tolerance, K, rhs, valid, done));
  if (*valid && !*done) {
    PetscCall(BlocksFactorAndSolve(K, size, rhs, solution, &b->negative));
    BlocksStep(b, solution);
  }
  PetscCall(MatDestroy(&K));
  PetscCall(PetscFree2(rhs, solution));
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksTry(Blocks *b, PetscReal tolerance, PetscInt *iterations, PetscBool *converged)
{
  PetscBool valid = PETSC_TRUE;

  PetscFunctionBeginUser;
  *converged = PETSC_FALSE;
  for (*iterations = 0; *iterations < BLOCKS_ITERATIONS && valid; ++*iterations) {
    PetscCall(BlocksIterate(b, tolerance, &valid, converged));
    if (*converged) break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksSolve(Blocks *b, PetscReal tolerance, PetscInt *iterations)
{
  PetscBool converged;

  PetscFunctionBeginUser;
  PetscCall(BlocksTry(b, tolerance, iterations, &converged));
  PetscCheck(converged, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "no contact equilibrium of the blocks in %d iterations",
             BLOCKS_ITERATIONS);
  PetscFunctionReturn(0);
}
