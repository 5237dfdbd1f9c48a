/*
  lamella rve: solves the RVE along the scene's load.

  Each state starts from the last converged one, so the states are sequential and rank 0 solves them; further ranks help
  to factor the matrices of large RVEs, otherwise they wait.
*/
#include "app.h"
#include "rounding.h"
#include "failure_print.h"
#include "rve_fields.h"
#include "clock.h"
#include <math.h>
#include <string.h>

typedef struct {
  const char *scene_path, *out_path;
  PetscBool tangent, monitor, second_mesh, find_onset, find_failure, no_estimate;

  LamScene *scene;
  LamMeshes meshes;        /* the scene's, and with --second-mesh a finer one */
  LamRVEEstimate estimate; /* NULL: no estimate */
  LamOnset onset;
  LamFailure failure;
  LamRecordWriter writer; /* NULL without -o */
  LamConsole console;
  PetscInt solved, failed;
  PetscInt inaccurate; /* number of states whose estimated error exceeds the prescribed accuracy */
  PetscInt kinked;     /* number of states in which too much of the walls has kinked for an estimate */
  PetscReal most_kinked;
  PetscReal start;
} Run;

/* ---- the file ---- */

/* Fields are written first, so that a committed record always has them. */
static PetscErrorCode WriteState(Run *run, PetscInt number, const LamResponse *response)
{
  const PetscInt64 key = number;
  char group[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(group, sizeof(group), "/fields/%" PetscInt_FMT, number));
  if (LamResponseHasFields(response))
    PetscCall(LamRVEWriteFields(run->writer, group, run->meshes.rve[0], run->meshes.state[0], &run->scene->scales));
  if (response->status == LAM_UNSTABLE)
    PetscCall(LamRVEWriteMode(run->writer, group, run->meshes.rve[0], run->meshes.state[0]));
  PetscCall(LamRecordWriterCommit(run->writer, 1, &key, response));
  PetscFunctionReturn(0);
}

/* ---- reports ---- */

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

/* Prints separation and error estimate from the second mesh. */
static void PrintSecondMesh(const LamResponse responses[2])
{
  const LamSeparation separation = LamSeparationOf(responses);

  if (!LamResponseHasFields(&responses[0])) return;
  if (separation == LAM_SEPARATION_UNKNOWN) {
    printf("      second mesh: %s: %s\n", LamStatusNames[responses[1].status], responses[1].reason);
    return;
  }
  printf("      second mesh: P differs by %.2g %%, debonded by %.2g, open by %.2g; ",
         (double)(100 * responses[0].error_estimate), (double)responses[0].debonded_spread,
         (double)responses[0].open_spread);
  if (separation == LAM_SEPARATION_NONE)
    printf("not separated\n");
  else
    printf("separated (%s)\n", LamSeparationNames[separation]);
}

static void SetSecondMesh(json_t *object, const LamResponse responses[2])
{
  const LamSeparation separation = LamSeparationOf(responses);

  json_object_set_new(object, "separated",
                      separation == LAM_SEPARATION_UNKNOWN ? json_null()
                                                           : json_boolean(separation != LAM_SEPARATION_NONE));
  if (!LamResponseHasFields(&responses[1]))
    json_object_set_new(object, "second_mesh_reason", json_string(responses[1].reason));
}

/* The prescribed stress of a state; NULL: none. */
static const LamStressControl *Control(const Run *run, PetscInt number)
{
  return run->scene->controls ? &run->scene->controls[number - 1] : NULL;
}

/* The prescribed components of P; null where F is prescribed. */
static void SetPrescribed(json_t *object, const LamStressControl *control, PetscReal MPa)
{
  PetscReal P[9];
  PetscBool any = PETSC_FALSE;

  for (int i = 0; i < 9 && control; i++) {
    P[i] = control->given[i] ? control->P[i] : NAN;
    if (control->given[i]) any = PETSC_TRUE;
  }
  if (any) json_object_set_new(object, "P_prescribed", LamJSONReals(9, P, MPa));
}

