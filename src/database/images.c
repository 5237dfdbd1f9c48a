/*
  The symmetry of the tissue: rotated and mirrored loads with equivalent responses.
*/
#include "database_internal.h"
#include <lamella/tissue.h>
#include <math.h>

/* A mirror at face normal 0, then a rotation by 60 degrees * turn; c1 + i c2 rotates by the doubled angle. */
static void AddImage(const LamMicrostructure *micro, PetscBool mirror, PetscInt turn, LamImages *images)
{
  const PetscReal angle = 2 * PETSC_PI / 3 * (PetscReal)turn + (mirror ? 4 * micro->orientation : 0);
  const PetscReal c = cos(angle), s = sin(angle), sign = mirror ? -1 : 1;
  const PetscInt i = images->count++;

  images->map[i][0][0] = c;
  images->map[i][0][1] = -sign * s;
  images->map[i][1][0] = s;
  images->map[i][1][1] = sign * c;
  for (PetscInt k = 0; k < 3; k++) images->face[i][k] = ((mirror ? 3 - k : k) + turn) % 3;
}

PetscErrorCode LamImagesMake(const LamMicrostructure *micro, LamImages *images)
{
  LamSymmetry symmetry;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureSymmetry(micro, &symmetry));
  images->count = 0;
  for (int i = 0; i < LAM_MAX_IMAGES; i++) {
    const PetscBool mirror = (PetscBool)(i >= 3);

    if (LamSymmetryOfStrain(&symmetry, mirror, i % 3)) AddImage(micro, mirror, i % 3, images);
  }
  PetscFunctionReturn(0);
}

void LamImagesForward(const LamImages *images, PetscInt image, const PetscReal x[LAM_VARIABLES],
                      PetscReal y[LAM_VARIABLES])
{
  const PetscReal(*M)[2] = images->map[image];

  y[0] = x[0];
  y[1] = M[0][0] * x[1] + M[0][1] * x[2];
  y[2] = M[1][0] * x[1] + M[1][1] * x[2];
  for (int a = 3; a < LAM_VARIABLES; a++) y[a] = x[a];
}

void LamImagesBack(const LamImages *images, PetscInt image, PetscReal g[LAM_VARIABLES])
{
  const PetscReal(*M)[2] = images->map[image];
  const PetscReal y[2] = {g[1], g[2]};

  g[1] = M[0][0] * y[0] + M[1][0] * y[1];
  g[2] = M[0][1] * y[0] + M[1][1] * y[1];
}

void LamImagesBackHessian(const LamImages *images, PetscInt image, PetscReal H[LAM_VARIABLES][LAM_VARIABLES])
{
  for (int pass = 0; pass < 2; pass++) { /* columns, then rows */
    for (int a = 0; a < LAM_VARIABLES; a++) LamImagesBack(images, image, H[a]);
    for (int a = 0; a < LAM_VARIABLES; a++)
      for (int b = 0; b < a; b++) {
        const PetscReal swap = H[a][b];

        H[a][b] = H[b][a];
        H[b][a] = swap;
      }
  }
}
