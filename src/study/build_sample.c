/*
  The states of a sample box: a low-discrepancy sequence. State i does not depend on the number of states.
*/
#include "build.h"
#include <math.h>

/* Radical inverse: the digits of i in the given base, mirrored at the radix point. */
static PetscReal RadicalInverse(PetscInt64 i, PetscInt64 base)
{
  PetscReal place = 1, sum = 0;

  for (; i; i /= base) {
    place /= (PetscReal)base;
    sum += place * (PetscReal)(i % base);
  }
  return sum;
}

static PetscReal Between(PetscReal min, PetscReal max, PetscReal share)
{
  return min + (max - min) * share;
}

void LamSampleLoad(const LamScene *scene, PetscInt64 index, LamLoad *load)
{
  const LamSample *box = &scene->sample;
  const LamMicrostructure *micro = &scene->micro;
  const PetscReal wedge = micro->cells[0] == micro->cells[1] && !micro->cell ? PETSC_PI / 6 : PETSC_PI / 2;
  const PetscReal e0 = exp(Between(box->stretch_min, box->stretch_max, RadicalInverse(index + 1, 2)));
  const PetscReal e1 = exp(Between(box->stretch_min, box->stretch_max, RadicalInverse(index + 1, 3)));
  const PetscReal angle = micro->orientation + wedge * RadicalInverse(index + 1, 5);
  const PetscReal c = cos(angle), s = sin(angle);
  const PetscReal U11 = c * c * e0 + s * s * e1, U12 = c * s * (e0 - e1), U22 = s * s * e0 + c * c * e1;

  *load = (LamLoad){.F = {U11, U12, 0, U12, U22, 0, 0, 0, 1},
                    .turgor = Between(box->turgor_min, box->turgor_max, RadicalInverse(index + 1, 7)),
                    .cohesion = scene->cohesion};
}
