/*
  Meshes from files of Gmsh: surfaces in the plane X3 = 0 of triangles and quadrilaterals, straight or of second order.

  Rank 0 reads the file (mesh_gmsh_read.c), turns clockwise elements over and refuses what no body can be made of: edges
  of more than two elements, sides that lie on no element, parts that lie on each other without hanging together. DMPlex
  makes edges of its list of cells. The middle nodes of second-order elements are coordinates of edges and cells.
  Physical groups become labels of their names, LAM_MESH_SET or LAM_MESH_REGION before them.
*/
#include "macro_impl.h"
#include "mesh_gmsh.h"
#include "mesh_sources.h"
#include <stdarg.h>

/* Of the size of the body: distance within which nodes coincide and from which they are not in the plane. Files have 16
   digits; models of CAD are exact to 1e-7, and no element of use is as small as this. */
#define NEAR 1e-6
#define NONE SIZE_MAX

/* An edge of an element. */
typedef struct {
  int64_t key[2];           /* nodes at its ends, the lower number first */
  int64_t forward, element; /* whether the element runs along it in this order, counter-clockwise */
  size_t middle;            /* node, or NONE */
} Edge;

typedef struct {
  LamGmsh file;
  PetscInt cells, vertices;
  PetscInt *cell;   /* [element] its number; -1: no element of the surface */
  PetscInt *vertex; /* [node] its number; -1: no corner of an element */
  size_t *part;     /* [node] another node of its part of the body, or itself */
  LamGmshList edges;
  double size; /* of the body */
  char *why;   /* LAM_GMSH_WHY long; empty: all is well */
} Body;

static void Wrong(Body *body, const char format[], ...)
{
  va_list arguments;

  if (body->why[0]) return;
  va_start(arguments, format);
  vsnprintf(body->why, LAM_GMSH_WHY, format, arguments);
  va_end(arguments);
}

static LamGmshNode *NodeOf(const Body *body, size_t node)
{
  return (LamGmshNode *)body->file.nodes.items + node;
}

static int64_t TagOf(const Body *body, size_t node)
{
  return NodeOf(body, node)->key[0];
}

static const LamGmshElement *ElementOf(const Body *body, size_t e)
{
  return (const LamGmshElement *)body->file.elements.items + e;
}

static int Corners(const LamGmshElement *element)
{
  return (int)DMPolytopeTypeGetNumVertices(element->kind->polytope);
}

static int Edges(const LamGmshElement *element)
{
  return (int)strlen(element->kind->edges) / 2;
}

/* Name of the g-th physical group of an element, or NULL. */
static LamGmshName *NameOf(const Body *body, const LamGmshElement *element, size_t g)
{
  const int64_t tag = ((const int64_t *)body->file.groups.items)[element->first + g];

  return LamGmshFind(&body->file.names, sizeof(LamGmshName), element->kind->dimension, tag);
}

