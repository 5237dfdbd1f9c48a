/*
  What the commands of a scene cost.

  Method. Each command that the scene has a block for is begun in this process, without files, until a given share of
  processor time has passed. Where it ends before, its time is known. Otherwise the time is extrapolated from what has
  been done: states of a load, paths of a map, nodes of a table, time of a process, solves of the points of a body.
  Costs of a state are those of the last half, as the first ones are those of small strains.
*/
#include "build_run.h"
#include "clock.h"
#include "map.h"
#include "plan.h"
#include "process_run.h"
#include "rve_run.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

/* Solves per material point and load step: 3 to 4 Newton iterations. */
#define ANSWERS_PER_STEP 3.5
/* Larger RVEs take long until one of their factorisations ends, which nothing interrupts: 0.3 s. */
#define MOST_UNKNOWNS 40000
/* Resident memory, MB: the program with its libraries; matrix, factor and mesh per unknown; for contact tissue
   including the bonded RVE from which it starts. */
#define PROGRAM_MB 50.0
#define UNKNOWN_MB 0.0015
#define CONTACT_UNKNOWN_MB 0.003

typedef struct {
  const LamScene *scene;
  const LamPlan *plan, *regions; /* [region] */
} Planned;

static void TakeMesh(const LamPlan *plan, LamMicrostructure *micro)
{
  micro->along = plan->micro.along;
  micro->through = plan->micro.through;
  micro->grading = plan->micro.grading;
}

/* The scene once more, with the meshes of the plans. */
static PetscErrorCode Read(const Planned *planned, LamScene **copy)
{
  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(planned->scene->path, copy));
  TakeMesh(planned->plan, &(*copy)->micro);
  for (PetscInt r = 0; r < (*copy)->region_count; r++) TakeMesh(&planned->regions[r], &(*copy)->regions[r].micro);
  PetscFunctionReturn(0);
}

/* Of n equal parts `done` have taken `seconds`. */
static LamPrediction Extrapolate(PetscReal done, PetscReal n, PetscReal seconds)
{
  return (LamPrediction){.share = done / n, .seconds = done > 0 ? seconds * n / done : NAN};
}

/* ---- the commands ---- */

static PetscErrorCode TryLoad(const Planned *planned, LamPrediction *p)
{
  LamRVERun run = {0};
  PetscReal begin = LamProcessorClock(), *ends;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(Read(planned, &run.scene));
  PetscCall(LamRVERunPrepare(&run));
  PetscCall(PetscMalloc1(run.scene->load_count, &ends));
  while (run.solved < run.scene->load_count && !LamStopRequested()) {
    LamResponse responses[2];

    PetscCall(LamRVERunNext(&run, responses));
    if (run.meshes.stopped) break;
    ends[run.solved - 1] = LamProcessorClock() - begin;
  }
  n = run.solved;
  *p = (LamPrediction){.share = (PetscReal)n / (PetscReal)run.scene->load_count, .seconds = NAN};
  if (n) {
    const PetscInt half = n / 2;
    const PetscReal recent = (ends[n - 1] - (half ? ends[half - 1] : 0)) / (PetscReal)(n - half);
    const PetscReal next = PetscMax(recent, LamProcessorClock() - begin - ends[n - 1]); /* the one that was given up */

    p->seconds = ends[n - 1] + (n < run.scene->load_count ? next * (PetscReal)(run.scene->load_count - n) : 0);
  }
  PetscCall(PetscFree(ends));
  PetscCall(LamRVERunDestroy(&run));
  PetscFunctionReturn(0);
}

/* Into a file that is removed. */
static PetscErrorCode TryTable(const Planned *planned, LamPrediction *p)
{
  const LamScene *scene = planned->scene;
  const char *parent = getenv("TMPDIR");
  char folder[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN];
  LamBuild build = {.path = path, .team_size = 1, .shard = {1, 1}};
  const PetscReal begin = LamProcessorClock();
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(folder, sizeof(folder), "%s/lamella-XXXXXX", parent ? parent : "/tmp"));
  PetscCheck(mkdtemp(folder), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
             "%s: no folder for a table that is begun can be made there; set TMPDIR to one that can be written",
             parent ? parent : "/tmp");
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/begun.h5", folder));
  ierr = Read(planned, &build.scene);
  if (!ierr) build.scene->micro.relaxation.terms = 0; /* a table is of the walls at once */
  if (!ierr) ierr = LamBuildTable(&build);
  if (!ierr) {
    const PetscReal done = (PetscReal)LamRoundsAvailable(&build.rounds);

    if (!LamStopRequested())
      *p = Extrapolate(1, 1, LamProcessorClock() - begin);
    else if (scene->sample.count)
      *p = Extrapolate(done, (PetscReal)build.rounds.most, LamProcessorClock() - begin);
  }
  if (!ierr) ierr = LamBuildDestroy(&build);
  (void)unlink(path);
  (void)rmdir(folder);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscBool IsCoprime(PetscInt a, PetscInt b)
{
  while (b) {
    const PetscInt rest = a % b;

    a = b;
    b = rest;
  }
  return (PetscBool)(a == 1);
}

