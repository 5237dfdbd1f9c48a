/* A pair of chains of quadratic edges and the evaluation of its weighted gaps, for tests of the mortar kernel. */
#ifndef LAM_SUPPORT_MORTAR_FIXTURE_H
#define LAM_SUPPORT_MORTAR_FIXTURE_H

#include <string.h>
#include "mortar.h"
#include "random_reals.h"

#define SLAVE_EDGES 2
#define MASTER_EDGES 3
#define HATS (2 * SLAVE_EDGES + 1)
#define MASTER_NODES (2 * MASTER_EDGES + 1)
#define CHAIN_NODES (HATS + MASTER_NODES)
#define CHAIN_DOFS (2 * CHAIN_NODES)
typedef struct {
  double x[CHAIN_NODES][2]; /* slave, then master */
  double J0[SLAVE_EDGES], lambda[HATS];
} Chains;

typedef struct {
  double weight[HATS], gap[HATS], dgap[HATS][CHAIN_DOFS];
  double energy, gradient[CHAIN_DOFS], hessian[CHAIN_DOFS][CHAIN_DOFS]; /* of sum lambda G */
  double cut[MASTER_EDGES + 1], breaks[2 * SLAVE_EDGES + MASTER_EDGES + 2];
  int break_count;
} ChainValues;

PetscErrorCode EvaluateChains(const Chains *c, int points, ChainValues *values);

/*
  The slave runs from (1, 0) to (-1, 0) below the master, which runs from left to right; both are bent and kinked at
  random and turned by some angle. The planes of the master's ends pass the slave about `from` and `to` edges inside its
  ends (< 0: outside).
*/
Chains RandomChains(double from, double to, uint64_t *seed);

#endif
