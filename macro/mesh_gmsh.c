/*
  Meshes from Gmsh files, read by DMPlex: formats 2.2, 4.0 and 4.1, text and binary; triangles and quadrilaterals,
  straight or quadratic. Physical groups become labels of their names.
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

PetscErrorCode LamMacroGmshCreate(MPI_Comm comm, const char path[], DM *dm)
{
  PetscErrorCode ierr;
  PetscInt dim, elements;

  PetscFunctionBeginUser;
  PetscCall(CheckFile(comm, path));
  PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_use_regions", "1"));
  PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_spacedim", "2"));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = DMPlexCreateGmshFromFile(comm, path, PETSC_TRUE, dm);
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscOptionsClearValue(NULL, "-dm_plex_gmsh_use_regions"));
  PetscCall(PetscOptionsClearValue(NULL, "-dm_plex_gmsh_spacedim"));
  PetscCheck(!ierr, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
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
