#include "end_walls.h"
#include "rve_impl.h"

PetscErrorCode LamGeometryCreate(LamRVE rve)
{
  const LamMesh *mesh = &rve->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->element_count, &rve->geometry));
  PetscCall(PetscCalloc1(mesh->element_count, &rve->stress));
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    PetscReal X[LAM_ELEMENT_NODES][2], along[2], length;

    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      for (PetscInt d = 0; d < 2; ++d) X[a][d] = mesh->X[2 * mesh->elements[LAM_ELEMENT_NODES * e + a] + d];
    for (PetscInt d = 0; d < 2; ++d) along[d] = X[2][d] - X[1][d]; /* the chord of the outer edge */
    length = PetscSqrtReal(along[0] * along[0] + along[1] * along[1]);
    for (PetscInt d = 0; d < 2; ++d) along[d] /= length;
    PetscCall(LamElementSetGeometry((const PetscReal(*)[2])X, along, &rve->geometry[e]));
  }
  PetscFunctionReturn(0);
}

void LamGatherElement(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                      PetscReal x[LAM_ELEMENT_NODES][2])
{
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    LamNodePosition(rve, F, y, rve->mesh.elements[LAM_ELEMENT_NODES * e + a], x[a]);
}

void LamGatherDisplacements(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                            PetscReal u[LAM_ELEMENT_NODES][2])
{
  const LamMesh *mesh = &rve->mesh;
  const PetscReal H[4] = {F[0] - 1.0, F[1], F[3], F[4] - 1.0};

  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
    const PetscInt node = mesh->elements[LAM_ELEMENT_NODES * e + a], class = mesh->node_class[node];
    const PetscReal *S = &mesh->shift[2 * node];

    u[a][0] = (y[2 * class] - mesh->class_X[2 * class]) + (H[0] * S[0] + H[1] * S[1]);
    u[a][1] = (y[2 * class + 1] - mesh->class_X[2 * class + 1]) + (H[2] * S[0] + H[3] * S[1]);
  }
}

PetscReal LamSuction(LamRVE rve, const LamLoad *load)
{
  return rve->contact ? load->cohesion * load->F[8] : 0.0;
}

/* Potential of turgor and cohesion, and what end walls store. */
static PetscErrorCode LoopEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy)
{
  const PetscReal g = LamSuction(rve, load);
  LamEndWalls ends;

  PetscFunctionBeginUser;
  *energy = LamTurgorEnergy(rve, load, y);
  if (g != 0.0) *energy += g * LamGapAreaEvaluate(&rve->contact->gaps, load->F, y, NULL);
  if (!(rve->micro.length > 0.0)) PetscFunctionReturn(0);
  PetscCall(LamEndWallsEvaluate(&rve->micro, load->F, &ends));
  *energy += rve->mesh.V0 * ends.W;
  PetscFunctionReturn(0);
}

PetscErrorCode LamAssembleEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                                 PetscBool *valid)
{
  PetscFunctionBeginUser;
  PetscCall(LoopEnergy(rve, load, y, energy));
  if (rve->contact && !rve->contact->exact) *energy += LamSmoothEnergy(rve, load, y);
  if (rve->layer) *energy += LamLayerEnergy(rve, load, y);
  *valid = PETSC_TRUE;
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal u[LAM_ELEMENT_NODES][2], element;

    if (!LamMoves(rve, rve->mesh.cell_of[e])) continue;
    LamGatherDisplacements(rve, load->F, y, e, u);
    LamElementEnergy(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), LamHistoryOf(rve, e),
                     (const PetscReal(*)[2])u, load->F[8], &element, valid);
    if (!*valid) break;
    *energy += element;
  }
  PetscFunctionReturn(0);
}

/* Adds an element's residual and upper tangent to the sums. */
static void Scatter(LamRVE rve, PetscInt e, const LamElementResult *element, PetscReal residual[])
{
  const PetscInt *nodes = &rve->mesh.elements[LAM_ELEMENT_NODES * e], *position = &rve->linear->position[LAM_PAIRS * e];
  PetscReal *values = rve->linear->values;

  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt d = 0; d < 2; ++d) residual[2 * rve->mesh.node_class[nodes[a]] + d] += element->f[2 * a + d];
  for (PetscInt i = 0, pair = 0; i < LAM_ELEMENT_DOFS; ++i)
    for (PetscInt j = i; j < LAM_ELEMENT_DOFS; ++j, ++pair)
      if (position[pair] >= 0) values[position[pair]] += element->K[i][j];
}

