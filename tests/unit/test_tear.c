/* The layer of a period, and what is read off a curve of `tear`. */
#include "support/test.h"
#include <math.h>
#include "tear.h"

static LamMicrostructure Tissue(PetscInt columns, PetscInt rows, PetscReal degrees)
{
  LamMicrostructure micro = {.wall_thickness = 0.15,
                             .cells = {columns, rows},
                             .orientation = degrees * PETSC_PI / 180,
                             .interface = LAM_INTERFACE_LAMELLA,
                             .lamella = LAM_LAMELLA_UNIFORM};

  micro.lamella.strength = micro.lamella.shear_strength = 0.4;
  micro.lamella.energy = micro.lamella.shear_energy = 0.3;
  return micro;
}

static const LamCell plain = {.wall_thickness = 0.15, .turgor = 1, .lamella_strength = 1, .lamella_energy = 1};

static void AssertLayer(const LamMicrostructure *micro, PetscReal width, PetscReal height, PetscReal energy)
{
  LamTearLayer layer;

  CHECK(LamTearLayerOf("scene.yaml", micro, &layer));
  assert_near(layer.width, width, 1e-12);
  assert_near(layer.height, height, 1e-12);
  assert_near(layer.energy, energy, 1e-12);
}

/* Of cells on a corner a crack runs along two faces, 2/sqrt(3) long, in each width of two apothems; of cells on an edge
   along four in a width of two rows, 2 sqrt(3). */
TEST(a_layer_is_a_period_across_rows_of_cells)
{
  const PetscReal face = 2 / sqrt(3.0);

  for (int turn = -2; turn < 4; turn++) {
    const LamMicrostructure corner = Tissue(1, 1, 60 * turn), edge = Tissue(2, 2, 30 + 60 * turn);

    AssertLayer(&corner, 2, sqrt(3.0), 0.3 * 2 * face / 2);
    AssertLayer(&edge, 4 * sqrt(3.0), 2, 0.3 * 8 * face / (4 * sqrt(3.0)));
  }
  const LamMicrostructure tall = Tissue(1, 3, 0), wide = Tissue(3, 1, 0);

  AssertLayer(&tall, 2, 3 * sqrt(3.0), 0.3 * face);
  AssertLayer(&wide, 6, sqrt(3.0), 0.3 * face);
}

TEST(a_straight_crack_takes_the_row_with_the_least_energy)
{
  const PetscReal face = 2 / sqrt(3.0);
  LamCell cell[3] = {plain, plain, plain};
  LamMicrostructure micro = Tissue(1, 3, 0);

  micro.cell = cell;
  cell[1].lamella_energy = 0.5;
  AssertLayer(&micro, 2, 3 * sqrt(3.0), 0.15 * face);
  micro.lamella.face_energy[1] = 3; /* one of the two families that it cuts */
  AssertLayer(&micro, 2, 3 * sqrt(3.0), 0.15 * face * (1 + 3) / 2);
  micro.lamella.face_energy[0] = 7; /* the other family: it stands upright */
  AssertLayer(&micro, 2, 3 * sqrt(3.0), 0.15 * face * (1 + 3) / 2);
}

TEST(junctions_count_with_their_length)
{
  LamMicrostructure micro = Tissue(1, 1, 0);

  micro.lamella.junction_length = 0.1;
  micro.lamella.junction_energy = 3;
  AssertLayer(&micro, 2, sqrt(3.0), 0.3 * (2 / sqrt(3.0) - 0.2 + 3 * 0.2));
}

TEST(tissue_without_rows_along_the_layer_is_refused)
{
  const LamMicrostructure askew = Tissue(1, 1, 10), half = Tissue(1, 1, 30);
  LamTearLayer layer;

  CHECK(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  assert_int_equal(LamTearLayerOf("scene.yaml", &askew, &layer), PETSC_ERR_USER_INPUT);
  assert_int_equal(LamTearLayerOf("scene.yaml", &half, &layer), PETSC_ERR_USER_INPUT);
  CHECK(PetscPopErrorHandler());
}

TEST(readings_are_those_of_the_curve)
{
  LamTearPoint points[] = {
      {.is_state = 1},
      {.is_state = 1, .separation = 1, .traction = 2, .crack = 0.2, .dissipated = 0.1},
      {.separation = 1, .traction = 1.5, .crack = 0.6}, /* in a fall */
      {.is_state = 1, .separation = 2, .traction = 1, .crack = 1.6, .dissipated = 1.2, .released = 0.2},
      {.is_state = 1, .separation = 3, .crack = 3, .work = 2.5, .stored = -0.5, .dissipated = 2.1, .released = 0.7}};
  const LamTearCurve curve = {.count = 5, .points = points};
  const LamTearReadings r = LamTearRead(&curve);

  assert_near(r.strength, 2, 0);
  assert_near(r.at, 1, 0);
  assert_near(r.energy, 2.8, 1e-15);
  assert_near(r.share, 0.25, 1e-15);
  assert_near(r.law, 0.2 + 1.75 * 0.4 + 1.25 * 1.0 + 0.5 * 1.4, 1e-15);
  assert_near(r.imbalance, 2.5 + 0.5 - 2.8, 1e-15); /* what was released is not what is left */
  assert_int_equal(r.states, 4);
}

TEST_GROUP(.petsc = 1);
