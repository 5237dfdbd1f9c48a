/*
  What the exact law and the indicators take from a state of the smooth law: contact pressures, the hats in contact,
  and how deep walls lie in each other.
*/
#include "rve_impl.h"

#define IN_CONTACT 0.25 /* of the strength: pressure at half the width, from which on a hat counts as in contact */

/* Normal pressure over the strength of one point of a wall. */
typedef struct {
  LamRVE rve;
  PetscReal *length; /* [hat] reference length */
  LamTouchForces *forces;
  const LamLoad *load;
  PetscReal *strength; /* [face] F33 s */
} Pressures;

/* Half-edge of a slave face that a point of its wall belongs to, and the place in it; -1: the wall is no slave. */
static PetscInt PlaceOf(const Pressures *p, PetscInt loop, PetscInt span, PetscInt point, PetscReal *place)
{
  const PetscInt last = 2 * p->rve->mesh.along;
  const LamContact *contact = p->rve->contact;
  PetscInt half, face = LamWallsFace(&p->rve->smooth->walls, loop, span, &half), f;

  *place = ((PetscReal)point + 0.5) / LAM_TOUCH_POINTS;
  if (half == last) { /* at a corner */
    half = *place < 0.5 ? last - 1 : 0;
    if (half == 0) face = LamTissueNext(p->rve->mesh.tissue, face);
    *place = half == 0 ? 0.0 : 1.0;
  }
  f = loop % 2 ? -1 : contact->at[face];
  return f < 0 || contact->faces[f].face != face ? -1 : f * contact->hats + half;
}

static void AddPressure(void *ctx, const LamTouching *touch)
{
  Pressures *p = (Pressures *)ctx;
  LamContact *contact = p->rve->contact;
  const LamTouchStrength strength = LamTouchStrengthOf(p->rve, p->load, touch->loop / 2, touch->other / 2);
  const PetscBool facing = LamTouchIsFacing(&p->rve->smooth->walls, touch);
  PetscReal place, pressure;
  PetscInt hat;
  LamTouchLaw law;

  LamTouchLawOf(p->rve, touch->gap.gap, &law);
  pressure = -law.d * strength.s * p->load->F[8];
  *(LamTouchIsLumen(touch) ? &p->forces->lumen
    : facing               ? &p->forces->facing
                           : &p->forces->third) += 0.5 * touch->weight * pressure;
  hat = PlaceOf(p, touch->loop, touch->span, touch->point, &place);
  if (hat < 0 || !facing) return;
  p->strength[hat / contact->hats] = strength.s * p->load->F[8];
  contact->lambda[hat] += (1.0 - place) * touch->weight * pressure;
  contact->lambda[hat + 1] += place * touch->weight * pressure;
}

static void AddLengths(Pressures *p)
{
  const LamWalls *walls = &p->rve->smooth->walls;

  for (PetscInt loop = 0; loop < walls->loops; loop += 2)
    for (PetscInt k = 0; k < LAM_TOUCH_POINTS * LamWallsSpans(walls, loop); ++k) {
      PetscReal place;
      const PetscInt hat = PlaceOf(p, loop, k / LAM_TOUCH_POINTS, k % LAM_TOUCH_POINTS, &place);

      if (hat < 0) continue;
      p->length[hat] += (1.0 - place) * walls->weight[LAM_TOUCH_POINTS * walls->first[loop] + k];
      p->length[hat + 1] += place * walls->weight[LAM_TOUCH_POINTS * walls->first[loop] + k];
    }
}

PetscErrorCode LamSmoothPressures(LamRVE rve, const LamLoad *load, LamTouchForces *forces)
{
  LamContact *contact = rve->contact;
  Pressures p = {.rve = rve, .forces = forces, .load = load};

  PetscFunctionBeginUser;
  *forces = (LamTouchForces){0};
  PetscCall(PetscCalloc2(contact->count, &p.length, contact->face_count, &p.strength));
  for (PetscInt f = 0; f < contact->face_count; ++f) {
    contact->faces[f].first = contact->faces[f].low;
    contact->faces[f].last = contact->faces[f].high;
  }
  AddLengths(&p);
  PetscCall(PetscArrayzero(contact->lambda, contact->count));
  LamWallsPlace(&rve->smooth->walls, load->F, rve->y);
  LamWallsVisit(&rve->smooth->walls, rve->smooth->width, AddPressure, &p);
  for (PetscInt h = 0; h < contact->count; ++h) contact->lambda[h] /= p.length[h];
  (void)LamContactMerge(rve, load, rve->y);
  PetscCall(LamContactEvaluate(rve, load, rve->y));
  for (PetscInt h = 0; h < contact->count; ++h) {
    contact->active[h] =
        (PetscBool)(LamContactCarries(contact, h) && contact->lambda[h] > IN_CONTACT * p.strength[h / contact->hats]);
  }
  PetscCall(PetscFree2(p.length, p.strength));
  PetscFunctionReturn(0);
}

typedef struct {
  const LamWalls *walls;
  LamDepths depths;
} Depth;

static void Deepen(void *ctx, const LamTouching *touch)
{
  Depth *d = (Depth *)ctx;
  const PetscReal depth = -touch->gap.gap;

  if (LamTouchIsFacing(d->walls, touch)) {
    d->depths.facing = PetscMax(d->depths.facing, depth);
  } else if (depth > d->depths.other) {
    d->depths.other = depth;
    d->depths.cell[0] = touch->loop / 2;
    d->depths.cell[1] = touch->other / 2;
  }
}

LamDepths LamFindDepths(LamRVE rve, const LamLoad *load)
{
  Depth depth = {.walls = &rve->smooth->walls, .depths = {.cell = {-1, -1}}};

  LamWallsPlace(&rve->smooth->walls, load->F, rve->y);
  LamWallsVisit(&rve->smooth->walls, 0.0, Deepen, &depth);
  return depth.depths;
}