PetscErrorCode LamAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                           PetscReal residual[], PetscBool *valid)
{
  const PetscReal suction = LamSuction(rve, load);
  const PetscBool has_turgor = LamHasTurgor(rve, load);

  PetscFunctionBeginUser;
  PetscCall(LoopEnergy(rve, load, y, energy));
  *valid = PETSC_TRUE;
  if (rve->contact && !rve->contact->exact) {
    PetscCall(LamSmoothAssemble(rve, load, y, energy, residual));
  } else {
    PetscCall(PetscArrayzero(residual, rve->length));
    PetscCall(PetscArrayzero(rve->linear->values, rve->linear->nonzeros));
  }
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal u[LAM_ELEMENT_NODES][2];
    LamElementResult element;

    if (!LamMoves(rve, rve->mesh.cell_of[e])) continue;
    LamGatherDisplacements(rve, load->F, y, e, u);
    LamElementEvaluate(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), LamHistoryOf(rve, e),
                       (const PetscReal(*)[2])u, load->F[8], &rve->stress[e], &element, valid);
    if (!*valid) break;
    *energy += element.energy;
    if (has_turgor && LamMeshElementIsInner(&rve->mesh, e)) {
      PetscReal x[LAM_ELEMENT_NODES][2];

      LamGatherElement(rve, load->F, y, e, x);
      LamAddPressure((const PetscReal(*)[2])x, LamTurgor(rve, load, y, rve->mesh.cell_of[e]) * load->F[8], &element);
    }
    Scatter(rve, e, &element, residual);
  }
  if (has_turgor) LamAssembleChords(rve, load, y, residual);
  LamSealAssemble(rve, load, y, residual);
  if (suction != 0.0) {
    LamGapAreaAddGradient(&rve->contact->gaps, load->F, y, suction, residual);
    LamGapAreaAddHessian(&rve->contact->gaps, suction, rve->linear->values);
  }
  if (rve->layer) LamLayerAssemble(rve, load, y, energy, residual);
  rve->energy = *energy;
  PetscFunctionReturn(0);
}

void LamUpdateStresses(LamRVE rve, const LamLoad *load, const PetscReal y[], const PetscReal dy[],
                       const PetscReal dF[9], PetscReal alpha)
{
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal u[LAM_ELEMENT_NODES][2], du[LAM_ELEMENT_NODES][2];

    if (!LamMoves(rve, rve->mesh.cell_of[e])) continue;
    LamGatherDisplacements(rve, load->F, y, e, u);
    LamGatherElement(rve, dF, dy, e, du);
    LamElementUpdateStress(&rve->geometry[e], LamWallOf(rve, e), (const PetscReal(*)[2])u, (const PetscReal(*)[2])du,
                           load->F[8], dF[8], alpha, &rve->stress[e]);
  }
}

PetscBool LamPositionsAreValid(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal u[LAM_ELEMENT_NODES][2];

    if (!LamMoves(rve, rve->mesh.cell_of[e])) continue;
    LamGatherDisplacements(rve, load->F, y, e, u);
    if (!LamElementIsValid(&rve->geometry[e], (const PetscReal(*)[2])u, load->F[8])) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscBool LamSetConsistentStresses(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal u[LAM_ELEMENT_NODES][2];

    LamGatherDisplacements(rve, load->F, y, e, u);
    if (!LamElementSetConsistentStress(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), (const PetscReal(*)[2])u,
                                       load->F[8], &rve->stress[e]))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscReal LamResidualNorm(LamRVE rve, const PetscReal residual[])
{
  PetscReal sum = LamSealError(rve, residual);

  for (PetscInt i = 2; i < rve->ndof; ++i) sum += residual[i] * residual[i];
  return PetscSqrtReal(sum);
}
