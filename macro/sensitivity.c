/*
  How much each material point's stress counts in the reactions.

  Method. To first order in a change of stress dP at u, displacements change by du and the reaction R by

    dR = sum over the points of G : dP,  G = w dv/dX, and w v1/R for F33 of an axisymmetric body

  where v is the displacement by which the virtual work of the unbalanced force is that reaction: the pull of the
  reaction at nodes that are prescribed or touch an obstacle, and K^T v = 0 elsewhere, with the run's own tangent K
  (symmetric but for followers). So one factorisation and one solve per component of a reaction serve all points.
  Where a node touches a round obstacle, its force turns as it slides, which adds curvature times force to the equation
  along the tangent (rows.c).

  The inflated body, from which displacements are measured, changes with the stress dP0 that it has there. K^T v at a
  prescribed node is the derivative of R by its displacement; with it as load on the inflated body, whose tangent was
  kept, v0 gives R the part sum of w dv0/dX : dP0.
*/
#include "macro_impl.h"

/* ---- the transposed tangent ---- */

/* Rows and transposed tangent of the state in macro->now at macro->u. free: without the rows of the conditions; NULL:
   not wanted. */
static PetscErrorCode Transposed(LamMacro macro, Mat *constrained, Mat *free)
{
  PetscReal scale;

  PetscFunctionBeginUser;
  PetscCall(LamMacroAssembleForce(macro, macro->force, &scale));
  PetscCall(LamMacroExternalForce(macro, macro->u, macro->external));
  PetscCall(VecWAXPY(macro->residual, -LamMacroTractionFactor(macro), macro->external, macro->force));
  macro->fresh = PETSC_FALSE;
  PetscCall(LamMacroConstrainResidual(macro, macro->u, macro->residual));
  PetscCall(LamMacroAssembleTangent(macro, macro->tangent));
  PetscCall(LamMacroAddTractionTangent(macro, macro->u, macro->tangent));
  PetscCall(MatTranspose(macro->tangent, MAT_INITIAL_MATRIX, constrained));
  if (free) PetscCall(MatDuplicate(*constrained, MAT_COPY_VALUES, free));
  PetscCall(LamMacroConstrainTangent(macro, *constrained));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolverCreate(LamMacro macro, Mat K, KSP *ksp)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(macro->comm, ksp));
  PetscCall(KSPSetType(*ksp, KSPPREONLY));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetOperators(*ksp, K, K));
  PetscFunctionReturn(0);
}

/* ---- the inflated body ---- */

PetscErrorCode LamMacroInflatedDestroy(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(macro->inflated.points));
  PetscCall(PetscFree(macro->inflated.dP));
  PetscCall(PetscFree(macro->inflated.rows));
  PetscCall(KSPDestroy(&macro->inflated.solver));
  PetscFunctionReturn(0);
}

/* Rounding of F and P between equal points: the tolerance of Newton's method leaves less. */
static const PetscReal UNIFORM = 1e-8;

