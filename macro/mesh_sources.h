/*
  Where meshes come from: boxes, discs, files of Gmsh.
*/
#ifndef LAM_MESH_SOURCES_H
#define LAM_MESH_SOURCES_H

#include <petscdmplex.h>
#include <lamella/scene.h>

/* mesh_box.c */
PetscErrorCode LamMacroBoxCreate(MPI_Comm comm, const LamMacroSpec *spec, DM *dm);
/* mesh_disc.c: a disc of radius 1 or a part of it about the origin, with named sides. */
PetscErrorCode LamMacroDiscCreate(MPI_Comm comm, LamDiscPart part, const PetscInt elements[2], DM *dm);
/* mesh_gmsh.c; `key`: "scene.yaml:6:16: macro.mesh.gmsh", for messages. Labels of its physical groups, all of stratum 1,
   are called SET or REGION and the group's name: of points and curves, or of surfaces. */
#define LAM_MESH_SET "set "
#define LAM_MESH_REGION "region "
PetscErrorCode LamMacroGmshCreate(MPI_Comm comm, const char key[], const char path[], DM *dm);

#endif
