/*
  Collapsed lumens. In bonded tissue contact within a lumen is not modelled; in contact tissue it is between walls that
  are not beside each other (touching.h), but a corner may close like a hinge. A state in which an inner loop intersects
  itself, or is clockwise because the ring is inverted, is rejected. This occurs at large compression.

  Method. The inner loop of each cell is the polygon of its nodes (two per element). The loop is simple if no two
  non-adjacent sides intersect. Bounding boxes are compared first. At a cut (mesh.h) both nodes are in the polygon, and
  may pass each other by rounding or by the compliance of the cut: sides beside it count as adjacent.
*/
#include "measure.h"

static PetscReal Cross(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2])
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static PetscBool BoxesOverlap(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2], const PetscReal d[2])
{
  for (PetscInt i = 0; i < 2; ++i)
    if (PetscMax(a[i], b[i]) < PetscMin(c[i], d[i]) || PetscMax(c[i], d[i]) < PetscMin(a[i], b[i])) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool SidesCross(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2], const PetscReal d[2])
{
  return (PetscBool)(Cross(a, b, c) * Cross(a, b, d) < 0.0 && Cross(c, d, a) * Cross(c, d, b) < 0.0);
}

/* Whether the polygon x[n][2] crosses itself; sides less than `apart` sides from each other do not count. */
static PetscBool CrossesItself(PetscInt n, const PetscReal x[][2], PetscInt apart)
{
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = i + apart; j < n; ++j) {
      if (i + n - j < apart) continue;
      if (BoxesOverlap(x[i], x[i + 1], x[j], x[(j + 1) % n]) && SidesCross(x[i], x[i + 1], x[j], x[(j + 1) % n]))
        return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* Twice the signed area of a polygon. */
static PetscReal SignedArea(PetscInt n, const PetscReal x[][2])
{
  PetscReal area = 0.0;

  for (PetscInt i = 0, j = n - 1; i < n; j = i++) area += x[j][0] * x[i][1] - x[j][1] * x[i][0];
  return area;
}

void LamBracketText(const PetscReal between[2], char text[], size_t length)
{
  const PetscReal narrowness = between[1] / PetscMax(1e-12, between[1] - between[0]);
  const int digits = (int)PetscMax(5.0, PetscCeilReal(PetscLog10Real(PetscMax(1.0, narrowness))) + 1.0);

  text[0] = '\0';
  if (between[1] > between[0])
    (void)snprintf(text, length, " between %.*g and %.*g of the way", digits, (double)between[0], digits,
                   (double)between[1]);
}

PetscErrorCode LamRefuseCollapse(PetscInt cell, const PetscReal between[2], LamStatus status, LamResponse *response)
{
  char place[80];

  PetscFunctionBeginUser;
  LamBracketText(between, place, sizeof(place));
  PetscCall(LamRefuse(response, status,
                      "the lumen of cell %d collapses%s: its walls touch, and contact inside a lumen is not modelled",
                      (int)cell, place));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFindCollapsedLumen(LamRVE rve, const PetscReal y[], PetscInt *cell)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt apart = mesh->cuts ? 3 : 2;
  PetscInt most = 0;
  PetscReal(*x)[2];

  PetscFunctionBeginUser;
  *cell = -1;
  for (PetscInt c = 0; c < mesh->cell_count; ++c) most = PetscMax(most, LamMeshRingNodes(mesh, c));
  PetscCall(PetscMalloc1(most, &x));
  for (PetscInt c = 0; c < mesh->cell_count && *cell < 0; ++c) {
    const PetscInt n = LamMeshRingNodes(mesh, c), first = LamMeshFirstRing(mesh, c);

    for (PetscInt i = 0; i < n; ++i) {
      const PetscReal *position = &y[2 * mesh->node_class[LamMeshNode(mesh, first + i, 0)]];

      x[i][0] = position[0];
      x[i][1] = position[1];
    }
    if (SignedArea(n, (const PetscReal(*)[2])x) <= 0.0 || CrossesItself(n, (const PetscReal(*)[2])x, apart)) *cell = c;
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}
