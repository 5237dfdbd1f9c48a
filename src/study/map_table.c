/*
  Failure modes of a map as arrays of its file, beside the records (docs/reference/files.md).
*/
#include "map.h"
#include <math.h>

static void Clear(LamMapTable *table, PetscInt i)
{
  table->mode[i] = table->criterion[i] = -1;
  table->load_factor[i] = NAN;
  for (int k = 0; k < 3; k++) table->place[3 * i + k] = NAN;
}

/* Reads an array with `wanted` numbers: integers, or reals where `ints` is NULL. */
static PetscErrorCode Read(const char path[], const char name[], PetscInt wanted, PetscInt **ints, PetscReal **reals)
{
  PetscInt rank = 0, dims[4], count;
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(ints ? LamFileReadInts(path, name, &found, &rank, dims, ints)
                 : LamFileReadReals(path, name, &found, &rank, dims, reals));
  count = found ? 1 : 0;
  for (PetscInt i = 0; i < rank; i++) count *= dims[i];
  PetscCheck(count == wanted, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s holds %" PetscInt_FMT " numbers instead of %" PetscInt_FMT "; the file is damaged, begin it anew",
             path, name, count, wanted);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapTableCreate(const LamScene *scene, const char path[], const PetscBool known[], LamMapTable *table)
{
  const PetscInt n = LamMapPointCount(scene);

  PetscFunctionBeginUser;
  for (int a = 0; a < LAM_MAP_AXIS_COUNT; a++) table->points[a] = scene->map[a].points;
  if (path) {
    PetscCall(Read(path, "/map/mode", n, &table->mode, NULL));
    PetscCall(Read(path, "/map/criterion", n, &table->criterion, NULL));
    PetscCall(Read(path, "/map/load_factor", n, NULL, &table->load_factor));
    PetscCall(Read(path, "/map/place", 3 * n, NULL, &table->place));
  } else {
    PetscCall(PetscMalloc1(n, &table->mode));
    PetscCall(PetscMalloc1(n, &table->criterion));
    PetscCall(PetscMalloc1(n, &table->load_factor));
    PetscCall(PetscMalloc1(3 * n, &table->place));
  }
  for (PetscInt i = 0; i < n; i++)
    if (!known[i]) Clear(table, i);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapTableDestroy(LamMapTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(table->mode));
  PetscCall(PetscFree(table->criterion));
  PetscCall(PetscFree(table->load_factor));
  PetscCall(PetscFree(table->place));
  PetscFunctionReturn(0);
}

void LamMapTableSet(LamMapTable *table, const LamMapPoint *point)
{
  const PetscInt64 i = point->number;

  table->mode[i] = (PetscInt)point->mode;
  table->criterion[i] = point->criterion == LAM_CRITERION_COUNT ? -1 : (PetscInt)point->criterion;
  table->load_factor[i] = point->load_factor;
  for (int k = 0; k < 3; k++) table->place[3 * i + k] = point->place[k];
}

/* ---- writing ---- */

/* Names, one per line, in the order of their numbers. */
static PetscErrorCode WriteNames(LamRecordWriter writer, const char name[], PetscInt count, const char *const names[])
{
  char text[1024] = "";

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < count; i++) {
    PetscCall(PetscStrlcat(text, names[i], sizeof(text)));
    PetscCall(PetscStrlcat(text, "\n", sizeof(text)));
  }
  PetscCall(LamRecordWriterText(writer, name, text));
  PetscFunctionReturn(0);
}

/* For pictures: "fibre modulus $C_4$". */
static void LabelOf(LamMapQuantity quantity, size_t size, char label[])
{
  const char *const name = LamMapQuantityNames[quantity];
  char words[64];

  snprintf(label, size, "%s", name);
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    if (!strcmp(name, LamWallParameterNames[k]))
      snprintf(label, size, "%s %s", LamWallParameterWords(k, sizeof(words), words), LamWallParameterSymbol(k));
  for (char *c = label; *c; c++)
    if (*c == '_' && !strchr(label, '$')) *c = ' ';
}

static PetscErrorCode WriteAxis(LamRecordWriter writer, char letter, const LamMapAxis *axis, const LamScales *scales)
{
  PetscReal *values, scale;
  const char *const unit = LamMapQuantityUnit(axis->quantity, scales, &scale);
  const char *const names[] = {"quantity", "spacing", "unit", "label"};
  char name[LAM_NAME_LENGTH], label[LAM_NAME_LENGTH];
  const char *const texts[] = {LamMapQuantityNames[axis->quantity], axis->is_log ? "log" : "linear", unit, label};

  PetscFunctionBeginUser;
  LabelOf(axis->quantity, sizeof(label), label);
  PetscCall(PetscMalloc1(axis->points, &values));
  for (PetscInt i = 0; i < axis->points; i++) values[i] = LamMapAxisValue(axis, i) * scale;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(names); i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "/map/%c/%s", letter, names[i]));
    PetscCall(LamRecordWriterText(writer, name, texts[i]));
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "/map/%c/values", letter));
  PetscCall(LamRecordWriterReals(writer, name, 1, &axis->points, values, unit));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapAxesWrite(LamRecordWriter writer, const LamScene *scene)
{
  PetscFunctionBeginUser;
  PetscCall(WriteAxis(writer, 'x', &scene->map[LAM_MAP_X], &scene->scales));
  PetscCall(WriteAxis(writer, 'y', &scene->map[LAM_MAP_Y], &scene->scales));
  PetscCall(WriteNames(writer, "/map/modes", LAM_FAILURE_MODE_COUNT, LamFailureModeNames));
  PetscCall(WriteNames(writer, "/map/criteria", LAM_CRITERION_COUNT, LamCriterionNames));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapTableWrite(LamRecordWriter writer, const LamMapTable *table)
{
  const PetscInt dims[3] = {table->points[LAM_MAP_Y], table->points[LAM_MAP_X], 3};

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterInts(writer, "/map/mode", 2, dims, table->mode));
  PetscCall(LamRecordWriterInts(writer, "/map/criterion", 2, dims, table->criterion));
  PetscCall(LamRecordWriterReals(writer, "/map/load_factor", 2, dims, table->load_factor, "1"));
  PetscCall(LamRecordWriterReals(writer, "/map/place", 3, dims, table->place, "1"));
  PetscFunctionReturn(0);
}
