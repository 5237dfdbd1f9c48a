#include "mesh.h"
#include "outline.h"

#define ORIGIN -1 /* representative of nodes prescribed at F X */

/* ---- elements along faces ---- */

/* Elements on the arcs at both ends of a face: as many as their part of it, at least one. */
static void CountOnArcs(const LamMesh *mesh, const PetscReal flat[2], PetscInt on[2])
{
  const PetscReal part[2] = {flat[0], 1.0 - flat[1]};

  for (PetscInt i = 0; i < 2; ++i)
    on[i] = part[i] > 0.0 ? PetscMax(1, (PetscInt)(part[i] * (PetscReal)mesh->along + 0.5)) : 0;
  while (on[0] + on[1] >= mesh->along && on[0] + on[1] > 2) --on[on[1] > on[0]];
}

static void PlaceEnds(PetscReal grading, const PetscReal flat[2], LamMesh *mesh, PetscInt face)
{
  PetscReal *ends = &mesh->ends[face * (mesh->along + 1)];
  PetscInt on[2], count;

  CountOnArcs(mesh, flat, on);
  mesh->flat[face][0] = on[0];
  mesh->flat[face][1] = mesh->along - on[1];
  count = mesh->flat[face][1] - on[0];
  for (PetscInt i = 0; i <= count; ++i) {
    const PetscReal s = (PetscReal)i / (PetscReal)count;
    const PetscReal u = s - grading * PetscSinReal(2.0 * PETSC_PI * s) / (2.0 * PETSC_PI);

    ends[on[0] + i] = i == count ? flat[1] : flat[0] + u * (flat[1] - flat[0]);
  }
  for (PetscInt i = 0; i < on[0]; ++i) ends[i] = flat[0] * (PetscReal)i / (PetscReal)on[0];
  for (PetscInt i = 1; i <= on[1]; ++i)
    ends[mesh->along - on[1] + i] = flat[1] + (1.0 - flat[1]) * (PetscReal)i / (PetscReal)on[1];
  ends[mesh->along] = 1.0;
}

/* The element ends of a partner, in opposite direction. */
static void MirrorEnds(LamMesh *mesh, PetscInt from, PetscInt to)
{
  const PetscInt along = mesh->along;

  for (PetscInt i = 0; i < 2; ++i) mesh->flat[to][i] = along - mesh->flat[from][1 - i];
  for (PetscInt i = 0; i <= along; ++i)
    mesh->ends[to * (along + 1) + i] = 1.0 - mesh->ends[from * (along + 1) + along - i];
}

/* ---- nodes ---- */

static void PlaceFace(const LamOutline *outline, PetscInt k, LamMesh *mesh, PetscInt face)
{
  for (PetscInt i = 0; i < 3 * mesh->along; ++i) {
    const PetscReal s = LamMeshShare(mesh, face, (PetscReal)(i / 3) + 0.5 * (PetscReal)(i % 3));

    for (PetscInt r = 0; r < mesh->radial_nodes; ++r)
      LamOutlinePoint(outline, k, s, (PetscReal)r / (PetscReal)(mesh->radial_nodes - 1),
                      &mesh->X[2 * LamMeshNode(mesh, LamMeshRing(mesh, face, i / 3, i % 3), r)]);
  }
}