/* Whether F, turgor, cohesion and P are the same at all points. */
static PetscErrorCode FindUniform(LamMacro macro, const LamMaterialPoint points[], PetscBool *uniform)
{
  PetscReal most[2 * (11 + 9)]; /* the largest values, and minus the smallest */

  PetscFunctionBeginUser;
  for (int k = 0; k < 40; k++) most[k] = -PETSC_INFINITY;
  for (PetscInt p = 0; p < macro->point_count; p++) {
    for (int k = 0; k < 20; k++) {
      const PetscReal value = k < 9    ? points[p].load.F[k]
                              : k < 18 ? points[p].P[k - 9]
                                       : (k == 18 ? points[p].load.turgor : points[p].load.cohesion);
      most[k] = PetscMax(most[k], value);
      most[20 + k] = PetscMax(most[20 + k], -value);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 40, MPIU_REAL, MPIU_MAX, macro->comm));
  *uniform = PETSC_TRUE;
  for (int k = 0; k < 20; k++) *uniform = (PetscBool)(*uniform && most[k] + most[20 + k] <= UNIFORM);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroKeepInflated(LamMacro macro)
{
  LamMacroInflated *inflated = &macro->inflated;
  Mat K;

  PetscFunctionBeginUser;
  PetscCall(LamMacroInflatedDestroy(macro));
  PetscCall(PetscMalloc1(macro->point_count, &inflated->points));
  PetscCall(PetscArraycpy(inflated->points, macro->now, macro->point_count));
  PetscCall(FindUniform(macro, inflated->points, &inflated->uniform));
  PetscCall(Transposed(macro, &K, NULL));
  PetscCall(SolverCreate(macro, K, &inflated->solver));
  PetscCall(MatDestroy(&K)); /* the solver holds it */
  inflated->row_count = macro->row_count;
  PetscCall(PetscMalloc1(macro->row_count, &inflated->rows));
  PetscCall(PetscArraycpy(inflated->rows, macro->rows, macro->row_count));
  PetscFunctionReturn(0);
}

/* Applies the linear part of the inflated body's rows. */
static PetscErrorCode CombineInflated(LamMacro macro, Vec force)
{
  LamNodeRows *rows = macro->rows;
  const PetscInt count = macro->row_count;

  PetscFunctionBeginUser;
  macro->rows = macro->inflated.rows;
  macro->row_count = macro->inflated.row_count;
  PetscCall(LamMacroCombineRows(macro, force));
  macro->rows = rows;
  macro->row_count = count;
  PetscFunctionReturn(0);
}

/* Whether row i of a node prescribes a displacement. */
static PetscBool Prescribes(const LamNodeRows *rows, PetscInt i)
{
  return (PetscBool)(rows->combine[2 * i] == 0 && rows->combine[2 * i + 1] == 0);
}

/* Minus the derivative of the reaction by the displacement of the inflated body, from its derivative z by that of the
   prescribed nodes: their displacement is the solution of their two rows. */
static PetscErrorCode LoadInflated(LamMacro macro, Vec derivative, Vec load)
{
  const PetscScalar *z;
  PetscScalar *q;

  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(load));
  PetscCall(VecGetArrayRead(derivative, &z));
  PetscCall(VecGetArray(load, &q));
  for (PetscInt k = 0; k < macro->constraint_count; k = LamMacroNextHeld(macro, k)) {
    const LamNodeRows *rows = &macro->rows[macro->constraints[k].row];
    const PetscReal *a = Prescribes(rows, 0) ? rows->add : rows->combine;
    const PetscReal *b = Prescribes(rows, 1) ? rows->add + 2 : rows->combine + 2, det = a[0] * b[1] - a[1] * b[0];
    const PetscReal zx = PetscRealPart(z[rows->local]), zy = PetscRealPart(z[rows->local + 1]);
    const PetscReal y[2] = {(zx * b[1] - zy * b[0]) / det, (a[0] * zy - a[1] * zx) / det};

    for (PetscInt d = k; d < LamMacroNextHeld(macro, k); d++) {
      const PetscReal *normal = macro->constraints[d].normal;
      const PetscInt row = Prescribes(rows, 0) && a[0] == normal[0] && a[1] == normal[1] ? 0 : 1;
      for (PetscInt j = 0; j < 2; j++) q[rows->local + j] -= normal[j] * y[row];
    }
  }
  PetscCall(VecRestoreArray(load, &q));
  PetscCall(VecRestoreArrayRead(derivative, &z));
  PetscCall(CombineInflated(macro, load));
  PetscFunctionReturn(0);
}

/* ---- loads and solutions ---- */

/* The pull of a component of a side's reaction: its derivative by the forces of the nodes that bear it. */
static void FillPull(LamMacro macro, const PetscScalar u[], PetscInt side, PetscInt component, PetscScalar pull[])
{
  const PetscReal unit[2][2] = {{1, 0}, {0, 1}};

  for (PetscInt j = 0; j < 2; j++) {
    for (PetscInt k = 0; k < macro->constraint_count; k = LamMacroNextHeld(macro, k)) {
      PetscReal reaction[LAM_MAX_BOUNDARIES][2] = {{0}};
      LamMacroShareHeld(macro, k, unit[j], reaction);
      pull[macro->constraints[k].local + j] += reaction[side][component];
    }
    for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
      const LamObstacleNode *node = &macro->obstacle_nodes[k];
      const LamTouch touch = LamMacroNearest(macro, node, u, NULL);
      PetscReal reaction[LAM_MAX_BOUNDARIES][2] = {{0}};
      if (!node->active) continue;
      LamMacroShareTouched(macro, node, &touch, unit[j], reaction);
      pull[node->local + j] += reaction[side][component];
    }
  }
}

/* Puts the pull into the rows that prescribe. */
static void PullRows(LamMacro macro, PetscScalar pull[])
{
  for (PetscInt k = 0; k < macro->row_count; k++) {
    const LamNodeRows *rows = &macro->rows[k];
    const PetscScalar old[2] = {pull[rows->local], pull[rows->local + 1]};
    for (PetscInt i = 0; i < 2; i++)
      pull[rows->local + i] =
          Prescribes(rows, i) ? rows->add[2 * i] * old[0] + rows->add[2 * i + 1] * old[1] : (PetscScalar)0;
  }
}

/* Nodes at a round obstacle: their force turns as they slide. Their rows follow those of the prescribed nodes. */
static void TurnRows(LamMacro macro, const PetscScalar u[], PetscInt side, PetscInt component, PetscScalar load[])
{
  const LamNodeRows *rows = macro->rows;

  for (PetscInt k = 0; k < macro->constraint_count; k = LamMacroNextHeld(macro, k)) rows++;
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    if (!node->active || node->constraint >= 0) continue;
    const PetscBool own = (PetscBool)(macro->obstacles[LamMacroNearest(macro, node, u, NULL).obstacle].side == side);
    for (PetscInt i = 0; i < 2 && own; i++)
      if (!Prescribes(rows, i)) load[rows->local + i] = rows->add[2 * i + component];
    rows++;
  }
}

