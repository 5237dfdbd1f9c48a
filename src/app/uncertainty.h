/*
  What `--uncertainty` of `lamella rve` and `lamella process` asks for.
*/
#ifndef LAM_UNCERTAINTY_H
#define LAM_UNCERTAINTY_H

#include "app.h"

typedef struct {
  const char *command;       /* "rve" */
  PetscInt count, processes; /* 0: not given */
  PetscBool failure;
} LamUncertainty;

#define LAM_UNCERTAINTY_OPTION(uncertainty)                                                                            \
  {                                                                                                                    \
    0, "uncertainty", LAM_OPTION_FROM_2, "N",                                                                          \
        "what the scene's block `uncertain` does to the results: solve N samples of it; -o is a folder",               \
        &(uncertainty).count                                                                                           \
  }
/* folder: of uncertainty.json; NULL: none is written. */
PetscErrorCode LamUncertaintyRun(const LamUncertainty *uncertainty, const char scene[], const char folder[],
                                 PetscBool overwrite, PetscBool json, PetscBool quiet, int *exit_status);

#endif
