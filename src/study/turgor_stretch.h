/*
  An a priori estimate of how far turgor stretches the walls of free tissue: a turgor beyond what they hold is most
  often a mistake of units.
*/
#ifndef LAM_TURGOR_STRETCH_H
#define LAM_TURGOR_STRETCH_H

#include "study.h"

/* What turgor does to the walls of tissue that is free of stress, by the balance of sections; the largest of all cells.
   A stretch is infinite beyond 10, or where none is in balance. */
typedef struct {
  PetscReal along;   /* stretch along the walls, in the section */
  PetscReal axial;   /* along the cells' axis; 1 in plane strain */
  PetscReal tension; /* Cauchy stress along the walls plus turgor */
} LamInflated;
LamInflated LamInflatedTissue(const LamMicrostructure *micro, PetscReal turgor, PetscBool free_axis);
#define LAM_TURGOR_TEXT 520
/* One sentence if the largest turgor of a block would stretch free tissue of the scene, or of a region, by more than
   half in any direction, or if the tissue is inflated and its turgor puts a tension above their strength on the walls;
   else empty. Fields of turgor are not evaluated. */
void LamTurgorWarning(const LamScene *scene, char text[LAM_TURGOR_TEXT]);
/* Reports it. On rank 0. */
void LamWarnOfTurgor(const LamReporter *reporter, const LamScene *scene);

#endif
