/* Displacements of an element's nodes from their positions, as the element wants them. */
#ifndef LAM_TEST_DISPLACED_H
#define LAM_TEST_DISPLACED_H

#include "element.h"

typedef struct {
  PetscReal u[LAM_ELEMENT_NODES][2];
} NodeVectors;

static inline NodeVectors Displaced(const PetscReal X[][2], const PetscReal x[][2])
{
  NodeVectors v;

  for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; i++) v.u[i / 2][i % 2] = x[i / 2][i % 2] - X[i / 2][i % 2];
  return v;
}

#endif
