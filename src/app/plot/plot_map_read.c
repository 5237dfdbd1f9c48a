/*
  Reads the data of the picture of a map from its file.
*/
#include "plot_map.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static PetscErrorCode ReadText(const char path[], char letter, const char name[], char text[LAM_NAME_LENGTH])
{
  char dataset[LAM_NAME_LENGTH], *read;

  PetscFunctionBeginUser;
  snprintf(dataset, sizeof dataset, "/map/%c/%s", letter, name);
  PetscCall(LamPlotReadText(path, dataset, &read));
  PetscCall(PetscStrncpy(text, read, LAM_NAME_LENGTH));
  PetscCall(PetscFree(read));
  PetscFunctionReturn(0);
}

static void LabelSide(LamMapSide *side)
{
  static const struct {
    const char *quantity, *label;
  } labels[] = {{"turgor", "turgor $p$"},
                {"cohesion", "cohesion $g$"},
                {"shear", "shear $F$_{12}"},
                {"load_factor", "load factor"},
                {"wall_strength", "strength of the wall"},
                {"lamella_normal", "normal strength of the lamella"},
                {"lamella_shear", "shear strength of the lamella"},
                {"wall_thickness", "wall thickness $t$"}};
  const char *label = side->quantity;
  char words[40], parameter[LAM_NAME_LENGTH];

  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++) {
    if (strcmp(side->quantity, LamWallParameterNames[k])) continue;
    snprintf(parameter, sizeof parameter, "%s %.16s", LamWallParameterWords(k, sizeof words, words),
             LamWallParameterSymbol(k));
    label = parameter;
  }
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(labels); i++)
    if (!strcmp(side->quantity, labels[i].quantity)) label = labels[i].label;
  if (side->is_log && strcmp(side->unit, "1"))
    snprintf(side->label, sizeof side->label, "log_{10} of %s in %s", label, side->unit);
  else
    snprintf(side->label, sizeof side->label, "%s%s", side->is_log ? "log_{10} of " : "", label);
}

