/*
  Initial guesses for contact equilibrium.

  Mihai, Safar & Wyatt, J. Eng. Math. (successive deformation decomposition) for the bonded initial guess.
*/
#include "contact_path.h"

void LamContactStartNear(LamRVE rve, LamRVEState from, const LamLoad *load)
{
  LamMoveAffinely(rve, from->y, &from->load, load);
  (void)PetscArraycpy(rve->contact->lambda, from->lambda, rve->contact->count);
  LamTakeJunctions(rve, from);
}

/* Swells cells with a clearance until facing walls touch. */
static void CloseClearance(LamRVE rve, const LamLoad *load)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscReal swelling = 1.0 / mesh->apothem - 1.0;

  if (swelling == 0.0 || rve->micro.is_patch) return;
  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    PetscReal *y = &rve->y[2 * mesh->node_class[i]], centre[2];

    LamMeshCentre(mesh, i / (mesh->ring_nodes * mesh->radial_nodes), centre);
    for (PetscInt d = 0; d < 2; ++d)
      for (PetscInt J = 0; J < 2; ++J) y[d] += swelling * load->F[3 * d + J] * (mesh->X[2 * i + J] - centre[J]);
  }
}

void LamContactStartAffine(LamRVE rve, const LamLoad *load)
{
  for (PetscInt c = 0; c < rve->mesh.class_count; ++c) {
    const PetscReal *X = &rve->mesh.class_X[2 * c];

    for (PetscInt d = 0; d < 2; ++d) rve->y[2 * c + d] = load->F[3 * d] * X[0] + load->F[3 * d + 1] * X[1];
  }
  CloseClearance(rve, load);
  (void)PetscArrayzero(rve->stress, rve->mesh.element_count);
  for (PetscInt c = 0; c < rve->linear->lumens; ++c) rve->y[rve->ndof + c] = load->turgor * LamTurgorFactor(rve, c);
  for (PetscInt h = 0; h < rve->contact->count; ++h)
    rve->contact->lambda[h] = PetscMax(0.0, load->turgor + load->cohesion);
}

/* Copies positions and pressures of the bonded solution and sets consistent wall stresses. */
static void TakeBondedPositions(LamRVE rve, const LamLoad *load)
{
  const LamMesh *mesh = &rve->mesh, *bonded = &rve->bonded->mesh;

  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    const PetscReal *from = &bonded->shift[2 * i], *to = &mesh->shift[2 * i];
    const PetscReal S[2] = {from[0] - to[0], from[1] - to[1]}, *position = &rve->bonded->y[2 * bonded->node_class[i]];

    for (PetscInt d = 0; d < 2; ++d)
      rve->y[2 * mesh->node_class[i] + d] = position[d] + load->F[3 * d] * S[0] + load->F[3 * d + 1] * S[1];
  }
  for (PetscInt c = 0; c < rve->linear->lumens; ++c) rve->y[rve->ndof + c] = rve->bonded->y[rve->bonded->ndof + c];
  (void)LamSetConsistentStresses(rve, load, rve->y);
}

/*
  Least-squares fit of multipliers to the bonding forces r, B^T lambda = r, from the system
  [1 -B^T; -B 0] [v; lambda] = [-r; 0]. Multipliers in tension are set to zero.
*/
static PetscErrorCode FitMultipliers(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  LamContact *contact = rve->contact;
  const PetscInt positions = rve->linear->positions;
  PetscReal energy, *rhs, *solution;
  PetscInt negative;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(contact->lambda, contact->count));
  PetscCall(LamContactEvaluate(rve, load, rve->y, PETSC_TRUE));
  PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
  for (PetscInt h = 0; h < contact->count; ++h) contact->active[h] = (PetscBool)(contact->weight[h] > 0.0);
  PetscCall(PetscArrayzero(rve->linear->values, rve->linear->nonzeros));
  LamContactSetRows(rve, 0.0);
  LamSealSetOpen(rve);
  PetscCall(LamRVEFactor(rve, 1.0, &negative, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(rve->linear->n, &rhs, rve->linear->n, &solution));
  for (PetscInt i = 0; i < positions; ++i) rhs[i] = -rve->residual[i + 2];
  PetscCall(LamLinearSolveOnce(rve->linear, 1, rhs, solution));
  for (PetscInt h = 0; h < contact->count; ++h)
    contact->lambda[h] = contact->active[h] ? PetscMax(0.0, solution[positions + h]) : 0.0;
  PetscCall(PetscFree2(rhs, solution));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactStartBonded(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  PetscFunctionBeginUser;
  TakeBondedPositions(rve, load);
  PetscCall(FitMultipliers(rve, load, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(rve->contact->held, rve->residual, rve->ndof));
  LamContactAddForce(rve, rve->contact->held);
  PetscFunctionReturn(0);
}
