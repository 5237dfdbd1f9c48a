/*
  Private to the picture of a map: its data.
*/
#ifndef LAM_PLOT_MAP_H
#define LAM_PLOT_MAP_H

#include "plot.h"
#include "failure.h"

/* One axis: positions of its points and of the edges of their cells, as logarithms if the spacing is logarithmic. */
typedef struct {
  PetscInt n;
  PetscReal from, to;   /* the first and last value */
  PetscReal *at, *edge; /* [n], [n + 1]; owned */
  PetscBool is_log;
  char quantity[LAM_NAME_LENGTH], unit[LAM_NAME_LENGTH], label[192];
} LamMapSide;

typedef struct {
  LamMapSide x, y;
  PetscInt n;             /* number of points of the map */
  PetscInt *mode;         /* [n] a LamFailureMode, -1: not computed yet; owned */
  PetscReal *load_factor; /* [n]; owned */
  PetscReal *shear;       /* [n] F12 of the record; owned */
  PetscReal *value;       /* [n] of the field; owned */
  const char *field, *unit;
  LamColourRange range;
  PetscBool has_path; /* a path will be drawn over the modes: the legend names it */
} LamMapPicture;
static const LamColour LamPathColour = {0.75, 0.1, 0.1};

/* ---- plot_map_read.c: PETSC_ERR_USER_INPUT if the file lacks data or the request does not fit ---- */
PetscErrorCode LamMapRead(const char path[], LamMapPicture *picture); /* axes and modes alone */
PetscErrorCode LamMapPictureRead(const LamPlotRequest *request, LamMapPicture *picture);
PetscErrorCode LamMapPictureDestroy(LamMapPicture *picture);

/* ---- plot_map.c ---- */
/* Draws the modes alone, with their legend, inside `outer`; *axes: for drawing a path on the map. */
PetscErrorCode LamMapDrawModes(LamCanvas canvas, LamRect outer, const LamMapPicture *picture, LamAxes *axes);

#endif
