/*
  Result file of a macroscale run, and the XDMF file that describes it.
*/
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "fe2_file.h"
#include "names.h"
#include "study.h"
#include "xdmf.h"

/* A field of every step, /macro/step/<number>/<name>: columns of an array of LamMacroFields, times a factor. */
typedef struct {
  char name[LAM_NAME_LENGTH];
  PetscInt columns;       /* 1: scalar; 3: vector, on nodes; 9: tensor */
  size_t array;           /* offset of the array's pointer in LamMacroFields */
  PetscInt first, length; /* the first of the columns, and the number of all columns, of the array */
  LamPointField over;     /* ratio to the strength for this field; LAM_POINT_FIELD_COUNT: no ratio */
  PetscReal factor;       /* conversion to its unit */
  const char *unit;       /* static */
} Field;

enum { MAX_FIELDS = 4 + 2 * (LAM_POINT_FIELD_COUNT + 3) };

/* Layout of /macro/elements. */
typedef enum {
  QUADRILATERALS, /* [element][9] */
  TRIANGLES,      /* [element][6] */
  MIXED           /* [element][9], -1 after a triangle's nodes; XDMF reads /macro/topology: for each element its type
                     (XDMF_TRIANGLE_6, XDMF_QUADRILATERAL_9) and its nodes */
} Topology;
static const char *const TopologyNames[] = {"Quadrilateral_9", "Triangle_6", "Mixed"};
#define LOAD_FACTOR "load_factor"
enum { XDMF_QUADRILATERAL_9 = 0x23, XDMF_TRIANGLE_6 = 0x24 };

struct LamFE2File_s {
  char path[PETSC_MAX_PATH_LEN];
  LamRecordWriter writer;
  LamScales scales;
  PetscInt field_count;
  Field fields[MAX_FIELDS]; /* u, F, P, cauchy, then the scalars */
  Topology topology;
  PetscInt topology_length; /* of /macro/topology */
  PetscInt step_count, capacity;
  PetscInt *steps; /* numbers of the complete ones; owned */
  PetscErrorCode (*beside)(LamRecordWriter writer, void *ctx);
  void *beside_ctx; /* borrowed */
};

/* ---- choice of the fields ---- */

/* The strength for a field, in C1 + C2; NaN: not given, or the field has none. */
static PetscReal StrengthOf(const LamStrength *strength, LamPointField field)
{
  switch (field) {
  case LAM_POINT_WALL:
    return strength->wall;
  case LAM_POINT_NORMAL:
    return strength->lamella_normal;
  case LAM_POINT_SHEAR:
    return strength->lamella_shear;
  default:
    return NAN;
  }
}

/* Whether a field also has its largest (ellipticity: smallest) value in an element. The others hardly vary within an
   element. */
/* Of no other bodies than those in which water moves. */
static PetscBool IsOfTransport(LamPointField field)
{
  return (PetscBool)(field == LAM_POINT_POTENTIAL || field == LAM_POINT_APOPLAST);
}

static PetscBool HasLargest(LamPointField field)
{
  return (PetscBool)(!LamPointFieldIsEnergy(field) && field != LAM_POINT_TURGOR && field != LAM_POINT_LUMEN &&
                     field != LAM_POINT_INTERPOLATED && field != LAM_POINT_DOUBTFUL && !IsOfTransport(field));
}

static void AddField(LamFE2File file, const char name[], const char ending[], Field field)
{
  snprintf(field.name, sizeof(field.name), "%s%s", name, ending);
  file->fields[file->field_count++] = field;
}

/* The mean, and the largest value where it differs. */
static void AddScalars(LamFE2File file, LamPointField k, PetscBool ratio, PetscReal factor, const char unit[])
{
  const char *mean = ratio ? "_ratio" : "", *largest = ratio ? "_ratio_max" : "_max";
  Field field = {.columns = 1,
                 .array = offsetof(LamMacroFields, mean),
                 .first = k,
                 .length = LAM_POINT_FIELD_COUNT,
                 .over = ratio ? k : LAM_POINT_FIELD_COUNT,
                 .factor = factor,
                 .unit = unit};

  AddField(file, LamPointFieldNames[k], mean, field);
  field.array = offsetof(LamMacroFields, largest);
  if (HasLargest(k)) AddField(file, LamPointFieldNames[k], k == LAM_POINT_ELLIPTICITY ? "_min" : largest, field);
}

/* Of no other law than `lamella`. */
static PetscBool IsOfLamella(LamPointField field)
{
  return (PetscBool)(LamPointFieldIsEnergy(field) || field == LAM_POINT_BROKEN || field == LAM_POINT_BROKEN_FACE);
}

