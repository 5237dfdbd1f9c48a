#include <lamella/lattice.h>
#include <lamella/tissue.h>

PetscErrorCode LamTissueAllocate(PetscInt cells, PetscInt faces, LamTissue *out)
{
  LamTissue t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  t->cells = cells;
  t->faces = faces;
  PetscCall(
      PetscCalloc5(cells + 1, &t->first, faces, &t->cell, faces, &t->corner, faces, &t->partner, faces, &t->wraps));
  PetscCall(PetscCalloc4(faces, &t->direction, faces, &t->held, faces, &t->share, faces, &t->setback));
  for (PetscInt k = 0; k < faces; k++) {
    t->partner[k] = -1;
    t->share[k] = 1.0;
  }
  *out = t;
  PetscFunctionReturn(0);
}

PetscErrorCode LamTissueDestroy(LamTissue *tissue)
{
  PetscFunctionBeginUser;
  if (!*tissue) PetscFunctionReturn(0);
  PetscCall(PetscFree5((*tissue)->first, (*tissue)->cell, (*tissue)->corner, (*tissue)->partner, (*tissue)->wraps));
  PetscCall(PetscFree4((*tissue)->direction, (*tissue)->held, (*tissue)->share, (*tissue)->setback));
  PetscCall(PetscFree(*tissue));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTissueCopy(LamTissue from, LamTissue *to)
{
  PetscFunctionBeginUser;
  *to = NULL;
  if (!from) PetscFunctionReturn(0);
  PetscCall(LamTissueAllocate(from->cells, from->faces, to));
  PetscCall(PetscArraycpy((*to)->first, from->first, from->cells + 1));
  PetscCall(PetscArraycpy((*to)->cell, from->cell, from->faces));
  PetscCall(PetscArraycpy((*to)->corner, from->corner, from->faces));
  PetscCall(PetscArraycpy((*to)->partner, from->partner, from->faces));
  PetscCall(PetscArraycpy((*to)->wraps, from->wraps, from->faces));
  PetscCall(PetscArraycpy((*to)->direction, from->direction, from->faces));
  PetscCall(PetscArraycpy((*to)->held, from->held, from->faces));
  PetscCall(PetscArraycpy((*to)->share, from->share, from->faces));
  PetscCall(PetscArraycpy((*to)->setback, from->setback, from->faces));
  PetscCall(PetscMemcpy((*to)->period, from->period, sizeof(from->period)));
  (*to)->area = from->area;
  PetscFunctionReturn(0);
}

PetscBool LamTissuesAgree(LamTissue a, LamTissue b, PetscReal tolerance)
{
  PetscReal off = 0.0;

  if (!a || !b) return (PetscBool)(a == b);
  if (a->cells != b->cells || a->faces != b->faces) return PETSC_FALSE;
  for (PetscInt k = 0; k < 4; k++) off = PetscMax(off, PetscAbsReal(a->period[k / 2][k % 2] - b->period[k / 2][k % 2]));
  for (PetscInt k = 0; k < a->faces; k++) {
    if (a->cell[k] != b->cell[k] || a->partner[k] != b->partner[k] || a->direction[k] != b->direction[k] ||
        a->held[k] != b->held[k])
      return PETSC_FALSE;
    for (int d = 0; d < 2; d++) off = PetscMax(off, PetscAbsReal(a->corner[k][d] - b->corner[k][d]));
    off = PetscMax(off, PetscAbsReal(a->share[k] - b->share[k]));
    off = PetscMax(off, PetscAbsReal(a->setback[k] - b->setback[k]));
  }
  return (PetscBool)(off <= tolerance);
}

/* ---- hexagons ---- */

/* L_k for k = 0, 1. */
static void LatticeVector(PetscReal orientation, PetscInt k, PetscReal L[2])
{
  const PetscReal angle = orientation + 60.0 * (PetscReal)k * PETSC_PI / 180.0;

  L[0] = 2.0 * PetscCosReal(angle);
  L[1] = 2.0 * PetscSinReal(angle);
}

/* The start of face k of the hexagon around the origin. */
static void HexagonCorner(PetscReal orientation, PetscInt k, PetscReal corner[2])
{
  const PetscReal angle = orientation + (60.0 * (PetscReal)k - 30.0) * PETSC_PI / 180.0;

  corner[0] = 2.0 / PetscSqrtReal(3.0) * PetscCosReal(angle);
  corner[1] = 2.0 / PetscSqrtReal(3.0) * PetscSinReal(angle);
}

static PetscErrorCode CreateHexagons(const LamMicrostructure *micro, LamTissue *out)
{
  const PetscInt cells = micro->cells[0] * micro->cells[1];
  PetscReal L[2][2];
  LamTissue t;

  PetscFunctionBeginUser;
  PetscCall(LamTissueAllocate(cells, LAM_FACES * cells, &t));
  for (PetscInt k = 0; k < 2; k++) LatticeVector(micro->orientation, k, L[k]);
  for (PetscInt k = 0; k < 2 && !micro->is_patch; k++)
    for (PetscInt d = 0; d < 2; d++) t->period[k][d] = L[k][d] * (PetscReal)micro->cells[k];
  t->area = 2.0 * PetscSqrtReal(3.0) * (PetscReal)cells;
  for (PetscInt cell = 0; cell <= cells; cell++) t->first[cell] = LAM_FACES * cell;
  for (PetscInt face = 0; face < t->faces; face++) {
    const PetscInt cell = face / LAM_FACES, k = face % LAM_FACES;
    const PetscInt other = LamLatticeNeighbour(micro, cell, k, t->wraps[face], &t->held[face]);
    PetscInt index[2];
    PetscReal corner[2];

    LamLatticeIndex(micro, cell, index);
    HexagonCorner(micro->orientation, k, corner);
    for (PetscInt d = 0; d < 2; d++)
      t->corner[face][d] = (PetscReal)index[0] * L[0][d] + (PetscReal)index[1] * L[1][d] + corner[d];
    t->cell[face] = cell;
    t->direction[face] = k;
    t->partner[face] = other < 0 ? -1 : LAM_FACES * other + (k + LAM_FACES / 2) % LAM_FACES;
  }
  *out = t;
  PetscFunctionReturn(0);
}

PetscErrorCode LamTissueCreate(const LamMicrostructure *micro, LamTissue *tissue)
{
  PetscFunctionBeginUser;
  if (micro->tissue)
    PetscCall(LamTissueCopy(micro->tissue, tissue));
  else
    PetscCall(CreateHexagons(micro, tissue));
  PetscFunctionReturn(0);
}

PetscInt LamCellFaces(const LamMicrostructure *micro, PetscInt cell)
{
  return micro->tissue ? micro->tissue->first[cell + 1] - micro->tissue->first[cell] : LAM_FACES;
}

PetscInt LamCellAcross(const LamMicrostructure *micro, PetscInt cell, PetscInt k)
{
  const LamTissue tissue = micro->tissue;
  PetscInt partner;

  if (!tissue) return LamLatticeNeighbour(micro, cell, k, NULL, NULL);
  partner = tissue->partner[tissue->first[cell] + k];
  return partner < 0 ? -1 : tissue->cell[partner];
}

PetscInt LamCellDirection(const LamMicrostructure *micro, PetscInt cell, PetscInt k)
{
  return micro->tissue ? micro->tissue->direction[micro->tissue->first[cell] + k] : k;
}

void LamTissueCentre(LamTissue tissue, PetscInt cell, PetscReal centre[2])
{
  const PetscInt first = tissue->first[cell], count = tissue->first[cell + 1] - first;

  centre[0] = centre[1] = 0.0;
  for (PetscInt k = first; k < first + count; k++)
    for (PetscInt d = 0; d < 2; d++) centre[d] += tissue->corner[k][d] / (PetscReal)count;
}

/* Area between a corner of a cell and the arc that rounds it, which touches both faces at the setback s: with the inner
   angle b it has the radius s tan(b/2). */
static PetscReal RoundedCorner(LamTissue tissue, PetscInt k)
{
  const PetscReal *x = tissue->corner[LamTissuePrevious(tissue, k)], *y = tissue->corner[k];
  const PetscReal *z = tissue->corner[LamTissueNext(tissue, k)];
  const PetscReal u[2] = {x[0] - y[0], x[1] - y[1]}, v[2] = {z[0] - y[0], z[1] - y[1]};
  const PetscReal angle = PetscAbsReal(PetscAtan2Real(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]));
  const PetscReal radius = tissue->setback[k] * PetscTanReal(0.5 * angle);

  return tissue->setback[k] * radius - 0.5 * (PETSC_PI - angle) * radius * radius;
}

