/*
  Mesh of the macroscale body: a box of nine-node quadrilaterals, distributed over the ranks.
*/
#include "macro_impl.h"

/*
  Numbers of the undistributed mesh for every mesh point of this rank, so that output does not depend on the ranks.
  `migration` is NULL where nothing was distributed.
*/
static PetscErrorCode NumberPoints(LamMacro macro, PetscSF migration)
{
  PetscInt n = macro->mesh_end - macro->mesh_start;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &macro->number));
  for (PetscInt p = 0; p < n; p++) macro->number[p] = p;
  if (migration) {
    PetscInt roots, *own;
    PetscCall(PetscSFGetGraph(migration, &roots, NULL, NULL, NULL));
    PetscCall(PetscMalloc1(roots, &own));
    for (PetscInt p = 0; p < roots; p++) own[p] = p;
    PetscCall(PetscSFBcastBegin(migration, MPIU_INT, own, macro->number, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(migration, MPIU_INT, own, macro->number, MPI_REPLACE));
    PetscCall(PetscFree(own));
  }
  PetscFunctionReturn(0);
}

/* A node sits at the mean of its mesh point's vertices: elements have straight edges. */
static PetscErrorCode LocateNodes(LamMacro macro)
{
  DM coordinate_dm;
  PetscSection section;
  Vec coordinates;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * (macro->mesh_end - macro->mesh_start), &macro->position));
  PetscCall(DMGetCoordinateDM(macro->dm, &coordinate_dm));
  PetscCall(DMGetCoordinateSection(macro->dm, &section));
  PetscCall(DMGetCoordinatesLocal(macro->dm, &coordinates));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    PetscReal *X = &macro->position[2 * (p - macro->mesh_start)];
    PetscScalar *corner = NULL;
    PetscInt size;
    PetscCall(DMPlexVecGetClosure(coordinate_dm, section, coordinates, p, &size, &corner));
    for (PetscInt k = 0; k < size; k++) X[k % 2] += PetscRealPart(corner[k]) / (size / 2);
    PetscCall(DMPlexVecRestoreClosure(coordinate_dm, section, coordinates, p, &size, &corner));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MarkSides(LamMacro macro)
{
  DMLabel label;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(macro->mesh_end - macro->mesh_start, &macro->sides));
  PetscCall(DMGetLabel(macro->dm, "Face Sets", &label));
  PetscCheck(label, macro->comm, PETSC_ERR_PLIB, "the box mesh has no label of its sides");
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    for (PetscInt side = 0; side < 4; side++) {
      PetscBool on;
      PetscCall(DMLabelStratumHasPoint(label, side + 1, p, &on));
      if (on) macro->sides[p - macro->mesh_start] |= (unsigned char)(1 << side);
    }
  }
  PetscFunctionReturn(0);
}

/* Quadratic displacements; shape function gradients and areas of all Gauss points, once for ever. */
static PetscErrorCode Tabulate(LamMacro macro)
{
  PetscInt cells = macro->cell_end - macro->cell_start;
  PetscReal x[LAM_MACRO_POINTS * 2], J[LAM_MACRO_POINTS * 4], invJ[LAM_MACRO_POINTS * 4], detJ[LAM_MACRO_POINTS];
  const PetscReal *weights;
  PetscFE fe;
  PetscQuadrature quadrature;
  PetscTabulation table;
  PetscInt points;

  PetscFunctionBeginUser;
  PetscCall(PetscFECreateLagrange(macro->comm, 2, 2, PETSC_FALSE, 2, 2, &fe));
  PetscCall(DMSetField(macro->dm, 0, NULL, (PetscObject)fe));
  PetscCall(DMCreateDS(macro->dm));
  PetscCall(PetscFEGetQuadrature(fe, &quadrature));
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &points, NULL, &weights));
  PetscCall(PetscFEGetCellTabulation(fe, 1, &table));
  PetscCheck(points == LAM_MACRO_POINTS && table->Nb == LAM_MACRO_DOFS && table->Nc == 2, macro->comm, PETSC_ERR_PLIB,
             "unexpected element: %" PetscInt_FMT " points, %" PetscInt_FMT " functions", points, table->Nb);
  PetscCall(PetscMalloc1(cells * LAM_MACRO_POINTS * LAM_MACRO_DOFS, &macro->gradient));
  PetscCall(PetscMalloc1(cells * LAM_MACRO_POINTS, &macro->weight));
  for (PetscInt c = 0; c < cells; c++) {
    PetscCall(DMPlexComputeCellGeometryFEM(macro->dm, macro->cell_start + c, quadrature, x, J, invJ, detJ));
    for (PetscInt q = 0; q < LAM_MACRO_POINTS; q++) {
      PetscReal *gradient = &macro->gradient[(c * LAM_MACRO_POINTS + q) * LAM_MACRO_DOFS];
      macro->weight[c * LAM_MACRO_POINTS + q] = weights[q] * detJ[q];
      for (PetscInt a = 0; a < LAM_MACRO_NODES; a++) {
        /* function 2a is node a's first component */
        const PetscReal *g = &table->T[1][(q * LAM_MACRO_DOFS + 2 * a) * 4];
        for (PetscInt j = 0; j < 2; j++) gradient[2 * a + j] = g[0] * invJ[4 * q + j] + g[1] * invJ[4 * q + 2 + j];
      }
    }
  }
  PetscCall(PetscFEDestroy(&fe));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroMeshCreate(LamMacro macro)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  const PetscReal lower[2] = {0, 0};
  DM distributed;
  DMLabel label;
  PetscSF migration = NULL;

  PetscFunctionBeginUser;
  PetscCall(
      DMPlexCreateBoxMesh(macro->comm, 2, PETSC_FALSE, spec->elements, lower, spec->box, NULL, PETSC_TRUE, &macro->dm));
  PetscCall(DMGetLabel(macro->dm, "Face Sets", &label));
  if (label) PetscCall(DMPlexLabelComplete(macro->dm, label)); /* from edges to their vertices */
  PetscCall(DMPlexDistribute(macro->dm, 0, &migration, &distributed));
  if (distributed) {
    PetscCall(DMDestroy(&macro->dm));
    macro->dm = distributed;
  }
  PetscCall(DMPlexGetHeightStratum(macro->dm, 0, &macro->cell_start, &macro->cell_end));
  PetscCall(DMPlexGetChart(macro->dm, &macro->mesh_start, &macro->mesh_end));
  PetscCall(NumberPoints(macro, migration));
  PetscCall(PetscSFDestroy(&migration));
  PetscCall(LocateNodes(macro));
  PetscCall(MarkSides(macro));
  PetscCall(Tabulate(macro));
  macro->point_count = (macro->cell_end - macro->cell_start) * LAM_MACRO_POINTS;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroMeshDestroy(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(macro->number));
  PetscCall(PetscFree(macro->position));
  PetscCall(PetscFree(macro->sides));
  PetscCall(PetscFree(macro->gradient));
  PetscCall(PetscFree(macro->weight));
  PetscCall(DMDestroy(&macro->dm));
  PetscFunctionReturn(0);
}
