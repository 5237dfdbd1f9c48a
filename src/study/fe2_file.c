/*
  Result file of a macroscale run.
*/
#include <stdlib.h>
#include <string.h>
#include "fe2_fields.h"
#include "fe2_file.h"
#include "names.h"

struct LamFE2File_s {
  char path[PETSC_MAX_PATH_LEN];
  LamRecordWriter writer;
  LamScales scales;
  LamFE2Fields fields;
  LamXDMFTopology topology;
  PetscInt topology_length;
  PetscInt step_count, capacity;
  PetscInt *steps; /* numbers of the complete ones; owned */
  PetscErrorCode (*beside)(LamRecordWriter writer, void *ctx);
  void *beside_ctx; /* borrowed */
};

PetscErrorCode LamFE2FileOpen(const char path[], LamWriteMode mode, const LamScene *scene, LamFE2File *file)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(file));
  PetscCall(PetscStrncpy((*file)->path, path, sizeof((*file)->path)));
  (*file)->scales = scene->scales;
  LamFE2FieldsChoose(scene, &(*file)->fields);
  PetscErrorCode ierr = LamRecordWriterOpen(path, "fe2", mode, scene, &(*file)->writer);
  if (ierr) PetscCall(PetscFree(*file));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Writes values * factor as [rows][columns], or [rows] where columns is 1; rows are `stride` long. */
static PetscErrorCode WriteColumns(LamFE2File file, const char name[], PetscInt rows, PetscInt stride, PetscInt columns,
                                   const PetscReal values[], PetscReal factor, const char unit[])
{
  const PetscInt dims[2] = {rows, columns};
  PetscReal *scaled;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows * columns, &scaled));
  for (PetscInt r = 0; r < rows; r++) {
    for (PetscInt c = 0; c < columns; c++) scaled[r * columns + c] = values[r * stride + c] * factor;
  }
  PetscCall(LamRecordWriterReals(file->writer, name, columns > 1 ? 2 : 1, dims, scaled, unit));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(0);
}

static PetscBool IsTriangle(const LamMacroFields *fields, PetscInt e)
{
  return (PetscBool)(fields->elements[LAM_FIELD_NODES * e + 6] < 0);
}

/* Writes the XDMF type and the nodes of each element, concatenated. */
static PetscErrorCode WriteTopology(LamFE2File file, const LamMacroFields *fields)
{
  PetscInt *topology, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(10 * fields->element_count, &topology));
  for (PetscInt e = 0; e < fields->element_count; e++) {
    const PetscInt nodes = IsTriangle(fields, e) ? 6 : 9;
    topology[n++] = nodes == 6 ? LAM_XDMF_TRIANGLE_6 : LAM_XDMF_QUADRILATERAL_9;
    for (PetscInt a = 0; a < nodes; a++) topology[n++] = fields->elements[LAM_FIELD_NODES * e + a];
  }
  PetscCall(LamRecordWriterInts(file->writer, "/macro/topology", 1, &n, topology));
  PetscCall(PetscFree(topology));
  file->topology_length = n;
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteElements(LamFE2File file, const LamMacroFields *fields)
{
  PetscInt triangles = 0, dims[2] = {fields->element_count, 9}, *elements;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < dims[0]; e++) triangles += IsTriangle(fields, e);
  file->topology = triangles == dims[0] ? LAM_XDMF_TRIANGLES : triangles ? LAM_XDMF_MIXED : LAM_XDMF_QUADRILATERALS;
  if (file->topology == LAM_XDMF_TRIANGLES) dims[1] = 6;
  PetscCall(PetscMalloc1(dims[0] * dims[1], &elements));
  for (PetscInt k = 0; k < dims[0] * dims[1]; k++)
    elements[k] = fields->elements[LAM_FIELD_NODES * (k / dims[1]) + k % dims[1]];
  PetscCall(LamRecordWriterInts(file->writer, "/macro/elements", 2, dims, elements));
  PetscCall(PetscFree(elements));
  if (file->topology == LAM_XDMF_MIXED) PetscCall(WriteTopology(file, fields));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteMesh(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields)
{
  char names[LAM_MAX_BOUNDARIES * LAM_NAME_LENGTH] = "";

  PetscFunctionBeginUser;
  PetscCall(WriteColumns(file, "/macro/nodes", fields->node_count, 2, 2, fields->nodes, file->scales.macro_length * 1e3,
                         "mm"));
  PetscCall(WriteElements(file, fields));
  for (PetscInt s = 0; s < step->boundary_count; s++) LamNamesAppend(sizeof(names), names, "\n", step->boundary[s]);
  PetscCall(LamRecordWriterText(file->writer, "/macro/boundaries", names));
  PetscFunctionReturn(0);
}

