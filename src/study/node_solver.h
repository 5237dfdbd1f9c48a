/*
  Solves nodes of a database's grid, each from the state of its parent: the nearest node of the next coarser level.

  So a node is on the branch of its neighbours, and its response depends on its key alone: not on who solves it, what
  was solved before, or what a file holds. Its parent is solved likewise, and so on up to the reference state.
*/
#ifndef LAM_NODE_SOLVER_H
#define LAM_NODE_SOLVER_H

#include "study.h"

/*
  Solves one node. State of contact tissue in: that of its parent (`from_parent`: the parent leads), else anything, for
  it is reached from the reference then, and also where no answer is found from the parent; the counts of both attempts
  are summed. State out: the solution, where there is one.
*/
PetscErrorCode LamNodeSolve(LamRVE rve, LamGrid grid, PetscInt64 key, PetscBool from_parent, LamRVEState state,
                            LamResponse *response);
/* Whether children may start from it: it is stable, on the first branch and without floating cells. */
PetscBool LamNodeLeads(const LamResponse *response);

typedef struct LamNodeChain_s *LamNodeChain;

/*
  One per rank and RVE; borrows rve and grid. Of the nodes that it has solved it remembers the latest, of no more than
  `memory` bytes, for those that follow. Once `stop` (NULL: never) is true nodes are LAM_OUT_OF_REACH.
*/
#define LAM_NODE_MEMORY ((size_t)256 << 20)
PetscErrorCode LamNodeChainCreate(LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                  PetscBool (*stop)(void), LamNodeChain *chain);
/*
  `chain`: a LamNodeChain; with this function it is a LamNodeSolver (cache.h). The state of bonded tissue is reached
  from the reference; that of contact tissue from its parent where that leads, whose own is reached likewise.
*/
PetscErrorCode LamNodeChainSolve(void *chain, PetscInt64 key, LamResponse *response);
/* Its solve_near; bonded tissue, and what is not found from the node, from the reference. */
PetscErrorCode LamNodeChainSolveNear(void *chain, PetscInt64 key, const LamLoad *load, LamResponse *response);
PetscErrorCode LamNodeChainDestroy(LamNodeChain *chain);

#endif
