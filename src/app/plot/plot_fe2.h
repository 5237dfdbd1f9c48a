/*
  Pictures of FE2 runs: declarations shared by their parts. plot_fe2.c draws the body, its time histories and the page,
  plot_fe2_curve.c the reactions, plot_obstacle.c plates and indenters, plot_zoom.c the microstructure at selected
  points.
*/
#ifndef LAM_PLOT_FE2_H
#define LAM_PLOT_FE2_H

#include "plot_tissue.h"
#include "plot_time.h"
#include <lamella/process.h>
#include <jansson.h>

/* ---- plot_fe2_curve.c ---- */
typedef struct {
  PetscInt count;      /* of steps */
  PetscReal *load;     /* [step] load factor; owned */
  PetscReal *x;        /* [step] displacement of the loaded side, mm; owned; NULL: no loaded side, or an older file */
  PetscReal *pull;     /* [step] the reaction along its displacement, N/mm; owned; NULL as x */
  PetscReal *reaction; /* [step][side][2], N/mm; owned */
  PetscReal *certified, *margin; /* likewise, corrected, and half the width of the interval; owned; NULL: none is */
  PetscInt side_count;
  char *sides;     /* names, one per line; owned */
  json_t *summary; /* owned; NULL: an older file */
} LamReactions;

/* Reads the first `count` steps. */
PetscErrorCode LamReactionsRead(const char path[], PetscInt count, LamReactions *reactions);
PetscErrorCode LamReactionsDestroy(LamReactions *reactions);
/* One component of one side over the steps, 2*side + component, with its label; PETSC_FALSE: it is rounding, as the
   free component of a roller. */
PetscBool LamReactionsGet(const LamReactions *reactions, PetscInt column, PetscReal values[],
                          char label[LAM_SERIES_LABEL]);
/* The step with the largest force of the loaded side, or else the largest load factor. */
PetscInt LamReactionsPeak(const LamReactions *reactions);
/* Draws the reactions of all sides against the displacement of the loaded one, or else the load factor, the onsets,
   and certified reactions as error bars. */
PetscErrorCode LamReactionsDraw(LamCanvas canvas, LamRect outer, const LamReactions *reactions);

/* ---- plot_obstacle.c ---- */
typedef struct {
  PetscInt count;
  PetscReal *rows; /* [count][5] as in the file (docs/reference/files.md), mm and 1; owned */
} LamObstacles;
/* Reads those of a step in place of what `obstacles` has; none where the file has none. */
PetscErrorCode LamObstaclesRead(const char path[], PetscInt step, LamObstacles *obstacles);
PetscErrorCode LamObstaclesDestroy(LamObstacles *obstacles);
/* Extends the box of a body of this size so that they are seen. */
void LamObstaclesExtend(const LamObstacles *obstacles, PetscReal size, PetscReal box[4]);
void LamObstaclesDraw(LamCanvas canvas, const LamView *view, const LamObstacles *obstacles);
/* Nodes of gripped sides [node_count], caller frees; NULL: an older file. */
PetscErrorCode LamGripsRead(const char path[], PetscInt node_count, PetscInt **gripped);
/* Draws bands along these sides at positions x, to be half covered by the body; whether there are any. */
PetscBool LamGripsDraw(LamCanvas canvas, const LamView *view, const LamOutline *outline, const PetscReal x[],
                       const PetscInt gripped[]);
/* The legend of all that is rigid from (x, y) to the right; returns its width. */
double LamObstaclesKey(LamCanvas canvas, double x, double y, const LamObstacles *obstacles, PetscBool grips);

/* ---- plot_zoom.c ---- */
#define LAM_PLOT_MAX_ZOOMS 3
typedef struct {
  PetscInt count;
  PetscReal *place, *position; /* [zoom][2] of their points, mm: reference, current; owned */
  PetscReal *apothem;          /* [zoom] um; owned */
  LamTissue tissue[LAM_PLOT_MAX_ZOOMS];
  PetscBool has_interface, is_open; /* contact tissue; gaps in any of them */
  LamColourRange stress, gaps;      /* over all zooms */
} LamZooms;

/* count 0 if the file has none. */
PetscErrorCode LamZoomsRead(const char path[], LamZooms *zooms);
PetscErrorCode LamZoomsDestroy(LamZooms *zooms);
/* Draws the zooms one below the other in `outer`, with their colour bars and legends, and lines to them from their
   points in the body's view. */
PetscErrorCode LamZoomsDraw(LamCanvas canvas, LamRect outer, const LamView *body, const LamZooms *zooms);

#endif
