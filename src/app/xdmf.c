/*
  Writer of XDMF 3: a temporal collection of grids of biquadratic quadrilaterals.

  Every grid names topology and geometry itself: readers differ in their support of references between grids.
  Reference: https://www.xdmf.org/index.php/XDMF_Model_and_Format
*/
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "xdmf.h"

typedef struct {
  const char *name, *type;
  PetscBool on_nodes;
  PetscInt columns;
} Attribute;

static const Attribute Attributes[] = {
    {"u", "Vector", PETSC_TRUE, 3},
    {"F", "Tensor", PETSC_FALSE, 9},
    {"P", "Tensor", PETSC_FALSE, 9},
    {"cauchy", "Tensor", PETSC_FALSE, 9},
    {"lumen_fraction", "Scalar", PETSC_FALSE, 1},
    {"opening_fraction", "Scalar", PETSC_FALSE, 1},
    {"debonded_fraction", "Scalar", PETSC_FALSE, 1},
    {"turgor", "Scalar", PETSC_FALSE, 1},
};

/* Path of the XDMF file: .h5 or .hdf5 is replaced. */
static PetscErrorCode XDMFPath(const char hdf5[], const char ending[], size_t size, char path[])
{
  const char *dot = strrchr(hdf5, '.');
  int stem = (int)strlen(hdf5);

  PetscFunctionBeginUser;
  if (dot && (!strcmp(dot, ".h5") || !strcmp(dot, ".hdf5"))) stem = (int)(dot - hdf5);
  PetscCall(PetscSNPrintf(path, size, "%.*s%s", stem, hdf5, ending));
  PetscFunctionReturn(0);
}

/* File name without its folder, as XML text. */
static void PrintName(FILE *out, const char path[])
{
  const char *slash = strrchr(path, '/');

  for (const char *c = slash ? slash + 1 : path; *c; c++) {
    if (*c == '&')
      fputs("&amp;", out);
    else if (*c == '<')
      fputs("&lt;", out);
    else if (*c == '>')
      fputs("&gt;", out);
    else
      fputc(*c, out);
  }
}

static void PrintItem(FILE *out, const char hdf5[], const char dataset[], const char type[], PetscInt rows,
                      PetscInt columns)
{
  fprintf(out, "          <DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"8\" Dimensions=\"%" PetscInt_FMT, type,
          rows);
  if (columns > 1) fprintf(out, " %" PetscInt_FMT, columns);
  fputs("\">", out);
  PrintName(out, hdf5);
  fprintf(out, ":%s</DataItem>\n", dataset);
}

static void PrintGrid(FILE *out, const char hdf5[], PetscInt nodes, PetscInt elements, PetscInt step, PetscReal time)
{
  fprintf(out, "      <Grid Name=\"step %" PetscInt_FMT "\" GridType=\"Uniform\">\n", step);
  fprintf(out, "        <Time Value=\"%.17g\"/>\n", (double)time);
  fprintf(out, "        <Topology TopologyType=\"Quadrilateral_9\" NumberOfElements=\"%" PetscInt_FMT "\">\n",
          elements);
  PrintItem(out, hdf5, "/macro/elements", "Int", elements, 9);
  fputs("        </Topology>\n        <Geometry GeometryType=\"XY\">\n", out);
  PrintItem(out, hdf5, "/macro/nodes", "Float", nodes, 2);
  fputs("        </Geometry>\n", out);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(Attributes); k++) {
    const Attribute *a = &Attributes[k];
    char dataset[96];
    snprintf(dataset, sizeof(dataset), "/macro/step/%" PetscInt_FMT "/%s", step, a->name);
    fprintf(out, "        <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", a->name, a->type,
            a->on_nodes ? "Node" : "Cell");
    PrintItem(out, hdf5, dataset, "Float", a->on_nodes ? nodes : elements, a->columns);
    fputs("        </Attribute>\n", out);
  }
  fputs("      </Grid>\n", out);
}

PetscErrorCode LamXDMFWrite(const char hdf5[], PetscInt node_count, PetscInt element_count, PetscInt step_count,
                            const PetscInt steps[], const PetscReal times[])
{
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  FILE *out;
  int failed;

  PetscFunctionBeginUser;
  PetscCall(XDMFPath(hdf5, ".xdmf", sizeof(path), path));
  PetscCall(XDMFPath(hdf5, ".xdmf.tmp", sizeof(temporary), temporary));
  out = fopen(temporary, "w");
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", temporary, strerror(errno));
  fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n", out);
  fputs("    <Grid Name=\"load steps\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", out);
  for (PetscInt k = 0; k < step_count; k++) PrintGrid(out, hdf5, node_count, element_count, steps[k], times[k]);
  fputs("    </Grid>\n  </Domain>\n</Xdmf>\n", out);
  failed = ferror(out);
  failed |= fclose(out);
  if (!failed) failed = rename(temporary, path); /* a reader never sees half a file */
  if (failed) unlink(temporary);
  PetscCheck(!failed, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: cannot write", path);
  PetscFunctionReturn(0);
}
