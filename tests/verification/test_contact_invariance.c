/* What the answer of contact tissue must not depend on, in a pressurised state whose faces have partly come apart. */
#include "support/test.h"
#include "support/rve_fixture.h"
#include "support/contact_checks.h"
#include "support/turned_response.h"

#define TOLERANCE 1e-8
#define SCATTER 1e-4    /* C1 + C2: of slaves that become masters, with 6 elements a face */
#define OTHER_HATS 5e-4 /* the same where the hats at a junction settle differently: several discrete solutions */

static const double F0[9] = {1.04, 0.12, 0, -0.03, 0.99, 0, 0, 0, 1};

static LamLoad LoadOf(const double F[9])
{
  LamLoad load = {.turgor = 0.02 / TISSUE_STRESS, .cohesion = 0.002 / TISSUE_STRESS};

  memcpy(load.F, F, sizeof(load.F));
  return load;
}

TEST(RotationOfTheObserver)
{
  const LamMicrostructure micro = ContactTissue(6, 2);
  const LamResponse a = SolveTissue(&micro, LoadOf(F0));

  for (double angle = 0.4; angle < 3.2; angle += 1.2) {
    double Q[9], F[9];
    LamResponse b;

    RotationTensor(angle, Q);
    TurnTensor(Q, F0, turned_identity, F);
    b = SolveTissue(&micro, LoadOf(F));
    AssertTurnedResponse(&a, &b, Q, turned_identity, TOLERANCE);
  }
}

/* `orientation` turns the cell: P = R P0(R^T F R) R^T. */
TEST(OrientationTurnsTheCell)
{
  LamMicrostructure micro = ContactTissue(6, 2);
  const LamResponse a = SolveTissue(&micro, LoadOf(F0));
  LamResponse b;
  double R[9], F[9];

  micro.orientation = 0.37;
  RotationTensor(micro.orientation, R);
  TurnTensor(R, F0, R, F);
  b = SolveTissue(&micro, LoadOf(F));
  AssertTurnedResponse(&a, &b, R, R, TOLERANCE);
}

TEST(NumberOfCells)
{
  static const int cells[][2] = {{1, 2}, {2, 1}, {2, 2}};
  LamMicrostructure micro = ContactTissue(6, 2);
  const LamResponse a = SolveTissue(&micro, LoadOf(F0));

  for (int k = 0; k < 3; k++) {
    LamResponse b;

    micro.cells[0] = cells[k][0];
    micro.cells[1] = cells[k][1];
    b = SolveTissue(&micro, LoadOf(F0));
    AssertTurnedResponse(&a, &b, turned_identity, turned_identity, TOLERANCE);
  }
}

/* A two-fold axis makes every slave a master and keeps all pairs. */
TEST(RotationOfTheLatticeByAHalfTurn)
{
  const LamMicrostructure micro = ContactTissue(6, 2);
  const LamResponse a = SolveTissue(&micro, LoadOf(F0));
  LamResponse b;
  double R[9], F[9];

  RotationTensor(PETSC_PI, R);
  TurnTensor(R, F0, R, F);
  b = SolveTissue(&micro, LoadOf(F));
  AssertTurnedResponse(&a, &b, R, R, TOLERANCE);
}

/* Largest error of the stress under rotations by 60 and 120 degrees and under a mirror. They make slaves masters in
   some of the faces only, so that the symmetry is that of the continuum, not of the mesh. */
static double SymmetryError(int along, int through)
{
  static const double mirror[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
  const LamMicrostructure micro = ContactTissue(along, through);
  const LamResponse a = SolveTissue(&micro, LoadOf(F0));
  double error = 0.0;

  for (int k = 0; k < 3; k++) {
    double R[9], F[9];
    LamResponse b;

    RotationTensor(k * PETSC_PI / 3.0, R);
    if (k == 0) memcpy(R, mirror, sizeof(R));
    TurnTensor(R, F0, R, F);
    b = SolveTissue(&micro, LoadOf(F));
    assert_int_equal(b.status, LAM_CONVERGED);
    error = fmax(error, TurnedStressError(&a, &b, R, R));
  }
  return error;
}

TEST_IS(SymmetriesOfTheLattice, assert_near(SymmetryError(6, 2), 0.0, SCATTER));
TEST_IS(SymmetriesOfTheLatticeOnAFinerMesh, assert_near(SymmetryError(24, 2), 0.0, OTHER_HATS));

#define SCENE(cell, wall, cohesion, pressure)                                                                          \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: " cell "\n"                                                                                                 \
  "  wall: " wall "\n"                                                                                                 \
  "  interface: {law: contact, cohesion: " cohesion "}\n"                                                              \
  "  turgor: {mode: prescribed, pressure: " pressure "}\n"                                                             \
  "  mesh: {along: 6, through: 2}\n"                                                                                   \
  "load:\n"                                                                                                            \
  "  - {F: [[1.02, 0.1], [0, 1]]}\n"

/* Stresses in Pa of the one load of a scene. */
static void SolveScene(const char text[], double P[9])
{
  LamScene *scene;
  LamResponse r;

  assert_int_equal(LamSceneReadText("units.yaml", text, &scene), 0);
  r = SolveTissue(&scene->micro, scene->loads[0]);
  assert_int_equal(r.status, LAM_CONVERGED);
  for (int i = 0; i < 9; i++) P[i] = scene->scales.stress * r.P[i];
  assert_int_equal(LamSceneDestroy(&scene), 0);
}

TEST(SystemOfUnits)
{
  static const char *const scenes[3] = {
      SCENE("{apothem: 75 um, wall_thickness: 11.25 um, orientation: 30 deg}",
            "{law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa, bulk_modulus: 110 MPa}", "2 kPa",
            "0.02 MPa"),
      SCENE("{apothem: 7.5e-5 m, wall_thickness: 1.125e-5 m, orientation: 0.5235987755982988 rad}",
            "{law: fibre_mooney_rivlin, C1: 1e5 Pa, C2: 1e4 Pa, C4: 1e6 Pa, bulk_modulus: 1.1e8 Pa}", "2e3 Pa",
            "2e4 Pa"),
      SCENE("{apothem: 0.075 mm, wall_thickness: 11250 nm, orientation: 30 deg}",
            "{law: fibre_mooney_rivlin, C1: 1 bar, C2: 0.1 bar, C4: 10 bar, bulk_modulus: 1100 bar}", "20 mbar",
            "200 mbar")};
  double first[9], P[9];

  SolveScene(scenes[0], first);
  for (int k = 1; k < 3; k++) {
    SolveScene(scenes[k], P);
    for (int i = 0; i < 9; i++) assert_near(P[i], first[i], TOLERANCE * fabs(first[0]));
  }
}

TEST_GROUP(.petsc = 1);
