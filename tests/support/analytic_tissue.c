#include "analytic_tissue.h"

/* ---- numbers with their first and second derivatives ---- */

enum { VARIABLES = 7 };

typedef struct {
  double v, g[VARIABLES], h[VARIABLES][VARIABLES];
} Number;

static Number Constant(double v)
{
  return (Number){.v = v};
}

static Number Variable(double v, int k)
{
  Number a = {.v = v};

  a.g[k] = 1;
  return a;
}

/* a + factor b */
static Number Sum(Number a, double factor, Number b)
{
  a.v += factor * b.v;
  for (int i = 0; i < VARIABLES; i++) {
    a.g[i] += factor * b.g[i];
    for (int j = 0; j < VARIABLES; j++) a.h[i][j] += factor * b.h[i][j];
  }
  return a;
}

static Number Times(Number a, Number b)
{
  Number c = {.v = a.v * b.v};

  for (int i = 0; i < VARIABLES; i++) {
    c.g[i] = a.v * b.g[i] + a.g[i] * b.v;
    for (int j = 0; j < VARIABLES; j++)
      c.h[i][j] = a.v * b.h[i][j] + a.h[i][j] * b.v + a.g[i] * b.g[j] + a.g[j] * b.g[i];
  }
  return c;
}

/* A function of a with these derivatives there. */
static Number Of(Number a, double f, double f1, double f2)
{
  Number c = {.v = f};

  for (int i = 0; i < VARIABLES; i++) {
    c.g[i] = f1 * a.g[i];
    for (int j = 0; j < VARIABLES; j++) c.h[i][j] = f1 * a.h[i][j] + f2 * a.g[i] * a.g[j];
  }
  return c;
}

static Number Exp(Number a)
{
  return Of(a, exp(a.v), exp(a.v), exp(a.v));
}

static Number Log(Number a)
{
  return Of(a, log(a.v), 1 / a.v, -1 / (a.v * a.v));
}

static Number Polynomial(int degree, const double c[], Number x)
{
  double y[3] = {0};

  for (int i = degree; i >= 0; i--) {
    y[2] = y[2] * x.v + 2 * y[1];
    y[1] = y[1] * x.v + y[0];
    y[0] = y[0] * x.v + c[i];
  }
  return Of(x, y[0], y[1], y[2]);
}

/* ---- the potential ---- */

static const double tissue_width[4] = {-0.04, 0.02, 0.006, 0.001}; /* a, of tau */

static const double tissue_free_energy[6] = {0.1, -1.0, -0.7, 0.4, -0.3, 0.2}; /* E, of s */

static const double tissue_turgor[4] = {0.02, 0.01, -0.004, 0.002}; /* T, of tau */

static const double tissue_turgor2[4] = {0.01, 0.004, 0.003, -0.001}; /* W, of tau */

/* Sums of products of one, two and three of them. */
static void Symmetric(const Number x[3], Number e[3])
{
  e[0] = Sum(Sum(x[0], 1, x[1]), 1, x[2]);
  e[1] = Sum(Sum(Times(x[0], x[1]), 1, Times(x[1], x[2])), 1, Times(x[2], x[0]));
  e[2] = Times(x[0], Times(x[1], x[2]));
}

/* z = ln F33, 0 in plane strain */
static Number BondedEnergy(const Number x[3], Number z, Number p)
{
  const Number d = Sum(p, -1, Constant(TISSUE_P0));
  Number e[3], phi, T, W;

  Symmetric(x, e);
  phi = Sum(Sum(Exp(Sum(Constant(-0.5), -1, e[0])), 0.5, e[1]), 0.8, e[2]);
  for (int k = 0; k < 3; k++) phi = Sum(phi, 0.25, Exp(Of(x[k], 3 * x[k].v, 3, 0)));
  T = Sum(Sum(Constant(0.3), 0.05, e[1]), 0.2, e[2]);
  W = Sum(Constant(0.01), 0.02, e[0]);
  phi = Sum(Sum(phi, 0.9, Times(z, z)), 0.6, Times(Exp(z), Times(z, e[1])));
  phi = Sum(Sum(phi, 0.5, Times(z, e[2])), -0.4, Times(z, Exp(e[0])));
  T = Sum(Sum(T, 0.1, z), 0.03, Times(z, e[0]));
  W = Sum(W, 0.01, z);
  return Sum(Sum(phi, 1, Times(d, T)), 0.5, Times(Times(d, d), W));
}

/* y^2 (1 - y) where walls are pressed together; where they only touch up to rounding, on that side, too */
static Number Pressed(Number y)
{
  return y.v < 1e-12 ? Of(y, y.v * y.v * (1 - y.v), 2 * y.v - 3 * y.v * y.v, 2 - 6 * y.v) : Constant(0);
}

static Number Tau(Number s)
{
  return Log(Sum(Constant(1), 32 / TISSUE_SUCTION, s));
}

/* a, where cells touch */
static Number Width(Number tau, Number z)
{
  const Number a = Polynomial(3, tissue_width, tau);

  return Sum(Sum(Sum(a, -0.3, z), 0.1, Times(z, z)), -0.01, Times(z, tau));
}

