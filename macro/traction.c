/*
  Tractions on named sides of a plane body.

  Dead: f_a = integral of N_a t over the reference side. Followers, per current area: with tau = dx/dxi the present
  tangent of an edge that runs counter-clockwise, ds = |tau| dxi, tangent tau / |tau| and outward normal R tau / |tau|,
  R = (0 1; -1 0), so that

    f_a = integral of N_a (t_t 1 + t_n R) dx/dxi dxi = sum_b [integral of N_a dN_b/dxi dxi] (t_t 1 + t_n R) x_b

  is linear in the positions. A pressure p is t_n = -p. On an axisymmetric body the integrands have the factor 2 pi R,
  of followers 2 pi r, whose derivative by the positions adds to theirs.
*/
#include "macro_impl.h"

PetscReal LamMacroTractionFactor(LamMacro macro)
{
  const PetscInt control = macro->scene->macro.control.on[0] ? LamMacroFindBorder(macro, -1, 0) : -1;

  if (!macro->loaded) return 0;
  return control < 0 ? 1 : macro->borders[control].now;
}

/* Factor of an entry's traction. */
static PetscReal Factor(LamMacro macro, const LamBoundary *boundary)
{
  return macro->scene->macro.control.on[0] ? 1 : LamHistoryFactor(&boundary->history, macro->parameter);
}

