/*
  States of processes in result files and progress reports. /process has arrays over the states
  (docs/reference/files.md).
*/
#include "process_run.h"
#include "beside.h"
#include "mechanical_test.h"
#include "names.h"
#include <stddef.h>
#include <string.h>

PetscInt64 LamProcessProgress(const LamScene *scene, PetscReal time)
{
  return (PetscInt64)(LAM_PROCESS_PARTS * time / scene->process.duration);
}

/* States of a material point or of a body, each of `size` bytes. */
typedef struct {
  LamRecordWriter writer;
  const LamScene *scene;
  PetscInt count;
  const void *states;
  size_t size;
} States;

/* Numbers of a state, at `offset`, times `factor` in `unit`. */
typedef struct {
  const char *name, *unit;
  size_t offset;
  PetscReal factor;
} Column;

static PetscErrorCode WriteColumn(const States *s, const char group[], Column column, PetscInt numbers)
{
  const PetscInt dims[2] = {s->count, numbers};
  char path[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/process/%s%s", group, column.name));
  PetscCall(LamWriteRows(s->writer, path, numbers > 1 ? 2 : 1, dims,
                         (const PetscReal *)((const char *)s->states + column.offset), s->size, column.factor,
                         column.unit));
  PetscFunctionReturn(0);
}

/* Writes the columns, and the arrays of ratios and factors at these offsets. */
static PetscErrorCode WriteColumns(const States *s, size_t count, const Column columns[], size_t ratio, size_t factor)
{
  PetscFunctionBeginUser;
  for (size_t c = 0; c < count; c++) PetscCall(WriteColumn(s, "", columns[c], 1));
  for (size_t k = 0; k < LAM_RATIO_COUNT; k++)
    PetscCall(WriteColumn(s, "ratio/", (Column){LamRatioNames[k], "1", ratio + k * sizeof(PetscReal), 1}, 1));
  for (size_t k = 0; k < LAM_CHANGING_COUNT; k++)
    if (!LamSceneLacksChanging(s->scene, (LamChanging)k))
      PetscCall(WriteColumn(s, "factor/", (Column){LamChangingNames[k], "1", factor + k * sizeof(PetscReal), 1}, 1));
  PetscFunctionReturn(0);
}

/* Writes the number of the event at each state, -1 at output times; names in /process/events. */
static PetscErrorCode WriteEvents(const States *s, size_t offset)
{
  char names[LAM_EVENT_COUNT * LAM_NAME_LENGTH] = "";
  PetscErrorCode ierr;
  PetscInt *events;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_EVENT_COUNT; k++) LamNamesAppend(sizeof(names), names, "\n", LamEventNames[k]);
  PetscCall(PetscMalloc1(s->count, &events));
  for (PetscInt k = 0; k < s->count; k++) {
    const LamEvent event = *(const LamEvent *)((const char *)s->states + (size_t)k * s->size + offset);

    events[k] = event == LAM_EVENT_COUNT ? -1 : (PetscInt)event;
  }
  ierr = LamRecordWriterInts(s->writer, "/process/event", 1, &s->count, events);
  PetscCall(PetscFree(events));
  PetscCall(ierr);
  PetscCall(LamRecordWriterText(s->writer, "/process/events", names));
  PetscFunctionReturn(0);
}

#define COLUMN(Type, name, member, factor, unit)                                                                       \
  {                                                                                                                    \
    name, unit, offsetof(Type, member), factor                                                                         \
  }

#define POINT_COLUMNS 9
static void PointColumns(const LamScene *scene, Column columns[POINT_COLUMNS])
{
  const PetscReal MPa = scene->scales.stress * 1e-6;
  const Column all[POINT_COLUMNS] = {
      COLUMN(LamProcessState, "time", time, 1, "s"),
      COLUMN(LamProcessState, "temperature", temperature, 1, "K"),
      COLUMN(LamProcessState, "turgor", turgor, MPa, "MPa"),
      COLUMN(LamProcessState, "cohesion", cohesion, MPa, "MPa"),
      COLUMN(LamProcessState, "osmotic_pressure", osmotic, MPa, "MPa"),
      COLUMN(LamProcessState, "outside", outside, MPa, "MPa"),
      COLUMN(LamProcessState, "firmness", firmness, MPa, "MPa"),
      COLUMN(LamProcessState, "water", water, 1, "1"),
      COLUMN(LamProcessState, "walls", walls, 1, "1"),
  };

  for (int c = 0; c < POINT_COLUMNS; c++) columns[c] = all[c];
}

PetscErrorCode LamProcessHistoryWrite(LamRecordWriter writer, const LamScene *scene, const LamProcessHistory *h)
{
  const States s = {writer, scene, h->count, h->states, sizeof(LamProcessState)};
  Column columns[POINT_COLUMNS];

  PetscFunctionBeginUser;
  PointColumns(scene, columns);
  PetscCall(
      WriteColumns(&s, POINT_COLUMNS, columns, offsetof(LamProcessState, ratio), offsetof(LamProcessState, factor)));
  PetscCall(WriteEvents(&s, offsetof(LamProcessState, event)));
  PetscFunctionReturn(0);
}

