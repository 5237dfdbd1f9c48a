/* Claims about the meshes of the macroscale solver: discs, Gmsh files, and what holds bodies that are no box. */
#include "support/gmsh_writer.h"
#include "support/error_message.h"
#include "support/macro_fixture.h"
#include "macro_impl.h"
#include <unistd.h>

#define TWO_REGIONS LAMELLA_SOURCE_DIR "/tests/verification/data/two-regions.msh"

static void UseGmsh(Fixture *fixture, const char path[])
{
  fixture->scene.macro.source = LAM_MESH_GMSH;
  strcpy(fixture->scene.macro.gmsh, path);
}

static PetscReal Area(LamMacro macro)
{
  PetscReal area = 0;

  for (PetscInt p = 0; p < macro->point_count; p++) area += macro->weight[p];
  MPI_Allreduce(MPI_IN_PLACE, &area, 1, MPIU_REAL, MPI_SUM, macro->comm);
  return area;
}

/* Error of the area of a part of a disc of radius 1. */
static PetscReal DiscError(LamDiscPart part, PetscInt along)
{
  static const PetscReal share[] = {1, 0.5, 0.5, 0.25};
  PetscReal error;
  FIXTURE fixture;

  FixtureScene(&fixture, 1, 1, 1, 1);
  FixtureDisc(&fixture, part, along, along);
  FixtureBoundary(&fixture, "rim", 0, 0);
  FixtureSetUp(&fixture, PETSC_COMM_WORLD);
  error = PetscAbsReal(Area(fixture.macro) - PETSC_PI * share[part]);
  return error;
}

/* Quadratic edges miss a circle's area by O(h^4). */
TEST(DiscsHaveTheirArea)
{
  for (LamDiscPart part = LAM_DISC_WHOLE; part < LAM_DISC_PART_COUNT; part++) {
    const PetscReal coarse = DiscError(part, 2), fine = DiscError(part, 4);
    assert_true(fine < 1e-4);
    assert_true(coarse / fine > 14 && coarse / fine < 18);
  }
}

MACRO_TEST(RimNodesAreOnTheCircle)
{
  PetscInt nodes = 0;

  FixtureScene(fixture, 1, 1, 1, 1);
  FixtureDisc(fixture, LAM_DISC_HALF, 3, 2);
  FixtureBoundary(fixture, "rim", 0, 0);
  FixtureSetUp(fixture, PETSC_COMM_SELF);
  LamMacro macro = fixture->macro;
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    const PetscReal *X = &macro->position[2 * (p - macro->mesh_start)];
    if (!LamMacroIsOn(macro, p, "rim")) continue;
    assert_true(PetscAbsReal(X[0] * X[0] + X[1] * X[1] - 1) < 1e-14);
    nodes++;
  }
  assert_int_equal(nodes, 2 * 12 + 1); /* 12 edges along half a circle */
}

/* Distorted triangles and quadrilaterals of two regions: homogeneous deformation is exact, as in a box. */
MACRO_TEST(GmshIsAsGoodAsABox)
{
  const LamLoad load = {.F = {1.2, 0, 0, 0, 0.9, 0, 0, 0, 1}};
  const char(*groups)[LAM_NAME_LENGTH];
  PetscInt group_count;
  LamResponse exact;

  FixtureScene(fixture, 1, 1, 1, 2);
  UseGmsh(fixture, TWO_REGIONS);
  FixtureBoundary(fixture, "left", 0, NAN);
  FixtureBoundary(fixture, "right", 0.2, NAN);
  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureBoundary(fixture, "top", NAN, -0.1);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  CHECK(LamMacroGetGroups(fixture->macro, &group_count, &groups));
  assert_int_equal(group_count, 2);
  assert_true(PetscAbsReal(Area(fixture->macro) - 1) < 1e-14);
  FixtureSolve(fixture, LAM_MACRO_DONE);
  CHECK(LamResponseInit(&load, &exact));
  SyntheticEvaluate(fixture->material, &load, &exact);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < 9 * fields->element_count; k++) {
    assert_true(PetscAbsReal(fields->F[k] - load.F[k % 9]) < 1e-12);
    assert_true(PetscAbsReal(fields->P[k] - exact.P[k % 9]) < 1e-12);
  }
  assert_true(PetscAbsReal(FixtureReaction(fixture, "right")[0] - exact.P[0]) < 1e-11);
}

