/*
  Meshes from Gmsh files, read by DMPlex: formats 2.2, 4.0 and 4.1, text and binary; triangles and quadrilaterals,
  straight or quadratic. Physical groups become labels of their names. PETSc reads the nodes of curved edges only if
  all elements are of one kind.
*/
#include "macro_impl.h"
#include "mesh_sources.h"

/* Rank 0 checks the file before PETSc reads it: PETSc does not validate it, and its error messages do not name it. */
static PetscErrorCode CheckFile(MPI_Comm comm, const char key[], const char path[])
{
  char why[LAM_GMSH_WHY] = "";
  PetscBool good = PETSC_TRUE;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) good = LamGmshCheck(path, why);
  PetscCallMPI(MPI_Bcast(&good, 1, MPIU_BOOL, 0, comm));
  PetscCallMPI(MPI_Bcast(why, sizeof(why), MPI_CHAR, 0, comm));
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s: %s", key, path, why);
  PetscFunctionReturn(0);
}

/* Reads the file with PETSc, with or without the nodes on curved edges; *ierr: PETSc's error code. */
static PetscErrorCode Read(MPI_Comm comm, const char path[], PetscBool curved, DM *dm, PetscErrorCode *ierr)
{
  static const char *const options[][2] = {{"-dm_plex_gmsh_use_regions", "1"},
                                           {"-dm_plex_gmsh_spacedim", "2"},
                                           {"-dm_plex_gmsh_periodic", "0"}}; /* periodic sides are not identified */

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(options); k++)
    PetscCall(PetscOptionsSetValue(NULL, options[k][0], options[k][1]));
  if (!curved) PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_highorder", "0")); /* "1" fails for straight files */
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  *dm = NULL;
  *ierr = DMPlexCreateGmshFromFile(comm, path, PETSC_TRUE, dm);
  PetscCall(PetscPopErrorHandler());
  if (*ierr) PetscCall(DMDestroy(dm)); /* free what was created */
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(options); k++)
    PetscCall(PetscOptionsClearValue(NULL, options[k][0]));
  PetscCall(PetscOptionsClearValue(NULL, "-dm_plex_gmsh_highorder"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGmshCreate(MPI_Comm comm, const char key[], const char path[], DM *dm)
{
  PetscErrorCode curved, straight = 1;

  PetscFunctionBeginUser;
  PetscCall(CheckFile(comm, key, path));
  PetscCall(Read(comm, path, PETSC_TRUE, dm, &curved));
  if (curved) PetscCall(Read(comm, path, PETSC_FALSE, dm, &straight));
  PetscCheck(!curved || straight, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s: PETSc reads quadratic meshes of triangles alone, or of quadrilaterals with a middle "
             "node alone, which this is not; mesh with one kind of elements, or with straight edges (gmsh -order 1)",
             key, path);
  PetscCheck(!curved, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s: PETSc cannot read this mesh; write it with gmsh -2 -format msh41 or msh22", key, path);
  PetscFunctionReturn(0);
}
