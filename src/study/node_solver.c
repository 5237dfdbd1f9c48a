/*
  Chains of nodes, from the reference state down to the finest level.

  Method

  A child starts from its parent's own solution, bit for bit, whether that is cached or computed again: a chain is
  followed from its last cached node on, and the cache only saves time. When the cache is full, the least recently used
  node is evicted.
*/
#include "node_solver.h"

/* A cached node. */
typedef struct {
  LamResponse response;
  LamRVEState state; /* owned; NULL: bonded tissue */
} Node;

struct LamNodeChain_s {
  LamRVE rve;   /* borrowed */
  LamGrid grid; /* borrowed */
  PetscBool warm;
  PetscBool (*stop)(void); /* or NULL */
  LamRVEState state;       /* of the solve in progress; owned */
  PetscInt n, most, capacity;
  PetscInt64 *keys, *used; /* [capacity]; used: time of last use */
  Node *nodes;             /* [capacity] */
  PetscInt64 time;
};

/* ---- cache of solved nodes ---- */

static PetscInt Find(LamNodeChain chain, PetscInt64 key)
{
  for (PetscInt i = 0; i < chain->n; i++) {
    if (chain->keys[i] != key) continue;
    chain->used[i] = chain->time++;
    return i;
  }
  return -1;
}

static PetscErrorCode Grow(LamNodeChain chain)
{
  PetscFunctionBeginUser;
  if (chain->n < chain->capacity) PetscFunctionReturn(0);
  chain->capacity = PetscMin(PetscMax(2 * chain->capacity, 64), chain->most);
  PetscCall(PetscRealloc((size_t)chain->capacity * sizeof(*chain->keys), &chain->keys));
  PetscCall(PetscRealloc((size_t)chain->capacity * sizeof(*chain->used), &chain->used));
  PetscCall(PetscRealloc((size_t)chain->capacity * sizeof(*chain->nodes), &chain->nodes));
  PetscFunctionReturn(0);
}

/* Returns a slot for one more node: a new one, or that of the least recently used node. */
static PetscErrorCode TakePlace(LamNodeChain chain, PetscInt *place)
{
  PetscInt oldest = 0;

  PetscFunctionBeginUser;
  if (chain->n < chain->most) {
    PetscCall(Grow(chain));
    *place = chain->n++;
    chain->nodes[*place].state = NULL;
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 1; i < chain->n; i++)
    if (chain->used[i] < chain->used[oldest]) oldest = i;
  *place = oldest;
  PetscFunctionReturn(0);
}

static PetscErrorCode Remember(LamNodeChain chain, PetscInt64 key, const LamResponse *response, PetscInt *place)
{
  Node *node;

  PetscFunctionBeginUser;
  PetscCall(TakePlace(chain, place));
  node = &chain->nodes[*place];
  chain->keys[*place] = key;
  chain->used[*place] = chain->time++;
  node->response = *response;
  if (!chain->warm) PetscFunctionReturn(0);
  if (!node->state) PetscCall(LamRVEStateCreate(chain->rve, &node->state));
  PetscCall(LamRVEStateCopy(chain->state, node->state));
  PetscFunctionReturn(0);
}

/* ---- solves ---- */

PetscBool LamNodeLeads(const LamResponse *response)
{
  return (PetscBool)(response->status == LAM_CONVERGED && !response->branch && response->floating_cells <= 0);
}

static PetscErrorCode SolveFromReference(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(rve, state));
  PetscCall(LamRVESolve(rve, load, state, response));
  PetscFunctionReturn(0);
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

