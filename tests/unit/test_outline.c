/* Walls along polygons: short faces, acute and reflex corners, air at corners; and what has no lumen. */
#include <polygons.h>
#include "support/rve_fixture.h"
#include "element.h"
#include "outline.h"

#define MOST 8

/* A patch of one cell: bottom and top are along X1. */
static LamTissue OneCell(PetscInt n, const double corner[][2], double setback)
{
  PetscReal vertex[MOST][2], setbacks[MOST], apothem;
  PetscInt first[2] = {0, n}, corners[MOST];
  LamPolygons p = {.name = "cell",
                   .vertices = n,
                   .cells = 1,
                   .vertex = vertex,
                   .first = first,
                   .corner = corners,
                   .is_patch = PETSC_TRUE,
                   .sides = LAM_SIDES_FREE,
                   .setback = setbacks};
  LamTissue tissue;

  for (PetscInt v = 0; v < n; v++) {
    corners[v] = v;
    setbacks[v] = setback;
    for (int d = 0; d < 2; d++) vertex[v][d] = corner[v][d];
  }
  assert_int_equal(LamTissueFromPolygons(&p, &apothem, &tissue), 0);
  for (PetscInt k = 0; k < n; k++) { /* back to the lengths above */
    for (int d = 0; d < 2; d++) tissue->corner[k][d] = corner[k][d];
    tissue->setback[k] = setback;
  }
  return tissue;
}

static const double short_face[5][2] = {{0, 0}, {3, 0}, {3, 1.95}, {2.95, 2}, {0, 2}};
static const double acute[4][2] = {{0, 0}, {3, 0}, {2, 1}, {1.6, 1}};
static const double reflex[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1.5, 1}, {1.5, 3}, {0, 3}};
static const double regular[6][2] = {{-0.5, -0.8660254037844386}, {0.5, -0.8660254037844386}, {1, 0},
                                     {0.5, 0.8660254037844386},   {-0.5, 0.8660254037844386}, {-1, 0}};

static double AreaOf(PetscInt n, const double x[][2])
{
  double area = 0.0;

  for (PetscInt k = 0; k < n; k++) area += 0.5 * (x[k][0] * x[(k + 1) % n][1] - x[k][1] * x[(k + 1) % n][0]);
  return area;
}

/* Area of the elements of a mesh, all of whose Gauss points have a positive one. */
static double WallArea(LamTissue tissue, double thickness)
{
  LamMicrostructure micro = DefaultTissue();
  double area = 0.0;
  LamMesh mesh;

  micro.tissue = tissue;
  micro.is_patch = PETSC_TRUE;
  micro.cells[0] = micro.cells[1] = 1;
  micro.wall_thickness = thickness;
  assert_int_equal(LamMeshCreate(&micro, &mesh), 0);
  for (PetscInt e = 0; e < mesh.element_count; e++) {
    const double fibre[2] = {1, 0};
    LamElementGeometry geometry;
    double X[LAM_ELEMENT_NODES][2];

    for (int a = 0; a < LAM_ELEMENT_NODES; a++)
      for (int d = 0; d < 2; d++) X[a][d] = mesh.X[2 * mesh.elements[LAM_ELEMENT_NODES * e + a] + d];
    assert_int_equal(LamElementSetGeometry((const double(*)[2])X, fibre, &geometry), 0);
    for (int g = 0; g < LAM_GAUSS; g++) {
      assert_true(geometry.weight[g] > 0.0);
      area += geometry.weight[g];
    }
  }
  assert_int_equal(LamMeshDestroy(&mesh), 0);
  return area;
}

static double LumenArea(LamTissue tissue, double thickness)
{
  double x[MOST][2], area;
  LamOutline outline;

  assert_int_equal(LamOutlineCreate(tissue, 0, thickness, 0.0, &outline), 0);
  for (PetscInt k = 0; k < outline.count; k++)
    for (int d = 0; d < 2; d++) x[k][d] = outline.inner[k].X[d];
  area = AreaOf(outline.count, (const double(*)[2])x);
  assert_int_equal(LamOutlineDestroy(&outline), 0);
  return area;
}

