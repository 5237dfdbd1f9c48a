#include "bare_tissue.h"

#define BARE_ITERATIONS 25
PetscErrorCode BareCreate(const LamMicrostructure *micro, LamRVE *out)
{
  LamRVE rve;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&rve));
  rve->linear = &rve->systems[0];
  rve->micro = *micro;
  PetscCall(LamMeshCreate(micro, &rve->mesh));
  PetscCall(PetscMalloc1(rve->mesh.cell_count, &rve->law));
  for (PetscInt c = 0; c < rve->mesh.cell_count; c++) PetscCall(LamWallLawGet(micro->wall.law, &rve->law[c]));
  rve->stiffest = micro->wall.bulk_modulus + micro->wall.C4;
  PetscCall(LamGeometryCreate(rve));
  PetscCall(LamLinearCreate(&rve->mesh, NULL, 0, rve->linear));
  rve->ndof = rve->length = 2 * rve->mesh.class_count;
  PetscCall(PetscCalloc3(rve->ndof, &rve->y, rve->ndof, &rve->step, rve->ndof, &rve->residual));
  PetscCall(LamLinearCreateMatrix(PETSC_COMM_SELF, rve->linear));
  *out = rve;
  PetscFunctionReturn(0);
}

PetscErrorCode BareDestroy(LamRVE *rve)
{
  PetscFunctionBeginUser;
  PetscCall(LamLinearDestroy((*rve)->linear));
  PetscCall(LamMeshDestroy(&(*rve)->mesh));
  PetscCall(PetscFree((*rve)->law));
  PetscCall(PetscFree((*rve)->geometry));
  PetscCall(PetscFree((*rve)->stress));
  PetscCall(PetscFree3((*rve)->y, (*rve)->step, (*rve)->residual));
  PetscCall(PetscFree(*rve));
  PetscFunctionReturn(0);
}

/* Residual and tangent of the walls. */
static void BareAssemble(LamRVE rve, const LamLoad *load)
{
  PetscReal *values = rve->linear->values;

  PetscArrayzero(rve->residual, rve->ndof);
  PetscArrayzero(values, rve->linear->nonzeros);
  for (PetscInt e = 0; e < rve->mesh.element_count; e++) {
    const PetscInt *nodes = &rve->mesh.elements[LAM_ELEMENT_NODES * e],
                   *position = &rve->linear->position[LAM_PAIRS * e];
    PetscReal u[LAM_ELEMENT_NODES][2];
    LamElementResult element;
    PetscBool valid;

    LamGatherDisplacements(rve, load->F, rve->y, e, u);
    LamElementEvaluate(&rve->geometry[e], rve->law[0], &rve->micro.wall, NULL, (const PetscReal(*)[2])u, load->F[8],
                       &rve->stress[e], &element, &valid);
    for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; i++)
      rve->residual[2 * rve->mesh.node_class[nodes[i / 2]] + i % 2] += element.f[i];
    for (PetscInt i = 0, pair = 0; i < LAM_ELEMENT_DOFS; i++)
      for (PetscInt j = i; j < LAM_ELEMENT_DOFS; j++, pair++)
        if (position[pair] >= 0) values[position[pair]] += element.K[i][j];
  }
}

static PetscReal BareNorm(LamRVE rve)
{
  PetscReal sum = 0;

  for (PetscInt i = 2; i < rve->ndof; i++) sum += rve->residual[i] * rve->residual[i];
  return PetscSqrtReal(sum);
}

/* One Newton step from the assembled state. */
static PetscErrorCode BareStep(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  static const PetscReal still[9] = {0};
  PetscInt negative;

  PetscFunctionBeginUser;
  PetscCall(LamLinearFactor(rve->linear, 0, &negative, ok));
  *ok = (PetscBool)(*ok && negative == 0);
  PetscCall(LamLinearSolve(rve->linear, 1, rve->residual + 2, rve->step + 2));
  for (PetscInt i = 2; i < rve->ndof; i++) rve->step[i] = -rve->step[i];
  LamUpdateStresses(rve, load, rve->y, rve->step, still, 1);
  for (PetscInt i = 0; i < rve->ndof; i++) rve->y[i] += rve->step[i];
  *ok = (PetscBool)(*ok && LamPositionsAreValid(rve, load, rve->y));
  PetscFunctionReturn(0);
}

