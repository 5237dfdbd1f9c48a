/*
  Finite element assembly with the responses of a responder.

  Method. Total Lagrangian, plane strain, nine-node quadrilaterals with 3 x 3 Gauss points: F = 1 + sum_a u_a (x)
  dN_a/dX at every point of the rank in one batch, then from the stored P and A f_ai = sum_q w P_ij dN_a/dX_j, K_ai,bk =
  sum_q w dN_a/dX_j A_ijkl dN_b/dX_l.

  Reference: Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., ch. 9.
*/
#include <time.h>
#include "macro_impl.h"

static const PetscReal LARGEST_CHANGE = 0.75; /* of a deformation gradient in one step, Frobenius norm */

/* Deformation gradients and turgor of all material points, into macro->loads. */
static PetscErrorCode GatherLoads(LamMacro macro, Vec u)
{
  PetscSection section;
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalSection(macro->dm, &section));
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(DMGlobalToLocal(macro->dm, u, INSERT_VALUES, local));
  for (PetscInt cell = macro->cell_start; cell < macro->cell_end; cell++) {
    PetscScalar *ue = NULL;
    PetscCall(DMPlexVecGetClosure(macro->dm, section, local, cell, NULL, &ue));
    for (PetscInt q = 0; q < LAM_MACRO_POINTS; q++) {
      PetscInt point = (cell - macro->cell_start) * LAM_MACRO_POINTS + q;
      const PetscReal *dN = &macro->gradient[point * LAM_MACRO_DOFS];
      LamLoad *load = &macro->loads[point];
      *load = (LamLoad){{1, 0, 0, 0, 1, 0, 0, 0, 1}, macro->turgor, macro->scene->cohesion};
      for (PetscInt a = 0; a < LAM_MACRO_NODES; a++) {
        for (PetscInt ij = 0; ij < 4; ij++)
          load->F[3 * (ij / 2) + ij % 2] += PetscRealPart(ue[2 * a + ij / 2]) * dN[2 * a + ij % 2];
      }
    }
    PetscCall(DMPlexVecRestoreClosure(macro->dm, section, local, cell, NULL, &ue));
  }
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscFunctionReturn(0);
}

static PetscBool SameLoad(const LamLoad *a, const LamLoad *b)
{
  for (int k = 0; k < 9; k++) {
    if (a->F[k] != b->F[k]) return PETSC_FALSE;
  }
  return a->turgor == b->turgor && a->cohesion == b->cohesion ? PETSC_TRUE : PETSC_FALSE;
}

/* True on all ranks where every point's stored response belongs to its present load. */
static PetscErrorCode AllKnown(LamMacro macro, PetscBool *known)
{
  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  for (PetscInt p = 0; p < macro->point_count && *known; p++)
    *known = macro->now[p].known && SameLoad(&macro->now[p].load, &macro->loads[p]) ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, known, 1, MPIU_BOOL, MPI_LAND, macro->comm));
  PetscFunctionReturn(0);
}

static void KeepResponse(const LamLoad *load, const LamResponse *response, LamMaterialPoint *point)
{
  point->known = LamResponseHasFields(response);
  point->load = *load;
  memcpy(point->P, response->P, sizeof(point->P));
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) point->A[i][j][k][l] = response->tangent[9 * (3 * i + j) + 3 * k + l];
  point->lumen_fraction = response->lumen_fraction;
  point->opening_fraction = response->opening_fraction;
  point->debonded_fraction = response->debonded_fraction;
  point->max_gap = response->max_gap;
}

/* Writes which point has no response: of all ranks, the one in the element of the lowest number. */
static PetscErrorCode DescribeTrouble(LamMacro macro, PetscInt64 failed, PetscInt point)
{
  struct {
    int element, rank;
  } mine, first;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(macro->comm, &rank));
  mine.rank = rank;
  mine.element = point < 0 ? PETSC_MPI_INT_MAX
                           : (int)macro->number[macro->cell_start - macro->mesh_start + point / LAM_MACRO_POINTS];
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_2INT, MPI_MINLOC, macro->comm));
  if (rank == first.rank && point >= 0) {
    const LamResponse *response = &macro->responses[point];
    const PetscReal *F = macro->loads[point].F;
    PetscCall(PetscSNPrintf(macro->trouble, sizeof(macro->trouble),
                            "%s: %s; %" PetscInt64_FMT " points without response, the first in element %d, point "
                            "%" PetscInt_FMT ": F = [%.5g %.5g %.5g %.5g], turgor %.4g MPa",
                            LamStatusNames[response->status], response->reason, failed, mine.element,
                            point % LAM_MACRO_POINTS, (double)F[0], (double)F[1], (double)F[3], (double)F[4],
                            (double)(macro->loads[point].turgor * macro->scene->scales.stress * 1e-6)));
  }
  PetscCallMPI(MPI_Bcast(macro->trouble, sizeof(macro->trouble), MPI_CHAR, first.rank, macro->comm));
  PetscFunctionReturn(0);
}

/* Waits for the other ranks, which may learn of a request to stop from this one's asking. */
static PetscErrorCode AwaitOthers(LamMacro macro)
{
  const struct timespec pause = {0, 200000};
  MPI_Request request;
  int done = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Ibarrier(macro->comm, &request));
  for (;;) {
    PetscCallMPI(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
    if (done) break;
    (void)macro->stop();
    nanosleep(&pause, NULL);
  }
  PetscFunctionReturn(0);
}

