#include "synthetic_responder.h"

static PetscReal SyntheticDistance(const PetscReal a[9], const PetscReal b[9])
{
  PetscReal sum = 0;

  for (int k = 0; k < 9; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sqrt(sum);
}

PetscReal SyntheticInverseTranspose(const PetscReal F[9], PetscReal G[9])
{
  PetscReal J;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      G[3 * i + j] = F[3 * i1 + j1] * F[3 * i2 + j2] - F[3 * i1 + j2] * F[3 * i2 + j1];
    }
  }
  J = F[0] * G[0] + F[1] * G[1] + F[2] * G[2];
  for (int k = 0; k < 9; k++) G[k] /= J;
  return J;
}

void SyntheticEvaluate(const Synthetic *material, const LamLoad *load, LamResponse *response)
{
  const PetscReal *F = load->F, mu = material->mu, lambda = material->lambda;
  const PetscReal p = load->turgor, lumen = material->phi + material->c * p,
                  push = (material->phi + 0.5 * material->c * p) * p;
  PetscReal G[9], J = SyntheticInverseTranspose(F, G), trace = 0, pressure = lambda * log(J) - push * J;

  for (int k = 0; k < 9; k++) trace += F[k] * F[k];
  response->energy = 0.5 * mu * (trace - 3 - 2 * log(J)) + 0.5 * lambda * log(J) * log(J) - push * J;
  for (int k = 0; k < 9; k++) {
    response->P[k] = mu * (F[k] - G[k]) + pressure * G[k];
    response->P_turgor[k] = -lumen * J * G[k];
    response->P_cohesion[k] = 0; /* bonded */
  }
  for (int ij = 0; ij < 9; ij++) {
    for (int kl = 0; kl < 9; kl++) {
      int i = ij / 3, j = ij % 3, k = kl / 3, l = kl % 3;
      response->tangent[9 * ij + kl] =
          mu * (ij == kl) + (lambda - push * J) * G[ij] * G[kl] + (mu - pressure) * G[3 * i + l] * G[3 * k + j];
    }
  }
  response->energy_turgor2 = -material->c * J;
  response->energy_turgor_cohesion = 0;
  response->energy_cohesion = response->energy_cohesion2 = 0;
  response->lumen_fraction = lumen * J;
  response->energy_turgor = -lumen * J;
  response->opening_fraction = response->debonded_fraction = response->max_gap = 0;
  response->status = LAM_CONVERGED;
  response->source = LAM_SOURCE_SOLVE;
  response->stable = PETSC_TRUE;
}

PetscErrorCode SyntheticRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                LamResponse responses[])
{
  Synthetic *material = (Synthetic *)ctx;
  const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  PetscFunctionBeginUser;
  material->calls++;
  material->counters.queries += n;
  material->counters.solves += n;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *from = points[i] < 0 ? identity : material->accepted[points[i]];
    PetscCall(LamResponseInit(&loads[i], &responses[i]));
    if (SyntheticDistance(loads[i].F, identity) > material->largest_strain ||
        SyntheticDistance(loads[i].F, from) > material->largest_step) {
      responses[i].status = LAM_NOT_CONVERGED;
      PetscCall(PetscStrncpy(responses[i].reason, material->reason, sizeof(responses[i].reason)));
      material->counters.failures++;
      continue;
    }
    SyntheticEvaluate(material, &loads[i], &responses[i]);
    if (points[i] >= 0) memcpy(material->current[points[i]], loads[i].F, sizeof(identity));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  return ((Synthetic *)ctx)->respond(ctx, n, loads, points, responses);
}

static PetscErrorCode SyntheticAccept(void *ctx)
{
  Synthetic *material = (Synthetic *)ctx;

  PetscFunctionBeginUser;
  material->accepts++;
  PetscCall(PetscArraycpy(material->accepted, material->current, material->points));
  PetscFunctionReturn(0);
}

static PetscErrorCode SyntheticReject(void *ctx)
{
  Synthetic *material = (Synthetic *)ctx;

  PetscFunctionBeginUser;
  material->rejects++;
  PetscCall(PetscArraycpy(material->current, material->accepted, material->points));
  PetscFunctionReturn(0);
}

static PetscErrorCode SyntheticDestroy(void **ctx)
{
  Synthetic *material = (Synthetic *)*ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(material->accepted));
  PetscCall(PetscFree(material->current));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode SyntheticCreate(PetscInt points, LamResponder *responder, Synthetic **material)
{
  const LamResponderFunctions functions = {
      .respond = Respond, .accept = SyntheticAccept, .reject = SyntheticReject, .destroy = SyntheticDestroy};
  const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  PetscFunctionBeginUser;
  PetscCall(PetscNew(material));
  (*material)->mu = 1;
  (*material)->lambda = 2;
  (*material)->phi = 1;
  (*material)->largest_strain = (*material)->largest_step = PETSC_INFINITY;
  (*material)->reason = "too far";
  (*material)->points = points;
  (*material)->respond = SyntheticRespond;
  PetscCall(PetscMalloc1(points, &(*material)->accepted));
  PetscCall(PetscMalloc1(points, &(*material)->current));
  for (PetscInt p = 0; p < points; p++) {
    memcpy((*material)->accepted[p], identity, sizeof(identity));
    memcpy((*material)->current[p], identity, sizeof(identity));
  }
  PetscCall(LamResponderCreate(&functions, *material, &(*material)->counters, responder));
  PetscFunctionReturn(0);
}
