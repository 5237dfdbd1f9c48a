/*
  A run of the RVE along the scene's load.
*/
#include "rve_run.h"
#include "clock.h"
#include "plan.h"
#include "lamella_zone.h"
#include "rounding.h"
#include "rve_fields.h"
#include "turgor_stretch.h"
#include <math.h>

/* Fields are written first, so that a committed record always has them. */
static PetscErrorCode WriteState(LamRVERun *run, PetscInt number, const LamResponse *response)
{
  const PetscInt64 key = number;
  const LamRVE rve = run->meshes.rve[0];
  const LamRVEState state = run->meshes.state[0];
  PetscBool mode = PETSC_FALSE;
  char group[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(group, sizeof(group), "/fields/%" PetscInt_FMT, number));
  if (LamResponseHasFields(response)) PetscCall(LamRVEWriteFields(run->writer, group, rve, state, &run->scene->scales));
  if (response->status == LAM_UNSTABLE) PetscCall(LamRVEWriteMode(run->writer, group, rve, state, &mode));
  PetscCall(LamRecordWriterCommit(run->writer, 1, &key, response));
  if (LamResponseHasFields(response)) PetscCall(LamRVEDescribeFields(&run->xdmf, group, rve, number, mode));
  PetscFunctionReturn(0);
}

/* A file holds all members. Wall quantities are needed for failure and to decide whether the error estimate is valid.
 */
static LamWanted Wanted(const LamRVERun *run)
{
  LamWanted wanted = LAM_WANT_STRESS | LAM_WANT_INDICATORS;

  if (run->derivatives || run->readings) wanted |= LAM_WANT_DERIVATIVES;
  if (run->walls || run->find_failure || !run->no_estimate) wanted |= LAM_WANT_WALLS;
  if (run->out_path) wanted = LAM_WANT_ALL;
  return wanted | LAM_WANT_JUMPS;
}

