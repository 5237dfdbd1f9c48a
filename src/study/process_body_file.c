/*
  Data of a body that changes in time that its result file holds beside the steps (docs/reference/files.md): /process,
  arrays over the states.
*/
#include "process_run.h"
#include "names.h"
#include <stddef.h>

PetscErrorCode LamBodyHistoryAdd(LamBodyHistory *h, const LamBodyState *state)
{
  PetscFunctionBeginUser;
  if (h->count == h->capacity) {
    h->capacity = PetscMax(128, 2 * h->capacity);
    PetscCall(PetscRealloc((size_t)h->capacity * sizeof(LamBodyState), &h->states));
  }
  h->states[h->count++] = *state;
  PetscFunctionReturn(0);
}

/* Writes `columns` numbers of each state, at `offset`, times `factor`. */
static PetscErrorCode WriteColumns(const LamBodyHistory *h, LamRecordWriter writer, const char name[], size_t offset,
                                   PetscInt columns, PetscReal factor, const char unit[])
{
  const PetscInt dims[2] = {h->count, columns};
  char path[LAM_NAME_LENGTH];
  PetscReal *values;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/process/%s", name));
  PetscCall(PetscMalloc1(h->count * columns, &values));
  for (PetscInt k = 0; k < h->count; k++)
    for (PetscInt c = 0; c < columns; c++)
      values[k * columns + c] = factor * ((const PetscReal *)((const char *)&h->states[k] + offset))[c];
  ierr = LamRecordWriterReals(writer, path, columns > 1 ? 2 : 1, dims, values, unit);
  PetscCall(PetscFree(values));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Writes for each state the number of its event (-1 at output times), of its element, and of the point in that. */
static PetscErrorCode WriteEvents(const LamBodyHistory *h, LamRecordWriter writer)
{
  const PetscInt dims[2] = {h->count, 2};
  char names[LAM_EVENT_COUNT * LAM_NAME_LENGTH] = "";
  PetscInt *events, *at;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_EVENT_COUNT; k++) LamNamesAppend(sizeof(names), names, "\n", LamEventNames[k]);
  PetscCall(PetscMalloc2(h->count, &events, 2 * h->count, &at));
  for (PetscInt k = 0; k < h->count; k++) {
    events[k] = h->states[k].event == LAM_EVENT_COUNT ? -1 : (PetscInt)h->states[k].event;
    at[2 * k] = h->states[k].element;
    at[2 * k + 1] = h->states[k].point;
  }
  PetscErrorCode ierr = LamRecordWriterInts(writer, "/process/event", 1, &h->count, events);
  if (!ierr) ierr = LamRecordWriterInts(writer, "/process/event_point", 2, dims, at);
  PetscCall(PetscFree2(events, at));
  PetscCall(ierr);
  PetscCall(LamRecordWriterText(writer, "/process/events", names));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyHistoryWrite(LamRecordWriter writer, void *ctx)
{
  const LamBodyHistory *h = (const LamBodyHistory *)ctx;
  const PetscReal MPa = h->scene->scales.stress * 1e-6, mm = h->scene->scales.macro_length * 1e3;
  const struct {
    const char *name, *unit;
    size_t offset;
    PetscReal factor;
  } columns[] = {
      {"time", "s", offsetof(LamBodyState, time), 1},
      {"temperature", "K", offsetof(LamBodyState, temperature), 1},
      {"outside", "MPa", offsetof(LamBodyState, outside), MPa},
      {"walls", "1", offsetof(LamBodyState, walls), 1},
      {"load", "1", offsetof(LamBodyState, load), 1},
      {"water", "1", offsetof(LamBodyState, water), 1},
      {"turgor_min", "MPa", offsetof(LamBodyState, turgor_min), MPa},
      {"turgor_mean", "MPa", offsetof(LamBodyState, step.turgor_mean), MPa},
      {"turgor_max", "MPa", offsetof(LamBodyState, turgor_max), MPa},
      {"plasmolysed", "1", offsetof(LamBodyState, plasmolysed), 1},
      {"debonded_fraction", "1", offsetof(LamBodyState, step.debonded_fraction), 1},
  };
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (size_t c = 0; c < PETSC_STATIC_ARRAY_LENGTH(columns); c++)
    PetscCall(WriteColumns(h, writer, columns[c].name, columns[c].offset, 1, columns[c].factor, columns[c].unit));
  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "ratio/%s", LamRatioNames[k]));
    PetscCall(WriteColumns(h, writer, name, offsetof(LamBodyState, ratio) + (size_t)k * sizeof(PetscReal), 1, 1, "1"));
  }
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    if (LamSceneLacksChanging(h->scene, (LamChanging)k)) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "factor/%s", LamChangingNames[k]));
    PetscCall(WriteColumns(h, writer, name, offsetof(LamBodyState, factor) + (size_t)k * sizeof(PetscReal), 1, 1, "1"));
  }
  PetscCall(WriteColumns(h, writer, "event_place", offsetof(LamBodyState, place), 2, mm, "mm"));
  PetscCall(WriteEvents(h, writer));
  PetscFunctionReturn(0);
}
