/*
  Random numbers that are equal on all machines.

  Method. splitmix64 (Steele, Lea & Flood, OOPSLA 2014, Figure 12) and the transform of Box & Muller (Ann. Math. Stat.
  29, 1958). Results are rounded to six decimals, which hides differences in the last digit of a machine's logarithm.
*/
#include "scene_keys.h"
#include <lamella/lattice.h>
#include <lamella/tissue.h>
#include <math.h>
#include <stdint.h>

#define REACH 3.0 /* correlation lengths; weights beyond are below 2e-8 */

static uint64_t Next(uint64_t *state)
{
  uint64_t z = *state += 0x9e3779b97f4a7c15u;

  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* Uniform in (0, 1), excluding both ends. */
static PetscReal Uniform(uint64_t *state)
{
  return ((PetscReal)(Next(state) >> 12) + 0.5) / 4503599627370496.0;
}

static PetscReal Normal(uint64_t *state)
{
  const PetscReal radius = sqrt(-2.0 * log(Uniform(state)));

  return radius * cos(2.0 * PETSC_PI * Uniform(state));
}

void LamRandomShuffle(PetscInt seed, PetscInt n, PetscInt values[])
{
  uint64_t state = (uint64_t)seed;

  for (PetscInt i = n - 1; i > 0; i--) {
    const PetscInt j = (PetscInt)(Uniform(&state) * (PetscReal)(i + 1)), kept = values[i];

    values[i] = values[j];
    values[j] = kept;
  }
}

static PetscReal Weight(PetscInt d0, PetscInt d1, PetscReal correlation)
{
  const PetscReal r = LamLatticeDistance(d0, d1) / correlation;

  return r <= REACH ? exp(-2.0 * r * r) : 0.0;
}

/* Weights as below of cells that are polygons: distances of the means of their corners over two apothems. */
static void WeighPolygons(const LamMicrostructure *micro, PetscInt cell, PetscReal correlation, PetscReal weight[])
{
  const LamTissue t = micro->tissue;
  const PetscReal reach = 2.0 * REACH * correlation,
                  det = t->period[0][0] * t->period[1][1] - t->period[0][1] * t->period[1][0];
  PetscInt images[2] = {0, 0};
  PetscReal here[2], there[2];

  for (int k = 0; k < 2 && !micro->is_patch; k++) /* periods within reach, beside those between the centres */
    images[k] = 2 + (PetscInt)(reach * hypot(t->period[1 - k][0], t->period[1 - k][1]) / det);
  LamTissueCentre(t, cell, here);
  for (PetscInt c = 0; c < t->cells; c++) {
    weight[c] = 0.0;
    LamTissueCentre(t, c, there);
    for (PetscInt i = -images[0]; i <= images[0]; i++)
      for (PetscInt j = -images[1]; j <= images[1]; j++) {
        const PetscReal x = there[0] - here[0] + (PetscReal)i * t->period[0][0] + (PetscReal)j * t->period[1][0];
        const PetscReal y = there[1] - here[1] + (PetscReal)i * t->period[0][1] + (PetscReal)j * t->period[1][1];
        const PetscReal r = 0.5 * hypot(x, y) / correlation;

        if (r <= REACH) weight[c] += exp(-2.0 * r * r);
      }
  }
}

/* Weights of the noise of each cell, in a period including all its images, for one cell. */
static void WeighNoise(const LamMicrostructure *micro, PetscInt cell, PetscReal correlation, PetscReal weight[])
{
  const PetscInt *n = micro->cells, count = n[0] * n[1];
  const PetscInt reach = (PetscInt)ceil(2.0 / sqrt(3.0) * REACH * correlation); /* r^2 >= 3/4 d0^2 and 3/4 d1^2 */
  PetscInt at[2], other[2];

  LamLatticeIndex(micro, cell, at);
  for (PetscInt c = 0; c < count; c++) {
    LamLatticeIndex(micro, c, other);
    weight[c] = micro->is_patch ? Weight(other[0] - at[0], other[1] - at[1], correlation) : 0.0;
  }
  for (PetscInt d0 = -reach; !micro->is_patch && d0 <= reach; d0++)
    for (PetscInt d1 = -reach; d1 <= reach; d1++) {
      const PetscInt i = ((at[0] + d0) % n[0] + n[0]) % n[0], j = ((at[1] + d1) % n[1] + n[1]) % n[1];

      weight[i * n[1] + j] += Weight(d0, d1, correlation);
    }
}

/* Correlated standard normal numbers z[property][cell] from independent ones; weight [cell] is work space. */
static void Smooth(const LamMicrostructure *micro, PetscReal correlation, PetscInt properties, const PetscReal noise[],
                   PetscReal weight[], PetscReal z[])
{
  const PetscInt count = micro->cells[0] * micro->cells[1];

  for (PetscInt cell = 0; cell < count; cell++) {
    PetscReal square = 0.0;

    (micro->tissue ? WeighPolygons : WeighNoise)(micro, cell, correlation, weight);
    for (PetscInt c = 0; c < count; c++) square += weight[c] * weight[c];
    for (PetscInt p = 0; p < properties; p++) {
      PetscReal sum = 0.0;

      for (PetscInt c = 0; c < count; c++) sum += weight[c] * noise[p * count + c];
      z[p * count + cell] = sum / sqrt(square);
    }
  }
}

PetscErrorCode LamRandomFactors(const LamMicrostructure *micro, PetscInt seed, PetscReal correlation,
                                PetscInt properties, const PetscReal variation[], PetscReal factors[])
{
  const PetscInt count = micro->cells[0] * micro->cells[1];
  uint64_t state = (uint64_t)seed;
  PetscReal *noise, *weight;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(properties * count, &noise, count, &weight));
  for (PetscInt k = 0; k < properties * count; k++) noise[k] = Normal(&state);
  if (correlation > 0.0)
    Smooth(micro, correlation, properties, noise, weight, factors);
  else
    PetscCall(PetscArraycpy(factors, noise, properties * count));
  for (PetscInt k = 0; k < properties * count; k++) {
    const PetscReal v = variation[k / count], s2 = log1p(v * v);

    factors[k] = round(1e6 * exp(sqrt(s2) * factors[k] - 0.5 * s2)) * 1e-6;
  }
  PetscCall(PetscFree2(noise, weight));
  PetscFunctionReturn(0);
}
