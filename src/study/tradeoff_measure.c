/*
  Measures a setting: repeats, and the single run of an RVE, which solves the states as `lamella rve` does.
*/
#include "tradeoff.h"
#include "onset.h"
#include "clock.h"

/* Continues after a state that did not converge, as `lamella rve` does; the first one gives the reason why the
   setting is left out. */
static PetscErrorCode SolveStates(const LamStates *states, LamMeshes *meshes, LamResponse responses[],
                                  LamMeasurement *m)
{
  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < states->n; s++) {
    LamResponse both[2];

    PetscCall(LamResponseInit(&states->loads[s], &responses[s]));
    responses[s].status = LAM_OUT_OF_REACH;
    if (meshes->stopped || states->skip[s]) continue;
    if (!states->chained) PetscCall(LamRVEStateReset(meshes->rve[0], meshes->state[0]));
    PetscCall(LamMeshesSolve(meshes, &states->loads[s], NULL, both));
    responses[s] = both[0];
    if (both[0].status == LAM_CONVERGED || m->reason[0]) continue;
    PetscCall(PetscSNPrintf(m->reason, sizeof(m->reason), "state %" PetscInt_FMT ": %s: %.120s", s + 1,
                            LamStatusNames[both[0].status], both[0].reason));
  }
  if (meshes->stopped) {
    PetscCall(PetscStrncpy(m->reason, "stopped: the time was over", sizeof(m->reason)));
    m->stopped = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasureRVE(const LamScene *scene, const LamStates *states, LamMeasurement *m)
{
  const LamStopwatch start = LamStopwatchRead();
  LamScene own = *scene;
  LamResponse *responses;
  LamStopwatch solves;
  LamMeshes meshes;

  PetscFunctionBeginUser;
  own.micro = m->setting.micro;
  own.strategy = m->setting.strategy;
  own.tolerance = m->setting.tolerance;
  m->reason[0] = '\0';
  PetscCall(PetscMalloc1(states->n, &responses));
  PetscCall(LamMeshesCreate(PETSC_COMM_SELF, &own, 1, &meshes));
  PetscCall(LamRVEGetUnknowns(meshes.rve[0], &m->unknowns));
  PetscCall(LamMeshesSetInterrupt(&meshes, LamStopInterrupt, NULL));
  solves = LamStopwatchRead();
  PetscCall(LamMeshesSeal(&meshes, &own, &states->loads[0]));
  PetscCall(SolveStates(states, &meshes, responses, m));
  if (!m->reason[0])
    LamMeasurementAddRun(m, start, (LamStopwatchRead().cpu - solves.cpu) / (PetscReal)LamStatesCount(states));
  m->responses = responses;
  PetscCall(LamMeshesDestroy(&meshes));
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
    PetscCall(LamMeasureMacro(scene, table, &run));
  else if (m->setting.knob == LAM_KNOB_DATABASE)
    PetscCall(LamMeasureTable(scene, states, table, &run));
  else
    PetscCall(LamMeasureRVE(scene, states, &run));
  PetscCall(LamMeasurementTake(&run, m));
  PetscFunctionReturn(0);
}
