/*
  Mean face tractions of one frictionless cell follow from the macroscopic stress by statics alone (contact_checks.h).
  The formula of small strains holds where turgor and cohesion are small against the moduli of the tissue: faces turn by
  angles of the order of the strain, and pressure times angle compares with the differences between the tractions. With
  the current directions of the contact forces it holds under turgor, too. Errors are over the spread between the faces.
*/
#include "support/rve_fixture.h"
#include "support/contact_checks.h"

#define STRAINS 3
#define WEAK_LOADS 2 /* without and with cohesion */
#define LOADS 3

static StaticTractions weak[WEAK_LOADS][STRAINS]; /* p + g = 0.001 MPa */
static StaticTractions turgid[LOADS][STRAINS];    /* 0.02 and 0.05 MPa */

static int SolveAll(void **state)
{
  static const double strains[STRAINS] = {1e-2, 3e-3, 1e-3};

  for (int s = 0; s < STRAINS; s++) {
    if (ComputeStaticTractions(strains[s], 0.001, 0.0, &weak[0][s])) return 1;
    if (ComputeStaticTractions(strains[s], 0.0005, 0.0005, &weak[1][s])) return 1;
    if (ComputeStaticTractions(strains[s], 0.02, 0.0, &turgid[0][s])) return 1;
    if (ComputeStaticTractions(strains[s], 0.015, 0.005, &turgid[1][s])) return 1;
    if (ComputeStaticTractions(strains[s], 0.05, 0.0, &turgid[2][s])) return 1;
  }
  return 0;
}

TEST(FormulaOfSmallStrainsHolds)
{
  for (int k = 0; k < WEAK_LOADS; k++) assert_near(weak[k][STRAINS - 1].reference, 0.0, 0.01);
}

TEST(ItsErrorFallsWithTheStrain)
{
  for (int k = 0; k < WEAK_LOADS; k++)
    for (int s = 1; s < STRAINS; s++) assert_true(weak[k][s].reference < 0.6 * weak[k][s - 1].reference);
}

TEST(StaticsOfTheCurrentFacesHoldsUnderTurgor)
{
  for (int k = 0; k < LOADS; k++) assert_near(turgid[k][STRAINS - 1].current, 0.0, 0.01);
}

TEST(ItsErrorFallsWithTheStrainToo)
{
  for (int k = 0; k < LOADS; k++)
    for (int s = 1; s < STRAINS; s++) assert_true(turgid[k][s].current < 0.6 * turgid[k][s - 1].current);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
