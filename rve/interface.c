/* What pictures need to know of the interfaces. */
#include "rve_impl.h"

PetscErrorCode LamRVEGetInterfaceSize(LamRVE rve, PetscInt *faces, PetscInt *points)
{
  PetscFunctionBeginUser;
  *faces = rve->micro.interface == LAM_INTERFACE_CONTACT ? 3 * rve->mesh.cell_count : 0;
  *points = 4 * rve->mesh.along + 1;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEGetInterface(LamRVE rve, LamRVEState state, PetscReal from[], PetscReal to[], PetscReal gap[],
                                  PetscReal pressure[])
{
  PetscFunctionBeginUser;
  (void)rve, (void)state, (void)from, (void)to, (void)gap, (void)pressure;
  PetscFunctionReturn(0);
}
