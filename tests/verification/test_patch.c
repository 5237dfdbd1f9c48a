/* What the answer of a patch must not depend on, its limit of many cells, and the smallest patches. */
#include "support/rve_fixture.h"
#include "support/cell_patch.h"
#include "support/turned_response.h"

#define TOLERANCE 1e-8
#define SCATTER 1e-4 /* C1 + C2: of slaves that become masters, with 6 elements a face */

static const double F0[9] = {1.03, 0.1, 0, -0.02, 1.01, 0, 0, 0, 1};

/* Under turgor; with cohesion, which bonded tissue does not feel. */
static LamResponse SolvePatch(const LamMicrostructure *micro, const double F[9])
{
  LamLoad load = {.turgor = 0.02 / TISSUE_STRESS};

  memcpy(load.F, F, sizeof(load.F));
  if (micro->interface == LAM_INTERFACE_CONTACT) load.cohesion = 0.002 / TISSUE_STRESS;
  return SolveTissue(micro, load);
}

TEST(RotationOfTheObserver)
{
  for (int interface = 0; interface < LAM_INTERFACE_LAW_COUNT; interface++)
    for (int sides = 0; sides < LAM_PATCH_SIDES_COUNT; sides++) {
      LamMicrostructure micro = PatchTissue(2, 3, 30, (LamInterfaceLawType)interface);
      double Q[9], F[9];
      LamResponse a, b;

      micro.sides = (LamPatchSides)sides;
      a = SolvePatch(&micro, F0);
      RotationTensor(0.7, Q);
      TurnTensor(Q, F0, turned_identity, F);
      b = SolvePatch(&micro, F);
      AssertTurnedResponse(&a, &b, Q, turned_identity, TOLERANCE);
    }
}

/* Cells turned by 60 degrees lie in the same places; only the numbers of their faces change. */
TEST(CellsTurnedBySixtyDegrees)
{
  for (int orientation = 0; orientation <= 30; orientation += 30) {
    LamMicrostructure micro = PatchTissue(3, 2, orientation, LAM_INTERFACE_BONDED), turned = micro;
    LamResponse a, b;

    turned.orientation += 60 * DEGREE;
    a = SolvePatch(&micro, F0);
    b = SolvePatch(&turned, F0);
    AssertTurnedResponse(&a, &b, turned_identity, turned_identity, TOLERANCE);
    micro.interface = turned.interface = LAM_INTERFACE_CONTACT;
    a = SolvePatch(&micro, F0);
    b = SolvePatch(&turned, F0);
    assert_near(TurnedStressError(&a, &b, turned_identity, turned_identity), 0.0, SCATTER);
  }
}

/* Three columns of cells on an edge, turned by a right angle, are three rows of cells on a corner. */
TEST(CellsOnAnEdgeAreTurnedCellsOnACorner)
{
  LamMicrostructure micro = PatchTissue(3, 2, 30, LAM_INTERFACE_BONDED),
                    turned = PatchTissue(2, 3, 0, LAM_INTERFACE_BONDED);
  double R[9], F[9];
  LamResponse a, b;

  RotationTensor(-PETSC_PI / 2.0, R);
  TurnTensor(R, F0, R, F);
  a = SolvePatch(&micro, F0);
  b = SolvePatch(&turned, F);
  AssertTurnedResponse(&a, &b, R, R, TOLERANCE);
  micro.interface = turned.interface = LAM_INTERFACE_CONTACT;
  a = SolvePatch(&micro, F0);
  b = SolvePatch(&turned, F);
  assert_near(TurnedStressError(&a, &b, R, R), 0.0, SCATTER);
}

/* The boundary holds a layer of cells: the stress of n x n cells differs from the periodic one by a term in 1/n. */
TEST(BondedPatchTendsToThePeriodicTissue)
{
  double error[PATCH_SIZES], limit;

  assert_int_equal(BondedPatchErrors(error, &limit), 0);
  assert_near(error[1] / error[0], 0.5, 0.1);
  assert_near(error[2] / error[1], 0.5, 0.05);
  assert_near(limit, 0.0, 0.01);
}

