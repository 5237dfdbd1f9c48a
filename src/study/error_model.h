/*
  How large the error of P is on a mesh, before anything is solved: measured on random tissues and loads, fitted by
  powers (docs/results/performance.md, "The error of a mesh").
*/
#ifndef LAM_ERROR_MODEL_H
#define LAM_ERROR_MODEL_H

#include <lamella/scene.h>

/* What the error depends on beside the mesh. */
typedef struct {
  LamInterfaceLawType interface;
  PetscReal thickness; /* of the thickest wall, apothems */
  PetscReal fibres;    /* C4 / C1 */
  PetscReal strain;    /* Frobenius norm of the logarithmic strain, the largest of the loads */
} LamErrorCase;

/* Frobenius norm of log U, F = R U, in the plane. */
PetscReal LamStrainSize(const PetscReal F[9]);
/* The error of P, as LamStressError, that 90 of 100 tissues and loads stay below. */
PetscReal LamErrorOfMesh(const LamErrorCase *c, PetscInt along, PetscInt through);
/* The cheapest mesh of those that the planner knows with that error at most `accuracy`; the finest, if none has. */
void LamCheapestMesh(const LamErrorCase *c, PetscReal accuracy, PetscInt *along, PetscInt *through, PetscReal *grading);

/*
  The same by what `tradeoff` has measured of a tissue (its model.json; hash: LamMicrostructureHashTissue): the fastest
  mesh with a measured error at most `accuracy`. PETSC_ERR_USER_INPUT with the reason where the file cannot be read, is
  of another tissue, or none of its meshes will do.
*/
PetscErrorCode LamMeasuredMesh(const char path[], const char hash[], PetscReal accuracy, PetscInt *along,
                               PetscInt *through, PetscReal *grading);

#endif