/* For a period of several cells: whether the pattern has that period or the one of a single cell. */
static PetscErrorCode SetCellDifference(json_t *object, const Run *run, const LamResponse *response)
{
  const LamMicrostructure *micro = &run->scene->micro;
  PetscReal difference;

  PetscFunctionBeginUser;
  if (micro->is_patch || micro->cells[0] * micro->cells[1] == 1 || !LamResponseHasFields(response))
    PetscFunctionReturn(0);
  PetscCall(LamRVEGetCellDifference(run->meshes.rve[0], run->meshes.state[0], &difference));
  json_object_set_new(object, "cell_difference", json_real(difference));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tell(Run *run, PetscInt number, const LamResponse responses[2])
{
  const LamScales *scales = &run->scene->scales;
  json_t *object;

  PetscFunctionBeginUser;
  if (run->console.json) {
    PetscCall(LamResponseToJSON(&responses[0], scales, number, run->tangent, &object));
    SetPrescribed(object, Control(run, number), scales->stress * 1e-6);
    PetscCall(SetCellDifference(object, run, &responses[0]));
    if (run->second_mesh) SetSecondMesh(object, responses);
    PetscCall(LamPrintJSON(object));
    PetscFunctionReturn(0);
  }
  PetscCall(LamPrintResponseRow(&responses[0], scales, run->scene->micro.interface, number));
  if (run->second_mesh) PrintSecondMesh(responses);
  if (run->find_failure) PetscCall(LamFailurePrintState(&responses[0], &run->scene->strength, scales));
  if (run->tangent) PrintTangent(&responses[0], scales->stress * 1e-6);
  PetscFunctionReturn(0);
}

static PetscErrorCode TellEnd(const Run *run)
{
  PetscFunctionBeginUser;
  if (run->console.json) PetscFunctionReturn(0);
  printf("%" PetscInt_FMT " of %" PetscInt_FMT " states solved, %" PetscInt_FMT " failed, %.3g s\n",
         run->solved - run->failed, run->scene->load_count, run->failed, LamClock() - run->start);
  if (run->out_path) printf("wrote %s\n", run->out_path);
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

/* PETSC_FALSE, with a message, if an option requests something that bonded tissue does not have. */
static PetscBool OptionsFit(const Run *run)
{
  if (!run->second_mesh || run->scene->micro.interface == LAM_INTERFACE_CONTACT) return PETSC_TRUE;
  fprintf(stderr,
          "lamella rve: %s: the cells of %s are bonded and never separate; leave it out, or write law: contact\n",
          run->find_onset ? "--onset" : "--second-mesh", run->scene_path);
  return PETSC_FALSE;
}

/* A file holds all members. Rows of the table show no tangents; wall quantities are needed for --failure and to
   decide whether the error estimate is valid. */
static LamWanted Wanted(const Run *run)
{
  LamWanted wanted = LAM_WANT_STRESS | LAM_WANT_INDICATORS;

  if (run->tangent) wanted |= LAM_WANT_DERIVATIVES;
  if (run->console.json || run->find_failure || !run->no_estimate) wanted |= LAM_WANT_WALLS;
  return run->out_path ? LAM_WANT_ALL : wanted;
}

static PetscErrorCode Prepare(Run *run)
{
  const PetscBool contact = (PetscBool)(run->scene->micro.interface == LAM_INTERFACE_CONTACT);
  const LamReporter reporter = LamConsoleReporter(&run->console);
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCheck(run->scene->load_count, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `load`, which says what states to solve", run->scene_path);
  PetscCall(LamPlanMake(run->scene, &plan));
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &reporter, &plan.micro, run->scene->accuracy));
  run->scene->micro = plan.micro;
  if (run->find_failure && contact) run->second_mesh = PETSC_TRUE; /* separation is determined on two meshes */
  PetscCall(LamMeshesCreate(plan.unknowns < LAM_PARALLEL_UNKNOWNS ? PETSC_COMM_SELF : PETSC_COMM_WORLD, run->scene,
                            run->second_mesh ? 2 : 1, &run->meshes));
  PetscCall(LamMeshesSetInterrupt(&run->meshes, LamStopInterrupt, NULL));
  PetscCall(LamMeshesSetWanted(&run->meshes, Wanted(run)));
  PetscCall(LamRVESetMonitor(run->meshes.rve[0], run->monitor));
  if (!run->no_estimate && !run->second_mesh) PetscCall(LamRVEEstimateCreate(run->meshes.rve[0], &run->estimate));
  PetscCall(LamMeshesSeal(&run->meshes, run->scene, &run->scene->loads[0]));
  if (run->find_onset) PetscCall(LamOnsetCreate(&run->meshes, &run->onset));
  if (run->find_failure) {
    const LamFailureProgram program = {.interface = run->scene->micro.interface,
                                       .strength = &run->scene->strength,
                                       .count = run->scene->load_count,
                                       .loads = run->scene->loads,
                                       .controls = run->scene->controls};

    PetscCall(LamFailureCreate(&run->meshes, &program, &run->failure));
  }
  PetscFunctionReturn(0);
}

static void CountDoubts(Run *run, const LamResponse *response)
{
  if (response->error_estimate > run->scene->accuracy) run->inaccurate++;
  if (!(response->kinked_fraction > LAM_KINKED_SHARE)) return;
  run->kinked++;
  run->most_kinked = PetscMax(run->most_kinked, response->kinked_fraction);
}

static void TellDoubts(const Run *run)
{
  if (run->inaccurate)
    fprintf(stderr,
            "lamella rve: the estimated error of %d of %d states exceeds the wanted accuracy of %.2g %%: write a finer "
            "rve.mesh (it is %d x %d)\n",
            (int)run->inaccurate, (int)run->solved, (double)(100 * run->scene->accuracy), (int)run->scene->micro.along,
            (int)run->scene->micro.through);
  if (run->kinked)
    fprintf(stderr,
            "lamella rve: in %d of %d states walls are compressed along their fibres beyond C4 (1 - I4) > C1 + C2, in "
            "up to %.2g %% of their volume: they kink on the scale of the mesh, and the estimate of the error, though "
            "taken larger there, is no more than a guess; walls with `fibres: tension` have no such limit\n",
            (int)run->kinked, (int)run->solved, (double)(100 * run->most_kinked));
}

static PetscErrorCode SolveStates(Run *run)
{
  const LamReporter reporter = LamConsoleReporter(&run->console);

  PetscFunctionBeginUser;
  run->console.has_rows = (PetscBool)(run->monitor || !run->console.json);
  if (!run->console.json) PetscCall(LamPrintResponseHeader(run->scene->micro.interface));
  while (run->solved < run->scene->load_count && !LamStopRequested()) {
    LamResponse responses[2];

    PetscCall(LamMeshesSolve(&run->meshes, &run->scene->loads[run->solved], Control(run, run->solved + 1), responses));
    if (run->meshes.stopped) break;
    if (run->estimate) PetscCall(LamRVEEstimateError(run->estimate, run->meshes.state[0], &responses[0]));
    run->solved++;
    if (responses[0].status != LAM_CONVERGED) run->failed++;
    CountDoubts(run, &responses[0]);
    if (run->find_onset) PetscCall(LamOnsetWatch(&run->onset, &run->meshes, run->solved, responses));
    if (run->find_failure) PetscCall(LamFailureWatch(&run->failure, &run->meshes, run->solved, responses));
    if (run->writer) PetscCall(WriteState(run, run->solved, &responses[0]));
    PetscCall(Tell(run, run->solved, responses));
    PetscCall(LamReportProgress(&reporter, run->solved, run->scene->load_count, run->failed));
  }
  LamConsoleClear(&run->console);
  if (!run->console.quiet) TellDoubts(run);
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamOnsetDestroy(&run->onset));
  PetscCall(LamFailureDestroy(&run->failure));
  PetscCall(LamRVEEstimateDestroy(&run->estimate));
  PetscCall(LamMeshesDestroy(&run->meshes));
  PetscCall(LamSceneDestroy(&run->scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode FindOnset(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamOnsetFind(&run->onset, &run->meshes, run->scene->load_count));
  PetscCall(LamOnsetPrint(&run->onset, &run->scene->scales, run->console.json));
  PetscFunctionReturn(0);
}

static PetscErrorCode TellFailure(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamFailureConclude(&run->failure));
  PetscCall(LamFailurePrint(&run->failure, &run->scene->scales, run->console.json));
  PetscFunctionReturn(0);
}

static int ExitStatus(const Run *run)
{
  if (LamStopRequested()) return LamStopExitStatus();
  if (run->failed || LamOnsetIsUnsolved(&run->onset)) return LAM_EXIT_UNSOLVED;
  return run->failure.mode == LAM_FAILURE_UNKNOWN ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
}

static PetscErrorCode RunOnRoot(Run *run, int *exit_status)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  run->start = LamClock();
  PetscCall(LamSceneRead(run->scene_path, &run->scene));
  if (!OptionsFit(run)) {
    *exit_status = LAM_EXIT_USAGE;
    PetscCall(Destroy(run));
    PetscFunctionReturn(0);
  }
  PetscCall(Prepare(run));
  if (run->out_path) {
    PetscCall(LamRecordWriterOpen(run->out_path, "rve", LAM_WRITE_CREATE, run->scene, &run->writer));
    ierr = LamRVEWriteMesh(run->writer, "/mesh", run->meshes.rve[0]);
  }
  if (!ierr) ierr = SolveStates(run);
  if (run->writer) { /* also after an error, to release the lock */
    const PetscErrorCode closed = LamRecordWriterClose(&run->writer);

    if (!ierr) ierr = closed;
  }
  PetscCall(ierr);
  if (run->find_onset) PetscCall(FindOnset(run));
  if (run->find_failure) PetscCall(TellFailure(run));
  PetscCall(TellEnd(run));
  *exit_status = ExitStatus(run);
  PetscCall(Destroy(run));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandRVE(LamArgs *args, int *exit_status)
{
  Run run = {.console.command = "rve"};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5", "states and fields, for plot and query", &run.out_path},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per state on stdout", &run.console.json},
      {0, "tangent", LAM_OPTION_FLAG, NULL, "the effective tangent too", &run.tangent},
      {0, "second-mesh", LAM_OPTION_FLAG, NULL,
       "solve contact tissue on a mesh with twice the elements along a face, too: errors, and whether cells separate",
       &run.second_mesh},
      {0, "onset", LAM_OPTION_FLAG, NULL,
       "find where along the load the cells begin to separate, on two meshes (includes --second-mesh)",
       &run.find_onset},
      {0, "failure", LAM_OPTION_FLAG, NULL,
       "what walls and lamella bear, and how the tissue fails first along the load (contact: includes --second-mesh)",
       &run.find_failure},
      {0, "no-estimate", LAM_OPTION_FLAG, NULL, "no estimate of the error: a tenth to a quarter less time",
       &run.no_estimate},
      {0, "monitor", LAM_OPTION_FLAG, NULL, "each Newton iteration on stderr", &run.monitor},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "rve SCENE [-o OUT.h5] [--json] [--tangent] [--second-mesh] [--onset] [--failure] "
                            "[--no-estimate] [--monitor]\n           [--quiet]",
                            "Solves the representative volume element along the scene's load.", options, 1,
                            &run.scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (run.find_onset) run.second_mesh = PETSC_TRUE;
  PetscCall(args->start(args));
  if (LamAppIsRoot()) {
    const PetscErrorCode ierr = RunOnRoot(&run, exit_status);

    PetscCall(LamRVEDismiss(PETSC_COMM_WORLD));
    PetscCall(ierr);
  } else {
    PetscCall(LamRVEServe(PETSC_COMM_WORLD, LamStopInterrupt, NULL));
  }
  PetscFunctionReturn(0);
}
