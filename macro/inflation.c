/*
  Initial guess of an inflated body: the homogeneous deformation in which free tissue under its turgor is stress-free.

  Method. The full Newton step from F = 1 diverges if the tissue is soft relative to its turgor, as tissue of sliding
  cells is. The initial guess is therefore computed at one material point, the one nearest to the middle of the body:
  Psi(F, p) is minimised over symmetric plane F by Newton's method with the absolute values of the eigenvalues of its
  Hessian. Steps are at most STEP long, and halved if the energy does not decrease or there is no response. Then u =
  (F - 1) X + c + w x X, with the rigid motion fitted to the constraints. The guess costs one query per iteration; the
  body's own Newton iteration verifies it.

  An axisymmetric body can be deformed alike everywhere only with F33 = F11 and without shear: then Psi is minimised
  over F11 = F33 and F22. Where that leaves a stress, since the cells' axes are along the hoop, it balances that within
  the body only with deformations that differ from place to place, which Newton's method finds.
*/
#include <math.h>
#include "macro_impl.h"
#include <petscblaslapack.h>

enum { ITERATIONS = 40, SYMMETRIC = 3 }; /* components 11, 12 = 21, 22 */
static const PetscReal STEP = 0.1, STRESS = 1e-9 /* relative to the largest stress during the iteration */;

/* Energy of the middle point at F. */
typedef struct {
  PetscBool known;
  PetscReal energy, gradient[SYMMETRIC], hessian[SYMMETRIC * SYMMETRIC];
} Energy;

/* Finds the material point nearest to the centroid, and its rank. */
static PetscErrorCode FindMiddle(LamMacro macro, PetscMPIInt *rank, PetscBool *mine, PetscInt *point)
{
  PetscReal sum[3] = {0};
  double nearest = HUGE_VAL;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < macro->point_count; p++) {
    sum[2] += macro->weight[p];
    for (int i = 0; i < 2; i++) sum[i] += macro->weight[p] * macro->place[2 * p + i];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, macro->comm));
  for (PetscInt p = 0; p < macro->point_count; p++) {
    const double distance = hypot(macro->place[2 * p] - sum[0] / sum[2], macro->place[2 * p + 1] - sum[1] / sum[2]);
    if (distance >= nearest) continue;
    nearest = distance;
    *point = p;
  }
  PetscCall(LamMacroFindRank(macro, nearest, rank, mine));
  PetscFunctionReturn(0);
}

static void Project(LamMacro macro, const LamResponse *response, Energy *energy)
{
  /* a component of F and the corresponding component of e */
  static const int plane[4][2] = {{0, 0}, {1, 1}, {3, 1}, {4, 2}}, around[3][2] = {{0, 0}, {8, 0}, {4, 2}};
  const int(*moves)[2] = macro->axisymmetric ? around : plane, count = macro->axisymmetric ? 3 : 4;

  energy->known = LamResponseHasFields(response);
  energy->energy = response->energy;
  for (int k = 0; k < SYMMETRIC; k++) {
    energy->gradient[k] = 0;
    for (int l = 0; l < SYMMETRIC; l++) energy->hessian[SYMMETRIC * k + l] = 0;
  }
  for (int i = 0; i < count; i++) {
    energy->gradient[moves[i][1]] += response->P[moves[i][0]];
    for (int j = 0; j < count; j++)
      energy->hessian[SYMMETRIC * moves[i][1] + moves[j][1]] += response->tangent[9 * moves[i][0] + moves[j][0]];
  }
}

/* Psi and its derivatives at F = 1 + (e11, e12, e22), the same on all ranks. */
static PetscErrorCode QueryAt(LamMacro macro, PetscMPIInt rank, PetscBool mine, PetscInt point,
                              const PetscReal e[SYMMETRIC], Energy *energy)
{
  const LamLoad load = {.F = {1 + e[0], e[1], 0, e[1], 1 + e[2], 0, 0, 0, macro->axisymmetric ? 1 + e[0] : 1},
                        .turgor = macro->turgor * (macro->point_count ? macro->turgor_share[point] : 0),
                        .cohesion = macro->point_count ? macro->cohesion[point] : 0,
                        .duration = macro->duration};
  LamResponse response;

  PetscFunctionBeginUser;
  PetscCall(LamResponderRespond(macro->responder, mine, &load, &point, &response));
  if (mine) Project(macro, &response, energy);
  PetscCallMPI(MPI_Bcast(energy, sizeof(*energy), MPI_BYTE, rank, macro->comm));
  PetscFunctionReturn(0);
}

