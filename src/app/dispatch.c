/*
  Work handed out by rank 0 in two-sided messages.

  Method
    Each worker has at most two pieces: one it works on and one that waits, so it never idles while rank 0 is busy with
    a piece of its own. Rank 0 answers what has come in, then does a piece itself, and so on. The pieces do not depend
    on each other, so who does which, and what was done before, has no influence on the results.
*/
#include "dispatch.h"
#include <string.h>

enum { AHEAD = 2, TAG_WORK = 1, TAG_RESULT = 2 };

typedef struct {
  LamDispatch *dispatch;
  PetscInt64 next, last;
  PetscInt out; /* pieces that workers have */
  LamWorked worked;
  void *ctx;
  PetscErrorCode ierr; /* of `worked`: nothing more is begun, results are thrown away */
} Run;

/* A message is the index, then the result. */
static void *ResultOf(LamDispatch *dispatch)
{
  return (char *)dispatch->buffer + sizeof(PetscInt64);
}

static PetscMPIInt MessageSize(const LamDispatch *dispatch)
{
  return (PetscMPIInt)(sizeof(PetscInt64) + dispatch->result_size);
}

PetscErrorCode LamDispatchCreate(MPI_Comm comm, LamWork work, void *ctx, size_t result_size, LamDispatch *dispatch)
{
  PetscFunctionBeginUser;
  *dispatch = (LamDispatch){.comm = comm, .work = work, .ctx = ctx, .result_size = result_size};
  PetscCallMPI(MPI_Comm_rank(comm, &dispatch->rank));
  PetscCallMPI(MPI_Comm_size(comm, &dispatch->size));
  PetscCall(PetscMalloc(sizeof(PetscInt64) + result_size, &dispatch->buffer));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(dispatch->buffer));
  PetscFunctionReturn(0);
}

static PetscErrorCode WorkOne(LamDispatch *dispatch, PetscInt64 index)
{
  PetscFunctionBeginUser;
  memset(dispatch->buffer, 0, (size_t)MessageSize(dispatch));
  memcpy(dispatch->buffer, &index, sizeof(index));
  PetscCall(dispatch->work(dispatch->ctx, index, ResultOf(dispatch)));
  PetscFunctionReturn(0);
}

static PetscBool MayBegin(const Run *run)
{
  return (PetscBool)(!run->ierr && run->next < run->last && !LamStopRequested());
}

/* Gives `worker` the next piece, if there is one. */
static PetscErrorCode Send(Run *run, PetscMPIInt worker)
{
  PetscFunctionBeginUser;
  if (!MayBegin(run)) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Send(&run->next, 1, MPIU_INT64, worker, TAG_WORK, run->dispatch->comm));
  run->next++;
  run->out++;
  PetscFunctionReturn(0);
}

/* What is in the buffer. */
static void Take(Run *run)
{
  PetscInt64 index;

  memcpy(&index, run->dispatch->buffer, sizeof(index));
  if (!run->ierr) run->ierr = run->worked(run->ctx, index, ResultOf(run->dispatch));
}

static PetscErrorCode Receive(Run *run)
{
  LamDispatch *dispatch = run->dispatch;
  MPI_Status status;

  PetscFunctionBeginUser;
  PetscCallMPI(
      MPI_Recv(dispatch->buffer, MessageSize(dispatch), MPI_BYTE, MPI_ANY_SOURCE, TAG_RESULT, dispatch->comm, &status));
  run->out--;
  PetscCall(Send(run, status.MPI_SOURCE));
  Take(run);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReceiveWaiting(Run *run)
{
  int waiting = 1;

  PetscFunctionBeginUser;
  while (run->out && waiting) {
    PetscCallMPI(MPI_Iprobe(MPI_ANY_SOURCE, TAG_RESULT, run->dispatch->comm, &waiting, MPI_STATUS_IGNORE));
    if (waiting) PetscCall(Receive(run));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchRun(LamDispatch *dispatch, PetscInt64 first, PetscInt64 last, LamWorked worked, void *ctx)
{
  Run run = {.dispatch = dispatch, .next = first, .last = last, .worked = worked, .ctx = ctx};

  PetscFunctionBeginUser;
  for (int i = 0; i < AHEAD; i++)
    for (PetscMPIInt worker = 1; worker < dispatch->size; worker++) PetscCall(Send(&run, worker));
  while (run.out || MayBegin(&run)) {
    PetscCall(ReceiveWaiting(&run));
    if (MayBegin(&run)) {
      PetscCall(WorkOne(dispatch, run.next++));
      Take(&run);
    } else if (run.out) {
      PetscCall(Receive(&run));
    }
  }
  PetscCall(run.ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchEnd(LamDispatch *dispatch)
{
  const PetscInt64 end = -1;

  PetscFunctionBeginUser;
  for (PetscMPIInt worker = 1; worker < dispatch->size; worker++)
    PetscCallMPI(MPI_Send(&end, 1, MPIU_INT64, worker, TAG_WORK, dispatch->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchServe(LamDispatch *dispatch)
{
  PetscFunctionBeginUser;
  for (;;) {
    PetscInt64 index;

    PetscCallMPI(MPI_Recv(&index, 1, MPIU_INT64, 0, TAG_WORK, dispatch->comm, MPI_STATUS_IGNORE));
    if (index < 0) break;
    PetscCall(WorkOne(dispatch, index));
    PetscCallMPI(MPI_Send(dispatch->buffer, MessageSize(dispatch), MPI_BYTE, 0, TAG_RESULT, dispatch->comm));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchShare(LamDispatch *dispatch, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, dispatch->comm));
  if (code) return (PetscErrorCode)code;
  PetscFunctionReturn(0);
}
