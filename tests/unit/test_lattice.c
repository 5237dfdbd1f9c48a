/* Which cells lie side by side, and which outer walls follow F, is what the mesh has. */
#include "support/test.h"
#include <lamella/lattice.h>
#include <mesh.h>

static const LamMicrostructure blocks[] = {
    {.cells = {1, 1}},
    {.cells = {2, 3}},
    {.is_patch = PETSC_TRUE, .sides = LAM_SIDES_AFFINE, .cells = {4, 3}},
    {.is_patch = PETSC_TRUE, .sides = LAM_SIDES_FREE, .cells = {3, 4}},
    {.is_patch = PETSC_TRUE, .sides = LAM_SIDES_FREE, .cells = {1, 1}},
};
enum { BLOCKS = sizeof(blocks) / sizeof(blocks[0]) };

static LamMicrostructure Block(int i, double degrees)
{
  LamMicrostructure micro = blocks[i];

  micro.orientation = degrees * PETSC_PI / 180;
  micro.wall_thickness = 0.2;
  micro.along = micro.through = 1;
  return micro;
}

TEST(neighbours_and_held_walls_are_those_of_the_mesh)
{
  for (int i = 0; i < BLOCKS; i++)
    for (int degrees = -360; degrees <= 360; degrees += 10) {
      const LamMicrostructure micro = Block(i, degrees);
      OWNED(LamMesh, LamMeshDestroy) mesh;

      assert_int_equal(LamMeshCreate(&micro, &mesh), 0);
      for (PetscInt k = 0; k < LAM_FACES * mesh.cell_count; k++) {
        PetscBool held;

        assert_int_equal(LamLatticeNeighbour(&micro, k / LAM_FACES, k % LAM_FACES, NULL, &held), LamMeshNeighbour(&mesh, k));
        assert_int_equal(held, mesh.tissue->held[k]);
      }
    }
}

/* Centre of a cell, from its coordinates. */
static void Centre(const LamMicrostructure *micro, PetscInt cell, double X[2])
{
  PetscInt index[2];

  LamLatticeIndex(micro, cell, index);
  X[0] = X[1] = 0;
  for (int k = 0; k < 2; k++) {
    X[0] += 2 * index[k] * cos(micro->orientation + k * PETSC_PI / 3);
    X[1] += 2 * index[k] * sin(micro->orientation + k * PETSC_PI / 3);
  }
}

/* The neighbour's centre, or that of its image, is one lattice vector away. */
TEST(a_neighbour_lies_across_its_face)
{
  for (int i = 0; i < BLOCKS; i++)
    for (int degrees = -180; degrees <= 180; degrees += 15) {
      const LamMicrostructure micro = Block(i, degrees);

      for (PetscInt k = 0; k < LAM_FACES * micro.cells[0] * micro.cells[1]; k++) {
        const PetscInt face = k % LAM_FACES;
        const double angle = micro.orientation + face * PETSC_PI / 3;
        PetscInt wraps[2], other = LamLatticeNeighbour(&micro, k / LAM_FACES, face, wraps, NULL);
        double X[2], Y[2];

        if (other < 0) continue;
        Centre(&micro, k / LAM_FACES, X);
        Centre(&micro, other, Y);
        for (int d = 0; d < 2; d++) {
          const double turn = micro.orientation + d * PETSC_PI / 3;

          Y[0] += 2 * (double)(wraps[d] * micro.cells[d]) * cos(turn);
          Y[1] += 2 * (double)(wraps[d] * micro.cells[d]) * sin(turn);
        }
        assert_near(Y[0] - X[0], 2 * cos(angle), 1e-12);
        assert_near(Y[1] - X[1], 2 * sin(angle), 1e-12);
      }
    }
}

TEST(distances_are_those_of_the_plane)
{
  assert_near(LamLatticeDistance(1, 0), 1.0, 0.0);
  assert_near(LamLatticeDistance(-1, 1), 1.0, 0.0);
  assert_near(LamLatticeDistance(1, 1), sqrt(3.0), 1e-15);
  assert_near(LamLatticeDistance(3, -1), sqrt(7.0), 1e-15);
}

/* Below two cells of row 1, between three columns and rows standing on a corner: each of them faces two below. */
TEST(a_notch_cuts_the_faces_below_its_cells)
{
  LamMicrostructure micro = {.is_patch = PETSC_TRUE, .cells = {3, 3}, .notch_row = 1, .notch_columns = 2};
  PetscInt cut = 0;

  for (PetscInt k = 0; k < LAM_FACES * 9; k++) {
    const PetscInt cell = k / LAM_FACES, other = LamLatticeNeighbour(&micro, cell, k % LAM_FACES, NULL, NULL);

    if (other < 0 || !LamLatticeIsCut(&micro, cell, other)) continue;
    assert_true(LamLatticeIsCut(&micro, other, cell));
    assert_true(cell % 3 != other % 3 && cell % 3 < 2 && other % 3 < 2);
    cut++;
  }
  assert_int_equal(cut, 2 * 4); /* from both sides */
  micro.notch_columns = 0;
  for (PetscInt k = 0; k < LAM_FACES * 9; k++) {
    const PetscInt other = LamLatticeNeighbour(&micro, k / LAM_FACES, k % LAM_FACES, NULL, NULL);

    assert_false(other >= 0 && LamLatticeIsCut(&micro, k / LAM_FACES, other));
  }
}
