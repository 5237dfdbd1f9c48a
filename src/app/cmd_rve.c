/*
  lamella rve: solves the RVE along the scene's load.

  The states depend on one another: each starts from the last one that has an answer. So rank 0 solves the chain, and
  further ranks wait.
*/
#include "app.h"
#include <petsctime.h>
#include <string.h>

typedef struct {
  const char *scene_path, *out_path;
  PetscBool json, tangent, monitor, quiet;

  LamScene *scene;
  LamRVE rve;
  LamRVEState state;
  LamRVEMesh mesh;
  LamRecordWriter writer; /* NULL without -o */
  LamProgress progress;
  PetscInt solved, failed;
  PetscLogDouble start;
} Run;

/* ---- the file ---- */

static PetscErrorCode WriteMesh(Run *run)
{
  const LamRVEMesh *m = &run->mesh;
  const PetscInt nodes[2] = {m->node_count, 2}, elements[2] = {m->element_count, 9}, period[2] = {2, 2};

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterReals(run->writer, "/mesh/nodes", 2, nodes, m->nodes, "apothem"));
  PetscCall(LamRecordWriterInts(run->writer, "/mesh/elements", 2, elements, m->elements));
  PetscCall(LamRecordWriterInts(run->writer, "/mesh/cell_of", 1, &m->element_count, m->cell_of));
  PetscCall(LamRecordWriterReals(run->writer, "/mesh/period", 2, period, &m->period[0][0], "apothem"));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteField(Run *run, PetscInt number, const char name[], PetscInt components,
                                 const PetscReal values[], const char unit[])
{
  const PetscInt dims[2] = {run->mesh.node_count, components};
  char path[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/fields/%" PetscInt_FMT "/%s", number, name));
  PetscCall(LamRecordWriterReals(run->writer, path, components > 1 ? 2 : 1, dims, values, unit));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFields(Run *run, PetscInt number)
{
  const PetscReal MPa = run->scene->scales.stress * 1e-6;
  const PetscInt n = run->mesh.node_count;
  PetscReal *x, *fibre, *stress;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(2 * n, &x, n, &fibre, n, &stress));
  PetscCall(LamRVEGetFields(run->rve, run->state, x, fibre, stress));
  for (PetscInt i = 0; i < n; i++) stress[i] *= MPa;
  PetscCall(WriteField(run, number, "x", 2, x, "apothem"));
  PetscCall(WriteField(run, number, "fibre_stretch", 1, fibre, "1"));
  PetscCall(WriteField(run, number, "wall_stress", 1, stress, "MPa"));
  PetscCall(PetscFree3(x, fibre, stress));
  PetscFunctionReturn(0);
}

/* The fields come first, so that a record that is committed always has them. */
static PetscErrorCode WriteState(Run *run, PetscInt number, const LamResponse *response)
{
  const PetscInt64 key = number;

  PetscFunctionBeginUser;
  if (LamResponseHasFields(response)) PetscCall(WriteFields(run, number));
  PetscCall(LamRecordWriterCommit(run->writer, 1, &key, response));
  PetscFunctionReturn(0);
}

/* ---- what is told ---- */

/* In-plane entries; rows and columns 11, 12, 21, 22. */
static void PrintTangent(const LamResponse *response, PetscReal MPa)
{
  const PetscInt in_plane[4] = {0, 1, 3, 4};

  for (int i = 0; i < 4 && LamResponseHasFields(response); i++) {
    printf("%*s", 13, i ? "" : "dP/dF, MPa:");
    for (int j = 0; j < 4; j++) printf(" %13.6e", (double)(response->tangent[9 * in_plane[i] + in_plane[j]] * MPa));
    putchar('\n');
  }
}

static PetscErrorCode Tell(Run *run, PetscInt number, const LamResponse *response)
{
  const LamScales *scales = &run->scene->scales;
  json_t *object;

  PetscFunctionBeginUser;
  if (run->json) {
    PetscCall(LamResponseToJSON(response, scales, number, run->tangent, &object));
    PetscCall(LamPrintJSON(object));
    PetscFunctionReturn(0);
  }
  PetscCall(LamPrintResponseRow(response, scales, number));
  if (run->tangent) PrintTangent(response, scales->stress * 1e-6);
  PetscFunctionReturn(0);
}

static PetscErrorCode TellEnd(const Run *run)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  if (run->json) PetscFunctionReturn(0);
  PetscCall(PetscTime(&now));
  printf("%" PetscInt_FMT " of %" PetscInt_FMT " states solved, %" PetscInt_FMT " failed, %.3g s\n",
         run->solved - run->failed, run->scene->load_count, run->failed, now - run->start);
  if (run->out_path) printf("wrote %s\n", run->out_path);
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

static PetscErrorCode Prepare(Run *run)
{
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&run->start));
  PetscCall(LamSceneRead(run->scene_path, &run->scene));
  PetscCheck(run->scene->load_count, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `load`, which says what states to solve", run->scene_path);
  PetscCall(LamPlanMake(run->scene, &plan));
  run->scene->micro = plan.micro;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &run->rve));
  PetscCall(LamRVESetMicrostructure(run->rve, &run->scene->micro));
  PetscCall(LamRVESetMonitor(run->rve, run->monitor));
  PetscCall(LamRVESetUp(run->rve));
  PetscCall(LamRVEStateCreate(run->rve, &run->state));
  PetscCall(LamRVEGetMesh(run->rve, &run->mesh));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveStates(Run *run)
{
  /* rows of a table on the terminal are progress enough */
  const PetscBool quiet = (PetscBool)(run->quiet || run->monitor || !run->json);

  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&run->progress, run->scene->load_count, quiet));
  if (!run->json) PetscCall(LamPrintResponseHeader());
  while (run->solved < run->scene->load_count && !LamStopRequested()) {
    LamResponse response;

    PetscCall(LamRVESolve(run->rve, &run->scene->loads[run->solved], run->state, &response));
    run->solved++;
    if (response.status != LAM_CONVERGED) run->failed++;
    if (run->writer) PetscCall(WriteState(run, run->solved, &response));
    PetscCall(Tell(run, run->solved, &response));
    PetscCall(LamProgressUpdate(&run->progress, run->solved, run->failed));
  }
  PetscCall(LamProgressEnd(&run->progress));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&run->state));
  PetscCall(LamRVEDestroy(&run->rve));
  PetscCall(LamSceneDestroy(&run->scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunOnRoot(Run *run, int *exit_status)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(Prepare(run));
  if (run->out_path) {
    PetscCall(LamRecordWriterOpen(run->out_path, "rve", LAM_WRITE_CREATE, run->scene, &run->writer));
    ierr = WriteMesh(run);
  }
  if (!ierr) ierr = SolveStates(run);
  if (run->writer) { /* whatever happened: the lock is given up */
    const PetscErrorCode closed = LamRecordWriterClose(&run->writer);

    if (!ierr) ierr = closed;
  }
  PetscCall(ierr);
  PetscCall(TellEnd(run));
  *exit_status = LamStopRequested() ? LamStopExitStatus() : run->failed ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
  PetscCall(Destroy(run));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandRVE(LamArgs *args, int *exit_status)
{
  Run run = {0};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5", "states and fields, for plot and query", &run.out_path},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per state on stdout", &run.json},
      {0, "tangent", LAM_OPTION_FLAG, NULL, "the effective tangent too", &run.tangent},
      {0, "monitor", LAM_OPTION_FLAG, NULL, "each Newton iteration on stderr", &run.monitor},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "rve SCENE [-o OUT.h5] [--json] [--tangent] [--monitor] [--quiet]",
                            "Solves the representative volume element along the scene's load.", options, 1,
                            &run.scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  PetscCall(LamAppInitialize(args));
  if (LamAppIsRoot()) PetscCall(RunOnRoot(&run, exit_status));
  PetscFunctionReturn(0);
}
