/* What the answer must not depend on: the observer, the lattice's symmetry, the number of cells, the path
 * (units: test_unit_systems). */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"
#include "support/turned_response.h"

#define TOLERANCE 1e-8
#define SCATTER 1e-4    /* C1 + C2: of slaves that become masters, with 6 elements a face */
#define OTHER_HATS 5e-4 /* the same where the hats at a junction settle differently: several discrete solutions */
#define TURGOR (0.02 / TISSUE_STRESS)
#define FOR_INTERFACES(contact) for (int contact = 0; contact < 2; contact++)

/* In contact faces have partly come apart. */
static const double F0[2][9] = {{1.06, 0.13, 0, -0.04, 0.99, 0, 0, 0, 1}, {1.04, 0.12, 0, -0.03, 0.99, 0, 0, 0, 1}};

static LamMicrostructure Tissue(int contact)
{
  return contact ? ContactTissue(6, 2) : DefaultTissue();
}

static LamLoad LoadOf(int contact, const double F[9])
{
  LamLoad load = {.turgor = TURGOR, .cohesion = contact ? 0.002 / TISSUE_STRESS : 0};

  memcpy(load.F, F, sizeof(load.F));
  return load;
}

/* P(Q F R^T) = Q P(F) R^T of the tissue, the second time with its cells at an orientation. */
static void AssertTurns(int contact, const double Q[9], const double R[9], double orientation)
{
  LamMicrostructure micro = Tissue(contact);
  const LamResponse a = SolveTissue(&micro, LoadOf(contact, F0[contact]));
  double F[9];
  LamResponse b;

  TurnTensor(Q, F0[contact], R, F);
  micro.orientation = orientation;
  b = SolveTissue(&micro, LoadOf(contact, F));
  AssertTurnedResponse(&a, &b, Q, R, TOLERANCE);
}

TEST(RotationOfTheObserver)
{
  FOR_INTERFACES(contact)
  for (double angle = 0.4; angle < 3.2; angle += 1.2) {
    double Q[9];

    RotationTensor(angle, Q);
    AssertTurns(contact, Q, turned_identity, 0.0);
  }
}

/* A solution that is turned is a solution: the start for a turned load is turned with it. */
TEST(RotationOfASolutionCostsNothing)
{
  const LamMicrostructure micro = DefaultTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamLoad load = LoadOf(0, F0[0]);
  LamResponse r;
  double Q[9];

  RotationTensor(1.3, Q);
  assert_int_equal(LamRVESolve(rve, &load, point, &r), 0);
  TurnTensor(Q, F0[0], turned_identity, load.F);
  assert_int_equal(LamRVESolve(rve, &load, point, &r), 0);
  assert_in_range(r.newton_iterations, 0, 1);
}

/* The cell is the same after each symmetry R of the hexagon: P(R F R^T) = R P(F) R^T. */
TEST(SymmetriesOfTheLatticeOfBondedTissue)
{
  static const double along[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1}, across[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
  double R[9];

  RotationTensor(PETSC_PI / 3.0, R);
  AssertTurns(0, R, R, 0.0);
  AssertTurns(0, along, along, 0.0);
  AssertTurns(0, across, across, 0.0);
}

/* A two-fold axis makes every slave a master and keeps all pairs. */
TEST(RotationOfTheLatticeOfContactTissueByAHalfTurn)
{
  double R[9];

  RotationTensor(PETSC_PI, R);
  AssertTurns(1, R, R, 0.0);
}

/* Largest error of the stress under rotations by 60 and 120 degrees and under a mirror. They make slaves masters in
   some of the faces only, so that the symmetry is that of the continuum, not of the mesh. */
static double SymmetryError(int along, int through)
{
  static const double mirror[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
  const LamMicrostructure micro = ContactTissue(along, through);
  const LamResponse a = SolveTissue(&micro, LoadOf(1, F0[1]));
  double error = 0.0;

  for (int k = 0; k < 3; k++) {
    double R[9], F[9];
    LamResponse b;

    RotationTensor(k * PETSC_PI / 3.0, R);
    if (k == 0) memcpy(R, mirror, sizeof(R));
    TurnTensor(R, F0[1], R, F);
    b = SolveTissue(&micro, LoadOf(1, F));
    assert_int_equal(b.status, LAM_CONVERGED);
    error = fmax(error, TurnedStressError(&a, &b, R, R));
  }
  return error;
}

TEST_IS(SymmetriesOfTheLatticeOfContactTissue, assert_near(SymmetryError(6, 2), 0.0, SCATTER));
TEST_IS(SymmetriesOfTheLatticeOnAFinerMesh, assert_near(SymmetryError(24, 2), 0.0, OTHER_HATS));

/* `orientation` turns the cell: P = R P0(R^T F R) R^T. */
TEST(OrientationTurnsTheCell)
{
  double R[9];

  RotationTensor(0.37, R);
  FOR_INTERFACES(contact) AssertTurns(contact, R, R, 0.37);
}

/* Before a pattern longer than a cell appears, more cells answer like one. */
TEST(NumberOfCells)
{
  static const int cells[][2] = {{1, 2}, {2, 1}, {2, 2}};

  FOR_INTERFACES(contact)
  {
    LamMicrostructure micro = Tissue(contact);
    const LamResponse a = SolveTissue(&micro, LoadOf(contact, F0[contact]));

    for (int k = 0; k < 3; k++) {
      LamResponse b;

      micro.cells[0] = cells[k][0];
      micro.cells[1] = cells[k][1];
      b = SolveTissue(&micro, LoadOf(contact, F0[contact]));
      AssertTurnedResponse(&a, &b, turned_identity, turned_identity, TOLERANCE);
      for (int f = 0; f < 3 && !contact; f++) assert_near(b.mean_face_traction[f], a.mean_face_traction[f], TOLERANCE);
    }
  }
}

/* A path does not matter where there is one stable state: in steps by another way, with another turgor. */
TEST(PathToTheLoad)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamResponse a = SolveTissue(&micro, LoadOf(0, F0[0]));
  const LamLoad way[2] = {PlaneLoad(1.1, -0.1, 0.1, 1.1, 3.0 * TURGOR), LoadOf(0, F0[0])};
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamResponse b;

  for (int k = 0; k < 2; k++) assert_int_equal(LamRVESolve(rve, &way[k], point, &b), 0);
  AssertTurnedResponse(&a, &b, turned_identity, turned_identity, TOLERANCE);
}