static PetscErrorCode FillLoad(LamMacro macro, PetscInt side, PetscInt component, Vec load)
{
  const PetscScalar *u;
  PetscScalar *values;

  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(load));
  PetscCall(VecGetArrayRead(macro->u, &u));
  PetscCall(VecGetArray(load, &values));
  FillPull(macro, u, side, component, values);
  PullRows(macro, values);
  TurnRows(macro, u, side, component, values);
  PetscCall(VecRestoreArray(load, &values));
  PetscCall(VecRestoreArrayRead(macro->u, &u));
  PetscFunctionReturn(0);
}

/* G = w dv/dX, and w v1/X1 for F33; [points][strains]. */
static PetscErrorCode Gradients(LamMacro macro, Vec v, PetscReal G[])
{
  const PetscInt dim = macro->dim, n = macro->strains;
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(G, macro->point_count * n));
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(DMGlobalToLocal(macro->dm, v, INSERT_VALUES, local));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscScalar *ve = NULL;
    PetscCall(DMPlexVecGetClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &ve));
    for (PetscInt q = 0; q < element->kind->points; q++) {
      const PetscReal *dN = LamMacroGradient(macro, element, q), *hoop = LamMacroHoop(macro, element, q);
      const PetscInt point = element->first + q;
      for (PetscInt a = 0; a < element->kind->nodes; a++) {
        for (PetscInt ij = 0; ij < dim * dim; ij++)
          G[point * n + ij] += macro->weight[point] * PetscRealPart(ve[dim * a + ij / dim]) * dN[dim * a + ij % dim];
        if (hoop) G[point * n + n - 1] += macro->weight[point] * PetscRealPart(ve[dim * a]) * hoop[a];
      }
    }
    PetscCall(DMPlexVecRestoreClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &ve));
  }
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveWith(KSP ksp, Vec load, Vec v, PetscBool *ok)
{
  KSPConvergedReason reason;

  PetscFunctionBeginUser;
  PetscCall(KSPSolve(ksp, load, v));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  if (reason <= 0) *ok = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* One component; *any: its reaction depends on the stress. */
static PetscErrorCode Component(LamMacro macro, KSP ksp, Mat free, LamSensitivity *s, PetscBool *any, PetscBool *ok)
{
  const PetscInt values = macro->point_count * macro->strains, k = s->count;
  PetscReal norm;
  Vec load, v;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(macro->u, &load));
  PetscCall(VecDuplicate(macro->u, &v));
  PetscCall(FillLoad(macro, s->side[k], s->component[k], load));
  PetscCall(VecNorm(load, NORM_INFINITY, &norm));
  *any = (PetscBool)(norm > 0);
  if (*any) PetscCall(SolveWith(ksp, load, v, ok));
  if (*any && *ok) PetscCall(Gradients(macro, v, &s->G[k * values]));
  if (*any && *ok && free) {
    PetscCall(MatMult(free, v, macro->residual));
    PetscCall(LoadInflated(macro, macro->residual, load));
    PetscCall(SolveWith(macro->inflated.solver, load, v, ok));
    if (*ok) PetscCall(Gradients(macro, v, &s->inflated[k * values]));
  }
  PetscCall(VecDestroy(&load));
  PetscCall(VecDestroy(&v));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSensitivityCreate(LamMacro macro, LamSensitivity *s, PetscBool *ok)
{
  const PetscInt most = 2 * macro->step.boundary_count, values = macro->point_count * macro->strains;
  const PetscBool inflated = (PetscBool)(macro->loaded && macro->inflated.points);
  Mat K, free = NULL;
  KSP ksp;

  PetscFunctionBeginUser;
  *s = (LamSensitivity){0};
  *ok = PETSC_TRUE;
  PetscCall(PetscMalloc1(most * values, &s->G));
  if (inflated) PetscCall(PetscMalloc1(most * values, &s->inflated));
  PetscCall(Transposed(macro, &K, inflated ? &free : NULL));
  PetscCall(SolverCreate(macro, K, &ksp));
  for (PetscInt k = 0; k < most && *ok; k++) {
    PetscBool any = PETSC_FALSE;
    s->side[s->count] = k / 2;
    s->component[s->count] = k % 2;
    PetscCall(Component(macro, ksp, free, s, &any, ok));
    if (any) s->count++;
  }
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&free));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSensitivityDestroy(LamSensitivity *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->G));
  PetscCall(PetscFree(s->inflated));
  PetscFunctionReturn(0);
}
