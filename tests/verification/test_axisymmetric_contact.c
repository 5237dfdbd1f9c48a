/*
  Rigid probes on an elastic half space in the limit of small strain: Sneddon's flat punch F = 2 E* a d, and Hertz's
  sphere F = 4/3 E* R^1/2 d^3/2, a^2 = R d. E* = E / (1 - nu^2).

  The half space is a cylinder some ten times as large as the contact, held at its bottom: its elements are as even as
  the contact needs them up to twice its radius, and then grow like a geometric series. A body of size L is stiffer by a
  share in proportion to a/L, since displacements fall with 1/r: bodies of two sizes tell the half space's force.
*/
#include "support/gmsh_writer.h"
#include "support/macro_fixture.h"
#include "macro_impl.h"

static const PetscReal E_STAR = 3; /* of the synthetic material, mu = 1, lambda = 2: nu = 1/3, E = 8/3 */
static const double DEEP = 1e-3;   /* over the radius of the contact */
static double Large;               /* the body's size */
enum { FINE = 24, COARSE = 10 };   /* elements up to twice the radius of the contact, and beyond */

/* From the number of an edge over that of all: even up to 2, then geometric up to `Large`. */
static double Distance(double share)
{
  const double k = share * (FINE + COARSE) - FINE;

  return k <= 0 ? 2 + 2 * k / FINE : 2 * pow(Large / 2, k / COARSE);
}

static void HalfSpace(double X[2])
{
  X[0] = Distance(X[0]);
  X[1] = -Distance(1 - X[1]);
}

/* Edges of elements shrink towards the punch's, at 1, where stress is singular: as the cube of their distance. */
static void PunchedSpace(double X[2])
{
  const double r = Distance(X[0]), aside = r - 1;

  X[0] = r < 2 ? 1 + aside * aside * aside : r;
  X[1] = -Distance(1 - X[1]);
  if (X[1] > -1) X[1] *= X[1] * X[1];
}

static PetscReal ForceOfBody(GmshMap map, PetscReal radius, PetscBool shaft)
{
  FIXTURE fixture;
  LamBoundary *indenter;

  FixtureScene(&fixture, 1, 1, 1, 1);
  fixture.scene.macro.symmetry = LAM_AXISYMMETRIC;
  fixture.scene.macro.source = LAM_MESH_GMSH;
  GmshWrite(fixture.scene.macro.gmsh, FINE + COARSE, FINE + COARSE, GMSH_QUADRILATERALS, map);
  FixtureBoundary(&fixture, "bottom", 0, 0);
  FixtureIndenter(&fixture, radius, 0, 0, 0, -DEEP);
  indenter = &fixture.scene.macro.boundary[1];
  indenter->shaft = shaft;
  FixtureRun(&fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  remove(fixture.scene.macro.gmsh);
  return -FixtureReaction(&fixture, "top")[1];
}

/* Of a half space. */
static PetscReal Force(GmshMap map, PetscReal radius, PetscBool shaft)
{
  PetscReal force[2];

  for (int k = 0; k < 2; k++) {
    Large = k ? 60 : 30;
    force[k] = ForceOfBody(map, radius, shaft);
  }
  return 2 * force[1] - force[0];
}

TEST(FlatPunchIsSneddon)
{
  const PetscReal force = Force(PunchedSpace, 1, PETSC_TRUE), sneddon = 2 * E_STAR * DEEP;

  assert_near(force / sneddon, 1, 1e-3); /* 0.99996 */
}

TEST(SphereIsHertz)
{
  const PetscReal radius = 1 / DEEP, force = Force(HalfSpace, radius, PETSC_FALSE),
                  hertz = 4. / 3 * E_STAR * sqrt(radius) * pow(DEEP, 1.5);

  assert_near(force / hertz, 1, 1e-3); /* 1.00000 */
}
