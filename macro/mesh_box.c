/*
  A box of n1 x n2 elements with a corner at the origin. Edges of elements along an axis are a geometric series: the
  last one is `grading` times the first one.
*/
#include "macro_impl.h"
#include "mesh_sources.h"

/* Moves a coordinate of an even grid. */
static PetscReal Graded(PetscReal x, PetscReal edge, PetscInt n, PetscReal grading)
{
  const PetscReal ratio = n > 1 ? PetscPowReal(grading, 1.0 / (PetscReal)(n - 1)) : 1;

  if (PetscAbsReal(ratio - 1) < PETSC_SMALL) return x;
  return edge * (PetscPowReal(ratio, x / edge * (PetscReal)n) - 1) / (PetscPowReal(ratio, (PetscReal)n) - 1);
}

PetscErrorCode LamMacroBoxCreate(MPI_Comm comm, const LamMacroSpec *spec, DM *dm)
{
  const PetscReal lower[2] = {0, 0};
  Vec coordinates;
  PetscScalar *x;
  PetscInt size;

  PetscFunctionBeginUser;
#if PETSC_VERSION_GE(3, 22, 0)
  PetscCall(
      DMPlexCreateBoxMesh(comm, 2, PETSC_FALSE, spec->elements, lower, spec->box, NULL, PETSC_TRUE, 0, PETSC_TRUE, dm));
#else
  PetscCall(DMPlexCreateBoxMesh(comm, 2, PETSC_FALSE, spec->elements, lower, spec->box, NULL, PETSC_TRUE, dm));
#endif
  if (spec->grading[0] == 0) PetscFunctionReturn(0); /* not given */
  PetscCall(DMGetCoordinatesLocal(*dm, &coordinates));
  PetscCall(VecGetLocalSize(coordinates, &size));
  PetscCall(VecGetArray(coordinates, &x));
  for (PetscInt k = 0; k < size; k++)
    x[k] = Graded(PetscRealPart(x[k]), spec->box[k % 2], spec->elements[k % 2], spec->grading[k % 2]);
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscFunctionReturn(0);
}
