/*
  A material law for other programs: stress and tangent in SI units and plain arrays; of PETSc only its error codes.

    LamMaterialCreateFromScene(path, points, &material)   or   LamMaterialCreateFromDatabase(path, &material)
    LamMaterialEvaluate(material, n, points, F, turgor, cohesion, P, tangent, info)     in each iteration
    LamMaterialAccept(material)  or  LamMaterialReject(material)                        at the end of a load step
    LamMaterialDestroy(&material)

  From a scene each evaluation solves an RVE; a numbered material point starts from its own last state. From a
  database it interpolates, keeps no states, and is thread-safe.

  F and P are 3 x 3, row-major (11 12 13 21 22 23 31 32 33); P is the first Piola-Kirchhoff stress, Pa. The tangent is
  dP_ij/dF_kl, 9 x 9: row ij, column kl, Pa. The cells' axis is direction 3. F is that of plane strain with any F33, of
  a database the F33 that it covers; derivatives of and with respect to out-of-plane shears are NaN. A scene has any F
  and all derivatives after LamMaterialSetOutOfPlane, for three-dimensional bodies. LamErrorMessage (error.h) returns the
  text of an error.

  A material belongs to its rank: no call waits for other ranks. Where the program has started neither PETSc nor MPI, the
  first material starts them for this rank alone; a program that uses them with its other ranks starts them before.
*/
#ifndef LAMELLA_MATERIAL_H
#define LAMELLA_MATERIAL_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamMaterial_s *LamMaterial;

/* Further results for a state. */
typedef struct {
  int status;            /* LamStatus of response.h; 0: converged. Stress and tangent are NaN if there is no response */
  int trusted;           /* from a database: the surrounding states agree; 1 for a solve */
  double error_estimate; /* relative error of P; NaN: unknown */
  double debonded_fraction; /* fraction of the interface without contact; NaN for bonded tissue */
  double max_gap;           /* between facing walls, m */
  double turgor;            /* mean pressure in the cells, Pa */
  char reason[192];         /* why the status is not `converged`; otherwise empty */
} LamMaterialInfo;

/* `points`: number of material points that keep a state, numbered from 0. PETSC_ERR_USER_INPUT for a patch, which is
   not a material point. */
LAM_EXPORT PetscErrorCode LamMaterialCreateFromScene(const char path[], int points, LamMaterial *material);
LAM_EXPORT PetscErrorCode LamMaterialCreateFromDatabase(const char path[], LamMaterial *material);
LAM_EXPORT PetscErrorCode LamMaterialDestroy(LamMaterial *material);

/*
  Any F, and all entries of the tangent: a quarter more time for each solve. Of a scene, before the first evaluation,
  and undeformed again afterwards; default: off, unless the scene's loads or fibres leave the section. PETSC_ERR_SUP for
  a database.
*/
LAM_EXPORT PetscErrorCode LamMaterialSetOutOfPlane(LamMaterial material, int on);
/* Turgor and cohesion of the scene, Pa: defaults of LamMaterialEvaluate. */
LAM_EXPORT PetscErrorCode LamMaterialGetLoads(LamMaterial material, double *turgor, double *cohesion);
/* Largest relative error of P at which a database responds; default: the scene's accuracy. */
LAM_EXPORT PetscErrorCode LamMaterialSetAccuracy(LamMaterial material, double accuracy);

/*
  Evaluates n states. points [n]: number of the material point; -1: none, starts from the reference state; NULL: no
  point has a number. F [n][9]; turgor, cohesion [n] in Pa, NULL: those of the scene. P [n][9]; tangent [n][81] and
  info [n], or NULL. A state without a response is not an error: info contains the reason.
*/
LAM_EXPORT PetscErrorCode LamMaterialEvaluate(LamMaterial material, int n, const int points[], const double F[],
                                              const double turgor[], const double cohesion[], double P[],
                                              double tangent[], LamMaterialInfo info[]);
/* Accept: the last states become the starting points of the next load step. Reject: restores those at the start of
   the current one. */
LAM_EXPORT PetscErrorCode LamMaterialAccept(LamMaterial material);
LAM_EXPORT PetscErrorCode LamMaterialReject(LamMaterial material);

/* The accepted state of a point as bytes, for restart files; 0 bytes from a database. */
LAM_EXPORT PetscErrorCode LamMaterialGetStateSize(LamMaterial material, size_t *bytes);
LAM_EXPORT PetscErrorCode LamMaterialSaveState(LamMaterial material, int point, void *bytes);
LAM_EXPORT PetscErrorCode LamMaterialRestoreState(LamMaterial material, int point, const void *bytes);

LAM_C_END

#endif