static PetscErrorCode PlaceWalls(const LamMicrostructure *micro, PetscInt cell, const LamOutline *outline,
                                 LamMesh *mesh)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < outline->count; ++k) {
    const PetscInt face = mesh->tissue->first[cell] + k, partner = mesh->tissue->partner[face];
    PetscReal flat[2];

    mesh->length[face] = outline->length[k];
    mesh->thickness[face] = outline->thickness[k];
    LamOutlineFlat(outline, k, flat);
    PetscCheck(flat[0] < flat[1], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "cell %d: air at both ends of face %d, %.3g apothems long, leaves nothing of it", (int)cell, (int)k,
               (double)outline->length[k]);
    if (partner >= 0 && partner < face)
      MirrorEnds(mesh, partner, face);
    else
      PlaceEnds(micro->grading, flat, mesh, face);
    PetscCheck(mesh->flat[face][0] < mesh->flat[face][1], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%d elements along a face: with air at both its ends there must be 3 at least", (int)mesh->along);
    PlaceFace(outline, k, mesh, face);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaceCell(const LamMicrostructure *micro, PetscInt cell, LamMesh *mesh)
{
  const PetscReal clearance = 2.0 * (1.0 - mesh->apothem);
  LamOutline outline;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamOutlineCreate(mesh->tissue, cell, LamWallThickness(micro, cell), clearance, &outline));
  ierr = PlaceWalls(micro, cell, &outline, mesh);
  PetscCall(LamOutlineDestroy(&outline));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Lengths of the outer edges, and the extremes of lengths and walls. */
static void MeasureMesh(LamMesh *mesh)
{
  PetscReal low[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, high[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};
  PetscInt count = 0;

  mesh->shortest = mesh->thinnest = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < mesh->tissue->faces * mesh->along; ++k) {
    const PetscInt face = k / mesh->along, e = k % mesh->along;
    const PetscReal *a = &mesh->X[2 * LamMeshOuterNode(mesh, face, 2 * e)];
    const PetscReal *b = &mesh->X[2 * LamMeshOuterNode(mesh, face, 2 * e + 2)];
    const PetscReal *ends = &mesh->ends[face * (mesh->along + 1) + e];
    const PetscBool flat = (PetscBool)(e >= mesh->flat[face][0] && e < mesh->flat[face][1]);

    mesh->edge[k] =
        flat ? mesh->length[face] * (ends[1] - ends[0]) : PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
    mesh->shortest = PetscMin(mesh->shortest, mesh->edge[k]);
    mesh->longest = PetscMax(mesh->longest, mesh->edge[k]);
    mesh->thinnest = PetscMin(mesh->thinnest, mesh->thickness[face]);
  }
  for (PetscInt face = 0; face < mesh->tissue->faces; ++face) {
    if (mesh->tissue->partner[face] < 0) continue;
    mesh->mean_length += mesh->length[face];
    ++count;
  }
  mesh->mean_length /= (PetscReal)PetscMax(1, count);
  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell) {
    PetscReal centre[2];

    LamTissueCentre(mesh->tissue, cell, centre);
    for (PetscInt d = 0; d < 2; ++d) {
      low[d] = PetscMin(low[d], centre[d]);
      high[d] = PetscMax(high[d], centre[d]);
    }
  }
  mesh->size = 1.0 + 0.5 * PetscSqrtReal(PetscSqr(high[0] - low[0]) + PetscSqr(high[1] - low[1]));
}

static void PlaceImages(LamMesh *mesh)
{
  for (PetscInt face = 0; face < mesh->tissue->faces; ++face) {
    const PetscInt *wraps = mesh->tissue->wraps[face];

    for (PetscInt d = 0; d < 2; ++d)
      mesh->image[2 * face + d] = (PetscReal)wraps[0] * mesh->period[0][d] + (PetscReal)wraps[1] * mesh->period[1][d];
  }
}

static void ConnectElements(LamMesh *mesh)
{
  /* (radial, around) offsets of the nine nodes; radial first makes the element counter-clockwise */
  static const PetscInt offset[LAM_ELEMENT_NODES][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0},
                                                        {2, 1}, {1, 2}, {0, 1}, {1, 1}};

  for (PetscInt face = 0; face < mesh->tissue->faces; ++face)
    for (PetscInt i = 0; i < mesh->along; ++i)
      for (PetscInt m = 0; m < mesh->through; ++m) {
        const PetscInt e = LamMeshElement(mesh, face, i, m);

        mesh->cell_of[e] = mesh->tissue->cell[face];
        for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
          mesh->elements[LAM_ELEMENT_NODES * e + a] =
              LamMeshNode(mesh, LamMeshRing(mesh, face, i, offset[a][1]), 2 * m + offset[a][0]);
      }
}

/* ---- classes ---- */

/* Representative of a node: the root of its class. */
static PetscInt FirstOf(const PetscInt tied[], PetscInt node)
{
  while (tied[node] != node) node = tied[node];
  return node;
}

/* Puts two nodes into one class. The representative is the lowest node number. */
static void Tie(LamMesh *mesh, PetscInt one, PetscInt other)
{
  const PetscInt a = FirstOf(mesh->node_class, one), b = FirstOf(mesh->node_class, other);

  mesh->node_class[PetscMax(a, b)] = PetscMin(a, b);
}

