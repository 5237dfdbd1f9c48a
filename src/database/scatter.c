/*
  Records outside the grid: their use, their models of the potential, and the search for the nearest.
*/
#include "database_internal.h"
#include <lamella/ellipticity.h>
#include <lamella/tissue.h>
#include <math.h>
#include <string.h>

#define TIE 1e-14 /* strain: distances that differ by less are equal, and the first record or image is used */

/* Bits of the images that coincide with no earlier one; on a mirror plane of the lattice they coincide in pairs. */
static PetscInt DistinctImages(const LamImages *images, const PetscReal x[LAM_VARIABLES])
{
  PetscReal at[LAM_MAX_IMAGES][LAM_VARIABLES];
  PetscInt distinct = 0;

  for (PetscInt i = 0; i < images->count; i++) {
    PetscBool fresh = PETSC_TRUE;

    memcpy(at[i], x, sizeof(at[i]));
    LamImagesBack(images, i, at[i]);
    for (PetscInt j = 0; j < i; j++)
      if (hypot(at[i][1] - at[j][1], at[i][2] - at[j][2]) < LAM_OWN_STATE) fresh = PETSC_FALSE;
    if (fresh) distinct |= 1 << i;
  }
  return distinct;
}

static LamScatterPlace PlaceOf(const PetscReal x[LAM_VARIABLES], PetscReal F33)
{
  return (LamScatterPlace){x[0], hypot(x[1], x[2]), x[3], x[4], F33};
}

/* Whether the load is finite, in the plane, and has J > 0. */
static PetscBool HasPlace(const LamLoad *load)
{
  PetscReal sum = load->turgor + load->cohesion;
  LamResponse unused;

  for (int i = 0; i < 9; i++) sum += load->F[i];
  return (PetscBool)(isfinite(sum) && LamLoadValidateInPlane(load, &unused) && load->F[8] > 0);
}

static LamScattered StateOf(const LamImages *images, PetscBool bonded, const LamResponse *record)
{
  LamScattered state = {.use = LAM_SCATTER_REFUSES, .F33 = record->load.F[8]};

  LamVariables(&record->load, state.model.x);
  if (record->status == LAM_CONVERGED && record->stable && LamExpansionMake(record, bonded, &state.model))
    state.use = record->branch || record->floating_cells > 0           ? LAM_SCATTER_ALONE
                : !bonded && LamEllipticityIsLost(record->ellipticity) ? LAM_SCATTER_KINK
                                                                       : LAM_SCATTER_BLENDS;
  state.images = DistinctImages(images, state.model.x);
  return state;
}

PetscErrorCode LamScatterAdd(LamDatabase database, const LamResponse *record)
{
  const PetscBool bonded = (PetscBool)(database->header.micro.interface == LAM_INTERFACE_BONDED);
  LamScatter *scatter = &database->scatter;
  const PetscInt at = scatter->n;

  PetscFunctionBeginUser;
  PetscCall(LamGrow(at, 1, sizeof(*scatter->records), &scatter->capacity[0], &scatter->records));
  PetscCall(LamGrow(at, 1, sizeof(*scatter->states), &scatter->capacity[1], &scatter->states));
  PetscCall(LamGrow(at, 1, sizeof(*scatter->places), &scatter->capacity[2], &scatter->places));
  scatter->n++;
  scatter->records[at] = *record;
  scatter->states[at] = (LamScattered){.use = LAM_SCATTER_REFUSES};
  scatter->places[at] = (LamScatterPlace){.mean = INFINITY};
  if (!HasPlace(&record->load)) PetscFunctionReturn(0);
  scatter->states[at] = StateOf(&database->images, bonded, record);
  scatter->places[at] = PlaceOf(scatter->states[at].model.x, record->load.F[8]);
  PetscFunctionReturn(0);
}

/* ---- the nearest records ---- */

