#include "support/polygons.h"
#include <polygons.h>
#include <math.h>

#define WAVE 0.2 /* apothems: edges of 1.15 stay longer than half of that */

void NotDisplaced(PetscInt n, PetscReal X[2])
{
  (void)n;
  (void)X;
}

void Stretched(PetscInt n, PetscReal X[2])
{
  (void)n;
  X[0] *= 1.5;
}

void Sheared(PetscInt n, PetscReal X[2])
{
  (void)n;
  X[0] += 0.3 * X[1];
  X[1] *= 1.2;
}

/* k . X of the wave with these numbers of periods along the two vectors of the period. */
static PetscReal Phase(PetscInt n, const PetscReal X[2], PetscReal first, PetscReal second)
{
  const PetscReal along = X[1] / sqrt(3.0), across = X[0] - along; /* X = across (1, 0) + along (1, sqrt 3) */

  return PETSC_PI / (PetscReal)n * (first * across + 2.0 * second * along);
}

void Waves(PetscInt n, PetscReal X[2])
{
  const PetscReal a = Phase(n, X, 1, 0), b = Phase(n, X, 0, 1), c = Phase(n, X, 1, -2);

  X[0] += 0.5 * WAVE * (sin(a + 1) + cos(b));
  X[1] += 0.5 * WAVE * (sin(b + 2) + cos(c + 0.5));
}

/* Even in X2. Waves of one and of two periods have no centre in common, so no half turn or other mirror is left. */
void MirroredWaves(PetscInt n, PetscReal X[2])
{
  const PetscReal a = Phase(n, X, 0, 1), b = Phase(n, X, 1, 0), mirrored = Phase(n, X, 1, 1);

  X[0] += 0.3 * WAVE * (cos(a) + cos(2 * a) + sin(b) + sin(mirrored));
}

void OddWaves(PetscInt n, PetscReal X[2])
{
  const PetscReal a = Phase(n, X, 1, 0), b = Phase(n, X, 0, 1), c = Phase(n, X, 1, -2);

  X[0] += 0.5 * WAVE * (sin(a) + sin(b));
  X[1] += 0.5 * WAVE * (sin(b) - sin(c));
}

PetscErrorCode PolygonsCreate(PetscInt n, Displacement displace, LamTissue *tissue)
{
  const PetscInt cells = n * n, corners = LAM_DIRECTIONS * cells;
  LamPolygons p = {.name = "polygons", .vertices = corners, .cells = cells};
  PetscReal *setback, apothem, end[2][2] = {{2.0 * (PetscReal)n, 0}, {(PetscReal)n, sqrt(3.0) * (PetscReal)n}};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(corners, &p.vertex, cells + 1, &p.first, corners, &p.corner, corners, &setback));
  p.first[cells] = corners;
  p.setback = setback;
  for (PetscInt v = 0; v < corners; v++) {
    const PetscInt cell = v / LAM_DIRECTIONS;
    const PetscReal i = (PetscReal)(cell / n), j = (PetscReal)(cell % n);
    const PetscReal angle = PETSC_PI / 3.0 * ((PetscReal)(v % LAM_DIRECTIONS) - 0.5);

    p.first[cell] = LAM_DIRECTIONS * cell;
    p.corner[v] = v;
    setback[v] = 0.05;
    p.vertex[v][0] = 2.0 * i + j + 2.0 / sqrt(3.0) * cos(angle);
    p.vertex[v][1] = sqrt(3.0) * j + 2.0 / sqrt(3.0) * sin(angle);
    displace(n, p.vertex[v]);
  }
  for (int k = 0; k < 2; k++) { /* how far a period goes */
    PetscReal start[2] = {0.0, 0.0};

    displace(n, start);
    displace(n, end[k]);
    for (int d = 0; d < 2; d++) p.period[k][d] = end[k][d] - start[d];
  }
  PetscCall(LamTissueFromPolygons(&p, &apothem, tissue));
  PetscCall(PetscFree4(p.vertex, p.first, p.corner, setback));
  PetscFunctionReturn(0);
}