/* Second-order elements with curved edges inside the square: homogeneous deformation is exact. */
TEST(CurvedElementsPassThePatchTest)
{
  for (GmshElements elements = GMSH_CURVED; elements <= GMSH_CURVED_MIXED; elements++) {
    FIXTURE fixture;

    FixtureScene(&fixture, 1, 1, 1, 1);
    fixture.scene.macro.source = LAM_MESH_GMSH;
    GmshWrite(fixture.scene.macro.gmsh, 3, 4, elements, GmshDistorted);
    FixtureBoundary(&fixture, "left", 0, NAN);
    FixtureBoundary(&fixture, "right", 0.2, NAN);
    FixtureBoundary(&fixture, "bottom", NAN, 0);
    FixtureBoundary(&fixture, "top", NAN, -0.1);
    FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
    remove(fixture.scene.macro.gmsh);
    const LamMacroFields *fields = FixtureFields(&fixture);
    for (PetscInt k = 0; k < 9 * fields->element_count; k++)
      assert_near(fields->F[k], ((PetscReal[]){1.2, 0, 0, 0, 0.9, 0, 0, 0, 1})[k % 9], 1e-12);
  }
}

/* Of a quarter of a ring with radii 1 and 2. */
static void QuarterRing(double X[2])
{
  const double radius = 1 + X[0], angle = 0.5 * PETSC_PI * X[1];

  X[0] = radius * cos(angle);
  X[1] = radius * sin(angle);
}

/* Second-order edges miss the area by O(h^4). */
TEST(CurvedElementsHaveTheirArea)
{
  for (GmshElements elements = GMSH_CURVED; elements <= GMSH_CURVED_MIXED; elements++) {
    PetscReal error[2];

    for (int fine = 0; fine < 2; fine++) {
      FIXTURE fixture;

      FixtureScene(&fixture, 1, 1, 1, 1);
      fixture.scene.macro.source = LAM_MESH_GMSH;
      GmshWrite(fixture.scene.macro.gmsh, 4 << fine, 4 << fine, elements, QuarterRing);
      FixtureBoundary(&fixture, "left", 0, 0);
      FixtureSetUp(&fixture, PETSC_COMM_WORLD);
      remove(fixture.scene.macro.gmsh);
      error[fine] = PetscAbsReal(Area(fixture.macro) - 0.75 * PETSC_PI);
    }
    assert_true(error[1] < 1e-5 && error[0] / error[1] > 14);
  }
}

static const PetscReal ANGLE = 0.4;

static void Turned(double X[2])
{
  const double s = X[0], t = X[1];

  X[0] = cos(ANGLE) * s - sin(ANGLE) * t;
  X[1] = sin(ANGLE) * s + cos(ANGLE) * t;
}

/* Oblique sides of symmetry: a turned square under pressure is the upright one turned. */
TEST(ObliqueSymmetryIsUprightTurned)
{
  static const char *const sides[] = {"right", "top"};
  char path[PETSC_MAX_PATH_LEN];
  PetscReal P[2][4], force[2];

  GmshWrite(path, 3, 3, GMSH_QUADRILATERALS, Turned);
  for (int turned = 0; turned < 2; turned++) {
    FIXTURE fixture;
    OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;
    FixtureScene(&fixture, 3, 3, 1, 2);
    if (turned) UseGmsh(&fixture, path);
    FixtureSymmetry(&fixture);
    for (int s = 0; s < 2; s++) {
      LamBoundary *boundary = FixtureAdd(&fixture, sides[s], LAM_BOUNDARY_TRACTION);
      boundary->follower = PETSC_TRUE;
      boundary->traction[1] = s ? 0.2 : -0.3;
    }
    FixtureRun(&fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
    CHECK(LamMacroGetFields(fixture.macro, &fields));
    for (int ij = 0; ij < 4; ij++) P[turned][ij] = fields.P[3 * (ij / 2) + ij % 2];
    const PetscReal *left = FixtureReaction(&fixture, "left");
    force[turned] = PetscSqrtReal(left[0] * left[0] + left[1] * left[1]);
  }
  remove(path);
  const PetscReal c = cos(ANGLE), s = sin(ANGLE), Q[4] = {c, -s, s, c};
  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < 2; j++) {
      PetscReal sum = 0;
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) sum += Q[2 * i + k] * P[0][2 * k + l] * Q[2 * j + l];
      assert_true(PetscAbsReal(sum - P[1][2 * i + j]) < 1e-9);
    }
  }
  assert_true(PetscAbsReal(force[0] - force[1]) < 1e-9);
}