static void TieCuts(LamMesh *mesh)
{
  for (PetscInt k = 0; k < mesh->tissue->faces * mesh->cuts; ++k)
    for (PetscInt r = 0; r < mesh->radial_nodes; ++r) {
      PetscInt side[2];

      LamMeshCut(mesh, k, r, side);
      Tie(mesh, side[0], side[1]);
    }
}

/* Ties coincident nodes of facing walls, also across the period. */
static void TieOuterNodes(LamMesh *mesh)
{
  for (PetscInt face = 0; face < mesh->tissue->faces; ++face) {
    const PetscInt other = mesh->tissue->partner[face];

    for (PetscInt i = 2 * mesh->flat[face][0]; other >= 0 && i <= 2 * mesh->flat[face][1]; ++i)
      Tie(mesh, LamMeshOuterNode(mesh, face, i), LamMeshOuterNode(mesh, other, 2 * mesh->along - i));
  }
}

/* Assigns the nodes of outer walls that follow F to the origin, with all nodes tied to them: a bonded cell may touch
   the grip in a vertex only. Other nodes get their representative. */
static void HoldNodes(LamMesh *mesh)
{
  PetscInt *class = mesh->node_class;

  for (PetscInt i = 0; i < mesh->node_count; ++i) class[i] = FirstOf(class, i);
  for (PetscInt face = 0; face < mesh->tissue->faces; ++face)
    for (PetscInt i = 0; mesh->tissue->held[face] && i < 3 * mesh->along; ++i) {
      const PetscInt node = LamMeshNode(mesh, LamMeshRing(mesh, face, i / 3, i % 3), mesh->radial_nodes - 1);

      if (class[node] != ORIGIN) class[class[node]] = ORIGIN;
    }
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    if (class[i] != ORIGIN) class[i] = class[class[i]];
}