static Number ContactEnergy(const Number x[3], Number s, Number z, Number d)
{
  const Number tau = Tau(s), a = Width(tau, z), T0 = Sum(Polynomial(3, tissue_turgor, tau), 0.01, Times(z, tau));
  const Number W = Sum(Polynomial(3, tissue_turgor2, tau), 0.003, z);
  Number r[3], e[3], phi, T;

  for (int k = 0; k < 3; k++) r[k] = Pressed(Sum(x[k], -1, a));
  Symmetric(r, e);
  phi = Sum(Polynomial(5, tissue_free_energy, s), 1, Times(Sum(Constant(2), 3, s), e[0]));
  phi = Sum(Sum(phi, 5, e[1]), 8, Times(s, e[2]));
  phi = Sum(Sum(Sum(phi, 0.3, Times(z, z)), 0.2, Times(z, s)), 0.7, Times(z, e[0]));
  T = Sum(Sum(T0, 0.05, Times(tau, e[0])), 0.02, Times(z, e[0]));
  return Sum(Sum(phi, 1, Times(d, T)), 0.5, Times(Times(d, d), W));
}

/* Psi; *across: P33. */
static Number TissueEnergy(const AnalyticTissue *tissue, const LamLoad *load, Number *across)
{
  const Number F[4] = {Variable(load->F[0], 0), Variable(load->F[1], 1), Variable(load->F[3], 2),
                       Variable(load->F[4], 3)};
  const Number p = Variable(load->turgor, 4), g = Variable(load->cohesion, 5), s = Sum(p, 1, g);
  const Number F33 = tissue->axial ? Variable(load->F[8], 6) : Constant(1), z = Log(F33);
  const Number J = Times(F33, Sum(Times(F[0], F[3]), -1, Times(F[1], F[2])));
  Number x[3];

  for (int k = 0; k < 3; k++) {
    const double angle = tissue->orientation + k * acos(-1) / 3;
    const Number f = Sum(Times(Constant(cos(angle)), F[0]), sin(angle), F[1]);
    const Number e = Sum(Times(Constant(cos(angle)), F[2]), sin(angle), F[3]);
    const Number log_square = Log(Sum(Times(f, f), 1, Times(e, e)));

    x[k] = Of(log_square, 0.5 * log_square.v, 0.5, 0);
  }
  if (tissue->contact) {
    *across = Sum(Times(g, J), 0.3, s);
    return Sum(ContactEnergy(x, s, z, Sum(Constant(TISSUE_G0), -1, g)), 1, Times(g, J));
  }
  *across = Sum(Sum(Sum(x[0], 1, x[1]), 1, x[2]), -1, Times(p, J));
  return Sum(BondedEnergy(x, z, p), -1, Times(p, J));
}

/* ---- the answer ---- */

/* P33 as a number, with its own first derivatives alone. */
static Number Across(Number psi)
{
  Number across = {.v = psi.g[6]};

  for (int i = 0; i < VARIABLES; i++) across.g[i] = psi.h[6][i];
  return across;
}

static void FillDerivatives(Number psi, Number across, PetscReal stiffness, LamResponse *r)
{
  static const int in_plane[4] = {0, 1, 3, 4};

  for (int i = 0; i < 9; i++) r->P[i] = r->P_turgor[i] = r->P_cohesion[i] = 0;
  for (int i = 0; i < 4; i++) {
    r->P[in_plane[i]] = psi.g[i];
    r->P_turgor[in_plane[i]] = psi.h[i][4];
    r->P_cohesion[in_plane[i]] = psi.h[i][5];
    for (int j = 0; j < 4; j++) r->tangent[9 * in_plane[i] + in_plane[j]] = psi.h[i][j];
    r->tangent[72 + in_plane[i]] = r->tangent[9 * in_plane[i] + 8] = across.g[i];
  }
  r->P[8] = across.v;
  r->P_turgor[8] = across.g[4];
  r->P_cohesion[8] = across.g[5];
  r->tangent[80] = stiffness;
}

LamResponse TissueAnswer(const AnalyticTissue *tissue, const LamLoad *load)
{
  Number across, psi = TissueEnergy(tissue, load, &across);
  LamResponse r;

  (void)LamResponseInit(load, &r);
  r.status = LAM_CONVERGED;
  r.stable = PETSC_TRUE;
  if (tissue->axial) across = Across(psi);
  FillDerivatives(psi, across, tissue->axial ? across.g[6] : 1, &r);
  r.energy = psi.v;
  r.energy_turgor = psi.g[4];
  r.energy_cohesion = psi.g[5];
  r.energy_turgor2 = psi.h[4][4];
  r.energy_cohesion2 = psi.h[5][5];
  r.energy_turgor_cohesion = psi.h[4][5];
  return r;
}

PetscErrorCode TissueRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                             LamResponse responses[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const Number s = Constant(loads[i].turgor + loads[i].cohesion);
    const double gap = 2 * (loads[i].F[0] - exp(Width(Tau(s), Constant(log(loads[i].F[8]))).v));

    responses[i] = TissueAnswer(ctx, &loads[i]);
    responses[i].min_gap = fmax(0, gap);
    responses[i].floating_cells = gap > 0;
  }
  PetscFunctionReturn(0);
}