static const char *const NoMore[] = {NULL};
const LamTextKind LamProcessTable = {
    .what = "a table of lamella process",
    .ending = ".csv",
    .begins = "state,event,time (s),temperature (K),turgor (MPa),cohesion (MPa),osmotic_pressure (MPa),outside (MPa),"
              "firmness (MPa),water,walls,F11,F12,F21,F22,F33,P11 (MPa),P12 (MPa),P21 (MPa),P22 (MPa),P33 (MPa)",
    .columns = NoMore};

PetscErrorCode LamProcessHistoryWriteCSV(const char hdf5[], const LamScene *scene, const LamProcessHistory *h)
{
  static const int plane[] = {0, 1, 3, 4, 8};
  const PetscReal MPa = scene->scales.stress * 1e-6;
  Column columns[POINT_COLUMNS];
  LamBeside file;

  PetscFunctionBeginUser;
  PointColumns(scene, columns);
  PetscCall(LamBesideOpen(hdf5, &LamProcessTable, &file));
  fprintf(file.out, "%s\n", LamProcessTable.begins); /* the columns, F and P */
  for (PetscInt n = 0; n < h->count; n++) {
    const LamProcessState *state = &h->states[n];
    PetscReal F[9], P[9];

    LamProcessMeasures(scene, state, F, P);
    fprintf(file.out, "%d,%s", (int)n, state->event == LAM_EVENT_COUNT ? "" : LamEventNames[state->event]);
    for (int c = 0; c < POINT_COLUMNS; c++)
      LamBesideNumber(file.out,
                      columns[c].factor * *(const PetscReal *)(const void *)((const char *)state + columns[c].offset));
    for (int k = 0; k < 5; k++) LamBesideNumber(file.out, F[plane[k]]);
    for (int k = 0; k < 5; k++) LamBesideNumber(file.out, P[plane[k]] * MPa);
    fputc('\n', file.out);
  }
  PetscCall(LamBesideClose(&file));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyHistoryWrite(LamRecordWriter writer, void *history)
{
  const LamBodyHistory *h = (const LamBodyHistory *)history;
  const PetscReal MPa = h->scene->scales.stress * 1e-6, mm = h->scene->scales.macro_length * 1e3;
  const States s = {writer, h->scene, h->count, h->states, sizeof(LamBodyState)};
  const PetscInt dims[2] = {h->count, 2};
  const Column columns[] = {
      COLUMN(LamBodyState, "time", time, 1, "s"),
      COLUMN(LamBodyState, "temperature", temperature, 1, "K"),
      COLUMN(LamBodyState, "outside", outside, MPa, "MPa"),
      COLUMN(LamBodyState, "walls", walls, 1, "1"),
      COLUMN(LamBodyState, "load", load, 1, "1"),
      COLUMN(LamBodyState, "water", water, 1, "1"),
      COLUMN(LamBodyState, "turgor_min", turgor_min, MPa, "MPa"),
      COLUMN(LamBodyState, "turgor_mean", step.turgor_mean, MPa, "MPa"),
      COLUMN(LamBodyState, "turgor_max", turgor_max, MPa, "MPa"),
      COLUMN(LamBodyState, "plasmolysed", plasmolysed, 1, "1"),
      COLUMN(LamBodyState, "debonded_fraction", step.debonded_fraction, 1, "1"),
  };
  const Column moving[] = {COLUMN(LamBodyState, "inflow", inflow, 1, "1"),
                           COLUMN(LamBodyState, "water_balance", water_balance, 1, "1")};
  PetscErrorCode ierr;
  PetscInt *at;

  PetscFunctionBeginUser;
  for (int c = 0; c < 2 && LamTransportHasPotentials(h->scene); c++) PetscCall(WriteColumn(&s, "", moving[c], 1));
  PetscCall(WriteColumns(&s, PETSC_STATIC_ARRAY_LENGTH(columns), columns, offsetof(LamBodyState, ratio),
                         offsetof(LamBodyState, factor)));
  PetscCall(WriteColumn(&s, "", (Column)COLUMN(LamBodyState, "event_place", place, mm, "mm"), 2));
  PetscCall(WriteEvents(&s, offsetof(LamBodyState, event)));
  PetscCall(PetscMalloc1(2 * h->count, &at));
  for (PetscInt k = 0; k < h->count; k++) {
    at[2 * k] = h->states[k].element;
    at[2 * k + 1] = h->states[k].point;
  }
  ierr = LamRecordWriterInts(writer, "/process/event_point", 2, dims, at);
  PetscCall(PetscFree(at));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
