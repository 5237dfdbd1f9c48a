/*
  Measurements: one run of a setting by an RVE, which solves the states as `lamella rve` does; by a table over the
  scene's sample box, built and then queried at the states; or by the macroscale problem, as `lamella fe2` without its
  files. And runs added to measurements.
*/
#include "tradeoff.h"
#include "build_run.h"
#include "clock.h"
#include "onset.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* ---- times ---- */

LamStopwatch LamStopwatchRead(void)
{
  struct timespec cpu;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return (LamStopwatch){(PetscReal)cpu.tv_sec + 1e-9 * (PetscReal)cpu.tv_nsec, LamClock()};
}

/* Stores the times since `start`; state_cpu: average CPU seconds per state. */
static void AddRun(LamMeasurement *m, LamStopwatch start, PetscReal state_cpu)
{
  const LamStopwatch now = LamStopwatchRead();

  m->cpu[m->runs] = now.cpu - start.cpu;
  m->wall[m->runs] = now.wall - start.wall;
  m->state_cpu[m->runs] = state_cpu;
  m->runs++;
}

PetscErrorCode LamMeasurementInit(const LamSetting *setting, LamMeasurement *m)
{
  PetscFunctionBeginUser;
  *m = (LamMeasurement){.setting = *setting};
  PetscCall(PetscMalloc3(LAM_MOST_REPEATS, &m->cpu, LAM_MOST_REPEATS, &m->wall, LAM_MOST_REPEATS, &m->state_cpu));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasurementDestroy(LamMeasurement *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(m->cpu, m->wall, m->state_cpu));
  PetscCall(PetscFree(m->responses));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasurementTake(LamMeasurement *run, LamMeasurement *m)
{
  PetscFunctionBeginUser;
  if (!m->runs) {
    PetscCall(LamMeasurementDestroy(m));
    *m = *run;
    PetscFunctionReturn(0);
  }
  if (run->runs && m->runs < LAM_MOST_REPEATS) {
    m->cpu[m->runs] = run->cpu[0];
    m->wall[m->runs] = run->wall[0];
    m->state_cpu[m->runs] = run->state_cpu[0];
    m->build_cpu = run->build_cpu;
    m->build_wall = run->build_wall;
    m->runs++;
  }
  PetscCall(LamMeasurementDestroy(run));
  PetscFunctionReturn(0);
}

/* ---- by an RVE ---- */

/* The first state that did not converge gives the reason why the setting is left out. */
static PetscErrorCode NoteState(PetscInt state, const LamResponse *response, LamMeasurement *m)
{
  PetscFunctionBeginUser;
  if (response->status == LAM_CONVERGED || m->reason[0]) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(m->reason, sizeof(m->reason), "state %" PetscInt_FMT ": %s: %.120s", state + 1,
                          LamStatusNames[response->status], response->reason));
  PetscFunctionReturn(0);
}

