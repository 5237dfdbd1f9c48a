/*
  lamella verify: asks a database at random and solves what it answers afresh.

  Rank 0 holds the database, asks and compares; all ranks solve.
*/
#include "app.h"
#include "audit.h"
#include "dispatch.h"
#include <lamella/clock.h>

enum { DEFAULT_SAMPLES = 200 };

typedef struct {
  const char *path, *samples_text, *seed_text, *accuracy_text;
  PetscBool json, quiet;
  PetscInt samples, seed;
  PetscReal accuracy; /* 0: that of the database */
  LamDispatch dispatch;
  PetscMPIInt rank, ranks;
  PetscReal start;

  /* every rank */
  LamMicrostructure micro;
  LamStrategy strategy;
  PetscInt count;
  LamLoad *loads; /* [count] */
  LamRVE rve;
  LamRVEState state;

  /* rank 0 */
  LamAnswers from;
  LamAudit audit;
  LamProgress progress;
} Verify;

/* ---- what is solved ---- */

/* What rank 0 has drawn, and the tissue, to all. */
static PetscErrorCode Share(Verify *v)
{
  const MPI_Comm comm = PETSC_COMM_WORLD;
  LamMicrostructure *micro = &v->micro;
  LamCell *cells = micro->cell; /* of rank 0: the database's */
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

static PetscErrorCode CreateRVE(Verify *v)
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

/* From the stress-free reference, as if nothing else were known. */
static PetscErrorCode Solve(void *ctx, PetscInt64 index, const void *input, size_t input_size, void *result,
                            size_t *size)
{
  Verify *v = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(v->rve, v->state));
  PetscCall(LamRVESolve(v->rve, &v->loads[index], v->state, result));
  PetscFunctionReturn(0);
}

static PetscErrorCode Arrive(void *ctx, PetscInt64 index, const void *result)
{
  const LamResponse *fresh = result;
  Verify *v = ctx;

  PetscFunctionBeginUser;
  if (fresh->status == LAM_OUT_OF_REACH) PetscFunctionReturn(0); /* stopped */
  PetscCall(LamAuditCompare(&v->audit, (PetscInt)index, fresh));
  PetscCall(LamProgressUpdate(&v->progress, v->audit.solved, (PetscInt64)json_object_size(v->audit.unsolved)));
  PetscFunctionReturn(0);
}

/* ---- rank 0 ---- */

static PetscErrorCode Begin(Verify *v)
{
  PetscFunctionBeginUser;
  PetscCall(LamAnswersOpen(v->path, &v->from));
  PetscCall(LamAuditCreate(&v->from, v->accuracy ? v->accuracy : v->from.accuracy, v->samples, v->seed, &v->audit));
  v->micro = v->from.micro;
  v->strategy = v->from.scene->strategy;
  v->count = v->audit.answered;
  PetscFunctionReturn(0);
}

static PetscErrorCode RunRoot(Verify *v)
{
  PetscBool complete;

  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&v->progress, v->count, v->quiet));
  PetscCall(LamDispatchAdd(v->dispatch, 0, v->count, 1));
  PetscCall(LamDispatchRun(v->dispatch, NULL, NULL, &complete));
  PetscCall(LamProgressEnd(&v->progress));
  PetscFunctionReturn(0);
}

static PetscErrorCode Report(Verify *v)
{
  json_t *object;

  PetscFunctionBeginUser;
  if (!v->json) {
    PetscCall(LamAuditPrint(&v->audit, v->path, LamClock() - v->start, v->ranks));
    PetscFunctionReturn(0);
  }
  PetscCall(LamAuditToJSON(&v->audit, v->path, LamClock() - v->start, &object));
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

/* Unsolved where an answer has no solution beside it, or nothing was answered. Rank 0's outcome is everyone's. */
static PetscErrorCode ExitStatus(Verify *v, int *exit_status)
{
  int status = LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (v->rank == 0 && (json_object_size(v->audit.unsolved) || !v->audit.answered)) status = LAM_EXIT_UNSOLVED;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  *exit_status = status;
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

/* A worker that fails cannot tell rank 0, which waits for its result: it ends the job. */
static PetscErrorCode RunAll(Verify *v)
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
  if (root) PetscCall(Report(v));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Verify *v)
{
  PetscFunctionBeginUser;
  if (v->rank == 0) {
    PetscCall(LamAuditDestroy(&v->audit));
    PetscCall(LamAnswersClose(&v->from));
  }
  PetscCall(LamRVEStateDestroy(&v->state));
  PetscCall(LamRVEDestroy(&v->rve));
  PetscCall(PetscFree(v->loads));
  PetscCall(PetscFree(v->micro.cell));
  PetscCall(LamDispatchDestroy(&v->dispatch));
  PetscFunctionReturn(0);
}

static PetscBool ReadValues(Verify *v, int *exit_status)
{
  v->samples = DEFAULT_SAMPLES;
  v->seed = 1;
  return (PetscBool)(LamCountParse("verify", "--samples", v->samples_text, 1, &v->samples, exit_status) &&
                     LamCountParse("verify", "--seed", v->seed_text, 0, &v->seed, exit_status) &&
                     LamAccuracyParse("verify", v->accuracy_text, &v->accuracy, exit_status));
}

PetscErrorCode LamCommandVerify(LamArgs *args, int *exit_status)
{
  Verify v = {0};
  PetscBool done;
  const LamOption options[] = {
      {0, "samples", LAM_OPTION_TEXT, "N", "answers that are solved afresh; default 200", &v.samples_text},
      {0, "seed", LAM_OPTION_TEXT, "S", "another one draws other states; default 1", &v.seed_text},
      {0, "accuracy", LAM_OPTION_TEXT, "ERROR",
       "relative error of P that is asked for, 0.01; inf: any; by default the scene's", &v.accuracy_text},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &v.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &v.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "verify DB.h5 [--samples N] [--seed S] [--accuracy ERROR] [--json] [--quiet]",
                            "Asks a database at random, solves what it answers afresh, and compares.", options, 1,
                            &v.path, &done, exit_status));
  if (done || !ReadValues(&v, exit_status)) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  v.start = LamClock();
  PetscCall(LamDispatchCreate(
      PETSC_COMM_WORLD, &(LamDispatchJob){&v, .result_size = sizeof(LamResponse), .work = Solve, .worked = Arrive},
      &v.dispatch));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &v.rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &v.ranks));
  PetscCall(RunAll(&v));
  PetscCall(ExitStatus(&v, exit_status));
  PetscCall(Destroy(&v));
  PetscFunctionReturn(0);
}
