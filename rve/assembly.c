#include "rve_impl.h"

/*
  Area under one quadratic edge with nodes 0 (start), 1 (middle), 2 (end): 1/2 sum_{a<b} D_ab x_a x x_b, and the
  area inside a closed loop is the sum over its edges. Positions x enter quadratically, so the Hessian is constant.
*/
static const PetscReal edge_area[3][3] = {
    {0.0, 4.0 / 3.0, -1.0 / 3.0}, {-4.0 / 3.0, 0.0, 4.0 / 3.0}, {1.0 / 3.0, -4.0 / 3.0, 0.0}};
/* The inner edge of an element at the lumen, counter-clockwise around the lumen. */
static const PetscInt inner_edge[3] = {0, 7, 3};

PetscErrorCode LamGeometryCreate(LamRVE rve)
{
  const LamMesh *mesh = &rve->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->element_count, &rve->geometry));
  PetscCall(PetscCalloc1(mesh->element_count, &rve->stress));
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    const PetscReal angle = rve->micro.orientation + (PetscReal)LamMeshFaceOfElement(mesh, e) * 60.0 * PETSC_PI / 180.0;
    const PetscReal along[2] = {-PetscSinReal(angle), PetscCosReal(angle)};
    PetscReal X[LAM_ELEMENT_NODES][2];

    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      for (PetscInt d = 0; d < 2; ++d) X[a][d] = mesh->X[2 * mesh->elements[LAM_ELEMENT_NODES * e + a] + d];
    PetscCall(LamElementSetGeometry((const PetscReal(*)[2])X, along, &rve->geometry[e]));
  }
  PetscFunctionReturn(0);
}

void LamGatherElement(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                      PetscReal x[LAM_ELEMENT_NODES][2])
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt *nodes = &mesh->elements[LAM_ELEMENT_NODES * e];

  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
    const PetscReal *S = &mesh->shift[2 * nodes[a]], *position = &y[2 * mesh->node_class[nodes[a]]];

    x[a][0] = position[0] + F[0] * S[0] + F[1] * S[1];
    x[a][1] = position[1] + F[3] * S[0] + F[4] * S[1];
  }
}

static PetscReal EdgeArea(const PetscReal x[LAM_ELEMENT_NODES][2])
{
  PetscReal area = 0.0;

  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt b = a + 1; b < 3; ++b) {
      const PetscReal *xa = x[inner_edge[a]], *xb = x[inner_edge[b]];

      area += 0.5 * edge_area[a][b] * (xa[0] * xb[1] - xa[1] * xb[0]);
    }
  return area;
}

/* Adds factor * d(area)/dx and factor * d2(area)/dxdx of the inner edge. */
static void AddEdgeArea(const PetscReal x[LAM_ELEMENT_NODES][2], PetscReal factor, PetscReal f[LAM_ELEMENT_DOFS],
                        PetscReal K[LAM_ELEMENT_DOFS][LAM_ELEMENT_DOFS])
{
  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt b = 0; b < 3; ++b) {
      const PetscInt na = inner_edge[a], nb = inner_edge[b];
      const PetscReal c = 0.5 * factor * edge_area[a][b];

      f[2 * na] += c * x[nb][1];
      f[2 * na + 1] -= c * x[nb][0];
      if (K) {
        K[2 * na][2 * nb + 1] += c;
        K[2 * nb + 1][2 * na] += c;
      }
    }
}

PetscReal LamLumenArea(LamRVE rve, const PetscReal y[], PetscReal factor, PetscReal gradient[])
{
  static const PetscReal no_shift[9] = {0}; /* nodes at the lumen have no shift */
  const LamMesh *mesh = &rve->mesh;
  PetscReal area = 0.0, x[LAM_ELEMENT_NODES][2];

  for (PetscInt e = 0; e < mesh->element_count; e += mesh->through) {
    LamGatherElement(rve, no_shift, y, e, x);
    area += EdgeArea((const PetscReal(*)[2])x);
    if (gradient) {
      PetscReal f[LAM_ELEMENT_DOFS] = {0};

      AddEdgeArea((const PetscReal(*)[2])x, factor, f, NULL);
      for (PetscInt k = 0; k < 3; ++k)
        for (PetscInt d = 0; d < 2; ++d)
          gradient[2 * mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + inner_edge[k]]] + d] +=
              f[2 * inner_edge[k] + d];
    }
  }
  return area;
}

