/*
  Long waves of dry tissue under uniaxial compression F = diag(1, 1 - e), orientation 0, against its tangent: what the
  test asserts and the bench program prints.

  A row of n cells along lattice vector 1, of period one cell along lattice vector 0, has the waves of k/n periods per
  cell, k = 0..n-1; their normal is X2. Each loses stability at a strain of its own, and shows as a negative eigenvalue
  of the symmetric solution from there on. The longest, k = 1 and k = n - 1, are the last of the n - 1: short ones
  buckle first, and the wave of k = 0 is the buckling of one cell, far later.

  Reference: Geymonat, Mueller and Triantafyllidis, Arch. Rational Mech. Anal. 122 (1993) 231: the limit of long waves
  is the loss of ellipticity of the effective tangent.
*/
#ifndef LAM_FIGURES_LOCALISATION_H
#define LAM_FIGURES_LOCALISATION_H

#include "figures_buckling.h"

#define LOCALISATION_LOW 0.01
#define LOCALISATION_HIGH 0.04

/* Negative eigenvalues of the symmetric solution; -1: it is not found. */
static inline PetscErrorCode NegativeUnderCompression(LamRVE rve, double e, PetscInt *negative)
{
  const LamLoad load = PlaneLoad(1, 0, 0, 1 - e, 0);
  PetscBool ok;

  PetscFunctionBeginUser;
  *negative = -1;
  PetscCall(SolveSymmetric(rve, &load, &ok));
  if (ok) PetscCall(LamFactorConsistent(rve, &load, negative, &ok));
  PetscFunctionReturn(0);
}

/* Where `wanted` waves of a row of n cells have become unstable. */
static inline PetscErrorCode WaveOnset(const LamMicrostructure *cell, PetscInt n, PetscInt wanted, double width,
                                       double *onset)
{
  LamMicrostructure micro = *cell;
  double low = LOCALISATION_LOW, high = LOCALISATION_HIGH;
  LamRVE rve;

  PetscFunctionBeginUser;
  micro.cells[0] = 1;
  micro.cells[1] = n;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &micro));
  PetscCall(LamRVESetUp(rve));
  while (high - low > width) {
    const double middle = 0.5 * (low + high);
    PetscInt negative;

    PetscCall(NegativeUnderCompression(rve, middle, &negative));
    PetscCheck(negative >= 0, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "no symmetric solution at %g", middle);
    *(negative < wanted ? &low : &high) = middle;
  }
  *onset = 0.5 * (low + high);
  PetscCall(LamRVEDestroy(&rve));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode LongestWaveOnset(const LamMicrostructure *cell, PetscInt n, double width, double *onset)
{
  PetscFunctionBeginUser;
  PetscCall(WaveOnset(cell, n, n - 1, width, onset));
  PetscFunctionReturn(0);
}

/* Where the tangent of one cell loses ellipticity, and the angle of the band's normal there, degrees. */
static inline PetscErrorCode EllipticityOnset(const LamMicrostructure *cell, double width, double *onset,
                                              double *normal)
{
  double low = LOCALISATION_LOW, high = LOCALISATION_HIGH;

  PetscFunctionBeginUser;
  while (high - low > width) {
    const LamLoad load = PlaneLoad(1, 0, 0, 1 - 0.5 * (low + high), 0);
    LamResponse response;

    PetscCall(SolveOnce(cell, &load, &response));
    *normal = LamBandAngle(response.localisation_normal);
    *(response.ellipticity > 0 ? &low : &high) = 0.5 * (low + high);
  }
  *onset = 0.5 * (low + high);
  PetscFunctionReturn(0);
}

/* e in onset(n) = e + a/n^2 + b/n^4, from three of them. */
static inline double LongWaveLimit(const int n[3], const double onset[3])
{
  double limit = 0;

  for (int i = 0; i < 3; i++) {
    double weight = 1;

    for (int j = 0; j < 3; j++)
      if (j != i) weight *= (0 - 1.0 / (n[j] * n[j])) / (1.0 / (n[i] * n[i]) - 1.0 / (n[j] * n[j]));
    limit += weight * onset[i];
  }
  return limit;
}

#endif
