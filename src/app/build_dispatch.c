/*
  States handed out by rank 0 in two-sided messages.

  Method
    Each worker has at most two states: one it solves and one that waits, so it never idles while rank 0 is busy with a
    state of its own. Rank 0 answers what has come in, then solves a state itself, and so on. Every state starts from
    the stress-free reference, so who solves it and what was solved before has no influence on the result.
*/
#include "build.h"

enum { AHEAD = 2, TAG_WORK = 1, TAG_RESULT = 2 };

typedef struct {
  PetscInt64 index;
  LamResponse response;
} Result;

typedef struct {
  LamDispatch *dispatch;
  PetscInt64 next, last;
  PetscInt out; /* states that workers have */
  LamSolved solved;
  void *ctx;
  PetscErrorCode ierr; /* of `solved`: nothing more is begun, results are thrown away */
} Run;

PetscErrorCode LamDispatchCreate(MPI_Comm comm, const LamScene *scene, LamDispatch *dispatch)
{
  PetscFunctionBeginUser;
  *dispatch = (LamDispatch){.comm = comm, .scene = scene};
  PetscCallMPI(MPI_Comm_rank(comm, &dispatch->rank));
  PetscCallMPI(MPI_Comm_size(comm, &dispatch->size));
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &dispatch->rve));
  PetscCall(LamRVESetMicrostructure(dispatch->rve, &scene->micro));
  PetscCall(LamRVESetStrategy(dispatch->rve, scene->strategy));
  PetscCall(LamRVESetUp(dispatch->rve));
  PetscCall(LamRVEStateCreate(dispatch->rve, &dispatch->state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&dispatch->state));
  PetscCall(LamRVEDestroy(&dispatch->rve));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveOne(LamDispatch *dispatch, Result *result)
{
  LamLoad load;

  PetscFunctionBeginUser;
  LamSampleLoad(dispatch->scene, result->index, &load);
  PetscCall(LamRVEStateReset(dispatch->rve, dispatch->state));
  PetscCall(LamRVESolve(dispatch->rve, &load, dispatch->state, &result->response));
  PetscFunctionReturn(0);
}

static PetscBool MayBegin(const Run *run)
{
  return (PetscBool)(!run->ierr && run->next < run->last && !LamStopRequested());
}

/* Gives `worker` the next state, if there is one. */
static PetscErrorCode Send(Run *run, PetscMPIInt worker)
{
  PetscFunctionBeginUser;
  if (!MayBegin(run)) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Send(&run->next, 1, MPIU_INT64, worker, TAG_WORK, run->dispatch->comm));
  run->next++;
  run->out++;
  PetscFunctionReturn(0);
}

static void Take(Run *run, const Result *result)
{
  if (!run->ierr) run->ierr = run->solved(run->ctx, result->index, &result->response);
}

static PetscErrorCode Receive(Run *run)
{
  Result result;
  MPI_Status status;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Recv(&result, (PetscMPIInt)sizeof(result), MPI_BYTE, MPI_ANY_SOURCE, TAG_RESULT, run->dispatch->comm,
                        &status));
  run->out--;
  PetscCall(Send(run, status.MPI_SOURCE));
  Take(run, &result);
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

PetscErrorCode LamDispatchRun(LamDispatch *dispatch, PetscInt64 first, PetscInt64 last, LamSolved solved, void *ctx)
{
  Run run = {.dispatch = dispatch, .next = first, .last = last, .solved = solved, .ctx = ctx};

  PetscFunctionBeginUser;
  for (int i = 0; i < AHEAD; i++)
    for (PetscMPIInt worker = 1; worker < dispatch->size; worker++) PetscCall(Send(&run, worker));
  while (run.out || MayBegin(&run)) {
    PetscCall(ReceiveWaiting(&run));
    if (MayBegin(&run)) {
      Result result = {.index = run.next++};

      PetscCall(SolveOne(dispatch, &result));
      Take(&run, &result);
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
    Result result;

    PetscCallMPI(MPI_Recv(&result.index, 1, MPIU_INT64, 0, TAG_WORK, dispatch->comm, MPI_STATUS_IGNORE));
    if (result.index < 0) break;
    PetscCall(SolveOne(dispatch, &result));
    PetscCallMPI(MPI_Send(&result, (PetscMPIInt)sizeof(result), MPI_BYTE, 0, TAG_RESULT, dispatch->comm));
  }
  PetscFunctionReturn(0);
}
