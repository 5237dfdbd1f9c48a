/* Patches of polygons: cells that meet grips and sides in a face, in a vertex only, many of them in one vertex. */
#include <polygons.h>
#include <malloc.h>
#include "support/random_reals.h"
#include "support/rve_fixture.h"
#include "mesh.h"

#define SIDE 3 /* squares along a side of the patch */
#define CELLS (2 * SIDE * SIDE)
#define VERTICES ((SIDE + 1) * (SIDE + 1))

typedef struct {
  LamPolygons p;
  PetscReal vertex[VERTICES][2], setback[VERTICES];
  PetscInt first[CELLS + 1], corner[4 * CELLS];
} Patch;

static void AddCell(Patch *patch, int corners, const int v[])
{
  PetscInt *end = &patch->first[++patch->p.cells];

  *end = end[-1] + corners;
  for (int k = 0; k < corners; k++) patch->corner[end[-1] + k] = v[k];
}

/* What is made of square k: 0, 1 two triangles by either diagonal, 2 one cell, 3 air. */
static LamTissue NewPatch(LamPatchSides sides, int n, const int kind[], double uneven, uint64_t *seed)
{
  Patch patch = {.p = {.name = "patch", .vertices = (n + 1) * (n + 1), .is_patch = PETSC_TRUE, .sides = sides}};
  PetscReal apothem;
  LamTissue tissue;

  for (int v = 0; v < patch.p.vertices; v++)
    for (int d = 0; d < 2; d++) {
      const int at = d ? v / (n + 1) : v % (n + 1);

      patch.vertex[v][d] = at + (at && at < n ? RandomReal(seed, -uneven, uneven) : 0.0);
    }
  for (int k = 0; k < n * n; k++) {
    const int a = k / n * (n + 1) + k % n, v[6] = {a, a + 1, a + n + 2, a + n + 1, a, a + 1};
    const int other[3] = {a, a + n + 2, a + n + 1};

    if (kind[k] == 0) {
      AddCell(&patch, 3, v);
      AddCell(&patch, 3, other);
    } else if (kind[k] == 1) {
      AddCell(&patch, 3, &v[1]);
      AddCell(&patch, 3, &v[3]);
    } else if (kind[k] == 2)
      AddCell(&patch, 4, v);
  }
  patch.p.vertex = patch.vertex;
  patch.p.first = patch.first;
  patch.p.corner = patch.corner;
  patch.p.setback = patch.setback;
  CHECK(LamTissueFromPolygons(&patch.p, &apothem, &tissue));
  return tissue;
}

static LamMicrostructure PatchOf(LamTissue tissue, LamPatchSides sides)
{
  LamMicrostructure micro = DefaultTissue();

  micro.tissue = tissue;
  micro.is_patch = PETSC_TRUE;
  micro.sides = sides;
  micro.along = 2;
  micro.through = 1;
  micro.wall_thickness = 0.06;
  return micro;
}

/* P F^T is symmetric, since the energy does not change when F is turned. */
static void AssertMomentsVanish(const LamMicrostructure *micro, const double F[4])
{
  const LamResponse r = SolveTissue(micro, PlaneLoad(F[0], F[1], F[2], F[3], 0.2));

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_near(r.P[0] * F[2] + r.P[1] * F[3] - r.P[3] * F[0] - r.P[4] * F[1], 0.0, 1e-9);
}

static void AssertSound(LamTissue tissue, LamPatchSides sides, uint64_t *seed)
{
  const LamMicrostructure micro = PatchOf(tissue, sides);
  const double rest[4] = {1, 0, 0, 1};
  double F[4];

  for (int k = 0; k < 4; k++) F[k] = rest[k] + RandomReal(seed, -0.05, 0.1);
  AssertMomentsVanish(&micro, rest);
  AssertMomentsVanish(&micro, F);
}

/* The diagonal ends at two corners of the square: at each of them one triangle is not on the grip. */
TEST(two_triangles_between_grips)
{
  static const LamPatchSides sides[2] = {LAM_SIDES_FREE, LAM_SIDES_AFFINE};
  uint64_t seed = 3;

  mallopt(M_PERTURB, 165); /* what was never set is no zero */
  for (int kind = 0; kind < 2; kind++)
    for (int k = 0; k < 2; k++) {
      OWNED(LamTissue, LamTissueDestroy) tissue = NewPatch(sides[k], 1, &kind, 0.0, &seed);

      AssertSound(tissue, sides[k], &seed);
    }
  mallopt(M_PERTURB, 0);
}

TEST(random_patches)
{
  uint64_t seed = 7;

  mallopt(M_PERTURB, 165);
  for (int run = 0; run < 12; run++) {
    const LamPatchSides sides = run % 2 ? LAM_SIDES_FREE : LAM_SIDES_AFFINE;
    int kind[SIDE * SIDE];

    for (int k = 0; k < SIDE * SIDE; k++) kind[k] = (int)RandomReal(&seed, 0, 3);
    if (run % 3 == 0) kind[SIDE + 1] = 3;
    OWNED(LamTissue, LamTissueDestroy) tissue = NewPatch(sides, SIDE, kind, 0.2, &seed);

    AssertSound(tissue, sides, &seed);
  }
  mallopt(M_PERTURB, 0);
}

/* Outer nodes at one place have one position; at a held wall all of them follow F. */
TEST(bonded_nodes_at_one_place_are_one)
{
  uint64_t seed = 11;

  for (int run = 0; run < 8; run++) {
    const LamPatchSides sides = run % 2 ? LAM_SIDES_FREE : LAM_SIDES_AFFINE;
    int kind[SIDE * SIDE];

    for (int k = 0; k < SIDE * SIDE; k++) kind[k] = (int)RandomReal(&seed, 0, 3);
    OWNED(LamTissue, LamTissueDestroy) tissue = NewPatch(sides, SIDE, kind, 0.2, &seed);
    const LamMicrostructure micro = PatchOf(tissue, sides);
    OWNED(LamMesh, LamMeshDestroy) mesh;
    const PetscInt layers = 2 * micro.through + 1;

    CHECK(LamMeshCreate(&micro, &mesh));
    for (PetscInt i = layers - 1; i < mesh.node_count; i += layers)
      for (PetscInt j = layers - 1; j < i; j += layers)
        if (hypot(mesh.X[2 * i] - mesh.X[2 * j], mesh.X[2 * i + 1] - mesh.X[2 * j + 1]) < 1e-9)
          assert_int_equal(mesh.node_class[i], mesh.node_class[j]);
    for (PetscInt i = 0; i < mesh.node_count; i++)
      for (int d = 0; d < 2; d++)
        assert_near(mesh.class_X[2 * mesh.node_class[i] + d] + mesh.shift[2 * i + d], mesh.X[2 * i + d], 1e-12);
  }
}

/* With affine sides the walls at the outside follow F, those of an air space within the patch do not. */
TEST(walls_of_air_within_a_patch_are_free)
{
  const int kind[9] = {2, 2, 2, 2, 3, 2, 2, 2, 2};
  uint64_t seed = 1;
  OWNED(LamTissue, LamTissueDestroy) tissue = NewPatch(LAM_SIDES_AFFINE, 3, kind, 0.0, &seed);
  int held = 0, borders = 0;

  for (PetscInt k = 0; k < tissue->faces; k++) {
    held += tissue->held[k];
    borders += tissue->partner[k] < 0;
  }
  assert_int_equal(borders, 16);
  assert_int_equal(held, 12);
}

TEST_GROUP(.petsc = 1);
