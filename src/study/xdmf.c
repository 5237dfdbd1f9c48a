/*
  XDMF 3 beside an HDF5 file.
*/
#include "xdmf.h"
#include <string.h>

#define HEAD "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n    <Grid Name=\""
#define COLLECTION "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"
const LamTextKind LamXDMFText = {
    .what = "an XDMF file of lamella", .ending = ".xdmf", .begins = HEAD "*" COLLECTION "*"};

PetscErrorCode LamXDMFOpen(const char hdf5[], const char collection[], LamXDMF *xdmf)
{
  PetscFunctionBeginUser;
  xdmf->hdf5 = hdf5;
  PetscCall(LamBesideOpen(hdf5, &LamXDMFText, &xdmf->file));
  fprintf(xdmf->file.out, HEAD "%s" COLLECTION, collection);
  PetscFunctionReturn(0);
}

PetscErrorCode LamXDMFClose(LamXDMF *xdmf)
{
  PetscFunctionBeginUser;
  fputs("    </Grid>\n  </Domain>\n</Xdmf>\n", xdmf->file.out);
  PetscCall(LamBesideClose(&xdmf->file));
  PetscFunctionReturn(0);
}

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

static void PrintData(const LamXDMF *xdmf, const char number[], LamXDMFData data)
{
  FILE *out = xdmf->file.out;

  fprintf(out, "          <DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"8\" Dimensions=\"%" PetscInt_FMT,
          number, data.rows);
  if (data.columns > 1) fprintf(out, " %" PetscInt_FMT, data.columns);
  fputs("\">", out);
  PrintName(out, xdmf->hdf5);
  fprintf(out, ":%s</DataItem>\n", data.path);
}

void LamXDMFBegin(LamXDMF *xdmf, const char name[], PetscInt number, PetscReal time, const char topology[],
                  PetscInt element_count, LamXDMFData elements, LamXDMFData nodes)
{
  FILE *out = xdmf->file.out;

  fprintf(out, "      <Grid Name=\"%s %" PetscInt_FMT "\" GridType=\"Uniform\">\n", name, number);
  fprintf(out, "        <Time Value=\"%.17g\"/>\n", (double)time);
  fprintf(out, "        <Topology TopologyType=\"%s\" NumberOfElements=\"%" PetscInt_FMT "\">\n", topology,
          element_count);
  PrintData(xdmf, "Int", elements);
  fputs("        </Topology>\n        <Geometry GeometryType=\"XY\">\n", out);
  PrintData(xdmf, "Float", nodes);
  fputs("        </Geometry>\n", out);
}

void LamXDMFField(LamXDMF *xdmf, const char name[], PetscBool on_nodes, const char number[], LamXDMFData values)
{
  const PetscInt n = values.columns;
  const char *type = n == 1 ? "Scalar" : n == 3 ? "Vector" : n == 9 ? "Tensor" : "Matrix";
  FILE *out = xdmf->file.out;

  fprintf(out, "        <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", name, type,
          on_nodes ? "Node" : "Cell");
  PrintData(xdmf, number, values);
  fputs("        </Attribute>\n", out);
}

void LamXDMFEnd(LamXDMF *xdmf)
{
  fputs("      </Grid>\n", xdmf->file.out);
}
