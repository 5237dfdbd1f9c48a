/*
  Quantities that a response copies from its record: those that do not follow from the potential.

  Tractions and gaps are not interpolated: contact switches between two states, and a mean of "open" and "closed" is
  neither. They are copied where the query is the record's own state, and unknown (NaN, LAM_UNKNOWN_COUNT) elsewhere.
*/
#include "database_internal.h"
#include <math.h>

/* Whether F is equal: a rotated state has the record's strain, but another orientation in space. */
static PetscBool SameF(const LamLoad *a, const LamLoad *b)
{
  for (int i = 0; i < 9; i++)
    if (fabs(a->F[i] - b->F[i]) > 1e-14) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Without kink_place, which a node does not keep. */
#define ONE(name, rule) {offsetof(LamResponse, name), 1, PETSC_FALSE},
#define THREE(name, rule) {offsetof(LamResponse, name), 3, LAM_RULE_##rule == LAM_RULE_FRAME},
static const struct {
  size_t offset;
  int count; /* 3: per face family, or in the frame of the cell, and then valid only in the record's orientation */
  PetscBool framed;
} indicators[] = {LAM_NODE_INDICATORS(ONE, THREE)};

static void CopyOwn(const LamResponse *record, const PetscInt face[3], LamResponse *r)
{
  const PetscBool oriented = SameF(&record->load, &r->load);

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(indicators); i++) {
    const PetscReal *from = (const PetscReal *)(const void *)((const char *)record + indicators[i].offset);
    PetscReal *to = (PetscReal *)(void *)((char *)r + indicators[i].offset);

    if (indicators[i].framed && !oriented) continue;
    for (int k = 0; k < indicators[i].count; k++)
      to[k] = from[indicators[i].count == 1 || indicators[i].framed ? k : face[k]];
  }
  for (int k = 0; k < 3 && oriented; k++) r->kink_place[k] = record->kink_place[k];
}

/* Bonded tissue has no gaps and stays connected at every load. */
static void CopyBonded(const LamResponse *record, LamResponse *r)
{
  for (int i = 0; i < 9; i++) r->P_cohesion[i] = 0;
  r->energy_cohesion = r->energy_cohesion2 = r->energy_turgor_cohesion = 0;
  r->opening_fraction = record->opening_fraction;
  r->mean_gap = record->mean_gap;
  r->max_gap = record->max_gap;
  r->max_penetration = record->max_penetration;
  r->debonded_fraction = record->debonded_fraction;
  r->open_fraction = record->open_fraction;
  for (int k = 0; k < 3; k++) {
    r->opening_by_face[k] = record->opening_by_face[k];
    r->debonded_by_face[k] = record->debonded_by_face[k];
    r->open_by_face[k] = record->open_by_face[k];
  }
}

void LamIndicatorsCopy(const LamResponse *record, const PetscInt face[3], PetscBool own, LamInterfaceLawType interface,
                       LamResponse *r)
{
  const PetscBool bonded = (PetscBool)(interface == LAM_INTERFACE_BONDED), known = (PetscBool)(bonded || own);

  if (bonded) CopyBonded(record, r);
  if (own) CopyOwn(record, face, r);
  if (!bonded) r->floating_cells = own ? record->floating_cells : LAM_UNKNOWN_COUNT;
  if (!bonded) r->zero_modes = own ? record->zero_modes : LAM_UNKNOWN_COUNT;
  r->cell_clusters = known ? record->cell_clusters : LAM_UNKNOWN_COUNT;
  r->percolating_directions = known ? record->percolating_directions : LAM_UNKNOWN_COUNT;
  r->lowest_eigenvalue = record->lowest_eigenvalue;
  r->negative_eigenvalues = record->negative_eigenvalues;
  r->stable = record->stable;
  r->branch = record->branch;
  r->unknowns = record->unknowns;
}
