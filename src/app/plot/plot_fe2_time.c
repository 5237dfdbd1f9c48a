/*
  Time histories of a body, beside its picture.
*/
#include "plot_fe2.h"
#include <stdio.h>

static PetscErrorCode MakeForces(const LamTimeLine *line, const LamReactions *reactions, LamTimeChart *chart)
{
  char label[LAM_SERIES_LABEL];
  PetscReal *values;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "reaction $R$", .unit = "N/mm"}};
  PetscCall(PetscMalloc1(line->n, &values));
  for (PetscInt c = 0; c < 2 * reactions->side_count; c++)
    if (LamReactionsGet(reactions, c, values, label)) PetscCall(LamTimeChartAdd(chart, line, values, label));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeTurgor(LamTimeLine *line, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "turgor $p$", .unit = "MPa"}};
  PetscCall(LamTimeChartAddColumn(chart, line, "turgor_min", "least"));
  PetscCall(LamTimeChartAddColumn(chart, line, "turgor_mean", "mean"));
  PetscCall(LamTimeChartAddColumn(chart, line, "turgor_max", "largest"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeShares(LamTimeLine *line, LamTimeChart *chart)
{
  const PetscReal *water;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "share of the start"}};
  PetscCall(LamTimeChartAddGroup(chart, line, "factor", LAM_CHANGING_COUNT, LamChangingNames, LamTimeVaries));
  PetscCall(LamTimeColumn(line, "water", PETSC_FALSE, &water));
  if (LamTimeIsKnown(line->n, water)) PetscCall(LamTimeChartAdd(chart, line, water, "water"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeDamage(LamTimeLine *line, LamTimeChart *chart)
{
  const PetscReal *plasmolysed;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "stress over strength"}};
  PetscCall(LamTimeChartAddGroup(chart, line, "ratio", LAM_RATIO_COUNT, LamRatioNames, LamTimeIsKnown));
  if (!chart->n) {
    chart->axes.y.label = "share";
    PetscCall(LamTimeChartAddColumn(chart, line, "debonded_fraction", "debonded"));
  }
  PetscCall(LamTimeColumn(line, "plasmolysed", PETSC_FALSE, &plasmolysed));
  if (LamTimeIsKnown(line->n, plasmolysed) && LamTimeVaries(line->n, plasmolysed))
    PetscCall(LamTimeChartAdd(chart, line, plasmolysed, "without turgor"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyTimesDraw(LamCanvas canvas, LamRect outer, LamTimeLine *line, const LamReactions *reactions,
                                PetscInt now)
{
  LamTimeChart charts[4];

  PetscFunctionBeginUser;
  PetscCall(MakeForces(line, reactions, &charts[0]));
  PetscCall(MakeTurgor(line, &charts[1]));
  PetscCall(MakeShares(line, &charts[2]));
  PetscCall(MakeDamage(line, &charts[3]));
  PetscCall(LamTimeChartsDraw(canvas, outer, line, charts, now));
  PetscFunctionReturn(0);
}
