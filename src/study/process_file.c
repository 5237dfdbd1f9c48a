/*
  The result file of `lamella process`: kind "process". Records are the responses of the states, their keys count from
  0; what else is known of them is in /process, arrays over the states (docs/reference/files.md).
*/
#include "process_run.h"
#include <lamella/clock.h>
#include <stddef.h>

#define COMMIT_SECONDS 5.0

PetscErrorCode LamProcessFileOpen(LamProcessRunState *run)
{
  PetscFunctionBeginUser;
  if (!run->out_path) PetscFunctionReturn(0);
  PetscCall(LamRecordWriterOpen(run->out_path, "process", LAM_WRITE_CREATE, run->scene, &run->writer));
  run->last_commit = LamClock();
  PetscFunctionReturn(0);
}

/* One number of each state, at `offset`, times `factor`. */
static PetscErrorCode WriteColumn(const LamProcessRunState *run, const char name[], size_t offset, PetscReal factor,
                                  const char unit[])
{
  const LamProcessHistory *h = &run->history;
  PetscReal *values;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(h->count, &values));
  for (PetscInt k = 0; k < h->count; k++)
    values[k] = factor * *(const PetscReal *)((const char *)&h->states[k] + offset);
  ierr = LamRecordWriterReals(run->writer, name, 1, &h->count, values, unit);
  PetscCall(PetscFree(values));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteColumns(const LamProcessRunState *run)
{
  const PetscReal MPa = run->scene->scales.stress * 1e-6;
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
    PetscCall(WriteColumn(run, name, columns[c].offset, columns[c].factor, columns[c].unit));
  }
  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "/process/ratio/%s", LamRatioNames[k]));
    PetscCall(WriteColumn(run, name, offsetof(LamProcessState, ratio) + (size_t)k * sizeof(PetscReal), 1, "1"));
  }
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "/process/factor/%s", LamChangingNames[k]));
    PetscCall(WriteColumn(run, name, offsetof(LamProcessState, factor) + (size_t)k * sizeof(PetscReal), 1, "1"));
  }
  PetscFunctionReturn(0);
}

/* The number of the event at each state, -1 at times of the output; names in /process/events. */
static PetscErrorCode WriteEvents(const LamProcessRunState *run)
{
  const LamProcessHistory *h = &run->history;
  char names[LAM_EVENT_COUNT * LAM_NAME_LENGTH] = "";
  PetscErrorCode ierr;
  PetscInt *events;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_EVENT_COUNT; k++) {
    if (k) PetscCall(PetscStrlcat(names, "\n", sizeof(names)));
    PetscCall(PetscStrlcat(names, LamEventNames[k], sizeof(names)));
  }
  PetscCall(PetscMalloc1(h->count, &events));
  for (PetscInt k = 0; k < h->count; k++)
    events[k] = h->states[k].event == LAM_EVENT_COUNT ? -1 : (PetscInt)h->states[k].event;
  ierr = LamRecordWriterInts(run->writer, "/process/event", 1, &h->count, events);
  PetscCall(PetscFree(events));
  PetscCall(ierr);
  PetscCall(LamRecordWriterText(run->writer, "/process/events", names));
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(LamProcessRunState *run, const char status[])
{
  const PetscInt n = run->history.count - run->committed;
  PetscErrorCode ierr;
  LamResponse *records;
  PetscInt64 *keys;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterBegin(run->writer));
  if (run->history.count) PetscCall(WriteColumns(run));
  if (run->history.count) PetscCall(WriteEvents(run));
  if (status) PetscCall(LamRecordWriterText(run->writer, "/process/status", status));
  PetscCall(PetscMalloc2(n, &keys, n, &records));
  for (PetscInt k = 0; k < n; k++) {
    keys[k] = run->committed + k;
    records[k] = run->history.states[run->committed + k].response;
  }
  ierr = LamRecordWriterCommit(run->writer, n, keys, records);
  PetscCall(PetscFree2(keys, records));
  PetscCall(ierr);
  run->committed += n;
  run->last_commit = LamClock();
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessFileAdd(LamProcessRunState *run, PetscBool now)
{
  PetscFunctionBeginUser;
  if (!run->writer || (!now && LamClock() - run->last_commit < COMMIT_SECONDS)) PetscFunctionReturn(0);
  PetscCall(Commit(run, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessFileClose(LamProcessRunState *run, const char status[])
{
  PetscErrorCode ierr = 0, closed;

  PetscFunctionBeginUser;
  if (!run->writer) PetscFunctionReturn(0);
  if (status) ierr = Commit(run, status);
  closed = LamRecordWriterClose(&run->writer);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}
