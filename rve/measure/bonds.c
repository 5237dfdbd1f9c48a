/* Energies, damage and forces of the lamella at rve->y. */
#include "measure.h"

void LamDamageAdd(LamRVE rve, const LamBond *bond, const LamBondPoint *point, LamDamage *damage)
{
  const PetscReal weight = rve->layer->weight[point->point];
  const PetscReal spent = weight * LamEnvelopeSpent(&bond->now, point->step.kappa);
  PetscInt family;

  damage->dissipated += weight * LamBondSpent(bond, &point->step);
  if (point->face < 0) {
    damage->torn += spent;
    return;
  }
  family = rve->contact->faces[point->face].family;
  damage->spent[family] += spent;
  damage->toughness[family] += weight * bond->now.energy;
}

typedef struct {
  LamRVE rve;
  LamDamage damage;
} Bonds;

static void AddBond(void *ctx, const LamBondPoint *point)
{
  Bonds *bonds = (Bonds *)ctx;

  LamDamageAdd(bonds->rve, &bonds->rve->layer->bond[point->point], point, &bonds->damage);
}

typedef struct {
  LamRVE rve;
  LamLayerForces *forces;
} Holding;

static void AddHolding(void *ctx, const LamBondPoint *point)
{
  const Holding *h = (const Holding *)ctx;
  const LamLayer *layer = h->rve->layer;
  const LamBond *bond = &layer->bond[point->point];
  const PetscReal weight = layer->weight[point->point];
  const PetscInt hat = point->face * h->rve->contact->hats + (PetscInt)(2.0 * point->at + 0.5);
  PetscReal traction[2];

  if (point->face < 0) return;
  LamBondTraction(bond, &point->jump, 2.0 * point->step.d, traction); /* d phi/d q = omega k/2 */
  h->forces->normal[point->point] = weight * traction[0];
  h->forces->shear[point->point] = weight * traction[1];
  if (!LamBondIsBroken(bond, point->step.kappa)) h->forces->held[hat] += weight;
}

PetscErrorCode LamLayerForcesCreate(LamRVE rve, const LamLoad *load, LamLayerForces *forces)
{
  const Holding holding = {rve, forces};

  PetscFunctionBeginUser;
  *forces = (LamLayerForces){0};
  if (!rve->layer) PetscFunctionReturn(0);
  PetscCall(PetscCalloc3(rve->layer->between, &forces->normal, rve->layer->between, &forces->shear, rve->contact->count,
                         &forces->held));
  LamLayerVisitPoints(rve, load->F, rve->y, AddHolding, (void *)&holding);
  PetscFunctionReturn(0);
}

PetscErrorCode LamLayerForcesDestroy(LamLayerForces *forces)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(forces->normal, forces->shear, forces->held));
  PetscFunctionReturn(0);
}

/* Force over the first part of an edge, which ends at s: each point's is spread over its share of the edge. */
static PetscReal ForceUpTo(const PetscReal force[], PetscReal s)
{
  PetscReal sum = 0.0;

  for (PetscInt q = 0; q < LAM_EDGE_POINTS && s > 0.0; ++q) {
    sum += force[q] * PetscMin(1.0, s / LamEdgeWeight(q));
    s -= LamEdgeWeight(q);
  }
  return sum;
}

PetscReal LamLayerForceBetween(const PetscReal force[], PetscReal a, PetscReal b)
{
  const PetscInt e = (PetscInt)(0.5 * (a + b));

  force += LAM_EDGE_POINTS * e;
  return ForceUpTo(force, b - (PetscReal)e) - ForceUpTo(force, a - (PetscReal)e);
}

/* Without any lamella to break, none is broken; a patch may lack a face family: NaN. */
static PetscReal Share(PetscReal whole, PetscReal part)
{
  return whole > 0.0 ? part / whole : NAN;
}

static void MeasureBursts(LamRVE rve, LamResponse *response)
{
  PetscInt burst = 0;

  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) burst += LamHasBurst(rve, c);
  response->burst_fraction = (PetscReal)burst / (PetscReal)rve->mesh.cell_count;
  response->juice = rve->layer->juice;
}

void LamDamageFill(const LamDamage *damage, LamResponse *response)
{
  PetscReal spent = 0.0, toughness = 0.0;

  for (PetscInt k = 0; k < 3; ++k) {
    response->broken_by_face[k] = Share(damage->toughness[k], damage->spent[k]);
    spent += damage->spent[k];
    toughness += damage->toughness[k];
  }
  response->broken_fraction = Share(toughness, spent);
}

void LamLayerMeasures(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  Bonds bonds = {.rve = rve};

  LamLayerVisitPoints(rve, load->F, rve->y, AddBond, &bonds);
  LamDamageFill(&bonds.damage, response);
  response->dissipated = rve->layer->spent + bonds.damage.dissipated / rve->mesh.V0;
  response->dissipated_walls = bonds.damage.torn / rve->mesh.V0;
  MeasureBursts(rve, response);
  response->released = rve->layer->released;
  response->stored = (rve->energy - bonds.damage.dissipated) / rve->mesh.V0;
  response->energy = response->stored + response->dissipated;
}
