/*
  The mesh of a scene: the cheapest whose error is below the prescribed accuracy, measured on trial loads of one cell.
*/
#ifndef LAM_MESH_CHOICE_H
#define LAM_MESH_CHOICE_H

#include "study.h"

/* ---- mesh_trial.c ---- */
typedef struct {
  PetscInt along, through;
  PetscReal grading;
  PetscReal error;   /* of P (LamWholeError), largest over the trial loads; NaN: none of them has a known solution */
  PetscInt loads;    /* trial loads with a known solution */
  PetscBool tried;   /* PETSC_FALSE: the mesh is given or was measured by `tradeoff`, and nothing above is set */
  PetscBool stopped; /* before the trial had found a mesh (stop.h): the mesh is a usual one */
} LamMeshTrial;
/*
  Solves trial loads of the scene on one cell, on meshes of increasing cost and on a much finer one, and returns the
  first mesh whose error is below scene->accuracy with a margin; the finest if there is none, with its error. The trial
  loads: states of the scene's load, of its sample, or usual ones for a body. Of different cells the thickest and the
  thinnest are tried.
*/
PetscErrorCode LamTryMeshes(const LamScene *scene, LamMeshTrial *trial);

/* Along, through and grading of mesh k of the planner's list, by increasing cost; PETSC_FALSE beyond its end. */
PetscBool LamListedMesh(LamInterfaceLawType interface, PetscInt k, LamMeshTrial *mesh);

/* ---- mesh_choice.c ---- */
/*
  The fastest mesh whose error is at most `accuracy`, from measurements by `tradeoff` for this tissue (its model.json;
  hash: LamMicrostructureHashTissue). PETSC_ERR_USER_INPUT if the file cannot be read, is of another tissue, or has no
  such mesh.
*/
PetscErrorCode LamMeasuredMesh(const char path[], const char hash[], PetscReal accuracy, PetscInt *along,
                               PetscInt *through, PetscReal *grading);

/* Chooses along, through and grading of scene->micro where the scene leaves them open; a mesh that was not given is
   tried. trial: what was measured; may be NULL. */
PetscErrorCode LamChooseMesh(LamScene *scene, LamMeshTrial *trial);
/* Warns on rank 0 if the trial says that the accuracy is not reached, or not known to be. */
void LamWarnOfMesh(MPI_Comm comm, const LamReporter *reporter, const LamScene *scene, const LamMeshTrial *trial);

#endif
