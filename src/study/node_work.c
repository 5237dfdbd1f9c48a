#define _GNU_SOURCE /* tdestroy */
#include "node_work.h"
#include <search.h>
#include <string.h>
#include <sys/queue.h>

typedef struct Node_s {
  PetscInt64 key;
  PetscReal cost;
  PetscBool wanted, queued, solved, leads;
  LamResponse *response;   /* until somebody wants it; owned */
  void *state;             /* NULL: none is kept; owned */
  PetscInt pins;           /* children that are to start from the state */
  struct Node_s *parent;   /* whose state it starts from; NULL: from the reference */
  struct Node_s *children; /* that wait for this one to be solved */
  struct Node_s *sibling;
  TAILQ_ENTRY(Node_s) entry; /* in the list of states */
} Node;

/* The message to the rank that solves a node; the parent's state follows. */
typedef struct {
  PetscInt64 key;
  PetscInt64 from_parent;
} Question;

/* Its answer; the node's state follows, where children may start from it. */
typedef struct {
  LamResponse response;
} Answer;

struct LamNodeWork_s {
  LamRVE rve;   /* borrowed */
  LamGrid grid; /* borrowed */
  PetscBool warm;
  LamRVEState state; /* of the solve under way; owned */
  size_t state_size;
  LamDispatch dispatch;
  LamNodeCustomer customer;

  /* on rank 0 */
  void *nodes; /* of tsearch, by key */
  PetscInt64 pieces, room;
  Node **piece;                      /* [pieces]; owned, the nodes are not */
  TAILQ_HEAD(States, Node_s) states; /* those used last at the end */
  PetscInt64 kept, most;             /* states */
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

/* The node of this key, made where it is new: then the file may know it. */
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
  known = w->customer.known ? w->customer.known(w->customer.ctx, key) : NULL;
  if (known) {
    (*node)->solved = PETSC_TRUE;
    (*node)->leads = LamNodeLeads(known);
  }
  PetscFunctionReturn(0);
}

/* ---- states ---- */

/* Forgets those that were used least lately, but none that a child is about to start from. */
static PetscErrorCode MakeRoom(LamNodeWork w)
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

static PetscErrorCode KeepState(LamNodeWork w, Node *node, const void *bytes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(w->state_size, &node->state));
  memcpy(node->state, bytes, w->state_size);
  TAILQ_INSERT_TAIL(&w->states, node, entry);
  w->kept++;
  PetscFunctionReturn(0);
}

/* ---- what waits for what ---- */

/* Nothing keeps the node from being solved any more. */
static PetscErrorCode Release(LamNodeWork w, Node *node, Node *parent)
{
  PetscFunctionBeginUser;
  node->parent = parent;
  if (parent) {
    parent->pins++;
    TAILQ_REMOVE(&w->states, parent, entry);
    TAILQ_INSERT_TAIL(&w->states, parent, entry);
  }
  if (w->pieces == w->room) {
    w->room = PetscMax(1024, 2 * w->room);
    PetscCall(PetscRealloc((size_t)w->room * sizeof(*w->piece), &w->piece));
  }
  w->piece[w->pieces] = node;
  PetscCall(LamDispatchAdd(w->dispatch, w->pieces++, 1, node->cost));
  PetscFunctionReturn(0);
}

static PetscErrorCode Queue(LamNodeWork w, Node *node, PetscReal cost)
{
  const PetscInt64 key = w->warm ? LamGridNodeParent(w->grid, node->key) : -1;
  Node *parent = NULL;

  PetscFunctionBeginUser;
  node->queued = PETSC_TRUE;
  node->cost = cost;
  if (key >= 0) PetscCall(GetNode(w, key, &parent));
  if (!parent || (parent->solved && !parent->leads)) {
    PetscCall(Release(w, node, NULL));
    PetscFunctionReturn(0);
  }
  if (parent->state) {
    PetscCall(Release(w, node, parent));
    PetscFunctionReturn(0);
  }
  node->sibling = parent->children;
  parent->children = node;
  if (!parent->queued) PetscCall(Queue(w, parent, cost)); /* for its state */
  PetscFunctionReturn(0);
}

