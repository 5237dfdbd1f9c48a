/* Which cells still touch: clusters, percolation and fabric of states whose answer is known. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"

static LamResponse SolveCells(int n0, int n1, double orientation, LamLoad load)
{
  LamMicrostructure micro = ContactTissue(6, 2);
  LamResponse r;

  micro.cells[0] = n0;
  micro.cells[1] = n1;
  micro.orientation = orientation;
  r = SolveTissue(&micro, load);
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

/* Squeezed along normal 0 and pulled across: the oblique faces open, cells stand in columns. */
static LamLoad Columns(void)
{
  return ContactLoad(0.97, 0, 0, 1.1, 0, 0);
}

TEST(OnlyTheSqueezedFamilyStaysClosed)
{
  const LamResponse r = SolveCells(1, 1, 0.0, Columns());

  assert_true(r.debonded_by_face[0] < 0.9);
  assert_near(r.debonded_by_face[1], 1.0, 1e-12);
  assert_near(r.debonded_by_face[2], 1.0, 1e-12);
  assert_true(r.open_by_face[1] > 0.8 && r.open_by_face[2] > 0.8);
}

TEST(ColumnsSpanOneDirection)
{
  const LamResponse r = SolveCells(1, 1, 0.0, Columns());

  assert_int_equal(r.percolating_directions, 1);
  assert_int_equal(r.floating_cells, 0);
}

TEST(EveryColumnIsACluster)
{
  const LamResponse r = SolveCells(1, 2, 0.0, Columns());

  assert_int_equal(r.cell_clusters, 2);
  assert_int_equal(r.percolating_directions, 1);
}

/* A column carries nothing across. */
TEST(ColumnsCarryStressAlongThemselvesOnly)
{
  const LamResponse r = SolveCells(1, 1, 0.0, Columns());

  assert_true(r.P[0] < -1e-3);
  for (int i = 1; i < 5; i++) assert_near(r.P[i], 0.0, 1e-9);
}

/* Its direction is that of the squeezed faces' normal, also where the cell is turned; nothing but their friction-free
   contact keeps the cells of a dry column from leaning a little. */
TEST(FabricPointsAlongTheColumns)
{
  const LamLoad turned = ContactLoad(1.1, 0, 0, 0.97, 0, 0);
  const LamResponse r = SolveCells(1, 1, 0.0, Columns()), t = SolveCells(1, 1, PETSC_PI / 2.0, turned);

  assert_true(r.fabric[0] > 0.03);
  assert_true(r.fabric[1] < 0.01 * r.fabric[0]);
  assert_near(r.fabric[2], 0.0, 0.02 * r.fabric[0]);
  assert_near(t.fabric[1], r.fabric[0], 1e-6);
  assert_near(t.fabric[0], r.fabric[1], 1e-6);
}

TEST(ClosedTissueIsOneClusterThatSpansThePeriod)
{
  const LamResponse r = SolveCells(2, 2, 0.2, ContactLoad(1, 0, 0, 1, 0.02, 0));

  assert_int_equal(r.cell_clusters, 1);
  assert_int_equal(r.percolating_directions, 2);
  assert_int_equal(r.floating_cells, 0);
}

/* All three families alike: sum of n (x) n / 3 is half the identity. */
TEST(FabricOfClosedTissueIsIsotropic)
{
  const LamResponse r = SolveCells(1, 1, 0.2, ContactLoad(1, 0, 0, 1, 0.02, 0));

  assert_near(r.fabric[0], 0.5, 1e-6);
  assert_near(r.fabric[1], 0.5, 1e-6);
  assert_near(r.fabric[2], 0.0, 0.02 * r.fabric[0]);
}

TEST(TraceOfTheFabricIsTheClosedShare)
{
  const LamLoad loads[] = {Columns(), ContactLoad(1, 0.2, 0, 1, 0.01, 0), ContactLoad(1.06, 0.05, 0, 1, 0.01, 0.005),
                           ContactLoad(1.1, 0, 0, 1.1, 0, 0)};

  for (size_t k = 0; k < sizeof(loads) / sizeof(loads[0]); k++) {
    const LamResponse r = SolveCells(1, 1, 0.1, loads[k]);

    assert_near(r.fabric[0] + r.fabric[1], 1.0 - r.debonded_fraction, 1e-12);
  }
}

/* Faces 0 stand across the stretch, the others lie along it. */
TEST(StretchOpensTheFamilyAcrossItAlone)
{
  const LamResponse r = SolveCells(1, 1, 0.0, ContactLoad(1.05, 0, 0, 0.96, 0.01, 0));

  assert_true(r.open_by_face[0] > 0.1);
  assert_near(r.open_by_face[1], 0.0, 1e-12);
  assert_near(r.open_by_face[2], 0.0, 1e-12);
}

/* The faces whose normals are stretched come apart. */
TEST(ShearDebondsTheStretchedFamilyMost)
{
  const LamResponse r = SolveCells(1, 1, 0.0, ContactLoad(1, 0.15, 0, 1, 0.01, 0));

  assert_true(r.debonded_by_face[1] > 1.5 * r.debonded_by_face[2]); /* normals at 60 and at 120 degrees */
  assert_true(r.debonded_by_face[1] > 1.5 * r.debonded_by_face[0]);
}

TEST(ApartCellsAreClustersOfTheirOwn)
{
  const LamResponse r = SolveCells(2, 1, 0.0, ContactLoad(1.1, 0, 0, 1.1, 0, 0));

  assert_int_equal(r.cell_clusters, 2);
  assert_int_equal(r.percolating_directions, 0);
  assert_near(r.fabric[0] + r.fabric[1], 0.0, 1e-12);
}