static PetscErrorCode StepName(PetscInt step, const char name[], char path[128])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, 128, "/macro/step/%" PetscInt_FMT "/%s", step, name));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteTensors(LamFE2File file, PetscInt step, const LamMacroFields *fields)
{
  const PetscReal MPa = file->scales.stress * 1e-6;
  char name[128];

  PetscFunctionBeginUser;
  PetscCall(StepName(step, "F", name));
  PetscCall(WriteColumns(file, name, fields->element_count, 9, 9, fields->F, 1, "1"));
  PetscCall(StepName(step, "P", name));
  PetscCall(WriteColumns(file, name, fields->element_count, 9, 9, fields->P, MPa, "MPa"));
  PetscCall(StepName(step, "cauchy", name));
  PetscCall(WriteColumns(file, name, fields->element_count, 9, 9, fields->cauchy, MPa, "MPa"));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteScalars(LamFE2File file, PetscInt step, const LamMacroFields *fields,
                                   const LamStrength *strength)
{
  char name[128];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < file->fields.count; k++) {
    const LamFE2Scalar *scalar = &file->fields.scalars[k];
    const PetscReal *values = scalar->largest ? fields->largest : fields->mean;
    if (!scalar->unit) continue;
    const PetscReal factor = scalar->over_strength ? 1 / LamFE2Strength(strength, scalar->field) : scalar->factor;
    PetscCall(StepName(step, file->fields.fields[k].name, name));
    PetscCall(WriteColumns(file, name, fields->element_count, LAM_POINT_FIELD_COUNT, 1, &values[scalar->field], factor,
                           scalar->unit));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteDisplacement(LamFE2File file, PetscInt step, const LamMacroFields *fields)
{
  PetscReal *u;
  char name[128];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * fields->node_count, &u));
  for (PetscInt k = 0; k < fields->node_count; k++) PetscCall(PetscArraycpy(&u[3 * k], &fields->u[2 * k], 2));
  PetscCall(StepName(step, "u", name));
  PetscCall(WriteColumns(file, name, fields->node_count, 3, 3, u, file->scales.macro_length * 1e3, "mm"));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteSummary(LamFE2File file, const LamSummary *summary)
{
  json_t *object = LamSummaryToJSON(summary);
  char *text = json_dumps(object, JSON_REAL_PRECISION(17));
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  json_decref(object);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_LIB, "a summary cannot be written as JSON");
  ierr = LamRecordWriterText(file->writer, "/macro/summary", text);
  free(text);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepStep(LamFE2File file, PetscInt step)
{
  PetscFunctionBeginUser;
  if (file->step_count == file->capacity) {
    file->capacity = PetscMax(16, 2 * file->capacity);
    PetscCall(PetscRealloc((size_t)file->capacity * sizeof(PetscInt), &file->steps));
  }
  file->steps[file->step_count++] = step;
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteXDMF(LamFE2File file, const LamMacroFields *fields, const LamCurve *curve)
{
  LamXDMF xdmf = {.node_count = fields->node_count,
                  .element_count = fields->element_count,
                  .topology = file->topology,
                  .topology_length = file->topology_length,
                  .field_count = file->fields.count,
                  .fields = file->fields.fields,
                  .step_count = file->step_count,
                  .steps = file->steps};
  PetscReal *times;

  PetscFunctionBeginUser;
  PetscCall(
      LamCurveGetColumn(curve, LamCurveHas(curve, LAM_CURVE_TIME) ? LAM_CURVE_TIME : LAM_CURVE_LOAD_FACTOR, &times));
  xdmf.times = times;
  PetscErrorCode ierr = LamXDMFWrite(file->path, &xdmf);
  PetscCall(PetscFree(times));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

void LamFE2FileSetBeside(LamFE2File file, PetscErrorCode (*write)(LamRecordWriter writer, void *ctx), void *ctx)
{
  file->beside = write;
  file->beside_ctx = ctx;
}

PetscErrorCode LamFE2FileAddStep(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields,
                                 const LamSummary *summary)
{
  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterBegin(file->writer));
  if (!file->step_count) PetscCall(WriteMesh(file, step, fields));
  PetscCall(WriteDisplacement(file, step->step, fields));
  PetscCall(WriteTensors(file, step->step, fields));
  PetscCall(WriteScalars(file, step->step, fields, &summary->strength));
  PetscCall(KeepStep(file, step->step));
  PetscCall(LamCurveWrite(&summary->curve, file->writer));
  PetscCall(WriteSummary(file, summary));
  if (file->beside) PetscCall(file->beside(file->writer, file->beside_ctx));
  PetscCall(LamRecordWriterInts(file->writer, "/macro/steps", 1, &file->step_count, file->steps));
  PetscCall(LamRecordWriterCommit(file->writer, 0, NULL, NULL)); /* the step is complete on disk */
  PetscCall(WriteXDMF(file, fields, &summary->curve));
  PetscCall(LamCurveWriteCSV(&summary->curve, file->path));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2FileArchive(LamFE2File file, LamArchive archive)
{
  struct LamFE2File_s none, *f = file ? file : &none;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(&none, sizeof(none)));
  PetscCall(LamArchiveShared(archive, "topology", sizeof(f->topology), &f->topology));
  PetscCall(LamArchiveShared(archive, "topology length", sizeof(f->topology_length), &f->topology_length));
  PetscCall(LamArchiveList(archive, "steps", sizeof(PetscInt), &f->step_count, (void **)&f->steps));
  f->capacity = f->step_count;
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteStatus(LamFE2File file, const char status[])
{
  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterBegin(file->writer));
  PetscCall(LamRecordWriterText(file->writer, "/macro/status", status));
  PetscCall(LamRecordWriterCommit(file->writer, 0, NULL, NULL));
  PetscFunctionReturn(0);
}

LamRecordWriter LamFE2FileWriter(LamFE2File file)
{
  return file->writer;
}

PetscErrorCode LamFE2FileClose(LamFE2File *file, const char status[])
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (!*file) PetscFunctionReturn(0);
  if (status) ierr = WriteStatus(*file, status);
  if (ierr)
    (void)LamRecordWriterClose(&(*file)->writer);
  else
    ierr = LamRecordWriterClose(&(*file)->writer);
  PetscCall(PetscFree((*file)->steps));
  PetscCall(PetscFree(*file));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
