/* Energies and damage of the lamella at rve->y. */
#include "measure.h"

typedef struct {
  LamRVE rve;
  PetscReal dissipated;             /* in this step */
  PetscReal spent[3], toughness[3]; /* by face family: energy spent, and that of fracture */
} Bonds;

static void AddBond(void *ctx, const LamBondPoint *point)
{
  Bonds *bonds = (Bonds *)ctx;
  const LamLayer *layer = bonds->rve->layer;
  const LamBond *bond = &layer->bond[point->point];
  const PetscInt family = bonds->rve->contact->faces[point->face].face;
  const PetscReal weight = layer->weight[point->point];

  bonds->dissipated += weight * LamBondSpent(bond, &point->step);
  bonds->spent[family] += weight * LamEnvelopeSpent(&bond->now, point->step.kappa);
  bonds->toughness[family] += weight * bond->now.energy;
}

/* Without any lamella to break, none is broken; a patch may lack a face family: NaN. */
static PetscReal Share(PetscReal whole, PetscReal part)
{
  return whole > 0.0 ? part / whole : NAN;
}

void LamLayerMeasures(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  Bonds bonds = {.rve = rve};
  PetscReal spent = 0.0, toughness = 0.0;

  LamLayerVisitPoints(rve, load->F, rve->y, AddBond, &bonds);
  for (PetscInt k = 0; k < 3; ++k) {
    response->broken_by_face[k] = Share(bonds.toughness[k], bonds.spent[k]);
    spent += bonds.spent[k];
    toughness += bonds.toughness[k];
  }
  response->broken_fraction = Share(toughness, spent);
  response->dissipated = (rve->layer->spent + bonds.dissipated) / rve->mesh.V0;
  response->released = rve->layer->released / rve->mesh.V0;
  response->stored = (rve->energy - bonds.dissipated) / rve->mesh.V0;
  response->energy = response->stored + response->dissipated;
}
