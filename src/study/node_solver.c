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

/* Largest change of F, turgor or cohesion taken in one step. Larger changes take steps of SUBSTEP; after a step of
   no more than EASY factorisations the next is twice as large, up to MOST_SUBSTEPS. Eight steps of SUBSTEP cost a
   sixth of a start for which the contact set must be searched from scratch. */
#define ONE_STEP 0.04
#define SUBSTEP 0.0075
enum { EASY = 10, MOST_SUBSTEPS = 5 };

static PetscInt StepCount(const LamLoad *from, const LamLoad *to)
{
  PetscReal largest = PetscMax(PetscAbsReal(to->turgor - from->turgor), PetscAbsReal(to->cohesion - from->cohesion));

  for (int i = 0; i < 9; i++) largest = PetscMax(largest, PetscAbsReal(to->F[i] - from->F[i]));
  return largest <= ONE_STEP ? 1 : (PetscInt)PetscCeilReal(largest / SUBSTEP);
}

static void AddEffort(const LamResponse *step, LamResponse *sum)
{
  sum->newton_iterations += step->newton_iterations;
  sum->factorisations += step->factorisations;
  sum->seconds += step->seconds;
}

/* Starts from `state`, the solution at `from`; from the reference if `from` is NULL or continuation from it fails. */
static PetscErrorCode SolveFrom(LamRVE rve, const LamLoad *from, const LamLoad *load, LamRVEState state,
                                LamResponse *response)
{
  const PetscInt steps = from ? StepCount(from, load) : 0;
  PetscInt stride = 1;
  LamResponse effort = {.status = LAM_CONVERGED};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < steps && effort.status == LAM_CONVERGED;) {
    const PetscInt end = PetscMin(k + stride, steps);
    const LamLoad next = LamLoadBetween(from, load, (PetscReal)end / (PetscReal)steps);

    PetscCall(LamRVESolve(rve, &next, state, response));
    AddEffort(response, &effort);
    if (response->status == LAM_CONVERGED)
      k = end;
    else if (end == k + 1 || response->status == LAM_OUT_OF_REACH) /* no smaller step; stopped */
      effort.status = response->status;
    stride =
        response->status == LAM_CONVERGED && response->factorisations <= EASY ? PetscMin(2 * stride, MOST_SUBSTEPS) : 1;
  }
  if (!steps || effort.status != LAM_CONVERGED) {
    PetscCall(LamRVEStateReset(rve, state));
    PetscCall(LamRVESolve(rve, load, state, response));
    AddEffort(response, &effort);
  }
  response->newton_iterations = effort.newton_iterations;
  response->factorisations = effort.factorisations;
  response->seconds = effort.seconds;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeSolve(LamRVE rve, LamGrid grid, PetscInt64 key, PetscBool from_parent, LamRVEState state,
                            LamResponse *response)
{
  LamLoad load, parent;

  PetscFunctionBeginUser;
  PetscCall(LamGridNodeLoad(grid, key, &load));
  if (from_parent) PetscCall(LamGridNodeLoad(grid, LamGridNodeParent(grid, key), &parent));
  PetscCall(SolveFrom(rve, from_parent ? &parent : NULL, &load, state, response));
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
  LamLoad from;
  Node *node;

  PetscFunctionBeginUser;
  if (chain->warm) {
    PetscCall(Reach(chain, key, &node));
    leads = LamNodeLeads(&node->response);
    if (leads) PetscCall(LamRVEStateCopy(node->state, chain->state));
  }
  PetscCall(LamGridNodeLoad(chain->grid, key, &from));
  PetscCall(SolveFrom(chain->rve, leads ? &from : NULL, load, chain->state, response));
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
  c->warm = (PetscBool)(interface == LAM_INTERFACE_CONTACT);
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
