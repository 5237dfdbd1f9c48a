/*
  Restart data: the state of the body after a complete step, by the numbers of the undistributed mesh.

  Every addition to the state of the solver needs a line in ArchiveState.
*/
#include "macro_impl.h"

PetscErrorCode LamMacroArchiveVec(LamMacro macro, LamArchive archive, const char name[], Vec vec)
{
  const PetscInt n = macro->node_count, dim = macro->dim;
  PetscInt *numbers;
  PetscScalar *values, *nodal;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &numbers, n * dim, &nodal));
  PetscCall(VecGetArray(vec, &values));
  for (PetscInt k = 0; k < n; k++) {
    numbers[k] = macro->nodes[k].number;
    PetscCall(PetscArraycpy(&nodal[k * dim], &values[macro->nodes[k].local], dim));
  }
  PetscCall(LamArchiveItems(archive, name, (size_t)dim * sizeof(PetscScalar), n, numbers, nodal));
  for (PetscInt k = 0; k < n; k++) PetscCall(PetscArraycpy(&values[macro->nodes[k].local], &nodal[k * dim], dim));
  PetscCall(VecRestoreArray(vec, &values));
  PetscCall(PetscFree2(numbers, nodal));
  PetscFunctionReturn(0);
}

/* Numbers of this rank's material points in the undistributed mesh, element by element, with equal space for each
   element. */
static PetscErrorCode NumberPoints(LamMacro macro, PetscInt numbers[])
{
  PetscInt most = 0;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < macro->element_count; e++) most = PetscMax(most, macro->elements[e].kind->points);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_INT, MPI_MAX, macro->comm));
  for (PetscInt p = 0; p < macro->point_count; p++) {
    const LamMacroElement *element = &macro->elements[macro->point_element[p]];
    numbers[p] = element->number * most + p - element->first;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ArchiveResponder(LamMacro macro, LamArchive archive, LamResponder responder, const char name[],
                                       const PetscInt numbers[])
{
  size_t size;
  char *states;

  PetscFunctionBeginUser;
  PetscCall(LamResponderGetStateSize(responder, &size));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_UNSIGNED_LONG, MPI_MAX, macro->comm));
  if (!size) PetscFunctionReturn(0);
  PetscCall(PetscCalloc((size_t)macro->point_count * size, &states));
  for (PetscInt p = 0; p < macro->point_count && !LamArchiveIsReading(archive); p++)
    PetscCall(LamResponderSave(responder, p, states + (size_t)p * size));
  PetscCall(LamArchiveItems(archive, name, size, macro->point_count, numbers, states));
  for (PetscInt p = 0; p < macro->point_count && LamArchiveIsReading(archive); p++)
    PetscCall(LamResponderLoad(responder, p, states + (size_t)p * size));
  PetscCall(PetscFree(states));
  PetscFunctionReturn(0);
}

/* States of the reference that certifies all points. */
static PetscErrorCode ArchiveReference(LamMacro macro, LamArchive archive, const PetscInt numbers[])
{
  const PetscBool wanted = (PetscBool)(macro->certify == LAM_CERTIFY_ALL);
  PetscBool has = wanted;

  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "has certified states", sizeof(has), &has));
  if (has && wanted) PetscCall(ArchiveResponder(macro, archive, macro->reference, "certified states", numbers));
  PetscFunctionReturn(0);
}

/* Nodes in contact, as a vector of 0 and 1, and of the signs of their friction. */
static PetscErrorCode ArchiveTouch(LamMacro macro, LamArchive archive)
{
  PetscScalar *touches;

  PetscFunctionBeginUser;
  if (!macro->obstacle_count) PetscFunctionReturn(0);
  PetscCall(VecZeroEntries(macro->external));
  PetscCall(VecGetArray(macro->external, &touches));
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    touches[node->local] = node->accepted;
    touches[node->local + 1] = (PetscScalar)node->accepted_slip;
  }
  PetscCall(VecRestoreArray(macro->external, &touches));
  PetscCall(LamMacroArchiveVec(macro, archive, "touch", macro->external));
  PetscCall(VecGetArray(macro->external, &touches));
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    LamObstacleNode *node = &macro->obstacle_nodes[k];
    node->accepted = (PetscBool)(PetscRealPart(touches[node->local]) > 0.5);
    node->accepted_slip = (PetscInt)PetscRealPart(touches[node->local + 1]);
  }
  PetscCall(VecRestoreArray(macro->external, &touches));
  PetscFunctionReturn(0);
}

static PetscErrorCode ArchiveState(LamMacro macro, LamArchive archive)
{
  PetscReal borders[PETSC_STATIC_ARRAY_LENGTH(macro->borders)] = {0};
  PetscInt *numbers;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(macro->point_count, &numbers));
  PetscCall(NumberPoints(macro, numbers));
  PetscCall(LamMacroArchiveVec(macro, archive, "displacement", macro->u));
  PetscCall(LamMacroArchiveVec(macro, archive, "force", macro->force_accepted));
  PetscCall(LamArchiveItems(archive, "points", sizeof(LamMaterialPoint), macro->point_count, numbers, macro->accepted));
  PetscCall(LamMacroArchiveSeal(macro, archive, numbers));
  /* for the loads and the prediction of the next step */
  PetscCall(LamMacroArchiveVec(macro, archive, "displacement before", macro->before));
  PetscCall(LamArchiveShared(archive, "passed", sizeof(macro->passed), &macro->passed));
  PetscCall(ArchiveTouch(macro, archive));
  for (PetscInt b = 0; b < macro->border_count; b++) borders[b] = macro->borders[b].accepted;
  PetscCall(LamArchiveShared(archive, "borders", sizeof(borders), borders));
  for (PetscInt b = 0; b < macro->border_count; b++) macro->borders[b].accepted = macro->borders[b].now = borders[b];
  PetscCall(ArchiveResponder(macro, archive, macro->responder, "tissue states", numbers));
  PetscCall(ArchiveReference(macro, archive, numbers));
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(0);
}

