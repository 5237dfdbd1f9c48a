#include "mortar_fixture.h"

static LamMortarChains MortarChains(const Chains *c)
{
  return (LamMortarChains){SLAVE_EDGES, MASTER_EDGES, (const double(*)[2])c->x, (const double(*)[2])(c->x + HATS),
                           c->J0};
}

PetscErrorCode EvaluateChains(const Chains *c, int points, ChainValues *values)
{
  const LamMortarChains chains = MortarChains(c);
  LamMortarSegments segments;
  LamMortarResult result;

  PetscFunctionBeginUser;
  PetscCall(LamMortarSegmentsCreate(SLAVE_EDGES, MASTER_EDGES, &segments));
  PetscCall(LamMortarResultCreate(SLAVE_EDGES, MASTER_EDGES, &result));
  LamMortarFindSegments(&chains, &segments);
  LamMortarEvaluate(&chains, &segments, c->lambda, points, &result);
  memset(values, 0, sizeof(*values));
  memcpy(values->weight, result.weight, sizeof(values->weight));
  memcpy(values->gap, result.gap, sizeof(values->gap));
  memcpy(values->dgap, result.dgap, sizeof(values->dgap));
  memcpy(values->hessian, result.hessian, sizeof(values->hessian));
  memcpy(values->cut, segments.cut, sizeof(values->cut));
  memcpy(values->breaks, segments.s, (size_t)segments.count * sizeof(double));
  values->break_count = segments.count;
  for (int A = 0; A < HATS; A++) {
    values->energy += c->lambda[A] * values->gap[A];
    for (int i = 0; i < CHAIN_DOFS; i++) values->gradient[i] += c->lambda[A] * values->dgap[A][i];
  }
  PetscCall(LamMortarResultDestroy(&result));
  PetscCall(LamMortarSegmentsDestroy(&segments));
  PetscFunctionReturn(0);
}

Chains RandomChains(double from, double to, uint64_t *seed)
{
  const double angle = RandomReal(seed, 0.0, 6.0), c = cos(angle), s = sin(angle);
  const double left = -1.0 + to, right = 1.0 - from;
  Chains chains;

  for (int a = 0; a < CHAIN_NODES; a++) {
    const double place = a < HATS ? 1.0 - 0.5 * a : left + (right - left) * (a - HATS) / (MASTER_NODES - 1.0);
    const double x = place + RandomReal(seed, -0.02, 0.02), y = (a < HATS ? 0.0 : 0.06) + RandomReal(seed, -0.02, 0.02);

    chains.x[a][0] = c * x - s * y + 0.3;
    chains.x[a][1] = s * x + c * y - 0.2;
  }
  for (int e = 0; e < SLAVE_EDGES; e++) chains.J0[e] = RandomReal(seed, 0.7, 1.3);
  for (int A = 0; A < HATS; A++) chains.lambda[A] = RandomReal(seed, -0.2, 1.0);
  return chains;
}
