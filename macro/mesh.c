/*
  Mesh of the macroscale body: quadratic elements over a DMPlex mesh, distributed over the ranks.

  Nodes are at the mesh points where the elements have one: vertices, edges, quadrilaterals. The geometry is
  isoparametric: X = sum_a N_a X_a with the same shape functions as the displacement, so edges may be curved.
*/
#include "macro_impl.h"
#include "mesh_sources.h"

#define OUTER "outer facets" /* label of the undistributed mesh's boundary; a rank's own boundary has more facets */

/* ---- numbering independent of the ranks ---- */

/* Migrates values of the undistributed mesh (all on rank 0) to values[mesh points of this rank], if migration is not
   NULL. */
static PetscErrorCode Migrate(PetscSF migration, PetscInt **values, PetscInt n)
{
  PetscInt *own = *values;

  PetscFunctionBeginUser;
  if (!migration) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, values));
  PetscCall(PetscSFBcastBegin(migration, MPIU_INT, own, *values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(migration, MPIU_INT, own, *values, MPI_REPLACE));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* In the undistributed mesh: number of each node, and of each point (the first ones are the elements). */
static PetscErrorCode NumberPoints(LamMacro macro, PetscInt **nodes, PetscInt **points)
{
  PetscInt start, end, count = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(macro->dm, &start, &end));
  PetscCall(PetscMalloc1(end - start, nodes));
  PetscCall(PetscMalloc1(end - start, points));
  for (PetscInt p = start; p < end; p++) {
    DMPolytopeType type;
    PetscCall(DMPlexGetCellType(macro->dm, p, &type));
    (*nodes)[p - start] = LamMacroHasNode(macro, type) ? count++ : -1;
    (*points)[p - start] = p - start;
  }
  PetscFunctionReturn(0);
}

/* In the undistributed mesh: the part of the body that each point is in. Parts share no node. */
static PetscErrorCode NumberParts(LamMacro macro, PetscInt *parts[])
{
  PetscInt start, end, elements, *part;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(macro->dm, &start, &end));
  PetscCall(DMPlexGetHeightStratum(macro->dm, 0, NULL, &elements));
  PetscCall(PetscMalloc1(end - start, parts));
  part = *parts; /* first another point of the part with a smaller number, or the point itself */
  for (PetscInt p = 0; p < end - start; p++) part[p] = p;
  for (PetscInt e = 0; e < elements; e++) {
    PetscInt size, *closure = NULL;

    PetscCall(DMPlexGetTransitiveClosure(macro->dm, e, PETSC_TRUE, &size, &closure));
    for (PetscInt k = 1; k < size; k++) {
      PetscInt one = e, other = closure[2 * k] - start;

      while (part[one] != one) one = part[one] = part[part[one]];
      while (part[other] != other) other = part[other] = part[part[other]];
      part[PetscMax(one, other)] = PetscMin(one, other);
    }
    PetscCall(DMPlexRestoreTransitiveClosure(macro->dm, e, PETSC_TRUE, &size, &closure));
  }
  macro->part_count = 0;
  for (PetscInt p = 0; p < end - start; p++) part[p] = part[p] == p ? macro->part_count++ : part[part[p]];
  PetscCallMPI(MPI_Bcast(&macro->part_count, 1, MPIU_INT, 0, macro->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroListNodes(LamMacro macro)
{
  PetscSection section;
  PetscInt start, size;

  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalSection(macro->dm, &section));
  PetscCall(VecGetOwnershipRange(macro->u, &start, NULL));
  PetscCall(VecGetLocalSize(macro->u, &size));
  PetscCall(PetscMalloc1(size / macro->dim, &macro->nodes));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    const PetscInt number = macro->node_number[p - macro->mesh_start];
    PetscInt offset;
    PetscCall(PetscSectionGetOffset(section, p, &offset));
    if (number >= 0 && offset >= 0)
      macro->nodes[macro->node_count++] =
          (LamMacroNode){p, offset - start, number, &macro->position[macro->dim * (p - macro->mesh_start)]};
  }
  PetscFunctionReturn(0);
}