static PetscErrorCode ReleaseChildren(LamNodeWork w, Node *node)
{
  Node *child = node->children;

  PetscFunctionBeginUser;
  node->children = NULL;
  while (child) {
    Node *next = child->sibling;

    PetscCall(Release(w, child, node->leads ? node : NULL));
    child = next;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode HandOver(LamNodeWork w, Node *node, const LamResponse *response)
{
  PetscFunctionBeginUser;
  node->wanted = PETSC_FALSE;
  PetscCall(w->customer.arrived(w->customer.ctx, node->key, response));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkWant(LamNodeWork work, PetscInt64 key, PetscReal cost)
{
  Node *node;

  PetscFunctionBeginUser;
  PetscCall(GetNode(work, key, &node));
  node->wanted = PETSC_TRUE;
  if (node->response) {
    PetscCall(HandOver(work, node, node->response));
    PetscCall(PetscFree(node->response));
  } else if (!node->queued) {
    PetscCall(Queue(work, node, cost));
  }
  PetscFunctionReturn(0);
}

/* ---- the pieces of the dispatch ---- */

static PetscErrorCode Describe(void *ctx, PetscInt64 piece, void *input, size_t *size)
{
  LamNodeWork w = ctx;
  const Node *node = w->piece[piece];
  const Question question = {.key = node->key, .from_parent = node->parent != NULL};

  PetscFunctionBeginUser;
  memcpy(input, &question, sizeof(question));
  *size = sizeof(question);
  if (!node->parent) PetscFunctionReturn(0);
  memcpy((char *)input + sizeof(question), node->parent->state, w->state_size);
  *size += w->state_size;
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(void *ctx, PetscInt64 piece, const void *input, void *result, size_t *size)
{
  LamNodeWork w = ctx;
  const PetscReal service = LamDispatchServiceTime(w->dispatch);
  Question question;
  Answer answer;

  PetscFunctionBeginUser;
  memset(&answer, 0, sizeof(answer));
  memcpy(&question, input, sizeof(question));
  if (question.from_parent) PetscCall(LamRVEStateUnpack((const char *)input + sizeof(question), w->state));
  PetscCall(LamNodeSolve(w->rve, w->grid, question.key, (PetscBool)question.from_parent, w->state, &answer.response));
  answer.response.seconds -= LamDispatchServiceTime(w->dispatch) - service; /* messages are no part of the solve */
  memcpy(result, &answer, sizeof(answer));
  *size = sizeof(answer);
  if (!w->warm || !LamNodeLeads(&answer.response)) PetscFunctionReturn(0);
  PetscCall(LamRVEStatePack(w->state, (char *)result + sizeof(answer)));
  *size += w->state_size;
  PetscFunctionReturn(0);
}

static PetscErrorCode Solved(void *ctx, PetscInt64 piece, const void *result)
{
  LamNodeWork w = ctx;
  Node *node = w->piece[piece];
  Answer answer;

  PetscFunctionBeginUser;
  memcpy(&answer, result, sizeof(answer));
  if (node->parent) node->parent->pins--;
  node->queued = PETSC_FALSE;
  node->leads = LamNodeLeads(&answer.response);
  if (w->warm && node->leads) PetscCall(KeepState(w, node, (const char *)result + sizeof(answer)));
  PetscCall(ReleaseChildren(w, node));
  PetscCall(MakeRoom(w));
  if (node->wanted) {
    PetscCall(HandOver(w, node, &answer.response));
  } else if (!node->solved) {
    PetscCall(PetscNew(&node->response));
    *node->response = answer.response;
  }
  node->solved = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* ---- all of it ---- */

PetscErrorCode LamNodeWorkRun(LamNodeWork work, PetscErrorCode (*stopped)(void *ctx), PetscBool *complete)
{
  PetscFunctionBeginUser;
  PetscCall(LamDispatchRun(work->dispatch, stopped, work->customer.ctx, complete));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkServe(LamNodeWork work)
{
  PetscFunctionBeginUser;
  PetscCall(LamDispatchServe(work->dispatch));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeWorkCreate(MPI_Comm comm, LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                 PetscInt group, const LamNodeCustomer *customer, LamNodeWork *work)
{
  LamDispatchJob job = {.describe = Describe, .work = Solve, .worked = Solved};
  LamNodeWork w;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  w->rve = rve;
  w->grid = grid;
  w->warm = (PetscBool)(interface == LAM_INTERFACE_CONTACT);
  if (customer) w->customer = *customer;
  TAILQ_INIT(&w->states);
  PetscCall(LamRVEStateCreate(rve, &w->state));
  if (w->warm) PetscCall(LamRVEStateSize(w->state, &w->state_size));
  w->most = w->warm ? (PetscInt64)(memory / w->state_size) : 0;
  job.ctx = w;
  job.input_size = sizeof(Question) + w->state_size;
  job.result_size = sizeof(Answer) + w->state_size;
  PetscCall(LamDispatchCreate(comm, &job, group, &w->dispatch));
  PetscCall(LamRVESetInterrupt(rve, LamDispatchServeWaiting, w->dispatch));
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
  PetscCall(PetscFree(w->piece));
  PetscCall(PetscFree(*work));
  PetscFunctionReturn(0);
}