static void ChooseFields(LamFE2File file, const LamStrength *strength, PetscBool lamella, PetscBool transport)
{
  const PetscReal MPa = file->scales.stress * 1e-6, mm = file->scales.macro_length * 1e3;
  const Field tensors[] = {{"u", 3, offsetof(LamMacroFields, u), 0, 2, LAM_POINT_FIELD_COUNT, mm, "mm"},
                           {"F", 9, offsetof(LamMacroFields, F), 0, 9, LAM_POINT_FIELD_COUNT, 1, "1"},
                           {"P", 9, offsetof(LamMacroFields, P), 0, 9, LAM_POINT_FIELD_COUNT, MPa, "MPa"},
                           {"cauchy", 9, offsetof(LamMacroFields, cauchy), 0, 9, LAM_POINT_FIELD_COUNT, MPa, "MPa"}};

  for (size_t t = 0; t < PETSC_STATIC_ARRAY_LENGTH(tensors); t++) file->fields[file->field_count++] = tensors[t];
  for (LamPointField k = 0; k < LAM_POINT_FIELD_COUNT; k++) {
    const PetscBool stress = LamPointFieldIsStress(k);

    if ((IsOfLamella(k) && !lamella) || (IsOfTransport(k) && !transport)) continue;
    if (LamPointFieldIsEnergy(k))
      AddScalars(file, k, PETSC_FALSE, MPa * 1e3, "kJ/m^3");
    else
      AddScalars(file, k, PETSC_FALSE, stress ? MPa : 1, stress ? "MPa" : k == LAM_POINT_GAP ? "apothem" : "1");
    if (isfinite(StrengthOf(strength, k))) AddScalars(file, k, PETSC_TRUE, 1, "1");
  }
}

PetscErrorCode LamFE2FileOpen(const char path[], LamWriteMode mode, const LamScene *scene, LamFE2File *file)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(file));
  PetscCall(PetscStrncpy((*file)->path, path, sizeof((*file)->path)));
  (*file)->scales = scene->scales;
  ChooseFields(*file, &scene->strength, (PetscBool)(scene->micro.interface == LAM_INTERFACE_LAMELLA),
               LamTransportHasPotentials(scene));
  PetscErrorCode ierr = LamRecordWriterOpen(path, "fe2", mode, scene, &(*file)->writer);
  if (ierr) PetscCall(PetscFree(*file));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- mesh ---- */

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
    topology[n++] = nodes == 6 ? XDMF_TRIANGLE_6 : XDMF_QUADRILATERAL_9;
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
  file->topology = triangles == dims[0] ? TRIANGLES : triangles ? MIXED : QUADRILATERALS;
  if (file->topology == TRIANGLES) dims[1] = 6;
  PetscCall(PetscMalloc1(dims[0] * dims[1], &elements));
  for (PetscInt k = 0; k < dims[0] * dims[1]; k++)
    elements[k] = fields->elements[LAM_FIELD_NODES * (k / dims[1]) + k % dims[1]];
  PetscCall(LamRecordWriterInts(file->writer, "/macro/elements", 2, dims, elements));
  PetscCall(PetscFree(elements));
  if (file->topology == MIXED) PetscCall(WriteTopology(file, fields));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteMesh(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields)
{
  const PetscInt dims[2] = {fields->node_count, 2};
  char names[LAM_MAX_BOUNDARIES * LAM_NAME_LENGTH] = "";

  PetscFunctionBeginUser;
  PetscCall(LamWriteRows(file->writer, "/macro/nodes", 2, dims, fields->nodes, 2 * sizeof(PetscReal),
                         file->scales.macro_length * 1e3, "mm"));
  PetscCall(LamRecordWriterInts(file->writer, "/macro/gripped", 1, dims, fields->gripped));
  PetscCall(WriteElements(file, fields));
  for (PetscInt s = 0; s < step->boundary_count; s++) LamNamesAppend(sizeof(names), names, "\n", step->boundary[s]);
  PetscCall(LamRecordWriterText(file->writer, "/macro/boundaries", names));
  PetscFunctionReturn(0);
}

/* ---- steps ---- */

/* Displacements with the third component, 0. */
static PetscErrorCode WithThird(const LamMacroFields *fields, PetscReal **u)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * fields->node_count, u));
  for (PetscInt k = 0; k < fields->node_count; k++) PetscCall(PetscArraycpy(&(*u)[3 * k], &fields->u[2 * k], 2));
  PetscFunctionReturn(0);
}

/* XDMF's times rise with the steps, and so cannot be load factors, which fall where a body is unloaded. Readers of
   series know fields of nodes and elements alone: it is one of the elements. */
