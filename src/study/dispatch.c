/*
  Method
    Waiting tasks are kept in a heap; of the lowest turn the task of the largest predicted cost is sent first. A worker
  holds one task beside the current one, so that it does not wait for rank 0, which handles messages between
  factorisations of its own task. It holds no more: tasks with mispredicted costs would wait behind each other. Sends do
  not block. The input of a task is kept until its result has arrived; a worker has one pending result. At the end rank
  0 sends TAG_STOP, and each worker sends TAG_LEFT after its last result, so that no message is left unreceived.

  References
    R. L. Graham, Bounds on multiprocessing timing anomalies, SIAM J. Appl. Math. 17 (1969) 416-429 (longest first).
*/
#include "dispatch.h"
#include "clock.h"
#include <signal.h>
#include <string.h>
#include <time.h>

enum { TAG_TASK = 1, TAG_RESULT, TAG_STOP, TAG_LEFT };
enum { LOOK_AHEAD = 1 }; /* tasks that a worker holds beside the current one; its buffers are for one */
/* An idle rank sleeps between polls, s, to leave the processor to other processes. */
#define LEAST_PAUSE 2e-5
#define LONGEST_PAUSE 1e-3

typedef struct {
  PetscInt64 number;
  PetscInt turn;
  PetscReal cost;
} Task;

/* A task with its input, or its result. */
typedef struct {
  PetscInt64 task;
  size_t size;
  char bytes[]; /* [size] */
} Message;

/* A task that was sent to a worker. */
typedef struct {
  Message *message; /* owned */
  MPI_Request request;
} Sent;

typedef struct {
  PetscInt n;
  Sent sent[1 + LOOK_AHEAD]; /* [n], in the order in which the worker does them */
} Worker;

struct LamDispatch_s {
  MPI_Comm comm; /* used for nothing else */
  PetscMPIInt rank, size;
  LamDispatchJob job;
  Message *current, *result; /* of the current task; owned */
  Message *next;             /* received; owned */
  PetscBool has_next;        /* workers: `next` is a task */
  PetscBool stopping;
  PetscErrorCode ierr; /* error in LamDispatchInterrupt */
  PetscReal pause, service;
  Message *sending;        /* workers: the pending result; owned */
  MPI_Request result_sent; /* workers */

  /* on rank 0 */
  PetscInt64 waiting, room;
  Task *heap;            /* [waiting]; owned */
  PetscInt64 unfinished; /* tasks without a result */
  Worker *worker;        /* [size]; owned */
  PetscMPIInt left;      /* number of workers that have left */
  PetscBool failed;      /* results are discarded */
};

/* ---- waiting tasks ---- */

static PetscBool ComesBefore(const Task *a, const Task *b)
{
  if (a->turn != b->turn) return (PetscBool)(a->turn < b->turn);
  return (PetscBool)(a->cost != b->cost ? a->cost > b->cost : a->number < b->number);
}

static PetscErrorCode Push(LamDispatch d, Task task)
{
  PetscInt64 i = d->waiting++;

  PetscFunctionBeginUser;
  if (i == d->room) {
    d->room = PetscMax(1024, 2 * d->room);
    PetscCall(PetscRealloc((size_t)d->room * sizeof(*d->heap), &d->heap));
  }
  for (; i && ComesBefore(&task, &d->heap[(i - 1) / 2]); i = (i - 1) / 2) d->heap[i] = d->heap[(i - 1) / 2];
  d->heap[i] = task;
  PetscFunctionReturn(0);
}

static PetscInt64 Pop(LamDispatch d)
{
  const PetscInt64 first = d->heap[0].number;
  const Task last = d->heap[--d->waiting];
  PetscInt64 i = 0;

  for (PetscInt64 child = 1; child < d->waiting; child = 2 * i + 1) {
    if (child + 1 < d->waiting && ComesBefore(&d->heap[child + 1], &d->heap[child])) child++;
    if (!ComesBefore(&d->heap[child], &last)) break;
    d->heap[i] = d->heap[child];
    i = child;
  }
  d->heap[i] = last;
  return first;
}

PetscErrorCode LamDispatchAdd(LamDispatch dispatch, PetscInt64 first, PetscInt64 count, PetscInt turn, PetscReal cost)
{
  PetscFunctionBeginUser;
  for (PetscInt64 i = 0; i < count; i++) PetscCall(Push(dispatch, (Task){first + i, turn, cost}));
  dispatch->unfinished += count;
  PetscFunctionReturn(0);
}

/* ---- rank 0: sending tasks, receiving results ---- */

/* Removes the first waiting task and writes its input. */
static PetscErrorCode TakeTask(LamDispatch d, Message *message)
{
  PetscFunctionBeginUser;
  message->task = Pop(d);
  message->size = 0;
  if (d->job.describe) PetscCall(d->job.describe(d->job.ctx, message->task, message->bytes, &message->size));
  PetscFunctionReturn(0);
}

