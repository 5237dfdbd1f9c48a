/*
  Writer of XDMF 3: a temporal collection of grids of quadratic elements.

  Every grid names topology and geometry itself: readers differ in their support of references between grids.
  Reference: https://www.xdmf.org/index.php/XDMF_Model_and_Format
*/
#include <string.h>
#include "beside.h"
#include "xdmf.h"

/* Prints the file name without its folder, as XML text. */
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

static void PrintField(FILE *out, const char hdf5[], const LamXDMF *xdmf, PetscInt step, const LamXDMFField *field)
{
  const char *type = field->columns == 1 ? "Scalar" : field->columns == 3 ? "Vector" : "Tensor";
  char dataset[128];

  snprintf(dataset, sizeof(dataset), "/macro/step/%" PetscInt_FMT "/%s", step, field->name);
  fprintf(out, "        <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", field->name, type,
          field->on_nodes ? "Node" : "Cell");
  PrintItem(out, hdf5, dataset, "Float", field->on_nodes ? xdmf->node_count : xdmf->element_count, field->columns);
  fputs("        </Attribute>\n", out);
}

static void PrintTopology(FILE *out, const char hdf5[], const LamXDMF *xdmf)
{
  static const char *const types[] = {"Quadrilateral_9", "Triangle_6", "Mixed"};

  fprintf(out, "        <Topology TopologyType=\"%s\" NumberOfElements=\"%" PetscInt_FMT "\">\n", types[xdmf->topology],
          xdmf->element_count);
  if (xdmf->topology == LAM_XDMF_MIXED)
    PrintItem(out, hdf5, "/macro/topology", "Int", xdmf->topology_length, 1);
  else
    PrintItem(out, hdf5, "/macro/elements", "Int", xdmf->element_count, xdmf->topology == LAM_XDMF_TRIANGLES ? 6 : 9);
  fputs("        </Topology>\n", out);
}

static void PrintGrid(FILE *out, const char hdf5[], const LamXDMF *xdmf, PetscInt k)
{
  fprintf(out, "      <Grid Name=\"step %" PetscInt_FMT "\" GridType=\"Uniform\">\n", xdmf->steps[k]);
  fprintf(out, "        <Time Value=\"%.17g\"/>\n", (double)xdmf->times[k]);
  PrintTopology(out, hdf5, xdmf);
  fputs("        <Geometry GeometryType=\"XY\">\n", out);
  PrintItem(out, hdf5, "/macro/nodes", "Float", xdmf->node_count, 2);
  fputs("        </Geometry>\n", out);
  for (PetscInt f = 0; f < xdmf->field_count; f++) PrintField(out, hdf5, xdmf, xdmf->steps[k], &xdmf->fields[f]);
  fputs("      </Grid>\n", out);
}

PetscErrorCode LamXDMFWrite(const char hdf5[], const LamXDMF *xdmf)
{
  LamBeside file;

  PetscFunctionBeginUser;
  PetscCall(LamBesideOpen(hdf5, ".xdmf", &file));
  fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n", file.out);
  fputs("    <Grid Name=\"load steps\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", file.out);
  for (PetscInt k = 0; k < xdmf->step_count; k++) PrintGrid(file.out, hdf5, xdmf, k);
  fputs("    </Grid>\n  </Domain>\n</Xdmf>\n", file.out);
  PetscCall(LamBesideClose(&file));
  PetscFunctionReturn(0);
}
