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

static PetscBool IsKnown(PetscInt n, const PetscReal values[])
{
  return (PetscBool)(n > 0 && isfinite(values[0]));
}

/* Of the arrays in a group those that are to be drawn. */
static PetscErrorCode ReadGroup(const LamProcessPicture *p, const char group[], PetscInt n, const char *const names[],
                                PetscBool (*shows)(PetscInt count, const PetscReal values[]), PetscInt *count,
                                PetscReal *values[], char (*labels)[LAM_NAME_LENGTH])
{
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/%s", group, names[k]));
    PetscCall(ReadColumn(p, name, &values[*count]));
    if (!shows(p->n, values[*count])) {
      PetscCall(PetscFree(values[*count]));
      continue;
    }
    PetscCall(PetscStrncpy(labels[*count], names[k], LAM_NAME_LENGTH));
    for (char *c = labels[*count]; *c; c++)
      if (*c == '_') *c = ' ';
    (*count)++;
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
  PetscCall(ReadGroup(p, "factor", LAM_CHANGING_COUNT, LamChangingNames, Varies, &p->factor_count, p->factor,
                      p->factor_name));
  PetscCall(ReadGroup(p, "ratio", LAM_RATIO_COUNT, LamRatioNames, IsKnown, &p->ratio_count, p->ratio, p->ratio_name));
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
