/*
  A material law for other programs: stress and tangent in SI units, plain arrays, no type of PETSc's but error codes.

    LamMaterialCreateFromScene(path, points, &material)   or   LamMaterialCreateFromDatabase(path, &material)
    LamMaterialEvaluate(material, n, points, F, turgor, cohesion, P, tangent, info)     in each iteration
    LamMaterialAccept(material)  or  LamMaterialReject(material)                        at the end of a load step
    LamMaterialDestroy(&material)

  From a scene each evaluation solves an RVE; a material point that has a number starts from its own last state. From a
  database it interpolates, keeps no states, and may be called from several threads at once.

  F and P are 3 x 3, row-major (11 12 13 21 22 23 31 32 33); P is the first Piola-Kirchhoff stress, Pa. The tangent is
  dP_ij/dF_kl, 9 x 9: row ij, column kl, Pa. Tissue is in plane strain: F33 = 1, and no out-of-plane shear;
  derivatives by and of out-of-plane shears are NaN, for they are not known.
  Needs PetscInitialize; LamErrorMessage (error.h) has the words of an error.
*/
#ifndef LAMELLA_MATERIAL_H
#define LAMELLA_MATERIAL_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamMaterial_s *LamMaterial;

/* What else is known of a state. */
typedef struct {
  int status;               /* LamStatus of response.h; 0: converged. Stress and tangent are NaN where there is none */
  int trusted;              /* of a database: the states around agree; 1 for a solve */
  double error_estimate;    /* relative error of P; NaN: not known */
  double debonded_fraction; /* of the interface, without contact; NaN for bonded tissue */
  double max_gap;           /* between facing walls, m */
  double turgor;            /* mean pressure in the cells, Pa */
  char reason[192];         /* why the status is not `converged`; else empty */
} LamMaterialInfo;

/* `points`: material points that keep a state, numbered from 0. PETSC_ERR_USER_INPUT for a scene that is no material
   point: a patch. */
LAM_EXPORT PetscErrorCode LamMaterialCreateFromScene(const char path[], int points, LamMaterial *material);
LAM_EXPORT PetscErrorCode LamMaterialCreateFromDatabase(const char path[], LamMaterial *material);
LAM_EXPORT PetscErrorCode LamMaterialDestroy(LamMaterial *material);

/* Turgor and cohesion of the scene, Pa: what holds where an evaluation gives none. */
LAM_EXPORT PetscErrorCode LamMaterialGetLoads(LamMaterial material, double *turgor, double *cohesion);
/* Error of P up to which a database responds, relative; the scene's to begin with. */
LAM_EXPORT PetscErrorCode LamMaterialSetAccuracy(LamMaterial material, double accuracy);

/*
  Evaluates n states. points [n]: number of the material point, -1: none, from the reference state; NULL: none has any.
  F [n][9]; turgor, cohesion [n] in Pa, NULL: those of the scene. P [n][9]; tangent [n][81] and info [n], or NULL.
  A state without a response is no error: its info says why.
*/
LAM_EXPORT PetscErrorCode LamMaterialEvaluate(LamMaterial material, int n, const int points[], const double F[],
                                              const double turgor[], const double cohesion[], double P[],
                                              double tangent[], LamMaterialInfo info[]);
/* The last states become those that a load step starts from; or are given up for the ones that it started from. */
LAM_EXPORT PetscErrorCode LamMaterialAccept(LamMaterial material);
LAM_EXPORT PetscErrorCode LamMaterialReject(LamMaterial material);

/* The accepted state of a point as bytes, to be kept beside a restart file; 0 bytes from a database. */
LAM_EXPORT PetscErrorCode LamMaterialGetStateSize(LamMaterial material, size_t *bytes);
LAM_EXPORT PetscErrorCode LamMaterialSaveState(LamMaterial material, int point, void *bytes);
LAM_EXPORT PetscErrorCode LamMaterialRestoreState(LamMaterial material, int point, const void *bytes);

LAM_C_END

#endif
