/*
  Solves nodes of a database's grid, each from the state of its parent: the next one towards coarser nodes.

  So a node is on the same branch as its neighbours, and its response depends on its key alone: not on the rank, on
  earlier solves, or on the contents of a file. Its parent is solved in the same way, and so on up to the reference
  state.
*/
#ifndef LAM_NODE_SOLVER_H
#define LAM_NODE_SOLVER_H

#include "study.h"

/*
  Solves one node. State of contact tissue, in: the state of its parent if `from_parent` (the parent satisfies
  LamNodeLeads), else ignored: the solve starts from the reference, as it also does if it does not converge from the
  parent; the counts of both attempts are summed. State out: the solution, if converged.
*/
PetscErrorCode LamNodeSolve(LamRVE rve, LamGrid grid, PetscInt64 key, PetscBool from_parent, LamRVEState state,
                            LamResponse *response);
/* Whether children may start from this response: it is stable, on the first branch and without floating cells. */
PetscBool LamNodeLeads(const LamResponse *response);

typedef struct LamNodeChain_s *LamNodeChain;

/*
  One per rank and RVE; borrows rve and grid. Caches the latest solved nodes, using at most `memory` bytes.
*/
#define LAM_NODE_MEMORY ((size_t)256 << 20)
PetscErrorCode LamNodeChainCreate(LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                  LamNodeChain *chain);
/*
  `chain`: a LamNodeChain; with this function it is a LamNodeSolver (cache.h). Bonded tissue is solved from the
  reference; contact tissue from its parent if LamNodeLeads holds for that, which is solved in the same way.
*/
PetscErrorCode LamNodeChainSolve(void *chain, PetscInt64 key, LamResponse *response);
/* The solve_near of a LamNodeSolver. Bonded tissue, and loads that do not converge from the node, start from the
   reference. */
PetscErrorCode LamNodeChainSolveNear(void *chain, PetscInt64 key, const LamLoad *load, LamResponse *response);
PetscErrorCode LamNodeChainDestroy(LamNodeChain *chain);

#endif
