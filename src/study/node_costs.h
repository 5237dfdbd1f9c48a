/*
  What a node will cost, told from the nodes around it that have been solved.
*/
#ifndef LAM_NODE_COSTS_H
#define LAM_NODE_COSTS_H

#include <lamella/database.h>

typedef struct LamNodeCosts_s *LamNodeCosts;

PetscErrorCode LamNodeCostsCreate(LamGrid grid, LamNodeCosts *costs); /* borrows the grid */
PetscErrorCode LamNodeCostsDestroy(LamNodeCosts *costs);
/* Factorisations are counted: unlike seconds they are the same on every machine. */
PetscErrorCode LamNodeCostsLearn(LamNodeCosts costs, PetscInt64 key, const LamResponse *response);
/* Geometric mean of the nearest of the latest; the same for nodes learnt in the same order. */
PetscReal LamNodeCostsPredict(LamNodeCosts costs, PetscInt64 key);

#endif
