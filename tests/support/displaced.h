/* Displacements of an element's nodes from their positions, as the element wants them. */
#ifndef LAM_SUPPORT_DISPLACED_H
#define LAM_SUPPORT_DISPLACED_H

#include "element.h"

typedef struct {
  PetscReal u[LAM_ELEMENT_NODES][2];
} NodeVectors;

NodeVectors Displaced(const PetscReal X[][2], const PetscReal x[][2]);

#endif
