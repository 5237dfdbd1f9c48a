/*
  Creation, set-up and destruction of the macroscale solver.
*/
#include <math.h>
#include "transport_impl.h"

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
             "%s: has no block `macro`, which describes the body", scene->path);
  PetscCall(LamMacroBoundaryNames(&scene->macro, &macro->step));
  macro->scene = scene;
  macro->relaxes = LamWallsRelax(&scene->micro);
  macro->duration = macro->relaxes ? PETSC_INFINITY : 0;
  PetscFunctionReturn(0);
}

enum { VECTORS = 8 };

static void ListVectors(LamMacro macro, Vec *vectors[VECTORS])
{
  Vec *const list[VECTORS] = {&macro->u,     &macro->trial,          &macro->residual, &macro->origin,
                              &macro->force, &macro->force_accepted, &macro->external, &macro->before};

  memcpy(vectors, list, sizeof(list));
}

static PetscErrorCode CreatePoints(LamMacro macro)
{
  const PetscInt n = macro->point_count;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc7(n, &macro->point_index, n, &macro->loads, n, &macro->responses, n, &macro->now, n,
                         &macro->accepted, n, &macro->turgor_share, n, &macro->cohesion));
  for (PetscInt p = 0; p < n; p++) {
    macro->point_index[p] = p;
    macro->turgor_share[p] = macro->scene->turgor;
    macro->cohesion[p] = macro->scene->cohesion;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateUnknowns(LamMacro macro)
{
  Vec *vectors[VECTORS];
  PetscInt local;

  PetscFunctionBeginUser;
  ListVectors(macro, vectors);
  for (int k = 0; k < VECTORS; k++) {
    PetscCall(DMCreateGlobalVector(macro->dm, vectors[k]));
    PetscCall(VecZeroEntries(*vectors[k]));
  }
  PetscCall(LamMacroListNodes(macro));
  PetscCall(VecGetLocalSize(macro->u, &local));
  PetscCall(PetscMalloc2(local, &macro->constraints, local, &macro->rows));
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
  PetscCall(LamMacroFlowCreate(macro));
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

PetscErrorCode LamMacroGetPlaces(LamMacro macro, PetscReal X[], unsigned int groups[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(X, macro->place, macro->dim * macro->point_count));
  for (PetscInt p = 0; p < macro->point_count; p++) groups[p] = macro->elements[macro->point_element[p]].groups;
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
  LamMacro m = *macro;
  Vec *vectors[VECTORS];

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  PetscCall(SNESDestroy(&m->snes));
  PetscCall(LamMacroFlowDestroy(m));
  PetscCall(LamMacroSealDestroy(m));
  PetscCall(MatDestroy(&m->tangent));
  ListVectors(m, vectors);
  for (int k = 0; k < VECTORS; k++) PetscCall(VecDestroy(vectors[k]));
  PetscCall(LamMacroBordersDestroy(m));
  PetscCall(LamMacroInflatedDestroy(m));
  PetscCall(LamMacroPeakDestroy(m));
  PetscCall(LamMacroWaypointsDestroy(m));
  PetscCall(KSPDestroy(&m->solver));
  PetscCall(PetscFree2(m->constraints, m->rows));
  PetscCall(PetscFree(m->obstacle_nodes));
  PetscCall(PetscFree7(m->point_index, m->loads, m->responses, m->now, m->accepted, m->turgor_share, m->cohesion));
  PetscCall(LamMacroMeshDestroy(m));
  PetscCall(PetscFree(*macro));
  PetscFunctionReturn(0);
}
