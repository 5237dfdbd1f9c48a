/*
  Restart data: the state of the body after a complete step, by the numbers of the undistributed mesh.

  Every addition to the state of the solver needs a line in ArchiveState.
*/
#include "macro_impl.h"

PetscErrorCode LamMacroArchiveVec(LamMacro macro, LamArchive archive, const char name[], Vec vec)
{
  const PetscInt most = macro->mesh_end - macro->mesh_start;
  PetscInt n = 0, local, *numbers;
  PetscScalar *values, *nodal;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(most, &numbers, most * macro->dim, &nodal));
  PetscCall(VecGetArray(vec, &values));
  for (int pass = 0; pass < 2; pass++) { /* the second pass stores the values read */
    n = 0;
    for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
      PetscCall(LamMacroOwnedIndex(macro, p, &local));
      if (local < 0) continue;
      numbers[n] = macro->node_number[p - macro->mesh_start];
      if (pass == 0)
        PetscCall(PetscArraycpy(&nodal[n * macro->dim], &values[local], macro->dim));
      else
        PetscCall(PetscArraycpy(&values[local], &nodal[n * macro->dim], macro->dim));
      n++;
    }
    if (pass == 0)
      PetscCall(LamArchiveItems(archive, name, (size_t)macro->dim * sizeof(PetscScalar), n, numbers, nodal));
  }
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

static PetscErrorCode ArchiveResponder(LamMacro macro, LamArchive archive, const PetscInt numbers[])
{
  size_t size;
  char *states;

  PetscFunctionBeginUser;
  PetscCall(LamResponderGetStateSize(macro->responder, &size));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_UNSIGNED_LONG, MPI_MAX, macro->comm));
  if (!size) PetscFunctionReturn(0);
  PetscCall(PetscCalloc((size_t)macro->point_count * size, &states));
  for (PetscInt p = 0; p < macro->point_count && !LamArchiveIsReading(archive); p++)
    PetscCall(LamResponderSave(macro->responder, p, states + (size_t)p * size));
  PetscCall(LamArchiveItems(archive, "tissue states", size, macro->point_count, numbers, states));
  for (PetscInt p = 0; p < macro->point_count && LamArchiveIsReading(archive); p++)
    PetscCall(LamResponderLoad(macro->responder, p, states + (size_t)p * size));
  PetscCall(PetscFree(states));
  PetscFunctionReturn(0);
}

/* Nodes in contact, as a vector of 0 and 1. */
static PetscErrorCode ArchiveTouch(LamMacro macro, LamArchive archive)
{
  PetscScalar *touches;

  PetscFunctionBeginUser;
  if (!macro->obstacle_count) PetscFunctionReturn(0);
  for (int pass = 0; pass < 2; pass++) { /* the second pass stores the values read */
    if (pass == 0) PetscCall(VecZeroEntries(macro->external));
    PetscCall(VecGetArray(macro->external, &touches));
    for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
      LamObstacleNode *node = &macro->obstacle_nodes[k];
      if (pass == 0)
        touches[node->local] = node->accepted ? 1 : 0;
      else
        node->accepted = PetscRealPart(touches[node->local]) > 0.5 ? PETSC_TRUE : PETSC_FALSE;
    }
    PetscCall(VecRestoreArray(macro->external, &touches));
    if (pass == 0) PetscCall(LamMacroArchiveVec(macro, archive, "touch", macro->external));
  }
  PetscFunctionReturn(0);
}

/* Data for the loads and the prediction of the next step. */
static PetscErrorCode ArchiveLoads(LamMacro macro, LamArchive archive)
{
  PetscReal borders[PETSC_STATIC_ARRAY_LENGTH(macro->borders)] = {0};

  PetscFunctionBeginUser;
  PetscCall(LamMacroArchiveVec(macro, archive, "displacement before", macro->before));
  PetscCall(LamArchiveShared(archive, "passed", sizeof(macro->passed), &macro->passed));
  PetscCall(ArchiveTouch(macro, archive));
  for (PetscInt b = 0; b < macro->border_count; b++) borders[b] = macro->borders[b].accepted;
  PetscCall(LamArchiveShared(archive, "borders", sizeof(borders), borders));
  for (PetscInt b = 0; b < macro->border_count; b++) macro->borders[b].accepted = macro->borders[b].now = borders[b];
  PetscFunctionReturn(0);
}

static PetscErrorCode ArchiveState(LamMacro macro, LamArchive archive)
{
  PetscInt *numbers;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(macro->point_count, &numbers));
  PetscCall(NumberPoints(macro, numbers));
  PetscCall(LamMacroArchiveVec(macro, archive, "displacement", macro->u));
  PetscCall(LamMacroArchiveVec(macro, archive, "force", macro->force_accepted));
  PetscCall(LamArchiveItems(archive, "points", sizeof(LamMaterialPoint), macro->point_count, numbers, macro->accepted));
  PetscCall(LamMacroArchiveSeal(macro, archive, numbers));
  PetscCall(ArchiveLoads(macro, archive));
  PetscCall(ArchiveResponder(macro, archive, numbers));
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroArchive(LamMacro macro, LamArchive archive)
{
  PetscFunctionBeginUser;
  PetscCheck(macro->responder, macro->comm, PETSC_ERR_ORDER, "call LamMacroSetResponder() first");
  PetscCall(LamArchiveShared(archive, "progress", sizeof(macro->progress), &macro->progress));
  PetscCall(LamArchiveShared(archive, "work", sizeof(macro->step.work), &macro->step.work));
  PetscCall(LamMacroArchiveVec(macro, archive, "origin", macro->origin));
  if (LamArchiveIsReading(archive)) { /* conditions are measured from the stored displacement */
    PetscCall(VecCopy(macro->origin, macro->u));
    PetscCall(LamMacroHoldBoundaries(macro));
  }
  PetscCall(ArchiveState(macro, archive));
  if (LamArchiveIsReading(archive)) PetscCall(PetscArraycpy(macro->now, macro->accepted, macro->point_count));
  PetscFunctionReturn(0);
}
