/*
  Creation of what moves water through the body (transport.c): numbering, prescribed potentials, matrices.
*/
#include "transport_impl.h"

#define ON_AXIS 1e-9 /* of the body's length: more than rounding, less than an element */

static PetscErrorCode NumberPotentials(LamMacro macro, LamMacroFlow *flow)
{
  PetscSection section;

  PetscFunctionBeginUser;
  PetscCall(DMClone(macro->dm, &flow->dm));
  PetscCall(PetscSectionCreate(macro->comm, &section));
  PetscCall(PetscSectionSetChart(section, macro->mesh_start, macro->mesh_end));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++)
    PetscCall(PetscSectionSetDof(section, p, macro->node_number[p - macro->mesh_start] < 0 ? 0 : flow->spec.count));
  PetscCall(PetscSectionSetUp(section));
  PetscCall(DMSetLocalSection(flow->dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscFunctionReturn(0);
}

/* The axis of an axisymmetric body is none of its surfaces. */
static PetscErrorCode CheckSurfaces(LamMacro macro)
{
  const LamTransportSpec *spec = &macro->scene->process.transport;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; macro->axisymmetric && k < spec->surface_count; k++) {
    const PetscInt set = LamMacroFindSet(macro, spec->surface[k].on);
    PetscReal radius = 0, X[6], sense;
    for (PetscInt i = 0; i < macro->facet_count; i++) {
      if (!(macro->facets[i].sets >> set & 1)) continue;
      PetscCall(LamMacroFacetNodes(macro, &macro->facets[i], X, &sense));
      for (int a = 0; a < 3; a++) radius = PetscMax(radius, X[2 * a]);
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &radius, 1, MPIU_REAL, MPIU_MAX, macro->comm));
    LamMacroRequire(radius > ON_AXIS, macro, &spec->surface[k].place,
                    "process.transport.surface: on: %s: is the axis of the body, where no water comes in; leave it out",
                    spec->surface[k].on);
  }
  PetscFunctionReturn(0);
}

/* Marks the prescribed potentials: 1 in flow->held, a local vector. */
static PetscErrorCode MarkHeld(LamMacro macro, LamMacroFlow *flow)
{
  const LamTransportSpec *spec = &macro->scene->process.transport;
  PetscSection section;
  PetscScalar *held;

  PetscFunctionBeginUser;
  PetscCall(DMCreateLocalVector(flow->dm, &flow->held));
  PetscCall(VecZeroEntries(flow->held));
  PetscCall(DMGetLocalSection(flow->dm, &section));
  PetscCall(VecGetArray(flow->held, &held));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    PetscInt at;
    if (macro->node_number[p - macro->mesh_start] < 0) continue;
    PetscCall(PetscSectionGetOffset(section, p, &at));
    for (PetscInt k = 0; k < spec->surface_count; k++) {
      if (!LamMacroIsOn(macro, p, spec->surface[k].on)) continue;
      for (PetscInt f = 0; f < flow->spec.count; f++)
        if (LamMacroPrescribes(flow, &spec->surface[k], f)) held[at + f] = 1;
    }
  }
  PetscCall(VecRestoreArray(flow->held, &held));
  PetscFunctionReturn(0);
}

/* Global numbers of an element's unknowns. */
static PetscErrorCode Numbers(DM dm, PetscInt cell, PetscInt numbers[])
{
  ISLocalToGlobalMapping map;
  PetscSection section;
  PetscInt n, *local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalSection(dm, &section));
  PetscCall(DMGetLocalToGlobalMapping(dm, &map));
  PetscCall(DMPlexGetClosureIndices(dm, section, section, cell, PETSC_TRUE, &n, &local, NULL, NULL));
  PetscCall(ISLocalToGlobalMappingApply(map, n, local, numbers));
  PetscCall(DMPlexRestoreClosureIndices(dm, section, section, cell, PETSC_TRUE, &n, &local, NULL, NULL));
  PetscFunctionReturn(0);
}

/* Rows and columns of the entries of B, element by element. */
static PetscErrorCode ListEntries(LamMacro macro, LamMacroFlow *flow, PetscInt rows[], PetscInt columns[])
{
  PetscInt at = 0, u[LAM_MACRO_DOFS], psi[LAM_MACRO_POTENTIALS * LAM_MACRO_NODES];

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const PetscInt nodes = macro->elements[e].kind->nodes;
    PetscCall(Numbers(macro->dm, macro->mesh_start + e, u));
    PetscCall(Numbers(flow->dm, macro->mesh_start + e, psi));
    for (PetscInt k = 0; k < nodes * macro->dim; k++)
      for (PetscInt l = 0; l < nodes * flow->spec.count; l++, at++) {
        rows[at] = u[k];
        columns[at] = psi[l];
      }
  }
  PetscFunctionReturn(0);
}

