/*
  Private to `lamella build`: which states are sampled, and how one is solved.
*/
#ifndef LAM_BUILD_H
#define LAM_BUILD_H

#include "app.h"

/*
  The state number `index` (0, 1, ...) of the scene's sample box: point index + 1 of the Halton sequence with bases
  2, 3, 5, 7 for two principal logarithmic strains, the angle between the first and face normal 0, and turgor. F is the
  right stretch U. With six-fold symmetry 30 degrees of angle are all there is, else 90.
  Source: J. H. Halton, Numer. Math. 2 (1960) 84-90.
*/
void LamSampleLoad(const LamScene *scene, PetscInt64 index, LamLoad *load);

/* Every rank has one. */
typedef struct {
  const LamScene *scene; /* borrowed */
  LamRVE rve;            /* owned */
  LamRVEState state;     /* owned */
} LamSampler;

PetscErrorCode LamSamplerCreate(const LamScene *scene, LamSampler *sampler);
/* A LamWork (dispatch.h): `result` is a LamResponse. Each state starts from the stress-free reference. */
PetscErrorCode LamSamplerSolve(void *sampler, PetscInt64 index, void *result);
PetscErrorCode LamSamplerDestroy(LamSampler *sampler);

#endif