/* ---- what certificates need ---- */

static PetscErrorCode ArchivePoints(LamMacro macro, LamArchive archive, const char name[], LamMaterialPoint points[])
{
  PetscInt *numbers;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(macro->point_count, &numbers));
  PetscCall(NumberPoints(macro, numbers));
  PetscCall(LamArchiveItems(archive, name, sizeof(*points), macro->point_count, numbers, points));
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(0);
}

static PetscErrorCode ArchiveWaypoints(LamMacro macro, LamArchive archive)
{
  LamMacroWaypoints *waypoints = &macro->waypoints;
  PetscInt *numbers;
  char name[32];

  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "waypoints", sizeof(waypoints->count), &waypoints->count));
  PetscCall(LamArchiveShared(archive, "waypoint stride", sizeof(waypoints->stride), &waypoints->stride));
  PetscCall(LamArchiveShared(archive, "waypoint steps", sizeof(waypoints->step), waypoints->step));
  PetscCall(PetscMalloc1(macro->point_count, &numbers));
  PetscCall(NumberPoints(macro, numbers));
  for (PetscInt k = 0; k < waypoints->count; k++) {
    if (!waypoints->loads[k]) PetscCall(PetscMalloc1(macro->point_count, &waypoints->loads[k]));
    PetscCall(PetscSNPrintf(name, sizeof(name), "waypoint %" PetscInt_FMT, k));
    PetscCall(LamArchiveItems(archive, name, sizeof(LamLoad), macro->point_count, numbers, waypoints->loads[k]));
  }
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteInflated(LamMacro macro, LamArchive archive)
{
  PetscBool kept = (PetscBool)(macro->inflated.points != NULL);

  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "inflated", sizeof(kept), &kept));
  if (kept) PetscCall(ArchivePoints(macro, archive, "inflated points", macro->inflated.points));
  PetscFunctionReturn(0);
}

/* With the displacement of the inflated body. */
static PetscErrorCode ReadInflated(LamMacro macro, LamArchive archive)
{
  PetscBool kept;

  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "inflated", sizeof(kept), &kept));
  if (!kept) PetscFunctionReturn(0);
  PetscCall(ArchivePoints(macro, archive, "inflated points", macro->now));
  PetscCall(LamMacroHoldRigidMotions(macro));
  PetscCall(LamMacroKeepInflated(macro));
  PetscFunctionReturn(0);
}

static PetscErrorCode ArchivePeak(LamMacro macro, LamArchive archive)
{
  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "peak", sizeof(macro->peak.known), &macro->peak.known));
  if (!macro->peak.known) PetscFunctionReturn(0);
  PetscCall(LamMacroPeakCreate(macro));
  PetscCall(LamArchiveShared(archive, "peak step", sizeof(macro->peak.step), &macro->peak.step));
  PetscCall(LamMacroArchiveVec(macro, archive, "peak displacement", macro->peak.u));
  PetscCall(ArchivePoints(macro, archive, "peak points", macro->peak.points));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroArchive(LamMacro macro, LamArchive archive)
{
  PetscFunctionBeginUser;
  PetscCheck(macro->responder, macro->comm, PETSC_ERR_ORDER, "call LamMacroSetResponder() first");
  PetscCall(LamArchiveShared(archive, "progress", sizeof(macro->progress), &macro->progress));
  PetscCall(LamArchiveShared(archive, "work", sizeof(macro->step.work), &macro->step.work));
  PetscCall(
      LamArchiveShared(archive, "mesh dependent", sizeof(macro->step.mesh_dependent), &macro->step.mesh_dependent));
  PetscCall(LamMacroArchiveVec(macro, archive, "origin", macro->origin));
  PetscCall(LamArchiveShared(archive, "cost", sizeof(macro->cost), &macro->cost));
  if (LamArchiveIsReading(archive)) { /* conditions are measured from the stored displacement */
    PetscCall(VecCopy(macro->origin, macro->u));
    PetscCall(ReadInflated(macro, archive));
    PetscCall(LamMacroHoldBoundaries(macro));
  } else
    PetscCall(WriteInflated(macro, archive));
  PetscCall(ArchiveState(macro, archive));
  PetscCall(ArchivePeak(macro, archive));
  PetscCall(ArchiveWaypoints(macro, archive));
  if (!LamArchiveIsReading(archive)) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(macro->now, macro->accepted, macro->point_count));
  PetscCall(LamMacroSetLoadFactor(macro, macro->progress.load));
  LamMacroObstaclesAccept(macro);
  PetscFunctionReturn(0);
}
