#include "outline.h"

/* Part of its usual length or radius to which an inner contour may shrink: elements then have a quarter of their outer
   width. */
#define LEAST 0.25
#define BOTH_ENDS 0.45 /* of an inner line: something of it is left between arcs at both its ends */
#define STRAIGHT 1e-2  /* radian: corners that turn less have no arc, and their mitre is the mean of both normals */
#define SHARPEST 0.175 /* radian: 10 degrees between two faces; elements along narrower mitres degenerate */
#define PASSES 20      /* of thickening: each face that shrinks another one is met in the next pass */

static PetscInt Next(const LamOutline *o, PetscInt k)
{
  return k + 1 < o->count ? k + 1 : 0;
}

static PetscInt Previous(const LamOutline *o, PetscInt k)
{
  return k > 0 ? k - 1 : o->count - 1;
}

static void Normal(const LamOutline *o, PetscInt k, PetscReal normal[2])
{
  normal[0] = o->along[k][1];
  normal[1] = -o->along[k][0];
}

/* Inward from a corner to the meeting point of the lines at the distances a and b inside the face before it and it. */
static void Mitre(const LamOutline *o, PetscInt k, PetscReal a, PetscReal b, PetscReal inward[2])
{
  const PetscReal sine = PetscSinReal(o->turn[k]), cosine = PetscCosReal(o->turn[k]);
  PetscReal n[2], m[2];

  Normal(o, Previous(o, k), m);
  Normal(o, k, n);
  for (PetscInt d = 0; d < 2; d++) {
    const PetscReal one = a - b * cosine, other = b - a * cosine; /* of m and n: inward.m = -a, inward.n = -b */

    inward[d] = PetscAbsReal(sine) < STRAIGHT ? -0.5 * (a + b) * (m[d] + n[d]) / (1.0 + cosine)
                                              : -(one * m[d] + other * n[d]) / (sine * sine);
  }
}

/* Length of the line at the distance of the walls inside face k. */
static PetscReal InnerLength(const LamOutline *o, PetscInt k, const PetscReal thickness[])
{
  const PetscInt next = Next(o, k);
  PetscReal start[2], end[2], length = o->length[k];

  Mitre(o, k, thickness[Previous(o, k)], thickness[k], start);
  Mitre(o, next, thickness[k], thickness[next], end);
  for (PetscInt d = 0; d < 2; d++) length += (end[d] - start[d]) * o->along[k][d];
  return length;
}

static PetscErrorCode SetFaces(LamTissue tissue, PetscInt cell, PetscReal thickness, LamOutline *o)
{
  const PetscInt first = tissue->first[cell];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < o->count; k++) {
    const PetscReal *a = tissue->corner[first + k], *b = tissue->corner[first + Next(o, k)];
    const PetscReal length = PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));

    for (PetscInt d = 0; d < 2; d++) o->along[k][d] = (b[d] - a[d]) / length;
    o->length[k] = length;
    o->angle[k] = PetscAtan2Real(-o->along[k][0], o->along[k][1]);
    o->thickness[k] = thickness * tissue->share[first + k];
  }
  for (PetscInt k = 0; k < o->count; k++) {
    const PetscReal *a = o->along[Previous(o, k)], *b = o->along[k];

    o->turn[k] = PetscAtan2Real(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    PetscCheck(PetscAbsReal(o->turn[k]) < PETSC_PI - SHARPEST, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "cell %d: its corner at vertex %d of %d has an angle of %.3g degrees; walls need at least %.3g",
               (int)cell, (int)k, (int)o->count, (double)((PETSC_PI - o->turn[k]) * 180.0 / PETSC_PI),
               (double)(SHARPEST * 180.0 / PETSC_PI));
  }
  PetscFunctionReturn(0);
}

/* Moves the outer lines inwards by half of the clearance; returns the radius of a round cell with its area and
   perimeter, 2 A/P. */
