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
  r->cell_clusters = record->cell_clusters;
  r->percolating_directions = record->percolating_directions;
  for (int k = 0; k < 3; k++) {
    r->opening_by_face[k] = record->opening_by_face[k];
    r->debonded_by_face[k] = record->debonded_by_face[k];
    r->open_by_face[k] = record->open_by_face[k];
  }
}

static void CopyContact(const LamResponse *record, const PetscInt face[3], LamResponse *r)
{
  for (int k = 0; k < 3; k++) {
    r->opening_by_face[k] = record->opening_by_face[face[k]];
    r->debonded_by_face[k] = record->debonded_by_face[face[k]];
    r->open_by_face[k] = record->open_by_face[face[k]];
  }
  r->debonded_fraction = record->debonded_fraction;
  r->debonded_spread = record->debonded_spread;
  r->open_fraction = record->open_fraction;
  r->open_spread = record->open_spread;
  r->max_gap = record->max_gap;
  r->min_gap = record->min_gap;
  r->mean_gap = record->mean_gap;
  r->max_penetration = record->max_penetration;
  r->floating_cells = record->floating_cells;
  r->zero_modes = record->zero_modes;
  r->cell_clusters = record->cell_clusters;
  r->percolating_directions = record->percolating_directions;
}

/*
  Volumes, and loads of walls and lamella, at the record's own state. Places and the fabric are valid only in the
  record's orientation.
*/
static void CopyLoads(const LamResponse *record, const PetscInt face[3], LamResponse *r)
{
  r->lumen_fraction = record->lumen_fraction;
  r->opening_fraction = record->opening_fraction;
  r->max_traction = record->max_traction;
  r->max_lamella_shear = record->max_lamella_shear;
  r->max_fibre_stretch = record->max_fibre_stretch;
  r->max_wall_energy = record->max_wall_energy;
  r->max_wall_tension = record->max_wall_tension;
  r->wall_ellipticity = record->wall_ellipticity;
  r->kinked_fraction = record->kinked_fraction;
  for (int k = 0; k < 3; k++) {
    r->mean_face_traction[k] = record->mean_face_traction[face[k]];
    r->mean_wall_tension[k] = record->mean_wall_tension[face[k]];
    if (!SameF(&record->load, &r->load)) continue;
    r->fabric[k] = record->fabric[k];
    r->opening_moment[k] = record->opening_moment[k];
    r->gap_place[k] = record->gap_place[k];
    r->normal_place[k] = record->normal_place[k];
    r->shear_place[k] = record->shear_place[k];
    r->wall_place[k] = record->wall_place[k];
    r->kink_place[k] = record->kink_place[k];
  }
}

void LamIndicatorsCopy(const LamResponse *record, const PetscInt face[3], PetscBool own, LamInterfaceLawType interface,
                       LamResponse *r)
{
  if (interface == LAM_INTERFACE_BONDED)
    CopyBonded(record, r);
  else if (own)
    CopyContact(record, face, r);
  else
    r->floating_cells = r->zero_modes = r->cell_clusters = r->percolating_directions = LAM_UNKNOWN_COUNT;
  if (own) CopyLoads(record, face, r);
  r->lowest_eigenvalue = record->lowest_eigenvalue;
  r->negative_eigenvalues = record->negative_eigenvalues;
  r->stable = record->stable;
  r->branch = record->branch;
  r->unknowns = record->unknowns;
}
