/*
  Loads rounded to a binary grid, so that the result does not depend on the order of summation.
*/
#ifndef LAM_ROUNDED_LOAD_H
#define LAM_ROUNDED_LOAD_H

#include <lamella/response.h>
#include <math.h>

/* 2^-33 is about 1e-10; the rounding itself is exact. */
static inline PetscReal LamOnGrid(PetscReal x)
{
  return ldexp(rint(ldexp(x, 33)), -33);
}

static inline LamLoad LamLoadRound(const LamLoad *load)
{
  LamLoad rounded = *load;

  for (int k = 0; k < 9; k++) rounded.F[k] = LamOnGrid(load->F[k]);
  rounded.turgor = LamOnGrid(load->turgor);
  rounded.cohesion = LamOnGrid(load->cohesion);
  return rounded;
}

/* Compares F, then turgor, then cohesion. */
static inline int LamLoadCompare(const void *first, const void *second)
{
  const LamLoad *a = (const LamLoad *)first, *b = (const LamLoad *)second;

  for (int k = 0; k < 9; k++) {
    if (a->F[k] != b->F[k]) return a->F[k] < b->F[k] ? -1 : 1;
  }
  if (a->turgor != b->turgor) return a->turgor < b->turgor ? -1 : 1;
  if (a->cohesion != b->cohesion) return a->cohesion < b->cohesion ? -1 : 1;
  return 0;
}

static inline void LamAddSlope(PetscReal slope, PetscReal change, PetscReal *value)
{
  if (change != 0 && !PetscIsNanReal(slope)) *value += slope * change;
}

/* First-order correction of a response to `load`, which differs by rounding. Unknown (NaN) slopes are skipped. */
static inline void LamResponseCorrectToLoad(const LamLoad *load, LamResponse *r)
{
  const PetscReal turgor = load->turgor - r->load.turgor, cohesion = load->cohesion - r->load.cohesion;

  LamAddSlope(r->energy_turgor, turgor, &r->energy);
  LamAddSlope(r->energy_cohesion, cohesion, &r->energy);
  for (int kl = 0; kl < 9; kl++) LamAddSlope(r->P[kl], load->F[kl] - r->load.F[kl], &r->energy);
  for (int ij = 0; ij < 9; ij++) {
    for (int kl = 0; kl < 9; kl++) LamAddSlope(r->tangent[9 * ij + kl], load->F[kl] - r->load.F[kl], &r->P[ij]);
    LamAddSlope(r->P_turgor[ij], turgor, &r->P[ij]);
    LamAddSlope(r->P_cohesion[ij], cohesion, &r->P[ij]);
  }
  r->load = *load;
}

#endif
