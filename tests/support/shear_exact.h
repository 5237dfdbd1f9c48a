/*
  Generalised shear x1 = X1 + f(X2), x2 = X2, x3 = X3 of the incompressible wall, in closed form; derived in
  docs/results/paper.md.

  With s = f'(X2), fibres M = (cos psi, sin psi, 0), e = I4 - 1 = s sin psi (2 cos psi + s sin psi):
    sigma = -p I + C1 B - C2 B^-1 + C4 e FM (x) FM,      P = sigma F^-T,      p a pressure that equilibrium fixes.
  Components in the plane are in the order 11 12 21 22; stresses in C1 + C2, lengths in the height of the strip.
*/
#ifndef LAM_SUPPORT_SHEAR_EXACT_H
#define LAM_SUPPORT_SHEAR_EXACT_H

#include <math.h>
#include <lamella/scene.h>

typedef struct {
  double sigma[4], sigma33; /* Cauchy */
  double P[4], P33;         /* first Piola-Kirchhoff; nominal tractions are P N */
} ExactShear;

/* I4 - 1. */
double ShearFibreStrain(double psi, double s);
ExactShear ShearStress(const LamWall *wall, double psi, double s, double p);
/* The p of a given sigma22, the component that equilibrium knows. */
double ShearPressure(const LamWall *wall, double psi, double s, double sigma22);
/* The traction on a material plane of unit reference normal N, on the side that N leaves. */
typedef struct {
  double nominal[2];    /* P N, force per reference area */
  double cauchy[2];     /* sigma n, force per current area */
  double stretch;       /* current over reference area */
  double normal, shear; /* of cauchy: along n, and along n turned by +90 degrees */
} FaceTraction;

FaceTraction ShearTraction(const ExactShear *stress, double s, const double N[2]);
/* Cauchy traction on a plane X1 = const, the interface of two walls side by side, without the detour over sigma. */
double InterfaceNormal(const LamWall *wall, double psi, double s, double p);
double InterfaceShear(const LamWall *wall, double psi, double s);
/* sigma12 and its energy W(s), d W / d s = sigma12. */
double ShearFlow(const LamWall *wall, double psi, double s);

/*
  The s of a given sigma12 = tau, where sigma12 rises with s, C1 + C2 > C4 (sin psi cos psi)^2. With u = s + cot psi the
  cubic has no square:  A u^3 + B u = tau + (C1 + C2) cot psi,  A = C4 sin^4 psi,  B = C1 + C2 - C4 (sin psi cos psi)^2.
*/
double ShearOfStress(const LamWall *wall, double psi, double tau);
/* f(X2) with f(0) = 0 of sigma12 = a X2 + b: the complementary energy [s tau - W(s)] / a, or s X2 where a = 0. */
double ShearProfile(const LamWall *wall, double psi, double a, double b, double X2);

#endif