static PetscReal Shrink(LamTissue tissue, PetscInt cell, PetscReal clearance, LamOutline *o)
{
  const PetscInt first = tissue->first[cell];
  PetscReal area = 0.0, perimeter = 0.0;

  for (PetscInt k = 0; k < o->count; k++) {
    PetscReal inward[2];

    Mitre(o, k, 0.5 * clearance, 0.5 * clearance, inward);
    for (PetscInt d = 0; d < 2; d++) o->outer[k].X[d] = tissue->corner[first + k][d] + inward[d];
  }
  for (PetscInt k = 0; k < o->count; k++) {
    const PetscReal *a = o->outer[k].X, *b = o->outer[Next(o, k)].X;

    o->length[k] = (b[0] - a[0]) * o->along[k][0] + (b[1] - a[1]) * o->along[k][1];
    perimeter += o->length[k];
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return 2.0 * area / perimeter;
}

/* Thickens the walls of faces that are too short for them. */
static PetscErrorCode Thicken(PetscInt cell, PetscReal radius, LamOutline *o)
{
  PetscBool changed = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt pass = 0; changed; pass++) {
    changed = PETSC_FALSE;
    for (PetscInt k = 0; k < o->count; k++) {
      const PetscReal t = o->thickness[k], length = InnerLength(o, k, o->thickness);
      const PetscReal least = LEAST * o->length[k] * (1.0 - t / radius);
      PetscReal slope;

      PetscCheck(t < radius && pass < PASSES, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
                 "cell %d: its walls of %.3g apothems leave no lumen: face %d, %.3g long, ends within them", (int)cell,
                 (double)t, (int)k, (double)o->length[k]);
      if (length >= least * (1.0 - 1e-6)) continue;
      slope = 1.0 / PetscTanReal(o->turn[k]) + 1.0 / PetscTanReal(o->turn[Next(o, k)]);
      PetscCheck(slope > 0.0 && PetscAbsReal(o->turn[k]) > STRAIGHT && PetscAbsReal(o->turn[Next(o, k)]) > STRAIGHT,
                 PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
                 "cell %d: face %d is %.3g apothems long between walls of %.3g, and the cell widens from it: no lumen "
                 "is left there",
                 (int)cell, (int)k, (double)o->length[k], (double)t);
      o->thickness[k] += (least - length) / slope;
      changed = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(0);
}

/* Sets the arc of a contour at corner k. */
static void SetArc(const LamOutline *o, PetscInt k, PetscReal setback, LamOutlineCorner *corner)
{
  PetscReal n[2];

  Normal(o, k, n);
  corner->setback = setback;
  corner->radius = setback / PetscTanReal(0.5 * o->turn[k]);
  for (PetscInt d = 0; d < 2; d++) corner->centre[d] = corner->X[d] + setback * o->along[k][d] - corner->radius * n[d];
}

/* Where the inner contour leaves its lines: below the end of the outer arc, or closer to the corner. */
static PetscReal InnerSetback(const LamOutline *o, PetscInt k)
{
  const PetscReal d = o->outer[k].setback;
  const PetscReal *before = o->along[Previous(o, k)], *X = o->outer[k].X, *Y = o->inner[k].X;
  PetscReal natural[2] = {d, d};

  for (PetscInt i = 0; i < 2; i++) {
    natural[0] += (Y[i] - X[i]) * before[i];
    natural[1] -= (Y[i] - X[i]) * o->along[k][i];
  }
  return PetscMax(PetscMin(natural[0], natural[1]), LEAST * d);
}

static void RoundCorners(LamTissue tissue, PetscInt cell, LamOutline *o)
{
  for (PetscInt k = 0; k < o->count; k++) {
    const PetscReal d = tissue->setback[tissue->first[cell] + k];
    PetscReal inward[2], inner;

    Mitre(o, k, o->thickness[Previous(o, k)], o->thickness[k], inward);
    for (PetscInt i = 0; i < 2; i++) o->inner[k].X[i] = o->outer[k].X[i] + inward[i];
    o->setback[k] = d;
    if (d == 0.0 || o->turn[k] < STRAIGHT) continue;
    SetArc(o, k, d, &o->outer[k]);
    inner = InnerSetback(o, k);
    inner = PetscMin(
        inner, BOTH_ENDS * PetscMin(InnerLength(o, k, o->thickness), InnerLength(o, Previous(o, k), o->thickness)));
    SetArc(o, k, inner, &o->inner[k]);
  }
}

PetscErrorCode LamOutlineCreate(LamTissue tissue, PetscInt cell, PetscReal thickness, PetscReal clearance,
                                LamOutline *o)
{
  const PetscInt n = tissue->first[cell + 1] - tissue->first[cell];
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *o = (LamOutline){.count = n};
  PetscCall(PetscCalloc4(n, &o->along, n, &o->angle, n, &o->turn, n, &o->setback));
  PetscCall(PetscCalloc4(n, &o->length, n, &o->thickness, n, &o->outer, n, &o->inner));
  ierr = SetFaces(tissue, cell, thickness, o);
  if (!ierr) ierr = Thicken(cell, Shrink(tissue, cell, clearance, o), o);
  if (ierr) PetscCall(LamOutlineDestroy(o));
  PetscCall(ierr);
  RoundCorners(tissue, cell, o);
  PetscFunctionReturn(0);
}

PetscErrorCode LamOutlineDestroy(LamOutline *o)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(o->along, o->angle, o->turn, o->setback));
  PetscCall(PetscFree4(o->length, o->thickness, o->outer, o->inner));
  PetscFunctionReturn(0);
}

