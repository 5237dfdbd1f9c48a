/*
  Fields for pictures: Gauss-point values extrapolated to nodes by a bilinear fit and averaged within a cell; softest
  modes; differences between cells.
*/
#include "measure.h"

void LamFitBilinear(const PetscReal gauss[LAM_GAUSS], PetscReal c[4])
{
  const PetscReal r2 = 0.6; /* square of the Gauss abscissa */

  for (PetscInt k = 0; k < 4; ++k) c[k] = 0.0;
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    PetscReal xi, eta, weight;

    LamGaussPoint(g, &xi, &eta, &weight);
    c[0] += gauss[g] / 9.0;
    c[1] += gauss[g] * xi / (6.0 * r2);
    c[2] += gauss[g] * eta / (6.0 * r2);
    c[3] += gauss[g] * xi * eta / (4.0 * r2 * r2);
  }
}

/* Values at an element's nodes of the least-squares bilinear function through the 3 x 3 Gauss values. */
static void ExtrapolateToNodes(const PetscReal gauss[LAM_GAUSS], PetscReal node[LAM_ELEMENT_NODES])
{
  static const PetscReal at[LAM_ELEMENT_NODES][2] = {{-1, -1}, {1, -1}, {1, 1},  {-1, 1}, {0, -1},
                                                     {1, 0},   {0, 1},  {-1, 0}, {0, 0}};
  PetscReal c[4];

  LamFitBilinear(gauss, c);
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    node[a] = c[0] + c[1] * at[a][0] + c[2] * at[a][1] + c[3] * at[a][0] * at[a][1];
}

PetscErrorCode LamRVEGetFields(LamRVE rve, LamRVEState state, PetscReal x[], PetscReal fibre[], PetscReal stress[])
{
  const LamMesh *mesh = &rve->mesh;
  PetscInt *count;

  PetscFunctionBeginUser;
  LamMemoryTake(rve, state, 0.0);
  PetscCall(PetscCalloc1(mesh->node_count, &count));
  if (fibre) PetscCall(PetscArrayzero(fibre, mesh->node_count));
  if (stress) PetscCall(PetscArrayzero(stress, mesh->node_count));
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    PetscReal xe[LAM_ELEMENT_NODES][2], u[LAM_ELEMENT_NODES][2], gauss[2][LAM_GAUSS], node[2][LAM_ELEMENT_NODES];

    LamGatherElement(rve, state->load.F, state->y, e, xe);
    LamGatherDisplacements(rve, state->load.F, state->y, e, u);
    LamElementFields(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), LamHistoryOf(rve, e),
                     (const PetscReal(*)[2])u, state->load.F[8], gauss[0], gauss[1]);
    for (PetscInt k = 0; k < 2; ++k) ExtrapolateToNodes(gauss[k], node[k]);
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
      const PetscInt i = mesh->elements[LAM_ELEMENT_NODES * e + a];

      ++count[i];
      if (x)
        for (PetscInt d = 0; d < 2; ++d) x[2 * i + d] = xe[a][d];
      if (fibre) fibre[i] += node[0][a];
      if (stress) stress[i] += node[1][a];
    }
  }
  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    if (fibre) fibre[i] /= (PetscReal)count[i];
    if (stress) stress[i] /= (PetscReal)count[i];
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTakeState(LamRVE rve, LamRVEState state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(rve->y, state->y, rve->length));
  if (!rve->contact) PetscFunctionReturn(0);
  PetscCall(state->width > 0.0 ? LamUseSmoothLaw(rve, state->width) : LamUseExactLaw(rve));
  PetscCall(PetscArraycpy(rve->contact->lambda, state->lambda, state->multipliers));
  LamTakeJunctions(rve, state);
  if (state->width > 0.0) PetscFunctionReturn(0);
  PetscCall(LamContactEvaluate(rve, &state->load, rve->y));
  (void)LamContactFindActive(rve->contact);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEGetSoftestMode(LamRVE rve, LamRVEState state, PetscReal *eigenvalue, PetscReal mode[])
{
  const LamMesh *mesh = &rve->mesh;
  PetscReal *unknowns, largest;
  PetscInt negative;
  PetscBool ok;

  PetscFunctionBeginUser;
  *eigenvalue = NAN;
  LamForgetTangent(rve);
  if (rve->contact) PetscCall(LamSmoothReset(rve));
  PetscCall(LamTakeState(rve, state));
  LamMemoryTake(rve, state, 0.0);
  PetscCall(PetscCalloc1(rve->linear->n, &unknowns));
  PetscCall(LamFactorConsistent(rve, &state->load, &negative, &ok));
  if (ok) PetscCall(LamSoftestMode(rve, eigenvalue, unknowns));
  largest = LamLargestEntry(rve->linear->positions, unknowns);
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscInt at = 2 * (mesh->node_class[i] - 1) + d; /* the first class is prescribed */

      mode[2 * i + d] = at >= 0 && largest > 0.0 ? unknowns[at] / largest : 0.0;
    }
  PetscCall(PetscFree(unknowns));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEGetCellDifference(LamRVE rve, LamRVEState state, PetscReal *difference)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt nodes = LamMeshRingNodes(mesh, 0) * mesh->radial_nodes; /* of a cell */
  const PetscReal *F = state->load.F;
  PetscReal first[2];

  PetscFunctionBeginUser;
  *difference = 0.0;
  LamTissueCentre(mesh->tissue, 0, first);
  for (PetscInt i = nodes; i < mesh->node_count; ++i) {
    PetscReal centre[2], x[2], x0[2];

    LamTissueCentre(mesh->tissue, LamMeshCellOfNode(mesh, i), centre);
    LamNodePosition(rve, F, state->y, i, x);
    LamNodePosition(rve, F, state->y, i % nodes, x0);
    for (PetscInt d = 0; d < 2; ++d)
      *difference = PetscMax(*difference, PetscAbsReal(x[d] - x0[d] - F[3 * d] * (centre[0] - first[0]) -
                                                       F[3 * d + 1] * (centre[1] - first[1])));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEGetMesh(LamRVE rve, LamRVEMesh *mesh)
{
  PetscFunctionBeginUser;
  *mesh = (LamRVEMesh){.node_count = rve->mesh.node_count,
                       .element_count = rve->mesh.element_count,
                       .cell_count = rve->mesh.cell_count,
                       .nodes = rve->mesh.X,
                       .elements = rve->mesh.elements,
                       .cell_of = rve->mesh.cell_of};
  PetscCall(PetscMemcpy(mesh->period, rve->mesh.period, sizeof(mesh->period)));
  PetscFunctionReturn(0);
}
