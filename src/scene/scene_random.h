/*
  Private to scene reading: chance that falls the same way on every machine.

  Method. splitmix64 (Steele, Lea & Flood, OOPSLA 2014, Figure 12) and the transform of Box & Muller (Ann. Math. Stat.
  29, 1958). What comes out is rounded to six decimals, so that the last digit of a machine's logarithm is not seen.
*/
#ifndef LAM_SCENE_RANDOM_H
#define LAM_SCENE_RANDOM_H

#include <lamella/scene.h>

/* Every order with the same probability (Fisher and Yates). */
void LamRandomShuffle(PetscInt seed, PetscInt n, PetscInt values[]);

/*
  Lognormal factors with mean 1 and the coefficients of variation variation[properties], independent of each other:
  factors[property][cell] (row-major, all cells of `micro`). They are exp(s z - s^2/2), s^2 = ln(1 + variation^2), with
  z standard normal. correlation 0: z of all cells independent. Else white noise is weighted with exp(-2
  (r/correlation)^2), r in distances of neighbours, and scaled back to unit variance, so that the z of two cells have
  about the correlation exp(-(r/correlation)^2); in a period the noise repeats with it. Properties without variation
  have the factor 1 and take nothing from the others' noise.
*/
PetscErrorCode LamRandomFactors(const LamMicrostructure *micro, PetscInt seed, PetscReal correlation,
                                PetscInt properties, const PetscReal variation[], PetscReal factors[]);

#endif