/* Numbers the classes in node order, after the origin if there is one, and sets the shifts. */
static PetscErrorCode NumberClasses(PetscBool has_origin, LamMesh *mesh)
{
  PetscInt *number;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->node_count, &number));
  mesh->class_count = has_origin ? 1 : 0;
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    if (mesh->node_class[i] == i) number[i] = mesh->class_count++;
  PetscCall(PetscCalloc1(2 * mesh->class_count, &mesh->class_X));
  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    const PetscInt representative = mesh->node_class[i];

    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal X = representative == ORIGIN ? 0.0 : mesh->X[2 * representative + d];

      mesh->shift[2 * i + d] = representative == i ? 0.0 : mesh->X[2 * i + d] - X;
      if (PetscAbsReal(mesh->shift[2 * i + d]) < 1e-9) mesh->shift[2 * i + d] = 0.0;
      if (representative != ORIGIN) mesh->class_X[2 * number[representative] + d] = X;
    }
  }
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    mesh->node_class[i] = mesh->node_class[i] == ORIGIN ? 0 : number[mesh->node_class[i]];
  PetscCall(PetscFree(number));
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    mesh->has_shift[e] = PETSC_FALSE;
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
      const PetscReal *S = &mesh->shift[2 * mesh->elements[LAM_ELEMENT_NODES * e + a]];

      if (S[0] != 0.0 || S[1] != 0.0) mesh->has_shift[e] = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckMicrostructure(const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  PetscCheck(micro->along > 0 && micro->through > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "elements along a face and through a wall must be chosen, got %d and %d", (int)micro->along,
             (int)micro->through);
  PetscCheck(!LamWallsTear(micro) || micro->along % 2 == 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "walls that tear are cut in the middle of faces, too: elements along a face must be even, got %d",
             (int)micro->along);
  PetscCheck(micro->grading >= 0.0 && micro->grading < 1.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "grading of the mesh is %g; it must lie between 0 and 1", (double)micro->grading);
  PetscCheck(micro->cells[0] > 0 && micro->cells[1] > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a block of %d x %d cells is empty", (int)micro->cells[0], (int)micro->cells[1]);
  if (micro->tissue) PetscFunctionReturn(0); /* walls that do not fit are found cell by cell */
  for (PetscInt cell = 0; cell < micro->cells[0] * micro->cells[1]; ++cell) {
    const PetscReal t = LamWallThickness(micro, cell), outer = LamOuterApothem(micro);

    PetscCheck(t > 0.0 && t < outer, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "wall thickness is %g apothems; it must lie between 0 and %g", (double)t, (double)outer);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshCreate(const LamMicrostructure *micro, LamMesh *mesh)
{
  PetscInt faces;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(mesh, sizeof(*mesh)));
  PetscCall(CheckMicrostructure(micro));
  PetscCall(LamTissueCreate(micro, &mesh->tissue));
  faces = mesh->tissue->faces;
  mesh->along = micro->along;
  mesh->through = micro->through;
  mesh->cell_count = mesh->tissue->cells;
  mesh->cuts = LamWallsTear(micro) ? LAM_FACE_CUTS : 0;
  mesh->face_nodes = 2 * micro->along + mesh->cuts;
  mesh->radial_nodes = 2 * micro->through + 1;
  mesh->node_count = faces * mesh->face_nodes * mesh->radial_nodes;
  mesh->element_count = faces * micro->along * micro->through;
  mesh->apothem = LamOuterApothem(micro);
  PetscCall(PetscMemcpy(mesh->period, mesh->tissue->period, sizeof(mesh->period)));
  mesh->V0 = mesh->tissue->area;
  PetscCall(PetscMalloc6(2 * mesh->node_count, &mesh->X, LAM_ELEMENT_NODES * mesh->element_count, &mesh->elements,
                         mesh->element_count, &mesh->cell_of, mesh->node_count, &mesh->node_class, 2 * mesh->node_count,
                         &mesh->shift, mesh->element_count, &mesh->has_shift));
  PetscCall(PetscCalloc6(faces * (mesh->along + 1), &mesh->ends, faces, &mesh->flat, faces, &mesh->length, faces,
                         &mesh->thickness, faces * mesh->along, &mesh->edge, 2 * faces, &mesh->image));
  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell) PetscCall(PlaceCell(micro, cell, mesh));
  MeasureMesh(mesh);
  PlaceImages(mesh);
  ConnectElements(mesh);
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    mesh->node_class[i] = i; /* the representative node until NumberClasses */
  if (micro->interface == LAM_INTERFACE_BONDED) {
    TieCuts(mesh);
    TieOuterNodes(mesh);
  }
  HoldNodes(mesh);
  PetscCall(NumberClasses(micro->is_patch, mesh));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshDestroy(LamMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(LamTissueDestroy(&mesh->tissue));
  PetscCall(PetscFree6(mesh->X, mesh->elements, mesh->cell_of, mesh->node_class, mesh->shift, mesh->has_shift));
  PetscCall(PetscFree6(mesh->ends, mesh->flat, mesh->length, mesh->thickness, mesh->edge, mesh->image));
  PetscCall(PetscFree(mesh->class_X));
  PetscFunctionReturn(0);
}

LamJunction LamMeshJunction(const LamMesh *mesh, PetscInt face)
{
  const LamTissue tissue = mesh->tissue;
  LamJunction j = {.count = 1, .face = {face}};
  PetscInt last = face;

  while (j.count < LAM_MOST_AROUND) { /* counter-clockwise: across the face before */
    const PetscInt before = LamTissuePrevious(tissue, last), next = tissue->partner[before];

    if (next == face) j.closed = PETSC_TRUE;
    if (next < 0 || j.closed) break;
    for (PetscInt d = 0; d < 2; ++d) j.image[j.count][d] = j.image[j.count - 1][d] + mesh->image[2 * before + d];
    j.face[j.count++] = last = next;
  }
  while (!j.closed && j.count < LAM_MOST_AROUND) { /* clockwise: across the face itself */
    const PetscInt first = j.face[0], partner = tissue->partner[first];

    if (partner < 0) break;
    (void)PetscArraymove(&j.face[1], &j.face[0], j.count);
    (void)PetscArraymove(&j.image[1], &j.image[0], j.count);
    j.face[0] = LamTissueNext(tissue, partner);
    for (PetscInt d = 0; d < 2; ++d) j.image[0][d] = j.image[1][d] + mesh->image[2 * first + d];
    ++j.count;
    ++j.at;
  }
  return j;
}
