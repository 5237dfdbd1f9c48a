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
#ifndef LAM_SUPPORT_LOCALISATION_H
#define LAM_SUPPORT_LOCALISATION_H

#include "buckling.h"

/* Where `wanted` waves of a row of n cells have become unstable. */
PetscErrorCode WaveOnset(const LamMicrostructure *cell, PetscInt n, PetscInt wanted, double width, double *onset);
PetscErrorCode LongestWaveOnset(const LamMicrostructure *cell, PetscInt n, double width, double *onset);
/* Where the tangent of one cell loses ellipticity, and the angle of the band's normal there, degrees. */
PetscErrorCode EllipticityOnset(const LamMicrostructure *cell, double width, double *onset, double *normal);
/* e in onset(n) = e + a/n^2 + b/n^4, from three of them. */
double LongWaveLimit(const int n[3], const double onset[3]);

#endif
