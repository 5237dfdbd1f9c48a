/*
  Measurements: their times, and runs added to them.
*/
#include "tradeoff.h"
#include "onset.h"
#include "clock.h"

LamStopwatch LamStopwatchRead(void)
{
  struct timespec cpu;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return (LamStopwatch){(PetscReal)cpu.tv_sec + 1e-9 * (PetscReal)cpu.tv_nsec, LamClock()};
}

void LamMeasurementAddRun(LamMeasurement *m, LamStopwatch start, PetscReal state_cpu)
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
