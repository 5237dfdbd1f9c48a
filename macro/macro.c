/*
  Creation, set-up and destruction of the macroscale solver.
*/
#include <math.h>
#include "macro_impl.h"

PetscErrorCode LamMacroCreate(MPI_Comm comm, LamMacro *macro)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(macro));
  (*macro)->comm = comm;
  (*macro)->extrapolates = PETSC_TRUE;
  (*macro)->step.time = NAN;
  (*macro)->lamella = (*macro)->walls = 1;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetScene(LamMacro macro, const LamScene *scene)
{
  PetscFunctionBeginUser;
  PetscCheck(scene->has_macro, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: macro: missing; a macroscale run needs this block", scene->path);
  PetscCall(LamMacroBoundaryNames(&scene->macro, &macro->step));
  macro->scene = scene;
  PetscFunctionReturn(0);
}

static PetscErrorCode CreatePoints(LamMacro macro)
{
  PetscInt n = macro->point_count;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &macro->point_index));
  for (PetscInt p = 0; p < n; p++) macro->point_index[p] = p;
  PetscCall(PetscCalloc1(n, &macro->loads));
  PetscCall(PetscCalloc1(n, &macro->responses));
  PetscCall(PetscCalloc1(n, &macro->now));
  PetscCall(PetscCalloc1(n, &macro->accepted));
  PetscCall(PetscMalloc1(n, &macro->turgor_share));
  PetscCall(PetscMalloc1(n, &macro->cohesion));
  for (PetscInt p = 0; p < n; p++) {
    macro->turgor_share[p] = macro->scene->turgor;
    macro->cohesion[p] = macro->scene->cohesion;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateUnknowns(LamMacro macro)
{
  PetscInt local;

  PetscFunctionBeginUser;
  PetscCall(DMCreateGlobalVector(macro->dm, &macro->u));
  PetscCall(VecDuplicate(macro->u, &macro->trial));
  PetscCall(VecDuplicate(macro->u, &macro->residual));
  PetscCall(VecDuplicate(macro->u, &macro->origin));
  PetscCall(VecDuplicate(macro->u, &macro->force));
  PetscCall(VecDuplicate(macro->u, &macro->force_accepted));
  PetscCall(VecZeroEntries(macro->u));
  PetscCall(VecZeroEntries(macro->origin));
  PetscCall(VecZeroEntries(macro->force_accepted));
  PetscCall(VecGetLocalSize(macro->u, &local));
  PetscCall(VecDuplicate(macro->u, &macro->external));
  PetscCall(VecDuplicate(macro->u, &macro->before));
  PetscCall(PetscMalloc1(local, &macro->constraints));
  PetscCall(PetscMalloc1(local, &macro->rows));
  PetscCall(DMSetMatType(macro->dm, MATAIJ));
  PetscCall(DMCreateMatrix(macro->dm, &macro->tangent));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetUp(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCheck(macro->scene, macro->comm, PETSC_ERR_ORDER, "call LamMacroSetScene() first");
  PetscCall(LamMacroMeshCreate(macro));
  PetscCall(LamMacroBoundaryCheck(macro));
  PetscCall(CreatePoints(macro));
  PetscCall(CreateUnknowns(macro));
  PetscCall(LamMacroSealCreate(macro));
  PetscCall(LamMacroNewtonCreate(macro));
  PetscCall(LamMacroHoldBoundaries(macro)); /* rejects an insufficiently constrained body before anything is solved */
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetComm(LamMacro macro, MPI_Comm *comm)
{
  PetscFunctionBeginUser;
  *comm = macro->comm;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetPointCount(LamMacro macro, PetscInt *points)
{
  PetscFunctionBeginUser;
  *points = macro->point_count;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetPlaces(LamMacro macro, PetscReal X[], PetscInt group[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(X, macro->place, macro->dim * macro->point_count));
  for (PetscInt p = 0; p < macro->point_count; p++) group[p] = macro->elements[macro->point_element[p]].group;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetGroups(LamMacro macro, PetscInt *count, const char (**names)[LAM_NAME_LENGTH])
{
  PetscFunctionBeginUser;
  *count = macro->group_count;
  *names = (const char(*)[LAM_NAME_LENGTH])macro->group_name;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetPointTissue(LamMacro macro, const PetscReal turgor[], const PetscReal cohesion[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(macro->turgor_share, turgor, macro->point_count));
  PetscCall(PetscArraycpy(macro->cohesion, cohesion, macro->point_count));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetWaterLaw(LamMacro macro, LamWaterLaw law, void *ctx)
{
  PetscFunctionBeginUser;
  PetscCheck(!macro->dm, macro->comm, PETSC_ERR_ORDER, "call LamMacroSetWaterLaw() before LamMacroSetUp()");
  macro->water_law = law;
  macro->water_ctx = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetResponder(LamMacro macro, LamResponder responder)
{
  PetscFunctionBeginUser;
  macro->responder = responder;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetMonitor(LamMacro macro, LamMacroMonitor monitor, void *ctx)
{
  PetscFunctionBeginUser;
  macro->monitor = monitor;
  macro->monitor_ctx = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetCutback(LamMacro macro, LamMacroCutback cutback, void *ctx)
{
  PetscFunctionBeginUser;
  macro->cutback = cutback;
  macro->cutback_ctx = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetStop(LamMacro macro, PetscBool (*stop)(void))
{
  PetscFunctionBeginUser;
  macro->stop = stop;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroDestroy(LamMacro *macro)
{
  PetscFunctionBeginUser;
  if (!*macro) PetscFunctionReturn(0);
  PetscCall(SNESDestroy(&(*macro)->snes));
  PetscCall(LamMacroSealDestroy(*macro));
  PetscCall(MatDestroy(&(*macro)->tangent));
  PetscCall(VecDestroy(&(*macro)->u));
  PetscCall(VecDestroy(&(*macro)->trial));
  PetscCall(VecDestroy(&(*macro)->residual));
  PetscCall(VecDestroy(&(*macro)->origin));
  PetscCall(VecDestroy(&(*macro)->force));
  PetscCall(VecDestroy(&(*macro)->force_accepted));
  PetscCall(VecDestroy(&(*macro)->external));
  PetscCall(VecDestroy(&(*macro)->before));
  PetscCall(LamMacroBordersDestroy(*macro));
  PetscCall(KSPDestroy(&(*macro)->solver));
  PetscCall(PetscFree((*macro)->constraints));
  PetscCall(PetscFree((*macro)->rows));
  PetscCall(PetscFree((*macro)->obstacle_nodes));
  PetscCall(PetscFree((*macro)->point_index));
  PetscCall(PetscFree((*macro)->loads));
  PetscCall(PetscFree((*macro)->responses));
  PetscCall(PetscFree((*macro)->now));
  PetscCall(PetscFree((*macro)->accepted));
  PetscCall(PetscFree((*macro)->turgor_share));
  PetscCall(PetscFree((*macro)->cohesion));
  PetscCall(LamMacroMeshDestroy(*macro));
  PetscCall(PetscFree(*macro));
  PetscFunctionReturn(0);
}
