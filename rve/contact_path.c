/*
  From a known state to contact equilibrium at a new load.
*/
#include "rve_impl.h"

/* rve->y := the bonded solution; multipliers: the least-squares fit of the forces that bonding carried. */
PetscErrorCode LamContactStartBonded(LamRVE rve, const LamLoad *load, LamRVEState state, PetscBool *ok)
{
  LamContact *contact = rve->contact;
  const LamMesh *mesh = &rve->mesh, *bonded = &rve->bonded->mesh;
  const PetscInt n = rve->linear.n, positions = rve->linear.positions;
  LamResponse response;
  PetscReal energy, *rhs, *solution;
  PetscInt negative;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(LamRVESolve(rve->bonded, load, state->bonded, &response));
  rve->work.iterations += response.newton_iterations;
  rve->work.factorisations += response.factorisations;
  *ok = LamResponseHasFields(&response);
  if (!*ok) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    for (PetscInt d = 0; d < 2; ++d)
      rve->y[2 * mesh->node_class[i] + d] = rve->bonded->y[2 * bonded->node_class[i] + d] +
                                            load->F[3 * d] * bonded->shift[2 * i] +
                                            load->F[3 * d + 1] * bonded->shift[2 * i + 1];
  (void)LamSetConsistentStresses(rve, load, rve->y);
  PetscCall(PetscArrayzero(contact->lambda, contact->count));
  PetscCall(LamContactEvaluate(rve, load, rve->y, PETSC_TRUE));
  PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
  for (PetscInt h = 0; h < contact->count; ++h) contact->active[h] = (PetscBool)(contact->weight[h] > 0.0);
  PetscCall(PetscArrayzero(rve->linear.values, rve->linear.nonzeros));
  LamContactAddTangent(rve, 0.0);
  for (PetscInt i = 0; i < positions; ++i) rve->linear.values[rve->linear.row[i]] = 1.0;
  PetscCall(LamLinearFactor(&rve->linear, 0.0, &negative, ok));
  ++rve->work.factorisations;
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(n, &rhs, n, &solution));
  for (PetscInt i = 0; i < positions; ++i) rhs[i] = -rve->residual[i + 2];
  PetscCall(LamLinearSolve(&rve->linear, 1, rhs, solution));
  for (PetscInt h = 0; h < contact->count; ++h)
    contact->lambda[h] = contact->active[h] ? PetscMax(0.0, solution[positions + h]) : 0.0;
  PetscCall(PetscFree2(rhs, solution));
  PetscFunctionReturn(0);
}

/* rve->y := F X, stress-free walls, multipliers that balance turgor and cohesion. */
PetscErrorCode LamContactStartAffine(LamRVE rve, const LamLoad *load)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < rve->mesh.class_count; ++c) {
    const PetscReal *X = &rve->mesh.class_X[2 * c];

    for (PetscInt d = 0; d < 2; ++d) rve->y[2 * c + d] = load->F[3 * d] * X[0] + load->F[3 * d + 1] * X[1];
  }
  PetscCall(PetscArrayzero(rve->stress, rve->mesh.element_count));
  for (PetscInt h = 0; h < rve->contact->count; ++h)
    rve->contact->lambda[h] = PetscMax(0.0, load->turgor + load->cohesion);
  PetscFunctionReturn(0);
}
