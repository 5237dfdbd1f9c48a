/* The mesh of the RVE: counts, areas, and how nodes are tied across faces and periods. */
#include "support/rve_fixture.h"
#include "element.h"

static LamMicrostructure Cells(int n0, int n1, double orientation)
{
  LamMicrostructure micro = DefaultTissue();

  micro.cells[0] = n0;
  micro.cells[1] = n1;
  micro.orientation = orientation;
  return micro;
}

static LamMesh NewMesh(const LamMicrostructure *micro)
{
  LamMesh mesh;

  assert_int_equal(LamMeshCreate(micro, &mesh), 0);
  return mesh;
}

/* One ring of 6 x 2 elements a face: 72 around, 5 through; half of the outer ring is tied to the other half. */
TEST(OneCellHas644Unknowns)
{
  const LamMicrostructure micro = Cells(1, 1, 0.0);
  OWNED(LamMesh, LamMeshDestroy) mesh = NewMesh(&micro);

  assert_int_equal(mesh.element_count, 72);
  assert_int_equal(mesh.node_count, 360);
  assert_int_equal(2 * (mesh.class_count - 1), 644);
}

/* n cells share n times the classes of one cell: every class is counted once per period. */
TEST(ClassesGrowWithTheNumberOfCells)
{
  static const int cells[][2] = {{1, 2}, {2, 1}, {2, 2}, {3, 2}};

  for (int k = 0; k < 4; k++) {
    const LamMicrostructure micro = Cells(cells[k][0], cells[k][1], 0.3);
    OWNED(LamMesh, LamMeshDestroy) mesh = NewMesh(&micro);

    assert_int_equal(mesh.class_count, 323 * cells[k][0] * cells[k][1]);
  }
}

/* V0 is the area of the period parallelogram and of the hexagons. */
TEST(VolumeIsThatOfThePeriod)
{
  const LamMicrostructure micro = Cells(2, 3, 0.4);
  OWNED(LamMesh, LamMeshDestroy) mesh = NewMesh(&micro);
  const double parallelogram = mesh.period[0][0] * mesh.period[1][1] - mesh.period[0][1] * mesh.period[1][0];

  assert_near(mesh.V0, 6 * 2.0 * sqrt(3.0), 1e-12);
  assert_near(parallelogram, mesh.V0, 1e-12);
}

static LamElementGeometry Geometry(const LamMesh *mesh, int e)
{
  const double fibre[2] = {1, 0};
  LamElementGeometry geometry;
  double X[LAM_ELEMENT_NODES][2];

  for (int a = 0; a < LAM_ELEMENT_NODES; a++)
    for (int d = 0; d < 2; d++) X[a][d] = mesh->X[2 * mesh->elements[LAM_ELEMENT_NODES * e + a] + d];
  assert_int_equal(LamElementSetGeometry((const double(*)[2])X, fibre, &geometry), 0);
  return geometry;
}

/* The elements fill the ring between the hexagons of apothem 1 - t and 1 exactly: 2 sqrt(3) (1 - (1 - t)^2). */
TEST(ElementsFillTheRing)
{
  LamMicrostructure micro = Cells(1, 1, 0.2);
  OWNED(LamMesh, LamMeshDestroy) mesh;
  double area = 0.0;

  micro.wall_thickness = 0.23;
  mesh = NewMesh(&micro);
  for (int e = 0; e < mesh.element_count; e++) {
    const LamElementGeometry geometry = Geometry(&mesh, e);

    for (int g = 0; g < LAM_GAUSS; g++) area += geometry.weight[g];
  }
  assert_near(area, 2.0 * sqrt(3.0) * (1.0 - 0.77 * 0.77), 1e-13);
}