/* Whether any rank was asked to stop: a signal may reach only one of them. */
static PetscErrorCode AskStop(LamMacro macro)
{
  PetscFunctionBeginUser;
  if (!macro->stop) PetscFunctionReturn(0);
  PetscCall(AwaitOthers(macro));
  macro->stopped = macro->stop();
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &macro->stopped, 1, MPIU_BOOL, MPI_LOR, macro->comm));
  PetscFunctionReturn(0);
}

/*
  An iteration that has gone astray asks for states that are dear to solve, or to look up, and of no use: *ok tells
  whether no point has changed by more than LARGEST_CHANGE since the last converged state.
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

PetscErrorCode LamMacroEvaluate(LamMacro macro, Vec u, PetscBool *ok)
{
  PetscInt64 failed = 0;
  PetscInt first = -1;
  PetscBool known;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  PetscCall(GatherLoads(macro, u));
  PetscCall(AllKnown(macro, &known));
  if (known) PetscFunctionReturn(0);
  PetscCall(CheckChange(macro, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(macro->responder->respond(macro->responder->ctx, macro->point_count, macro->loads, macro->point_index,
                                      macro->responses));
  PetscCall(AskStop(macro));
  for (PetscInt p = 0; p < macro->point_count; p++) {
    KeepResponse(&macro->loads[p], &macro->responses[p], &macro->now[p]);
    if (macro->now[p].known) continue;
    /* elements are not in the order of their numbers on a rank: name the lowest */
    const PetscInt *number = &macro->number[macro->cell_start - macro->mesh_start];
    if (first < 0 || number[p / LAM_MACRO_POINTS] < number[first / LAM_MACRO_POINTS]) first = p;
    failed++;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPIU_INT64, MPI_SUM, macro->comm));
  if (failed) PetscCall(DescribeTrouble(macro, failed, first));
  *ok = failed || macro->stopped ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroAssembleForce(LamMacro macro, Vec force, PetscReal *scale)
{
  PetscReal sum = 0;
  PetscSection section;
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalSection(macro->dm, &section));
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(VecZeroEntries(local));
  for (PetscInt cell = macro->cell_start; cell < macro->cell_end; cell++) {
    PetscScalar fe[LAM_MACRO_DOFS] = {0};
    for (PetscInt q = 0; q < LAM_MACRO_POINTS; q++) {
      PetscInt point = (cell - macro->cell_start) * LAM_MACRO_POINTS + q;
      const PetscReal *dN = &macro->gradient[point * LAM_MACRO_DOFS], *P = macro->now[point].P,
                      w = macro->weight[point];
      for (PetscInt a = 0; a < LAM_MACRO_NODES; a++) {
        for (PetscInt i = 0; i < 2; i++) fe[2 * a + i] += w * (P[3 * i] * dN[2 * a] + P[3 * i + 1] * dN[2 * a + 1]);
      }
    }
    for (PetscInt k = 0; k < LAM_MACRO_DOFS; k++) sum += PetscRealPart(fe[k] * fe[k]);
    PetscCall(DMPlexVecSetClosure(macro->dm, section, local, cell, fe, ADD_VALUES));
  }
  PetscCall(VecZeroEntries(force));
  PetscCall(DMLocalToGlobal(macro->dm, local, ADD_VALUES, force));
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPIU_SUM, macro->comm));
  *scale = PetscSqrtReal(sum);
  PetscFunctionReturn(0);
}

/* Adds w dN_a/dX_j A_ijkl dN_b/dX_l to the element tangent. */
static void AddPointTangent(const LamMaterialPoint *point, const PetscReal dN[LAM_MACRO_DOFS], PetscReal w,
                            PetscScalar Ke[LAM_MACRO_DOFS * LAM_MACRO_DOFS])
{
  for (int b = 0; b < LAM_MACRO_NODES; b++) {
    for (int k = 0; k < 2; k++) {
      PetscReal S[2][2]; /* w A_ijkl dN_b/dX_l */
      for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++)
          S[i][j] = w * (point->A[i][j][k][0] * dN[2 * b] + point->A[i][j][k][1] * dN[2 * b + 1]);
      }
      for (int a = 0; a < LAM_MACRO_NODES; a++) {
        for (int i = 0; i < 2; i++)
          Ke[(2 * a + i) * LAM_MACRO_DOFS + 2 * b + k] += S[i][0] * dN[2 * a] + S[i][1] * dN[2 * a + 1];
      }
    }
  }
}

PetscErrorCode LamMacroAssembleTangent(LamMacro macro, Mat tangent)
{
  PetscSection section, global;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalSection(macro->dm, &section));
  PetscCall(DMGetGlobalSection(macro->dm, &global));
  PetscCall(MatZeroEntries(tangent));
  for (PetscInt cell = macro->cell_start; cell < macro->cell_end; cell++) {
    PetscScalar Ke[LAM_MACRO_DOFS * LAM_MACRO_DOFS] = {0};
    for (PetscInt q = 0; q < LAM_MACRO_POINTS; q++) {
      PetscInt point = (cell - macro->cell_start) * LAM_MACRO_POINTS + q;
      AddPointTangent(&macro->now[point], &macro->gradient[point * LAM_MACRO_DOFS], macro->weight[point], Ke);
    }
    PetscCall(DMPlexMatSetClosure(macro->dm, section, global, tangent, cell, Ke, ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(tangent, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(tangent, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}
