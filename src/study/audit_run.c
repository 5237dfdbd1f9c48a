/*
  Queries a database at random states and solves the states with a response afresh. Rank 0 holds the database, queries
  it and compares; all ranks solve.
*/
#include "audit.h"
#include "dispatch.h"
#include "clock.h"

/* ---- solves ---- */

/* Shares the tissue and the states drawn by rank 0, which owns both. */
static PetscErrorCode Share(LamVerification *v, PetscErrorCode ierr)
{
  const MPI_Comm comm = PETSC_COMM_WORLD;
  LamMicrostructure *micro = &v->micro;
  size_t cells = 0, loads = (size_t)v->audit.answered * sizeof(*v->loads);

  PetscFunctionBeginUser;
  if (micro->cell) cells = (size_t)(micro->cells[0] * micro->cells[1]) * sizeof(LamCell);
  v->loads = v->audit.loads;
  PetscCall(LamShareError(comm, ierr));
  PetscCallMPI(MPI_Bcast(micro, sizeof(*micro), MPI_BYTE, 0, comm));
  PetscCallMPI(MPI_Bcast(&v->strategy, 1, MPI_INT, 0, comm));
  PetscCall(LamShareBytes(comm, 0, &cells, &micro->cell));
  PetscCall(LamShareBytes(comm, 0, &loads, &v->loads));
  if (!cells) PetscCall(PetscFree(micro->cell));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateRVE(LamVerification *v)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &v->rve));
  PetscCall(LamRVESetMicrostructure(v->rve, &v->micro));
  PetscCall(LamRVESetStrategy(v->rve, v->strategy));
  PetscCall(LamRVESetUp(v->rve));
  PetscCall(LamRVESetInterrupt(v->rve, LamDispatchInterrupt, v->dispatch));
  PetscCall(LamRVEStateCreate(v->rve, &v->state));
  PetscFunctionReturn(0);
}

/* Starts from the stress-free reference, independent of the database and of earlier solves. */
static PetscErrorCode Solve(void *ctx, PetscInt64 index, const void *input, size_t input_size, void *result,
                            size_t *size)
{
  LamVerification *v = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(v->rve, v->state));
  PetscCall(LamRVESolve(v->rve, &v->loads[index], v->state, result));
  PetscFunctionReturn(0);
}

static PetscErrorCode Arrive(void *ctx, PetscInt64 index, const void *result)
{
  const LamResponse *fresh = result;
  LamVerification *v = ctx;

  PetscFunctionBeginUser;
  if (fresh->status == LAM_OUT_OF_REACH) PetscFunctionReturn(0); /* stopped */
  PetscCall(LamAuditCompare(&v->audit, (PetscInt)index, fresh));
  PetscCall(LamReportProgress(&v->reporter, v->audit.solved, v->audit.answered,
                              (PetscInt64)json_object_size(v->audit.unsolved)));
  PetscFunctionReturn(0);
}

/* ---- rank 0 ---- */

static PetscErrorCode Begin(LamVerification *v)
{
  PetscFunctionBeginUser;
  PetscCall(LamQuerySourceOpen(v->path, &v->from));
  PetscCall(LamAuditCreate(&v->from, v->accuracy ? v->accuracy : v->from.accuracy, v->samples, v->seed, &v->audit));
  v->micro = v->from.micro;
  v->strategy = v->from.scene->strategy;
  LamActivitySet("states solved afresh");
  PetscFunctionReturn(0);
}

static PetscErrorCode RunRoot(LamVerification *v)
{
  PetscFunctionBeginUser;
  PetscCall(LamDispatchAdd(v->dispatch, 0, v->audit.answered, 0, 1));
  PetscCall(LamDispatchRun(v->dispatch, NULL, NULL, NULL));
  PetscFunctionReturn(0);
}

/* ---- ranks ---- */

/* An error on a worker must abort the job: rank 0 waits for its result. */
static PetscErrorCode RunAll(LamVerification *v)
{
  const PetscBool root = (PetscBool)(v->rank == 0);
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(Share(v, root ? Begin(v) : 0));
  PetscCall(CreateRVE(v));
  if (root)
    ierr = RunRoot(v);
  else
    PetscCall(LamDispatchServe(v->dispatch));
  PetscCall(LamShareError(PETSC_COMM_WORLD, ierr));
  PetscFunctionReturn(0);
}

PetscErrorCode LamVerificationRun(LamVerification *v)
{
  PetscFunctionBeginUser;
  v->start = LamClock();
  PetscCall(LamDispatchCreate(PETSC_COMM_WORLD,
                              &(LamDispatchJob){v, .result_size = sizeof(LamResponse), .work = Solve, .worked = Arrive},
                              &v->dispatch));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &v->rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &v->ranks));
  PetscCall(RunAll(v));
  PetscFunctionReturn(0);
}

PetscErrorCode LamVerificationDestroy(LamVerification *v)
{
  PetscFunctionBeginUser;
  if (v->rank == 0) {
    PetscCall(LamAuditDestroy(&v->audit));
    PetscCall(LamQuerySourceClose(&v->from));
  } else {
    PetscCall(PetscFree(v->loads));
    PetscCall(PetscFree(v->micro.cell));
  }
  PetscCall(LamRVEStateDestroy(&v->state));
  PetscCall(LamRVEDestroy(&v->rve));
  PetscCall(LamDispatchDestroy(&v->dispatch));
  PetscFunctionReturn(0);
}