static PetscBool IsNamed(const Body *body, const LamGmshElement *element)
{
  for (size_t g = 0; g < element->groups; g++)
    if (NameOf(body, element, g)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* ---- checks, on rank 0 ---- */

/* Numbers the corners, measures the body and looks whether it is plane. */
static void NumberVertices(Body *body)
{
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};

  for (size_t n = 0; n < body->file.nodes.count; n++) body->vertex[n] = -1;
  for (size_t e = 0; e < body->file.elements.count; e++) {
    const LamGmshElement *element = ElementOf(body, e);

    for (int i = 0; i < element->kind->nodes && element->kind->dimension == 2; i++) {
      for (int d = 0; d < 2; d++) {
        low[d] = PetscMin(low[d], NodeOf(body, element->node[i])->X[d]);
        high[d] = PetscMax(high[d], NodeOf(body, element->node[i])->X[d]);
      }
      if (i < Corners(element)) body->vertex[element->node[i]] = 0;
    }
  }
  for (size_t n = 0; n < body->file.nodes.count; n++)
    if (!body->vertex[n]) body->vertex[n] = body->vertices++;
  if (!body->vertices) Wrong(body, "there is no element of a surface");
  body->size = PetscMax(high[0] - low[0], high[1] - low[1]);
  for (size_t e = 0; e < body->file.elements.count; e++) {
    const LamGmshElement *element = ElementOf(body, e);

    for (int i = 0; i < element->kind->nodes && element->kind->dimension == 2; i++) {
      const double z = NodeOf(body, element->node[i])->X[2];

      if (PetscAbsReal(z) > NEAR * body->size)
        Wrong(body, "node %lld lies at X3 = %g; the body is a surface in the plane X3 = 0: move or project it there",
              (long long)TagOf(body, element->node[i]), z);
    }
  }
}

/* Whether an element runs clockwise. */
static PetscBool IsTurned(const Body *body, const LamGmshElement *element)
{
  const double *x = NodeOf(body, element->node[0])->X;
  double area = 0;

  for (int i = 1; i + 1 < Corners(element); i++) {
    const double *y = NodeOf(body, element->node[i])->X, *z = NodeOf(body, element->node[i + 1])->X;
    area += (y[0] - x[0]) * (z[1] - x[1]) - (y[1] - x[1]) * (z[0] - x[0]);
  }
  return (PetscBool)(area < 0);
}

static int CompareEdges(const void *a, const void *b)
{
  const Edge *one = a, *other = b;
  const int64_t keys[2][4] = {{one->key[0], one->key[1], one->forward, one->element},
                              {other->key[0], other->key[1], other->forward, other->element}};

  for (int k = 0; k < 4; k++)
    if (keys[0][k] != keys[1][k]) return keys[0][k] < keys[1][k] ? -1 : 1;
  return 0;
}

static void ListEdges(Body *body)
{
  for (size_t e = 0; e < body->file.elements.count; e++) {
    const LamGmshElement *element = ElementOf(body, e);
    const char *ends = element->kind->edges;
    const PetscBool turned = IsTurned(body, element);

    for (int k = 0; k < Edges(element) && element->kind->dimension == 2; k++) {
      const size_t from = element->node[ends[2 * k] - '0'], to = element->node[ends[2 * k + 1] - '0'];
      Edge *edge = LamGmshAppend(&body->edges, sizeof(*edge));

      if (!edge) {
        Wrong(body, "no memory for the mesh");
        return;
      }
      edge->key[0] = (int64_t)PetscMin(from, to);
      edge->key[1] = (int64_t)PetscMax(from, to);
      edge->forward = (from < to) != turned;
      edge->element = (int64_t)e;
      edge->middle = element->kind->order == 2 ? element->node[Corners(element) + k] : NONE;
    }
  }
  if (body->edges.count) qsort(body->edges.items, body->edges.count, sizeof(Edge), CompareEdges);
}

/* Whether two elements have the same corners. */
static PetscBool AreSame(const LamGmshElement *one, const LamGmshElement *other)
{
  int shared = 0;

  for (int i = 0; i < Corners(one); i++)
    for (int j = 0; j < Corners(other); j++) shared += one->node[i] == other->node[j];
  return (PetscBool)(shared == Corners(one) && shared == Corners(other));
}

/* Numbers the elements: those that format 2.2 repeats, once for each of their groups, are one. */
static void NumberCells(Body *body)
{
  Edge *edges = body->edges.items;

  for (size_t e = 0; e < body->file.elements.count; e++)
    body->cell[e] = ElementOf(body, e)->kind->dimension == 2 ? (PetscInt)e : -1;
  for (size_t k = 1; k < body->edges.count; k++) {
    Edge *edge = &edges[k], *before = &edges[k - 1];

    if (edge->key[0] != before->key[0] || edge->key[1] != before->key[1]) continue;
    if (edge->middle == NONE) edge->middle = before->middle;
    if (before->middle != NONE && edge->middle != before->middle)
      Wrong(body, "the edge from node %lld to %lld has two middle nodes, %lld and %lld",
            (long long)TagOf(body, (size_t)edge->key[0]), (long long)TagOf(body, (size_t)edge->key[1]),
            (long long)TagOf(body, before->middle), (long long)TagOf(body, edge->middle));
    if (edge->forward != before->forward) continue;
    if (AreSame(ElementOf(body, (size_t)edge->element), ElementOf(body, (size_t)before->element)))
      body->cell[edge->element] = body->cell[before->element];
    else
      Wrong(body, "two elements lie on the same side of the edge from node %lld to %lld: they overlap",
            (long long)TagOf(body, (size_t)edge->key[0]), (long long)TagOf(body, (size_t)edge->key[1]));
  }
  for (size_t e = 0; e < body->file.elements.count; e++) {
    if (body->cell[e] < 0) continue;
    body->cell[e] = body->cell[e] == (PetscInt)e ? body->cells++ : body->cell[body->cell[e]];
  }
}

/* Every line and point of a named group is on an element. */
static void CheckSides(Body *body)
{
  for (size_t e = 0; e < body->file.elements.count; e++) {
    const LamGmshElement *element = ElementOf(body, e);
    const size_t from = element->node[0], to = element->kind->dimension ? element->node[1] : from;

    if (element->kind->dimension == 2 || !IsNamed(body, element)) continue;
    if (!element->kind->dimension && body->vertex[from] < 0)
      Wrong(body, "the point at node %lld is on no element", (long long)TagOf(body, from));
    if (element->kind->dimension &&
        !LamGmshFind(&body->edges, sizeof(Edge), (int64_t)PetscMin(from, to), (int64_t)PetscMax(from, to)))
      Wrong(body, "the line from node %lld to %lld is on no element", (long long)TagOf(body, from),
            (long long)TagOf(body, to));
  }
}

/* A node that stands for the part of the body that a node is in. */
static size_t PartOf(Body *body, size_t node)
{
  while (body->part[node] != node) node = body->part[node] = body->part[body->part[node]];
  return node;
}

/* A node along a line on which no regular mesh has many nodes at one place. */
typedef struct {
  double along;
  size_t node;
} Projection;

static int CompareProjections(const void *a, const void *b)
{
  const double one = ((const Projection *)a)->along, other = ((const Projection *)b)->along;

  return (one > other) - (one < other);
}

static double Along(const LamGmshNode *node)
{
  const double angle = 1; /* any that no lattice has */

  return node->X[0] * cos(angle) + node->X[1] * sin(angle);
}

/* Whether a node lies on the chord of an edge. */
static PetscBool IsOn(const Body *body, size_t node, size_t from, size_t to)
{
  const double *X = NodeOf(body, node)->X, *A = NodeOf(body, from)->X, *B = NodeOf(body, to)->X;
  const double along[2] = {B[0] - A[0], B[1] - A[1]}, off[2] = {X[0] - A[0], X[1] - A[1]};
  const double square = along[0] * along[0] + along[1] * along[1];
  const double share = PetscMax(0, PetscMin(1, (along[0] * off[0] + along[1] * off[1]) / square));

  return (PetscBool)(hypot(off[0] - share * along[0], off[1] - share * along[1]) <= NEAR * body->size);
}

/* Refuses nodes that lie on nodes or edges of another part of the body: a mesh that was not merged. Nodes along a crack
   belong to one part. `nodes`: corners, sorted. */
static void CheckTouching(Body *body, size_t n, const Projection nodes[])
{
  const Edge *edges = body->edges.items;
  size_t twice = 0, first[2] = {0, 0};

  for (size_t k = 0; k < n; k++)
    for (size_t l = k + 1; l < n && nodes[l].along - nodes[k].along <= 2 * NEAR * body->size; l++) {
      const double *X = NodeOf(body, nodes[k].node)->X, *Y = NodeOf(body, nodes[l].node)->X;

      if (hypot(X[0] - Y[0], X[1] - Y[1]) > NEAR * body->size ||
          PartOf(body, nodes[k].node) == PartOf(body, nodes[l].node))
        continue;
      if (!twice++) first[0] = nodes[k].node, first[1] = nodes[l].node;
      break;
    }
  if (twice)
    Wrong(body,
          "%zu nodes of one part of the body lie on nodes of another, such as %lld on %lld, and do not hang together "
          "with them; merge the mesh (in Gmsh: Coherence, or BooleanFragments before meshing)",
          twice, (long long)TagOf(body, first[0]), (long long)TagOf(body, first[1]));
  for (size_t k = 0; k < body->edges.count && !body->why[0]; k++) {
    const size_t from = (size_t)edges[k].key[0], to = (size_t)edges[k].key[1];
    const double ends[2] = {Along(NodeOf(body, from)), Along(NodeOf(body, to))};
    size_t low = 0;

    for (size_t high = n; low < high;) { /* the first node that is not before the edge */
      const size_t middle = (low + high) / 2;
      if (nodes[middle].along < PetscMin(ends[0], ends[1]))
        low = middle + 1;
      else
        high = middle;
    }
    for (size_t l = low; l < n && nodes[l].along <= PetscMax(ends[0], ends[1]); l++)
      if (PartOf(body, nodes[l].node) != PartOf(body, from) && IsOn(body, nodes[l].node, from, to))
        Wrong(body,
              "node %lld of one part of the body lies on the edge from node %lld to %lld of another, and does not hang "
              "together with it; merge the mesh (in Gmsh: BooleanFragments before meshing)",
              (long long)TagOf(body, nodes[l].node), (long long)TagOf(body, from), (long long)TagOf(body, to));
  }
}

static PetscErrorCode CheckParts(Body *body)
{
  PetscBool several = PETSC_FALSE;
  Projection *nodes;
  size_t n = 0;

  PetscFunctionBeginUser;
  for (size_t k = 0; k < body->file.nodes.count; k++) body->part[k] = k;
  PetscCall(PetscMalloc1(body->file.nodes.count, &nodes));
  for (size_t e = 0; e < body->file.elements.count; e++) {
    const LamGmshElement *element = ElementOf(body, e);

    for (int i = 0; i < element->kind->nodes && body->cell[e] >= 0; i++)
      body->part[PartOf(body, element->node[i])] = PartOf(body, element->node[0]);
  }
  for (size_t k = 0; k < body->file.nodes.count; k++) {
    if (body->vertex[k] < 0) continue;
    nodes[n++] = (Projection){Along(NodeOf(body, k)), k};
    if (PartOf(body, k) != PartOf(body, nodes[0].node)) several = PETSC_TRUE;
  }
  qsort(nodes, n, sizeof(*nodes), CompareProjections);
  if (several) CheckTouching(body, n, nodes);
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(0);
}

static PetscErrorCode Understand(Body *body, const char path[])
{
  PetscFunctionBeginUser;
  if (!LamGmshRead(path, &body->file, body->why)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(body->file.elements.count, &body->cell, body->file.nodes.count, &body->vertex,
                         body->file.nodes.count, &body->part));
  NumberVertices(body);
  ListEdges(body);
  NumberCells(body);
  CheckSides(body);
  PetscCall(CheckParts(body));
  PetscFunctionReturn(0);
}

/* ---- the mesh ---- */

/* Cells and their vertices, which follow the cells; then edges. */
static PetscErrorCode Connect(MPI_Comm comm, const Body *body, DM *dm)
{
  DM plain;
  DMLabel types;

  PetscFunctionBeginUser;
  PetscCall(DMCreate(comm, &plain));
  PetscCall(DMSetType(plain, DMPLEX));
  PetscCall(DMSetDimension(plain, 2));
  PetscCall(DMPlexGetCellTypeLabel(plain, &types));
  PetscCall(DMPlexSetChart(plain, 0, body->cells + body->vertices));
  for (int pass = 0; pass < 2; pass++) {
    for (size_t e = 0; e < body->file.elements.count; e++) {
      const LamGmshElement *element = ElementOf(body, e);
      const PetscBool turned = IsTurned(body, element);
      const int corners = Corners(element);
      PetscInt cone[LAM_GMSH_NODES];

      if (body->cell[e] < 0) continue;
      for (int i = 0; i < corners; i++)
        cone[i] = body->cells + body->vertex[element->node[turned ? (corners - i) % corners : i]];
      if (!pass)
        PetscCall(DMPlexSetConeSize(plain, body->cell[e], corners));
      else {
        PetscCall(DMPlexSetCone(plain, body->cell[e], cone));
        PetscCall(DMPlexSetCellType(plain, body->cell[e], element->kind->polytope));
      }
    }
    if (!pass) PetscCall(DMSetUp(plain));
  }
  for (PetscInt v = body->cells; v < body->cells + body->vertices; v++)
    PetscCall(DMPlexSetCellType(plain, v, DM_POLYTOPE_POINT));
  PetscCall(DMPlexSymmetrize(plain));
  PetscCall(DMPlexStratify(plain));
  PetscCall(DMPlexInterpolate(plain, dm));
  PetscCall(DMDestroy(&plain));
  PetscFunctionReturn(0);
}

/* The mesh point of the edge between two nodes, or of a corner (from = to). */
static PetscErrorCode FindPoint(DM dm, const Body *body, size_t from, size_t to, PetscInt *point)
{
  const PetscInt ends[2] = {body->cells + body->vertex[from], body->cells + body->vertex[to]}, *join;
  PetscInt count;

  PetscFunctionBeginUser;
  *point = ends[0];
  if (from == to) PetscFunctionReturn(0);
  PetscCall(DMPlexGetFullJoin(dm, 2, ends, &count, &join));
  PetscCheck(count == 1, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%d edges between two nodes", (int)count);
  *point = join[0];
  PetscCall(DMPlexRestoreJoin(dm, 2, ends, &count, &join));
  PetscFunctionReturn(0);
}

/* Coordinates of vertices and of the middle nodes of edges and cells: `node` [point], or NONE. */
static PetscErrorCode Locate(DM dm, const Body *body, const size_t node[])
{
  PetscSection section;
  PetscInt start, end, size;
  PetscScalar *x;
  Vec coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &start, &end));
  PetscCall(DMSetCoordinateDim(dm, 2));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(PetscSectionSetNumFields(section, 1));
  PetscCall(PetscSectionSetFieldComponents(section, 0, 2));
  PetscCall(PetscSectionSetChart(section, start, end));
  for (PetscInt p = start; p < end; p++) {
    PetscCall(PetscSectionSetDof(section, p, node[p] == NONE ? 0 : 2));
    PetscCall(PetscSectionSetFieldDof(section, p, 0, node[p] == NONE ? 0 : 2));
  }
  PetscCall(PetscSectionSetUp(section));
  PetscCall(PetscSectionGetStorageSize(section, &size));
  PetscCall(VecCreate(PETSC_COMM_SELF, &coordinates));
  PetscCall(PetscObjectSetName((PetscObject)coordinates, "coordinates"));
  PetscCall(VecSetSizes(coordinates, size, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(coordinates, 2));
  PetscCall(VecSetType(coordinates, VECSTANDARD));
  PetscCall(VecGetArray(coordinates, &x));
  for (PetscInt p = start; p < end; p++) {
    PetscInt offset;

    PetscCall(PetscSectionGetOffset(section, p, &offset));
    for (int d = 0; d < 2 && node[p] != NONE; d++) x[offset + d] = NodeOf(body, node[p])->X[d];
  }
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates));
  PetscCall(VecDestroy(&coordinates));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaceNodes(DM dm, const Body *body)
{
  const Edge *edges = body->edges.items;
  PetscInt start, end;
  size_t *node;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &start, &end));
  PetscCall(PetscMalloc1(end, &node));
  for (PetscInt p = start; p < end; p++) node[p] = NONE;
  for (size_t n = 0; n < body->file.nodes.count; n++)
    if (body->vertex[n] >= 0) node[body->cells + body->vertex[n]] = n;
  for (size_t k = 0; k < body->edges.count; k++) {
    PetscInt p;

    if (edges[k].middle == NONE) continue;
    PetscCall(FindPoint(dm, body, (size_t)edges[k].key[0], (size_t)edges[k].key[1], &p));
    node[p] = edges[k].middle;
  }
  for (size_t e = 0; e < body->file.elements.count; e++) {
    const LamGmshElement *element = ElementOf(body, e);
    const int centre = Corners(element) + Edges(element);

    if (body->cell[e] >= 0 && element->kind->nodes > centre) node[body->cell[e]] = element->node[centre];
  }
  PetscCall(Locate(dm, body, node));
  PetscCall(PetscFree(node));
  PetscFunctionReturn(0);
}