/* Paths from all over the map: those that end early are cheap. */
static PetscErrorCode TryMap(const Planned *planned, LamPrediction *p)
{
  const LamScene *scene = planned->scene;
  const PetscReal begin = LamProcessorClock();
  const PetscInt n = LamMapPathCount(scene);
  PetscInt stride = (PetscInt)(0.618 * (PetscReal)n), done = 0;
  PetscReal spent = 0;
  LamMapPoint *points;
  LamScene *own;

  PetscFunctionBeginUser;
  PetscCall(Read(planned, &own));
  if (LamMapVariesWalls(scene)) own->micro = scene->micro;
  PetscCall(PetscMalloc1(LamMapCutCount(scene), &points));
  for (stride = PetscMax(stride, 1); !IsCoprime(stride, n);) stride++; /* visits all, neighbours late */
  for (PetscBool complete = PETSC_TRUE; done < n && complete && !LamStopRequested();) {
    PetscCall(LamMapFollow(own, done * stride % n, LamStopInterrupt, NULL, points, &complete));
    if (!complete || LamStopRequested()) break;
    done++;
    spent = LamProcessorClock() - begin;
  }
  *p = Extrapolate((PetscReal)done, (PetscReal)n, spent);
  PetscCall(PetscFree(points));
  PetscCall(LamSceneDestroy(&own));
  PetscFunctionReturn(0);
}

/* Solves of all material points until now. */
static PetscInt64 CountSolves(const LamFE2Run *run)
{
  PetscInt64 solves = 0;

  for (PetscInt t = 0; t < run->tissues.count; t++)
    if (run->tissues.tissues[t].direct) solves += LamResponderGetCounters(run->tissues.tissues[t].direct).solves;
  return solves;
}

typedef struct {
  LamFE2Run run;
  PetscReal begin, spent; /* at the start, and until the last complete step */
  PetscInt steps;         /* complete, the inflation not among them */
} Body;

/* `step` of a LamFE2Run. */
static PetscErrorCode CountStep(void *ctx, const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  Body *body = (Body *)ctx;

  PetscFunctionBeginUser;
  (void)run;
  (void)peak_memory;
  if (!step->complete) PetscFunctionReturn(0);
  body->steps = step->step;
  body->spent = LamProcessorClock();
  PetscFunctionReturn(0);
}

/* By its steps, or by the solves of the first one. */
static PetscErrorCode TryBody(const Planned *planned, LamPrediction *p)
{
  const LamScene *scene = planned->scene;
  const PetscReal steps = (PetscReal)scene->macro.steps;
  Body body = {.run = LAM_FE2_RUN};
  LamFE2Run *run = &body.run;
  PetscInt points;
  PetscBool finished;
  PetscInt64 solves;

  PetscFunctionBeginUser;
  run->comm = PETSC_COMM_SELF;
  run->scene_path = scene->path;
  run->step = CountStep;
  run->step_ctx = &body;
  PetscCall(Read(planned, &run->scene));
  PetscCall(LamFE2Prepare(run, &finished));
  PetscCall(LamMacroGetPointCount(run->macro, &points));
  body.begin = LamProcessorClock();
  PetscCall(LamFE2Solve(run));
  solves = CountSolves(run);
  if (body.steps)
    *p = Extrapolate((PetscReal)body.steps, steps, body.spent - body.begin);
  else
    *p = Extrapolate((PetscReal)solves, ANSWERS_PER_STEP * (PetscReal)points * steps, LamProcessorClock() - body.begin);
  PetscCall(LamFE2Destroy(run));
  PetscFunctionReturn(0);
}