/* What the files of -o would replace. */
static PetscErrorCode CheckTargets(const LamRVERun *run)
{
  PetscFunctionBeginUser;
  if (!run->out_path) PetscFunctionReturn(0);
  PetscCall(LamTargetCheck(run->out_path, "rve", run->overwrite, run->scene));
  PetscCall(LamTargetCheckText(run->out_path, &LamRVETable, run->overwrite, run->scene));
  PetscCall(LamTargetCheckText(run->out_path, &LamXDMFText, run->overwrite, run->scene));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVERunPrepare(LamRVERun *run)
{
  const PetscBool contact = LamCellsPart(run->scene->micro.interface);
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(CheckTargets(run));
  if (run->scene->inflate) run->readings = PETSC_TRUE;
  if (run->scene->dissipating) {
    PetscCheck(!run->second_mesh && !run->find_onset && !run->find_failure && !run->global, PETSC_COMM_SELF,
               PETSC_ERR_USER_INPUT,
               "%s: ramp.dissipation: its loads are not known before: --second-mesh, --onset, --failure and --global "
               "do not go with it",
               run->scene->path);
    run->no_estimate = PETSC_TRUE; /* another mesh finds other loads */
  }
  PetscCheck(!LamWallsRelax(&run->scene->micro) || (!run->find_onset && !run->find_failure && !run->global),
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.wall.relaxation: --onset, --failure and --global look for states beside those of the load, which "
             "have no time; leave them out",
             run->scene->path);
  PetscCheck(run->scene->load_count, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `load`, which says what states to solve", run->scene->path);
  PetscCall(LamPlanMake(run->scene, &plan));
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &run->reporter, &plan.micro, run->scene->accuracy));
  LamWarnOfMesh(PETSC_COMM_WORLD, &run->reporter, run->scene, &plan.trial);
  LamWarnOfTurgor(&run->reporter, run->scene);
  LamWarnOfZone(PETSC_COMM_WORLD, &run->reporter, &plan.micro, &run->scene->scales);
  run->scene->micro = plan.micro;
  if (run->find_failure && contact) run->second_mesh = PETSC_TRUE; /* separation is determined on two meshes */
  if (run->derivatives) run->scene->out_of_plane = PETSC_TRUE;     /* all entries of the tangent */
  PetscCall(LamMeshesCreate(plan.unknowns < LAM_PARALLEL_UNKNOWNS ? PETSC_COMM_SELF : PETSC_COMM_WORLD, run->scene,
                            run->second_mesh ? 2 : 1, &run->meshes));
  PetscCall(LamMeshesSetInterrupt(&run->meshes, LamStopInterrupt, NULL));
  PetscCall(LamMeshesSetWanted(&run->meshes, Wanted(run)));
  PetscCall(LamRVESetMonitor(run->meshes.rve[0], run->monitor));
  if (!run->no_estimate && !run->second_mesh) PetscCall(LamRVEEstimateCreate(run->meshes.rve[0], &run->estimate));
  LamTestCreate(run->scene, &run->test);
  run->crack = LAM_NO_CRACK;
  if (!run->scene->inflate) PetscCall(LamMeshesSeal(&run->meshes, run->scene, &run->scene->loads[0]));
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

static void CountDoubts(LamRVERun *run, const LamResponse *response)
{
  if (response->error_estimate > run->scene->accuracy) run->inaccurate++;
  if (run->estimate && LamResponseHasFields(response) && isnan(response->error_estimate)) run->unknown++;
  if (!(response->kinked_fraction > LAM_KINKED_SHARE)) return;
  run->kinked++;
  run->most_kinked = PetscMax(run->most_kinked, response->kinked_fraction);
}

/* The largest principal Cauchy stress in the plane. */
static PetscReal LargestTension(const LamResponse *response)
{
  const PetscReal *F = response->load.F, *P = response->P, J = (F[0] * F[4] - F[1] * F[3]) * F[8];
  const PetscReal s11 = P[0] * F[0] + P[1] * F[1], s22 = P[3] * F[3] + P[4] * F[4], s12 = P[0] * F[3] + P[1] * F[4];

  return (0.5 * (s11 + s22) + hypot(0.5 * (s11 - s22), s12)) / J;
}

/* The Cauchy stress of cohesion, in all directions; where cells differ that of the gaps that are open. */
static PetscReal Suction(const LamMicrostructure *micro, const LamResponse *response)
{
  return response->load.cohesion * (micro->cell ? response->energy_cohesion / response->opening_fraction : 1);
}

#define OPEN_SHARE 0.5    /* of the interface: its cells have come apart, not their junctions alone */
#define SUCTION_ALONE 0.9 /* of the suction: walls that touch take less than a tenth of it away */

/*
  Once, of cells that have come apart and are still pulled by the cohesion of law `contact`. Walls that touch push: they
  can only lower the stress below the suction g, and where its largest principal value is g none touch across a line.
  The held walls of a patch pull, too.
*/
static void WarnOfSuction(LamRVERun *run, const LamResponse *response)
{
  const LamScene *scene = run->scene;

  if (run->warned_of_suction || scene->micro.interface != LAM_INTERFACE_CONTACT) return;
  if (!LamResponseHasFields(response) || !(response->load.cohesion > 0)) return;
  if (!(response->open_fraction > OPEN_SHARE)) return;
  if (!(LargestTension(response) > SUCTION_ALONE * Suction(&scene->micro, response))) return;
  run->warned_of_suction = PETSC_TRUE;
  LamReportWarning(&run->reporter,
                   "%s: cohesion: %.4g MPa: still pulls at cells that have come apart (state %d, %.0f %% of the "
                   "interface open): with law: contact it is a suction that acts at any gap and never ends; law: "
                   "lamella, with strength and fracture_energy, gives it a range and an energy",
                   scene->path, (double)(response->load.cohesion * scene->scales.stress * 1e-6), (int)run->solved,
                   (double)(100 * response->open_fraction));
}

static void ReportDoubts(const LamRVERun *run)
{
  if (run->inaccurate)
    LamReportNote(&run->reporter,
                  "the estimated error of %d of %d states exceeds the wanted accuracy of %.2g %%: write a finer "
                  "rve.mesh (it is %d x %d)",
                  (int)run->inaccurate, (int)run->solved, (double)(100 * run->scene->accuracy),
                  (int)run->scene->micro.along, (int)run->scene->micro.through);
  if (run->unknown)
    LamReportNote(
        &run->reporter, "the error of %d of %d states is not known: %s", (int)run->unknown, (int)run->solved,
        run->scene->sealed
            ? "it is not estimated for sealed cells"
            : "a finer mesh has no state near theirs; it has another branch there, and these depend on the mesh");
  if (run->kinked)
    LamReportNote(
        &run->reporter,
        "in %d of %d states walls are compressed along their fibres beyond C4 (1 - I4) > C1 + C2, in "
        "up to %.2g %% of their volume: they kink on the scale of the mesh, and the estimate of the error, though "
        "taken larger there, is no more than a guess; walls with `fibres: tension` have no such limit",
        (int)run->kinked, (int)run->solved, (double)(100 * run->most_kinked));
}

const LamStressControl *LamRVERunControl(const LamRVERun *run, PetscInt number)
{
  return run->scene->controls ? &run->scene->controls[number - 1] : NULL;
}

/* After the first state of a load from the inflated tissue: what follows counts from there. Cells that are sealed in
   it, and walls that have relaxed in it, are stiffer at once than when it was found: it is solved again, where it is.
 */
static PetscErrorCode StartFromInflated(LamRVERun *run, LamResponse inflated[2])
{
  LamLoad load = inflated->load;

  PetscFunctionBeginUser;
  if (!LamResponseHasFields(inflated)) {
    LamReportNote(&run->reporter, "the tissue that is free of stress was not found, and what follows counts from it: "
                                  "it is not solved");
    run->scene->load_count = 1;
    PetscFunctionReturn(0);
  }
  LamLoadsFromInflated(run->scene, load.F);
  if (!run->scene->sealed) PetscFunctionReturn(0);
  PetscCall(LamMeshesSeal(&run->meshes, run->scene, &load));
  load.duration = 0;
  PetscCall(LamMeshesSolve(&run->meshes, &load, NULL, inflated));
  PetscFunctionReturn(0);
}

/* Whether the next state is one of a ramp that is followed by what is dissipated. */
static PetscBool Dissipates(const LamRVERun *run)
{
  return (PetscBool)(run->solved >= run->scene->load_count - run->scene->dissipating);
}

/* The next state of such a ramp, which ends where its end is reached or a state is not found. */
static PetscErrorCode Dissipate(LamRVERun *run, LamResponse *response)
{
  LamScene *scene = run->scene;
  const PetscInt first = scene->load_count - scene->dissipating;
  const LamDissipationPath path = {.from = scene->loads[first - 1],
                                   .to = scene->loads[scene->load_count - 1],
                                   .most = 1 / (PetscReal)scene->dissipating,
                                   .faces = scene->dissipated_faces};

  PetscFunctionBeginUser;
  PetscCall(LamMeshesDissipate(&run->meshes, &path, &run->reached, response));
  if (response->status == LAM_CONVERGED && run->reached.share < 1) PetscFunctionReturn(0);
  scene->load_count = run->solved + 1;
  scene->dissipating = scene->load_count - first;
  PetscFunctionReturn(0);
}

/* The next state of the load; the time of states before it that were not found passes with it. */
static PetscErrorCode SolveNext(LamRVERun *run, LamResponse responses[2])
{
  LamLoad load = run->scene->loads[run->solved];

  PetscFunctionBeginUser;
  load.duration += run->missed;
  PetscCall(LamMeshesSolve(&run->meshes, &load, LamRVERunControl(run, run->solved + 1), responses));
  run->missed = LamResponseHasFields(&responses[0]) ? 0 : load.duration;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVERunNext(LamRVERun *run, LamResponse responses[2])
{
  PetscFunctionBeginUser;
  if (Dissipates(run))
    PetscCall(Dissipate(run, responses));
  else
    PetscCall(SolveNext(run, responses));
  if (run->global) PetscCall(LamMeshesSearch(&run->meshes, run->scene->strategy, &responses[0]));
  if (run->meshes.stopped) PetscFunctionReturn(0);
  if (run->scene->inflate && !run->solved) PetscCall(StartFromInflated(run, responses));
  if (run->estimate) PetscCall(LamRVEEstimateError(run->estimate, run->meshes.state[0], &responses[0]));
  run->time += run->scene->loads[run->solved].duration;
  run->solved++;
  if (run->readings || run->writer)
    PetscCall(LamTestAdd(&run->test, run->solved, &responses[0], LamRVERunControl(run, run->solved)));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveStates(LamRVERun *run)
{
  PetscFunctionBeginUser;
  LamActivitySet("states");
  PetscCall(LamReportProgress(&run->reporter, run->solved, run->scene->load_count, 0));
  while (run->solved < run->scene->load_count && !LamStopRequested()) {
    LamResponse responses[2];

    PetscCall(LamRVERunNext(run, responses));
    if (run->meshes.stopped) break;
    if (responses[0].status != LAM_CONVERGED) run->failed++;
    CountDoubts(run, &responses[0]);
    WarnOfSuction(run, &responses[0]);
    LamCrackAdd(&run->crack, &run->scene->micro, run->solved, &responses[0]);
    if (run->find_onset) PetscCall(LamOnsetWatch(&run->onset, &run->meshes, run->solved, responses));
    if (run->find_failure) PetscCall(LamFailureWatch(&run->failure, &run->meshes, run->solved, responses));
    if (run->writer) {
      PetscCall(WriteState(run, run->solved, &responses[0]));
      LamRVECSVAdd(run, &responses[0]);
    }
    if (run->state) PetscCall(run->state(run->reporter.ctx, run, responses));
    PetscCall(LamReportProgress(&run->reporter, run->solved, run->scene->load_count, run->failed));
  }
  ReportDoubts(run);
  PetscFunctionReturn(0);
}

/* What was read off the curve, for pictures. */
static PetscErrorCode WriteTest(LamRVERun *run)
{
  json_t *read;
  char *text;

  PetscFunctionBeginUser;
  if (run->test.count < 2) PetscFunctionReturn(0);
  read = LamTestToJSON(&run->test, 0, NULL);
  text = json_dumps(read, 0);
  json_decref(read);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the readings");
  PetscCall(LamRecordWriterText(run->writer, "/test", text));
  free(text);
  PetscFunctionReturn(0);
}

/* When the states were reached, of walls with memory. */
static PetscErrorCode WriteTimes(LamRVERun *run)
{
  const PetscInt n = run->solved;
  PetscReal *times, time = 0;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  if (!n || !LamWallsRelax(&run->scene->micro)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &times));
  for (PetscInt k = 0; k < n; k++) times[k] = time += run->scene->loads[k].duration;
  ierr = LamRecordWriterReals(run->writer, "/time", 1, &n, times, "s");
  PetscCall(PetscFree(times));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVERunSolve(LamRVERun *run)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (run->out_path) {
    PetscCall(LamRecordWriterOpen(run->out_path, "rve", LamTargetMode(run->overwrite), run->scene, &run->writer));
    ierr = LamRVEWriteMesh(run->writer, "/mesh", run->meshes.rve[0]);
    if (!ierr) ierr = LamRVECSVOpen(run);
    if (!ierr) ierr = LamXDMFOpen(run->out_path, "states", &run->xdmf);
  }
  if (!ierr) ierr = SolveStates(run);
  if (!ierr && run->writer) ierr = WriteTest(run);
  if (!ierr && run->writer) ierr = WriteTimes(run);
  if (run->csv.out) {
    const PetscErrorCode written = LamBesideClose(&run->csv);

    if (!ierr) ierr = written;
  }
  if (run->xdmf.file.out) {
    const PetscErrorCode written = LamXDMFClose(&run->xdmf);

    if (!ierr) ierr = written;
  }
  if (run->writer) { /* also after an error, to release the lock */
    const PetscErrorCode closed = LamRecordWriterClose(&run->writer);

    if (!ierr) ierr = closed;
  }
  PetscCall(ierr);
  if (run->find_onset) PetscCall(LamOnsetFind(&run->onset, &run->meshes, run->scene->load_count));
  if (run->find_failure) PetscCall(LamFailureConclude(&run->failure));
  PetscCall(LamCrackConclude(&run->crack, &run->scene->micro, &run->scene->loads[0]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVERunDestroy(LamRVERun *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamOnsetDestroy(&run->onset));
  PetscCall(LamFailureDestroy(&run->failure));
  PetscCall(LamTestDestroy(&run->test));
  PetscCall(LamRVEEstimateDestroy(&run->estimate));
  PetscCall(LamMeshesDestroy(&run->meshes));
  PetscCall(LamSceneDestroy(&run->scene));
  PetscFunctionReturn(0);
}