/* A shift is a whole number of periods along each period vector, and moves the class's node onto the node. */
TEST(ShiftsArePeriodVectors)
{
  static const int cells[][2] = {{1, 1}, {2, 1}, {2, 2}};

  for (int k = 0; k < 3; k++) {
    const LamMicrostructure micro = Cells(cells[k][0], cells[k][1], 0.3);
    OWNED(LamMesh, LamMeshDestroy) mesh = NewMesh(&micro);
    const double(*p)[2] = (const double(*)[2])mesh.period;
    const double det = p[0][0] * p[1][1] - p[0][1] * p[1][0];

    for (int i = 0; i < mesh.node_count; i++) {
      const double *S = &mesh.shift[2 * i], *X = &mesh.X[2 * i], *Y = &mesh.class_X[2 * mesh.node_class[i]];
      const double m = (S[0] * p[1][1] - S[1] * p[1][0]) / det, n = (S[1] * p[0][0] - S[0] * p[0][1]) / det;

      assert_near(m, round(m), 1e-12);
      assert_near(n, round(n), 1e-12);
      for (int d = 0; d < 2; d++) assert_near(Y[d] + S[d], X[d], 1e-12);
    }
  }
}

/* Nodes inside a face are shared by two cells, corners by three, all others by none. */
TEST(OuterNodesAreSharedByTwoOrThreeCells)
{
  const LamMicrostructure micro = Cells(2, 2, 0.0);
  OWNED(LamMesh, LamMeshDestroy) mesh = NewMesh(&micro);
  int shared[4] = {0, 0, 0, 0}, *members = calloc((size_t)mesh.class_count, sizeof(int));

  for (int i = 0; i < mesh.node_count; i++) members[mesh.node_class[i]]++;
  for (int c = 0; c < mesh.class_count; c++) {
    assert_in_range(members[c], 1, 3);
    shared[members[c]]++;
  }
  assert_int_equal(shared[3], 2 * 4);      /* two junctions a cell */
  assert_int_equal(shared[2], 3 * 11 * 4); /* three faces a cell with 11 nodes between corners */
  assert_int_equal(shared[1], 4 * 72 * 4); /* four of five layers are not outer */
  free(members);
}

TEST(LumenNodesHaveNoShift)
{
  const LamMicrostructure micro = Cells(1, 1, 0.0);
  OWNED(LamMesh, LamMeshDestroy) mesh = NewMesh(&micro);

  for (int i = 0; i < mesh.node_count; i += (int)mesh.radial_nodes)
    assert_true(mesh.shift[2 * i] == 0.0 && mesh.shift[2 * i + 1] == 0.0);
}

/* Elements at the ends of a face are 1 - grading as long as those of an even mesh, to first order; the mesh is
   symmetric about the middle of the face, so that facing walls have the same nodes. */
TEST(GradedElementsAreSmallAtTheCorners)
{
  LamMicrostructure micro = Cells(1, 1, 0.0);
  OWNED(LamMesh, LamMeshDestroy) mesh;

  micro.along = 40;
  micro.grading = 0.6;
  mesh = NewMesh(&micro);
  assert_near(40 * mesh.ends[1], 0.4, 0.01);
  assert_near(40 * (mesh.ends[21] - mesh.ends[20]), 1.6, 0.01);
  for (int i = 0; i <= 40; i++) assert_near(mesh.ends[i] + mesh.ends[40 - i], 1.0, 1e-15);
  assert_near(mesh.shortest, 2 / sqrt(3.0) * mesh.ends[1], 1e-15);
  assert_near(mesh.longest, 2 / sqrt(3.0) * (mesh.ends[20] - mesh.ends[19]), 1e-15);
}

TEST(PlacesAndSharesOfAFaceAreInverse)
{
  LamMicrostructure micro = Cells(1, 1, 0.0);
  OWNED(LamMesh, LamMeshDestroy) mesh;

  micro.grading = 0.7;
  mesh = NewMesh(&micro);
  for (int i = 0; i <= 24; i++) {
    assert_near(LamMeshPlace(&mesh, 0, LamMeshShare(&mesh, 0, 0.25 * i)), 0.25 * i, 1e-14);
    assert_near(LamMeshShare(&mesh, 0, LamMeshPlace(&mesh, 0, i / 24.0)), i / 24.0, 1e-15);
  }
}

TEST(ImpossibleWallThicknessIsRefused)
{
  LamMicrostructure micro = DefaultTissue();
  LamMesh mesh;

  micro.wall_thickness = 1.0;
  assert_int_equal(PetscPushErrorHandler(PetscReturnErrorHandler, NULL), 0);
  assert_int_equal(LamMeshCreate(&micro, &mesh), PETSC_ERR_USER_INPUT);
  assert_int_equal(PetscPopErrorHandler(), 0);
}
