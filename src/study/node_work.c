#define _GNU_SOURCE /* tdestroy */
#include "node_work.h"
#include <search.h>
#include <string.h>
#include <sys/queue.h>

typedef struct Node_s {
  PetscInt64 key;
  PetscInt turn;
  PetscReal cost;
  PetscBool requested, queued, solved, leads;
  LamResponse *response;   /* kept until it is requested; owned */
  void *state;             /* NULL: not kept; owned */
  PetscInt pins;           /* number of tasks that start from the state */
  struct Node_s *parent;   /* start of its task; NULL: the reference */
  struct Node_s *children; /* nodes that wait for this one to be solved */
  struct Node_s *sibling;
  TAILQ_ENTRY(Node_s) entry; /* in the LRU list of states */
} Node;

struct LamNodeWork_s {
  LamRVE rve;   /* borrowed */
  LamGrid grid; /* borrowed */
  PetscBool warm;
  LamRVEState state; /* of the solve in progress; owned */
  size_t state_size; /* 0: nodes do not start from others */
  LamDispatch dispatch;
  LamNodeCallbacks callbacks;

  /* on rank 0 */
  void *nodes;                       /* root for tsearch, ordered by key */
  TAILQ_HEAD(States, Node_s) states; /* least recently used first */
  PetscInt64 kept, most;             /* number of states */
};

/* ---- nodes ---- */

static int CompareNodes(const void *a, const void *b)
{
  const PetscInt64 x = ((const Node *)a)->key, y = ((const Node *)b)->key;

  return (x > y) - (x < y);
}

static void FreeNode(void *pointer)
{
  Node *node = pointer;

  (void)PetscFree(node->response);
  (void)PetscFree(node->state);
  (void)PetscFree(node);
}

/* Returns the node of this key; a new one may have a record in the file. */
static PetscErrorCode GetNode(LamNodeWork w, PetscInt64 key, Node **node)
{
  const Node wanted = {.key = key};
  const LamResponse *known;
  Node *const *found = tfind(&wanted, &w->nodes, CompareNodes);

  PetscFunctionBeginUser;
  if (found) {
    *node = *found;
    PetscFunctionReturn(0);
  }
  PetscCall(PetscNew(node));
  (*node)->key = key;
  PetscCheck(tsearch(*node, &w->nodes, CompareNodes), PETSC_COMM_SELF, PETSC_ERR_MEM, "node");
  known = w->callbacks.known ? LamKnownRecordsGet(w->callbacks.known, key, NULL) : NULL;
  (*node)->solved = (PetscBool)(known != NULL);
  (*node)->leads = (PetscBool)(known && LamNodeLeads(known));
  PetscFunctionReturn(0);
}

/* ---- states ---- */

static PetscErrorCode KeepState(LamNodeWork w, Node *node, const void *bytes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(w->state_size, &node->state));
  memcpy(node->state, bytes, w->state_size);
  TAILQ_INSERT_TAIL(&w->states, node, entry);
  w->kept++;
  PetscFunctionReturn(0);
}

/* Frees states above the limit, except those from which a task is about to start. */
static PetscErrorCode LimitStates(LamNodeWork w)
{
  Node *node = TAILQ_FIRST(&w->states);

  PetscFunctionBeginUser;
  while (node && w->kept > w->most) {
    Node *next = TAILQ_NEXT(node, entry);

    if (!node->pins) {
      TAILQ_REMOVE(&w->states, node, entry);
      PetscCall(PetscFree(node->state));
      w->kept--;
    }
    node = next;
  }
  PetscFunctionReturn(0);
}

/* ---- requests ---- */

/* Adds the node's task, which starts from the state of `parent`; NULL: from the reference. */
static PetscErrorCode AddTask(LamNodeWork w, Node *node, Node *parent)
{
  PetscFunctionBeginUser;
  node->parent = parent;
  if (parent) {
    parent->pins++;
    TAILQ_REMOVE(&w->states, parent, entry);
    TAILQ_INSERT_TAIL(&w->states, parent, entry);
  }
  PetscCall(LamDispatchAdd(w->dispatch, node->key, 1, node->turn, node->cost));
  PetscFunctionReturn(0);
}

/* Adds the task of the node, or defers it until its parent is solved. */
static PetscErrorCode Queue(LamNodeWork w, Node *node, PetscInt turn, PetscReal cost)
{
  const PetscInt64 key = w->warm ? LamGridNodeParent(w->grid, node->key) : -1;
  Node *parent = NULL;

  PetscFunctionBeginUser;
  node->queued = PETSC_TRUE;
  node->turn = turn;
  node->cost = cost;
  if (key >= 0) PetscCall(GetNode(w, key, &parent));
  if (parent && parent->solved && !parent->leads) parent = NULL;
  if (!parent || parent->state) {
    PetscCall(AddTask(w, node, parent));
    PetscFunctionReturn(0);
  }
  node->sibling = parent->children;
  parent->children = node;
  if (!parent->queued) PetscCall(Queue(w, parent, turn, cost)); /* for its state */
  PetscFunctionReturn(0);
}

