/*
  Events in a body that changes in time, at the material point with the largest event function.
*/
#include "body_impl.h"
#include <math.h>

static const PetscReal MOST_SLACK = 1e-4;

PetscReal LamBodyNoTurgor(LamBody body)
{
  return PetscMin(LamPlasmolysisTolerance(body->process), MOST_SLACK) * body->process->pressure;
}

PetscInt LamBodyListEvents(LamBody body, LamEvent events[LAM_EVENT_COUNT])
{
  const PetscInt n = LamProcessListEvents(body->process, events);
  PetscInt kept = 0;

  for (PetscInt k = 0; k < n; k++)
    if (events[k] != LAM_EVENT_LIMIT) events[kept++] = events[k]; /* the run of a body ends there */
  return kept;
}

/* Event function of a point: rises through 0 at the event. */
static PetscReal Excess(LamBody body, LamEvent event, PetscInt p, const LamMacroPoint *point)
{
  const LamStrength *strength = &body->process->scene->strength;
  const LamProcessFactor *factor = body->now.factor;
  const PetscReal lamella = factor[LAM_CHANGING_LAMELLA].value, wall = factor[LAM_CHANGING_WALL_STRENGTH].value;

  switch (event) {
  case LAM_EVENT_LAMELLA_NORMAL:
    return point->field[LAM_POINT_NORMAL] - lamella * strength->lamella_normal;
  case LAM_EVENT_LAMELLA_SHEAR:
    return point->field[LAM_POINT_SHEAR] - lamella * strength->lamella_shear;
  case LAM_EVENT_WALL:
    return point->field[LAM_POINT_WALL] - wall * strength->wall;
  case LAM_EVENT_OPENING:
    return point->field[LAM_POINT_OPENING] - body->opening[p] - body->process->spec->opening;
  case LAM_EVENT_PERCOLATION:
    return point->percolating < 0 ? -1 : 1.5 - (PetscReal)point->percolating; /* below 0: unknown */
  case LAM_EVENT_TURGOR_LOST:
    return LamBodyNoTurgor(body) - point->load->turgor;
  case LAM_EVENT_TURGOR_FOUND: /* largest at the point that regains turgor last */
    return 2 * LamBodyNoTurgor(body) - point->load->turgor;
  default:
    return -1;
  }
}

PetscErrorCode LamBodyExcess(LamBody body, PetscInt n, const LamEvent events[], PetscReal excess[], PetscInt points[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    excess[k] = -PETSC_INFINITY;
    points[k] = -1;
  }
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal at = Excess(body, events[k], p, &point);

      if (!(at > excess[k])) continue; /* not a number: unknown there */
      excess[k] = at;
      points[k] = p;
    }
  }
  PetscFunctionReturn(0);
}