/* The step -|H|^-1 g, at most STEP long. */
static PetscErrorCode Descend(const Energy *energy, PetscReal step[SYMMETRIC])
{
  PetscBLASInt n = SYMMETRIC, length = 32, info;
  PetscReal V[SYMMETRIC * SYMMETRIC], w[SYMMETRIC], work[32], size = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(V, energy->hessian, SYMMETRIC * SYMMETRIC));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, V, &n, w, work, &length, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev: %d", (int)info);
  PetscCall(PetscArrayzero(step, SYMMETRIC));
  for (int k = 0; k < SYMMETRIC; k++) {
    PetscReal along = 0;
    for (int i = 0; i < SYMMETRIC; i++) along += V[SYMMETRIC * k + i] * energy->gradient[i];
    for (int i = 0; i < SYMMETRIC; i++)
      step[i] -= along / PetscMax(PetscAbsReal(w[k]), PETSC_SMALL) * V[SYMMETRIC * k + i];
  }
  for (int i = 0; i < SYMMETRIC; i++) size += PetscSqr(step[i]);
  size = PetscSqrtReal(size);
  for (int i = 0; i < SYMMETRIC && size > STEP; i++) step[i] *= STEP / size;
  PetscFunctionReturn(0);
}

static PetscReal Stress(const Energy *energy)
{
  PetscReal largest = 0;

  for (int i = 0; i < SYMMETRIC; i++) largest = PetscMax(largest, PetscAbsReal(energy->gradient[i]));
  return largest;
}

/* Minimises the energy of the middle point; *found: its stress vanishes. */
static PetscErrorCode FreeTissue(LamMacro macro, PetscReal e[SYMMETRIC], PetscBool *found)
{
  PetscMPIInt rank = 0;
  PetscBool mine = PETSC_FALSE;
  PetscInt point = 0;
  PetscReal step[SYMMETRIC] = {0}, share = 1, scale = 0;
  Energy now, next;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(FindMiddle(macro, &rank, &mine, &point));
  PetscCall(PetscArrayzero(e, SYMMETRIC));
  PetscCall(QueryAt(macro, rank, mine, point, e, &now));
  for (PetscInt it = 0; it < ITERATIONS && now.known && share > 1e-3; it++) {
    PetscReal trial[SYMMETRIC];
    scale = PetscMax(scale, Stress(&now));
    *found = Stress(&now) <= STRESS * scale ? PETSC_TRUE : PETSC_FALSE;
    if (*found) break;
    PetscCall(Descend(&now, step));
    for (int i = 0; i < SYMMETRIC; i++) trial[i] = e[i] + share * step[i];
    PetscCall(QueryAt(macro, rank, mine, point, trial, &next));
    /* near convergence the decrease of the energy is below rounding */
    if (!next.known || (next.energy > now.energy && Stress(&next) > 0.5 * Stress(&now))) {
      share *= 0.5;
      continue;
    }
    PetscCall(PetscArraycpy(e, trial, SYMMETRIC));
    now = next;
    share = 1;
  }
  PetscFunctionReturn(0);
}

/* Rigid motion c1, c2, w: least-squares fit of (F - 1) X plus the motion to the constraints. */
static PetscErrorCode FitMotion(LamMacro macro, const PetscReal e[SYMMETRIC], PetscReal motion[3])
{
  const PetscReal plane = macro->axisymmetric ? 0 : 1; /* motions other than along X2 */
  PetscReal sums[12] = {0};                            /* of the normal equations: matrix, right side */
  PetscBLASInt n = 3, one = 1, pivots[3], info;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->constraint_count; k++) {
    const LamConstraint *held = &macro->constraints[k];
    const PetscReal *X = &macro->position[2 * (held->point - macro->mesh_start)];
    const PetscReal row[3] = {plane * held->normal[0], held->normal[1],
                              plane * (held->normal[1] * X[0] - held->normal[0] * X[1])};
    const PetscReal miss =
        held->target - held->normal[0] * (e[0] * X[0] + e[1] * X[1]) - held->normal[1] * (e[1] * X[0] + e[2] * X[1]);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) sums[3 * i + j] += row[i] * row[j];
      sums[9 + i] += row[i] * miss;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 12, MPIU_REAL, MPIU_SUM, macro->comm));
  if (macro->axisymmetric) sums[0] = sums[8] = 1;
  PetscCallBLAS("LAPACKgesv", LAPACKgesv_(&n, &one, sums, &n, pivots, &sums[9], &n, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the body is not held");
  PetscCall(PetscArraycpy(motion, &sums[9], 3));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGuessInflated(LamMacro macro, Vec u, PetscBool *found)
{
  PetscReal e[SYMMETRIC], motion[3];
  PetscScalar *values;

  PetscFunctionBeginUser;
  PetscCall(FreeTissue(macro, e, found));
  if (!*found) PetscFunctionReturn(0);
  PetscCall(FitMotion(macro, e, motion));
  PetscCall(VecGetArray(u, &values));
  for (PetscInt k = 0; k < macro->node_count; k++) {
    const PetscReal *X = macro->nodes[k].X;
    const PetscInt local = macro->nodes[k].local;
    values[local] = e[0] * X[0] + e[1] * X[1] + motion[0] - motion[2] * X[1];
    values[local + 1] = e[1] * X[0] + e[2] * X[1] + motion[1] + motion[2] * X[0];
  }
  PetscCall(VecRestoreArray(u, &values));
  PetscFunctionReturn(0);
}