/* The matrices B and C', whose entries are set element by element, in flow->entries: of B row-major. */
static PetscErrorCode CreateCouplings(LamMacro macro, LamMacroFlow *flow)
{
  PetscInt total = 0, n, m, *rows, *columns;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < macro->element_count; e++)
    total += PetscSqr(macro->elements[e].kind->nodes) * macro->dim * flow->spec.count;
  PetscCall(PetscMalloc2(total, &rows, total, &columns));
  PetscCall(VecGetLocalSize(macro->u, &n));
  PetscCall(VecGetLocalSize(flow->psi, &m));
  for (int k = 0; k < 2; k++) {
    Mat *matrix = k ? &flow->from_u : &flow->to_force;
    PetscCall(ListEntries(macro, flow, rows, columns)); /* anew: they have been sorted */
    PetscCall(MatCreate(macro->comm, matrix));
    PetscCall(MatSetSizes(*matrix, k ? m : n, k ? n : m, PETSC_DETERMINE, PETSC_DETERMINE));
    PetscCall(MatSetType(*matrix, MATAIJ));
    PetscCall(MatSetPreallocationCOO(*matrix, total, k ? columns : rows, k ? rows : columns));
  }
  PetscCall(PetscMalloc2(total, &flow->entries[0], total, &flow->entries[1]));
  PetscCall(PetscFree2(rows, columns));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetTransport(LamMacro macro, const LamMacroTransport *transport)
{
  PetscFunctionBeginUser;
  PetscCheck(!macro->dm, macro->comm, PETSC_ERR_ORDER, "call LamMacroSetTransport() before LamMacroSetUp()");
  PetscCall(PetscNew(&macro->flow));
  macro->flow->spec = *transport;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowCreate(LamMacro macro)
{
  LamMacroFlow *flow = macro->flow;

  PetscFunctionBeginUser;
  if (!flow) PetscFunctionReturn(0);
  PetscCall(NumberPotentials(macro, flow));
  PetscCall(DMCreateGlobalVector(flow->dm, &flow->psi));
  PetscCall(VecZeroEntries(flow->psi));
  PetscCall(VecDuplicate(flow->psi, &flow->accepted));
  PetscCall(VecCopy(flow->psi, flow->accepted));
  PetscCall(VecDuplicate(flow->psi, &flow->balance));
  PetscCall(VecDuplicate(flow->psi, &flow->step));
  PetscCall(PetscCalloc1(macro->point_count * flow->spec.count, &flow->at));
  PetscCall(DMSetMatType(flow->dm, MATAIJ));
  PetscCall(DMCreateMatrix(flow->dm, &flow->own));
  PetscCall(CheckSurfaces(macro));
  PetscCall(MarkHeld(macro, flow));
  PetscCall(CreateCouplings(macro, flow));
  PetscCall(LamMacroFactorise(macro, "macro_flow_", &flow->own_solver));
  PetscCall(LamMacroFactorise(macro, "macro_whole_", &flow->whole_solver));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowDestroy(LamMacro macro)
{
  LamMacroFlow *flow = macro->flow;

  PetscFunctionBeginUser;
  if (!flow) PetscFunctionReturn(0);
  PetscCall(KSPDestroy(&flow->whole_solver));
  PetscCall(KSPDestroy(&flow->own_solver));
  PetscCall(MatDestroy(&flow->whole));
  PetscCall(MatDestroy(&flow->to_force));
  PetscCall(MatDestroy(&flow->from_u));
  PetscCall(MatDestroy(&flow->own));
  PetscCall(VecDestroy(&flow->psi));
  PetscCall(VecDestroy(&flow->accepted));
  PetscCall(VecDestroy(&flow->balance));
  PetscCall(VecDestroy(&flow->step));
  PetscCall(VecDestroy(&flow->held));
  PetscCall(VecDestroy(&flow->whole_in));
  PetscCall(VecDestroy(&flow->whole_out));
  PetscCall(PetscFree2(flow->entries[0], flow->entries[1]));
  PetscCall(PetscFree(flow->at));
  PetscCall(DMDestroy(&flow->dm));
  PetscCall(PetscFree(macro->flow));
  PetscFunctionReturn(0);
}
