/*
  Private to the pictures of a process: the data of its file.
*/
#ifndef LAM_PLOT_PROCESS_H
#define LAM_PLOT_PROCESS_H

#include "plot_tissue.h"
#include "plot_time.h"
#include <lamella/process.h>

/* Arrays over the states, as docs/reference/files.md describes them; all owned. */
typedef struct {
  const char *path;     /* borrowed */
  LamDatabase database; /* owns `records` */
  LamMicrostructure micro;
  LamScales scales;
  PetscInt n;
  const LamResponse *records;
  LamTimeLine line;
  PetscReal *turgor, *cohesion, *osmotic, *outside, *firmness, *walls;
  PetscInt factor_count, ratio_count; /* number of changing factors, of known ratios; names with blanks */
  PetscReal *factor[16], *ratio[8];
  char factor_name[16][LAM_NAME_LENGTH], ratio_name[8][LAM_NAME_LENGTH];
} LamProcessPicture;

/* ---- plot_process_read.c: PETSC_ERR_USER_INPUT if the file lacks something ---- */
PetscErrorCode LamProcessPictureRead(const char path[], LamProcessPicture *picture);
PetscErrorCode LamProcessPictureDestroy(LamProcessPicture *picture);

/* ---- plot_process.c ---- */
/* Draws firmness, pressures, changing quantities and separation against time, inside `outer`; `now` >= 0: a state to
   mark. */
PetscErrorCode LamProcessDraw(LamCanvas canvas, LamRect outer, const LamProcessPicture *picture, PetscInt now);

#endif
