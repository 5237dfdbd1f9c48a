/* Cells that differ (their derivatives: test_derivatives): repeated and shifted patterns, balance of forces, and the
 * weakest lamella. */
#include "support/rve_fixture.h"
#include "support/uneven_cells.h"
#include "support/turned_response.h"

static LamCell cells[UNEVEN_CELLS];

TEST(EqualCellsAreTheTissue)
{
  for (int interface = 0; interface < LAM_INTERFACE_LAW_COUNT; interface++)
    for (int is_patch = 0; is_patch < 2; is_patch++) {
      LamCell equal[UNEVEN_CELLS];
      LamMicrostructure micro = UnevenTissue((PetscBool)is_patch, (LamInterfaceLawType)interface, cells);
      LamResponse a, b;

      for (int k = 0; k < UNEVEN_CELLS; k++) equal[k] = PlainCell(&micro);
      micro.cell = NULL;
      a = SolveTissue(&micro, UnevenLoad(&micro));
      micro.cell = equal;
      b = SolveTissue(&micro, UnevenLoad(&micro));
      AssertTurnedResponse(&a, &b, turned_identity, turned_identity, 1e-13);
      assert_near(b.energy_turgor, -b.lumen_fraction, 1e-13);
      if (interface == LAM_INTERFACE_CONTACT) assert_near(b.energy_cohesion, b.opening_fraction, 1e-13);
    }
}

/* Cells [n0][n1] of a block: cell (i, j) is that of a 2 x 1 pattern, by the parity of i. */
TEST(RepeatedPatternGivesTheSameStress)
{
  static const int blocks[][2] = {{2, 1}, {4, 1}, {2, 2}};

  for (int interface = 0; interface < LAM_INTERFACE_LAW_COUNT; interface++) {
    LamCell block[4];
    LamResponse first, r;

    for (int k = 0; k < 3; k++) {
      LamMicrostructure micro = UnevenTissue(PETSC_FALSE, (LamInterfaceLawType)interface, cells);

      for (int d = 0; d < 2; d++) micro.cells[d] = blocks[k][d];
      for (int c = 0; c < blocks[k][0] * blocks[k][1]; c++) block[c] = cells[c / blocks[k][1] % 2];
      micro.cell = block;
      r = SolveTissue(&micro, UnevenLoad(&micro));
      if (k == 0) first = r;
      AssertTurnedResponse(&first, &r, turned_identity, turned_identity, 1e-8);
    }
  }
}

/* The pattern of 2 x 2 cells moved by a lattice vector. */
TEST(ShiftedPatternGivesTheSameResponse)
{
  for (int interface = 0; interface < LAM_INTERFACE_LAW_COUNT; interface++) {
    LamMicrostructure micro = UnevenTissue(PETSC_FALSE, (LamInterfaceLawType)interface, cells);
    const LamResponse a = SolveTissue(&micro, UnevenLoad(&micro));

    for (int shift = 1; shift < UNEVEN_CELLS; shift++) { /* bit 1: along lattice vector 0, bit 0: along 1 */
      LamCell shifted[UNEVEN_CELLS];
      LamResponse b;

      for (int k = 0; k < UNEVEN_CELLS; k++) shifted[k ^ shift] = cells[k];
      micro.cell = shifted;
      b = SolveTissue(&micro, UnevenLoad(&micro));
      AssertTurnedResponse(&a, &b, turned_identity, turned_identity, 1e-8);
    }
  }
}

