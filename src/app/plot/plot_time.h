/*
  Quantities against time in pictures of processes: at a material point (plot_process.c), of a body (plot_fe2.c);
  films.
*/
#ifndef LAM_PLOT_TIME_H
#define LAM_PLOT_TIME_H

#include "plot.h"

#define LAM_TIME_HEIGHT 350.0 /* of a page with charts */
enum { LAM_TIME_SERIES = 12, LAM_TIME_COLUMNS = 48 };

/* States ordered by time, and their events. */
typedef struct {
  const char *path; /* of the file; borrowed */
  PetscInt n;
  const PetscReal *time; /* s */
  PetscInt *event;       /* number of the name, -1: none; owned, as the following member */
  char *event_names;     /* one per line */
  const char *unit;      /* of time, for labels; static */
  PetscReal seconds;     /* per unit */
  PetscInt column_count;
  struct {
    char name[LAM_NAME_LENGTH];
    PetscReal *values; /* [n]; owned; NULL: the file has none */
  } column[LAM_TIME_COLUMNS];
} LamTimeLine;

/* Reads a file with n states. PETSC_ERR_USER_INPUT if it lacks something, as the next but one. */
PetscErrorCode LamTimeLineRead(const char path[], PetscInt n, LamTimeLine *line);
PetscErrorCode LamTimeLineDestroy(LamTimeLine *line);
/* /process/<name> [n], read when it is first asked for; the line owns it. optional: NULL if the file has none. */
PetscErrorCode LamTimeColumn(LamTimeLine *line, const char name[], PetscBool optional, const PetscReal **values);
PetscBool LamTimeVaries(PetscInt n, const PetscReal values[]);
PetscBool LamTimeIsKnown(PetscInt n, const PetscReal values[]);
/* The name of the event at a state, "" at others, with blanks for underscores; "14 day: turgor lost". */
void LamTimeEventName(const LamTimeLine *line, PetscInt state, size_t size, char name[]);
void LamTimeTitle(const LamTimeLine *line, PetscInt state, size_t size, char title[]);
/* Draws the title of a picture with charts, in which a red line marks the state. */
void LamTimeTitleDraw(LamCanvas canvas, double x, double y, const LamTimeLine *line, PetscInt state);

/* A few series over time; initialise as {.axes.y = ...}. */
typedef struct {
  LamAxes axes;
  PetscInt n;
  LamSeries series[LAM_TIME_SERIES];
} LamTimeChart;
PetscErrorCode LamTimeChartAdd(LamTimeChart *chart, const LamTimeLine *line, const PetscReal values[],
                               const char label[]);
/* Add /process/<name>; those of the arrays /process/<group>/<name> that `shows` selects. */
PetscErrorCode LamTimeChartAddColumn(LamTimeChart *chart, LamTimeLine *line, const char name[], const char label[]);
PetscErrorCode LamTimeChartAddGroup(LamTimeChart *chart, LamTimeLine *line, const char group[], PetscInt n,
                                    const char *const names[],
                                    PetscBool (*shows)(PetscInt count, const PetscReal values[]));
/* Draws the charts two by two, or in a row if the height is too small, with marks at events, labelled in the first
   chart; `now` >= 0: a state to mark. Destroys the charts. */
PetscErrorCode LamTimeChartsDraw(LamCanvas canvas, LamRect outer, const LamTimeLine *line, LamTimeChart charts[4],
                                 PetscInt now);

/* Draws title and colour bars of a frame of a film; *view: its picture. The charts are at the right. */
void LamFrameBegin(LamCanvas canvas, const LamTimeLine *line, PetscInt state, const LamFrame *frame, LamView *view);
LamRect LamFrameCharts(void);
/* Draws the frames 0..count-1 as pages of a file, or as files: of "film.png" several become "film-0001.png" and so
   on; tells the request's reporter. */
typedef PetscErrorCode (*LamFrameFunction)(LamCanvas canvas, void *ctx, PetscInt frame);
PetscErrorCode LamFilmDraw(const LamPlotRequest *request, PetscInt count, LamFrameFunction draw, void *ctx);

#endif
