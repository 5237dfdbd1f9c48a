/*
  Result file of a macroscale run.
*/
#include <string.h>
#include "fe2_file.h"
#include "xdmf.h"

struct LamFE2File_s {
  char path[PETSC_MAX_PATH_LEN];
  LamRecordWriter writer;
  LamScales scales;
  PetscInt step_count, capacity, side_count;
  PetscInt *steps;                          /* owned */
  PetscReal *load_factor, *work, *reaction; /* [step], [step], [step][side][2]; owned */
};

PetscErrorCode LamFE2FileOpen(const char path[], LamWriteMode mode, const LamScene *scene, LamFE2File *file)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(file));
  PetscCall(PetscStrncpy((*file)->path, path, sizeof((*file)->path)));
  (*file)->scales = scene->scales;
  PetscErrorCode ierr = LamRecordWriterOpen(path, "fe2", mode, scene, &(*file)->writer);
  if (ierr) PetscCall(PetscFree(*file));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Writes values * factor as [rows][columns], or [rows] where columns is 1; of rows `stride` long, from `first`. */
static PetscErrorCode WriteColumns(LamFE2File file, const char name[], PetscInt rows, PetscInt stride, PetscInt first,
                                   PetscInt columns, const PetscReal values[], PetscReal factor, const char unit[])
{
  const PetscInt dims[2] = {rows, columns};
  PetscReal *scaled;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows * columns, &scaled));
  for (PetscInt r = 0; r < rows; r++) {
    for (PetscInt c = 0; c < columns; c++) scaled[r * columns + c] = values[r * stride + first + c] * factor;
  }
  PetscCall(LamRecordWriterReals(file->writer, name, columns > 1 ? 2 : 1, dims, scaled, unit));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteMesh(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields)
{
  const PetscInt dims[2] = {fields->element_count, 9};
  char names[LAM_MAX_BOUNDARIES * LAM_NAME_LENGTH] = "";

  PetscFunctionBeginUser;
  PetscCall(WriteColumns(file, "/macro/nodes", fields->node_count, 2, 0, 2, fields->nodes,
                         file->scales.macro_length * 1e3, "mm"));
  PetscCall(LamRecordWriterInts(file->writer, "/macro/elements", 2, dims, fields->elements));
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    if (s) PetscCall(PetscStrlcat(names, "\n", sizeof(names)));
    PetscCall(PetscStrlcat(names, step->boundary[s], sizeof(names)));
  }
  PetscCall(LamRecordWriterText(file->writer, "/macro/boundaries", names));
  file->side_count = step->boundary_count;
  PetscFunctionReturn(0);
}

