/*
  Facets of a plane body's boundary: quadratic edges.
*/
#include "macro_impl.h"
#include <math.h>

PetscErrorCode LamMacroFacetNodes(LamMacro macro, const LamMacroFacet *facet, PetscReal X[6], PetscReal *sense)
{
  const PetscInt *ends;
  const PetscReal *inside = &macro->position[2 * facet->element]; /* elements are the first mesh points */
  PetscInt nodes[3];

  PetscFunctionBeginUser;
  PetscCheck(macro->dim == 2, macro->comm, PETSC_ERR_SUP, "loads act on edges of plane bodies");
  PetscCall(DMPlexGetCone(macro->dm, facet->point, &ends));
  nodes[0] = facet->point;
  nodes[1] = ends[0];
  nodes[2] = ends[1];
  for (PetscInt a = 0; a < 3; a++)
    for (PetscInt i = 0; i < 2; i++) X[2 * a + i] = macro->position[2 * (nodes[a] - macro->mesh_start) + i];
  const PetscReal along[2] = {X[4] - X[2], X[5] - X[3]}, in[2] = {inside[0] - X[0], inside[1] - X[1]};
  *sense = along[0] * in[1] - along[1] * in[0] > 0 ? 1 : -1;
  PetscFunctionReturn(0);
}

void LamMacroFacetShape(PetscInt q, PetscReal N[3], PetscReal dN[3], PetscReal *weight)
{
  const PetscReal outer = PetscSqrtReal(0.6), xi = q == 0 ? -outer : q == 1 ? 0 : outer;

  N[0] = 1 - xi * xi;
  N[1] = 0.5 * xi * (xi - 1);
  N[2] = 0.5 * xi * (xi + 1);
  dN[0] = -2 * xi;
  dN[1] = xi - 0.5;
  dN[2] = xi + 0.5;
  *weight = q == 1 ? 8. / 9 : 5. / 9;
}

PetscReal LamMacroAround(LamMacro macro, const PetscReal N[3], const PetscReal x[6])
{
  return macro->axisymmetric ? 2 * PETSC_PI * (N[0] * x[0] + N[1] * x[2] + N[2] * x[4]) : 1;
}

PetscErrorCode LamMacroFaces(LamMacro macro, const char on[], const PetscReal direction[2], PetscBool *faces)
{
  const PetscInt set = LamMacroFindSet(macro, on);
  const PetscReal tiny = 1e-8; /* as below */
  PetscReal X[6], sense;

  PetscFunctionBeginUser;
  *faces = PETSC_FALSE;
  for (PetscInt f = 0; f < macro->facet_count; f++) {
    if (!(macro->facets[f].sets >> set & 1)) continue;
    PetscCall(LamMacroFacetNodes(macro, &macro->facets[f], X, &sense));
    const PetscReal outward[2] = {sense * (X[5] - X[3]), -sense * (X[4] - X[2])};
    if (outward[0] * direction[0] + outward[1] * direction[1] < -tiny * hypot(outward[0], outward[1]))
      *faces = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, faces, 1, MPIU_BOOL, MPI_LOR, macro->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroStraightNormal(LamMacro macro, const LamBoundary *boundary, PetscReal normal[2])
{
  const PetscInt set = LamMacroFindSet(macro, boundary->on);
  const PetscReal tiny = 1e-8; /* relative to lengths of order one */
  PetscReal sum[2] = {0, 0}, range[2] = {-PETSC_INFINITY, -PETSC_INFINITY}, X[6], sense, length;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < macro->facet_count; f++) {
    if (!(macro->facets[f].sets >> set & 1)) continue;
    PetscCall(LamMacroFacetNodes(macro, &macro->facets[f], X, &sense));
    sum[0] += sense * (X[5] - X[3]);
    sum[1] -= sense * (X[4] - X[2]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, macro->comm));
  length = PetscSqrtReal(PetscSqr(sum[0]) + PetscSqr(sum[1]));
  for (PetscInt i = 0; i < 2; i++) normal[i] = PetscAbsReal(sum[i]) > tiny * length ? sum[i] / length : 0;
  for (PetscInt f = 0; f < macro->facet_count; f++) {
    if (!(macro->facets[f].sets >> set & 1)) continue;
    PetscCall(LamMacroFacetNodes(macro, &macro->facets[f], X, &sense));
    for (PetscInt a = 0; a < 3; a++) {
      const PetscReal height = normal[0] * X[2 * a] + normal[1] * X[2 * a + 1];
      range[0] = PetscMax(range[0], height);
      range[1] = PetscMax(range[1], -height);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPIU_MAX, macro->comm));
  LamMacroRequire(
      length > 0 && range[0] + range[1] < tiny, macro, &boundary->place, "macro.boundary: on: %s: %s", boundary->on,
      boundary->kind == LAM_BOUNDARY_PLATE
          ? "plate: the side is curved; say from where the plate looks into the body, such as normal: [0, -1]"
          : "symmetry needs a straight side, which this is not; name the straight parts of it on their own");
  PetscFunctionReturn(0);
}
