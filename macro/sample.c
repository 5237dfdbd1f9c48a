/*
  Estimate of a sum over many items from a few of them.

  Method. Sampling with probability proportional to size: with p_i = size_i over the total of m draws the mean of
  value_i / p_i is an estimate without bias (Hansen & Hurwitz), exact where value is proportional to size. The
  cumulated sizes are cut into m equal parts with a random draw in each, so that draws spread over the items: equal
  steps would meet copies in a body of repeated parts. The variance is estimated as if draws were independent, which is
  too large where neighbours are alike, and the interval is that of Student's t.

  References: Hansen & Hurwitz, Ann. Math. Statist. 14 (1943) 333-362; Saerndal, Swensson & Wretman, Model Assisted
  Survey Sampling, ch. 3; Abramowitz & Stegun, 26.7.5 (quantile of t).
*/
#include <math.h>
#include "sample.h"

PetscReal LamSampleRandom(PetscInt64 seed, PetscInt k)
{
  uint64_t x = ((uint64_t)seed << 20) + (uint64_t)k + 1; /* SplitMix64 (Steele, Lea & Flood 2014) */

  x *= 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  x ^= x >> 31;
  return (PetscReal)(x >> 11) * 0x1p-53;
}

PetscReal LamSampleStudent(PetscInt freedom)
{
  const PetscReal z = 2.5758293035489, n = (PetscReal)freedom; /* z: of the normal distribution */
  const PetscReal z2 = z * z, z3 = z * z2, z5 = z3 * z2, z7 = z5 * z2, z9 = z7 * z2;

  if (freedom < 1) return INFINITY; /* PETSC_INFINITY is finite */
  if (freedom == 1) return 63.656741; /* the expansion is right to 1 % from 4 on; exact below */
  if (freedom == 2) return 9.924843;
  if (freedom == 3) return 5.840909;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n) +
         (79 * z9 + 776 * z7 + 1482 * z5 - 1920 * z3 - 945 * z) / (92160 * n * n * n * n);
}

/* Draws the items that take more than a step, the largest first; returns what they leave to chance: total and draws. */
static void DrawCertain(PetscInt N, const PetscReal size[], PetscInt wanted, PetscInt draws[], PetscReal *total,
                        PetscInt *left)
{
  *total = 0;
  *left = wanted;
  for (PetscInt i = 0; i < N; i++) *total += size[i];
  while (*left > wanted - wanted / 2) {
    PetscInt largest = -1;

    for (PetscInt i = 0; i < N; i++)
      if (!draws[i] && (largest < 0 || size[i] > size[largest])) largest = i;
    if (largest < 0 || size[largest] * (PetscReal)*left < *total) return;
    draws[largest] = -1;
    *total -= size[largest];
    (*left)--;
  }
}

PetscErrorCode LamSampleDraw(PetscInt N, const PetscReal size[], PetscInt wanted, PetscInt64 seed, PetscInt draws[],
                             PetscReal share[], PetscInt *drawn)
{
  PetscReal total, passed = 0;
  PetscInt left;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(draws, N));
  PetscCall(PetscArrayzero(share, N));
  *drawn = 0;
  for (PetscInt i = 0; i < N && wanted >= N; i++) draws[i] = -1;
  if (wanted >= N) PetscFunctionReturn(0);
  DrawCertain(N, size, wanted, draws, &total, &left);
  for (PetscInt i = 0; i < N && total > 0; i++) {
    if (draws[i]) continue;
    share[i] = size[i] / total;
    passed += share[i] * (PetscReal)left;
    for (; *drawn < left && (PetscReal)*drawn + LamSampleRandom(seed, *drawn) < passed; ++*drawn) draws[i]++;
  }
  PetscFunctionReturn(0);
}

void LamSampleSum(PetscInt N, const PetscInt draws[], const PetscReal share[], PetscInt drawn, const PetscReal value[],
                  PetscReal *sum, PetscReal *margin)
{
  PetscReal certain = 0, mean = 0, squares = 0;

  for (PetscInt i = 0; i < N; i++) {
    if (draws[i] < 0) certain += value[i];
    if (draws[i] > 0) mean += (PetscReal)draws[i] * value[i] / share[i] / (PetscReal)drawn;
  }
  for (PetscInt i = 0; i < N; i++)
    if (draws[i] > 0) squares += (PetscReal)draws[i] * PetscSqr(value[i] / share[i] - mean);
  *sum = certain + mean;
  *margin = 0;
  if (drawn == 1) *margin = INFINITY; /* one value has no variance */
  if (drawn > 1) *margin = LamSampleStudent(drawn - 1) * PetscSqrtReal(squares / (PetscReal)(drawn * (drawn - 1)));
}
