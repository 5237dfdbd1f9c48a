/*
  Sealed lumens of the macroscale body: mixed elements with condensed pressures.

  Method. If the water in the lumens of a material point is constant, its pressure p = p0 + q follows from

    Pi(u, q) = int [ Psi(F(u), p0 + q) + v q - v q^2 / (2 K_w) ] dV    stationary in u and q,

  with v = -dPsi/dp when the point was sealed, at turgor p0: by the equation of q the lumen is v (1 - q / K_w) in the
  mean. The responder is always queried at a given pressure, so databases and caches need no change, and K_w amplifies
  no query. q is linear in each element, q = sum_a psi_a q_a with psi = 1 and (X - X_c) / h about the element's
  centre, in reference coordinates, and belongs to that element alone (Q2/P1; triangles with a bubble). With

    R_a    = int psi_a [ dPsi/dp + v (1 - q / K_w) ]     f_ai    = int P_ij dN_a/dX_j
    K_ab   = int psi_a psi_b [ d2Psi/dp2 - v / K_w ]     C_a,bi  = int psi_a dP_ij/dp dN_b/dX_j

  and in an axisymmetric body the terms of F33 in f and C (assembly.c).

  Lumens that exchange water with their surroundings (body.h) have volume w(p0 + q) instead of v (1 - q / K_w); the
  slope w' then replaces -v / K_w.

  Newton's method for u and q together has the condensed residual f - C^T K^-1 R and tangent A - C^T K^-1 C, and
  updates the pressures by their own linearised equation,  dq = -K^-1 (R + C du), so K_w multiplies no error of the
  lumen.

  References: Brezzi & Fortin, Mixed and Hybrid Finite Element Methods, VI.4 (Q2/P1, P2 with a bubble/P1); Magisano,
  Leonetti & Garcea, CMAME 313 (2017) 1004-1025 (independent stresses).
*/
#include "transport_impl.h"

#include <petscblaslapack.h> /* requires that PETSc's own headers come first */

/* ---- creation ---- */

PetscBool LamMacroHasPressures(LamMacro macro)
{
  return macro->scene->sealed || macro->water_law ? PETSC_TRUE : PETSC_FALSE;
}

/* psi of an element's points; h is the root of its area (of the volume of an axisymmetric one: psi may be scaled). */
static void FillShape(LamMacro macro, const LamMacroElement *element)
{
  const PetscInt dim = macro->dim;
  PetscReal centre[LAM_MACRO_DIM] = {0}, volume = 0;

  for (PetscInt q = 0; q < element->kind->points; q++) {
    const PetscInt point = element->first + q;
    volume += macro->weight[point];
    for (PetscInt i = 0; i < dim; i++) centre[i] += macro->weight[point] * macro->place[dim * point + i];
  }
  for (PetscInt q = 0; q < element->kind->points; q++) {
    const PetscInt point = element->first + q;
    PetscReal *shape = &macro->seal->shape[macro->seal->modes * point];
    shape[0] = 1;
    for (PetscInt i = 0; i < dim; i++)
      shape[1 + i] = (macro->place[dim * point + i] - centre[i] / volume) / PetscPowReal(volume, 1.0 / dim);
  }
}

