#include "gmsh_writer.h"

void GmshDistorted(double X[2])
{
  const double bump = 16 * X[0] * (1 - X[0]) * X[1] * (1 - X[1]);

  X[0] += 0.09 * bump * sin(7 * X[0] + 5 * X[1]);
  X[1] += 0.09 * bump * cos(9 * X[0] - 4 * X[1]);
}

void GmshCook(double X[2])
{
  X[1] = 44 * X[0] + (44 - 28 * X[0]) * X[1];
  X[0] *= 48;
}

static void GmshSide(FILE *file, int *number, int tag, int from, int to)
{
  fprintf(file, "%d 1 2 %d %d %d %d\n", ++*number, tag, tag, from, to);
}

static void GmshCell(FILE *file, GmshElements elements, int *number, const int v[4], int odd)
{
  if (elements == GMSH_QUADRILATERALS) {
    fprintf(file, "%d 3 2 5 5 %d %d %d %d\n", ++*number, v[0], v[1], v[2], v[3]);
    return;
  }
  fprintf(file, "%d 2 2 5 5 %d %d %d\n", ++*number, v[0], v[1], odd ? v[3] : v[2]);
  fprintf(file, "%d 2 2 5 5 %d %d %d\n", ++*number, odd ? v[1] : v[0], v[2], v[3]);
}

static void GmshNodes(FILE *file, int nx, int ny, GmshMap map)
{
  fprintf(file, "$Nodes\n%d\n", (nx + 1) * (ny + 1));
  for (int j = 0; j <= ny; j++) {
    for (int i = 0; i <= nx; i++) {
      double X[2] = {(double)i / nx, (double)j / ny};
      map(X);
      fprintf(file, "%d %.17g %.17g 0\n", j * (nx + 1) + i + 1, X[0], X[1]);
    }
  }
}

/* Gmsh's number of the type of curved elements at a place of the grid; of triangles there are two. */
static int CurvedKind(GmshElements elements, int i, int j)
{
  static const int kinds[3] = {10, 16, 9};

  return elements == GMSH_CURVED_TRIANGLES ? 9 : elements == GMSH_CURVED_MIXED ? kinds[(i + j) % 3] : 10;
}

/* Quadratic elements and sides over a grid of twice as many nodes. */
static void GmshCurved(FILE *file, int nx, int ny, GmshElements elements)
{
  const int across = 2 * nx + 1, up = 2 * ny * across;
  int number = 0;

  for (int i = 1; i < across; i += 2) {
    fprintf(file, "%d 8 2 1 1 %d %d %d\n", ++number, i, i + 2, i + 1);
    fprintf(file, "%d 8 2 3 3 %d %d %d\n", ++number, up + i, up + i + 2, up + i + 1);
  }
  for (int j = 0; j < 2 * ny; j += 2) {
    const int left = j * across + 1, right = left + across - 1;
    fprintf(file, "%d 8 2 2 2 %d %d %d\n", ++number, right, right + 2 * across, right + across);
    fprintf(file, "%d 8 2 4 4 %d %d %d\n", ++number, left, left + 2 * across, left + across);
  }
  for (int j = 0; j < ny; j++)
    for (int i = 0; i < nx; i++) {
      const int v = 2 * j * across + 2 * i + 1, mid = v + across, up2 = v + 2 * across;
      const int kind = CurvedKind(elements, i, j);
      if (kind != 9)
        fprintf(file, "%d %d 2 5 5 %d %d %d %d %d %d %d %d", ++number, kind, v, v + 2, up2 + 2, up2, v + 1, mid + 2,
                up2 + 1, mid);
      if (kind == 10) fprintf(file, " %d", mid + 1);
      if (kind == 9) {
        fprintf(file, "%d 9 2 5 5 %d %d %d %d %d %d\n", ++number, v, v + 2, up2 + 2, v + 1, mid + 2, mid + 1);
        fprintf(file, "%d 9 2 5 5 %d %d %d %d %d %d", ++number, v, up2 + 2, up2, mid + 1, up2 + 1, mid);
      }
      fprintf(file, "\n");
    }
}

void GmshWrite(char path[], int nx, int ny, GmshElements elements, GmshMap map)
{
  const int curved = elements >= GMSH_CURVED ? 2 : 1;
  const char *folder = getenv("TMPDIR");
  FILE *file;
  int number = 0, cells = 0;

  snprintf(path, PETSC_MAX_PATH_LEN, "%s/lamella-XXXXXX", folder ? folder : "/tmp");
  file = fdopen(mkstemp(path), "w");
  if (!file) abort();
  fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 1 \"bottom\"\n1 2 \"right\"\n1 3 \"top\"\n"
                "1 4 \"left\"\n2 5 \"body\"\n$EndPhysicalNames\n");
  GmshNodes(file, curved * nx, curved * ny, map);
  for (int k = 0; k < nx * ny; k++)
    cells += elements == GMSH_TRIANGLES || (curved > 1 && CurvedKind(elements, k % nx, k / nx) == 9) ? 2 : 1;
  fprintf(file, "$EndNodes\n$Elements\n%d\n", 2 * (nx + ny) + cells);
  if (curved > 1) GmshCurved(file, nx, ny, elements);
  for (int i = 1; i <= nx && curved == 1; i++) {
    GmshSide(file, &number, 1, i, i + 1);
    GmshSide(file, &number, 3, ny * (nx + 1) + i, ny * (nx + 1) + i + 1);
  }
  for (int j = 0; j < ny && curved == 1; j++) {
    GmshSide(file, &number, 2, (j + 1) * (nx + 1), (j + 2) * (nx + 1));
    GmshSide(file, &number, 4, j * (nx + 1) + 1, (j + 1) * (nx + 1) + 1);
  }
  for (int j = 0; j < ny && curved == 1; j++) {
    for (int i = 0; i < nx; i++) {
      const int first = j * (nx + 1) + i + 1, v[4] = {first, first + 1, first + nx + 2, first + nx + 1};
      GmshCell(file, elements, &number, v, (i + j) % 2);
    }
  }
  fprintf(file, "$EndElements\n");
  fclose(file);
}
