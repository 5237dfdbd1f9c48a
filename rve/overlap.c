/*
  Cells that lie in each other. Contact is between facing faces; a wall that slides round a junction may reach a cell
  that it does not face, and a solution may have a wall on its neighbour's far side. Such states are no answers.

  Method. The outer loop of each cell is the polygon of its nodes. A node inside the polygon of another cell or image,
  up to two cells away, counts with its distance to that polygon. Boxes are compared first.
*/
#include "rve_impl.h"

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

/* Largest depth of nodes x of one cell, moved by `shift`, inside the polygon of another. */
static PetscReal Depth(PetscInt n, const PetscReal x[][2], const PetscReal shift[2], const PetscReal other[][2],
                       const Box *box)
{
  PetscReal depth = 0.0;

  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal p[2] = {x[i][0] + shift[0], x[i][1] + shift[1]};

    if (p[0] < box->low[0] || p[0] > box->high[0] || p[1] < box->low[1] || p[1] > box->high[1]) continue;
    if (IsInside(p, n, other)) depth = PetscMax(depth, DistanceTo(p, n, other));
  }
  return depth;
}

/* Reference centre of a cell, from opposite nodes of its outer loop. */
static void Centre(const LamMesh *mesh, PetscInt cell, PetscReal centre[2])
{
  const PetscInt a = LamMeshOuterNode(mesh, cell, 0), b = LamMeshOuterNode(mesh, cell, mesh->ring_nodes / 2);

  for (PetscInt d = 0; d < 2; ++d) centre[d] = 0.5 * (mesh->X[2 * a + d] + mesh->X[2 * b + d]);
}

/* Whether centre a of an image at S is within reach of centre b. */
static PetscBool AreNear(const PetscReal a[2], const PetscReal S[2], const PetscReal b[2])
{
  return (PetscBool)(PetscSqr(a[0] + S[0] - b[0]) + PetscSqr(a[1] + S[1] - b[1]) <= REACH * REACH);
}

PetscErrorCode LamFindOverlap(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscReal *depth, PetscInt pair[2])
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt n = mesh->ring_nodes, cells = mesh->cell_count, reach = rve->micro.is_patch ? 0 : 2;
  PetscReal(*x)[2], (*centre)[2];

  PetscFunctionBeginUser;
  *depth = 0.0;
  pair[0] = pair[1] = -1;
  PetscCall(PetscMalloc2(cells * n, &x, cells, &centre));
  for (PetscInt a = 0; a < cells; ++a) Centre(mesh, a, centre[a]);
  for (PetscInt i = 0; i < cells * n; ++i) LamNodePosition(rve, F, y, LamMeshOuterNode(mesh, i / n, i % n), x[i]);
  for (PetscInt b = 0; b < cells; ++b) {
    const Box box = BoxOf(n, (const PetscReal(*)[2]) & x[b * n]);

    for (PetscInt a = 0; a < cells; ++a)
      for (PetscInt i = -reach; i <= reach; ++i)
        for (PetscInt j = -reach; j <= reach; ++j) {
          PetscReal S[2], shift[2], found;

          for (PetscInt d = 0; d < 2; ++d) S[d] = (PetscReal)i * mesh->period[0][d] + (PetscReal)j * mesh->period[1][d];
          if ((a == b && i == 0 && j == 0) || !AreNear(centre[a], S, centre[b])) continue;
          shift[0] = F[0] * S[0] + F[1] * S[1];
          shift[1] = F[3] * S[0] + F[4] * S[1];
          found = Depth(n, (const PetscReal(*)[2]) & x[a * n], shift, (const PetscReal(*)[2]) & x[b * n], &box);
          if (found > *depth) {
            *depth = found;
            pair[0] = a;
            pair[1] = b;
          }
        }
  }
  PetscCall(PetscFree2(x, centre));
  PetscFunctionReturn(0);
}
