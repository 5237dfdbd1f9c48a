#include "displaced.h"

NodeVectors Displaced(const PetscReal X[][2], const PetscReal x[][2])
{
  NodeVectors v;

  for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; i++) v.u[i / 2][i % 2] = x[i / 2][i % 2] - X[i / 2][i % 2];
  return v;
}
