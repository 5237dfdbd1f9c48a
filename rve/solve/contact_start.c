/*
  Initial guesses for contact equilibrium.

  Mihai, Safar & Wyatt, J. Eng. Math. (successive deformation decomposition) for the bonded initial guess.
*/
#include "contact_find.h"

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

    LamTissueCentre(mesh->tissue, LamMeshCellOfNode(mesh, i), centre);
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
  rve->moved = PETSC_TRUE;
}

static PetscErrorCode CreateBonded(LamRVE rve)
{
  LamMicrostructure bonded = rve->micro;

  PetscFunctionBeginUser;
  if (!rve->bonded) {
    bonded.interface = LAM_INTERFACE_BONDED;
    PetscCall(LamRVECreateLike(rve, &bonded, 0, &rve->bonded)); /* an initial guess: only its state is used */
    PetscCall(LamRVEStateCreate(rve->bonded, &rve->bonded_state));
  }
  rve->bonded->seal.closed = rve->seal.closed;
  rve->bonded->seal.bulk_modulus = rve->seal.bulk_modulus;
  if (rve->seal.closed) PetscCall(PetscArraycpy(rve->bonded->seal.water, rve->seal.water, rve->linear->lumens));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactStartBonded(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  LamResponse response;
  const LamMesh *mesh = &rve->mesh;
  LamRVEState from;

  PetscFunctionBeginUser;
  PetscCall(CreateBonded(rve));
  from = rve->bonded_state;
  rve->bonded->budget = rve->budget;
  PetscCall(LamRVEStateReset(rve->bonded, from));
  PetscCall(LamRVESolve(rve->bonded, load, from, &response));
  LamAddWork(rve, &response);
  *ok = LamResponseHasFields(&response);
  if (!*ok) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    PetscReal x[2];

    LamNodePosition(rve->bonded, load->F, from->y, i, x);
    LamPlaceNode(rve, load->F, i, x, rve->y);
  }
  PetscCall(PetscArraycpy(rve->y + rve->ndof, from->y + rve->bonded->ndof, rve->linear->lumens));
  *ok = LamSetConsistentStresses(rve, load, rve->y);
  rve->moved = PETSC_TRUE;
  PetscFunctionReturn(0);
}
