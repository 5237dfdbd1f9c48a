/*
  What the pictures of a process show, from its file.
*/
#include "plot_process.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *LamTimeUnit(PetscReal duration, PetscReal *seconds)
{
  static const struct {
    const char *name;
    PetscReal seconds;
  } units[] = {{"day", 86400}, {"h", 3600}, {"min", 60}, {"s", 1}};
  size_t k = 0;

  while (k + 1 < PETSC_STATIC_ARRAY_LENGTH(units) && duration < 2 * units[k].seconds) k++;
  *seconds = units[k].seconds;
  return units[k].name;
}

static PetscErrorCode ReadColumn(const LamProcessPicture *p, const char name[], PetscReal **values)
{
  char path[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/process/%s", name));
  PetscCall(LamPlotReadReals(p->path, path, p->n, 1, values));
  PetscFunctionReturn(0);
}

static PetscBool Varies(PetscInt n, const PetscReal values[])
{
  for (PetscInt k = 1; k < n; k++)
    if (values[k] != values[0]) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode ReadFactors(LamProcessPicture *p)
{
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    PetscReal *values;

    PetscCall(PetscSNPrintf(name, sizeof(name), "factor/%s", LamChangingNames[k]));
    PetscCall(ReadColumn(p, name, &values));
    if (!Varies(p->n, values)) {
      PetscCall(PetscFree(values));
      continue;
    }
    PetscCall(PetscStrncpy(p->factor_name[p->factor_count], LamChangingNames[k], LAM_NAME_LENGTH));
    p->factor[p->factor_count++] = values;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadRatios(LamProcessPicture *p)
{
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) {
    PetscReal *values;

    PetscCall(PetscSNPrintf(name, sizeof(name), "ratio/%s", LamRatioNames[k]));
    PetscCall(ReadColumn(p, name, &values));
    if (!isfinite(values[0])) {
      PetscCall(PetscFree(values));
      continue;
    }
    PetscCall(PetscStrncpy(p->ratio_name[p->ratio_count], LamRatioNames[k], LAM_NAME_LENGTH));
    p->ratio[p->ratio_count++] = values;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadEvents(LamProcessPicture *p)
{
  PetscInt rank, dims[4];
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(p->path, "/process/event", &found, &rank, dims, &p->event));
  PetscCheck(found && rank == 1 && dims[0] == p->n, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /process/event does not fit the rest of the file; it is damaged", p->path);
  PetscCall(LamFileReadText(p->path, "/process/events", &found, &p->event_names));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no /process/events to draw", p->path);
  PetscFunctionReturn(0);
}

void LamProcessEventName(const LamProcessPicture *p, PetscInt state, size_t size, char name[])
{
  const char *at = p->event_names;

  name[0] = '\0';
  if (p->event[state] < 0) return;
  for (PetscInt k = 0; k < p->event[state] && *at; k++) at += strcspn(at, "\n") + (strchr(at, '\n') ? 1 : 0);
  snprintf(name, size, "%.*s", (int)PetscMin(strcspn(at, "\n"), size - 1), at);
  for (char *c = name; *c; c++)
    if (*c == '_') *c = ' ';
}

PetscErrorCode LamProcessPictureRead(const char path[], LamProcessPicture *p)
{
  const PetscInt64 *keys;

  PetscFunctionBeginUser;
  *p = (LamProcessPicture){.path = path};
  PetscCall(LamDatabaseOpen(path, &p->database));
  PetscCall(LamDatabaseGetRecords(p->database, &p->n, &p->records, &keys));
  PetscCall(LamDatabaseGetMicrostructure(p->database, &p->micro, &p->scales, NULL));
  PetscCheck(p->n > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no states", path);
  PetscCall(ReadColumn(p, "time", &p->time));
  PetscCall(ReadColumn(p, "turgor", &p->turgor));
  PetscCall(ReadColumn(p, "cohesion", &p->cohesion));
  PetscCall(ReadColumn(p, "osmotic_pressure", &p->osmotic));
  PetscCall(ReadColumn(p, "outside", &p->outside));
  PetscCall(ReadColumn(p, "firmness", &p->firmness));
  PetscCall(ReadColumn(p, "walls", &p->walls));
  PetscCall(ReadFactors(p));
  PetscCall(ReadRatios(p));
  PetscCall(ReadEvents(p));
  p->unit = LamTimeUnit(p->time[p->n - 1], &p->seconds);
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessPictureDestroy(LamProcessPicture *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->time));
  PetscCall(PetscFree(p->turgor));
  PetscCall(PetscFree(p->cohesion));
  PetscCall(PetscFree(p->osmotic));
  PetscCall(PetscFree(p->outside));
  PetscCall(PetscFree(p->firmness));
  PetscCall(PetscFree(p->walls));
  for (PetscInt k = 0; k < p->factor_count; k++) PetscCall(PetscFree(p->factor[k]));
  for (PetscInt k = 0; k < p->ratio_count; k++) PetscCall(PetscFree(p->ratio[k]));
  PetscCall(PetscFree(p->event));
  PetscCall(PetscFree(p->event_names));
  PetscCall(LamDatabaseClose(&p->database));
  PetscFunctionReturn(0);
}
