/*
  Overlapping cells. Contact is enforced only between facing faces. A wall that slides past a junction may penetrate a
  cell that it does not face, and a solution may have a wall on the far side of its neighbour. Such states are
  rejected.

  Method. The outer loop of each cell is the polygon of its nodes. The depth of a node inside the polygon of another
  cell or image, up to two cells away, is its distance to that polygon. Bounding boxes are compared first.
*/
#include "rve_impl.h"
#include <lamella/lattice.h>

#define REACH 4.1 /* apothems between reference centres: two rings of neighbours */

typedef struct {
  PetscReal low[2], high[2];
} Box;

static Box BoxOf(PetscInt n, const PetscReal x[][2])
{
  Box box = {{PETSC_MAX_REAL, PETSC_MAX_REAL}, {-PETSC_MAX_REAL, -PETSC_MAX_REAL}};

  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < 2; ++d) {
      box.low[d] = PetscMin(box.low[d], x[i][d]);
      box.high[d] = PetscMax(box.high[d], x[i][d]);
    }
  return box;
}

/* Crossing rule. */
static PetscBool IsInside(const PetscReal p[2], PetscInt n, const PetscReal x[][2])
{
  PetscBool inside = PETSC_FALSE;

  for (PetscInt i = 0, j = n - 1; i < n; j = i++)
    if ((x[i][1] > p[1]) != (x[j][1] > p[1]) &&
        p[0] < (x[j][0] - x[i][0]) * (p[1] - x[i][1]) / (x[j][1] - x[i][1]) + x[i][0])
      inside = (PetscBool)!inside;
  return inside;
}

static PetscReal DistanceTo(const PetscReal p[2], PetscInt n, const PetscReal x[][2])
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt i = 0, j = n - 1; i < n; j = i++) {
    const PetscReal d[2] = {x[i][0] - x[j][0], x[i][1] - x[j][1]}, z[2] = {p[0] - x[j][0], p[1] - x[j][1]};
    const PetscReal t = PetscMax(0.0, PetscMin(1.0, (z[0] * d[0] + z[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])));

    least = PetscMin(least, PetscSqr(z[0] - t * d[0]) + PetscSqr(z[1] - t * d[1]));
  }
  return PetscSqrtReal(least);
}

/* Largest depth of the nodes x of one cell, moved by `shift`, inside the polygon of another; node: index of that node.
 */
static PetscReal Depth(PetscInt n, const PetscReal x[][2], const PetscReal shift[2], const PetscReal other[][2],
                       const Box *box, PetscInt *node)
{
  PetscReal depth = 0.0;

  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal p[2] = {x[i][0] + shift[0], x[i][1] + shift[1]};

    if (p[0] < box->low[0] || p[0] > box->high[0] || p[1] < box->low[1] || p[1] > box->high[1]) continue;
    if (IsInside(p, n, other)) {
      const PetscReal distance = DistanceTo(p, n, other);

      if (distance > depth) *node = i;
      depth = PetscMax(depth, distance);
    }
  }
  return depth;
}

/* Whether centre a of an image at S is within reach of centre b. */
static PetscBool AreNear(const PetscReal a[2], const PetscReal S[2], const PetscReal b[2])
{
  return (PetscBool)(PetscSqr(a[0] + S[0] - b[0]) + PetscSqr(a[1] + S[1] - b[1]) <= REACH * REACH);
}

/* Whether the wall of cell a at an outer node faces cell b, where the image of a shifted by periods i, j overlaps b. */
static PetscBool Faces(LamRVE rve, PetscInt a, PetscInt node, PetscInt b, PetscInt i, PetscInt j)
{
  const PetscInt per_face = rve->mesh.ring_nodes / LAM_FACES, face = node / per_face;

  for (PetscInt k = 0; k < (node % per_face ? 1 : 2); ++k) { /* a corner also belongs to the previous face */
    PetscInt wraps[2];

    if (LamLatticeNeighbour(&rve->micro, a, (face + LAM_FACES - k) % LAM_FACES, wraps, NULL) != b) continue;
    if (rve->micro.is_patch || (wraps[0] == -i && wraps[1] == -j)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode LamFindOverlap(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscReal *depth, PetscInt pair[2],
                              PetscBool *facing)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt n = mesh->ring_nodes, cells = mesh->cell_count, reach = rve->micro.is_patch ? 0 : 2;
  PetscReal(*x)[2], (*centre)[2];

  PetscFunctionBeginUser;
  *depth = 0.0;
  *facing = PETSC_FALSE;
  pair[0] = pair[1] = -1;
  PetscCall(PetscMalloc2(cells * n, &x, cells, &centre));
  for (PetscInt a = 0; a < cells; ++a) LamMeshCentre(mesh, a, centre[a]);
  for (PetscInt i = 0; i < cells * n; ++i) LamNodePosition(rve, F, y, LamMeshOuterNode(mesh, i / n, i % n), x[i]);
  for (PetscInt b = 0; b < cells; ++b) {
    const Box box = BoxOf(n, (const PetscReal(*)[2]) & x[b * n]);

    for (PetscInt a = 0; a < cells; ++a)
      for (PetscInt i = -reach; i <= reach; ++i)
        for (PetscInt j = -reach; j <= reach; ++j) {
          PetscReal S[2], shift[2], found;
          PetscInt node = 0;

          for (PetscInt d = 0; d < 2; ++d) S[d] = (PetscReal)i * mesh->period[0][d] + (PetscReal)j * mesh->period[1][d];
          if ((a == b && i == 0 && j == 0) || !AreNear(centre[a], S, centre[b])) continue;
          shift[0] = F[0] * S[0] + F[1] * S[1];
          shift[1] = F[3] * S[0] + F[4] * S[1];
          found = Depth(n, (const PetscReal(*)[2]) & x[a * n], shift, (const PetscReal(*)[2]) & x[b * n], &box, &node);
          if (found > *depth) {
            *depth = found;
            pair[0] = a;
            pair[1] = b;
            *facing = Faces(rve, a, node, b, i, j);
          }
        }
  }
  PetscCall(PetscFree2(x, centre));
  PetscFunctionReturn(0);
}
