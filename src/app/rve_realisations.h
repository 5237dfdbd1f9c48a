/*
  What `lamella rve --realisations` asks for.
*/
#ifndef LAM_RVE_REALISATIONS_H
#define LAM_RVE_REALISATIONS_H

#include "app.h"

typedef struct {
  PetscInt count, processes; /* 0: not given */
  const char *cells;         /* "25,50,100"; NULL: not given */
} LamRealisations;

/* Whether the options fit together; otherwise says what does not. unused: the name of an option that does not go with
   realisations, or NULL. */
PetscBool LamRealisationsFit(const LamRealisations *realisations, const char unused[], int *exit_status);
/* folder: of all files; NULL: the default one. */
PetscErrorCode LamRealisationsRun(const LamRealisations *realisations, const char scene[], const char folder[],
                                  PetscBool overwrite, PetscBool json, PetscBool quiet, int *exit_status);

#endif
