/*
  Water of the cells of a body, point by point.

  The flow through membranes is that of evaluate.c. With r = V - V_b and pi = N / r, an implicit time step V' = s + c
  (V - a) gives the water V(p) by

    c r^2 + (s - c (a - V_b) + k (sigma pi_out + p)) r = k sigma N,

  with its positive root; without resistance c = 0 and only the terms with k remain. Its derivative is
  dr/dp = -k / (c + k sigma N / r^2). Where water moves through the body, the cells exchange it with the potentials
  there: k is the sum of the conductances k_f, and k (sigma pi_out + p) that of k_f (p - psi_f).

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

  if (body->cells_path >= 0) {
    LamProcessFlow(body->process, &body->process->cells, &body->now, 1, 0, &flow);
    body->skin = flow.conductance / body->process->cells.membrane * body->process->scene->scales.length /
                 body->process->scene->scales.macro_length;
  }
  body->sigma = spec->reflection * body->now.factor[LAM_CHANGING_REFLECTION].value;
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    const LamCells *cells = &body->cells[p];
    LamDrive *drive = &body->drive[p];

    LamProcessFlow(body->process, cells, &body->now, cells->water, 0, &flow);
    drive->conductance = body->isolated ? 0 : flow.conductance;
    drive->dead = spec->non_osmotic * cells->water;
    drive->solutes = flow.osmotic * (cells->water - drive->dead);
  }
}

/* Conductance from potential f to the cells of a point. */
static PetscReal Exchange(const struct LamBody_s *body, PetscInt point, PetscInt f)
{
  return f == body->cells_path ? body->exchange : body->drive[point].conductance;
}

/* Sum over what a cell exchanges water with: conductances k (p - psi), and of k. */
static PetscReal Drain(LamBody body, PetscInt point, PetscReal turgor, const PetscReal potential[], PetscReal *sum)
{
  PetscReal drain = 0;

  *sum = body->drive[point].conductance;
  if (!body->transport.count) return *sum * (body->sigma * body->now.outside + turgor);
  *sum = 0;
  for (PetscInt f = 0; f < body->transport.count; f++) {
    const PetscReal k = Exchange(body, point, f);

    *sum += k;
    drain += k * (turgor - potential[f]);
  }
  return drain;
}

PetscReal LamBodyFlow(LamBody body, PetscInt point, PetscReal water, const LamMacroPoint *at)
{
  const LamDrive *d = &body->drive[point];
  const PetscReal turgor = PetscMax(at->load->turgor, 0), osmotic = d->solutes / (water - d->dead);
  PetscReal k;

  if (!body->transport.count) return d->conductance * (body->sigma * (osmotic - body->now.outside) - turgor);
  const PetscReal drain = Drain(body, point, turgor, at->potential, &k);
  return k * body->sigma * osmotic - drain;
}

PetscReal LamBodyProtoplast(LamBody body, PetscInt point, PetscReal turgor, const PetscReal potential[],
                            PetscReal *slope)
{
  const LamDrive *d = &body->drive[point];
  PetscReal c = 0, b = 0, k, r;

  *slope = 0;
  if (body->mode == LAM_WATER_GIVEN) return body->water[point];
  const PetscReal drain = Drain(body, point, turgor, potential, &k);
  if (body->mode == LAM_WATER_PASSES) {
    c = body->cj;
    b = body->slope[point] - c * (body->start[point] - d->dead);
    b += drain;
  } else {
    k = 1;
    b = body->sigma * body->now.outside + turgor;
  }
  const PetscReal held = k * body->sigma * d->solutes, root = sqrt(b * b + 4 * c * held);

  r = b > 0 ? 2 * held / (b + root) : c > 0 ? (root - b) / (2 * c) : INFINITY;
  if (!(r < LARGEST_WATER)) r = LARGEST_WATER; /* unbounded in pure water without turgor: limited */
  if (r > 0) *slope = -k / (c + held / (r * r));
  return d->dead + r;
}

/* Potential and flows of cells with the protoplast water->water and its slope (docs/theory/process.md). What flows from
   the last potential is what the others leave, so that rounding of large conductances does not count. */
static void FindFlows(LamBody body, PetscInt point, PetscReal turgor, const PetscReal potential[], LamWater *water)
{
  const LamDrive *d = &body->drive[point];
  const PetscBool passes = (PetscBool)(body->mode == LAM_WATER_PASSES);
  const PetscReal p = PetscMax(turgor, 0), osmotic = body->sigma * d->solutes / (water->water - d->dead);
  const PetscInt n = body->transport.count;
  PetscReal k, others = 0;

  (void)Drain(body, point, p, potential, &k);
  const PetscReal own = passes && k > 0 ? -body->cj * water->slope / k : 1; /* derivative of `potential` by turgor */
  water->potential = p - osmotic;
  water->magnitude = passes ? PetscAbsReal(body->slope[point]) + body->cj * water->water : 0;
  for (PetscInt f = 0; f < n; f++) {
    const PetscReal kf = Exchange(body, point, f), share = k > 0 ? kf / k : 0;

    water->by_potential[f] = -share * water->slope;
    water->flow[f] = kf * (potential[f] - water->potential);
    if (passes && f == n - 1)
      water->flow[f] = body->slope[point] + body->cj * (water->water - body->start[point]) - others;
    others += water->flow[f];
    water->flow_turgor[f] = turgor > 0 ? -kf * own : 0;
    for (PetscInt g = 0; g < n; g++)
      water->flow_potential[f][g] = (f == g ? kf : 0) - share * (1 - own) * Exchange(body, point, g);
    water->magnitude += kf * (PetscAbsReal(potential[f]) + p + osmotic);
  }
}

void LamBodyWaterLaw(void *ctx, PetscInt point, PetscReal turgor, const PetscReal potential[], LamWater *water)
{
  LamBody body = (LamBody)ctx;

  water->water = LamBodyProtoplast(body, point, PetscMax(turgor, 0), potential, &water->slope);
  if (body->transport.count) FindFlows(body, point, turgor, potential, water);
  if (turgor >= 0) return;
  water->water -= VOID * turgor;
  water->slope = -VOID;
}

/* ---- transport ---- */

PetscErrorCode LamBodyTransportCreate(LamBody body)
{
  const LamScene *scene = body->process->scene;
  const LamTransportSpec *spec = &scene->process.transport;
  LamMacroTransport *transport = &body->transport;
  const PetscReal reach = 0.5 * scene->scales.length / scene->scales.macro_length; /* half the apothem */

  PetscFunctionBeginUser;
  body->apoplast = body->cells_path = -1;
  if (!spec->given || isinf(spec->apoplast)) PetscFunctionReturn(0);
  if (spec->apoplast > 0 && scene->process.water.permeability > 0) {
    body->apoplast = transport->count++;
    transport->conductivity[body->apoplast] = spec->apoplast;
  }
  if (spec->cell_to_cell > 0) {
    body->cells_path = transport->count++;
    transport->conductivity[body->cells_path] = spec->cell_to_cell;
    transport->has_membrane[body->cells_path] = PETSC_TRUE;
    body->exchange = spec->cell_to_cell / (reach * reach);
  }
  body->isolated = (PetscBool)!transport->count;
  if (transport->count) PetscCall(LamMacroSetTransport(body->macro, transport));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyInflowRate(LamBody body, PetscReal *rate)
{
  PetscFunctionBeginUser;
  PetscCall(LamMacroGetInflow(body->macro, rate));
  *rate /= body->volume;
  PetscFunctionReturn(0);
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
