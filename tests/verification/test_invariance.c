/* What the answer must not depend on: the observer, the lattice's symmetry, the number of cells, the user's units. */
#include "support/test.h"
#include "support/rve_fixture.h"
#include "support/turned_response.h"

#define TOLERANCE 1e-8
#define TURGOR (0.02 / TISSUE_STRESS)

static const double F0[9] = {1.06, 0.13, 0, -0.04, 0.99, 0, 0, 0, 1};

static LamLoad LoadOf(const double F[9], double turgor)
{
  LamLoad load = {.turgor = turgor};

  memcpy(load.F, F, sizeof(load.F));
  return load;
}

/* b must be a with the current configuration turned by Q and the reference one by R: P -> Q P R^T, A likewise. */
static void AssertTurned(const LamResponse *a, const LamResponse *b, const double Q[9], const double R[9])
{
  assert_int_equal(b->status, LAM_CONVERGED);
  assert_near(TurnedStressError(a, b, Q, R), 0.0, TOLERANCE);
  assert_near(TurnedTangentError(a, b, Q, R), 0.0, TOLERANCE);
  assert_near(b->energy, a->energy, TOLERANCE);
  assert_near(b->lumen_fraction, a->lumen_fraction, TOLERANCE);
  assert_near(b->max_traction, a->max_traction, TOLERANCE * (1.0 + fabs(a->max_traction)));
}

TEST(RotationOfTheObserver)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamResponse a = SolveTissue(&micro, LoadOf(F0, TURGOR));

  for (double angle = 0.4; angle < 3.2; angle += 1.2) {
    double Q[9], F[9];
    LamResponse b;

    RotationTensor(angle, Q);
    TurnTensor(Q, F0, turned_identity, F);
    b = SolveTissue(&micro, LoadOf(F, TURGOR));
    AssertTurned(&a, &b, Q, turned_identity);
  }
}

/* A solution that is turned is a solution: the start for a turned load is turned with it. */
TEST(RotationOfASolutionCostsNothing)
{
  const LamMicrostructure micro = DefaultTissue();
  LamRVE rve = NewRVE(&micro);
  LamRVEState point;
  LamLoad load = LoadOf(F0, TURGOR);
  LamResponse r;
  double Q[9];

  RotationTensor(1.3, Q);
  assert_int_equal(LamRVEStateCreate(rve, &point), 0);
  assert_int_equal(LamRVESolve(rve, &load, point, &r), 0);
  TurnTensor(Q, F0, turned_identity, load.F);
  assert_int_equal(LamRVESolve(rve, &load, point, &r), 0);
  assert_in_range(r.newton_iterations, 0, 1);
  assert_int_equal(LamRVEStateDestroy(&point), 0);
  assert_int_equal(LamRVEDestroy(&rve), 0);
}

/* The cell is the same after each symmetry R of the hexagon: P(R F R^T) = R P(F) R^T. */
static void AssertSymmetry(const double R[9])
{
  const LamMicrostructure micro = DefaultTissue();
  const LamResponse a = SolveTissue(&micro, LoadOf(F0, TURGOR));
  double F[9];
  LamResponse b;

  TurnTensor(R, F0, R, F);
  b = SolveTissue(&micro, LoadOf(F, TURGOR));
  AssertTurned(&a, &b, R, R);
}

TEST(RotationOfTheLatticeBySixtyDegrees)
{
  double R[9];

  RotationTensor(PETSC_PI / 3.0, R);
  AssertSymmetry(R);
}

TEST(MirrorOfTheLattice)
{
  static const double along[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1}, across[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};

  AssertSymmetry(along);
  AssertSymmetry(across);
}

/* `orientation` turns the cell: P = R P0(R^T F R) R^T. */
TEST(OrientationTurnsTheCell)
{
  const double angle = 0.37;
  LamMicrostructure micro = DefaultTissue();
  const LamResponse a = SolveTissue(&micro, LoadOf(F0, TURGOR));
  LamResponse b;
  double R[9], F[9];

  RotationTensor(angle, R);
  TurnTensor(R, F0, R, F);
  micro.orientation = angle;
  b = SolveTissue(&micro, LoadOf(F, TURGOR));
  AssertTurned(&a, &b, R, R);
}

/* Before a pattern longer than a cell appears, more cells answer like one. */
TEST(NumberOfCells)
{
  static const int cells[][2] = {{1, 2}, {2, 1}, {2, 2}};
  LamMicrostructure micro = DefaultTissue();
  const LamResponse a = SolveTissue(&micro, LoadOf(F0, TURGOR));

  for (int k = 0; k < 3; k++) {
    LamResponse b;

    micro.cells[0] = cells[k][0];
    micro.cells[1] = cells[k][1];
    b = SolveTissue(&micro, LoadOf(F0, TURGOR));
    AssertTurned(&a, &b, turned_identity, turned_identity);
    for (int f = 0; f < 3; f++) assert_near(b.mean_face_traction[f], a.mean_face_traction[f], TOLERANCE);
  }
}

/* A path does not matter where there is one stable state: in steps by another way, with another turgor. */
TEST(PathToTheLoad)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamResponse a = SolveTissue(&micro, LoadOf(F0, TURGOR));
  const LamLoad way[2] = {PlaneLoad(1.1, -0.1, 0.1, 1.1, 3.0 * TURGOR), LoadOf(F0, TURGOR)};
  LamRVE rve = NewRVE(&micro);
  LamRVEState point;
  LamResponse b;

  assert_int_equal(LamRVEStateCreate(rve, &point), 0);
  for (int k = 0; k < 2; k++) assert_int_equal(LamRVESolve(rve, &way[k], point, &b), 0);
  AssertTurned(&a, &b, turned_identity, turned_identity);
  assert_int_equal(LamRVEStateDestroy(&point), 0);
  assert_int_equal(LamRVEDestroy(&rve), 0);
}

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

#define SCENE(cell, wall, pressure)                                                                                    \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: " cell "\n"                                                                                                 \
  "  wall: " wall "\n"                                                                                                 \
  "  interface: {law: bonded}\n"                                                                                       \
  "  turgor: {mode: prescribed, pressure: " pressure "}\n"                                                             \
  "  mesh: {along: 6, through: 2}\n"                                                                                   \
  "load:\n"                                                                                                            \
  "  - {F: [[1.02, 0.1], [0, 1]]}\n"

TEST(SystemOfUnits)
{
  static const char *const scenes[3] = {
      SCENE("{apothem: 75 um, wall_thickness: 11.25 um, orientation: 30 deg}",
            "{law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa, bulk_modulus: 110 MPa}", "0.02 MPa"),
      SCENE("{apothem: 7.5e-5 m, wall_thickness: 1.125e-5 m, orientation: 0.5235987755982988 rad}",
            "{law: fibre_mooney_rivlin, C1: 1e5 Pa, C2: 1e4 Pa, C4: 1e6 Pa, bulk_modulus: 1.1e8 Pa}", "2e4 Pa"),
      SCENE("{apothem: 0.075 mm, wall_thickness: 11250 nm, orientation: 30 deg}",
            "{law: fibre_mooney_rivlin, C1: 1 bar, C2: 0.1 bar, C4: 10 bar, bulk_modulus: 1100 bar}", "200 mbar")};
  double first[9], P[9];

  SolveScene(scenes[0], first);
  for (int k = 1; k < 3; k++) {
    SolveScene(scenes[k], P);
    for (int i = 0; i < 9; i++) assert_near(P[i], first[i], TOLERANCE * fabs(first[0]));
  }
}

TEST_GROUP(.petsc = 1);
