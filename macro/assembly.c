/*
  Finite element assembly with the responses of a responder.

  Method. Total Lagrangian, quadratic elements (element.c): F = 1 + sum_a u_a (x) dN_a/dX at all points of the rank in
  one batch, then from the stored P and A f_ai = sum_q w P_ij dN_a/dX_j, K_ai,bk = sum_q w dN_a/dX_j A_ijkl dN_b/dX_l.
  An axisymmetric body has F33 = 1 + sum_a u_a1 N_a/R besides, R = X1, and weights w of 2 pi R times the area:
    f_a1 += w P33 N_a/R,  K_ai,bk += w dF_ij/du_ai (A_ij33 N_b/R delta_k1) + the transposed + w N_a/R A_3333 N_b/R.
  If lumens are sealed, their pressures are condensed out of both, element by element (sealed.c).

  Reference: Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., ch. 9.
*/
#include <math.h>
#include <time.h>
#include "macro_impl.h"

static const PetscReal LARGEST_CHANGE = 0.75; /* largest change of a deformation gradient in one step, Frobenius norm */

/* The load of a material point, at displacements ue[nodes][dim] of its element. */
static LamLoad PointLoad(LamMacro macro, const LamMacroElement *element, PetscInt q, const PetscScalar ue[])
{
  const PetscInt dim = macro->dim, point = element->first + q;
  const PetscReal *dN = LamMacroGradient(macro, element, q), *hoop = LamMacroHoop(macro, element, q);
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                  .turgor = macro->turgor * macro->turgor_share[point],
                  .cohesion = macro->lamella * macro->cohesion[point],
                  .duration = macro->duration};

  load.turgor += LamMacroTurgorChange(macro, element, point);
  for (PetscInt a = 0; a < element->kind->nodes; a++) {
    for (PetscInt i = 0; i < dim; i++) {
      for (PetscInt j = 0; j < dim; j++) load.F[3 * i + j] += PetscRealPart(ue[dim * a + i]) * dN[dim * a + j];
    }
  }
  for (PetscInt a = 0; a < element->kind->nodes && hoop; a++) load.F[8] += PetscRealPart(ue[dim * a]) * hoop[a];
  return load;
}

/* Deformation gradients and turgor of all material points, into macro->loads. */
static PetscErrorCode GatherLoads(LamMacro macro, Vec u)
{
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(DMGlobalToLocal(macro->dm, u, INSERT_VALUES, local));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscScalar *ue = NULL;
    PetscCall(DMPlexVecGetClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &ue));
    for (PetscInt q = 0; q < element->kind->points; q++)
      macro->loads[element->first + q] = PointLoad(macro, element, q, ue);
    PetscCall(DMPlexVecRestoreClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &ue));
  }
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscFunctionReturn(0);
}

/* True on all ranks if every point's stored response is that of its present load. */
static PetscErrorCode AllKnown(LamMacro macro, PetscBool *known)
{
  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  for (PetscInt p = 0; p < macro->point_count && *known; p++)
    *known = (PetscBool)(macro->now[p].known && macro->now[p].walls == macro->walls &&
                         !memcmp(&macro->now[p].load, &macro->loads[p], sizeof(LamLoad)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, known, 1, MPIU_BOOL, MPI_LAND, macro->comm));
  PetscFunctionReturn(0);
}

static void KeepResponse(LamMacro macro, const LamLoad *load, const LamResponse *response, LamMaterialPoint *point)
{
  const PetscInt n = macro->strains;

  point->known = LamResponseHasFields(response);
  point->load = *load;
  memcpy(point->P, response->P, sizeof(point->P));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt k = 0; k < n; k++)
      point->A[n * i + k] = response->tangent[9 * LamMacroEntry(macro, i) + LamMacroEntry(macro, k)];
  }
  point->tangent_error = isfinite(response->tangent_error_estimate) ? response->tangent_error_estimate : 0;
  LamMacroKeepFields(response, point->field);
  point->percolating = response->percolating_directions;
}

/* Describes the point without response: among all ranks, the one in the element of the lowest number. */
static PetscErrorCode DescribeTrouble(LamMacro macro, PetscInt64 failed, PetscInt point)
{
  const LamMacroElement *element = point < 0 ? NULL : &macro->elements[macro->point_element[point]];
  PetscMPIInt rank = 0;
  PetscBool mine = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(LamMacroFindRank(macro, element ? (double)element->number : INFINITY, &rank, &mine));
  if (mine && element) {
    const LamResponse *response = &macro->responses[point];
    const PetscReal *F = macro->loads[point].F, *X = &macro->place[macro->dim * point];
    const PetscReal mm = macro->scene->scales.macro_length * 1e3;
    char hoop[32] = "";
    if (macro->axisymmetric) PetscCall(PetscSNPrintf(hoop, sizeof(hoop), ", F33 = %.5g", (double)F[8]));
    PetscCall(PetscSNPrintf(macro->trouble, sizeof(macro->trouble),
                            "%s: %s; %" PetscInt64_FMT " points without response, the first in element %d, point "
                            "%" PetscInt_FMT " at (%.4g, %.4g) mm: F = [%.5g %.5g %.5g %.5g]%s, turgor %.4g MPa",
                            LamStatusNames[response->status], response->reason, failed, (int)element->number,
                            point - element->first, (double)(X[0] * mm), (double)(X[1] * mm), (double)F[0],
                            (double)F[1], (double)F[3], (double)F[4], hoop,
                            (double)(macro->loads[point].turgor * macro->scene->scales.stress * 1e-6)));
  }
  PetscCallMPI(MPI_Bcast(macro->trouble, sizeof(macro->trouble), MPI_CHAR, rank, macro->comm));
  PetscFunctionReturn(0);
}

