/*
  The reference: responses on a mesh that is finer than all settings.

  Method

  A sequence of refined meshes, solved to rounding, alternately uniform and slightly graded (strong gradings have
  elements in the middle of a face that are too long). The error of each is estimated from the previous one, whose own
  error is usually larger, so the estimate tends to be too large rather than too small. Cells in contact may be on
  another branch on the next mesh. A state at which the meshes do not agree well enough to resolve the scene's accuracy
  is left out. So is one on which a mesh would spend more than half of the remaining time: walls that wrinkle on the
  scale of the mesh do so on every mesh.
*/
#include "tradeoff.h"
#include "clock.h"
#include <math.h>

static const struct {
  PetscInt along, through;
  PetscReal grading;
} Ladder[] = {{10, 2, 0}, {14, 3, 0.3},  {20, 4, 0},  {28, 6, 0.3},
              {40, 8, 0}, {56, 10, 0.3}, {80, 14, 0}, {112, 20, 0.3}};
enum { RUNGS = PETSC_STATIC_ARRAY_LENGTH(Ladder), FINE_RUNG = 3 }; /* from this rung on finer than all settings */

#define GOAL 0.01      /* of the scene's accuracy: fine enough */
#define COST_POWER 1.5 /* exponent of the time in the number of unknowns */
#define SETTLED 0.1    /* of the scene's accuracy: largest difference of a state that is used */

/* To rounding. */
static PetscErrorCode Climb(const LamScene *scene, const LamStates *states, int rung, LamMeasurement *m)
{
  LamSetting setting = {.knob = LAM_KNOB_MESH, .micro = scene->micro, .strategy = scene->strategy};

  PetscFunctionBeginUser;
  setting.micro.along = Ladder[rung].along;
  setting.micro.through = Ladder[rung].through;
  setting.micro.grading = Ladder[rung].grading;
  PetscCall(LamMeasurementInit(&setting, m));
  PetscCall(LamMeasureRVE(scene, states, m));
  PetscFunctionReturn(0);
}

/* Selects the states included in the errors. */
static void Use(PetscReal accuracy, PetscInt n, LamReference *reference)
{
  PetscInt settled = 0;

  reference->used_count = reference->known_count = 0;
  for (PetscInt s = 0; s < n; s++) {
    reference->known_count += isfinite(reference->difference[s]);
    settled += reference->difference[s] <= SETTLED * accuracy;
  }
  for (PetscInt s = 0; s < n; s++) {
    const PetscReal difference = reference->difference[s];

    reference->used[s] = (PetscBool)(isfinite(difference) && (!settled || difference <= SETTLED * accuracy));
    reference->used_count += reference->used[s];
  }
}

static void Compare(const LamScene *scene, PetscInt n, const LamResponse coarser[], LamReference *reference)
{
  const LamStressScale scale = LamStressScaleOf(&scene->micro);

  for (PetscInt s = 0; s < n; s++) {
    const PetscBool known =
        (PetscBool)(coarser[s].status == LAM_CONVERGED && reference->responses[s].status == LAM_CONVERGED);

    reference->difference[s] = known ? LamStressError(scale, coarser[s].P, reference->responses[s].P) : NAN;
  }
  Use(scene->accuracy, n, reference);
  for (int k = 0; k < LAM_ERROR_MACRO; k++) {
    reference->error[k] = reference->used_count ? 0 : NAN;
    for (PetscInt s = 0; s < n; s++)
      if (reference->used[s])
        reference->error[k] = PetscMax(
            reference->error[k], LamErrorOf((LamErrorKind)k, &scene->micro, &coarser[s], &reference->responses[s]));
  }
}

/* Makes the mesh the reference and moves its responses there. */
static PetscErrorCode Take(const LamScene *scene, PetscInt n, LamMeasurement *m, LamReference *reference)
{
  LamResponse *coarser = reference->responses;

  PetscFunctionBeginUser;
  reference->other = reference->micro;
  reference->micro = m->setting.micro;
  reference->responses = m->responses;
  m->responses = NULL;
  if (coarser) Compare(scene, n, coarser, reference);
  PetscCall(PetscFree(coarser));
  PetscFunctionReturn(0);
}

/* Predicted time of the next rung, from the last one, whose times of the states are known. */
static PetscReal PredictSeconds(int rung, const LamStates *states, const LamReference *reference)
{
  const PetscReal before = (PetscReal)(Ladder[rung - 1].along * Ladder[rung - 1].through);
  const PetscReal ratio = (PetscReal)(Ladder[rung].along * Ladder[rung].through) / before;
  PetscReal seconds = 0;

  for (PetscInt s = 0; s < states->n; s++)
    if (!states->skip[s] && reference->responses[s].seconds > 0) seconds += reference->responses[s].seconds;
  return seconds * PetscPowReal(ratio, COST_POWER);
}

/* Skips the first state that was stopped: it takes too long for finer meshes. */
static void SkipStopped(const LamResponse responses[], LamStates *states)
{
  for (PetscInt s = 0; s < states->n; s++) {
    if (states->skip[s] || responses[s].status != LAM_OUT_OF_REACH) continue;
    states->skip[s] = PETSC_TRUE;
    return;
  }
}

static PetscErrorCode ClimbAll(const LamScene *scene, LamStates *states, PetscReal deadline, LamReference *reference)
{
  PetscFunctionBeginUser;
  for (int rung = 0; rung < RUNGS && !LamStopSignal(); rung++) {
    const LamStopwatch start = LamStopwatchRead();
    PetscInt known = 0;
    LamMeasurement m;

    if (start.wall + (rung ? PredictSeconds(rung, states, reference) : 0) > deadline) break;
    LamStopSetDeadline(start.wall + 0.5 * (deadline - start.wall));
    PetscCall(Climb(scene, states, rung, &m));
    LamStopSetDeadline(PETSC_INFINITY);
    if (m.stopped) SkipStopped(m.responses, states);
    for (PetscInt s = 0; s < states->n; s++) known += m.responses[s].status == LAM_CONVERGED;
    if (known >= reference->used_count) PetscCall(Take(scene, states->n, &m, reference));
    PetscCall(LamMeasurementDestroy(&m));
    if (known < reference->used_count) break;
    reference->cpu = LamStopwatchRead().cpu - start.cpu;
    if (rung >= FINE_RUNG && reference->used_count && reference->error[LAM_ERROR_P] <= GOAL * scene->accuracy) break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamReferenceMake(const LamScene *scene, LamStates *states, PetscReal deadline, LamReference *reference)
{
  LamStates left = *states; /* borrows the loads */

  PetscFunctionBeginUser;
  *reference = (LamReference){.cpu = NAN};
  for (int k = 0; k < LAM_ERROR_KIND_COUNT; k++) reference->error[k] = NAN;
  PetscCall(PetscCalloc1(states->n, &reference->used));
  PetscCall(PetscCalloc1(states->n, &left.skip));
  PetscCall(PetscMalloc1(states->n, &reference->difference));
  for (PetscInt s = 0; s < states->n; s++) reference->difference[s] = NAN;
  PetscCall(ClimbAll(scene, &left, deadline, reference));
  PetscCall(PetscFree(left.skip));
  for (PetscInt s = 0; s < states->n && reference->used_count; s++) states->skip[s] = (PetscBool)!reference->used[s];
  PetscFunctionReturn(0);
}
