/*
  Quantities against time in pictures of processes: at a material point (plot_process.c), of a body (plot_fe2_time.c).
*/
#ifndef LAM_PLOT_TIME_H
#define LAM_PLOT_TIME_H

#include "plot.h"

#define LAM_TIME_HEIGHT 350.0 /* of a page with charts */
enum { LAM_TIME_SERIES = 12 };

/* States ordered by time, and their events. */
typedef struct {
  const char *path; /* of the file; borrowed */
  PetscInt n;
  PetscReal *time;   /* s; owned, as the following members */
  PetscInt *event;   /* number of the name; -1: none */
  char *event_names; /* one per line */
  const char *unit;  /* of time, for labels; static */
  PetscReal seconds; /* per unit */
} LamTimeLine;

/* A suitable unit of time for a duration, and its length in s. */
const char *LamTimeUnit(PetscReal duration, PetscReal *seconds);
/* Reads a file with n states. PETSC_ERR_USER_INPUT if it lacks something, as the next two. */
PetscErrorCode LamTimeLineRead(const char path[], PetscInt n, LamTimeLine *line);
PetscErrorCode LamTimeLineDestroy(LamTimeLine *line);
/* /process/<name> [n]; the caller frees it. */
PetscErrorCode LamTimeReadColumn(const LamTimeLine *line, const char name[], PetscReal **values);
/* Reads those of the arrays /process/<group>/<name> that `shows` selects, with labels that have blanks for
   underscores. */
PetscErrorCode LamTimeReadGroup(const LamTimeLine *line, const char group[], PetscInt n, const char *const names[],
                                PetscBool (*shows)(PetscInt count, const PetscReal values[]), PetscInt *count,
                                PetscReal *values[], char (*labels)[LAM_NAME_LENGTH]);
PetscBool LamTimeVaries(PetscInt n, const PetscReal values[]);
PetscBool LamTimeIsKnown(PetscInt n, const PetscReal values[]);
/* The name of the event at a state, "" at others, with blanks for underscores. */
void LamTimeEventName(const LamTimeLine *line, PetscInt state, size_t size, char name[]);

/* A few series over time; initialise as {.axes.y = ...}. */
typedef struct {
  LamAxes axes;
  PetscInt n;
  LamSeries series[LAM_TIME_SERIES];
} LamTimeChart;
PetscErrorCode LamTimeChartAdd(LamTimeChart *chart, const LamTimeLine *line, const PetscReal values[],
                               const char label[]);
/* Draws the charts two by two, or in a row if the height is too small, with marks at events, labelled in the first
   chart; `now` >= 0: a state to mark. Destroys the charts. */
PetscErrorCode LamTimeChartsDraw(LamCanvas canvas, LamRect outer, const LamTimeLine *line, LamTimeChart charts[4],
                                 PetscInt now);

/* Replaces "film.png" by "film-0001.png". */
PetscErrorCode LamFrameName(const char path[], PetscInt number, size_t size, char name[]);

#endif
