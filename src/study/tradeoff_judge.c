/*
  Errors, spread of times, and the best settings.

  An error below ten times that of the reference is not resolved: it may stem from either, and is not ranked. Neither is
  that of a mesh which is no coarser than the reference, which occurs if there was no time for a finer one.
*/
#include "tradeoff.h"
#include <math.h>
#include <stdlib.h>

#define RESOLUTION 10.0

const char *const LamErrorNames[] = {LAM_ERROR_KINDS(LAM_NAME_ENTRY)};

static int CompareReals(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return (x > y) - (x < y);
}

LamSpread LamSpreadOf(PetscInt n, const PetscReal values[])
{
  PetscReal sorted[LAM_MOST_REPEATS];

  n = PetscMin(n, LAM_MOST_REPEATS);
  if (n < 1) return (LamSpread){NAN, NAN, NAN};
  for (PetscInt i = 0; i < n; i++) sorted[i] = values[i];
  qsort(sorted, (size_t)n, sizeof(*sorted), CompareReals);
  return (LamSpread){0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted[0], sorted[n - 1]};
}

/* |a - b| / |b| over the numbers that are known in both. */
static PetscReal RelativeDifference(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal difference = 0, size = 0;

  for (PetscInt i = 0; i < n; i++) {
    if (!isfinite(a[i]) || !isfinite(b[i])) continue;
    difference += PetscSqr(a[i] - b[i]);
    size += PetscSqr(b[i]);
  }
  return size > 0 ? PetscSqrtReal(difference / size) : NAN;
}

PetscReal LamErrorOf(LamErrorKind kind, const LamMicrostructure *micro, const LamResponse *answer,
                     const LamResponse *reference)
{
  switch (kind) {
  case LAM_ERROR_P:
    return LamStressError(LamStressScaleOf(micro), answer->P, reference->P);
  case LAM_ERROR_TANGENT:
    return RelativeDifference(81, answer->tangent, reference->tangent);
  case LAM_ERROR_OPENING:
    if (LamCellsPart(micro->interface)) return fabs(answer->opening_fraction - reference->opening_fraction);
    return fabs(answer->lumen_fraction - reference->lumen_fraction);
  default:
    return NAN;
  }
}

void LamMacroErrors(const LamMacroOutcome *answer, const LamMacroOutcome *reference, PetscReal errors[2])
{
  errors[0] = RelativeDifference(2 * reference->boundaries, answer->reaction[0], reference->reaction[0]);
  errors[1] = RelativeDifference(1, &answer->work, &reference->work);
}

void LamParetoMark(PetscInt n, const PetscReal cost[], const PetscReal error[], PetscBool optimal[])
{
  for (PetscInt i = 0; i < n; i++) {
    optimal[i] = (PetscBool)(isfinite(cost[i]) && isfinite(error[i]));
    for (PetscInt j = 0; j < n && optimal[i]; j++) {
      const PetscBool as_good = (PetscBool)(cost[j] <= cost[i] && error[j] <= error[i]);

      if (as_good && (cost[j] < cost[i] || error[j] < error[i])) optimal[i] = PETSC_FALSE;
    }
  }
}

static PetscBool IsCoarser(const LamMicrostructure *a, const LamMicrostructure *b)
{
  return (PetscBool)(a->along * a->through < b->along * b->through);
}

static void JudgeStates(const LamReference *reference, PetscInt states, LamMeasurement *m)
{
  for (int k = 0; k < LAM_ERROR_MACRO; k++) {
    LamMeasuredError *error = &m->error[k];
    PetscReal sum = 0, largest = 0;

    for (PetscInt s = 0; s < states; s++) {
      PetscReal e;

      if (!reference->used[s]) continue;
      e = LamErrorOf((LamErrorKind)k, &m->setting.micro, &m->responses[s], &reference->responses[s]);
      sum += e;
      largest = isnan(e) || e > largest ? e : largest;
    }
    error->largest = isnan(sum) ? NAN : largest;
    error->mean = sum / (PetscReal)reference->used_count;
    error->resolved = (PetscBool)(error->largest >= RESOLUTION * reference->error[k] &&
                                  IsCoarser(&m->setting.micro, &reference->micro));
  }
}

static PetscReal FromPlan(const LamStates *states, const LamMeasurement *m, const LamMeasurement *plan)
{
  PetscReal largest = 0;

  for (PetscInt s = 0; s < states->n; s++)
    if (!states->skip[s])
      largest = PetscMax(
          largest, LamStressError(LamStressScaleOf(&plan->setting.micro), m->responses[s].P, plan->responses[s].P));
  return largest;
}

/* Direct responses on the same mesh are the reference of all others. */
static void JudgeMacro(const LamMeasurement *direct, LamMeasurement *m)
{
  LamMeasuredError *error = &m->error[LAM_ERROR_MACRO];
  PetscReal errors[2];

  LamMacroErrors(&m->outcome, &direct->outcome, errors);
  error->largest = PetscMax(errors[0], errors[1]);
  error->mean = 0.5 * (errors[0] + errors[1]);
  error->resolved = (PetscBool)(m != direct);
  m->from_plan = error->largest;
}

static PetscErrorCode MarkOptimal(LamErrorKind kind, PetscInt n, LamMeasurement measured[])
{
  PetscReal *cost, *error;
  PetscBool *optimal;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &cost, n, &error, n, &optimal));
  for (PetscInt i = 0; i < n; i++) {
    const LamMeasuredError *e = &measured[i].error[kind];

    cost[i] = measured[i].cpu_spread.median;
    error[i] = e->resolved ? e->largest : NAN;
  }
  LamParetoMark(n, cost, error, optimal);
  for (PetscInt i = 0; i < n; i++) measured[i].error[kind].optimal = optimal[i];
  PetscCall(PetscFree3(cost, error, optimal));
  PetscFunctionReturn(0);
}

PetscErrorCode LamJudge(const LamReference *reference, const LamStates *states, PetscInt n, LamMeasurement measured[])
{
  const LamMeasurement *plan = NULL, *direct = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const LamMeasurement *m = &measured[i];

    if (!m->runs || !m->setting.planned) continue;
    if (m->setting.knob == LAM_KNOB_MACRO)
      direct = m;
    else if (!plan)
      plan = m;
  }
  for (PetscInt i = 0; i < n; i++) {
    LamMeasurement *m = &measured[i];

    m->cpu_spread = LamSpreadOf(m->runs, m->cpu);
    m->wall_spread = LamSpreadOf(m->runs, m->wall);
    for (int k = 0; k < LAM_ERROR_KIND_COUNT; k++) m->error[k] = (LamMeasuredError){NAN, NAN, PETSC_FALSE, PETSC_FALSE};
    m->from_plan = NAN;
    if (!m->runs) continue;
    if (m->setting.knob == LAM_KNOB_MACRO && direct) JudgeMacro(direct, m);
    if (m->setting.knob == LAM_KNOB_MACRO) continue;
    if (reference->used_count) JudgeStates(reference, states->n, m);
    if (plan) m->from_plan = FromPlan(states, m, plan);
  }
  for (int k = 0; k < LAM_ERROR_KIND_COUNT; k++) PetscCall(MarkOptimal((LamErrorKind)k, n, measured));
  PetscFunctionReturn(0);
}