/* Two points of a body hold it, one does not: a disc whose rim is free along X2 can still move. */
MACRO_TEST(LooseDiscIsRefused)
{
  FixtureScene(fixture, 1, 1, 1, 1);
  FixtureDisc(fixture, LAM_DISC_WHOLE, 2, 2);
  FixtureBoundary(fixture, "rim", 0, NAN);
  FixtureRefused(fixture);
}

/* Two squares of one element, one above the other, a tenth apart: bottom and upper side of the one and of the other. */
static void TwoSquares(Fixture *fixture, const char *const names[4])
{
  char *path = fixture->scene.macro.gmsh;
  FILE *file;

  fixture->scene.macro.source = LAM_MESH_GMSH;
  strcpy(path, "/tmp/lamella-XXXXXX");
  file = fdopen(mkstemp(path), "w");
  assert_non_null(file);
  fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n");
  for (int k = 0; k < 4; k++) fprintf(file, "1 %d \"%s\"\n", k + 1, names[k]);
  fprintf(file, "$EndPhysicalNames\n$Nodes\n8\n");
  for (int k = 0; k < 8; k++)
    fprintf(file, "%d %d %g 0\n", k + 1, (k & 1) ^ (k >> 1 & 1), (k >> 1 & 1) + 1.1 * (k >> 2));
  fprintf(file, "$EndNodes\n$Elements\n6\n");
  for (int k = 0; k < 4; k++) fprintf(file, "%d 1 2 %d 1 %d %d\n", k + 1, k + 1, 2 * k + 1, 2 * k + 2);
  for (int k = 0; k < 2; k++)
    fprintf(file, "%d 3 2 9 1 %d %d %d %d\n", k + 5, 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4);
  fprintf(file, "$EndElements\n");
  fclose(file);
}

static const char *const apart[4] = {"bottom", "top", "floor", "lid"}, *const joined[4] = {"bottom", "jaw", "jaw",
                                                                                           "lid"};

MACRO_TEST(APartThatNothingHoldsIsRefused)
{
  FixtureScene(fixture, 1, 1, 1, 1);
  TwoSquares(fixture, apart);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureBoundary(fixture, "lid", NAN, 0.1);
  CHECK(LamMacroCreate(PETSC_COMM_WORLD, &fixture->macro));
  CHECK(LamMacroSetScene(fixture->macro, &fixture->scene));
  CHECK(KeepErrorMessages());
  assert_int_equal(LamMacroSetUp(fixture->macro), PETSC_ERR_USER_INPUT);
  CHECK(PetscPopErrorHandler());
  remove(fixture->scene.macro.gmsh);
  if (!strstr(ErrorMessage,
              "leave one of 2 separate parts of the body, that at (0, 1.1) in the mesh's unit, free to move "
              "or turn as a whole"))
    fail_msg("%s", ErrorMessage);
}

/* Each is as it would be alone, also where both swell first. */
TEST(PartsThatAreHeldAreBodies)
{
  for (int inflate = 0; inflate < 2; inflate++) {
    PetscReal force[2];

    for (int alone = 0; alone < 2; alone++) {
      FIXTURE fixture;
      FixtureScene(&fixture, 1, 1, 1, 2);
      if (!alone) TwoSquares(&fixture, apart);
      if (inflate) FixtureInflate(&fixture);
      FixtureBoundary(&fixture, "bottom", 0, 0);
      FixtureBoundary(&fixture, "top", 0.1, 0.2);
      if (!alone) FixtureBoundary(&fixture, "floor", 0, 0);
      if (!alone) FixtureBoundary(&fixture, "lid", 0.05, -0.1);
      FixtureRun(&fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
      if (!alone) remove(fixture.scene.macro.gmsh);
      force[alone] = FixtureReaction(&fixture, "top")[1];
    }
    assert_near(force[0], force[1], 1e-9);
  }
}

/* The first component of the grip is free; the lower square holds the grip, and the grip the upper one. */
MACRO_TEST(AGripHoldsAPartThroughAnother)
{
  LamBoundary *grip;

  FixtureScene(fixture, 1, 1, 1, 1);
  TwoSquares(fixture, joined);
  FixtureBoundary(fixture, "bottom", 0, 0);
  grip = FixtureAdd(fixture, "jaw", LAM_BOUNDARY_GRIP);
  grip->given[1] = PETSC_TRUE;
  grip->displacement[1] = 0.1;
  FixtureRun(fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  remove(fixture->scene.macro.gmsh);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < fields->node_count; k++)
    if (fields->nodes[2 * k + 1] > 1.05) assert_near(fields->u[2 * k + 1], 0.1, 1e-9);
}