PetscReal LamTissueCellArea(LamTissue tissue, PetscInt cell)
{
  PetscReal sum = 0.0;

  for (PetscInt k = tissue->first[cell]; k < tissue->first[cell + 1]; k++) {
    const PetscReal *x = tissue->corner[k], *y = tissue->corner[LamTissueNext(tissue, k)];

    sum += 0.5 * (x[0] * y[1] - x[1] * y[0]) - (tissue->setback[k] > 0.0 ? RoundedCorner(tissue, k) : 0.0);
  }
  return sum;
}

#define ALL 1e-9 /* of the area: tissue files have 12 digits */

PetscErrorCode LamFluidFills(const LamMicrostructure *micro, PetscBool *fills)
{
  PetscReal cells = 0.0;
  LamTissue tissue;

  PetscFunctionBeginUser;
  PetscCall(LamTissueCreate(micro, &tissue));
  for (PetscInt c = 0; c < tissue->cells; c++) cells += LamTissueCellArea(tissue, c);
  *fills = (PetscBool)(PetscAbsReal(cells - tissue->area) <= ALL * tissue->area);
  for (PetscInt c = 0; micro->cell && c < tissue->cells; c++) {
    if (PetscAbsReal(micro->cell[c].turgor - 1.0) > ALL) *fills = PETSC_FALSE;
    if (LamCellsPart(micro->interface) && PetscAbsReal(micro->cell[c].cohesion - 1.0) > ALL) *fills = PETSC_FALSE;
  }
  PetscCall(LamTissueDestroy(&tissue));
  PetscFunctionReturn(0);
}

PetscReal LamTissueInnerPerimeter(LamTissue tissue, PetscInt cell, PetscReal distance)
{
  PetscReal sum = 0.0;

  for (PetscInt k = tissue->first[cell]; k < tissue->first[cell + 1]; k++) {
    const PetscReal *x = tissue->corner[LamTissuePrevious(tissue, k)], *y = tissue->corner[k];
    const PetscReal *z = tissue->corner[LamTissueNext(tissue, k)];
    const PetscReal a[2] = {y[0] - x[0], y[1] - x[1]}, b[2] = {z[0] - y[0], z[1] - y[1]};
    const PetscReal turn = PetscAtan2Real(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    const PetscReal tangent = PetscTanReal(0.5 * turn), setback = tissue->setback[k] - distance * tangent;

    sum += PetscSqrtReal(b[0] * b[0] + b[1] * b[1]) - 2.0 * distance * tangent;
    if (turn > 0.0 && setback > 0.0) sum -= 2.0 * setback - setback / tangent * turn;
  }
  return sum;
}