/* Inside the outer walls of all cells, each made of quadratic edges. */
static double AreaOfCells(LamRVE rve, LamRVEState state)
{
  static const double D[3][3] = {{0, 4.0 / 3.0, -1.0 / 3.0}, {0, 0, 4.0 / 3.0}, {0, 0, 0}};
  static const int edge[3] = {1, 5, 2}; /* of an element on the outside */
  double area = 0.0, *x;
  LamRVEMesh mesh;

  assert_int_equal(LamRVEGetMesh(rve, &mesh), 0);
  assert_int_equal(PetscMalloc1(2 * mesh.node_count, &x), 0);
  assert_int_equal(LamRVEGetFields(rve, state, x, NULL, NULL), 0);
  for (PetscInt e = 0; e < mesh.element_count; e++) {
    if (!LamMeshElementIsOuter(&rve->mesh, e)) continue;
    for (int i = 0; i < 3; i++)
      for (int j = i + 1; j < 3; j++) {
        const double *a = &x[2 * mesh.elements[9 * e + edge[i]]], *b = &x[2 * mesh.elements[9 * e + edge[j]]];

        area += 0.5 * D[i][j] * (a[0] * b[1] - a[1] * b[0]);
      }
  }
  assert_int_equal(PetscFree(x), 0);
  return area;
}

/* Sides that follow F keep the area of the block: what is not cell is gap. */
TEST(CellsAndGapsFillThePatch)
{
  for (int orientation = 0; orientation <= 30; orientation += 30) {
    const LamMicrostructure micro = PatchTissue(3, 3, orientation, LAM_INTERFACE_CONTACT);
    const LamLoad load = ContactLoad(1.03, 0.2, -0.02, 1.01, 0.01, 0);
    const double V0 = 9.0 * 2.0 * sqrt(3.0), J = 1.03 * 1.01 + 0.2 * 0.02;
    OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
    OWNED(LamRVEState, LamRVEStateDestroy) solution = NewState(rve);
    LamResponse r;

    assert_int_equal(LamRVESolve(rve, &load, solution, &r), 0);
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_true(r.opening_fraction > 1e-3);
    assert_near(r.opening_fraction, J - AreaOfCells(rve, solution) / V0, 1e-12);
  }
}

TEST(SmallestPatches)
{
  static const int cells[][2] = {{1, 1}, {1, 4}, {4, 1}};

  for (int k = 0; k < 3; k++)
    for (int orientation = 0; orientation <= 30; orientation += 30)
      for (int interface = 0; interface < LAM_INTERFACE_LAW_COUNT; interface++) {
        const LamMicrostructure micro =
            PatchTissue(cells[k][0], cells[k][1], orientation, (LamInterfaceLawType)interface);
        const LamResponse r = SolvePatch(&micro, F0);

        assert_int_equal(r.status, LAM_CONVERGED);
        assert_true(r.stable);
      }
}

/* One cell has no interface: contact does not change it, and of what would be open nothing is known. */
TEST(OneCellHasNoInterface)
{
  const LamMicrostructure bonded = PatchTissue(1, 1, 30, LAM_INTERFACE_BONDED),
                          contact = PatchTissue(1, 1, 30, LAM_INTERFACE_CONTACT);
  const LamResponse a = SolvePatch(&bonded, F0), b = SolvePatch(&contact, F0);

  assert_near(TurnedStressError(&a, &b, turned_identity, turned_identity), 0.0, TOLERANCE);
  assert_near(TurnedTangentError(&a, &b, turned_identity, turned_identity), 0.0, TOLERANCE);
  assert_near(b.opening_fraction, 0.0, 1e-14);
  assert_true(isnan(b.open_fraction));
  assert_true(isnan(b.debonded_fraction));
  assert_true(isnan(a.max_traction));
  assert_true(isnan(b.max_traction));
}
