/*
  Pictures of FE2 runs: what their parts share. plot_fe2.c draws the body and the page, plot_fe2_curve.c the reactions,
  plot_fe2_time.c what changes in time, plot_zoom.c the microstructure at chosen points.
*/
#ifndef LAM_PLOT_FE2_H
#define LAM_PLOT_FE2_H

#include "plot_tissue.h"
#include "plot_time.h"
#include <lamella/process.h>
#include <jansson.h>

/* ---- plot_fe2_curve.c ---- */
typedef struct {
  PetscInt count;  /* of steps */
  PetscReal *load; /* [step] load factor; owned */
  PetscReal *x;    /* [step] displacement of the loaded side, mm; owned; NULL: there is none, or the file is older */
  PetscReal *reaction; /* [step][side][2], N/mm; owned */
  PetscInt side_count;
  char *sides;     /* names, one per line; owned */
  json_t *summary; /* owned; NULL: the file is older */
} LamReactions;

/* Of the first `count` steps. */
PetscErrorCode LamReactionsRead(const char path[], PetscInt count, LamReactions *reactions);
PetscErrorCode LamReactionsDestroy(LamReactions *reactions);
/* Name of a side. */
void LamReactionsSideName(const LamReactions *reactions, PetscInt side, size_t size, char name[]);
/* Reactions of all sides, over the displacement of the loaded one or else the load factor, and the onsets. */
PetscErrorCode LamReactionsDraw(LamCanvas canvas, LamRect outer, const LamReactions *reactions);

/* ---- plot_fe2_time.c ---- */
/* Arrays over the steps; owned. */
typedef struct {
  PetscBool there; /* the run was one of `process` */
  LamTimeLine line;
  PetscReal *turgor[3], *water, *plasmolysed, *debonded; /* turgor: least, mean, largest */
  PetscInt factor_count, ratio_count; /* of those that change, and that are known; names with blanks */
  PetscReal *factor[16], *ratio[8];
  char factor_name[16][LAM_NAME_LENGTH], ratio_name[8][LAM_NAME_LENGTH];
} LamBodyTimes;
PetscErrorCode LamBodyTimesRead(const char path[], PetscInt steps, LamBodyTimes *times);
PetscErrorCode LamBodyTimesDestroy(LamBodyTimes *times);
/* Four charts, with a mark at the step `now`. */
PetscErrorCode LamBodyTimesDraw(LamCanvas canvas, LamRect outer, const LamBodyTimes *times,
                                const LamReactions *reactions, PetscInt now);

/* ---- plot_zoom.c ---- */
#define LAM_PLOT_MAX_ZOOMS 3
typedef struct {
  PetscInt count;
  PetscReal *place, *position; /* [zoom][2] of their points, mm: reference, present; owned */
  PetscReal *apothem;          /* [zoom] um; owned */
  LamTissue tissue[LAM_PLOT_MAX_ZOOMS];
  PetscBool has_interface, is_open; /* contact tissue, with gaps in any of them */
  LamColourRange stress, gaps;      /* of all */
} LamZooms;

/* count 0 where the file has none. */
PetscErrorCode LamZoomsRead(const char path[], LamZooms *zooms);
PetscErrorCode LamZoomsDestroy(LamZooms *zooms);
/* One below the other in `outer`, with their colour bars and keys; lines lead there from the points in the body's view.
 */
PetscErrorCode LamZoomsDraw(LamCanvas canvas, LamRect outer, const LamView *body, const LamZooms *zooms);

#endif
