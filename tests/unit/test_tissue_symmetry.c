/* The motions that map a tissue onto itself. */
#include "support/polygons.h"
#include "support/test.h"
#include <lamella/tissue.h>

enum { ROTATIONS = 63, ALL = 4095, HALF_TURN = 1 << 3, MIRROR = 1 << 6, OTHER_MIRROR = 1 << 9 };

/* Bit k: rotation by 60 k degrees; bit 6 + k: behind a mirror along face normal 0. */
static int Motions(const LamMicrostructure *micro)
{
  LamSymmetry symmetry;
  int motions = 0;

  CHECK(LamMicrostructureSymmetry(micro, &symmetry));
  for (int k = 0; k < 2 * LAM_DIRECTIONS; k++) motions |= symmetry.has[k / LAM_DIRECTIONS][k % LAM_DIRECTIONS] << k;
  return motions;
}

static LamMicrostructure Hexagons(PetscInt columns, PetscInt rows, PetscReal orientation)
{
  return (LamMicrostructure){.wall_thickness = 0.15, .cells = {columns, rows}, .orientation = orientation};
}

typedef struct {
  LamMicrostructure micro;
} Polygons;

static Polygons Make(PetscInt n, Displacement displace)
{
  Polygons p = {{.wall_thickness = 0.15, .cells = {n * n, 1}}};

  CHECK(PolygonsCreate(n, displace, &p.micro.tissue));
  return p;
}

static void Destroy(Polygons *p)
{
  CHECK(LamTissueDestroy(&p->micro.tissue));
}
#define POLYGONS(n, displace) OWNED(Polygons, Destroy) p = Make(n, displace)

TEST(hexagons_have_all_motions_that_their_period_has)
{
  const LamMicrostructure one = Hexagons(1, 1, 0), four = Hexagons(2, 2, 0.3), two = Hexagons(2, 1, 0),
                          six = Hexagons(2, 3, 0);

  assert_int_equal(Motions(&one), ALL);
  assert_int_equal(Motions(&four), ALL);
  assert_int_equal(Motions(&two), 1 | HALF_TURN | 1 << 8 | 1 << 11); /* mirrors along and across lattice vector 1 */
  assert_int_equal(Motions(&six), 1 | HALF_TURN);
}

TEST(hexagons_as_polygons_have_all_motions)
{
  for (PetscInt n = 1; n <= 3; n++) {
    POLYGONS(n, NotDisplaced);

    assert_int_equal(Motions(&p.micro), ALL);
  }
}

/* Mirrors are looked for along and across normals of the orientation alone. */
TEST(hexagons_turned_against_the_orientation_have_rotations_alone)
{
  POLYGONS(2, NotDisplaced);

  p.micro.orientation = 0.1;
  assert_int_equal(Motions(&p.micro), ROTATIONS);
}

TEST(stretched_hexagons_keep_two_mirrors)
{
  POLYGONS(2, Stretched);

  assert_int_equal(Motions(&p.micro), 1 | HALF_TURN | MIRROR | OTHER_MIRROR);
}

TEST(sheared_hexagons_keep_the_half_turn)
{
  POLYGONS(2, Sheared);

  assert_int_equal(Motions(&p.micro), 1 | HALF_TURN);
}

TEST(irregular_cells_have_no_motion)
{
  for (PetscInt n = 2; n <= 4; n++) {
    POLYGONS(n, Waves);

    assert_int_equal(Motions(&p.micro), 1);
  }
}

TEST(mirrored_cells_have_their_mirror)
{
  for (PetscInt n = 2; n <= 4; n++) {
    POLYGONS(n, MirroredWaves);

    assert_int_equal(Motions(&p.micro), 1 | MIRROR);
  }
}

TEST(centred_cells_have_their_half_turn)
{
  POLYGONS(3, OddWaves);

  assert_int_equal(Motions(&p.micro), 1 | HALF_TURN);
}

TEST(a_corner_that_moves_by_little_more_than_rounding_breaks_the_symmetry)
{
  POLYGONS(2, NotDisplaced);

  p.micro.tissue->corner[0][0] += 1e-11;
  assert_int_equal(Motions(&p.micro), ALL);
  p.micro.tissue->corner[0][0] += 1e-8;
  assert_int_equal(Motions(&p.micro), 1);
}

TEST(one_corner_with_more_air_breaks_the_rotations)
{
  POLYGONS(2, NotDisplaced);

  p.micro.tissue->setback[0] += 0.01;
  assert_int_equal(Motions(&p.micro) & ROTATIONS, 1);
}

TEST(one_thicker_wall_breaks_the_rotations)
{
  POLYGONS(2, NotDisplaced);

  p.micro.tissue->share[0] = 1.1;
  assert_int_equal(Motions(&p.micro) & ROTATIONS, 1);
}

TEST(cells_go_to_like_cells)
{
  LamCell cell[4];
  POLYGONS(2, NotDisplaced);

  for (int c = 0; c < 4; c++) cell[c] = (LamCell){.wall_thickness = 0.15, .turgor = 1, .cohesion = 1};
  p.micro.cell = cell;
  assert_int_equal(Motions(&p.micro), ALL);
  cell[3].turgor = 0.5; /* the centre of all motions */
  assert_int_equal(Motions(&p.micro), ALL);
  cell[2].turgor = 0.25;
  assert_int_equal(Motions(&p.micro) & ROTATIONS, 1 | HALF_TURN);
}

TEST(classes_of_faces_go_to_classes)
{
  POLYGONS(1, NotDisplaced);

  for (int k = 0; k < LAM_DIRECTIONS; k++) p.micro.tissue->direction[k] = k < LAM_DIRECTIONS / 2 ? 0 : 3;
  assert_int_equal(Motions(&p.micro) & ROTATIONS, 1 | HALF_TURN);
}

TEST(a_patch_has_no_motion)
{
  LamMicrostructure micro = Hexagons(2, 2, 0);

  micro.is_patch = PETSC_TRUE;
  assert_int_equal(Motions(&micro), 1);
}
