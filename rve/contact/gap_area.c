/*
  The area between cells as a function of positions, for cohesion: the suction g acts on every wall with a facing
  wall, so its potential is g times the area enclosed between the walls.

  Method. The area is a sum over closed loops: one per face, along its two walls and straight from corner to corner at
  its ends; and one per junction, the polygon of the corners of its cells. Loops may differ in cohesion: a face has the
  smaller one of its two cells, a junction the mean of its faces. Together the loops of a periodic block
  enclose det F V0 minus the cells. At the boundary of a patch there is no junction; the straight end of the face
  closes the gap. Area is bilinear in positions: a sum of c x_a x x_b over pairs of nodes, x x y = x_1 y_2 - x_2 y_1
  and x_a = y_a + F S_a; all derivatives follow from the list of pairs.
*/
#include "gap_area.h"
#include "edge_area.h"

/* A node of a face of a cell or of its image. */
typedef struct {
  PetscInt node;
  const PetscReal *image; /* shift of its cell's image, NULL: none */
} Corner;

static void AddPair(const LamMesh *mesh, Corner a, Corner b, PetscReal c, PetscReal cohesion, LamGapArea *area)
{
  LamGapPair *pair = &area->pairs[area->count++];

  pair->c = c;
  pair->cohesion = cohesion;
  pair->a = mesh->node_class[a.node];
  pair->b = mesh->node_class[b.node];
  for (PetscInt d = 0; d < 2; ++d) {
    pair->Sa[d] = mesh->shift[2 * a.node + d] + (a.image ? a.image[d] : 0.0);
    pair->Sb[d] = mesh->shift[2 * b.node + d] + (b.image ? b.image[d] : 0.0);
  }
}

/* Adds a wall from its start, counter-clockwise around its cell; returns its end. */
static Corner AddWall(const LamMesh *mesh, PetscInt face, const PetscReal *image, PetscReal cohesion, LamGapArea *area)
{
  Corner node[3] = {{0, image}, {0, image}, {0, image}};

  for (PetscInt e = 0; e < mesh->along; ++e) {
    for (PetscInt i = 0; i < 3; ++i) node[i].node = LamMeshOuterNode(mesh, face, 2 * e + i);
    for (PetscInt i = 0; i < 3; ++i)
      for (PetscInt j = i + 1; j < 3; ++j) AddPair(mesh, node[i], node[j], -0.5 * lam_edge_area[i][j], cohesion, area);
  }
  return node[2];
}

static Corner StartOf(const LamMesh *mesh, PetscInt face, const PetscReal *image)
{
  return (Corner){LamMeshOuterNode(mesh, face, 0), image};
}

/* Both walls of a face, clockwise around the gap: hence the minus signs. */
static void AddFace(const LamMicrostructure *micro, const LamMesh *mesh, PetscInt face, LamGapArea *area)
{
  const PetscReal *image = &mesh->image[2 * face];
  const PetscInt partner = mesh->tissue->partner[face];
  const PetscReal cohesion = LamFaceCohesion(micro, mesh->tissue->cell[face], mesh->tissue->cell[partner]);
  Corner end, other_end;

  end = AddWall(mesh, face, NULL, cohesion, area);
  AddPair(mesh, end, StartOf(mesh, partner, image), -0.5, cohesion, area);
  other_end = AddWall(mesh, partner, image, cohesion, area);
  AddPair(mesh, other_end, StartOf(mesh, face, NULL), -0.5, cohesion, area);
}

/* Adds the junction at the start of a face, if the face is the first of those that start there, and no air is. */
static void AddJunction(const LamMicrostructure *micro, const LamMesh *mesh, PetscInt face, LamGapArea *area)
{
  const LamJunction j = LamMeshJunction(mesh, face);
  PetscReal cohesion = 0.0;

  for (PetscInt i = 0; i < j.count; ++i) {
    if (!j.closed || j.face[i] < face) return;
    cohesion += LamFaceCohesion(micro, mesh->tissue->cell[j.face[i]], mesh->tissue->cell[j.face[(i + 1) % j.count]]);
  }
  for (PetscInt i = 0; i < j.count; ++i) {
    const PetscInt next = (i + 1) % j.count;

    AddPair(mesh, StartOf(mesh, j.face[i], j.image[i]), StartOf(mesh, j.face[next], j.image[next]), 0.5,
            cohesion / (PetscReal)j.count, area);
  }
}