/* ---- named boundaries and regions ---- */

PetscInt LamMacroFindSet(LamMacro macro, const char name[])
{
  for (PetscInt s = 0; s < macro->set_count; s++) {
    if (!strcmp(macro->set_name[s], name)) return s;
  }
  return -1;
}

/* Marks the points of stratum `value` of the label with the bit of a new set. */
static PetscErrorCode AddSet(LamMacro macro, DMLabel label, PetscInt value, const char name[])
{
  const unsigned int bit = 1u << macro->set_count;

  PetscFunctionBeginUser;
  LamMacroRequire(macro->set_count < LAM_MACRO_SETS, macro, &macro->scene->macro.mesh_place,
                  "macro.mesh: the mesh has more than %d named boundaries; join some of its physical groups",
                  LAM_MACRO_SETS);
  PetscCall(PetscStrncpy(macro->set_name[macro->set_count++], name, LAM_NAME_LENGTH));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    PetscBool on;
    PetscCall(DMLabelStratumHasPoint(label, value, p, &on));
    if (on) macro->sets[p - macro->mesh_start] |= bit;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode AddGroup(LamMacro macro, DMLabel label, const char name[])
{
  PetscFunctionBeginUser;
  LamMacroRequire(macro->group_count < LAM_MACRO_GROUPS, macro, &macro->scene->macro.mesh_place,
                  "macro.mesh: the mesh has more than %d named regions; join some of its physical groups",
                  LAM_MACRO_GROUPS);
  PetscCall(PetscStrncpy(macro->group_name[macro->group_count], name, LAM_NAME_LENGTH));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    PetscBool in;
    PetscCall(DMLabelStratumHasPoint(label, 1, macro->mesh_start + e, &in));
    if (in) macro->elements[e].groups |= 1u << macro->group_count;
  }
  macro->group_count++;
  PetscFunctionReturn(0);
}

/* Adds the sides of a box or disc: side k is stratum k + 1 of DMPlex's label of faces. */
static PetscErrorCode AddSides(LamMacro macro, PetscInt count, const char *const names[])
{
  DMLabel label;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(macro->dm, "Face Sets", &label));
  PetscCheck(label, macro->comm, PETSC_ERR_PLIB, "the mesh has no label of its sides");
  for (PetscInt side = 0; side < count; side++) {
    PetscInt size;
    PetscCall(DMLabelGetStratumSize(label, side + 1, &size));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPIU_INT, MPI_MAX, macro->comm));
    if (size) PetscCall(AddSet(macro, label, side + 1, names[side]));
  }
  PetscFunctionReturn(0);
}

/* Adds the physical groups of a Gmsh file that have a part of the mesh. */
static PetscErrorCode AddPhysicalGroups(LamMacro macro)
{
  PetscInt labels;

  PetscFunctionBeginUser;
  PetscCall(DMGetNumLabels(macro->dm, &labels));
  for (PetscInt k = 0; k < labels; k++) {
    PetscBool region, set;
    const char *name;
    DMLabel label;
    PetscInt size;

    PetscCall(DMGetLabelName(macro->dm, k, &name));
    PetscCall(PetscStrbeginswith(name, LAM_MESH_REGION, &region));
    PetscCall(PetscStrbeginswith(name, LAM_MESH_SET, &set));
    if (!region && !set) continue;
    PetscCall(DMGetLabelByNum(macro->dm, k, &label));
    PetscCall(DMLabelGetStratumSize(label, 1, &size));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPIU_INT, MPI_MAX, macro->comm));
    if (size && region) PetscCall(AddGroup(macro, label, name + strlen(LAM_MESH_REGION)));
    if (size && set) PetscCall(AddSet(macro, label, 1, name + strlen(LAM_MESH_SET)));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode NameSets(LamMacro macro)
{
  static const char *const box[] = {"bottom", "right", "top", "left"}, *const disc[] = {"rim", "bottom", "left"};
  const LamMeshSource source = macro->scene->macro.source;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(macro->mesh_end - macro->mesh_start, &macro->sets));
  if (source == LAM_MESH_BOX)
    PetscCall(AddSides(macro, 4, box));
  else if (source == LAM_MESH_DISC)
    PetscCall(AddSides(macro, 3, disc));
  else
    PetscCall(AddPhysicalGroups(macro));
  PetscFunctionReturn(0);
}

