/* Prints where waves of n cells lose stability under uniaxial compression, and where the tangent loses ellipticity. */
#include <stdio.h>
#include "support/localisation.h"

static PetscErrorCode Run(PetscInt along, PetscInt through)
{
  LamMicrostructure micro = DefaultTissue();
  double onset[9] = {0}, first = 0, lost = 0, normal = 0;

  PetscFunctionBeginUser;
  micro.along = along;
  micro.through = through;
  PetscCall(EllipticityOnset(&micro, 1e-7, &lost, &normal));
  printf("%d x %d: ellipticity is lost at e = %.6f, normal at %.3f degrees\n", (int)along, (int)through, lost, normal);
  for (PetscInt n = 2; n <= 8; n++) {
    PetscCall(WaveOnset(&micro, n, 1, 1e-6, &first));
    PetscCall(LongestWaveOnset(&micro, n, 1e-6, &onset[n]));
    printf("1 x %d cells: first wave %.6f, longest wave %.6f, (lost - longest) n^2 %.5f\n", (int)n, first, onset[n],
           (lost - onset[n]) * (double)(n * n));
  }
  printf("limit of long waves from 4, 6, 8: %.6f; from 6, 7, 8: %.6f\n",
         LongWaveLimit((const int[3]){4, 6, 8}, (const double[3]){onset[4], onset[6], onset[8]}),
         LongWaveLimit((const int[3]){6, 7, 8}, &onset[6]));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  printf("dry tissue, F = diag(1, 1 - e), t/a = 0.15\n");
  if (Run(4, 1) || Run(6, 2)) return 1;
  return PetscFinalize() ? 1 : 0;
}
