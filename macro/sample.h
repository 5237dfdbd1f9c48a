/*
  Estimate of a sum over many items from a few of them.
*/
#ifndef LAM_SAMPLE_H
#define LAM_SAMPLE_H

#include <petscsys.h>

/*
  Draws about `wanted` of N items, with the expected number of draws of item i in proportion to size[i] >= 0
  (one from each of equal parts of the cumulated sizes, in the order of the items). The largest, which would be drawn
  for certain, are drawn once, but at most half of `wanted` are; draws[i] = -1. Of the others draws[i] >= 0 counts the
  draws, and share[i] is size over their total. *drawn: number of those draws; 0: no item is left to chance.
*/
PetscErrorCode LamSampleDraw(PetscInt N, const PetscReal size[], PetscInt wanted, PetscInt64 seed, PetscInt draws[],
                             PetscReal share[], PetscInt *drawn);
/* Reproducible number k < 2^20 of a seed, in [0, 1). */
PetscReal LamSampleRandom(PetscInt64 seed, PetscInt k);
/* Estimated sum of value[i], of which only those drawn are read, and half the width of its 99 % confidence interval;
   infinite for a single draw. */
void LamSampleSum(PetscInt N, const PetscInt draws[], const PetscReal share[], PetscInt drawn, const PetscReal value[],
                  PetscReal *sum, PetscReal *margin);
/* |t| that Student's t with this number of degrees of freedom exceeds with probability 1 %. */
PetscReal LamSampleStudent(PetscInt freedom);

#endif
