/* Gmsh meshes: any file becomes a mesh or is refused as the user's mistake, in words. */
#include "fuzz.h"
#include "macro_impl.h"
#include "mesh_sources.h"
#include <stdlib.h>

void __lsan_disable(void) __attribute__((weak)); /* of the leak checker, where there is one */
void __lsan_enable(void) __attribute__((weak));

/* MPI keeps what it has taken at its start. */
int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  if (__lsan_disable) __lsan_disable();
  FuzzCheck(!PetscOptionsSetValue(NULL, "-no_signal_handler", "true"), "PETSc takes no option");
  FuzzCheck(!PetscInitializeNoArguments(), "PETSc cannot be started");
  if (__lsan_enable) __lsan_enable();
  FuzzStart(argc, argv);
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  PetscErrorCode code;
  DM dm = NULL;

  FuzzEnterFolder();
  FuzzWriteFile("mesh.msh", data, size);
  code = LamMacroGmshCreate(PETSC_COMM_SELF, "macro.mesh.gmsh", "mesh.msh", &dm);
  FuzzLeaveFolder();
  FuzzCheck(!code || (code == PETSC_ERR_USER_INPUT && FuzzMessage()[0]), "error %d: %s", code, FuzzMessage());
  FuzzCheck(!DMDestroy(&dm), "the mesh cannot be destroyed");
  return 0;
}
