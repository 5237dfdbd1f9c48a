/*
  Predicts the cost of a node from solved nodes around it.
*/
#ifndef LAM_NODE_COSTS_H
#define LAM_NODE_COSTS_H

#include <lamella/database.h>

typedef struct LamNodeCosts_s *LamNodeCosts;

PetscErrorCode LamNodeCostsCreate(LamGrid grid, LamNodeCosts *costs); /* borrows the grid */
PetscErrorCode LamNodeCostsDestroy(LamNodeCosts *costs);
/* Records the cost of a node in factorisations, which unlike seconds are the same on every machine. */
PetscErrorCode LamNodeCostsLearn(LamNodeCosts costs, PetscInt64 key, const LamResponse *response);
/* Geometric mean over the nearest of the latest nodes; identical for nodes recorded in the same order. */
PetscReal LamNodeCostsPredict(LamNodeCosts costs, PetscInt64 key);

#endif