static PetscErrorCode StepName(PetscInt step, const char name[], char path[96])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, 96, "/macro/step/%" PetscInt_FMT "/%s", step, name));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteTensors(LamFE2File file, PetscInt step, const LamMacroFields *fields)
{
  const PetscReal MPa = file->scales.stress * 1e-6;
  char name[96];

  PetscFunctionBeginUser;
  PetscCall(StepName(step, "F", name));
  PetscCall(WriteColumns(file, name, fields->element_count, 9, 0, 9, fields->F, 1, "1"));
  PetscCall(StepName(step, "P", name));
  PetscCall(WriteColumns(file, name, fields->element_count, 9, 0, 9, fields->P, MPa, "MPa"));
  PetscCall(StepName(step, "cauchy", name));
  PetscCall(WriteColumns(file, name, fields->element_count, 9, 0, 9, fields->cauchy, MPa, "MPa"));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteIndicators(LamFE2File file, PetscInt step, const LamMacroFields *fields)
{
  static const char *const names[4] = {"lumen_fraction", "opening_fraction", "debonded_fraction", "turgor"};
  const PetscReal factor[4] = {1, 1, 1, file->scales.stress * 1e-6};
  const PetscInt n = fields->element_count;
  PetscReal *indicator;
  char name[96];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * n, &indicator));
  for (PetscInt k = 0; k < 4 * n; k++) indicator[k] = fields->indicator[k] * factor[k % 4];
  PetscCall(StepName(step, "indicator", name));
  PetscCall(WriteColumns(file, name, n, 4, 0, 4, indicator, 1, "1, 1, 1, MPa"));
  for (PetscInt k = 0; k < 4; k++) {
    PetscCall(StepName(step, names[k], name));
    PetscCall(WriteColumns(file, name, n, 4, k, 1, indicator, 1, k == 3 ? "MPa" : "1"));
  }
  PetscCall(PetscFree(indicator));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteDisplacement(LamFE2File file, PetscInt step, const LamMacroFields *fields)
{
  PetscReal *u;
  char name[96];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * fields->node_count, &u));
  for (PetscInt k = 0; k < fields->node_count; k++) PetscCall(PetscArraycpy(&u[3 * k], &fields->u[2 * k], 2));
  PetscCall(StepName(step, "u", name));
  PetscCall(WriteColumns(file, name, fields->node_count, 3, 0, 3, u, file->scales.macro_length * 1e3, "mm"));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepCurve(LamFE2File file, const LamMacroStep *step)
{
  PetscInt k = file->step_count++, row = 2 * file->side_count;

  PetscFunctionBeginUser;
  if (file->step_count > file->capacity) {
    file->capacity = PetscMax(16, 2 * file->capacity);
    PetscCall(PetscRealloc(file->capacity * sizeof(PetscInt), &file->steps));
    PetscCall(PetscRealloc(file->capacity * sizeof(PetscReal), &file->load_factor));
    PetscCall(PetscRealloc(file->capacity * sizeof(PetscReal), &file->work));
    PetscCall(PetscRealloc((file->capacity * row + 1) * sizeof(PetscReal), &file->reaction));
  }
  file->steps[k] = step->step;
  file->load_factor[k] = step->load_factor;
  file->work[k] = step->work;
  PetscCall(PetscArraycpy(&file->reaction[k * row], &step->reaction[0][0], row));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteCurves(LamFE2File file)
{
  const PetscReal newton_per_mm = file->scales.stress * file->scales.macro_length * 1e-3;
  const PetscReal work_unit = file->scales.stress * PetscSqr(file->scales.macro_length); /* J/m, which is N mm/mm */
  const PetscInt n = file->step_count, dims[3] = {n, file->side_count, 2};
  PetscReal *reaction;

  PetscFunctionBeginUser;
  PetscCall(WriteColumns(file, "/macro/curve/load_factor", n, 1, 0, 1, file->load_factor, 1, "1"));
  PetscCall(WriteColumns(file, "/macro/curve/work", n, 1, 0, 1, file->work, work_unit, "N mm/mm"));
  PetscCall(PetscMalloc1(n * dims[1] * 2, &reaction));
  for (PetscInt k = 0; k < n * dims[1] * 2; k++) reaction[k] = file->reaction[k] * newton_per_mm;
  PetscCall(LamRecordWriterReals(file->writer, "/macro/curve/reaction", 3, dims, reaction, "N/mm"));
  PetscCall(PetscFree(reaction));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2FileAddStep(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterBegin(file->writer));
  if (!file->step_count) PetscCall(WriteMesh(file, step, fields));
  PetscCall(WriteDisplacement(file, step->step, fields));
  PetscCall(WriteTensors(file, step->step, fields));
  PetscCall(WriteIndicators(file, step->step, fields));
  PetscCall(KeepCurve(file, step));
  PetscCall(WriteCurves(file));
  PetscCall(LamRecordWriterInts(file->writer, "/macro/steps", 1, &file->step_count, file->steps));
  PetscCall(LamRecordWriterCommit(file->writer, 0, NULL, NULL)); /* the file has the whole step now */
  PetscCall(LamXDMFWrite(file->path, fields->node_count, fields->element_count, file->step_count, file->steps,
                         file->load_factor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2FileArchive(LamFE2File file, LamArchive archive)
{
  struct LamFE2File_s none, *f = file ? file : &none;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(&none, sizeof(none)));
  PetscCall(LamArchiveShared(archive, "sides", sizeof(f->side_count), &f->side_count));
  PetscCall(LamArchiveList(archive, "steps", sizeof(PetscInt), &f->step_count, (void **)&f->steps));
  PetscCall(LamArchiveList(archive, "load factors", sizeof(PetscReal), &f->step_count, (void **)&f->load_factor));
  PetscCall(LamArchiveList(archive, "works", sizeof(PetscReal), &f->step_count, (void **)&f->work));
  PetscCall(LamArchiveList(archive, "reactions", 2 * (size_t)f->side_count * sizeof(PetscReal), &f->step_count,
                           (void **)&f->reaction));
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
  PetscCall(PetscFree((*file)->load_factor));
  PetscCall(PetscFree((*file)->work));
  PetscCall(PetscFree((*file)->reaction));
  PetscCall(PetscFree(*file));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