/* Lists the facets of the outer boundary that belong to a set. */
static PetscErrorCode ListFacets(LamMacro macro)
{
  PetscInt start, end;
  DMLabel outer;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(macro->dm, OUTER, &outer));
  PetscCall(DMPlexGetHeightStratum(macro->dm, 1, &start, &end));
  PetscCall(PetscMalloc1(end - start, &macro->facets));
  for (PetscInt p = start; p < end; p++) {
    const unsigned int sets = macro->sets[p - macro->mesh_start];
    const PetscInt *support;
    PetscBool on;
    PetscCall(DMLabelStratumHasPoint(outer, 1, p, &on));
    if (!sets || !on) continue;
    PetscCall(DMPlexGetSupport(macro->dm, p, &support));
    macro->facets[macro->facet_count++] = (LamMacroFacet){p, support[0] - macro->mesh_start, sets};
  }
  PetscFunctionReturn(0);
}

/* ---- geometry ---- */

/*
  Position of the node of a mesh point: the mean of its vertices; inside elements with curved edges that of their
  quadratic map: for a quadrilateral X = sum edges / 2 - sum vertices / 4, for a triangle X = 4/9 sum edges - sum
  vertices / 9.
*/
static PetscErrorCode PlaceNode(LamMacro macro, PetscInt point, PetscReal X[])
{
  const PetscInt dim = macro->dim;
  PetscInt size, *closure = NULL, count[2] = {0, 0};
  PetscReal mean[2][LAM_MACRO_DIM] = {{0}};

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetTransitiveClosure(macro->dm, point, PETSC_TRUE, &size, &closure));
  for (PetscInt k = 1; k < size; k++) {
    PetscInt depth;
    PetscCall(DMPlexGetPointDepth(macro->dm, closure[2 * k], &depth));
    if (depth > 1) continue;
    for (PetscInt i = 0; i < dim; i++)
      mean[depth][i] += macro->position[dim * (closure[2 * k] - macro->mesh_start) + i];
    count[depth]++;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(macro->dm, point, PETSC_TRUE, &size, &closure));
  for (PetscInt i = 0; i < dim; i++) {
    X[i] = mean[0][i] / count[0];
    if (count[1] == 4) X[i] = 0.5 * mean[1][i] - 0.25 * mean[0][i];
    if (count[1] == 3) X[i] = (4 * mean[1][i] - mean[0][i]) / 9;
  }
  PetscFunctionReturn(0);
}

/* Moves a mid-edge node of a disc's rim onto the circle. */
static void MoveToRim(LamMacro macro, PetscInt point)
{
  const PetscInt rim = LamMacroFindSet(macro, "rim");
  PetscReal *X = &macro->position[macro->dim * (point - macro->mesh_start)],
            radius = PetscSqrtReal(X[0] * X[0] + X[1] * X[1]);

  if (macro->scene->macro.source != LAM_MESH_DISC || !(macro->sets[point - macro->mesh_start] >> rim & 1)) return;
  for (int i = 0; i < 2; i++) X[i] /= radius;
}

/* Positions of vertices, then edges, then cells: from the mesh if it has them (quadratic Gmsh files), else computed
   from the previous ones. */
