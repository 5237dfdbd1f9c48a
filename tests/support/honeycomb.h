/*
  Moduli of thin-walled honeycombs against beam theory: what the test asserts and the bench program prints.

  Walls of the plain law; side l = 2a/sqrt(3), double wall h = 2t, E' = 4 (C1 + C2) the plane-strain modulus of the
  incompressible wall. Gibson & Ashby, Cellular Solids, ch. 4, for a regular honeycomb:
    E* = (4/sqrt 3) E' (h/l)^3,  G* = (1/sqrt 3) E' (h/l)^3,  K* = E' h / (2 sqrt 3 l).
  Under pressure p with the macroscopic stress zero, the walls are beams under the tension sqrt(3) p l:
    G(p) = p/2 + p / (1 - tanh(mu)/mu),  mu^2 = 3 sqrt(3) (p/E') (l/h)^3.
*/
#ifndef LAM_SUPPORT_HONEYCOMB_H
#define LAM_SUPPORT_HONEYCOMB_H

#include "tissue.h"

LamMicrostructure Honeycomb(double h_l, int along, int through);
/* E*, G*, K* at F = I without pressure, each over its theoretical value. */
PetscErrorCode HoneycombModuli(double h_l, int along, int through, double ratio[3]);
/* Shear modulus under the pressure that belongs to mu, at the stretch where the stress vanishes, over its theoretical
   value. */
PetscErrorCode PressurisedShearModulus(double h_l, double mu, int along, int through, double *ratio);

#endif
