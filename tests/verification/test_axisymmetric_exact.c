/*
  Bodies against exact solutions: a thick-walled cylinder and a thick-walled sphere under inner pressure at large
  strain, of a compressible material.

  With the stretches l = dr/dR and t = r/R of principal stresses P_l, P_t the equilibrium is

    dP_l/dR + k (P_l - P_t) / R = 0,  dt/dR = (l - t) / R,  k = 1: cylinder of fixed length, 2: sphere,

  an ordinary differential equation for l and t, integrated from the outer side, which is free, by the classical
  Runge-Kutta method with so many steps that its error is below that of the finite elements.
*/
#include "support/gmsh_writer.h"
#include "support/macro_fixture.h"

enum { STEPS = 4000 };
static const PetscReal OUTER = 2; /* radius; the inner one is 1 */

/* The material at stretches l along the radius and t around. */
static LamResponse At(PetscInt k, PetscReal l, PetscReal t)
{
  const Synthetic material = {.mu = 1, .lambda = 2, .phi = 1}; /* as SyntheticCreate */
  const LamLoad load = {.F = {l, 0, 0, 0, k == 1 ? 1 : t, 0, 0, 0, t}};
  LamResponse r;

  CHECK(LamResponseInit(&load, &r));
  SyntheticEvaluate(&material, &load, &r);
  return r;
}

/* dl/dR and dt/dR. */
static void Slope(PetscInt k, PetscReal R, const PetscReal y[2], PetscReal slope[2])
{
  const LamResponse r = At(k, y[0], y[1]);
  const PetscReal by_t = r.tangent[8] + (k == 2 ? r.tangent[4] : 0);

  slope[1] = (y[0] - y[1]) / R;
  slope[0] = (-(PetscReal)k * (r.P[0] - r.P[8]) / R - by_t * slope[1]) / r.tangent[0];
}

/* From a stretch around the outer side inwards: stretches at the inner side, and the pressure there. */
static PetscReal InnerPressure(PetscInt k, PetscReal outer, PetscReal y[2])
{
  const PetscReal h = -(OUTER - 1) / STEPS;
  LamResponse r;

  y[0] = 1;
  y[1] = outer;
  for (int it = 0; it < 50; it++) {
    r = At(k, y[0], y[1]);
    y[0] -= r.P[0] / r.tangent[0];
  }
  for (int step = 0; step < STEPS; step++) {
    const PetscReal R = OUTER + step * h;
    PetscReal s[4][2], z[2];
    Slope(k, R, y, s[0]);
    for (int stage = 1; stage < 4; stage++) {
      const PetscReal share = stage == 3 ? h : 0.5 * h;
      for (int i = 0; i < 2; i++) z[i] = y[i] + share * s[stage - 1][i];
      Slope(k, R + share, z, s[stage]);
    }
    for (int i = 0; i < 2; i++) y[i] += h / 6 * (s[0][i] + 2 * s[1][i] + 2 * s[2][i] + s[3][i]);
  }
  r = At(k, y[0], y[1]);
  return -r.P[0] / (k == 1 ? y[1] : y[1] * y[1]);
}

/* r/R of the inner side under this pressure. */
static PetscReal ExactStretch(PetscInt k, PetscReal pressure)
{
  PetscReal low = 1, high = 1.3, y[2];

  for (int it = 0; it < 50; it++) {
    const PetscReal middle = 0.5 * (low + high);
    if (InnerPressure(k, middle, y) < pressure)
      low = middle;
    else
      high = middle;
  }
  return y[1];
}

static void Ring(double X[2])
{
  X[0] = 1 + X[0];
}

/* The polar grid of a quarter: the left side is inside, the bottom in the plane X2 = 0, the top on the axis. */
static void Shell(double X[2])
{
  const double radius = 1 + X[0], angle = 0.5 * PETSC_PI * X[1];

  X[0] = X[1] == 1 ? 0 : radius * cos(angle);
  X[1] = radius * sin(angle);
}

/* Of the inner side's r/R at its end in the plane X2 = 0. Plane: a quarter of the cylinder's section. */
static PetscReal Error(PetscInt k, PetscBool plane, GmshElements elements, PetscInt n, PetscReal pressure)
{
  FIXTURE fixture;
  LamBoundary *boundary;
  PetscReal error = NAN;

  FixtureScene(&fixture, 1, 1, 1, 3);
  if (!plane) fixture.scene.macro.symmetry = LAM_AXISYMMETRIC;
  fixture.scene.macro.source = LAM_MESH_GMSH;
  GmshWrite(fixture.scene.macro.gmsh, n, k == 1 && !plane ? 1 : n, elements, k == 1 && !plane ? Ring : Shell);
  FixtureBoundary(&fixture, "bottom", NAN, 0);
  if (plane) FixtureBoundary(&fixture, "top", 0, NAN);
  if (k == 1 && !plane) FixtureBoundary(&fixture, "top", NAN, 0);
  boundary = FixtureAdd(&fixture, "left", LAM_BOUNDARY_PRESSURE);
  boundary->traction[1] = -pressure;
  boundary->follower = PETSC_TRUE;
  FixtureRun(&fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  remove(fixture.scene.macro.gmsh);
  const LamMacroFields *fields = FixtureFields(&fixture);
  for (PetscInt node = 0; node < fields->node_count; node++)
    if (fields->nodes[2 * node] == 1 && fields->nodes[2 * node + 1] == 0)
      error = 1 + fields->u[2 * node] - ExactStretch(k, pressure);
  return PetscAbsReal(error);
}

/* Displacements at vertices of quadratic elements converge with order 4. */
TEST(ThickWalledCylinder)
{
  PetscReal error[3];

  for (int i = 0; i < 3; i++) error[i] = Error(1, PETSC_FALSE, GMSH_CURVED, 4 << i, 0.5);
  assert_true(error[2] < 5e-9); /* 7.4e-7, 5.4e-8, 3.5e-9: order 3.95 */
  assert_true(log2(error[1] / error[2]) > 3.8);
}

TEST(ThickWalledSphere)
{
  PetscReal error[3];

  for (int i = 0; i < 3; i++) error[i] = Error(2, PETSC_FALSE, GMSH_CURVED, 4 << i, 0.5);
  assert_true(error[2] < 2e-7); /* 3.0e-5, 1.8e-6, 1.2e-7: order 3.99 */
  assert_true(log2(error[1] / error[2]) > 3.8);
}

/* Curved triangles of six nodes, and mixed with quadrilaterals of eight and nine: the section of the cylinder. */
TEST(CurvedTriangles)
{
  static const GmshElements kinds[2] = {GMSH_CURVED_TRIANGLES, GMSH_CURVED_MIXED};

  for (int kind = 0; kind < 2; kind++) {
    PetscReal error[3];

    for (int i = 0; i < 3; i++) error[i] = Error(1, PETSC_TRUE, kinds[kind], 4 << i, 0.5);
    assert_true(error[2] < (kind ? 5e-7 : 5e-6)); /* 3.6e-6: order 2.9; mixed 3.6e-7: order 3.1 */
    assert_true(log2(error[1] / error[2]) > 2.8);
  }
}
