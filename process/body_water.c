/*
  Water of the cells of a body, point by point.

  The flow through membranes is that of evaluate.c. With r = V - V_b and pi = N / r, an implicit time step V' = s + c
  (V - a) gives the water V(p) by

    c r^2 + (s - c (a - V_b) + k (sigma pi_out + p)) r = k sigma N,

  with its positive root; without resistance c = 0 and only the terms with k remain. Its derivative is
  dr/dp = -k / (c + k sigma N / r^2).

  When turgor is lost, the protoplast detaches from the wall, and the surrounding fluid fills the rest of the lumen at
  zero pressure. The conditions p >= 0 and V <= v, one of them with equality, are enforced by a penalty: at p < 0 the
  lumen is V(0) - VOID p. So p falls to -(v - V) / VOID, at most 1e-5 (C1 + C2) below 0 for an empty lumen.
*/
#include "body_impl.h"
#include <math.h>

static const PetscReal VOID = 1e5;          /* V0 / (C1 + C2) */
static const PetscReal LARGEST_WATER = 1e3; /* V0 */

void LamBodyDrives(LamBody body)
{
  const LamWaterSpec *spec = &body->process->spec->water;
  LamFlow flow;

  body->sigma = spec->reflection * body->now.factor[LAM_CHANGING_REFLECTION].value;
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    const LamCells *cells = &body->cells[p];
    LamDrive *drive = &body->drive[p];

    LamProcessFlow(body->process, cells, &body->now, cells->water, 0, &flow);
    drive->conductance = flow.conductance;
    drive->dead = spec->non_osmotic * cells->water;
    drive->solutes = flow.osmotic * (cells->water - drive->dead);
  }
}

PetscReal LamBodyFlow(LamBody body, PetscInt point, PetscReal water, PetscReal turgor)
{
  const LamDrive *d = &body->drive[point];

  return d->conductance * (body->sigma * (d->solutes / (water - d->dead) - body->now.outside) - PetscMax(turgor, 0));
}

PetscReal LamBodyProtoplast(LamBody body, PetscInt point, PetscReal turgor, PetscReal *slope)
{
  const LamDrive *d = &body->drive[point];
  PetscReal c = 0, b = 0, k = 1, r;

  *slope = 0;
  if (body->mode == LAM_WATER_GIVEN) return body->water[point];
  if (body->mode == LAM_WATER_PASSES) {
    c = body->cj;
    k = d->conductance;
    b = body->slope[point] - c * (body->start[point] - d->dead);
  }
  b += k * (body->sigma * body->now.outside + turgor);
  const PetscReal held = k * body->sigma * d->solutes, root = sqrt(b * b + 4 * c * held);

  r = b > 0 ? 2 * held / (b + root) : c > 0 ? (root - b) / (2 * c) : INFINITY;
  if (!(r < LARGEST_WATER)) r = LARGEST_WATER; /* unbounded in pure water without turgor: limited */
  if (r > 0) *slope = -k / (c + held / (r * r));
  return d->dead + r;
}

void LamBodyWaterLaw(void *ctx, PetscInt point, PetscReal turgor, PetscReal *water, PetscReal *slope)
{
  LamBody body = (LamBody)ctx;

  *water = LamBodyProtoplast(body, point, PetscMax(turgor, 0), slope);
  if (turgor >= 0) return;
  *water -= VOID * turgor;
  *slope = -VOID;
}

PetscErrorCode LamBodyWaterCreate(LamBody body)
{
  const LamWaterSpec *spec = &body->process->spec->water;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    LamCells *cells = &body->cells[p];
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    body->water[p] = cells->water = point.lumen;
    cells->membrane = body->membrane[p];
    cells->osmotic = spec->osmotic;
    if (isnan(spec->osmotic))
      cells->osmotic = body->now.outside + (spec->reflection > 0 ? point.load->turgor / spec->reflection : 0);
  }
  PetscFunctionReturn(0);
}