static PetscErrorCode LocateNodes(LamMacro macro)
{
  PetscSection section;
  Vec coordinates;
  const PetscScalar *x;
  PetscInt known[2]; /* range of mesh points that may have coordinates */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(macro->dim * (macro->mesh_end - macro->mesh_start), &macro->position));
  PetscCall(DMGetCoordinateSection(macro->dm, &section));
  PetscCall(PetscSectionGetChart(section, &known[0], &known[1]));
  PetscCall(DMGetCoordinatesLocal(macro->dm, &coordinates));
  PetscCall(VecGetArrayRead(coordinates, &x));
  for (PetscInt depth = 0; depth <= macro->dim; depth++) {
    PetscInt start, end;
    PetscCall(DMPlexGetDepthStratum(macro->dm, depth, &start, &end));
    for (PetscInt p = start; p < end; p++) {
      PetscReal *X = &macro->position[macro->dim * (p - macro->mesh_start)];
      PetscInt dof = 0, offset = 0;
      if (p >= known[0] && p < known[1]) {
        PetscCall(PetscSectionGetDof(section, p, &dof));
        PetscCall(PetscSectionGetOffset(section, p, &offset));
      }
      if (dof == macro->dim)
        for (PetscInt i = 0; i < macro->dim; i++) X[i] = PetscRealPart(x[offset + i]);
      else
        PetscCall(PlaceNode(macro, p, X));
      if (depth == 1) MoveToRim(macro, p);
    }
  }
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  PetscFunctionReturn(0);
}

/* Inverse of J[dim][dim] (row-major); returns the determinant. */
static PetscReal Invert(PetscInt dim, const PetscReal J[], PetscReal inverse[])
{
  if (dim == 2) {
    const PetscReal det = J[0] * J[3] - J[1] * J[2];
    inverse[0] = J[3] / det, inverse[1] = -J[1] / det, inverse[2] = -J[2] / det, inverse[3] = J[0] / det;
    return det;
  }
  PetscReal det = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      inverse[3 * j + i] = J[3 * i1 + j1] * J[3 * i2 + j2] - J[3 * i1 + j2] * J[3 * i2 + j1];
    }
  }
  for (int j = 0; j < 3; j++) det += J[j] * inverse[3 * j];
  for (int k = 0; k < 9; k++) inverse[k] /= det;
  return det;
}

/* dN/dX, weight and position of one Gauss point, N/X1 of an axisymmetric body; X [nodes][dim]. */
static PetscErrorCode MapPoint(LamMacro macro, const LamMacroElement *element, PetscInt q, const PetscReal X[])
{
  const LamMacroKind *kind = element->kind;
  const PetscInt dim = macro->dim;
  const PetscReal *dN = &kind->gradient[q * kind->nodes * dim], *N = &kind->value[q * kind->nodes];
  PetscReal *dNdX = &macro->gradient[element->gradient + q * kind->nodes * dim],
            *place = &macro->place[dim * (element->first + q)];
  PetscReal J[LAM_MACRO_DIM * LAM_MACRO_DIM] = {0}, inverse[LAM_MACRO_DIM * LAM_MACRO_DIM], det;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < kind->nodes; a++) {
    for (PetscInt i = 0; i < dim; i++) {
      place[i] += N[a] * X[dim * a + i];
      for (PetscInt j = 0; j < dim; j++) J[dim * i + j] += X[dim * a + i] * dN[dim * a + j];
    }
  }
  det = Invert(dim, J, inverse);
  LamMacroRequire(
      det > 0, macro, &macro->scene->macro.mesh_place,
      "macro.mesh: element %d of the mesh is inside out or has no area, near (%g, %g) in its unit; mend the "
      "mesh there",
      (int)element->number, (double)place[0], (double)place[1]);
  macro->weight[element->first + q] = kind->weight[q] * det;
  if (macro->axisymmetric) {
    PetscReal *hoop = &macro->hoop[element->gradient / dim + q * kind->nodes];
    macro->weight[element->first + q] *= 2 * PETSC_PI * place[0];
    for (PetscInt a = 0; a < kind->nodes; a++) hoop[a] = N[a] / place[0];
  }
  for (PetscInt a = 0; a < kind->nodes; a++) {
    for (PetscInt i = 0; i < dim; i++) {
      for (PetscInt j = 0; j < dim; j++) dNdX[dim * a + i] += dN[dim * a + j] * inverse[dim * j + i];
    }
  }
  PetscFunctionReturn(0);
}

