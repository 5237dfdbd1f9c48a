#include "shear_exact.h"

double ShearFibreStrain(double psi, double s)
{
  return s * sin(psi) * (2.0 * cos(psi) + s * sin(psi));
}

ExactShear ShearStress(const LamWall *wall, double psi, double s, double p)
{
  const double m[2] = {cos(psi) + s * sin(psi), sin(psi)}, fibre = wall->C4 * ShearFibreStrain(psi, s);
  ExactShear out;

  out.sigma[0] = -p + wall->C1 * (1.0 + s * s) - wall->C2 + fibre * m[0] * m[0];
  out.sigma[1] = out.sigma[2] = (wall->C1 + wall->C2) * s + fibre * m[0] * m[1];
  out.sigma[3] = -p + wall->C1 - wall->C2 * (1.0 + s * s) + fibre * m[1] * m[1];
  out.sigma33 = -p + wall->C1 - wall->C2;
  out.P[0] = out.sigma[0] - s * out.sigma[1];
  out.P[1] = out.sigma[1];
  out.P[2] = out.sigma[2] - s * out.sigma[3];
  out.P[3] = out.sigma[3];
  out.P33 = out.sigma33;
  return out;
}

double ShearPressure(const LamWall *wall, double psi, double s, double sigma22)
{
  return ShearStress(wall, psi, s, 0.0).sigma[3] - sigma22;
}

FaceTraction ShearTraction(const ExactShear *stress, double s, const double N[2])
{
  const double v[2] = {N[0], N[1] - s * N[0]}; /* F^-T N */
  FaceTraction t;

  t.stretch = hypot(v[0], v[1]);
  for (int i = 0; i < 2; i++) {
    t.nominal[i] = stress->P[2 * i] * N[0] + stress->P[2 * i + 1] * N[1];
    t.cauchy[i] = (stress->sigma[2 * i] * v[0] + stress->sigma[2 * i + 1] * v[1]) / t.stretch;
  }
  t.normal = (t.cauchy[0] * v[0] + t.cauchy[1] * v[1]) / t.stretch;
  t.shear = (t.cauchy[1] * v[0] - t.cauchy[0] * v[1]) / t.stretch;
  return t;
}

double InterfaceNormal(const LamWall *wall, double psi, double s, double p)
{
  const double area = 1.0 + s * s, c = cos(psi);

  return -p + (wall->C1 - wall->C2 * (area * area + s * s) + wall->C4 * ShearFibreStrain(psi, s) * c * c) / area;
}

double InterfaceShear(const LamWall *wall, double psi, double s)
{
  const double area = 1.0 + s * s, c = cos(psi);

  return ((wall->C1 + wall->C2) * s + wall->C4 * ShearFibreStrain(psi, s) * c * (s * c + area * sin(psi))) / area;
}

double ShearFlow(const LamWall *wall, double psi, double s)
{
  return ShearStress(wall, psi, s, 0.0).sigma[1];
}

static double ShearEnergy(const LamWall *wall, double psi, double s)
{
  const double e = ShearFibreStrain(psi, s);

  return 0.5 * (wall->C1 + wall->C2) * s * s + 0.25 * wall->C4 * e * e;
}

double ShearOfStress(const LamWall *wall, double psi, double tau)
{
  const double c = cos(psi), S = sin(psi), modulus = wall->C1 + wall->C2;
  const double A = wall->C4 * pow(S, 4), B = modulus - wall->C4 * pow(S * c, 2);
  const double scale = sqrt(B / (3.0 * A));

  return 2.0 * scale * sinh(asinh(1.5 * (tau + modulus * c / S) / (B * scale)) / 3.0) - c / S;
}

double ShearProfile(const LamWall *wall, double psi, double a, double b, double X2)
{
  const double s0 = ShearOfStress(wall, psi, b), s1 = ShearOfStress(wall, psi, a * X2 + b);

  if (a == 0.0) return s0 * X2;
  return (s1 * (a * X2 + b) - ShearEnergy(wall, psi, s1) - s0 * b + ShearEnergy(wall, psi, s0)) / a;
}
