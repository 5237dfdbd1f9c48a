#include "honeycomb.h"

#define WALL_MODULUS 4.0 /* E' in C1 + C2 */
LamMicrostructure Honeycomb(double h_l, int along, int through)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall.law = LAM_WALL_MOONEY_RIVLIN;
  micro.wall.bulk_modulus = 1000.0; /* the theory's wall is incompressible: O(1/kappa) */
  micro.wall_thickness = h_l / sqrt(3.0);
  micro.along = along;
  micro.through = through;
  return micro;
}

PetscErrorCode HoneycombModuli(double h_l, int along, int through, double ratio[3])
{
  const LamMicrostructure micro = Honeycomb(h_l, along, through);
  const LamLoad load = PlaneLoad(1, 0, 0, 1, 0);
  const double bending = WALL_MODULUS * pow(h_l, 3) / sqrt(3.0);
  LamResponse response;
  double A11, A12;

  PetscFunctionBeginUser;
  PetscCall(SolveOnce(&micro, &load, &response));
  A11 = response.tangent[0];
  A12 = response.tangent[4];
  ratio[0] = (A11 - A12) * (A11 + A12) / A11 / (4.0 * bending);
  ratio[1] = response.tangent[9 + 1] / bending;
  ratio[2] = 0.5 * (A11 + A12) / (WALL_MODULUS * h_l / (2.0 * sqrt(3.0)));
  PetscFunctionReturn(0);
}

PetscErrorCode PressurisedShearModulus(double h_l, double mu, int along, int through, double *ratio)
{
  const LamMicrostructure micro = Honeycomb(h_l, along, through);
  const double p = WALL_MODULUS * mu * mu * pow(h_l, 3) / (3.0 * sqrt(3.0));
  double stretch = 1.0;
  LamResponse response;

  PetscFunctionBeginUser;
  for (int it = 0; it < 20; it++) {
    const LamLoad load = PlaneLoad(stretch, 0, 0, stretch, p);

    PetscCall(SolveOnce(&micro, &load, &response));
    if (fabs(response.P[0]) < 1e-9 * p) break;
    stretch -= response.P[0] / (response.tangent[0] + response.tangent[4]);
  }
  *ratio = response.tangent[9 + 1] / (0.5 * p + p / (1.0 - tanh(mu) / mu));
  PetscFunctionReturn(0);
}
