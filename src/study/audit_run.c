/*
  Queries a database at random states and solves the states with a response afresh. Rank 0 holds the database, queries
  it and compares; all ranks solve.
*/
#include "audit.h"
#include "dispatch.h"
#include "clock.h"

/* ---- solves ---- */

/* Broadcasts the tissue and the states drawn by rank 0. */
static PetscErrorCode Share(LamVerification *v)
{
  const MPI_Comm comm = PETSC_COMM_WORLD;
  LamMicrostructure *micro = &v->micro;
  LamCell *cells = micro->cell; /* on rank 0: the database's */
  int has_cells = cells != NULL;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(micro, sizeof(*micro), MPI_BYTE, 0, comm));
  PetscCallMPI(MPI_Bcast(&v->strategy, 1, MPI_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&has_cells, 1, MPI_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&v->count, 1, MPIU_INT, 0, comm));
  n = has_cells ? micro->cells[0] * micro->cells[1] : 0;
  PetscCall(PetscMalloc1(n, &micro->cell));
  if (v->rank == 0) PetscCall(PetscArraycpy(micro->cell, cells, n));
  PetscCallMPI(MPI_Bcast(micro->cell, (PetscMPIInt)((size_t)n * sizeof(LamCell)), MPI_BYTE, 0, comm));
  if (!has_cells) PetscCall(PetscFree(micro->cell));
  PetscCall(PetscMalloc1(v->count, &v->loads));
  if (v->rank == 0) PetscCall(PetscArraycpy(v->loads, v->audit.loads, v->count));
  for (PetscInt i = 0; i < v->count; i++) PetscCallMPI(MPI_Bcast(&v->loads[i], sizeof(LamLoad), MPI_BYTE, 0, comm));
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
  PetscCall(
      LamReportProgress(&v->reporter, v->audit.solved, v->count, (PetscInt64)json_object_size(v->audit.unsolved)));
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
  v->count = v->audit.answered;
  PetscFunctionReturn(0);
}

static PetscErrorCode RunRoot(LamVerification *v)
{
  PetscBool complete;

  PetscFunctionBeginUser;
  PetscCall(LamDispatchAdd(v->dispatch, 0, v->count, 1));
  PetscCall(LamDispatchRun(v->dispatch, NULL, NULL, &complete));
  PetscFunctionReturn(0);
}

/* ---- ranks ---- */

/* An error on a worker must abort the job: rank 0 waits for its result. */
static PetscErrorCode RunAll(LamVerification *v)
{
  const PetscBool root = (PetscBool)(v->rank == 0);
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(LamShareError(PETSC_COMM_WORLD, root ? Begin(v) : 0));
  PetscCall(Share(v));
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
  }
  PetscCall(LamRVEStateDestroy(&v->state));
  PetscCall(LamRVEDestroy(&v->rve));
  PetscCall(PetscFree(v->loads));
  PetscCall(PetscFree(v->micro.cell));
  PetscCall(LamDispatchDestroy(&v->dispatch));
  PetscFunctionReturn(0);
}