static PetscErrorCode WriteLoadFactor(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields)
{
  const PetscInt n = fields->element_count;
  char path[128];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/macro/step/%" PetscInt_FMT "/" LOAD_FACTOR, step->step));
  PetscCall(LamWriteRows(file->writer, path, 1, &n, &step->load_factor, 0, 1, "1"));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFields(LamFE2File file, PetscInt step, const LamMacroFields *fields,
                                  const LamStrength *strength)
{
  PetscReal *u;
  char path[128];

  PetscFunctionBeginUser;
  PetscCall(WithThird(fields, &u));
  for (PetscInt k = 0; k < file->field_count; k++) {
    const Field *f = &file->fields[k];
    const PetscBool vector = (PetscBool)(f->columns == 3);
    const PetscInt dims[2] = {vector ? fields->node_count : fields->element_count, f->columns};
    const PetscReal *values = vector ? u : *(PetscReal *const *)((const char *)fields + f->array) + f->first;
    const PetscReal factor = f->over == LAM_POINT_FIELD_COUNT ? f->factor : 1 / StrengthOf(strength, f->over);

    PetscCall(PetscSNPrintf(path, sizeof(path), "/macro/step/%" PetscInt_FMT "/%s", step, f->name));
    PetscCall(LamWriteRows(file->writer, path, f->columns > 1 ? 2 : 1, dims, values,
                           (size_t)(vector ? 3 : f->length) * sizeof(PetscReal), factor, f->unit));
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

/* Plates and indenters: positions and radius in mm, the direction as it is. */
static PetscErrorCode WriteObstacles(LamFE2File file, const LamMacroStep *step)
{
  const PetscReal mm = file->scales.macro_length * 1e3;
  enum { COLUMNS = PETSC_STATIC_ARRAY_LENGTH(step->obstacle[0]) };
  const PetscInt dims[2] = {step->obstacle_count, COLUMNS};
  PetscReal rows[LAM_MAX_BOUNDARIES][COLUMNS];
  char path[128];

  PetscFunctionBeginUser;
  if (!step->obstacle_count) PetscFunctionReturn(0);
  for (PetscInt o = 0; o < dims[0]; o++)
    for (PetscInt i = 0; i < COLUMNS; i++) rows[o][i] = step->obstacle[o][i] * (i == 2 || i == 3 ? 1 : mm);
  PetscCall(PetscSNPrintf(path, sizeof(path), "/macro/step/%" PetscInt_FMT "/obstacles", step->step));
  PetscCall(LamWriteRows(file->writer, path, 2, dims, rows[0], sizeof(rows[0]), 1, "mm"));
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

/* ---- XDMF ---- */

/* time: of a process; NaN: of a run, whose times are the numbers of the steps. */
static void WriteGrid(LamXDMF *xdmf, const LamFE2File file, const LamMacroFields *fields, PetscInt step, PetscReal time)
{
  const PetscBool timed = (PetscBool)isfinite(time);
  const PetscInt nodes = fields->node_count, elements = fields->element_count;
  const LamXDMFData mixed = {"/macro/topology", file->topology_length, 1},
                    alike = {"/macro/elements", elements, file->topology == TRIANGLES ? 6 : 9};

  LamXDMFBegin(xdmf, "step", step, timed ? time : (PetscReal)step, TopologyNames[file->topology], elements,
               file->topology == MIXED ? mixed : alike, (LamXDMFData){"/macro/nodes", nodes, 2});
  for (PetscInt f = 0; f < file->field_count; f++) {
    const Field *field = &file->fields[f];
    const PetscBool on_nodes = (PetscBool)(field->columns == 3);
    char dataset[128];

    snprintf(dataset, sizeof(dataset), "/macro/step/%" PetscInt_FMT "/%s", step, field->name);
    LamXDMFField(xdmf, field->name, on_nodes, "Float",
                 (LamXDMFData){dataset, on_nodes ? nodes : elements, field->columns});
  }
  if (!timed) {
    char dataset[128];

    snprintf(dataset, sizeof(dataset), "/macro/step/%" PetscInt_FMT "/" LOAD_FACTOR, step);
    LamXDMFField(xdmf, LOAD_FACTOR, PETSC_FALSE, "Float", (LamXDMFData){dataset, elements, 1});
  }
  LamXDMFEnd(xdmf);
}

/* Rewrites the .xdmf file. */
static PetscErrorCode WriteXDMF(LamFE2File file, const LamMacroFields *fields, const LamCurve *curve)
{
  LamXDMF xdmf;

  PetscFunctionBeginUser;
  PetscCall(LamXDMFOpen(file->path, "load steps", &xdmf));
  for (PetscInt k = 0; k < file->step_count; k++)
    WriteGrid(&xdmf, file, fields, file->steps[k], curve->rows[k].value[LAM_CURVE_TIME]);
  PetscCall(LamXDMFClose(&xdmf));
  PetscFunctionReturn(0);
}

/* ---- the file ---- */

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
  PetscCall(WriteFields(file, step->step, fields, &summary->strength));
  if (isnan(step->time)) PetscCall(WriteLoadFactor(file, step, fields));
  PetscCall(WriteObstacles(file, step));
  PetscCall(LamListGrow(file->step_count, sizeof(PetscInt), &file->capacity, &file->steps));
  file->steps[file->step_count++] = step->step;
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
  struct LamFE2File_s none = {0}, *f = file ? file : &none;

  PetscFunctionBeginUser;
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
  PetscErrorCode ierr = 0, closed;

  PetscFunctionBeginUser;
  if (!*file) PetscFunctionReturn(0);
  if (status) ierr = WriteStatus(*file, status);
  closed = LamRecordWriterClose(&(*file)->writer);
  PetscCall(PetscFree((*file)->steps));
  PetscCall(PetscFree(*file));
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}