PetscErrorCode LamGapAreaCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamGapArea *area)
{
  const PetscInt faces = mesh->tissue->faces, most = faces / 2 * (6 * mesh->along + 2) + faces;

  PetscFunctionBeginUser;
  area->count = 0;
  PetscCall(PetscMalloc1(most, &area->pairs));
  for (PetscInt face = 0; face < faces; ++face) {
    if (LamTissueIsSlave(mesh->tissue, face)) AddFace(micro, mesh, face, area);
    AddJunction(micro, mesh, face, area);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamGapAreaDestroy(LamGapArea *area)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(area->pairs));
  PetscFunctionReturn(0);
}

void LamGapAreaSetMatrix(const LamLinear *linear, LamGapArea *area)
{
  for (PetscInt k = 0; k < area->count; ++k) {
    LamGapPair *pair = &area->pairs[k];

    for (PetscInt i = 0; i < 2; ++i)
      pair->entry[i] = LamLinearEntry(linear, LamUnknown(pair->a, i), LamUnknown(pair->b, 1 - i));
  }
}

PetscReal LamGapAreaEvaluate(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal *plain)
{
  PetscReal sum = 0.0, all = 0.0;

  for (PetscInt k = 0; k < area->count; ++k) {
    const LamGapPair *pair = &area->pairs[k];
    PetscReal a[2], b[2], value;

    LamImagePosition(F, y, pair->a, pair->Sa, a);
    LamImagePosition(F, y, pair->b, pair->Sb, b);
    value = pair->c * (a[0] * b[1] - a[1] * b[0]);
    sum += pair->cohesion * value;
    all += value;
  }
  if (plain) *plain = all;
  return sum;
}

void LamGapAreaAddGradient(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal factor,
                           PetscReal gradient[])
{
  for (PetscInt k = 0; k < area->count; ++k) {
    const LamGapPair *pair = &area->pairs[k];
    const PetscReal c = factor * pair->cohesion * pair->c;
    PetscReal a[2], b[2];

    LamImagePosition(F, y, pair->a, pair->Sa, a);
    LamImagePosition(F, y, pair->b, pair->Sb, b);
    gradient[2 * pair->a] += c * b[1];
    gradient[2 * pair->a + 1] -= c * b[0];
    gradient[2 * pair->b] -= c * a[1];
    gradient[2 * pair->b + 1] += c * a[0];
  }
}

void LamGapAreaAddHessian(const LamGapArea *area, PetscReal factor, PetscReal values[])
{
  for (PetscInt k = 0; k < area->count; ++k) {
    const LamGapPair *pair = &area->pairs[k];
    const PetscReal c = factor * pair->cohesion * pair->c;

    if (pair->entry[0] < 0) continue;
    values[pair->entry[0]] += c; /* d2/da_1 db_2 */
    values[pair->entry[1]] -= c; /* d2/da_2 db_1 */
  }
}

void LamGapAreaAddShifts(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal factor,
                         PetscReal force[4], PetscReal force_force[4][4], PetscReal *force_y[4])
{
  static const PetscReal eps[2][2] = {{0.0, 1.0}, {-1.0, 0.0}};

  for (PetscInt n = 0; n < area->count; ++n) {
    const LamGapPair *pair = &area->pairs[n];
    const PetscReal c = factor * pair->cohesion * pair->c;
    PetscReal a[2], b[2];

    LamImagePosition(F, y, pair->a, pair->Sa, a);
    LamImagePosition(F, y, pair->b, pair->Sb, b);
    for (PetscInt q = 0; q < 4; ++q) {
      const PetscInt k = q / 2, l = q % 2;

      for (PetscInt j = 0; j < 2; ++j) {
        force[q] += c * (eps[k][j] * pair->Sa[l] * b[j] + eps[j][k] * a[j] * pair->Sb[l]);
        if (force_y) {
          force_y[q][2 * pair->b + j] += c * eps[k][j] * pair->Sa[l];
          force_y[q][2 * pair->a + j] += c * eps[j][k] * pair->Sb[l];
        }
      }
      for (PetscInt r = 0; force_force && r < 4; ++r)
        force_force[q][r] +=
            c * (eps[k][r / 2] * pair->Sa[l] * pair->Sb[r % 2] + eps[r / 2][k] * pair->Sa[r % 2] * pair->Sb[l]);
    }
  }
}