#define FILLS(name, n, corner, t)                                                                                      \
  TEST(name)                                                                                                           \
  {                                                                                                                    \
    LamTissue tissue = OneCell(n, corner, 0.0);                                                                        \
                                                                                                                       \
    assert_near(WallArea(tissue, t) + LumenArea(tissue, t), AreaOf(n, corner), 1e-12);                                 \
    assert_int_equal(LamTissueDestroy(&tissue), 0);                                                                    \
  }
FILLS(WallsAndLumenFillACellWithAShortFace, 5, short_face, 0.2)
FILLS(WallsAndLumenFillAnAcuteCell, 4, acute, 0.05)
FILLS(WallsAndLumenFillAReflexCell, 6, reflex, 0.2)

/* 0.07 long between walls of 0.2: a quarter of what round cells leave of it. */
TEST(TheLumenIsBluntAtAShortFace)
{
  LamTissue tissue = OneCell(5, short_face, 0.0);
  const double t = 0.2, length = 0.05 * sqrt(2.0);
  double inner = 0.0, perimeter = 0.0;
  LamOutline o;

  assert_int_equal(LamOutlineCreate(tissue, 0, t, 0.0, &o), 0);
  for (int k = 0; k < 5; k++) perimeter += o.length[k];
  for (int d = 0; d < 2; d++) inner += (o.inner[3].X[d] - o.inner[2].X[d]) * o.along[2][d];
  assert_true(o.thickness[2] > t);
  assert_near(inner, 0.25 * length * (1.0 - t * perimeter / (2.0 * AreaOf(5, short_face))), 1e-4);
  assert_int_equal(LamOutlineDestroy(&o), 0);
  assert_int_equal(LamTissueDestroy(&tissue), 0);
}

/* Corners of 120 degrees: outer arcs of the radius d / tan 30 degrees, inner ones of the thickness less. */
TEST(ArcsHaveOneCentre)
{
  const double d = 0.2, t = 0.1, radius = d * sqrt(3.0);
  LamTissue tissue = OneCell(6, regular, 0.0);
  LamOutline o;

  for (PetscInt k = 0; k < 6; k++) tissue->setback[k] = d;
  assert_int_equal(LamOutlineCreate(tissue, 0, t, 0.0, &o), 0);
  for (int k = 0; k < 6; k++)
    for (int i = 0; i <= 4; i++) {
      const double *centre = o.outer[k].centre;
      double X[2], Y[2];

      LamOutlinePoint(&o, k, 0.25 * i * d, 1.0, X);
      LamOutlinePoint(&o, k, 0.25 * i * d, 0.0, Y);
      assert_near(hypot(X[0] - centre[0], X[1] - centre[1]), radius, 1e-12);
      assert_near(hypot(Y[0] - centre[0], Y[1] - centre[1]), radius - t, 1e-12);
    }
  assert_int_equal(LamOutlineDestroy(&o), 0);
  assert_int_equal(LamTissueDestroy(&tissue), 0);
}

/* A hexagon of side 1: 6 - 4 sqrt 3 t, and of its arcs 2 pi r instead of 4 sqrt 3 r, r = 0.2 sqrt 3 - t. */
TEST(InnerPerimetersAreThoseOfHexagonsAndCircles)
{
  const double t = 0.1, r = 0.2 * sqrt(3.0) - t;
  LamTissue tissue = OneCell(6, regular, 0.0);

  assert_near(LamTissueInnerPerimeter(tissue, 0, t), 6.0 - 4.0 * sqrt(3.0) * t, 1e-14);
  for (PetscInt k = 0; k < 6; k++) tissue->setback[k] = 0.2;
  assert_near(LamTissueInnerPerimeter(tissue, 0, t), 6.0 - 4.0 * sqrt(3.0) * (t + r) + 2.0 * PETSC_PI * r, 1e-14);
  assert_int_equal(LamTissueDestroy(&tissue), 0);
}

TEST(WallsThatFillACellAreRefused)
{
  LamTissue tissue = OneCell(6, reflex, 0.0);
  LamOutline o;

  assert_int_equal(PetscPushErrorHandler(PetscReturnErrorHandler, NULL), 0);
  assert_int_equal(LamOutlineCreate(tissue, 0, 0.9, 0.0, &o), PETSC_ERR_USER_INPUT);
  assert_int_equal(PetscPopErrorHandler(), 0);
  assert_int_equal(LamTissueDestroy(&tissue), 0);
}

TEST_GROUP(.petsc = 1);