static PetscErrorCode QueueChildren(LamNodeWork w, Node *node)
{
  Node *child = node->children;

  PetscFunctionBeginUser;
  node->children = NULL;
  while (child) {
    Node *next = child->sibling;

    PetscCall(AddTask(w, child, node->leads ? node : NULL));
    child = next;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkRequest(LamNodeWork work, PetscInt64 key, PetscInt turn, PetscReal cost)
{
  Node *node;

  PetscFunctionBeginUser;
  PetscCall(GetNode(work, key, &node));
  if (node->response) {
    PetscCall(work->callbacks.arrived(work->callbacks.ctx, key, node->response));
    PetscCall(PetscFree(node->response));
    PetscFunctionReturn(0);
  }
  node->requested = PETSC_TRUE;
  if (!node->queued) PetscCall(Queue(work, node, turn, cost));
  PetscFunctionReturn(0);
}

/* ---- tasks: their number is the key; the input is the parent's state, the result a response and a state ---- */

static PetscErrorCode Describe(void *ctx, PetscInt64 key, void *input, size_t *size)
{
  LamNodeWork w = ctx;
  Node *node;

  PetscFunctionBeginUser;
  PetscCall(GetNode(w, key, &node));
  if (!node->parent) PetscFunctionReturn(0);
  *size = w->state_size;
  memcpy(input, node->parent->state, *size);
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(void *ctx, PetscInt64 key, const void *input, size_t input_size, void *result, size_t *size)
{
  LamNodeWork w = ctx;
  const PetscReal service = LamDispatchServiceTime(w->dispatch);
  LamResponse *response = result;

  PetscFunctionBeginUser;
  if (input_size) PetscCall(LamRVEStateUnpack(input, w->state));
  PetscCall(LamNodeSolve(w->rve, w->grid, key, (PetscBool)(input_size > 0), w->state, response));
  response->seconds -= LamDispatchServiceTime(w->dispatch) - service; /* excludes time spent on messages */
  *size = sizeof(*response);
  if (!w->warm || !LamNodeLeads(response)) PetscFunctionReturn(0);
  PetscCall(LamRVEStatePack(w->state, response + 1));
  *size += w->state_size;
  PetscFunctionReturn(0);
}

static PetscErrorCode Solved(void *ctx, PetscInt64 key, const void *result)
{
  const LamResponse *response = result;
  LamNodeWork w = ctx;
  PetscBool requested;
  Node *node;

  PetscFunctionBeginUser;
  PetscCall(GetNode(w, key, &node));
  requested = node->requested;
  if (node->parent) node->parent->pins--;
  if (!requested && !node->solved) {
    PetscCall(PetscNew(&node->response));
    *node->response = *response;
  }
  node->requested = node->queued = PETSC_FALSE;
  node->solved = PETSC_TRUE;
  node->leads = LamNodeLeads(response);
  if (w->warm && node->leads) PetscCall(KeepState(w, node, response + 1));
  PetscCall(QueueChildren(w, node));
  PetscCall(LimitStates(w));
  if (requested) PetscCall(w->callbacks.arrived(w->callbacks.ctx, key, response));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkRun(LamNodeWork work, PetscErrorCode (*stopped)(void *ctx))
{
  PetscFunctionBeginUser;
  PetscCall(LamDispatchRun(work->dispatch, stopped, work->callbacks.ctx, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkServe(LamNodeWork work)
{
  PetscFunctionBeginUser;
  PetscCall(LamDispatchServe(work->dispatch));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkLook(void *work)
{
  PetscFunctionBeginUser;
  PetscCall(LamDispatchLook(((LamNodeWork)work)->dispatch));
  PetscFunctionReturn(0);
}

/* ---- lifecycle ---- */

PetscErrorCode LamNodeWorkCreate(MPI_Comm comm, LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                 const LamNodeCallbacks *callbacks, LamNodeWork *work)
{
  LamDispatchJob job = {.describe = Describe, .work = Solve, .worked = Solved};
  LamNodeWork w;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  w->rve = rve;
  w->grid = grid;
  w->warm = LamCellsPart(interface);
  if (callbacks) w->callbacks = *callbacks;
  TAILQ_INIT(&w->states);
  PetscCall(LamRVEStateCreate(rve, &w->state));
  if (w->warm) PetscCall(LamRVEStateSize(w->state, &w->state_size));
  w->most = w->warm ? (PetscInt64)(memory / w->state_size) : 0;
  job.ctx = w;
  job.input_size = w->state_size;
  job.result_size = sizeof(LamResponse) + w->state_size;
  PetscCall(LamDispatchCreate(comm, &job, &w->dispatch));
  PetscCall(LamRVESetInterrupt(rve, LamDispatchInterrupt, w->dispatch));
  *work = w;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkDestroy(LamNodeWork *work)
{
  LamNodeWork w = *work;

  PetscFunctionBeginUser;
  if (!w) PetscFunctionReturn(0);
  PetscCall(LamRVESetInterrupt(w->rve, NULL, NULL));
  PetscCall(LamDispatchDestroy(&w->dispatch));
  PetscCall(LamRVEStateDestroy(&w->state));
  tdestroy(w->nodes, FreeNode);
  PetscCall(PetscFree(*work));
  PetscFunctionReturn(0);
}