static PetscErrorCode ReadSide(const char path[], char letter, LamMapSide *side)
{
  char name[LAM_NAME_LENGTH], spacing[LAM_NAME_LENGTH];
  PetscInt rank, dims[4];
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(ReadText(path, letter, "quantity", side->quantity));
  PetscCall(ReadText(path, letter, "unit", side->unit));
  PetscCall(ReadText(path, letter, "spacing", spacing));
  snprintf(name, sizeof name, "/map/%c/values", letter);
  PetscCall(LamFileReadReals(path, name, &found, &rank, dims, &side->at));
  PetscCheck(found && rank == 1 && dims[0] > 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no %s; it is damaged, or older than this program", path, name);
  side->n = dims[0];
  side->from = side->at[0];
  side->to = side->at[side->n - 1];
  side->is_log = (PetscBool)!strcmp(spacing, "log");
  PetscCall(PetscMalloc1(side->n + 1, &side->edge));
  for (PetscInt i = 0; i < side->n && side->is_log; i++) side->at[i] = log10(side->at[i]);
  for (PetscInt i = 1; i < side->n; i++) side->edge[i] = 0.5 * (side->at[i - 1] + side->at[i]);
  side->edge[0] = 1.5 * side->at[0] - 0.5 * side->at[1];
  side->edge[side->n] = 1.5 * side->at[side->n - 1] - 0.5 * side->at[side->n - 2];
  LabelSide(side);
  PetscFunctionReturn(0);
}

/* The mode numbers in the file refer to its own list of names. */
static PetscErrorCode ReadModes(const char path[], LamMapPicture *p)
{
  PetscInt number[16], count = 0;
  char *names, *rest;

  PetscFunctionBeginUser;
  PetscCall(LamPlotReadText(path, "/map/modes", &names));
  for (char *name = strtok_r(names, "\n", &rest); name && count < 16; name = strtok_r(NULL, "\n", &rest)) {
    number[count] = LAM_FAILURE_UNKNOWN;
    for (PetscInt k = 0; k < LAM_FAILURE_MODE_COUNT; k++)
      if (!strcmp(name, LamFailureModeNames[k])) number[count] = k;
    count++;
  }
  PetscCall(PetscFree(names));
  PetscCall(LamPlotReadInts(path, "/map/mode", p->y.n, p->x.n, &p->mode));
  for (PetscInt i = 0; i < p->n; i++)
    if (p->mode[i] >= 0) p->mode[i] = p->mode[i] < count ? number[p->mode[i]] : LAM_FAILURE_UNKNOWN;
  PetscFunctionReturn(0);
}

#define LOAD_FACTOR "load_factor" /* of the points, not of their records */

static PetscBool IsSingleNumber(const LamMember *m)
{
  return (PetscBool)(m->count == 1 && (m->type == LAM_MEMBER_REAL || m->type == LAM_MEMBER_INT));
}

const char *LamPlotMapField(size_t i)
{
  if (!i) return LOAD_FACTOR;
  for (const LamMember *m = LamResponseMembers; m->name; m++)
    if (IsSingleNumber(m) && !--i) return m->name;
  return NULL;
}

/* Finds a scalar member of all records by its name in the table of members. */
static const LamMember *FindMember(const char name[])
{
  for (const LamMember *m = LamResponseMembers; m->name; m++)
    if (IsSingleNumber(m) && !strcmp(m->name, name)) return m;
  return NULL;
}

/* The member of a record in physical units; NaN if it has no fields. */
static PetscReal MemberValue(const LamMember *member, const LamResponse *record, const LamScales *scales)
{
  const char *at = (const char *)record + member->offset;

  if (!LamResponseHasFields(record)) return NAN;
  if (member->type == LAM_MEMBER_INT) return (PetscReal) * (const PetscInt *)(const void *)at;
  return *(const PetscReal *)(const void *)at * PetscPowReal(scales->stress * 1e-6, member->stress_power);
}

/* member: NULL for none. */
static PetscErrorCode ReadRecords(const char path[], const LamMember *member, LamMapPicture *p)
{
  LamDatabase database;
  LamPlotRecords of;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseOpen(path, &database));
  PetscCall(LamPlotGetRecords(database, &of));
  for (PetscInt i = 0; i < of.n; i++) {
    const PetscInt64 point = of.keys[i];

    if (point < 0 || point >= p->n) continue;
    p->shear[point] = of.records[i].load.F[1];
    if (member) p->value[point] = MemberValue(member, &of.records[i], &of.scales);
  }
  p->unit = member && member->stress_power == 1 ? "MPa" : NULL;
  PetscCall(LamDatabaseClose(&database));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadField(const LamPlotRequest *request, LamMapPicture *p)
{
  const LamMember *member;

  PetscFunctionBeginUser;
  p->field = request->field ? request->field : LOAD_FACTOR;
  member = FindMember(p->field);
  PetscCheck(member || !strcmp(p->field, LOAD_FACTOR), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--field %s: a map has " LOAD_FACTOR " and the single numbers of its records, such as max_wall_tension, "
             "max_traction, open_fraction, max_gap, energy",
             p->field);
  PetscCall(PetscMalloc1(p->n, &p->value));
  PetscCall(PetscMalloc1(p->n, &p->shear));
  for (PetscInt i = 0; i < p->n; i++) {
    p->value[i] = member ? NAN : p->load_factor[i];
    p->shear[i] = NAN;
  }
  PetscCall(ReadRecords(request->input, member, p));
  PetscCall(LamColourRangeFind(p->n, p->value, &p->range));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapRead(const char path[], LamMapPicture *p)
{
  PetscFunctionBeginUser;
  *p = (LamMapPicture){.n = 0};
  PetscCall(ReadSide(path, 'x', &p->x));
  PetscCall(ReadSide(path, 'y', &p->y));
  p->n = p->x.n * p->y.n;
  PetscCall(ReadModes(path, p));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapPictureRead(const LamPlotRequest *request, LamMapPicture *p)
{
  PetscFunctionBeginUser;
  PetscCall(LamMapRead(request->input, p));
  PetscCall(LamPlotReadReals(request->input, "/map/load_factor", p->y.n, p->x.n, &p->load_factor));
  PetscCall(ReadField(request, p));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapPictureDestroy(LamMapPicture *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->x.at));
  PetscCall(PetscFree(p->x.edge));
  PetscCall(PetscFree(p->y.at));
  PetscCall(PetscFree(p->y.edge));
  PetscCall(PetscFree(p->mode));
  PetscCall(PetscFree(p->load_factor));
  PetscCall(PetscFree(p->shear));
  PetscCall(PetscFree(p->value));
  PetscFunctionReturn(0);
}