/* Continues after a state that did not converge, as `lamella rve` does. */
static PetscErrorCode SolveStates(const LamStates *states, LamMeshes *meshes, LamMeasurement *m)
{
  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < states->n; s++) {
    LamResponse both[2];

    PetscCall(LamResponseInit(&states->loads[s], &m->responses[s]));
    m->responses[s].status = LAM_OUT_OF_REACH;
    if (meshes->stopped || states->skip[s]) continue;
    if (!states->chained) PetscCall(LamRVEStateReset(meshes->rve[0], meshes->state[0]));
    PetscCall(LamMeshesSolve(meshes, &states->loads[s], NULL, both));
    m->responses[s] = both[0];
    PetscCall(NoteState(s, &both[0], m));
  }
  m->stopped = meshes->stopped;
  if (m->stopped) PetscCall(PetscStrncpy(m->reason, "stopped: the time was over", sizeof(m->reason)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasureRVE(const LamScene *scene, const LamStates *states, LamMeasurement *m)
{
  const LamStopwatch start = LamStopwatchRead();
  LamScene own = *scene;
  LamStopwatch solves;
  LamMeshes meshes;

  PetscFunctionBeginUser;
  own.micro = m->setting.micro;
  own.strategy = m->setting.strategy;
  own.tolerance = m->setting.tolerance;
  PetscCall(PetscMalloc1(states->n, &m->responses));
  PetscCall(LamMeshesCreate(PETSC_COMM_SELF, &own, 1, &meshes));
  PetscCall(LamRVEGetUnknowns(meshes.rve[0], &m->unknowns));
  PetscCall(LamMeshesSetInterrupt(&meshes, LamStopInterrupt, NULL));
  solves = LamStopwatchRead();
  PetscCall(LamMeshesSeal(&meshes, &own, &states->loads[0]));
  PetscCall(SolveStates(states, &meshes, m));
  if (!m->reason[0]) AddRun(m, start, (LamStopwatchRead().cpu - solves.cpu) / (PetscReal)LamStatesCount(states));
  PetscCall(LamMeshesDestroy(&meshes));
  PetscFunctionReturn(0);
}

/* ---- by a table ---- */

/* Serial. *nodes: final number of nodes of the table. */
static PetscErrorCode BuildTable(const LamScene *scene, const LamSetting *setting, const char path[], PetscInt *nodes)
{
  LamScene own = *scene;
  LamBuild build = {.scene = &own, .path = path, .team_size = 1, .shard = {1, 1}};

  PetscFunctionBeginUser;
  own.micro = setting->micro;
  own.accuracy = setting->accuracy;
  own.sample.count = 0;
  own.sample.accuracy = setting->accuracy;
  PetscCall(LamBuildTable(&build));
  *nodes = (PetscInt)LamBuildRecords(&build);
  build.scene = NULL; /* borrowed */
  PetscCall(LamBuildDestroy(&build));
  PetscFunctionReturn(0);
}

/* Sets m->responses if all queries succeed. */
static PetscErrorCode QueryTable(const LamStates *states, const char table[], LamMeasurement *m)
{
  LamDatabase database;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(states->n, &m->responses));
  PetscCall(LamDatabaseOpen(table, &database));
  for (PetscInt s = 0; s < states->n && !m->reason[0]; s++) {
    if (states->skip[s]) continue;
    PetscCall(LamDatabaseQuery(database, &states->loads[s], m->setting.accuracy, &m->responses[s]));
    PetscCall(NoteState(s, &m->responses[s], m));
  }
  PetscCall(LamDatabaseClose(&database));
  if (m->reason[0]) PetscCall(PetscFree(m->responses));
  PetscFunctionReturn(0);
}

static PetscErrorCode MeasureTable(const LamScene *scene, const LamStates *states, const char table[],
                                   LamMeasurement *m)
{
  const LamStopwatch start = LamStopwatchRead();
  char part[PETSC_MAX_PATH_LEN];
  LamStopwatch built;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(part, sizeof(part), "%s.part", table));
  PetscCall(BuildTable(scene, &m->setting, part, &m->nodes));
  if (LamStopRequested()) {
    unlink(part); /* a complete table of the previous run stays */
    PetscCall(
        PetscSNPrintf(m->reason, sizeof(m->reason), "stopped: the time was over at %" PetscInt_FMT " nodes", m->nodes));
    m->nodes = 0;
    PetscFunctionReturn(0);
  }
  PetscCheck(!rename(part, table), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", table, strerror(errno));
  built = LamStopwatchRead();
  m->build_cpu = built.cpu - start.cpu;
  m->build_wall = built.wall - start.wall;
  PetscCall(QueryTable(states, table, m));
  if (!m->reason[0]) AddRun(m, start, (LamStopwatchRead().cpu - built.cpu) / (PetscReal)LamStatesCount(states));
  PetscFunctionReturn(0);
}

/* ---- by the macroscale problem ---- */

/* `step` of LamFE2Run: keeps the last step. */
static PetscErrorCode KeepStep(void *ctx, const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  LamMacroOutcome *outcome = (LamMacroOutcome *)ctx;

  PetscFunctionBeginUser;
  outcome->boundaries = step->boundary_count;
  outcome->work = step->work;
  PetscCall(PetscArraycpy(outcome->reaction[0], step->reaction[0], 2 * step->boundary_count));
  PetscFunctionReturn(0);
}

static PetscErrorCode MeasureMacro(const LamScene *scene, const char table[], LamMeasurement *m)
{
  LamStopwatch start = LamStopwatchRead();
  LamFE2Run run = LAM_FE2_RUN;
  LamScene own = *scene;
  PetscBool finished;

  PetscFunctionBeginUser;
  own.micro = m->setting.micro;
  if (m->setting.accuracy > 0) own.response.accuracy = m->setting.accuracy;
  run.scene_path = scene->path;
  run.scene = &own;
  run.comm = PETSC_COMM_WORLD;
  run.response = m->setting.response;
  run.database_path = m->setting.response == LAM_FE2_DATABASE ? table : NULL;
  run.step = KeepStep;
  run.step_ctx = &m->outcome;
  PetscCall(LamFE2Prepare(&run, &finished));
  PetscCall(LamFE2Solve(&run));
  if (run.reason == LAM_MACRO_STOPPED)
    PetscCall(PetscStrncpy(m->reason, "stopped: the time was over", sizeof(m->reason)));
  else if (run.reason == LAM_MACRO_NOT_CONVERGED)
    PetscCall(PetscSNPrintf(m->reason, sizeof(m->reason), "%.180s", run.message));
  start.cpu -= m->build_cpu;
  start.wall -= m->build_wall;
  if (!m->reason[0]) AddRun(m, start, NAN);
  run.scene = NULL; /* borrowed */
  PetscCall(LamFE2Destroy(&run));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasure(const LamScene *scene, const LamStates *states, const char table[], LamMeasurement *m)
{
  LamMeasurement run;

  PetscFunctionBeginUser;
  PetscCall(LamMeasurementInit(&m->setting, &run));
  run.build_cpu = m->build_cpu;
  run.build_wall = m->build_wall;
  if (m->setting.knob == LAM_KNOB_MACRO)
    PetscCall(MeasureMacro(scene, table, &run));
  else if (m->setting.knob == LAM_KNOB_DATABASE)
    PetscCall(MeasureTable(scene, states, table, &run));
  else
    PetscCall(LamMeasureRVE(scene, states, &run));
  PetscCall(LamMeasurementTake(&run, m));
  PetscFunctionReturn(0);
}
