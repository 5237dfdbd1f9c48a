/*
  Numbers against time in pictures of processes: of a material point (plot_process.c), of a body (plot_fe2_time.c).
*/
#ifndef LAM_PLOT_TIME_H
#define LAM_PLOT_TIME_H

#include "plot.h"

#define LAM_TIME_HEIGHT 350.0 /* of a page with charts */
enum { LAM_TIME_SERIES = 12 };

/* States in the order of time, and what happens at them. */
typedef struct {
  const char *path; /* of the file; borrowed */
  PetscInt n;
  PetscReal *time;   /* s; owned, as what follows */
  PetscInt *event;   /* number of the name; -1: none */
  char *event_names; /* one per line */
  const char *unit;  /* of time, for people; static */
  PetscReal seconds; /* in one of it */
} LamTimeLine;

/* The unit of time that suits a duration, and its length in s. */
const char *LamTimeUnit(PetscReal duration, PetscReal *seconds);
/* Of a file that has n states. PETSC_ERR_USER_INPUT where it lacks something, as the next two. */
PetscErrorCode LamTimeLineRead(const char path[], PetscInt n, LamTimeLine *line);
PetscErrorCode LamTimeLineDestroy(LamTimeLine *line);
/* /process/<name> [n]; the caller frees it. */
PetscErrorCode LamTimeReadColumn(const LamTimeLine *line, const char name[], PetscReal **values);
/* Of the arrays /process/<group>/<name> those that `shows` says are to be drawn, with labels that have blanks for
   underscores. */
PetscErrorCode LamTimeReadGroup(const LamTimeLine *line, const char group[], PetscInt n, const char *const names[],
                                PetscBool (*shows)(PetscInt count, const PetscReal values[]), PetscInt *count,
                                PetscReal *values[], char (*labels)[LAM_NAME_LENGTH]);
PetscBool LamTimeVaries(PetscInt n, const PetscReal values[]);
PetscBool LamTimeIsKnown(PetscInt n, const PetscReal values[]);
/* The name of the event at a state, "" at others, with blanks for underscores. */
void LamTimeEventName(const LamTimeLine *line, PetscInt state, size_t size, char name[]);

/* A few series over the time; made as {.axes.y = ...}. */
typedef struct {
  LamAxes axes;
  PetscInt n;
  LamSeries series[LAM_TIME_SERIES];
} LamTimeChart;
PetscErrorCode LamTimeChartAdd(LamTimeChart *chart, const LamTimeLine *line, const PetscReal values[],
                               const char label[]);
/* Two by two, or in a row where there is no height for that, with marks at events, named in the first; `now` >= 0: a
 * state to mark. They are used up. */
PetscErrorCode LamTimeChartsDraw(LamCanvas canvas, LamRect outer, const LamTimeLine *line, LamTimeChart charts[4],
                                 PetscInt now);

/* "film.png" becomes "film-0001.png". */
PetscErrorCode LamFrameName(const char path[], PetscInt number, size_t size, char name[]);

#endif