PetscErrorCode LamMacroSealCreate(LamMacro macro)
{
  LamMacroSeal *seal;
  PetscInt changes;

  PetscFunctionBeginUser;
  if (!LamMacroHasPressures(macro)) PetscFunctionReturn(0);
  PetscCall(PetscNew(&seal));
  macro->seal = seal;
  seal->modes = 1 + macro->dim;
  changes = macro->element_count * seal->modes;
  PetscCall(PetscCalloc6(macro->point_count * seal->modes, &seal->shape, macro->point_count, &seal->water, changes,
                         &seal->change, changes, &seal->last_change, macro->point_count, &seal->now, macro->point_count,
                         &seal->accepted));
  PetscCall(VecDuplicate(macro->u, &seal->u));
  for (PetscInt e = 0; e < macro->element_count; e++) FillShape(macro, &macro->elements[e]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSealDestroy(LamMacro macro)
{
  LamMacroSeal *seal = macro->seal;

  PetscFunctionBeginUser;
  if (!seal) PetscFunctionReturn(0);
  PetscCall(PetscFree6(seal->shape, seal->water, seal->change, seal->last_change, seal->now, seal->accepted));
  PetscCall(VecDestroy(&seal->u));
  PetscCall(PetscFree(macro->seal));
  PetscFunctionReturn(0);
}

/* ---- the element ---- */

PetscReal LamMacroTurgorChange(LamMacro macro, const LamMacroElement *element, PetscInt point)
{
  const LamMacroSeal *seal = macro->seal;
  PetscReal change = 0;

  if (!seal) return 0;
  for (PetscInt a = 0; a < seal->modes; a++)
    change += seal->shape[seal->modes * point + a] * seal->change[seal->modes * (element - macro->elements) + a];
  return change;
}

void LamMacroFindWater(LamMacro macro, PetscInt point, LamWater *water)
{
  const PetscReal sealed = macro->seal->water[point];
  const PetscReal change = LamMacroTurgorChange(macro, &macro->elements[macro->point_element[point]], point);

  if (macro->water_law) {
    macro->water_law(macro->water_ctx, point, macro->turgor * macro->turgor_share[point] + change,
                     macro->flow ? &macro->flow->at[macro->flow->spec.count * point] : NULL, water);
    return;
  }
  water->water = sealed * (1 - change / macro->scene->water_bulk_modulus);
  water->slope = -sealed / macro->scene->water_bulk_modulus;
}

PetscReal LamMacroWaterSlope(LamMacro macro, PetscInt point)
{
  LamWater water;

  LamMacroFindWater(macro, point, &water);
  return water.slope;
}

/* R [modes] of the last evaluation. */
static void AddResidual(LamMacro macro, const LamMacroElement *element, PetscReal R[])
{
  const LamMacroSeal *seal = macro->seal;

  for (PetscInt point = element->first; point < element->first + element->kind->points; point++) {
    LamWater wanted;
    LamMacroFindWater(macro, point, &wanted);
    for (PetscInt a = 0; a < seal->modes; a++)
      R[a] += macro->weight[point] * seal->shape[seal->modes * point + a] * (wanted.water - seal->now[point].lumen);
  }
}

/* Adds the contribution of Gauss point q to C [dofs][modes] and K [modes][modes]. */
static void AddPoint(LamMacro macro, const LamMacroElement *element, PetscInt q, PetscReal C[], PetscReal K[])
{
  const LamMacroSeal *seal = macro->seal;
  const PetscInt dim = macro->dim, modes = seal->modes, point = element->first + q;
  const PetscReal *dN = LamMacroGradient(macro, element, q), *hoop = LamMacroHoop(macro, element, q),
                  *shape = &seal->shape[modes * point], w = macro->weight[point];
  const LamSealedPoint *response = &seal->now[point];
  LamWater water;

  LamMacroFindWater(macro, point, &water);
  const PetscReal curvature = response->curvature + water.slope;
  for (PetscInt b = 0; b < element->kind->nodes; b++) {
    for (PetscInt i = 0; i < dim; i++) {
      PetscReal force = 0; /* from the pressure */
      for (PetscInt j = 0; j < dim; j++) force += w * response->P_turgor[dim * i + j] * dN[dim * b + j];
      if (hoop && i == 0) force += w * response->P_turgor[macro->strains - 1] * hoop[b];
      for (PetscInt a = 0; a < modes; a++) C[(dim * b + i) * modes + a] += shape[a] * force;
    }
  }
  for (PetscInt a = 0; a < modes; a++) {
    for (PetscInt b = 0; b < modes; b++) K[a * modes + b] += w * curvature * shape[a] * shape[b];
  }
}

PetscErrorCode LamMacroCondensationCreate(LamMacro macro, const LamMacroElement *element, LamCondensation *c)
{
  PetscBLASInt n, columns, info;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(c, sizeof(*c)));
  c->modes = macro->seal->modes;
  c->dofs = element->kind->nodes * macro->dim;
  for (PetscInt q = 0; q < element->kind->points; q++) AddPoint(macro, element, q, c->coupling, c->K);
  AddResidual(macro, element, &c->coupling[c->dofs * c->modes]);
  PetscCall(PetscArraycpy(c->solved, c->coupling, (c->dofs + 1) * c->modes));
  PetscCall(PetscBLASIntCast(c->modes, &n));
  PetscCall(PetscBLASIntCast(c->dofs + 1, &columns));
  PetscCallBLAS("LAPACKgesv", LAPACKgesv_(&n, &columns, c->K, &n, c->pivots, c->solved, &n, &info));
  PetscCheck(info == 0, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "the compliance of the water in element %d is singular (LAPACK gesv: %d)", (int)element->number,
             (int)info);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroCondensationSolve(LamCondensation *c, PetscInt columns, PetscReal x[])
{
  PetscBLASInt n = (PetscBLASInt)c->modes, count = (PetscBLASInt)columns, info;

  PetscFunctionBeginUser;
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("N", &n, &count, c->K, &n, c->pivots, x, &n, &info));
  PetscFunctionReturn(0);
}

static PetscReal Dot(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;

  for (PetscInt k = 0; k < n; k++) sum += a[k] * b[k];
  return sum;
}

PetscErrorCode LamMacroCondense(LamMacro macro, const LamMacroElement *element, PetscScalar fe[], PetscScalar Ke[])
{
  LamCondensation c;

  PetscFunctionBeginUser;
  if (!macro->seal || !macro->seal->closed) PetscFunctionReturn(0);
  PetscCall(LamMacroCondensationCreate(macro, element, &c));
  for (PetscInt k = 0; k < c.dofs; k++) {
    const PetscReal *column = &c.coupling[k * c.modes];
    if (fe) fe[k] -= Dot(c.modes, column, &c.solved[c.dofs * c.modes]);
    for (PetscInt l = 0; l < c.dofs && Ke; l++) Ke[k * c.dofs + l] -= Dot(c.modes, column, &c.solved[l * c.modes]);
  }
  PetscFunctionReturn(0);
}

/* ---- states ---- */

PetscErrorCode LamMacroMovePressures(LamMacro macro, Vec u)
{
  LamMacroSeal *seal = macro->seal;
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(VecAYPX(seal->u, -1, u)); /* the step */
  PetscCall(LamMacroFlowFollow(macro, seal->u));
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(DMGlobalToLocal(macro->dm, seal->u, INSERT_VALUES, local));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    PetscScalar *step = NULL;
    PetscReal moved[LAM_MACRO_MODES] = {0}; /* by the potentials */
    LamCondensation c;
    PetscCall(LamMacroCondensationCreate(macro, &macro->elements[e], &c));
    if (macro->flow) {
      PetscCall(LamMacroFlowLumens(macro, e, moved));
      PetscCall(LamMacroCondensationSolve(&c, 1, moved));
    }
    PetscCall(DMPlexVecGetClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &step));
    for (PetscInt a = 0; a < c.modes; a++) {
      PetscReal *change = &seal->change[c.modes * e + a];
      *change -= c.solved[c.dofs * c.modes + a] + moved[a];
      for (PetscInt k = 0; k < c.dofs; k++) *change -= c.solved[k * c.modes + a] * PetscRealPart(step[k]);
    }
    PetscCall(DMPlexVecRestoreClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &step));
  }
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscCall(LamMacroFlowMove(macro));
  PetscCall(VecCopy(u, seal->u));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFollow(LamMacro macro, Vec u)
{
  PetscBool there;

  PetscFunctionBeginUser;
  if (!macro->seal || !macro->seal->closed) PetscFunctionReturn(0);
  PetscCall(VecEqual(u, macro->seal->u, &there));
  if (!there) PetscCall(LamMacroMovePressures(macro, u));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroKeepSealed(LamMacro macro, PetscInt point)
{
  LamResponse *response = &macro->responses[point];
  PetscReal sum = response->energy_turgor2;

  PetscFunctionBeginUser;
  if (!macro->seal || !LamResponseHasFields(response)) PetscFunctionReturn(0);
  LamSealedPoint *sealed = &macro->seal->now[point];
  for (PetscInt ij = 0; ij < macro->strains; ij++) {
    sealed->P_turgor[ij] = response->P_turgor[LamMacroEntry(macro, ij)];
    sum += sealed->P_turgor[ij];
  }
  sealed->lumen = -response->energy_turgor;
  sealed->curvature = LamResponseConcavity(response);
  if (!PetscIsInfOrNanReal(sum + sealed->lumen)) PetscFunctionReturn(0);
  response->status = LAM_OUT_OF_REACH;
  PetscCall(PetscStrncpy(response->reason,
                         "the response has no derivatives by the turgor, which sealed "
                         "cells need",
                         sizeof(response->reason)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSealedResidual(LamMacro macro, PetscReal *residual)
{
  const LamMacroSeal *seal = macro->seal;
  PetscReal sum[2] = {0}; /* squares of R, and of the water */

  PetscFunctionBeginUser;
  *residual = 0;
  if (!seal || !seal->closed) PetscFunctionReturn(0);
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscReal R[LAM_MACRO_MODES] = {0};
    AddResidual(macro, element, R);
    sum[0] += Dot(seal->modes, R, R);
    sum[1] += PetscSqr(Dot(element->kind->points, &seal->water[element->first], &macro->weight[element->first]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, macro->comm));
  *residual = PetscSqrtReal(sum[0] / sum[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroAcceptPressures(LamMacro macro)
{
  LamMacroSeal *seal = macro->seal;

  PetscFunctionBeginUser;
  if (!seal) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(seal->last_change, seal->change, seal->modes * macro->element_count));
  PetscCall(PetscArraycpy(seal->accepted, seal->now, macro->point_count));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroRejectPressures(LamMacro macro)
{
  LamMacroSeal *seal = macro->seal;

  PetscFunctionBeginUser;
  if (!seal) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(seal->change, seal->last_change, seal->modes * macro->element_count));
  PetscCall(PetscArraycpy(seal->now, seal->accepted, macro->point_count));
  PetscCall(VecCopy(macro->u, seal->u));
  PetscCall(LamMacroFlowReject(macro));
  PetscFunctionReturn(0);
}

/* Makes F = 1 under the full turgor the last converged state, whether or not the body is in equilibrium there. */
static PetscErrorCode StartUndeformed(LamMacro macro, PetscBool *ok)
{
  PetscReal scale;

  PetscFunctionBeginUser;
  macro->turgor = 1;
  PetscCall(LamMacroEvaluate(macro, macro->u, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamMacroAssembleForce(macro, macro->force_accepted, &scale));
  PetscCall(PetscArraycpy(macro->accepted, macro->now, macro->point_count));
  PetscCall(LamResponderAccept(macro->responder));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSealLumens(LamMacro macro, PetscBool *ok)
{
  LamMacroSeal *seal = macro->seal;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  if (!seal) PetscFunctionReturn(0);
  if (!macro->scene->macro.inflate && !macro->water_law) PetscCall(StartUndeformed(macro, ok));
  if (!*ok) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < macro->point_count; p++) seal->water[p] = seal->now[p].lumen;
  PetscCall(VecCopy(macro->u, seal->u));
  PetscCall(LamMacroAcceptPressures(macro));
  seal->closed = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroArchiveSeal(LamMacro macro, LamArchive archive, const PetscInt points[])
{
  LamMacroSeal *seal = macro->seal;
  PetscInt *elements;

  PetscFunctionBeginUser;
  if (!seal) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(macro->element_count, &elements));
  for (PetscInt e = 0; e < macro->element_count; e++) elements[e] = macro->elements[e].number;
  PetscCall(LamArchiveShared(archive, "sealed", sizeof(seal->closed), &seal->closed));
  PetscCall(LamArchiveItems(archive, "water", sizeof(PetscReal), macro->point_count, points, seal->water));
  PetscCall(
      LamArchiveItems(archive, "sealed points", sizeof(LamSealedPoint), macro->point_count, points, seal->accepted));
  PetscCall(LamArchiveItems(archive, "turgor changes", (size_t)seal->modes * sizeof(PetscReal), macro->element_count,
                            elements, seal->last_change));
  PetscCall(PetscFree(elements));
  if (LamArchiveIsReading(archive)) PetscCall(LamMacroRejectPressures(macro));
  PetscFunctionReturn(0);
}