static PetscErrorCode Send(LamDispatch d, const Message *message, PetscMPIInt rank, PetscMPIInt tag,
                           MPI_Request *request)
{
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast((PetscInt)(sizeof(*message) + message->size), &count));
  PetscCallMPI(MPI_Isend(message, count, MPI_BYTE, rank, tag, d->comm, request));
  PetscFunctionReturn(0);
}

/* Sends tasks to workers without one first, then one ahead to each while more tasks wait than there are ranks. */
static PetscErrorCode HandOut(LamDispatch d)
{
  PetscFunctionBeginUser;
  if (d->stopping || LamStopRequested()) PetscFunctionReturn(0);
  for (PetscInt ahead = 0; ahead <= LOOK_AHEAD; ahead++) {
    for (PetscMPIInt rank = 1; rank < d->size && d->waiting > ahead * d->size; rank++) {
      Worker *worker = &d->worker[rank];
      Sent *sent = &worker->sent[worker->n];

      if (worker->n != ahead) continue;
      PetscCall(PetscMalloc(sizeof(Message) + d->job.input_size, &sent->message));
      PetscCall(TakeTask(d, sent->message));
      PetscCall(Send(d, sent->message, rank, TAG_TASK, &sent->request));
      worker->n++;
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Finish(LamDispatch d, const Message *result)
{
  PetscFunctionBeginUser;
  d->unfinished--;
  if (!d->failed) PetscCall(d->job.worked(d->job.ctx, result->task, result->bytes));
  PetscFunctionReturn(0);
}

/* Frees the message of the worker's first task. */
static PetscErrorCode ForgetFirst(Worker *worker)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Wait(&worker->sent[0].request, MPI_STATUS_IGNORE));
  PetscCall(PetscFree(worker->sent[0].message));
  worker->n--;
  for (PetscInt i = 0; i < worker->n; i++) worker->sent[i] = worker->sent[i + 1];
  PetscFunctionReturn(0);
}

/* ---- messages ---- */

static PetscErrorCode Receive(LamDispatch d, PetscBool *found)
{
  MPI_Status status;
  PetscMPIInt count;
  int arrived;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, d->comm, &arrived, &status));
  *found = (PetscBool)arrived;
  if (!arrived) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Get_count(&status, MPI_BYTE, &count));
  PetscCallMPI(MPI_Recv(d->next, count, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, d->comm, MPI_STATUS_IGNORE));
  switch (status.MPI_TAG) {
  case TAG_TASK:
    d->has_next = PETSC_TRUE;
    break;
  case TAG_RESULT:
    PetscCall(ForgetFirst(&d->worker[status.MPI_SOURCE]));
    PetscCall(Finish(d, d->next));
    break;
  case TAG_STOP:
    d->stopping = PETSC_TRUE;
    break;
  case TAG_LEFT:
    d->left++;
    if (!d->stopping) LamStopRequest(SIGTERM); /* the worker left because of a signal */
    break;
  }
  PetscFunctionReturn(0);
}

/* Handles all messages that have arrived; a worker stops at a task, which only TAG_STOP can follow. */
static PetscErrorCode Handle(LamDispatch d)
{
  PetscBool found;

  PetscFunctionBeginUser;
  do {
    PetscCall(Receive(d, &found));
    if (found) d->pause = 0;
    if (!d->rank) PetscCall(HandOut(d));
  } while (found && !d->has_next);
  PetscFunctionReturn(0);
}

PetscBool LamDispatchInterrupt(void *dispatch)
{
  LamDispatch d = dispatch;
  const PetscReal begin = LamClock();

  if (d->size > 1 && !d->ierr) {
    d->ierr = Handle(d);
    d->service += LamClock() - begin;
  }
  return (PetscBool)(d->ierr || d->stopping || LamStopRequested());
}

PetscErrorCode LamDispatchLook(LamDispatch dispatch)
{
  PetscFunctionBeginUser;
  if (dispatch->size > 1) PetscCall(Handle(dispatch));
  PetscFunctionReturn(0);
}

PetscReal LamDispatchServiceTime(LamDispatch dispatch)
{
  return dispatch->service;
}

/* Exponential backoff; the first calls do not sleep. */
static void Pause(LamDispatch d)
{
  const struct timespec pause = {0, (long)(1e9 * d->pause)};

  if (d->pause >= LEAST_PAUSE) nanosleep(&pause, NULL);
  d->pause = PetscMin(LONGEST_PAUSE, d->pause ? 2 * d->pause : LEAST_PAUSE / 8);
}

/* ---- tasks ---- */

/* Does the task `current`. *done: it was not interrupted. */
static PetscErrorCode DoTask(LamDispatch d, PetscBool *done)
{
  const Message *task = d->current;
  Message *result = d->result;

  PetscFunctionBeginUser;
  result->task = task->task;
  result->size = d->job.result_size;
  memset(result->bytes, 0, result->size); /* messages have no uninitialised bytes */
  PetscCall(d->job.work(d->job.ctx, task->task, task->bytes, task->size, result->bytes, &result->size));
  PetscCall(d->ierr);
  d->pause = 0;
  *done = (PetscBool)(!d->stopping && !LamStopRequested());
  PetscFunctionReturn(0);
}