/* Reference positions of an element's nodes, [nodes][dim]. */
static PetscErrorCode ElementPositions(LamMacro macro, PetscInt e, PetscReal X[])
{
  PetscInt size, *closure = NULL, node = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetTransitiveClosure(macro->dm, macro->mesh_start + e, PETSC_TRUE, &size, &closure));
  for (PetscInt k = 0; k < size; k++) {
    const PetscInt p = closure[2 * k] - macro->mesh_start;
    if (macro->node_number[p] < 0) continue;
    PetscCall(PetscArraycpy(&X[macro->dim * node++], &macro->position[macro->dim * p], macro->dim));
  }
  PetscCall(DMPlexRestoreTransitiveClosure(macro->dm, macro->mesh_start + e, PETSC_TRUE, &size, &closure));
  PetscFunctionReturn(0);
}

/* The half plane of an axisymmetric body has no points beyond its axis. */
static PetscErrorCode CheckRadii(LamMacro macro)
{
  const PetscReal rounding = 1e-9; /* of mesh files, whose lengths are of order one */
  PetscReal least = PETSC_INFINITY;

  PetscFunctionBeginUser;
  if (!macro->axisymmetric) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < macro->mesh_end - macro->mesh_start; p++)
    if (macro->node_number[p] >= 0) least = PetscMin(least, macro->position[macro->dim * p]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPIU_MIN, macro->comm));
  LamMacroRequire(
      least > -rounding, macro, &macro->scene->macro.mesh_place,
      "macro.mesh: has points up to X1 = %g in its unit, but X1 is the radius of an axisymmetric body; mesh "
      "the half X1 >= 0 alone, or leave symmetry out",
      (double)least);
  PetscFunctionReturn(0);
}

static PetscErrorCode MapElements(LamMacro macro)
{
  PetscInt gradients = 0;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < macro->element_count; e++) {
    LamMacroElement *element = &macro->elements[e];
    DMPolytopeType type;
    PetscCall(DMPlexGetCellType(macro->dm, macro->mesh_start + e, &type));
    PetscCall(LamMacroKindGet(macro, type, &element->kind));
    element->first = macro->point_count;
    element->gradient = gradients;
    macro->point_count += element->kind->points;
    gradients += element->kind->points * element->kind->nodes * macro->dim;
  }
  PetscCall(PetscCalloc4(gradients, &macro->gradient, macro->point_count, &macro->weight,
                         macro->point_count * macro->dim, &macro->place, macro->point_count, &macro->point_element));
  if (macro->axisymmetric) PetscCall(PetscMalloc1(gradients / macro->dim, &macro->hoop));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscReal X[LAM_MACRO_DOFS];
    PetscCall(ElementPositions(macro, e, X));
    for (PetscInt q = 0; q < element->kind->points; q++) {
      macro->point_element[element->first + q] = e;
      PetscCall(MapPoint(macro, element, q, X));
    }
  }
  PetscFunctionReturn(0);
}

/* ---- creation and destruction ---- */

/* The undistributed mesh, in macro lengths. */
static PetscErrorCode CreateMesh(MPI_Comm comm, const LamScene *scene, DM *dm)
{
  const LamMacroSpec *spec = &scene->macro;
  char at[LAM_PLACE_TEXT], key[LAM_PLACE_TEXT + 20];

  PetscFunctionBeginUser;
  if (spec->source == LAM_MESH_BOX)
    PetscCall(LamMacroBoxCreate(comm, spec, dm));
  else if (spec->source == LAM_MESH_DISC)
    PetscCall(LamMacroDiscCreate(comm, spec->disc, spec->elements, dm));
  else {
    snprintf(key, sizeof(key), "%s: macro.mesh.gmsh", LamScenePlaceText(scene, &spec->mesh_place, at));
    PetscCall(LamMacroGmshCreate(comm, key, spec->gmsh, dm));
  }
  PetscFunctionReturn(0);
}