PetscErrorCode LamAssembleEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                                 PetscBool *valid)
{
  PetscFunctionBeginUser;
  *energy = -load->turgor * load->F[8] * LamLumenArea(rve, y, 0.0, NULL);
  *valid = PETSC_TRUE;
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2], element;

    LamGatherElement(rve, load->F, y, e, x);
    LamElementEnergy(&rve->geometry[e], rve->law, &rve->micro.wall, (const PetscReal(*)[2])x, load->F[8], &element,
                     valid);
    if (!*valid) break;
    *energy += element;
  }
  PetscFunctionReturn(0);
}

/* Adds an element's residual and upper tangent to the sums. */
static void Scatter(LamRVE rve, PetscInt e, const LamElementResult *element, PetscReal residual[])
{
  const PetscInt *nodes = &rve->mesh.elements[LAM_ELEMENT_NODES * e], *position = &rve->linear.position[LAM_PAIRS * e];
  PetscReal *values = rve->linear.values;

  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt d = 0; d < 2; ++d) residual[2 * rve->mesh.node_class[nodes[a]] + d] += element->f[2 * a + d];
  for (PetscInt i = 0, pair = 0; i < LAM_ELEMENT_DOFS; ++i)
    for (PetscInt j = i; j < LAM_ELEMENT_DOFS; ++j, ++pair)
      if (position[pair] >= 0) values[position[pair]] += element->K[i][j];
}

PetscErrorCode LamAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                           PetscReal residual[], PetscBool *valid)
{
  const PetscReal pressure = load->turgor * load->F[8];

  PetscFunctionBeginUser;
  *energy = 0.0;
  *valid = PETSC_TRUE;
  PetscCall(PetscArrayzero(residual, rve->ndof));
  PetscCall(PetscArrayzero(rve->linear.values, rve->linear.nonzeros));
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2];
    LamElementResult element;

    LamGatherElement(rve, load->F, y, e, x);
    LamElementEvaluate(&rve->geometry[e], rve->law, &rve->micro.wall, (const PetscReal(*)[2])x, load->F[8],
                       &rve->stress[e], &element, valid);
    if (!*valid) break;
    *energy += element.energy;
    if (LamMeshElementIsInner(&rve->mesh, e) && pressure != 0.0) {
      *energy -= pressure * EdgeArea((const PetscReal(*)[2])x);
      AddEdgeArea((const PetscReal(*)[2])x, -pressure, element.f, element.K);
    }
    Scatter(rve, e, &element, residual);
  }
  PetscFunctionReturn(0);
}

void LamUpdateStresses(LamRVE rve, const LamLoad *load, const PetscReal y[], const PetscReal dy[], PetscReal alpha)
{
  static const PetscReal no_change[9] = {0}; /* F is held during an iteration */

  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2], dx[LAM_ELEMENT_NODES][2];

    LamGatherElement(rve, load->F, y, e, x);
    LamGatherElement(rve, no_change, dy, e, dx);
    LamElementUpdateStress(&rve->geometry[e], (const PetscReal(*)[2])x, (const PetscReal(*)[2])dx, load->F[8], alpha,
                           &rve->stress[e]);
  }
}

PetscBool LamPositionsAreValid(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2];

    LamGatherElement(rve, load->F, y, e, x);
    if (!LamElementIsValid(&rve->geometry[e], (const PetscReal(*)[2])x, load->F[8])) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscBool LamSetConsistentStresses(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    PetscReal x[LAM_ELEMENT_NODES][2];

    LamGatherElement(rve, load->F, y, e, x);
    if (!LamElementSetConsistentStress(&rve->geometry[e], rve->law, &rve->micro.wall, (const PetscReal(*)[2])x,
                                       load->F[8], &rve->stress[e]))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscReal LamResidualNorm(LamRVE rve, const PetscReal residual[])
{
  PetscReal sum = 0.0;

  for (PetscInt i = 2; i < rve->ndof; ++i) sum += residual[i] * residual[i];
  return PetscSqrtReal(sum);
}