/* Whether a stop was requested on any rank: a signal may reach only one of them. While this rank waits for the others
   it calls macro->stop(), through which they may learn of a request. */
static PetscErrorCode CheckStop(LamMacro macro)
{
  const struct timespec pause = {0, 200000};
  MPI_Request request;
  int done = 0;

  PetscFunctionBeginUser;
  if (!macro->stop) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Ibarrier(macro->comm, &request));
  for (;;) {
    PetscCallMPI(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
    if (done) break;
    (void)macro->stop();
    nanosleep(&pause, NULL);
  }
  macro->stopped = macro->stop();
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &macro->stopped, 1, MPIU_BOOL, MPI_LOR, macro->comm));
  PetscFunctionReturn(0);
}

/*
  A diverging iteration queries states that are expensive to solve or to look up, and useless. *ok: whether no point
  has changed by more than LARGEST_CHANGE since the last converged state.
*/
static PetscErrorCode CheckChange(LamMacro macro, PetscBool *ok)
{
  const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal largest = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < macro->point_count; p++) {
    const PetscReal *F = macro->loads[p].F, *from = macro->accepted[p].known ? macro->accepted[p].load.F : identity;
    PetscReal square = 0;
    for (int k = 0; k < 9; k++) square += PetscSqr(F[k] - from[k]);
    largest = PetscMax(largest, PetscSqrtReal(square));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPIU_MAX, macro->comm));
  *ok = largest <= LARGEST_CHANGE ? PETSC_TRUE : PETSC_FALSE;
  if (!*ok)
    PetscCall(PetscSNPrintf(macro->trouble, sizeof(macro->trouble),
                            "an iteration changes the deformation gradient of a point by %.2g, %.2g is allowed",
                            (double)largest, (double)LARGEST_CHANGE));
  PetscFunctionReturn(0);
}

/* Queries the responder. Tissue whose moduli are all s times those of the responder's has the energy s Psi(F, p / s, g
   / s). */
