#include <lamella/blend.h>
#include <math.h>
#include <stddef.h>

/* ---- weights ---- */

/* The axis is linear where a knot is 0 (no fibres, no C2), else logarithmic. */
static PetscReal Position(PetscReal value, PetscBool is_log)
{
  return is_log ? log(value) : value;
}

/* Lagrange weights of n knots at value; knot `without` is left out (-1: none). */
static void Weights(const PetscReal knots[], PetscInt n, PetscReal value, PetscInt without, PetscReal w[])
{
  const PetscBool is_log = (PetscBool)(knots[0] > 0);
  const PetscReal x = Position(value, is_log);

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal at = Position(knots[i], is_log);

    w[i] = i != without;
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal other = Position(knots[k], is_log);

      if (k != i && k != without) w[i] *= (x - other) / (at - other);
    }
  }
}

/* The knots around a value: index of the first, and their number. */
static void Nearest(PetscInt n, const PetscReal knots[], PetscReal value, PetscInt *first, PetscInt *count)
{
  PetscInt above = 1;

  while (above < n - 1 && knots[above] < value) above++;
  *count = PetscMin(n, (PetscInt)LAM_BLEND_TERMS);
  *first = PetscMin(PetscMax(above - *count / 2, 0), n - *count);
}

/* Weights without the farthest knot. */
static void CoarseWeights(const PetscReal knots[], PetscInt n, PetscReal value, const PetscReal w[], PetscReal coarse[])
{
  const PetscReal low = fabs(log1p(value) - log1p(knots[0])), high = fabs(log1p(value) - log1p(knots[n - 1]));

  if (n > 2) {
    Weights(knots, n, value, low > high ? 0 : n - 1, coarse);
  } else {
    coarse[0] = w[0] + 0.25;
    coarse[1] = w[1] - 0.25;
  }
}

PetscInt LamBlendAt(PetscInt n, const PetscReal knots[], PetscReal value, LamBlendTerm terms[LAM_BLEND_TERMS])
{
  PetscReal w[LAM_BLEND_TERMS], coarse[LAM_BLEND_TERMS], t;
  PetscInt first, count, above = 1;

  if (n == 1) {
    terms[0] = (LamBlendTerm){.weight = 1, .coarse = 1, .share = 1};
    return 1;
  }
  Nearest(n, knots, value, &first, &count);
  knots += first;
  Weights(knots, count, value, -1, w);
  CoarseWeights(knots, count, value, w, coarse);
  for (PetscInt i = 0; i < count; i++) terms[i] = (LamBlendTerm){first + i, w[i], coarse[i], 0};
  while (above < count - 1 && knots[above] < value) above++;
  t = PetscClipInterval((value - knots[above - 1]) / (knots[above] - knots[above - 1]), 0.0, 1.0);
  terms[above - 1].share = 1 - t;
  terms[above].share = t;
  return count;
}

/* ---- responses ---- */

/* The quantities that are linear in the potential are contiguous in LamResponse, from `energy` to `turgor_mean`. */
enum { POTENTIAL = (offsetof(LamResponse, turgor_mean) - offsetof(LamResponse, energy)) / sizeof(PetscReal) };

static PetscReal *Potential(const LamResponse *r)
{
  return (PetscReal *)((char *)r + offsetof(LamResponse, energy));
}

static PetscBool IsIndicator(size_t offset)
{
  return (
      PetscBool)((offset >= offsetof(LamResponse, turgor_mean) && offset <= offsetof(LamResponse, mean_wall_tension)) ||
                 offset == offsetof(LamResponse, broken_fraction) || offset == offsetof(LamResponse, broken_by_face));
}

/* Of law `lamella`: their sums remain those of the energy. */
static void AddEnergies(PetscReal weight, const LamResponse *term, LamResponse *r)
{
  r->stored += weight * term->stored;
  r->dissipated += weight * term->dissipated;
  r->work += weight * term->work;
  r->released += weight * term->released;
}

/* Interpolates pressures and indicators between the two terms with shares; counts are set where both agree. */
static void MixIndicators(const LamResponse *a, const LamResponse *b, PetscReal t, LamResponse *r)
{
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const PetscReal *from = (const PetscReal *)((const char *)a + m->offset);
    const PetscReal *to = (const PetscReal *)((const char *)b + m->offset);
    PetscReal *mixed = (PetscReal *)((char *)r + m->offset);

    if (m->type != LAM_MEMBER_REAL || !IsIndicator(m->offset)) continue;
    for (PetscInt i = 0; i < m->count; i++) mixed[i] = (1 - t) * from[i] + t * to[i];
  }
  if (a->floating_cells == b->floating_cells) r->floating_cells = a->floating_cells;
  if (a->zero_modes == b->zero_modes) r->zero_modes = a->zero_modes;
  if (a->cell_clusters == b->cell_clusters) r->cell_clusters = a->cell_clusters;
  if (a->percolating_directions == b->percolating_directions) r->percolating_directions = a->percolating_directions;
  r->indicators_trusted = (PetscBool)(a->indicators_trusted && b->indicators_trusted);
  /* as at the knots, the lumen fraction is a derivative of the potential */
  if (a->lumen_fraction == -a->energy_turgor) r->lumen_fraction = -r->energy_turgor;
  r->opening_fraction = PetscMax(r->energy_cohesion, 0);
}

static void MixShares(PetscInt n, const LamBlendTerm terms[], const LamResponse at[], LamResponse *r)
{
  PetscInt first = 0;

  while (first < n - 1 && terms[first].share == 0) first++;
  if (first == n - 1)
    MixIndicators(&at[first], &at[first], 0, r);
  else
    MixIndicators(&at[first], &at[first + 1], terms[first + 1].share, r);
}

/* Status and effort of the terms. */
static void AddEffort(const LamResponse *term, LamResponse *r)
{
  if (term->status == LAM_UNSTABLE) r->status = LAM_UNSTABLE;
  if (term->source == LAM_SOURCE_SOLVE) r->source = LAM_SOURCE_SOLVE;
  r->stable = (PetscBool)(r->stable && term->stable);
  r->branch = PetscMax(r->branch, term->branch);
  r->newton_iterations += term->newton_iterations;
  r->factorisations += term->factorisations;
  r->unknowns = PetscMax(r->unknowns, term->unknowns);
}

void LamBlend(LamStressScale scale, PetscInt n, const LamBlendTerm terms[], const LamResponse at[], LamResponse *r)
{
  PetscReal estimate = 0, P[9] = {0};

  for (int k = 0; k < POTENTIAL; k++) Potential(r)[k] = 0;
  r->stored = r->dissipated = r->work = r->released = 0;
  r->status = LAM_CONVERGED;
  r->source = LAM_SOURCE_DATABASE;
  r->stable = PETSC_TRUE;
  for (PetscInt i = 0; i < n; i++) {
    for (int k = 0; k < POTENTIAL; k++) Potential(r)[k] += terms[i].weight * Potential(&at[i])[k];
    AddEnergies(terms[i].weight, &at[i], r);
    AddEffort(&at[i], r);
    estimate += fabs(terms[i].weight) * at[i].error_estimate;
    for (int k = 0; k < 9; k++) P[k] += terms[i].coarse * at[i].P[k];
  }
  MixShares(n, terms, at, r);
  r->error_estimate = estimate + LamStressError(scale, P, r->P);
}
