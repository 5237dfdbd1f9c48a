/* Work and precision of the integration of a process (tests/scenes/ripening.yaml, a week at one material point) over
   its tolerance: steps, questions, time, error at the end. `bench_process` solves directly; `bench_process DB.h5` asks
   a database that `lamella process -d DB.h5` has filled, warm. */
#include <lamella/lamella.h>
#include "clock.h"
#include "support/tissue.h"
#include <math.h>
#include <stdio.h>

enum { REPEATS = 5, OUTPUTS = 200 };
#define REFERENCE 1e-10

typedef struct {
  PetscInt count;
  LamProcessState states[OUTPUTS];
} Way;

static PetscErrorCode Keep(const LamProcessState *state, void *ctx)
{
  Way *way = (Way *)ctx;

  if (state->event == LAM_EVENT_COUNT && way->count < OUTPUTS) way->states[way->count++] = *state;
  return 0;
}

static PetscErrorCode Run(LamScene *scene, LamResponder responder, PetscReal tolerance, Way *way,
                          LamProcessCounts *counts, PetscReal *seconds)
{
  char message[LAM_PROCESS_MESSAGE];
  LamProcessReason reason;
  LamProcess process;

  PetscFunctionBeginUser;
  scene->process.tolerance = tolerance;
  PetscCall(LamProcessCreate(scene, &process));
  PetscCall(LamProcessSetResponder(process, responder));
  PetscCall(LamProcessSetMonitor(process, Keep, way));
  *seconds = INFINITY;
  for (int k = 0; k < REPEATS; k++) {
    const PetscReal start = LamClock();

    way->count = 0;
    PetscCall(LamProcessRun(process, &reason, message));
    *seconds = fmin(*seconds, LamClock() - start);
  }
  PetscCheck(reason == LAM_PROCESS_DONE, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", message);
  PetscCall(LamProcessGetCounts(process, counts));
  PetscCall(LamProcessDestroy(&process));
  PetscFunctionReturn(0);
}

/* Largest error over the outputs, of the turgor over that of the start and of the factors. */
static PetscReal Error(const Way *way, const Way *reference)
{
  PetscReal error = 0;

  for (PetscInt k = 0; k < way->count; k++) {
    const LamProcessState *a = &way->states[k], *b = &reference->states[k];

    error = fmax(error, fabs(a->turgor - b->turgor) / reference->states[0].turgor);
    for (int f = 0; f < LAM_CHANGING_COUNT; f++) error = fmax(error, fabs(a->factor[f] - b->factor[f]));
  }
  return error;
}

static PetscErrorCode Measure(LamScene *scene, LamResponder responder)
{
  static Way reference, way;
  LamProcessCounts counts;
  PetscReal seconds;

  PetscFunctionBeginUser;
  PetscCall(Run(scene, responder, REFERENCE, &reference, &counts, &seconds));
  printf("%10s %7s %10s %10s %9s %9s\n", "tolerance", "steps", "residuals", "questions", "error", "ms/week");
  for (PetscReal tolerance = 1e-2; tolerance > 0.5e-8; tolerance /= 10) {
    PetscCall(Run(scene, responder, tolerance, &way, &counts, &seconds));
    printf("%10.0e %7d %10d %10d %9.1e %9.2f\n", (double)tolerance, (int)counts.steps, (int)counts.residuals,
           (int)counts.questions, (double)Error(&way, &reference),
           (double)(1e3 * seconds * 7 * 86400 / scene->process.duration));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Bench(const char *path)
{
  LamDatabase database = NULL;
  LamResponder responder;
  LamScene *scene;
  LamRVE rve = NULL;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(LAMELLA_SOURCE_DIR "/tests/scenes/ripening.yaml", &scene));
  if (path) {
    PetscCall(LamDatabaseOpen(path, &database));
    PetscCall(LamCacheResponderCreate(PETSC_COMM_SELF, database, NULL, NULL, LAM_OUTSIDE_STOP, scene->accuracy, 1,
                                      &responder));
  } else {
    scene->micro.along = 6;
    scene->micro.through = 2;
    scene->micro.grading = 0;
    PetscCall(NewTissue(&scene->micro, &rve, NULL));
    PetscCall(LamRVEResponderCreate(rve, 1, &responder));
  }
  PetscCall(Measure(scene, responder));
  PetscCall(LamResponderDestroy(&responder));
  PetscCall(LamDatabaseClose(&database));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int code;

  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  code = Bench(argc > 1 ? argv[1] : NULL);
  PetscFinalize();
  return code;
}