/* By the time reached. */
static PetscErrorCode AddState(void *ctx, const LamProcessStudy *study)
{
  LamPrediction *p = (LamPrediction *)ctx;

  PetscFunctionBeginUser;
  p->share = study->history.states[study->history.count - 1].time / study->scene->process.duration;
  p->seconds = LamProcessorClock();
  PetscFunctionReturn(0);
}

static PetscErrorCode AddBodyState(void *ctx, const LamBodyStudy *study, const LamBodyState *state, PetscReal memory)
{
  LamPrediction *p = (LamPrediction *)ctx;

  PetscFunctionBeginUser;
  (void)memory;
  p->share = state->time / study->fe2.scene->process.duration;
  p->seconds = LamProcessorClock();
  PetscFunctionReturn(0);
}

static PetscErrorCode TryProcess(const Planned *planned, LamPrediction *p)
{
  const LamScene *scene = planned->scene;
  LamPrediction reached = {.seconds = NAN};
  LamBodyStudy body = {.fe2 = LAM_FE2_RUN, .state = AddBodyState};
  const PetscReal begin = LamProcessorClock();
  PetscBool ended; /* before its duration too: as the command will */

  PetscFunctionBeginUser;
  body.fe2.comm = PETSC_COMM_SELF;
  body.fe2.scene_path = scene->path;
  body.fe2.step_ctx = &reached;
  PetscCall(Read(planned, &body.fe2.scene));
  if (scene->has_macro) {
    PetscCall(LamBodyStudyPrepare(&body));
    PetscCall(LamBodyStudySolve(&body));
    ended = (PetscBool)(body.reason != LAM_PROCESS_STOPPED);
  } else {
    LamProcessStudy point = {.response = body.fe2, .scene = body.fe2.scene, .state = AddState};

    PetscCall(LamProcessStudyRun(&point));
    ended = (PetscBool)(point.reason != LAM_PROCESS_STOPPED);
  }
  PetscCall(LamBodyStudyDestroy(&body));
  *p = ended ? Extrapolate(1, 1, LamProcessorClock() - begin) : Extrapolate(reached.share, 1, reached.seconds - begin);
  PetscFunctionReturn(0);
}

/* ---- all ---- */

const char *const LamPlannedNames[] = {LAM_PLANNED(LAM_NAME_ENTRY)};

PetscErrorCode LamPlanCost(const LamScene *scene, const LamPlan *plan, const LamPlan regions[], PetscReal seconds,
                           LamCost *cost)
{
  static PetscErrorCode (*const tries[])(const Planned *, LamPrediction *) = {TryLoad, TryTable, TryMap, TryBody,
                                                                              TryProcess};
  const PetscBool history = (PetscBool)(scene->micro.interface == LAM_INTERFACE_LAMELLA);
  const PetscBool has[] = {(PetscBool)(scene->load_count > 0), (PetscBool)(scene->has_sample && !history),
                           scene->has_map, (PetscBool)(scene->has_macro && !LamWallsRelax(&scene->micro)),
                           scene->has_process};
  const PetscReal n = (PetscReal)plan->unknowns, before = LamProcessorClock(), end = before + seconds;
  const Planned planned = {scene, plan, regions};
  PetscInt left = 0;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  /* each material point stores its positions, accepted and trial */
  cost->memory = PROGRAM_MB + (LamCellsPart(plan->micro.interface) ? CONTACT_UNKNOWN_MB : UNKNOWN_MB) * n +
                 (PetscReal)plan->macro_points * 2 * sizeof(PetscReal) * n / 1e6;
  for (int k = 0; k < LAM_PLANNED_COUNT; k++) {
    cost->of[k] = (LamPrediction){.seconds = NAN, .has = has[k]};
    left += has[k];
  }
  if (size > 1 || plan->unknowns > MOST_UNKNOWNS) PetscFunctionReturn(0);
  for (int k = 0; k < LAM_PLANNED_COUNT && !LamStopSignal(); k++) {
    const PetscReal begin = LamProcessorClock();

    if (!has[k]) continue;
    LamActivitySet("predicts %s", LamPlannedNames[k]);
    LamStopSetProcessorLimit(begin + (end - begin) / (PetscReal)left--);
    PetscCall(tries[k](&planned, &cost->of[k]));
    LamStopSetProcessorLimit(PETSC_INFINITY);
    cost->of[k].has = PETSC_TRUE;
    cost->of[k].seconds += before; /* the start, and the trial of meshes */
  }
  PetscFunctionReturn(0);
}