/* Extends all labels of sides from facets to their edges and vertices, and labels the outer facets. */
static PetscErrorCode CompleteLabels(DM dm)
{
  PetscInt labels;
  DMLabel outer;

  PetscFunctionBeginUser;
  PetscCall(DMCreateLabel(dm, OUTER));
  PetscCall(DMGetLabel(dm, OUTER, &outer));
  PetscCall(DMPlexMarkBoundaryFaces(dm, 1, outer));
  PetscCall(DMGetNumLabels(dm, &labels));
  for (PetscInt k = 0; k < labels; k++) {
    const char *name;
    DMLabel label;
    PetscCall(DMGetLabelName(dm, k, &name));
    if (!strcmp(name, "depth") || !strcmp(name, "celltype") || !strcmp(name, "Cell Sets")) continue;
    PetscCall(DMGetLabelByNum(dm, k, &label));
    PetscCall(DMPlexLabelComplete(dm, label));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Distribute(LamMacro macro)
{
  PetscInt *points, n;
  PetscSF migration = NULL;
  DM distributed;

  PetscFunctionBeginUser;
  PetscCall(NumberPoints(macro, &macro->node_number, &points));
  PetscCall(NumberParts(macro, &macro->part));
  PetscCall(DMPlexDistribute(macro->dm, 0, &migration, &distributed));
  if (distributed) {
    PetscCall(DMDestroy(&macro->dm));
    macro->dm = distributed;
  }
  PetscCall(DMPlexGetHeightStratum(macro->dm, 0, NULL, &macro->element_count));
  PetscCall(DMPlexGetChart(macro->dm, &macro->mesh_start, &macro->mesh_end));
  n = macro->mesh_end - macro->mesh_start;
  PetscCall(Migrate(migration, &macro->node_number, n));
  PetscCall(Migrate(migration, &points, n));
  PetscCall(Migrate(migration, &macro->part, n));
  PetscCall(PetscSFDestroy(&migration));
  PetscCall(PetscMalloc1(macro->element_count, &macro->elements));
  for (PetscInt e = 0; e < macro->element_count; e++) macro->elements[e] = (LamMacroElement){.number = points[e]};
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/* dim unknowns on every node. */
static PetscErrorCode NumberUnknowns(LamMacro macro)
{
  PetscSection section;

  PetscFunctionBeginUser;
  PetscCall(PetscSectionCreate(macro->comm, &section));
  PetscCall(PetscSectionSetChart(section, macro->mesh_start, macro->mesh_end));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++)
    PetscCall(PetscSectionSetDof(section, p, macro->node_number[p - macro->mesh_start] < 0 ? 0 : macro->dim));
  PetscCall(PetscSectionSetUp(section));
  PetscCall(DMSetLocalSection(macro->dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroMeshCreate(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCall(CreateMesh(macro->comm, macro->scene, &macro->dm));
  PetscCall(DMGetDimension(macro->dm, &macro->dim));
  macro->axisymmetric = (PetscBool)(macro->scene->macro.symmetry == LAM_AXISYMMETRIC);
  macro->strains = macro->dim * macro->dim + (macro->axisymmetric ? 1 : 0);
  PetscCall(CompleteLabels(macro->dm));
  PetscCall(Distribute(macro));
  PetscCall(NameSets(macro));
  PetscCall(ListFacets(macro));
  PetscCall(LocateNodes(macro));
  PetscCall(CheckRadii(macro));
  PetscCall(MapElements(macro));
  PetscCall(NumberUnknowns(macro));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroMeshDestroy(LamMacro macro)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->kind_count; k++)
    PetscCall(PetscFree3(macro->kinds[k].value, macro->kinds[k].gradient, macro->kinds[k].weight));
  PetscCall(PetscFree(macro->elements));
  PetscCall(PetscFree(macro->node_number));
  PetscCall(PetscFree(macro->part));
  PetscCall(PetscFree(macro->position));
  PetscCall(PetscFree(macro->nodes));
  PetscCall(PetscFree(macro->sets));
  PetscCall(PetscFree(macro->facets));
  PetscCall(PetscFree4(macro->gradient, macro->weight, macro->place, macro->point_element));
  PetscCall(PetscFree(macro->hoop));
  PetscCall(DMDestroy(&macro->dm));
  PetscFunctionReturn(0);
}
