/* Databases of tissue of polygons against solves: of symmetries they know those that the tissue has. */
#include "support/test.h"
#include <grid.h>
#include <load.h>
#include <lamella/lamella.h>
#include "support/polygons.h"
#include "support/random_reals.h"
#include "support/table_fixture.h"
#include "support/tissue.h"

#define ACCURACY 0.01
enum { STATES = 12 };

TEST_GROUP(.petsc = 1);

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamResponder solver;
  LamDatabase database;
} Tissue;

/* n x n cells, coarse. */
static Tissue Start(PetscInt n, Displacement displace, LamInterfaceLawType law)
{
  static const char text[] = "version: 1\n"
                             "rve:\n"
                             "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                             "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                             "  mesh: {along: 4, through: 1}\n"
                             "sample:\n"
                             "  stretch: {min: -0.02, max: 0.25}\n"
                             "  turgor: {min: 0.01 MPa, max: 0.05 MPa}\n";
  Tissue t;
  LamGrid grid;

  CHECK(LamSceneReadText("test_tissue_table", text, &t.scene));
  t.scene->micro.interface = law;
  CHECK(PolygonsCreate(n, displace, &t.scene->micro.tissue));
  t.scene->micro.cells[0] = n * n;
  CHECK(NewTissue(&t.scene->micro, &t.rve, NULL));
  CHECK(LamRVEResponderCreate(t.rve, 0, &t.solver));
  CHECK(LamGridCreate(t.scene, t.solver, &grid));
  CHECK(LamDatabaseCreateEmpty(t.scene, &t.database));
  CHECK(LamDatabaseSetGrid(t.database, &grid));
  return t;
}

static void Finish(Tissue *t)
{
  CHECK(LamDatabaseClose(&t->database));
  CHECK(LamResponderDestroy(&t->solver));
  CHECK(LamRVEDestroy(&t->rve));
  CHECK(LamSceneDestroy(&t->scene));
}
#define TISSUE(n, displace) OWNED(Tissue, Finish) t = Start(n, displace, LAM_INTERFACE_BONDED)

/* U with principal stretches of the box in any direction. */
static LamLoad RandomLoad(uint64_t *seed, const LamSample *box)
{
  const double first = RandomReal(seed, box->stretch_min, box->stretch_max);
  const double second = RandomReal(seed, box->stretch_min, box->stretch_max);

  return LamLoadOfStrains(first, second, RandomReal(seed, 0, PETSC_PI),
                          RandomReal(seed, box->turgor_min, box->turgor_max), 0);
}

static LamResponse Solve(const Tissue *t, const LamLoad *load)
{
  LamResponse r;

  CHECK(LamResponderRespond(t->solver, 1, load, NULL, &r));
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

/* Largest error of the table over states in all directions, as a multiple of the accuracy. */
static double LargestError(Tissue *t)
{
  double largest = 0;
  uint64_t seed = 3;

  for (int i = 0; i < STATES; i++) {
    const LamLoad load = RandomLoad(&seed, &t->scene->sample);
    const LamResponse solve = Solve(t, &load);
    LamResponse answer;
    LamTable table;

    CHECK(RefineTable(t->database, t->solver, &load, ACCURACY));
    CHECK(LamDatabaseGetTable(t->database, &table));
    CHECK(LamTableQuery(table, &load, ACCURACY, &answer));
    CHECK(LamTableDestroy(&table));
    assert_int_equal(answer.status, LAM_CONVERGED);
    largest = PetscMax(largest, StressError(answer.P, solve.P));
  }
  return largest / ACCURACY;
}

static PetscBool IsSymmetric(const Tissue *t)
{
  LamGrid grid;

  CHECK(LamDatabaseGetGrid(t->database, &grid));
  return grid->symmetric;
}

TEST(a_sheared_cell_answers_in_all_directions)
{
  TISSUE(1, Sheared);

  assert_false(IsSymmetric(&t));
  assert_true(LargestError(&t) < 2);
}

TEST(irregular_cells_answer_in_all_directions)
{
  TISSUE(2, Waves);

  assert_false(IsSymmetric(&t));
  assert_true(LargestError(&t) < 2);
}

TEST(hexagons_as_polygons_have_a_sixth_of_the_nodes)
{
  TISSUE(2, NotDisplaced);

  assert_true(IsSymmetric(&t));
  assert_true(LargestError(&t) < 2);
}

/* Known without a table: cells that touch no neighbour, if one width tells where they do. */
static PetscInt FreeStates(Displacement displace)
{
  OWNED(Tissue, Finish) t = Start(1, displace, LAM_INTERFACE_CONTACT);
  LamGrid grid;

  CHECK(LamDatabaseGetGrid(t.database, &grid));
  return grid->free.n;
}

TEST_IS(a_hexagon_as_a_polygon_floats_as_a_hexagon_does, assert_true(FreeStates(NotDisplaced) > 0));
TEST_IS(a_sheared_cell_has_no_one_width, assert_int_equal(FreeStates(Sheared), 0));

/* A state of one side of the mirror, asked on the other. */
static double ErrorOfTheImage(Tissue *t)
{
  const LamLoad load = LamLoadOfStrains(0.15, -0.01, 0.5, 0.2, 0),
                mirrored = LamLoadOfStrains(0.15, -0.01, -0.5, 0.2, 0);
  const LamResponse record = Solve(t, &load), solve = Solve(t, &mirrored);
  LamResponse answer;

  CHECK(LamDatabaseAdd(t->database, 1, NULL, &record));
  CHECK(LamDatabaseQuery(t->database, &mirrored, ACCURACY, &answer));
  if (answer.status != LAM_CONVERGED) return INFINITY;
  return StressError(answer.P, solve.P);
}

TEST(a_record_answers_in_the_mirror_that_the_tissue_has)
{
  TISSUE(2, MirroredWaves);

  assert_true(ErrorOfTheImage(&t) < 1e-8);
}

TEST(a_record_does_not_answer_in_a_mirror_that_the_tissue_lacks)
{
  TISSUE(2, Waves);

  assert_true(ErrorOfTheImage(&t) == INFINITY);
}
