/* Patches between grips: P, tangent and couplings are derivatives of the energy, also where cells differ; turgor is
   cohesion; a single cell. */
#include "support/test.h"
#include "support/rve_fixture.h"
#include "separation.h"
#include "support/contact_tissue.h"

#define COLUMNS 3
#define ROWS 2

static LamMicrostructure Patch(LamInterfaceLawType interface, PetscInt columns, PetscInt rows)
{
  LamMicrostructure micro = ContactTissue(6, 2);

  micro.interface = interface;
  micro.is_patch = PETSC_TRUE;
  micro.cells[0] = columns;
  micro.cells[1] = rows;
  return micro;
}

/* Cells that differ in all that may differ; `cells` is where they are kept. */
static LamMicrostructure UnevenPatch(LamInterfaceLawType interface, LamCell cells[COLUMNS * ROWS])
{
  LamMicrostructure micro = Patch(interface, COLUMNS, ROWS);

  for (int c = 0; c < COLUMNS * ROWS; c++) {
    const double factor = 0.8 + 0.08 * c;

    cells[c] = (LamCell){.wall_thickness = 0.12 + 0.01 * c, .wall = micro.wall, .turgor = factor, .cohesion = factor};
    cells[c].wall.C1 *= factor;
    cells[c].wall.C4 /= factor;
  }
  micro.cell = cells;
  micro.orientation = 0.05;
  return micro;
}

/* Near it no contact opens or closes. */
static LamLoad PatchLoad(void)
{
  LamLoad load = ContactLoad(1, 0.1, 0, 1, 0.03, 0.005);

  load.F[8] = 1.03;
  return load;
}

/* What a response says of the energy: its derivative by a component of F, turgor or cohesion. */
static double Slope(const LamResponse *r, int column)
{
  if (column == CONTACT_TURGOR) return r->energy_turgor;
  return column == CONTACT_COHESION ? r->energy_cohesion : r->P[contact_components[column]];
}

static double Curvature(const LamResponse *r, int row, int column)
{
  if (column == CONTACT_TURGOR) return r->P_turgor[contact_components[row]];
  if (column == CONTACT_COHESION) return r->P_cohesion[contact_components[row]];
  return r->tangent[9 * contact_components[row] + contact_components[column]];
}

/* Fourth-order differences of the energy and of the stress in one column, from the state of `r`. */
static void Differences(LamRVE rve, LamRVEState centre, const LamResponse *r, int column, double *slope,
                        double curvature[5])
{
  static const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
  OWNED(LamRVEState, LamRVEStateDestroy) state;

  assert_int_equal(LamRVEStateCreate(rve, &state), 0);
  *slope = 0;
  for (int i = 0; i < 5; i++) curvature[i] = 0;
  for (int k = 0; k < 4; k++) {
    const double w = weight[k] / (12.0 * CONTACT_STEP), moved_by = step[k] * CONTACT_STEP;
    LamLoad load = r->load;
    LamResponse moved;

    if (column == CONTACT_TURGOR)
      load.turgor += moved_by;
    else if (column == CONTACT_COHESION)
      load.cohesion += moved_by;
    else
      load.F[contact_components[column]] += moved_by;
    assert_int_equal(LamRVEStateCopy(centre, state), 0);
    assert_int_equal(LamRVESolve(rve, &load, state, &moved), 0);
    assert_int_equal(moved.status, LAM_CONVERGED);
    *slope += w * moved.energy;
    for (int i = 0; i < 5; i++) curvature[i] += w * moved.P[contact_components[i]];
  }
}