void LamOutlineFlat(const LamOutline *o, PetscInt k, PetscReal flat[2])
{
  flat[0] = o->setback[k] / o->length[k];
  flat[1] = 1.0 - o->setback[Next(o, k)] / o->length[k];
}

/* Point of a contour beside a corner of face k: at the fraction u of the way from the corner to where it leaves the
   face. end: the corner at the end of the face. */
static void BesideCorner(const LamOutline *o, PetscInt k, PetscBool end, PetscReal u, const LamOutlineCorner *corner,
                         PetscReal X[2])
{
  const PetscReal half = 0.5 * o->turn[end ? Next(o, k) : k] * (1.0 - u);
  const PetscReal angle = o->angle[k] + (end ? half : -half);

  X[0] = corner->centre[0] + corner->radius * PetscCosReal(angle);
  X[1] = corner->centre[1] + corner->radius * PetscSinReal(angle);
}

/* Point of one contour of face k, whose corners are at both its ends. */
static void ContourPoint(const LamOutline *o, PetscInt k, PetscReal s, const LamOutlineCorner *start,
                         const LamOutlineCorner *stop, PetscReal X[2])
{
  PetscReal flat[2], first, last;

  LamOutlineFlat(o, k, flat);
  first = start->setback > 0.0 ? flat[0] : 0.0;
  last = stop->setback > 0.0 ? flat[1] : 1.0;
  if (s < first) {
    BesideCorner(o, k, PETSC_FALSE, s / first, start, X);
  } else if (s > last) {
    BesideCorner(o, k, PETSC_TRUE, (1.0 - s) / (1.0 - last), stop, X);
  } else {
    const PetscReal u = (s - first) / (last - first);

    for (PetscInt d = 0; d < 2; d++)
      X[d] = (1.0 - u) * (start->X[d] + start->setback * o->along[k][d]) +
             u * (stop->X[d] - stop->setback * o->along[k][d]);
  }
}

void LamOutlinePoint(const LamOutline *o, PetscInt k, PetscReal s, PetscReal r, PetscReal X[2])
{
  PetscReal outer[2], inner[2];

  ContourPoint(o, k, s, &o->outer[k], &o->outer[Next(o, k)], outer);
  ContourPoint(o, k, s, &o->inner[k], &o->inner[Next(o, k)], inner);
  for (PetscInt d = 0; d < 2; d++) X[d] = (1.0 - r) * inner[d] + r * outer[d];
}