static PetscBool IsTraction(const LamBoundary *boundary)
{
  return boundary->traction[0] != 0 || boundary->traction[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* The follower's matrix t_t 1 + t_n R at a factor, row-major. */
static void FollowerMatrix(const LamBoundary *boundary, PetscReal factor, PetscReal T[4])
{
  T[0] = T[3] = factor * boundary->traction[0];
  T[1] = factor * boundary->traction[1];
  T[2] = -T[1];
}

/* Adds the nodal forces fe [3][2] of one entry's traction on a facet, at displacements ue [3][2]. */
static PetscErrorCode AddFacetForce(LamMacro macro, const LamMacroFacet *facet, const LamBoundary *boundary,
                                    PetscReal factor, const PetscScalar ue[6], PetscScalar fe[6])
{
  PetscReal X[6], sense, T[4];

  PetscFunctionBeginUser;
  PetscCall(LamMacroFacetNodes(macro, facet, X, &sense));
  FollowerMatrix(boundary, factor, T);
  for (PetscInt a = 0; a < 6 && boundary->follower; a++) X[a] += PetscRealPart(ue[a]);
  for (PetscInt q = 0; q < LAM_FACET_POINTS; q++) {
    PetscReal N[3], dN[3], weight, tau[2] = {0, 0}, t[2];
    LamMacroFacetShape(q, N, dN, &weight);
    weight *= LamMacroAround(macro, N, X);
    for (PetscInt a = 0; a < 6; a++) tau[a % 2] += dN[a / 2] * X[a];
    for (PetscInt i = 0; i < 2; i++)
      t[i] = boundary->follower ? sense * (T[2 * i] * tau[0] + T[2 * i + 1] * tau[1])
                                : factor * boundary->traction[i] * PetscSqrtReal(PetscSqr(tau[0]) + PetscSqr(tau[1]));
    for (PetscInt a = 0; a < 3; a++)
      for (PetscInt i = 0; i < 2; i++) fe[2 * a + i] += weight * N[a] * t[i];
  }
  PetscFunctionReturn(0);
}

/* Adds the nodal forces of one condition at a local displacement to a local vector, if it is not NULL, and to `sum`. */
static PetscErrorCode AddForces(LamMacro macro, const LamBoundary *boundary, PetscReal factor, Vec displacement,
                                Vec force, PetscReal sum[2])
{
  const PetscInt set = LamMacroFindSet(macro, boundary->on);

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < macro->facet_count; f++) {
    const LamMacroFacet *facet = &macro->facets[f];
    PetscScalar *ue = NULL, fe[6] = {0};
    if (!(facet->sets >> set & 1)) continue;
    PetscCall(DMPlexVecGetClosure(macro->dm, NULL, displacement, facet->point, NULL, &ue));
    PetscCall(AddFacetForce(macro, facet, boundary, factor, ue, fe));
    PetscCall(DMPlexVecRestoreClosure(macro->dm, NULL, displacement, facet->point, NULL, &ue));
    if (force) PetscCall(DMPlexVecSetClosure(macro->dm, NULL, force, facet->point, fe, ADD_VALUES));
    for (PetscInt k = 0; k < 6; k++) sum[k % 2] += PetscRealPart(fe[k]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroExternalForce(LamMacro macro, Vec u, Vec external)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  PetscReal sum[2] = {0, 0};
  Vec displacement, force;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(macro->dm, &displacement));
  PetscCall(DMGetLocalVector(macro->dm, &force));
  PetscCall(DMGlobalToLocal(macro->dm, u, INSERT_VALUES, displacement));
  PetscCall(VecZeroEntries(force));
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const PetscReal factor = Factor(macro, &spec->boundary[b]);
    if (!IsTraction(&spec->boundary[b]) || factor == 0) continue;
    PetscCall(AddForces(macro, &spec->boundary[b], factor, displacement, force, sum));
  }
  PetscCall(VecZeroEntries(external));
  PetscCall(DMLocalToGlobal(macro->dm, force, ADD_VALUES, external));
  PetscCall(DMRestoreLocalVector(macro->dm, &force));
  PetscCall(DMRestoreLocalVector(macro->dm, &displacement));
  PetscFunctionReturn(0);
}

/* Adds minus the tangent of a follower on one facet, at displacements ue [3][2]. */
static PetscErrorCode AddFacetTangent(LamMacro macro, const LamMacroFacet *facet, const LamBoundary *boundary,
                                      PetscReal factor, const PetscScalar ue[6], Mat tangent)
{
  PetscReal X[6], sense, T[4];
  PetscScalar Ke[36] = {0};

  PetscFunctionBeginUser;
  PetscCall(LamMacroFacetNodes(macro, facet, X, &sense));
  FollowerMatrix(boundary, factor, T);
  for (PetscInt a = 0; a < 6; a++) X[a] += PetscRealPart(ue[a]);
  for (PetscInt q = 0; q < LAM_FACET_POINTS; q++) {
    PetscReal N[3], dN[3], weight, tau[2] = {0, 0};
    LamMacroFacetShape(q, N, dN, &weight);
    for (PetscInt a = 0; a < 6; a++) tau[a % 2] += dN[a / 2] * X[a];
    for (PetscInt row = 0; row < 6; row++) {
      const PetscReal *t = &T[2 * (row % 2)], share = sense * weight * N[row / 2], around = LamMacroAround(macro, N, X);
      for (PetscInt column = 0; column < 6; column++)
        Ke[6 * row + column] -= share * around * dN[column / 2] * t[column % 2];
      for (PetscInt b = 0; b < 3 && macro->axisymmetric; b++) /* by the radius */
        Ke[6 * row + 2 * b] -= share * 2 * PETSC_PI * N[b] * (t[0] * tau[0] + t[1] * tau[1]);
    }
  }
  PetscCall(DMPlexMatSetClosure(macro->dm, NULL, NULL, tangent, facet->point, Ke, ADD_VALUES));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroAddTractionTangent(LamMacro macro, Vec u, Mat tangent)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  PetscBool any = PETSC_FALSE;
  Vec displacement;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(macro->dm, &displacement));
  PetscCall(DMGlobalToLocal(macro->dm, u, INSERT_VALUES, displacement));
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    const PetscInt set = LamMacroFindSet(macro, boundary->on);
    const PetscReal factor = Factor(macro, boundary) * LamMacroTractionFactor(macro);
    if (!boundary->follower || !IsTraction(boundary)) continue;
    any = PETSC_TRUE;
    for (PetscInt f = 0; f < macro->facet_count; f++) {
      const LamMacroFacet *facet = &macro->facets[f];
      PetscScalar *ue = NULL;
      if (!(facet->sets >> set & 1)) continue;
      PetscCall(DMPlexVecGetClosure(macro->dm, NULL, displacement, facet->point, NULL, &ue));
      PetscCall(AddFacetTangent(macro, facet, boundary, factor, ue, tangent));
      PetscCall(DMPlexVecRestoreClosure(macro->dm, NULL, displacement, facet->point, NULL, &ue));
    }
  }
  PetscCall(DMRestoreLocalVector(macro->dm, &displacement));
  if (!any) PetscFunctionReturn(0);
  PetscCall(MatAssemblyBegin(tangent, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(tangent, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroTractionSum(LamMacro macro, PetscInt entry, Vec u, PetscReal sum[2])
{
  const LamBoundary *boundary = &macro->scene->macro.boundary[entry];
  const PetscReal factor = Factor(macro, boundary) * LamMacroTractionFactor(macro);
  Vec displacement;

  PetscFunctionBeginUser;
  sum[0] = sum[1] = 0;
  if (!IsTraction(boundary)) PetscFunctionReturn(0);
  PetscCall(DMGetLocalVector(macro->dm, &displacement));
  PetscCall(DMGlobalToLocal(macro->dm, u, INSERT_VALUES, displacement));
  PetscCall(AddForces(macro, boundary, factor, displacement, NULL, sum));
  PetscCall(DMRestoreLocalVector(macro->dm, &displacement));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, macro->comm));
  PetscFunctionReturn(0);
}
