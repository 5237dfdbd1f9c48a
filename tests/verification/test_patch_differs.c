/* Patches between grips: P, tangent and couplings are derivatives of the energy, also where cells differ; turgor is
   cohesion; a single cell. */
#include "support/rve_fixture.h"
#include "separation.h"

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

static void CheckDerivatives(const LamMicrostructure *micro)
{
  const ContactState state = {.micro = *micro, .load = PatchLoad(), .step = CONTACT_STEP};
  ContactDerivativeError e;
  ContactSweep sweep;

  CHECK(SweepContact(&state, &sweep));
  assert_int_equal(sweep.response.status, LAM_CONVERGED);
  assert_int_equal(sweep.switches, 0);
  e = DerivativeError(&sweep);
  assert_near(e.stress, 0.0, 1e-8);
  assert_near(e.turgor, 0.0, 1e-8);
  assert_near(e.cohesion, 0.0, 1e-8);
  assert_near(e.tangent, 0.0, 1e-7);
  assert_near(e.turgor_coupling, 0.0, 1e-7 * TangentScale(&sweep.response));
  assert_near(e.cohesion_coupling, 0.0, 1e-7 * TangentScale(&sweep.response));
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
