/*
  A disc about the origin, or the part of it with X2 >= 0, X1 >= 0 or both: an inner square of m x m elements per
  quadrant, and around it k layers that blend from the square to the circle.

  Vertices are numbered by grid position (i, j) in the full square, |i|, |j| <= m, and by layer along its perimeter;
  vertices that no element of the part uses are omitted.
*/
#include "macro_impl.h"
#include "mesh_sources.h"

static const PetscReal SQUARE = 0.5; /* half the edge of the inner square relative to the radius */

typedef struct {
  PetscInt m, k; /* elements along half the square's edge, and across the ring */
  LamDiscPart part;
  PetscInt *number; /* [square vertices, then layers x perimeter] number of a vertex; -1: not in use */
  PetscInt vertices, elements;
  PetscReal *X;      /* [vertices][2] */
  PetscInt *corners; /* [elements][4] counter-clockwise */
} Disc;

static PetscInt SquareIndex(const Disc *disc, PetscInt i, PetscInt j)
{
  return (i + disc->m) * (2 * disc->m + 1) + j + disc->m;
}

/* Grid position of point s = 0..8m-1 of the square's perimeter, counter-clockwise from (m, 0). */
static void Perimeter(PetscInt m, PetscInt s, PetscInt *i, PetscInt *j)
{
  const PetscInt t = (s + m) % (8 * m), side = t / (2 * m), along = t % (2 * m) - m;

  *i = side == 0 ? m : side == 1 ? -along : side == 2 ? -m : along;
  *j = side == 0 ? along : side == 1 ? m : side == 2 ? -along : -m;
}

static PetscInt RingIndex(const Disc *disc, PetscInt layer, PetscInt s)
{
  const PetscInt m = disc->m;
  PetscInt i, j;

  s = (s + 8 * m) % (8 * m);
  Perimeter(m, s, &i, &j);
  return layer ? (2 * m + 1) * (2 * m + 1) + (layer - 1) * 8 * m + s : SquareIndex(disc, i, j);
}

/* Number of a vertex; at its first use it is numbered and positioned. */
static PetscInt Vertex(Disc *disc, PetscInt index, const PetscReal X[2])
{
  if (disc->number[index] < 0) {
    disc->number[index] = disc->vertices++;
    for (int i = 0; i < 2; i++) disc->X[2 * disc->number[index] + i] = PetscAbsReal(X[i]) < 1e-14 ? 0 : X[i];
  }
  return disc->number[index];
}

static PetscInt SquareVertex(Disc *disc, PetscInt i, PetscInt j)
{
  const PetscReal X[2] = {SQUARE * i / disc->m, SQUARE * j / disc->m};

  return Vertex(disc, SquareIndex(disc, i, j), X);
}

static PetscInt RingVertex(Disc *disc, PetscInt layer, PetscInt s)
{
  const PetscReal angle = 0.25 * PETSC_PI * s / disc->m, share = (PetscReal)layer / disc->k;
  PetscInt i, j;

  Perimeter(disc->m, (s + 8 * disc->m) % (8 * disc->m), &i, &j);
  const PetscReal X[2] = {(1 - share) * SQUARE * i / disc->m + share * PetscCosReal(angle),
                          (1 - share) * SQUARE * j / disc->m + share * PetscSinReal(angle)};
  return Vertex(disc, RingIndex(disc, layer, s), X);
}

static void FillDisc(Disc *disc)
{
  const PetscBool right = (PetscBool)(disc->part == LAM_DISC_RIGHT || disc->part == LAM_DISC_QUARTER);
  const PetscBool upper = (PetscBool)(disc->part == LAM_DISC_HALF || disc->part == LAM_DISC_QUARTER);
  const PetscInt m = disc->m, left = right ? 0 : -m, low = upper ? 0 : -m;
  const PetscInt first = right && !upper ? -2 * m : 0, around = (right ? 1 : 2) * (upper ? 1 : 2) * 2 * m;
  PetscInt *corner = disc->corners;

  for (PetscInt i = left; i < m; i++) {
    for (PetscInt j = low; j < m; j++) {
      for (int c = 0; c < 4; c++) *corner++ = SquareVertex(disc, i + (c == 1 || c == 2), j + (c > 1));
    }
  }
  for (PetscInt layer = 0; layer < disc->k; layer++) {
    for (PetscInt s = first; s < first + around; s++) {
      for (int c = 0; c < 4; c++) *corner++ = RingVertex(disc, layer + (c == 1 || c == 2), s + (c > 1));
    }
  }
  disc->elements = (PetscInt)(corner - disc->corners) / 4;
}

/* Facets on the circle, on X2 = 0 and on X1 = 0 are strata 1, 2, 3 of "Face Sets". */
static PetscErrorCode LabelSides(DM dm)
{
  const PetscReal near = 1e-9;
  PetscInt start, end;
  DMLabel label;
  PetscSection section;
  DM coordinate_dm;
  Vec coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMCreateLabel(dm, "Face Sets"));
  PetscCall(DMGetLabel(dm, "Face Sets", &label));
  PetscCall(DMGetCoordinateDM(dm, &coordinate_dm));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &start, &end));
  for (PetscInt p = start; p < end; p++) {
    PetscScalar *x = NULL;
    PetscInt size, side;
    PetscCall(DMPlexGetSupportSize(dm, p, &size));
    if (size != 1) continue;
    PetscCall(DMPlexVecGetClosure(coordinate_dm, section, coordinates, p, NULL, &x));
    side = PetscAbsScalar(x[1]) + PetscAbsScalar(x[3]) < near   ? 2
           : PetscAbsScalar(x[0]) + PetscAbsScalar(x[2]) < near ? 3
                                                                : 1;
    PetscCall(DMPlexVecRestoreClosure(coordinate_dm, section, coordinates, p, NULL, &x));
    PetscCall(DMLabelSetValue(label, p, side));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroDiscCreate(MPI_Comm comm, LamDiscPart part, const PetscInt elements[2], DM *dm)
{
  Disc disc = {.m = elements[0], .k = elements[1], .part = part};
  const PetscInt most = (2 * disc.m + 1) * (2 * disc.m + 1) + disc.k * 8 * disc.m;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc3(most, &disc.number, 2 * most, &disc.X, 4 * (4 * disc.m * disc.m + 8 * disc.m * disc.k),
                         &disc.corners));
  for (PetscInt v = 0; v < most; v++) disc.number[v] = -1;
  if (rank == 0) FillDisc(&disc);
  PetscCall(
      DMPlexCreateFromCellListPetsc(comm, 2, disc.elements, disc.vertices, 4, PETSC_TRUE, disc.corners, 2, disc.X, dm));
  PetscCall(LabelSides(*dm));
  PetscCall(PetscFree3(disc.number, disc.X, disc.corners));
  PetscFunctionReturn(0);
}
