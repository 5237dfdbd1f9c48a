#include "mixed_element.h"

/* The displacement that the problem prescribes at X; PETSC_FALSE: component i is free there. */
static PetscBool ProblemPrescribes(const Problem *problem, const PetscReal X[2], PetscInt i, PetscReal *u)
{
  const PetscReal x = X[0], y = X[1], tiny = 1e-9;

  if (problem->kind == PROBLEM_COOK) {
    *u = x > 1 ? problem->amplitude : 0;
    return (PetscBool)(x < tiny || (i == 1 && x > 48 - tiny));
  }
  *u = problem->amplitude * (i == 0 ? x * x * x - 3 * x * y * y : y * y * y - 3 * x * x * y);
  if (problem->gradient) *u += problem->amplitude * (i == 0 ? y * y * y : x * x * x);
  return (PetscBool)(x < tiny || x > 1 - tiny || y < tiny || y > 1 - tiny);
}

/* Replaces the conditions of the scene by those of the problem. */
static PetscErrorCode ProblemHold(const Problem *problem, LamMacro macro)
{
  PetscFunctionBeginUser;
  macro->constraint_count = 0;
  for (PetscInt k = 0; k < macro->node_count; k++) {
    const PetscInt p = macro->nodes[k].point, local = macro->nodes[k].local;
    for (PetscInt i = 0; i < 2; i++) {
      PetscReal u;
      if (!ProblemPrescribes(problem, macro->nodes[k].X, i, &u)) continue;
      macro->constraints[macro->constraint_count++] =
          (LamConstraint){.point = p, .local = local, .normal = {i == 0, i == 1}, .end = u, .target = u, .border = -1};
    }
  }
  PetscFunctionReturn(0);
}

/* Errors of the smooth problem's gradient and turgor. */
static void ProblemErrors(LamMacro macro, const Problem *problem, ProblemResult *result)
{
  PetscReal error[2] = {0}, size[2] = {0}, mean = 0, area = 0;

  for (PetscInt p = 0; p < macro->point_count; p++) {
    const PetscReal x = macro->place[2 * p], y = macro->place[2 * p + 1], c = problem->gradient ? 3 : 0,
                    H[4] = {3 * x * x - 3 * y * y, -6 * x * y + c * y * y, -6 * x * y + c * x * x,
                            3 * y * y - 3 * x * x};
    for (int k = 0; k < 4; k++) {
      const PetscReal found = macro->now[p].load.F[3 * (k / 2) + k % 2] - (k % 3 == 0);
      error[0] += macro->weight[p] * PetscSqr(found - problem->amplitude * H[k]);
      size[0] += macro->weight[p] * PetscSqr(problem->amplitude * H[k]);
    }
    area += macro->weight[p];
    mean += macro->weight[p] * macro->now[p].load.turgor;
  }
  result->strain = sqrt(error[0] / size[0]);
  for (PetscInt p = 0; p < macro->point_count && problem->gradient; p++) {
    const PetscReal x = macro->place[2 * p], y = macro->place[2 * p + 1],
                    lumen = problem->phi + problem->c * problem->scene->turgor,
                    change = 6 * problem->amplitude * problem->mu / lumen * (x * y - 0.25);
    error[1] += macro->weight[p] * PetscSqr(macro->now[p].load.turgor - mean / area - change);
    size[1] += macro->weight[p] * PetscSqr(change);
  }
  result->turgor = problem->gradient ? sqrt(error[1] / size[1]) : 0;
}

static PetscErrorCode ProblemMeasure(LamMacro macro, const Problem *problem, ProblemResult *result)
{
  const LamMacroSeal *seal = macro->seal;
  const PetscScalar *force;
  SNESConvergedReason reason;
  PetscReal *history;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(result, sizeof(*result)));
  PetscCall(SNESGetConvergedReason(macro->snes, &reason));
  if (reason <= 0) PetscFunctionReturn(0);
  PetscCall(SNESGetConvergenceHistory(macro->snes, &history, NULL, &n));
  result->residual_count = PetscMin(n, (PetscInt)PETSC_STATIC_ARRAY_LENGTH(result->residuals));
  for (PetscInt k = 0; k < result->residual_count; k++) result->residuals[k] = history[k] / macro->force_scale;
  ProblemErrors(macro, problem, result);
  for (PetscInt p = 0; p < macro->point_count; p++) {
    PetscReal energy = macro->responses[p].energy;
    if (seal) {
      const PetscReal q = macro->now[p].load.turgor - problem->scene->turgor;
      energy += seal->water[p] * (q - 0.5 * q * q / problem->scene->water_bulk_modulus);
    }
    result->energy += macro->weight[p] * energy;
  }
  PetscCall(VecGetArrayRead(macro->force, &force));
  for (PetscInt k = 0; k < macro->constraint_count; k++)
    if (macro->constraints[k].end != 0)
      result->force += PetscRealPart(force[macro->constraints[k].local + (macro->constraints[k].normal[1] != 0)]);
  PetscCall(VecRestoreArrayRead(macro->force, &force));
  PetscFunctionReturn(0);
}

static PetscErrorCode ProblemResponder(const Problem *problem, PetscInt points, LamResponder *responder)
{
  Synthetic *material;

  PetscFunctionBeginUser;
  if (problem->rve) {
    PetscCall(LamRVEResponderCreate(problem->rve, points, responder));
    PetscFunctionReturn(0);
  }
  PetscCall(SyntheticCreate(points, responder, &material));
  material->mu = problem->mu;
  material->lambda = problem->lambda;
  material->phi = problem->phi;
  material->c = problem->c;
  PetscFunctionReturn(0);
}

PetscErrorCode ProblemSolve(const Problem *problem, ProblemResult *result)
{
  LamScene scene = *problem->scene;
  LamResponder responder;
  PetscInt points;
  LamMacro macro;
  PetscBool ok;

  PetscFunctionBeginUser;
  scene.has_macro = PETSC_TRUE;
  scene.macro = (LamMacroSpec){.source = LAM_MESH_GMSH, .steps = 1, .boundary_count = 1};
  scene.macro.boundary[0] = (LamBoundary){.on = "left", .given = {PETSC_TRUE, PETSC_TRUE}};
  GmshWrite(scene.macro.gmsh, (int)problem->n, (int)problem->n, problem->elements,
            problem->kind == PROBLEM_COOK ? GmshCook : GmshDistorted);
  PetscCall(LamMacroCreate(PETSC_COMM_SELF, &macro));
  PetscCall(LamMacroSetScene(macro, &scene));
  PetscCall(LamMacroSetUp(macro));
  unlink(scene.macro.gmsh);
  PetscCall(LamMacroGetPointCount(macro, &points));
  PetscCall(ProblemResponder(problem, points, &responder));
  PetscCall(LamMacroSetResponder(macro, responder));
  PetscCall(LamMacroSealLumens(macro, &ok));
  PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", macro->trouble);
  PetscCall(ProblemHold(problem, macro));
  macro->turgor = 1;
  PetscCall(SNESSolve(macro->snes, NULL, macro->trial));
  PetscCall(ProblemMeasure(macro, problem, result));
  PetscCall(LamMacroDestroy(&macro));
  PetscCall(LamResponderDestroy(&responder));
  PetscFunctionReturn(0);
}

PetscReal OrderOf(const PetscReal value[3])
{
  return log2(fabs((value[1] - value[0]) / (value[2] - value[1])));
}