PetscErrorCode LamScatterMetricMake(const LamMicrostructure *micro, LamScatterMetric *metric)
{
  const PetscBool bonded = (PetscBool)(micro->interface == LAM_INTERFACE_BONDED);
  const PetscReal suction = bonded ? 0 : PetscSqr(LAM_SUCTION_WEIGHT), unfilled = PetscSqr(LAM_UNFILLED_WEIGHT);
  PetscBool filled;

  PetscFunctionBeginUser;
  PetscCall(LamFluidFills(micro, &filled));
  *metric = (LamScatterMetric){0.25, suction + (filled ? PetscSqr(LAM_TURGOR_WEIGHT) : unfilled), suction,
                               suction + (filled || bonded ? 0 : unfilled)};
  PetscFunctionReturn(0);
}

PetscReal LamScatterApply(const LamScatterMetric *m, const LamScatterVector delta, LamScatterVector v)
{
  PetscReal sum = 0;

  for (int a = 0; a < 3; a++) v[a] = m->strain * delta[a];
  v[3] = m->pp * delta[3] + m->pg * delta[4];
  v[4] = m->pg * delta[3] + m->gg * delta[4];
  for (int a = 0; a < LAM_VARIABLES; a++) sum += v[a] * delta[a];
  return sum;
}

PetscReal LamScatterLowerBound(const LamScatterSearch *search, const LamScatterPlace *place)
{
  const LamScatterMetric *m = &search->db->metric;
  const LamScatterPlace *at = &search->place;
  const PetscReal dm = place->mean - at->mean, dd = place->deviator - at->deviator;
  const PetscReal dp = place->turgor - at->turgor, dg = place->cohesion - at->cohesion;

  return m->strain * (dm * dm + dd * dd) + m->pp * dp * dp + 2 * m->pg * dp * dg + m->gg * dg * dg +
         PetscSqr(place->F33 - at->F33);
}

PetscBool LamScatterSameF33(const LamScatterSearch *search, PetscInt k)
{
  return (PetscBool)(fabs(search->db->scatter.places[k].F33 - search->place.F33) < LAM_OWN_STATE);
}

PetscReal LamScatterDistance2(const LamScatterSearch *search, const LamScattered *state, PetscInt image)
{
  LamScatterVector delta, v;

  for (int a = 0; a < LAM_VARIABLES; a++) delta[a] = search->turned[image][a] - state->model.x[a];
  return LamScatterApply(&search->db->metric, delta, v) + PetscSqr(search->place.F33 - state->F33);
}

void LamScatterBegin(LamDatabase db, const LamLoad *load, LamScatterSearch *search)
{
  const LamScatterNearest none = {-1, 0, INFINITY};

  *search = (LamScatterSearch){.db = db, .blends = none, .alone = none, .refuses = none, .kinks = none};
  LamVariables(load, search->x);
  search->place = PlaceOf(search->x, load->F[8]);
  for (PetscInt i = 0; i < db->images.count; i++) LamImagesForward(&db->images, i, search->x, search->turned[i]);
}

void LamScatterFind(LamDatabase db, const LamLoad *load, PetscBool same_F33, LamScatterSearch *search)
{
  LamScatterNearest *const nearest[] = {&search->blends, &search->alone, &search->refuses, &search->kinks}; /* by use */
  const LamScatter *scatter = &db->scatter;

  LamScatterBegin(db, load, search);
  for (PetscInt k = 0; k < scatter->n; k++) {
    const LamScattered *state = &scatter->states[k];
    LamScatterNearest *best = nearest[state->use];

    if (!(LamScatterLowerBound(search, &scatter->places[k]) < best->distance2)) continue;
    if (same_F33 && state->use != LAM_SCATTER_REFUSES && !LamScatterSameF33(search, k)) continue;
    for (PetscInt i = 0; i < db->images.count; i++) {
      PetscReal d2;

      if (!(state->images >> i & 1)) continue;
      d2 = LamScatterDistance2(search, state, i);
      if (d2 < best->distance2 - 2 * TIE * sqrt(d2)) *best = (LamScatterNearest){k, i, d2};
    }
  }
}