/* Forces and moment, about the origin, of contact and cohesion on each cell: its turgor has none, so they balance. */
static void AddForcesOnCells(LamRVE rve, const LamLoad *load, double sums[UNEVEN_CELLS][3])
{
  double *force;

  assert_int_equal(PetscCalloc1(rve->ndof, &force), 0);
  assert_int_equal(LamContactEvaluate(rve, load, rve->y), 0);
  LamContactAddForce(rve, force);
  LamGapAreaAddGradient(&rve->contact->gaps, load->F, rve->y, load->cohesion * load->F[8], force);
  for (PetscInt i = 0; i < rve->mesh.node_count; i++) {
    const double *f = &force[2 * rve->mesh.node_class[i]], *x = &rve->y[2 * rve->mesh.node_class[i]];
    double *sum = sums[i / (rve->mesh.node_count / UNEVEN_CELLS)];

    sum[0] += f[0];
    sum[1] += f[1];
    sum[2] += x[0] * f[1] - x[1] * f[0];
  }
  assert_int_equal(PetscFree(force), 0);
}

TEST(ForcesOnEveryCellBalance)
{
  const LamMicrostructure micro = UnevenTissue(PETSC_FALSE, LAM_INTERFACE_CONTACT, cells);
  const LamLoad load = UnevenLoad(&micro);
  double sums[UNEVEN_CELLS][3] = {{0}};
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  const LamResponse r = SolveFromReference(rve, load);

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_true(r.open_fraction > 0.05);
  AddForcesOnCells(rve, &load, sums);
  for (int k = 0; k < UNEVEN_CELLS; k++)
    for (int i = 0; i < 3; i++) assert_near(sums[k][i], 0.0, 1e-9);
}

/* Largest gap of the faces of a cell, and of all the others. */
static void FindGaps(LamRVE rve, LamRVEState state, PetscInt cell, double largest[2])
{
  PetscInt faces, points;
  double *gap;

  assert_int_equal(LamRVEGetInterfaceSize(rve, &faces, &points), 0);
  assert_int_equal(PetscMalloc1(faces * points, &gap), 0);
  assert_int_equal(LamRVEGetInterface(rve, state, NULL, NULL, gap, NULL), 0);
  largest[0] = largest[1] = 0.0;
  for (PetscInt k = 0; k < faces * points; k++) {
    const PetscInt owner = k / points / 3, other = LamMeshNeighbour(&rve->mesh, 6 * owner + k / points % 3);
    double *of = &largest[owner != cell && other != cell];

    *of = fmax(*of, gap[k]); /* NaN, where a face meets no other, is passed over */
  }
  assert_int_equal(PetscFree(gap), 0);
}

/* Slightly stretched tissue of cells that are alike but for the cohesion of one: gaps as FindGaps has them. */
static void StretchWithWeakCell(PetscInt weak, double cohesion, double largest[2])
{
  LamMicrostructure micro = UnevenTissue(PETSC_FALSE, LAM_INTERFACE_CONTACT, cells);
  const LamLoad load = ContactLoad(1.004, 0, 0, 1.004, 0, 0.01);
  LamCell alike[UNEVEN_CELLS];
  OWNED(LamRVEState, LamRVEStateDestroy) state;
  LamResponse r;
  OWNED(LamRVE, LamRVEDestroy) rve;

  for (int k = 0; k < UNEVEN_CELLS; k++) alike[k] = PlainCell(&micro);
  alike[weak].cohesion = cohesion;
  micro.cell = alike;
  rve = NewRVE(&micro);
  assert_int_equal(LamRVEStateCreate(rve, &state), 0);
  assert_int_equal(LamRVESolve(rve, &load, state, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  FindGaps(rve, state, weak, largest);
}

/* Where the lamella of one cell holds half of what the others hold, tissue opens around that cell. */
TEST(WeakLamellaOpensFirst)
{
  for (PetscInt weak = 0; weak < UNEVEN_CELLS; weak++) {
    double largest[2];

    StretchWithWeakCell(weak, 0.5, largest);
    assert_true(largest[0] > 2.0 * LAM_VISIBLE_GAP);
    assert_true(largest[1] < LAM_VISIBLE_GAP);
    StretchWithWeakCell(weak, 1.0, largest);
    assert_true(fmax(largest[0], largest[1]) < LAM_VISIBLE_GAP);
  }
}
