/*
  All keys of scene files: the tables of the blocks, in the order of the reference.
*/
#include "scene_rows.h"
#include <string.h>

static const LamKey first_keys[] = {
    {MAP(""), .example = "version: 1", .help = "The scene."},
    {INTEGER("version"), REQUIRED, FROM(1), TO(1), .example = "1", .help = "Version of the scene format."},
};
static LAM_KEY_TABLE(first, first_keys);

static const LamKey last_keys[] = {
    {REAL("accuracy"), INTO(LamScene, accuracy), ABOVE(0), TO(0.5), .default_value = "0.01", .example = "0.01",
     .help = "Wanted relative error of the effective stress; what the scene leaves open follows from it."},
};
static LAM_KEY_TABLE(last, last_keys);

static const LamKeyTable *const tables[] = {&first,         &LamCellKeys,     &LamWallKeys,    &LamVariationKeys,
                                            &LamTissueKeys, &LamStrengthKeys, &LamLoadKeys,    &LamSampleKeys,
                                            &LamMeshKeys,   &LamBoundaryKeys, &LamProgramKeys, &LamResponseKeys,
                                            &LamRegionKeys, &LamMapKeys,      &LamProcessKeys, &last};

const LamKey *LamKeyAt(PetscInt i)
{
  for (size_t t = 0; t < PETSC_STATIC_ARRAY_LENGTH(tables); t++) {
    if (i < tables[t]->count) return &tables[t]->key[i];
    i -= tables[t]->count;
  }
  return NULL;
}

const LamKey *LamKeyFind(const char path[])
{
  const LamKey *key;

  for (PetscInt i = 0; (key = LamKeyAt(i)) && strcmp(key->path, path) != 0; i++)
    ;
  return key;
}

const char *LamKeyName(const LamKey *key)
{
  const char *dot = strrchr(key->path, '.');

  return dot ? dot + 1 : key->path;
}

PetscBool LamKeyIsChild(const LamKey *key, const LamKey *map)
{
  const size_t length = strlen(map->path);
  const char *rest = key->path + length;

  if (!key->path[0] || strncmp(key->path, map->path, length)) return PETSC_FALSE;
  if (length && *rest++ != '.') return PETSC_FALSE;
  return strpbrk(rest, ".[") ? PETSC_FALSE : PETSC_TRUE;
}

static const char *BoundWords(const LamBound *bound, PetscBool lower)
{
  if (bound->kind == LAM_BOUND_EXCLUDED) return lower ? "larger than" : "less than";
  return lower ? "at least" : "at most";
}

static PetscBool HasOneValue(const LamKey *key)
{
  return key->lower.kind == LAM_BOUND_INCLUDED && key->upper.kind == LAM_BOUND_INCLUDED &&
                 key->lower.value == key->upper.value
             ? PETSC_TRUE
             : PETSC_FALSE;
}

void LamKeyBoundsText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  const char *space = key->unit ? " " : "", *unit = key->unit ? key->unit : "";
  char lower[80] = "", upper[80] = "";

  if (HasOneValue(key)) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "exactly %g%s%s", (double)key->lower.value, space, unit);
    return;
  }
  if (key->lower.kind != LAM_BOUND_NONE) {
    snprintf(lower, sizeof(lower), "%s %g%s%s", BoundWords(&key->lower, PETSC_TRUE), (double)key->lower.value, space,
             unit);
  }
  if (key->upper.kind != LAM_BOUND_NONE) {
    snprintf(upper, sizeof(upper), "%s %.9g%s%s", BoundWords(&key->upper, PETSC_FALSE), (double)key->upper.value, space,
             unit);
  }
  snprintf(text, LAM_KEY_TEXT_LENGTH, "%s%s%s", lower, lower[0] && upper[0] ? " and " : "", upper);
}

/* "bonded or contact" */
static void NamesText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  size_t used = 0;

  text[0] = '\0';
  for (PetscInt i = 0; i < key->name_count && used < LAM_KEY_TEXT_LENGTH; i++) {
    used += (size_t)snprintf(text + used, LAM_KEY_TEXT_LENGTH - used, "%s%s", i ? " or " : "", key->names[i]);
  }
}

static void SingleText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  static const char *const articles[] = {"a length",      "a stress", "an angle",       "a time",
                                         "a temperature", "a rate",   "a molar energy", "a permeability"};
  const char *what = "a plain number";
  char bounds[LAM_KEY_TEXT_LENGTH], with_unit[80];

  if (key->type == LAM_KEY_NAME) {
    NamesText(key, text);
    return;
  }
  LamKeyBoundsText(key, bounds);
  if (key->unit) {
    snprintf(with_unit, sizeof(with_unit), "%s with its unit", articles[key->dimension]);
    what = with_unit;
  } else if (key->type == LAM_KEY_INTEGER) {
    what = "a whole number";
  } else if (key->type == LAM_KEY_BOOL) {
    what = "true or false";
  } else if (key->type == LAM_KEY_TEXT || key->type == LAM_KEY_PATH) {
    what = "a text";
  }
  snprintf(text, LAM_KEY_TEXT_LENGTH, "%s%s%.200s%s%s", what, bounds[0] ? ", " : "", bounds,
           key->free_word ? ", or " : "", key->free_word ? key->free_word : "");
}

void LamKeyExpectation(const LamKey *key, PetscBool single, char text[LAM_KEY_TEXT_LENGTH])
{
  char one[LAM_KEY_TEXT_LENGTH];

  SingleText(key, one);
  if (HasOneValue(key)) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%s", key->example);
  } else if (key->type == LAM_KEY_MAP) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "keys and values, such as %s", key->example);
  } else if (key->type == LAM_KEY_LIST) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "a list, such as %s", key->example);
  } else if (key->type == LAM_KEY_TENSOR && !single) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "2x2 or 3x3 plain numbers, such as %s", key->example);
  } else if (key->type == LAM_KEY_QUANTITY_TENSOR && !single) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "2x2 or 3x3 values with units, such as %s", key->example);
  } else if (key->size && !single) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "a list of %d, such as %s", (int)key->size, key->example);
  } else if (key->type == LAM_KEY_NAME || key->type == LAM_KEY_BOOL || (key->size && single) ||
             key->type == LAM_KEY_TENSOR || key->type == LAM_KEY_QUANTITY_TENSOR) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%s", one);
  } else {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%.300s, such as %s", one, key->example);
  }
}
