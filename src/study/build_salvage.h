/*
  Private to `lamella build`: a database that is damaged.
*/
#ifndef LAM_BUILD_SALVAGE_H
#define LAM_BUILD_SALVAGE_H

#include "app.h"

/*
  Makes PATH anew of all sound records of it, with the microstructure (mesh chosen) and units of the scene; the damaged
  file is kept as PATH.damaged. The grid is the file's own where it can still be read, else `grid`. `tell` hears what
  is found, a line each; NULL: nobody does. Takes the lock of PATH meanwhile. Killed at any instant, PATH is as it was
  or made anew. PETSC_ERR_USER_INPUT, with PATH as it was: it is of other tissue, or holds no sound record, or
  PATH.damaged is there from before. *report: how many records there are, and how many are left out.
*/
PetscErrorCode LamBuildSalvage(const LamScene *scene, LamGrid grid, const char path[], void (*tell)(const char words[]),
                               LamMergeReport *report);

#endif
