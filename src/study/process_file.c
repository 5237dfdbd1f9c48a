/*
  The result file of `lamella process`: kind "process". Records are the responses of the states, with keys from 0; the
  other quantities are in /process, arrays over the states (docs/reference/files.md).
*/
#include "process_run.h"
#include "clock.h"
#include "names.h"
#include <stddef.h>

#define COMMIT_SECONDS 5.0

PetscErrorCode LamProcessFileOpen(LamProcessStudy *study)
{
  PetscFunctionBeginUser;
  if (!study->out_path) PetscFunctionReturn(0);
  PetscCall(LamRecordWriterOpen(study->out_path, "process", LAM_WRITE_CREATE, study->scene, &study->writer));
  study->last_commit = LamClock();
  PetscFunctionReturn(0);
}

/* Writes one number of each state, at `offset`, times `factor`. */
static PetscErrorCode WriteColumn(const LamProcessStudy *study, const char name[], size_t offset, PetscReal factor,
                                  const char unit[])
{
  const LamProcessHistory *h = &study->history;
  PetscReal *values;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(h->count, &values));
  for (PetscInt k = 0; k < h->count; k++)
    values[k] = factor * *(const PetscReal *)((const char *)&h->states[k] + offset);
  ierr = LamRecordWriterReals(study->writer, name, 1, &h->count, values, unit);
  PetscCall(PetscFree(values));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteColumns(const LamProcessStudy *study)
{
  const PetscReal MPa = study->scene->scales.stress * 1e-6;
  const struct {
    const char *name, *unit;
    size_t offset;
    PetscReal factor;
  } columns[] = {
      {"time", "s", offsetof(LamProcessState, time), 1},
      {"temperature", "K", offsetof(LamProcessState, temperature), 1},
      {"turgor", "MPa", offsetof(LamProcessState, turgor), MPa},
      {"cohesion", "MPa", offsetof(LamProcessState, cohesion), MPa},
      {"osmotic_pressure", "MPa", offsetof(LamProcessState, osmotic), MPa},
      {"outside", "MPa", offsetof(LamProcessState, outside), MPa},
      {"firmness", "MPa", offsetof(LamProcessState, firmness), MPa},
      {"water", "1", offsetof(LamProcessState, water), 1},
      {"walls", "1", offsetof(LamProcessState, walls), 1},
  };
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (size_t c = 0; c < PETSC_STATIC_ARRAY_LENGTH(columns); c++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "/process/%s", columns[c].name));
    PetscCall(WriteColumn(study, name, columns[c].offset, columns[c].factor, columns[c].unit));
  }
  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "/process/ratio/%s", LamRatioNames[k]));
    PetscCall(WriteColumn(study, name, offsetof(LamProcessState, ratio) + (size_t)k * sizeof(PetscReal), 1, "1"));
  }
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    if (LamSceneLacksChanging(study->scene, (LamChanging)k)) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "/process/factor/%s", LamChangingNames[k]));
    PetscCall(WriteColumn(study, name, offsetof(LamProcessState, factor) + (size_t)k * sizeof(PetscReal), 1, "1"));
  }
  PetscFunctionReturn(0);
}

/* Writes the number of the event at each state, -1 at output times; names in /process/events. */
static PetscErrorCode WriteEvents(const LamProcessStudy *study)
{
  const LamProcessHistory *h = &study->history;
  char names[LAM_EVENT_COUNT * LAM_NAME_LENGTH] = "";
  PetscErrorCode ierr;
  PetscInt *events;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_EVENT_COUNT; k++) LamNamesAppend(sizeof(names), names, "\n", LamEventNames[k]);
  PetscCall(PetscMalloc1(h->count, &events));
  for (PetscInt k = 0; k < h->count; k++)
    events[k] = h->states[k].event == LAM_EVENT_COUNT ? -1 : (PetscInt)h->states[k].event;
  ierr = LamRecordWriterInts(study->writer, "/process/event", 1, &h->count, events);
  PetscCall(PetscFree(events));
  PetscCall(ierr);
  PetscCall(LamRecordWriterText(study->writer, "/process/events", names));
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(LamProcessStudy *study, const char status[])
{
  const PetscInt n = study->history.count - study->committed;
  PetscErrorCode ierr;
  LamResponse *records;
  PetscInt64 *keys;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterBegin(study->writer));
  if (study->history.count) PetscCall(WriteColumns(study));
  if (study->history.count) PetscCall(WriteEvents(study));
  if (status) PetscCall(LamRecordWriterText(study->writer, "/process/status", status));
  PetscCall(PetscMalloc2(n, &keys, n, &records));
  for (PetscInt k = 0; k < n; k++) {
    keys[k] = study->committed + k;
    records[k] = study->history.states[study->committed + k].response;
  }
  ierr = LamRecordWriterCommit(study->writer, n, keys, records);
  PetscCall(PetscFree2(keys, records));
  PetscCall(ierr);
  study->committed += n;
  study->last_commit = LamClock();
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessFileAdd(LamProcessStudy *study, PetscBool now)
{
  PetscFunctionBeginUser;
  if (!study->writer || (!now && LamClock() - study->last_commit < COMMIT_SECONDS)) PetscFunctionReturn(0);
  PetscCall(Commit(study, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessFileClose(LamProcessStudy *study, const char status[])
{
  PetscErrorCode ierr = 0, closed;

  PetscFunctionBeginUser;
  if (!study->writer) PetscFunctionReturn(0);
  if (status) ierr = Commit(study, status);
  closed = LamRecordWriterClose(&study->writer);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}
