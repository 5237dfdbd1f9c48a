/*
  Time histories of a body, beside its picture.
*/
#include "plot_fe2.h"
#include <math.h>
#include <stdio.h>

PetscErrorCode LamBodyTimesRead(const char path[], PetscInt steps, LamBodyTimes *t)
{
  PetscInt rank, dims[4];
  PetscReal *time = NULL;
  PetscBool found;

  PetscFunctionBeginUser;
  *t = (LamBodyTimes){0};
  PetscCall(LamFileReadReals(path, "/process/time", &found, &rank, dims, &time));
  PetscCall(PetscFree(time));
  if (!found) PetscFunctionReturn(0);
  PetscCall(LamTimeLineRead(path, steps, &t->line));
  PetscCall(LamTimeReadColumn(&t->line, "turgor_min", &t->turgor[0]));
  PetscCall(LamTimeReadColumn(&t->line, "turgor_mean", &t->turgor[1]));
  PetscCall(LamTimeReadColumn(&t->line, "turgor_max", &t->turgor[2]));
  PetscCall(LamTimeReadColumn(&t->line, "water", &t->water));
  PetscCall(LamTimeReadColumn(&t->line, "plasmolysed", &t->plasmolysed));
  PetscCall(LamTimeReadColumn(&t->line, "debonded_fraction", &t->debonded));
  PetscCall(LamTimeReadGroup(&t->line, "factor", LAM_CHANGING_COUNT, LamChangingNames, LamTimeVaries, &t->factor_count,
                             t->factor, t->factor_name));
  PetscCall(LamTimeReadGroup(&t->line, "ratio", LAM_RATIO_COUNT, LamRatioNames, LamTimeIsKnown, &t->ratio_count,
                             t->ratio, t->ratio_name));
  t->there = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyTimesDestroy(LamBodyTimes *t)
{
  PetscFunctionBeginUser;
  PetscCall(LamTimeLineDestroy(&t->line));
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(t->turgor[k]));
  PetscCall(PetscFree(t->water));
  PetscCall(PetscFree(t->plasmolysed));
  PetscCall(PetscFree(t->debonded));
  for (PetscInt k = 0; k < t->factor_count; k++) PetscCall(PetscFree(t->factor[k]));
  for (PetscInt k = 0; k < t->ratio_count; k++) PetscCall(PetscFree(t->ratio[k]));
  PetscFunctionReturn(0);
}

/* Reactions above rounding. */
static PetscErrorCode MakeForces(const LamBodyTimes *t, const LamReactions *reactions, LamTimeChart *chart)
{
  const PetscInt columns = 2 * reactions->side_count;
  PetscReal largest = 0, *values;
  char label[LAM_NAME_LENGTH], side[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "reaction $R$", .unit = "N/mm"}};
  PetscCall(PetscMalloc1(t->line.n, &values));
  for (PetscInt k = 0; k < t->line.n * columns; k++) largest = PetscMax(largest, PetscAbsReal(reactions->reaction[k]));
  for (PetscInt c = 0; c < columns; c++) {
    PetscReal own = 0;

    for (PetscInt k = 0; k < t->line.n; k++) {
      values[k] = reactions->reaction[k * columns + c];
      own = PetscMax(own, PetscAbsReal(values[k]));
    }
    if (own < 1e-6 * largest) continue;
    LamReactionsSideName(reactions, c / 2, sizeof(side), side);
    snprintf(label, sizeof(label), "%.40s $R$_{%d}", side, (int)(c % 2 + 1));
    PetscCall(LamTimeChartAdd(chart, &t->line, values, label));
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeTurgor(const LamBodyTimes *t, LamTimeChart *chart)
{
  static const char *const labels[] = {"least", "mean", "largest"};

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "turgor $p$", .unit = "MPa"}};
  for (int k = 0; k < 3; k++) PetscCall(LamTimeChartAdd(chart, &t->line, t->turgor[k], labels[k]));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeShares(const LamBodyTimes *t, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "share of the start"}};
  for (PetscInt k = 0; k < t->factor_count; k++)
    PetscCall(LamTimeChartAdd(chart, &t->line, t->factor[k], t->factor_name[k]));
  if (LamTimeIsKnown(t->line.n, t->water)) PetscCall(LamTimeChartAdd(chart, &t->line, t->water, "water"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeDamage(const LamBodyTimes *t, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = t->ratio_count ? "stress over strength" : "share"}};
  for (PetscInt k = 0; k < t->ratio_count; k++)
    PetscCall(LamTimeChartAdd(chart, &t->line, t->ratio[k], t->ratio_name[k]));
  if (!t->ratio_count) PetscCall(LamTimeChartAdd(chart, &t->line, t->debonded, "debonded"));
  if (LamTimeIsKnown(t->line.n, t->plasmolysed) && LamTimeVaries(t->line.n, t->plasmolysed))
    PetscCall(LamTimeChartAdd(chart, &t->line, t->plasmolysed, "without turgor"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyTimesDraw(LamCanvas canvas, LamRect outer, const LamBodyTimes *t, const LamReactions *reactions,
                                PetscInt now)
{
  LamTimeChart charts[4];

  PetscFunctionBeginUser;
  PetscCall(MakeForces(t, reactions, &charts[0]));
  PetscCall(MakeTurgor(t, &charts[1]));
  PetscCall(MakeShares(t, &charts[2]));
  PetscCall(MakeDamage(t, &charts[3]));
  PetscCall(LamTimeChartsDraw(canvas, outer, &t->line, charts, now));
  PetscFunctionReturn(0);
}
