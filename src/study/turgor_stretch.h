/*
  An a priori estimate of how far turgor stretches the walls of free tissue: a turgor beyond what they hold is most
  often a mistake of units.
*/
#ifndef LAM_TURGOR_STRETCH_H
#define LAM_TURGOR_STRETCH_H

#include "study.h"

/* Stretch of the walls of tissue that is free of stress under its turgor, by the balance of a section; the largest one
   if cells differ. Infinite: beyond 10, or none is in balance. */
PetscReal LamTurgorStretch(const LamMicrostructure *micro, PetscReal turgor);
#define LAM_TURGOR_TEXT 480
/* One sentence if the walls of the scene, or of a region, are stretched by more than half by the largest turgor of a
   block; else empty. Fields of turgor are not evaluated. */
void LamTurgorWarning(const LamScene *scene, char text[LAM_TURGOR_TEXT]);
/* Reports it. On rank 0. */
void LamWarnOfTurgor(const LamReporter *reporter, const LamScene *scene);

#endif
