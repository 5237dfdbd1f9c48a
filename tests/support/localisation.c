#include "localisation.h"
#include "tissue.h"

#define LOCALISATION_LOW 0.01
#define LOCALISATION_HIGH 0.04
/* Negative eigenvalues of the symmetric solution; -1: it is not found. */
static PetscErrorCode NegativeUnderCompression(LamRVE rve, double e, PetscInt *negative)
{
  const LamLoad load = PlaneLoad(1, 0, 0, 1 - e, 0);
  PetscBool ok;

  PetscFunctionBeginUser;
  *negative = -1;
  PetscCall(SolveSymmetric(rve, &load, &ok));
  if (ok) PetscCall(LamFactorConsistent(rve, &load, negative, &ok));
  PetscFunctionReturn(0);
}

PetscErrorCode WaveOnset(const LamMicrostructure *cell, PetscInt n, PetscInt wanted, double width, double *onset)
{
  LamMicrostructure micro = *cell;
  double low = LOCALISATION_LOW, high = LOCALISATION_HIGH;
  LamRVE rve;

  PetscFunctionBeginUser;
  micro.cells[0] = 1;
  micro.cells[1] = n;
  PetscCall(NewTissue(&micro, &rve, NULL));
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

PetscErrorCode LongestWaveOnset(const LamMicrostructure *cell, PetscInt n, double width, double *onset)
{
  PetscFunctionBeginUser;
  PetscCall(WaveOnset(cell, n, n - 1, width, onset));
  PetscFunctionReturn(0);
}

PetscErrorCode EllipticityOnset(const LamMicrostructure *cell, double width, double *onset, double *normal)
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

double LongWaveLimit(const int n[3], const double onset[3])
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
