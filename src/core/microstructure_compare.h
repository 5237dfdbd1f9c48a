/*
  Where two microstructures differ, in the keys of a scene.
*/
#ifndef LAM_MICROSTRUCTURE_COMPARE_H
#define LAM_MICROSTRUCTURE_COMPARE_H

#include <lamella/scene.h>

#define LAM_DIFFERENCE_LENGTH 500
/* Writes "rve.mesh.along is 6, in the scene 8; ..." to `text`, empty where both have the same description. `where`:
   what holds the other one, "the scene". */
PetscErrorCode LamMicrostructureCompare(const LamMicrostructure *one, const LamMicrostructure *other,
                                        const char where[], char text[LAM_DIFFERENCE_LENGTH]);

#endif
