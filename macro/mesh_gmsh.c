/*
  Meshes from Gmsh files, read by DMPlex: formats 2.2, 4.0 and 4.1, text and binary; triangles and quadrilaterals,
  straight or quadratic. Physical groups become labels of their names. PETSc places the nodes of curved edges only where
  all elements are of one kind.
*/
#include <errno.h>
#include <stdio.h>
#include "macro_impl.h"

/* Rank 0 looks before PETSc does, whose messages know nothing of the user's file. Returns 0, or why it is no mesh. */
static const char *Refusal(const char path[])
{
  char line[64] = "";
  FILE *file = fopen(path, "r");

  if (!file) return strerror(errno);
  if (!fgets(line, sizeof(line), file)) line[0] = '\0';
  fclose(file);
  return strncmp(line, "$MeshFormat", 11) ? "is no Gmsh mesh: it does not begin with $MeshFormat" : NULL;
}

static PetscErrorCode CheckFile(MPI_Comm comm, const char path[])
{
  char why[128] = "";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    const char *refusal = Refusal(path);
    if (refusal) PetscCall(PetscStrncpy(why, refusal, sizeof(why)));
  }
  PetscCallMPI(MPI_Bcast(why, sizeof(why), MPI_CHAR, 0, comm));
  PetscCheck(!why[0], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "macro.mesh.gmsh: %s: %s", path, why);
  PetscFunctionReturn(0);
}

/* Lets PETSc read the file, places of nodes on curved edges included or not; *ierr is what it says. */
static PetscErrorCode Read(MPI_Comm comm, const char path[], PetscBool curved, DM *dm, PetscErrorCode *ierr)
{
  static const char *const options[][2] = {{"-dm_plex_gmsh_use_regions", "1"}, {"-dm_plex_gmsh_spacedim", "2"}};

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(PetscOptionsSetValue(NULL, options[k][0], options[k][1]));
  if (!curved) PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_highorder", "0")); /* "1" fails for straight files */
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  *ierr = DMPlexCreateGmshFromFile(comm, path, PETSC_TRUE, dm);
  PetscCall(PetscPopErrorHandler());
  for (int k = 0; k < 2; k++) PetscCall(PetscOptionsClearValue(NULL, options[k][0]));
  PetscCall(PetscOptionsClearValue(NULL, "-dm_plex_gmsh_highorder"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGmshCreate(MPI_Comm comm, const char path[], DM *dm)
{
  PetscErrorCode curved, straight = 1;
  PetscInt dim, elements;

  PetscFunctionBeginUser;
  PetscCall(CheckFile(comm, path));
  PetscCall(Read(comm, path, PETSC_TRUE, dm, &curved));
  if (curved) PetscCall(Read(comm, path, PETSC_FALSE, dm, &straight));
  PetscCheck(!curved || straight, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "macro.mesh.gmsh: %s: PETSc reads quadratic meshes of triangles alone, or of quadrilaterals with a middle "
             "node alone, which this is not; mesh with one kind of elements, or with straight edges (gmsh -order 1)",
             path);
  PetscCheck(!curved, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "macro.mesh.gmsh: %s: PETSc cannot read this mesh; write it with gmsh -2 -format msh41 or msh22", path);
  PetscCall(DMGetDimension(*dm, &dim));
  PetscCheck(
      dim == 2, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "macro.mesh.gmsh: %s: its elements have %d dimensions; the body is plane: mesh a surface in the plane X3 = 0",
      path, (int)dim);
  PetscCall(DMPlexGetHeightStratum(*dm, 0, NULL, &elements));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &elements, 1, MPIU_INT, MPI_MAX, comm));
  PetscCheck(elements > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "macro.mesh.gmsh: %s: holds no element", path);
  PetscFunctionReturn(0);
}
