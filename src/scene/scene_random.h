/*
  Private to scene reading: random numbers that are equal on all machines.

  Method. splitmix64 (Steele, Lea & Flood, OOPSLA 2014, Figure 12) and the transform of Box & Muller (Ann. Math. Stat.
  29, 1958). Results are rounded to six decimals, which hides differences in the last digit of a machine's logarithm.
*/
#ifndef LAM_SCENE_RANDOM_H
#define LAM_SCENE_RANDOM_H

#include <lamella/scene.h>

/* Random permutation with uniform probability (Fisher and Yates). */
void LamRandomShuffle(PetscInt seed, PetscInt n, PetscInt values[]);

/*
  Lognormal factors with mean 1 and the coefficients of variation variation[properties], independent between
  properties: factors[property][cell] (row-major, all cells of `micro`). They are exp(s z - s^2/2), s^2 = ln(1 +
  variation^2), with z standard normal. correlation 0: z of all cells are independent. Otherwise white noise is
  weighted with exp(-2 (r/correlation)^2), r in neighbour distances, and scaled to unit variance, so that the
  correlation of z between two cells is about exp(-(r/correlation)^2); in a period the noise is periodic. Properties
  without variation have the factor 1 and do not affect the noise of the others.
*/
PetscErrorCode LamRandomFactors(const LamMicrostructure *micro, PetscInt seed, PetscReal correlation,
                                PetscInt properties, const PetscReal variation[], PetscReal factors[]);

#endif
