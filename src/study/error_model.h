/*
  A-priori estimate of the error of P on a mesh: power laws fitted to errors measured on random tissues and loads
  (docs/results/performance.md, "The error of a mesh").
*/
#ifndef LAM_ERROR_MODEL_H
#define LAM_ERROR_MODEL_H

#include <lamella/scene.h>

/* Parameters of the error other than the mesh. */
typedef struct {
  LamInterfaceLawType interface;
  PetscReal thickness; /* of the thickest wall, apothems */
  PetscReal fibres;    /* C4 / C1 */
  PetscReal strain;    /* Frobenius norm of the logarithmic strain, largest over the loads */
} LamErrorCase;

/* Frobenius norm of the in-plane log U, F = R U. */
PetscReal LamStrainSize(const PetscReal F[9]);
/* Error of P (as LamStressError) that 90 % of tissues and loads do not exceed. */
PetscReal LamErrorOfMesh(const LamErrorCase *c, PetscInt along, PetscInt through);
/* The cheapest of the planner's meshes for which LamErrorOfMesh is at most `accuracy`; the finest if there is none. */
void LamCheapestMesh(const LamErrorCase *c, PetscReal accuracy, PetscInt *along, PetscInt *through, PetscReal *grading);

/*
  The fastest mesh whose error is at most `accuracy`, from measurements by `tradeoff` for this tissue (its model.json;
  hash: LamMicrostructureHashTissue). PETSC_ERR_USER_INPUT if the file cannot be read, is of another tissue, or has no
  such mesh.
*/
PetscErrorCode LamMeasuredMesh(const char path[], const char hash[], PetscReal accuracy, PetscInt *along,
                               PetscInt *through, PetscReal *grading);

/* Chooses along, through and grading of scene->micro where the scene leaves them open. */
PetscErrorCode LamChooseMesh(LamScene *scene);

#endif