static LamLoad Between(const LamLoad *from, const LamLoad *to, PetscReal t)
{
  LamLoad load = *to;

  if (t == 1) return load;
  for (int i = 0; i < 9; i++) load.F[i] = (1 - t) * from->F[i] + t * to->F[i];
  load.turgor = (1 - t) * from->turgor + t * to->turgor;
  load.cohesion = (1 - t) * from->cohesion + t * to->cohesion;
  return load;
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
    const LamLoad next = Between(from, load, (PetscReal)end / (PetscReal)steps);

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
    PetscCall(SolveFromReference(rve, load, state, response));
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
static PetscErrorCode Reach(LamNodeChain chain, PetscInt64 key, PetscInt *place)
{
  const PetscInt64 parent = chain->warm ? LamGridNodeParent(chain->grid, key) : -1;
  PetscBool leads;
  PetscInt start = -1;
  LamResponse response;

  PetscFunctionBeginUser;
  *place = Find(chain, key);
  if (*place >= 0) PetscFunctionReturn(0);
  if (parent >= 0) PetscCall(Reach(chain, parent, &start));
  leads = (PetscBool)(start >= 0 && LamNodeLeads(&chain->nodes[start].response));
  if (leads) PetscCall(LamRVEStateCopy(chain->nodes[start].state, chain->state));
  PetscCall(LamNodeSolve(chain->rve, chain->grid, key, leads, chain->state, &response));
  PetscCall(Remember(chain, key, &response, place));
  PetscFunctionReturn(0);
}

static PetscErrorCode LeaveOut(const LamLoad *load, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->status = LAM_OUT_OF_REACH;
  PetscCall(PetscStrncpy(response->reason, "stopped before it was solved", sizeof(response->reason)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeChainSolve(void *ctx, PetscInt64 key, LamResponse *response)
{
  LamNodeChain chain = ctx;
  PetscInt place;
  LamLoad load;

  PetscFunctionBeginUser;
  if (chain->stop && chain->stop()) {
    PetscCall(LamGridNodeLoad(chain->grid, key, &load));
    PetscCall(LeaveOut(&load, response));
    PetscFunctionReturn(0);
  }
  PetscCall(Reach(chain, key, &place));
  *response = chain->nodes[place].response;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeChainSolveNear(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response)
{
  LamNodeChain chain = ctx;
  PetscBool leads = PETSC_FALSE;
  PetscInt place;
  LamLoad from;

  PetscFunctionBeginUser;
  if (chain->stop && chain->stop()) {
    PetscCall(LeaveOut(load, response));
    PetscFunctionReturn(0);
  }
  if (chain->warm) {
    PetscCall(Reach(chain, key, &place));
    leads = LamNodeLeads(&chain->nodes[place].response);
    if (leads) PetscCall(LamRVEStateCopy(chain->nodes[place].state, chain->state));
  }
  PetscCall(LamGridNodeLoad(chain->grid, key, &from));
  PetscCall(SolveFrom(chain->rve, leads ? &from : NULL, load, chain->state, response));
  PetscFunctionReturn(0);
}

/* ---- lifecycle ---- */

PetscErrorCode LamNodeChainCreate(LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                  PetscBool (*stop)(void), LamNodeChain *chain)
{
  PetscInt unknowns;
  LamNodeChain c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  c->rve = rve;
  c->grid = grid;
  c->stop = stop;
  c->warm = (PetscBool)(interface == LAM_INTERFACE_CONTACT);
  PetscCall(LamRVEGetUnknowns(rve, &unknowns));
  /* positions of the tissue and of the bonded tissue from which it starts */
  c->most = (PetscInt)(memory / (sizeof(Node) + 2 * sizeof(PetscReal) * (size_t)unknowns)) + 1;
  PetscCall(LamRVEStateCreate(rve, &c->state));
  *chain = c;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeChainDestroy(LamNodeChain *chain)
{
  LamNodeChain c = *chain;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < c->n; i++) PetscCall(LamRVEStateDestroy(&c->nodes[i].state));
  PetscCall(LamRVEStateDestroy(&c->state));
  PetscCall(PetscFree(c->keys));
  PetscCall(PetscFree(c->used));
  PetscCall(PetscFree(c->nodes));
  PetscCall(PetscFree(*chain));
  PetscFunctionReturn(0);
}
