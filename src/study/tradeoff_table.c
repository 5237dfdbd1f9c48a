/*
  One run of a setting by a table: built over the scene's sample box, then queried at the states.
*/
#include "tradeoff.h"
#include "build_run.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Serial. *nodes: final number of nodes of the table. */
static PetscErrorCode Build(const LamScene *scene, const LamSetting *setting, const char path[], PetscInt *nodes)
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

static PetscErrorCode Ask(const LamStates *states, LamDatabase database, LamResponse responses[], LamMeasurement *m)
{
  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < states->n && !m->reason[0]; s++) {
    if (states->skip[s]) continue;
    PetscCall(LamDatabaseQuery(database, &states->loads[s], m->setting.accuracy, &responses[s]));
    if (responses[s].status != LAM_CONVERGED)
      PetscCall(PetscSNPrintf(m->reason, sizeof(m->reason), "state %" PetscInt_FMT ": %s: %.120s", s + 1,
                              LamStatusNames[responses[s].status], responses[s].reason));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasureTable(const LamScene *scene, const LamStates *states, const char table[], LamMeasurement *m)
{
  const LamStopwatch start = LamStopwatchRead();
  LamResponse *responses;
  LamStopwatch asked;
  LamDatabase database;
  char part[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  m->reason[0] = '\0';
  PetscCall(PetscSNPrintf(part, sizeof(part), "%s.part", table));
  PetscCall(Build(scene, &m->setting, part, &m->nodes));
  if (LamStopRequested()) {
    unlink(part); /* a complete table of the previous run stays */
    PetscCall(
        PetscSNPrintf(m->reason, sizeof(m->reason), "stopped: the time was over at %" PetscInt_FMT " nodes", m->nodes));
    m->nodes = 0;
    PetscFunctionReturn(0);
  }
  PetscCheck(!rename(part, table), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", table, strerror(errno));
  PetscCall(PetscMalloc1(states->n, &responses));
  PetscCall(LamDatabaseOpen(table, &database));
  asked = LamStopwatchRead();
  m->build_cpu = asked.cpu - start.cpu;
  m->build_wall = asked.wall - start.wall;
  PetscCall(Ask(states, database, responses, m));
  if (!m->reason[0])
    LamMeasurementAddRun(m, start, (LamStopwatchRead().cpu - asked.cpu) / (PetscReal)LamStatesCount(states));
  PetscCall(LamDatabaseClose(&database));
  if (m->reason[0])
    PetscCall(PetscFree(responses));
  else
    m->responses = responses;
  PetscFunctionReturn(0);
}