/* Labels of all named groups that have elements, on all ranks in the same order. */
static PetscErrorCode Label(MPI_Comm comm, DM dm, const Body *body)
{
  const LamGmshName *names = body->file.names.items;
  PetscInt count = (PetscInt)body->file.names.count;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&count, 1, MPIU_INT, 0, comm));
  for (PetscInt k = 0; k < count; k++) {
    char label[LAM_NAME_LENGTH + sizeof(LAM_MESH_REGION)] = "";

    if (names)
      snprintf(label, sizeof(label), "%s%s", names[k].key[0] == 2 ? LAM_MESH_REGION : LAM_MESH_SET, names[k].name);
    PetscCallMPI(MPI_Bcast(label, sizeof(label), MPI_CHAR, 0, comm));
    PetscCall(DMCreateLabel(dm, label));
  }
  for (size_t e = 0; e < body->file.elements.count; e++) {
    const LamGmshElement *element = ElementOf(body, e);
    PetscInt point = body->cell[e];

    for (size_t g = 0; g < element->groups; g++) {
      char label[LAM_NAME_LENGTH + sizeof(LAM_MESH_REGION)];
      const LamGmshName *name = NameOf(body, element, g);

      if (!name) continue;
      if (point < 0) PetscCall(FindPoint(dm, body, element->node[0], element->node[element->kind->dimension], &point));
      snprintf(label, sizeof(label), "%s%s", name->key[0] == 2 ? LAM_MESH_REGION : LAM_MESH_SET, name->name);
      PetscCall(DMSetLabelValue(dm, label, point, 1));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGmshCreate(MPI_Comm comm, const char key[], const char path[], DM *dm)
{
  char why[LAM_GMSH_WHY] = "";
  Body body = {.why = why};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *dm = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PetscCall(Understand(&body, path));
  PetscCallMPI(MPI_Bcast(why, sizeof(why), MPI_CHAR, 0, comm));
  if (!why[0]) {
    PetscCall(Connect(comm, &body, dm));
    PetscCall(PlaceNodes(*dm, &body));
    PetscCall(Label(comm, *dm, &body));
  }
  LamGmshFree(&body.file);
  free(body.edges.items);
  PetscCall(PetscFree3(body.cell, body.vertex, body.part));
  PetscCheck(!why[0], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s: %s", key, path, why);
  PetscFunctionReturn(0);
}