static PetscErrorCode QueryResponder(LamMacro macro)
{
  LamResponder responder = macro->responder;
  const PetscInt n = macro->point_count;
  LamLoad *own;

  PetscFunctionBeginUser;
  if (macro->walls == 1) {
    PetscCall(LamResponderRespond(responder, n, macro->loads, macro->point_index, macro->responses));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(n, &own));
  PetscCall(PetscArraycpy(own, macro->loads, n));
  for (PetscInt p = 0; p < n; p++) {
    own[p].turgor /= macro->walls;
    own[p].cohesion /= macro->walls;
  }
  PetscCall(LamResponderRespond(responder, n, own, macro->point_index, macro->responses));
  PetscCall(PetscFree(own));
  for (PetscInt p = 0; p < n; p++) {
    LamResponseScale(macro->walls, &macro->responses[p]);
    macro->responses[p].load = macro->loads[p];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroEvaluate(LamMacro macro, Vec u, PetscBool *ok)
{
  PetscInt64 failed = 0;
  PetscInt first = -1;
  PetscBool known;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  PetscCall(LamMacroFollow(macro, u));
  PetscCall(GatherLoads(macro, u));
  PetscCall(AllKnown(macro, &known));
  if (known) PetscFunctionReturn(0);
  PetscCall(CheckChange(macro, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(QueryResponder(macro));
  PetscCall(CheckStop(macro));
  for (PetscInt p = 0; p < macro->point_count; p++) {
    PetscCall(LamMacroKeepSealed(macro, p));
    KeepResponse(macro, &macro->loads[p], &macro->responses[p], &macro->now[p]);
    macro->now[p].walls = macro->walls;
    if (macro->now[p].known) continue;
    /* elements are not sorted by number on a rank: report the lowest */
    if (first < 0 ||
        macro->elements[macro->point_element[p]].number < macro->elements[macro->point_element[first]].number)
      first = p;
    failed++;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPIU_INT64, MPI_SUM, macro->comm));
  if (failed) PetscCall(DescribeTrouble(macro, failed, first));
  *ok = failed || macro->stopped ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Adds the forces of Gauss point q under the stress P to those of its element, fe [nodes][dim]. */
static void AddPointForce(LamMacro macro, const LamMacroElement *element, PetscInt q, const PetscReal P[9],
                          PetscScalar fe[])
{
  const PetscInt dim = macro->dim;
  const PetscReal *dN = LamMacroGradient(macro, element, q), *hoop = LamMacroHoop(macro, element, q),
                  w = macro->weight[element->first + q];

  for (PetscInt a = 0; a < element->kind->nodes; a++) {
    for (PetscInt i = 0; i < dim; i++) {
      for (PetscInt j = 0; j < dim; j++) fe[dim * a + i] += w * P[3 * i + j] * dN[dim * a + j];
    }
  }
  for (PetscInt a = 0; a < element->kind->nodes && hoop; a++) fe[dim * a] += w * P[8] * hoop[a];
}

PetscErrorCode LamMacroAssembleForce(LamMacro macro, Vec force, PetscReal *scale)
{
  PetscReal sum = 0;
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(VecZeroEntries(local));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscScalar fe[LAM_MACRO_DOFS] = {0};
    for (PetscInt q = 0; q < element->kind->points; q++)
      AddPointForce(macro, element, q, macro->now[element->first + q].P, fe);
    PetscCall(LamMacroCondense(macro, element, fe, NULL));
    for (PetscInt k = 0; k < element->kind->nodes * macro->dim; k++) sum += PetscRealPart(fe[k] * fe[k]);
    PetscCall(DMPlexVecSetClosure(macro->dm, NULL, local, macro->mesh_start + e, fe, ADD_VALUES));
  }
  PetscCall(VecZeroEntries(force));
  PetscCall(DMLocalToGlobal(macro->dm, local, ADD_VALUES, force));
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPIU_SUM, macro->comm));
  *scale = PetscSqrtReal(sum);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroForceFloor(LamMacro macro, PetscReal *scale)
{
  const PetscReal stress = LamStressScaleOf(&macro->scene->micro).plane,
                  P[9] = {stress, 0, 0, 0, stress, 0, 0, 0, stress};
  PetscReal sum = 0;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    const PetscInt dofs = element->kind->nodes * macro->dim;
    PetscReal fe[LAM_MACRO_DOFS] = {0};
    for (PetscInt q = 0; q < element->kind->points; q++) AddPointForce(macro, element, q, P, fe);
    for (PetscInt k = 0; k < dofs; k++) sum += fe[k] * fe[k];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPIU_SUM, macro->comm));
  *scale = PetscSqrtReal(sum);
  PetscFunctionReturn(0);
}

/* Adds w dN_a/dX_j A_ijkl dN_b/dX_l of Gauss point q to the element tangent, Ke [nodes dim][nodes dim]. */
static void AddPointTangent(LamMacro macro, const LamMacroElement *element, PetscInt q, PetscScalar Ke[])
{
  const PetscInt dim = macro->dim, nodes = element->kind->nodes, dofs = nodes * dim, point = element->first + q;
  const PetscInt n = macro->strains;
  const PetscReal *dN = LamMacroGradient(macro, element, q), *hoop = LamMacroHoop(macro, element, q),
                  *A = macro->now[point].A, w = macro->weight[point];

  for (PetscInt b = 0; b < nodes; b++) {
    for (PetscInt k = 0; k < dim; k++) {
      PetscReal S[LAM_MACRO_STRAINS] = {0}; /* w A_ijkl dN_b/dX_l */
      for (PetscInt ij = 0; ij < n; ij++) {
        for (PetscInt l = 0; l < dim; l++) S[ij] += w * A[n * ij + dim * k + l] * dN[dim * b + l];
        if (hoop && k == 0) S[ij] += w * A[n * ij + n - 1] * hoop[b];
      }
      for (PetscInt a = 0; a < nodes; a++) {
        for (PetscInt i = 0; i < dim; i++) {
          for (PetscInt j = 0; j < dim; j++) Ke[(dim * a + i) * dofs + dim * b + k] += S[dim * i + j] * dN[dim * a + j];
        }
        if (hoop) Ke[dim * a * dofs + dim * b + k] += S[n - 1] * hoop[a];
      }
    }
  }
}

PetscErrorCode LamMacroAssembleTangent(LamMacro macro, Mat tangent)
{

  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(tangent));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscScalar Ke[LAM_MACRO_DOFS * LAM_MACRO_DOFS];
    PetscCall(PetscArrayzero(Ke, PetscSqr(element->kind->nodes * macro->dim)));
    for (PetscInt q = 0; q < element->kind->points; q++) AddPointTangent(macro, element, q, Ke);
    PetscCall(LamMacroCondense(macro, element, NULL, Ke));
    PetscCall(DMPlexMatSetClosure(macro->dm, NULL, NULL, tangent, macro->mesh_start + e, Ke, ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(tangent, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(tangent, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}
