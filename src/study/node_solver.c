/*
  Chains of nodes, from the reference state down to the finest level.

  Method

  A child starts from its parent's own solution, bit for bit, whether that is cached or computed again: a chain is
  followed from its last cached node on, and the cache only saves time. When the cache is full, the least recently used
  node is evicted.
*/
#include "node_solver.h"
#include <sys/queue.h>

/* A cached node. */
typedef struct Node_s {
  PetscInt64 key;
  LamResponse response;
  LamRVEState state; /* owned; NULL: bonded tissue */
  TAILQ_ENTRY(Node_s) entry;
} Node;

struct LamNodeChain_s {
  LamRVE rve;   /* borrowed */
  LamGrid grid; /* borrowed */
  PetscBool warm;
  LamRVEState state; /* of the solve in progress; owned */
  PetscInt n, most;
  TAILQ_HEAD(Nodes, Node_s) nodes; /* [n], the last used first; owned */
};

/* ---- cache of solved nodes ---- */

/* NULL: not cached. */
static Node *Find(LamNodeChain chain, PetscInt64 key)
{
  Node *node;

  TAILQ_FOREACH(node, &chain->nodes, entry)
  {
    if (node->key != key) continue;
    TAILQ_REMOVE(&chain->nodes, node, entry);
    TAILQ_INSERT_HEAD(&chain->nodes, node, entry);
    break;
  }
  return node;
}

/* Keeps a node, in place of the least recently used one if the cache is full. */
static PetscErrorCode Remember(LamNodeChain chain, PetscInt64 key, const LamResponse *response, Node **node)
{
  PetscFunctionBeginUser;
  if (chain->n < chain->most) {
    chain->n++;
    PetscCall(PetscNew(node));
    if (chain->warm) PetscCall(LamRVEStateCreate(chain->rve, &(*node)->state));
  } else {
    *node = TAILQ_LAST(&chain->nodes, Nodes);
    TAILQ_REMOVE(&chain->nodes, *node, entry);
  }
  TAILQ_INSERT_HEAD(&chain->nodes, *node, entry);
  (*node)->key = key;
  (*node)->response = *response;
  if (chain->warm) PetscCall(LamRVEStateCopy(chain->state, (*node)->state));
  PetscFunctionReturn(0);
}

/* ---- solves ---- */

PetscBool LamNodeLeads(const LamResponse *response)
{
  return (PetscBool)(response->status == LAM_CONVERGED && !response->branch && response->floating_cells <= 0);
}

/* Starts from `state`, a solution; from the reference if `from_state` is false or continuation fails. */
static PetscErrorCode SolveFrom(LamRVE rve, PetscBool from_state, const LamLoad *load, LamRVEState state,
                                LamResponse *response)
{
  LamResponse failed = {0};

  PetscFunctionBeginUser;
  if (from_state) {
    PetscCall(LamRVESolve(rve, load, state, response));
    if (response->status == LAM_CONVERGED) PetscFunctionReturn(0);
    failed = *response;
  }
  PetscCall(LamRVEStateReset(rve, state));
  PetscCall(LamRVESolve(rve, load, state, response));
  response->newton_iterations += failed.newton_iterations;
  response->factorisations += failed.factorisations;
  response->seconds += failed.seconds;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeSolve(LamRVE rve, LamGrid grid, PetscInt64 key, PetscBool from_parent, LamRVEState state,
                            LamResponse *response)
{
  LamLoad load;

  PetscFunctionBeginUser;
  PetscCall(LamGridNodeLoad(grid, key, &load));
  PetscCall(SolveFrom(rve, from_parent, &load, state, response));
  PetscFunctionReturn(0);
}

/* Solves the node, its parents first, unless it is cached. */
static PetscErrorCode Reach(LamNodeChain chain, PetscInt64 key, Node **node)
{
  const PetscInt64 parent = chain->warm ? LamGridNodeParent(chain->grid, key) : -1;
  PetscBool leads = PETSC_FALSE;
  LamResponse response;

  PetscFunctionBeginUser;
  *node = Find(chain, key);
  if (*node) PetscFunctionReturn(0);
  if (parent >= 0) {
    PetscCall(Reach(chain, parent, node));
    leads = LamNodeLeads(&(*node)->response);
    if (leads) PetscCall(LamRVEStateCopy((*node)->state, chain->state));
  }
  PetscCall(LamNodeSolve(chain->rve, chain->grid, key, leads, chain->state, &response));
  PetscCall(Remember(chain, key, &response, node));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeChainSolve(void *chain, PetscInt64 key, LamResponse *response)
{
  Node *node;

  PetscFunctionBeginUser;
  PetscCall(Reach(chain, key, &node));
  *response = node->response;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeChainSolveNear(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response)
{
  LamNodeChain chain = ctx;
  PetscBool leads = PETSC_FALSE;
  Node *node;

  PetscFunctionBeginUser;
  if (chain->warm) {
    PetscCall(Reach(chain, key, &node));
    leads = LamNodeLeads(&node->response);
    if (leads) PetscCall(LamRVEStateCopy(node->state, chain->state));
  }
  PetscCall(SolveFrom(chain->rve, leads, load, chain->state, response));
  PetscFunctionReturn(0);
}

/* ---- lifecycle ---- */

PetscErrorCode LamNodeChainCreate(LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                  LamNodeChain *chain)
{
  PetscInt unknowns;
  LamNodeChain c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  c->rve = rve;
  c->grid = grid;
  c->warm = LamCellsPart(interface);
  PetscCall(LamRVEGetUnknowns(rve, &unknowns));
  /* positions of the tissue and of the bonded tissue from which it starts */
  c->most = (PetscInt)(memory / (sizeof(Node) + 2 * sizeof(PetscReal) * (size_t)unknowns)) + 1;
  TAILQ_INIT(&c->nodes);
  PetscCall(LamRVEStateCreate(rve, &c->state));
  *chain = c;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeChainDestroy(LamNodeChain *chain)
{
  LamNodeChain c = *chain;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  for (Node *node = TAILQ_FIRST(&c->nodes), *next; node; node = next) {
    next = TAILQ_NEXT(node, entry);
    PetscCall(LamRVEStateDestroy(&node->state));
    PetscCall(PetscFree(node));
  }
  PetscCall(LamRVEStateDestroy(&c->state));
  PetscCall(PetscFree(*chain));
  PetscFunctionReturn(0);
}