static void CheckDerivatives(const LamMicrostructure *micro)
{
  const LamLoad load = PatchLoad();
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(micro);
  OWNED(LamRVEState, LamRVEStateDestroy) centre = NewState(rve);
  LamResponse r;

  assert_int_equal(LamRVESolve(rve, &load, centre, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  for (int column = 0; column < CONTACT_COLUMNS; column++) {
    double slope, curvature[5];

    if (column == CONTACT_COHESION && micro->interface == LAM_INTERFACE_BONDED) continue; /* it does not act */
    Differences(rve, centre, &r, column, &slope, curvature);
    assert_near(Slope(&r, column), slope, 1e-8);
    for (int i = 0; i < 5; i++) assert_near(Curvature(&r, i, column), curvature[i], 1e-7 * TangentScale(&r));
  }
}

TEST(DerivativesOfBondedPatches)
{
  LamCell cells[COLUMNS * ROWS];
  LamMicrostructure micro = UnevenPatch(LAM_INTERFACE_BONDED, cells);

  CheckDerivatives(&micro);
  micro.sides = LAM_SIDES_FREE;
  CheckDerivatives(&micro);
}

TEST(DerivativesOfPatchesInContact)
{
  LamCell cells[COLUMNS * ROWS];
  LamMicrostructure micro = UnevenPatch(LAM_INTERFACE_CONTACT, cells);

  CheckDerivatives(&micro);
}

/* Turgor p and cohesion g act through p + g but for -p J F^-T, where the outer walls follow F: the gaps that cohesion
   works on are all that lumens and walls leave. Exact as the walls become incompressible. */
TEST(TurgorIsCohesion)
{
  LamMicrostructure micro = Patch(LAM_INTERFACE_CONTACT, 2, 2);
  LamResponse p, g;

  micro.wall.bulk_modulus = 1e5;
  p = SolveTissue(&micro, ContactLoad(1.04, 0.1, 0, 1, 0.02, 0));
  g = SolveTissue(&micro, ContactLoad(1.04, 0.1, 0, 1, 0, 0.02));
  assert_int_equal(p.status, LAM_CONVERGED);
  assert_int_equal(g.status, LAM_CONVERGED);
  assert_true(g.opening_fraction > 1e-4);
  assert_near(p.opening_fraction, g.opening_fraction, 1e-6);
  /* cofactors of [[1.04, 0.1], [0, 1]] */
  assert_near(p.P[0] - g.P[0], -p.load.turgor * 1.0, 1e-5);
  assert_near(p.P[1] - g.P[1], 0.0, 1e-5);
  assert_near(p.P[3] - g.P[3], p.load.turgor * 0.1, 1e-5);
  assert_near(p.P[4] - g.P[4], -p.load.turgor * 1.04, 1e-5);
}

static LamResponse SolveMesh(PetscInt along, PetscInt through)
{
  LamMicrostructure micro = Patch(LAM_INTERFACE_BONDED, 2, 1);
  LamResponse r;

  micro.along = along;
  micro.through = through;
  r = SolveTissue(&micro, ContactLoad(1, 0.1, 0, 1, 0.02, 0));
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

/* Both ends of the only face are held: what holds them is no load on the lamella, and would grow as meshes get finer.
 */
TEST(ReactionsDoNotLoadTheLamella)
{
  const LamResponse coarse = SolveMesh(6, 2), fine = SolveMesh(12, 4), coarsest = SolveMesh(1, 1);

  assert_near(coarse.max_lamella_shear, fine.max_lamella_shear, 0.04 * fine.max_lamella_shear);
  assert_true(isfinite(coarsest.max_lamella_shear));
}

/* A single cell has nothing that could come apart, whatever the interface law, and no traction to tell. */
TEST(ASingleCellIsNotSeparated)
{
  for (int law = 0; law < LAM_INTERFACE_LAW_COUNT; law++) {
    const LamMicrostructure micro = Patch((LamInterfaceLawType)law, 1, 1);
    const LamResponse r = SolveTissue(&micro, ContactLoad(1, 0.1, 0, 1, 0.02, 0)), both[2] = {r, r};

    assert_int_equal(r.status, LAM_CONVERGED);
    assert_int_equal(LamSeparationOf(both), LAM_SEPARATION_NONE);
    assert_true(isnan(r.max_traction) && isnan(r.normal_place[0]));
    assert_true(law == LAM_INTERFACE_CONTACT ? r.max_lamella_shear == 0 : isnan(r.max_lamella_shear));
  }
}

TEST_GROUP(.petsc = 1);