static PetscErrorCode RunRoot(LamDispatch d)
{
  PetscBool done;

  PetscFunctionBeginUser;
  while (d->unfinished && !LamStopRequested()) {
    PetscCall(Handle(d));
    if (!d->waiting) {
      Pause(d);
      continue;
    }
    PetscCall(TakeTask(d, d->current));
    PetscCall(DoTask(d, &done));
    if (done) PetscCall(Finish(d, d->result));
  }
  PetscFunctionReturn(0);
}

/* Sends TAG_STOP and handles messages until all workers have left. */
static PetscErrorCode StopWorkers(LamDispatch d)
{
  PetscFunctionBeginUser;
  d->stopping = PETSC_TRUE;
  for (PetscMPIInt rank = 1; rank < d->size; rank++) PetscCallMPI(MPI_Send(NULL, 0, MPI_BYTE, rank, TAG_STOP, d->comm));
  while (d->left < d->size - 1) {
    PetscCall(Handle(d));
    Pause(d);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchRun(LamDispatch dispatch, PetscErrorCode (*stopped)(void *ctx), void *ctx,
                              PetscBool *complete)
{
  PetscErrorCode ierr = RunRoot(dispatch), stop;

  PetscFunctionBeginUser;
  if (!ierr && LamStopRequested() && stopped) ierr = stopped(ctx);
  dispatch->failed = (PetscBool)(ierr != 0);
  stop = StopWorkers(dispatch);
  PetscCall(ierr ? ierr : stop);
  if (complete) *complete = (PetscBool)!dispatch->unfinished;
  PetscFunctionReturn(0);
}

/* Waits for the next task or for TAG_STOP. */
static PetscErrorCode Await(LamDispatch d)
{
  PetscFunctionBeginUser;
  while (!d->has_next && !d->stopping && !LamStopRequested()) {
    PetscCall(Handle(d));
    if (!d->has_next) Pause(d);
  }
  PetscFunctionReturn(0);
}

/* Waits for the previous send first. Rank 0 has usually received that result during this task. */
static PetscErrorCode SendResult(LamDispatch d)
{
  Message *const sent = d->sending;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Wait(&d->result_sent, MPI_STATUS_IGNORE));
  d->sending = d->result;
  d->result = sent;
  PetscCall(Send(d, d->sending, 0, TAG_RESULT, &d->result_sent));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchServe(LamDispatch dispatch)
{
  LamDispatch d = dispatch;
  PetscBool done = PETSC_TRUE;

  PetscFunctionBeginUser;
  while (done) {
    Message *const free = d->current;

    PetscCall(Await(d));
    if (!d->has_next || d->stopping || LamStopRequested()) break;
    d->current = d->next;
    d->next = free;
    d->has_next = PETSC_FALSE;
    PetscCall(DoTask(d, &done));
    if (done) PetscCall(SendResult(d));
  }
  PetscCallMPI(MPI_Wait(&d->result_sent, MPI_STATUS_IGNORE));
  PetscCallMPI(MPI_Send(NULL, 0, MPI_BYTE, 0, TAG_LEFT, d->comm));
  while (!d->stopping) { /* discards tasks sent before the end */
    d->has_next = PETSC_FALSE;
    PetscCall(Handle(d));
    Pause(d);
  }
  PetscFunctionReturn(0);
}

/* ---- lifecycle ---- */

PetscErrorCode LamDispatchCreate(MPI_Comm comm, const LamDispatchJob *job, LamDispatch *dispatch)
{
  const size_t size = sizeof(Message) + PetscMax(job->input_size, job->result_size);
  LamDispatch d;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  d->job = *job;
  d->result_sent = MPI_REQUEST_NULL;
  PetscCallMPI(MPI_Comm_dup(comm, &d->comm));
  PetscCallMPI(MPI_Comm_rank(comm, &d->rank));
  PetscCallMPI(MPI_Comm_size(comm, &d->size));
  PetscCall(PetscCalloc1(d->size, &d->worker));
  PetscCall(PetscMalloc(size, &d->current));
  PetscCall(PetscMalloc(size, &d->next));
  PetscCall(PetscMalloc(size, &d->result));
  PetscCall(PetscMalloc(size, &d->sending));
  *dispatch = d;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch)
{
  LamDispatch d = *dispatch;

  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(0);
  for (PetscMPIInt rank = 1; rank < d->size; rank++)
    while (d->worker[rank].n) PetscCall(ForgetFirst(&d->worker[rank])); /* tasks left at a stop */
  PetscCallMPI(MPI_Comm_free(&d->comm));
  PetscCall(PetscFree(d->worker));
  PetscCall(PetscFree(d->heap));
  PetscCall(PetscFree(d->current));
  PetscCall(PetscFree(d->result));
  PetscCall(PetscFree(d->sending));
  PetscCall(PetscFree(d->next));
  PetscCall(PetscFree(*dispatch));
  PetscFunctionReturn(0);
}
