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

void GmshWrite(char path[], int nx, int ny, GmshElements elements, GmshMap map)
{
  const char *folder = getenv("TMPDIR");
  FILE *file;
  int number = 0;

  snprintf(path, PETSC_MAX_PATH_LEN, "%s/lamella-XXXXXX", folder ? folder : "/tmp");
  file = fdopen(mkstemp(path), "w");
  if (!file) abort();
  fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 1 \"bottom\"\n1 2 \"right\"\n1 3 \"top\"\n"
                "1 4 \"left\"\n2 5 \"body\"\n$EndPhysicalNames\n");
  fprintf(file, "$Nodes\n%d\n", (nx + 1) * (ny + 1));
  for (int j = 0; j <= ny; j++) {
    for (int i = 0; i <= nx; i++) {
      double X[2] = {(double)i / nx, (double)j / ny};
      map(X);
      fprintf(file, "%d %.17g %.17g 0\n", j * (nx + 1) + i + 1, X[0], X[1]);
    }
  }
  fprintf(file, "$EndNodes\n$Elements\n%d\n", 2 * (nx + ny) + nx * ny * (elements == GMSH_TRIANGLES ? 2 : 1));
  for (int i = 1; i <= nx; i++) {
    GmshSide(file, &number, 1, i, i + 1);
    GmshSide(file, &number, 3, ny * (nx + 1) + i, ny * (nx + 1) + i + 1);
  }
  for (int j = 0; j < ny; j++) {
    GmshSide(file, &number, 2, (j + 1) * (nx + 1), (j + 2) * (nx + 1));
    GmshSide(file, &number, 4, j * (nx + 1) + 1, (j + 1) * (nx + 1) + 1);
  }
  for (int j = 0; j < ny; j++) {
    for (int i = 0; i < nx; i++) {
      const int first = j * (nx + 1) + i + 1, v[4] = {first, first + 1, first + nx + 2, first + nx + 1};
      GmshCell(file, elements, &number, v, (i + j) % 2);
    }
  }
  fprintf(file, "$EndElements\n");
  fclose(file);
}
