/* The cubic of generalised shear, Section 3 of Mihai, Safar & Wyatt, against a strip of wall elements
 * (docs/results/paper.md).
 */
#include "support/rve_fixture.h"
#include "support/gap_between_walls.h"

#define INCOMPRESSIBLE 1e8 /* bulk modulus over C1 + C2: no part in the errors of these meshes */

static StripErrors coarse, fine; /* 8 and 16 rows */

static int Solve(void **state)
{
  return ComputeStrip(DefaultStrip(8, INCOMPRESSIBLE), &coarse) ||
         ComputeStrip(DefaultStrip(16, INCOMPRESSIBLE), &fine);
}

TEST(DisplacementConvergesWithOrderThree)
{
  assert_true(fine.displacement < 2e-6);
  assert_near(log2(coarse.displacement / fine.displacement), 3.0, 0.15);
}

TEST(ShearConvergesWithOrderTwo)
{
  assert_true(fine.gradient < 2e-4);
  assert_near(log2(coarse.gradient / fine.gradient), 2.0, 0.15);
}

TEST(StressesConvergeWithOrderTwo)
{
  assert_near(log2(coarse.shear / fine.shear), 2.0, 0.15);
  assert_near(log2(coarse.normal / fine.normal), 2.0, 0.2);
}

TEST_IS(HeightsStay, assert_near(fine.lateral, 0.0, 1e-8));

/* A traction at the top gives the displacement that was prescribed. */
TEST(TractionMovesTheTopAsTheCubicSays)
{
  StripProblem pulled = DefaultStrip(16, INCOMPRESSIBLE);
  StripErrors errors;

  pulled.pulled = PETSC_TRUE;
  assert_int_equal(ComputeStrip(pulled, &errors), 0);
  assert_near(errors.nodal, 0.0, 1e-6);
}

/* Fibres at 75 degrees: the cubic of any angle. */
TEST(ObliqueFibresFollowTheirCubic)
{
  StripProblem oblique = DefaultStrip(16, INCOMPRESSIBLE);
  StripErrors errors;

  oblique.psi = 75.0 * PETSC_PI / 180.0;
  assert_int_equal(ComputeStrip(oblique, &errors), 0);
  assert_near(errors.displacement, 0.0, 1e-6);
}

/* Walls that can be compressed miss the incompressible solution by about 0.3 / kappa. */
TEST(CompressibilityCostsItsInverse)
{
  StripErrors soft, stiff;

  assert_int_equal(ComputeStrip(DefaultStrip(16, 1e2), &soft), 0);
  assert_int_equal(ComputeStrip(DefaultStrip(16, 1e3), &stiff), 0);
  assert_near(1e3 * stiff.displacement, 0.31, 0.03);
  assert_near(log10(soft.displacement / stiff.displacement), 1.0, 0.1);
}

/* Two walls sheared as the paper has it, with faces free of traction: a gap opens everywhere, nearly that of the cubic
   and, at small shear, nearly twice that of the power 4/3. */
TEST(FreeFacesPartAsTheCubicSays)
{
  const LamWall wall = DefaultStrip(1, 1e3).wall;
  const int middle = FACE_NODES / 2;
  FreeFaces faces;

  assert_int_equal(ComputeFreeFaces(&wall, 0.1, &faces), 0);
  for (int j = 1; j < FACE_NODES; j++) assert_true(faces.computed[j] > 0.0);
  assert_near(faces.computed[middle], faces.sheared[middle], 0.01);
  assert_true(faces.computed[middle] > 1.7 * faces.power[middle]);
}

TEST_GROUP(.petsc = 1, .setup = Solve);