/* Entry i of a step for element e; the held class does not move. */
static PetscReal BareMoved(LamRVE rve, PetscInt e, PetscInt i)
{
  return rve->step[2 * rve->mesh.node_class[rve->mesh.elements[LAM_ELEMENT_NODES * e + i / 2]] + i % 2];
}

/* P from the forces on shifted nodes, P33 from those on the walls' faces; rve->step: from the solution to rve->y. */
static void BareStress(LamRVE rve, const LamLoad *load, PetscReal P[9])
{
  for (PetscInt i = 0; i < 9; i++) P[i] = 0;
  for (PetscInt e = 0; e < rve->mesh.element_count; e++) {
    PetscReal u[LAM_ELEMENT_NODES][2], force33, ff, fx[LAM_ELEMENT_DOFS];
    LamElementResult element;
    PetscBool valid;

    LamGatherDisplacements(rve, load->F, rve->y, e, u);
    LamElementStretch33(&rve->geometry[e], rve->law[0], &rve->micro.wall, NULL, (const PetscReal(*)[2])u, load->F[8],
                        &rve->stress[e], &force33, fx, &ff);
    for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; i++) force33 -= fx[i] * BareMoved(rve, e, i);
    P[8] += force33 / rve->mesh.V0;
    if (!rve->mesh.has_shift[e]) continue;
    LamElementEvaluate(&rve->geometry[e], rve->law[0], &rve->micro.wall, NULL, (const PetscReal(*)[2])u, load->F[8],
                       &rve->stress[e], &element, &valid);
    for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; i++)
      for (PetscInt j = 0; j < LAM_ELEMENT_DOFS; j++) element.f[i] -= element.K[i][j] * BareMoved(rve, e, j);
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; a++) {
      const PetscReal *S = &rve->mesh.shift[2 * rve->mesh.elements[LAM_ELEMENT_NODES * e + a]];

      for (PetscInt k = 0; k < 2; k++)
        for (PetscInt l = 0; l < 2; l++) P[3 * k + l] += element.f[2 * a + k] * S[l] / rve->mesh.V0;
    }
  }
}

PetscErrorCode BareSolve(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  LamLoad start = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const PetscReal tolerance = LamNewtonTolerance(rve);
  PetscInt negative, iteration = 0;
  PetscBool ok = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  PetscCall(PetscArraycpy(rve->step, rve->mesh.class_X, rve->ndof));
  LamRotatePositions(rve->ndof, rve->step, start.F, LamRotationAngle(load->F));
  LamMoveAffinely(rve, rve->step, &start, load);
  rve->step[0] = rve->step[1] = 0;
  for (; ok && iteration < BARE_ITERATIONS; iteration++) {
    BareAssemble(rve, load);
    if (BareNorm(rve) <= tolerance) break;
    PetscCall(BareStep(rve, load, &ok));
  }
  if (!ok || iteration == BARE_ITERATIONS) PetscFunctionReturn(0);
  ok = LamSetConsistentStresses(rve, load, rve->y);
  BareAssemble(rve, load);
  PetscCall(LamLinearFactor(rve->linear, 0, &negative, &ok));
  PetscCall(LamLinearSolve(rve->linear, 1, rve->residual + 2, rve->step + 2));
  BareStress(rve, load, response->P);
  response->status = ok && negative == 0 ? LAM_CONVERGED : LAM_UNSTABLE;
  response->newton_iterations = iteration;
  response->factorisations = iteration + 1;
  response->unknowns = rve->linear->n;
  PetscFunctionReturn(0);
}
