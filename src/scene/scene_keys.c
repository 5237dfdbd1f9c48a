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

static const LamKeyTable *const tables[] = {&first,
                                            &LamCellKeys,
                                            &LamWallKeys,
                                            &LamVariationKeys,
                                            &LamInterfaceKeys,
                                            &LamLamellaKeys,
                                            &LamTissueKeys,
                                            &LamStrengthKeys,
                                            &LamLoadKeys,
                                            &LamSampleKeys,
                                            &LamMeshKeys,
                                            &LamBoundaryKeys,
                                            &LamProgramKeys,
                                            &LamResponseKeys,
                                            &LamRegionKeys,
                                            &LamMapKeys,
                                            &LamProcessKeys,
                                            &LamTransportKeys,
                                            &LamUncertainKeys,
                                            &last};

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

const char *LamBoundWords(const LamBound *bound, PetscBool lower)
{
  if (bound->kind == LAM_BOUND_EXCLUDED) return lower ? "larger than" : "less than";
  return lower ? "at least" : "at most";
}

PetscBool LamBoundsHold(const LamBound *lower, const LamBound *upper, PetscReal number)
{
  return (PetscBool)(!(lower->kind == LAM_BOUND_INCLUDED && number < lower->value) &&
                     !(lower->kind == LAM_BOUND_EXCLUDED && number <= lower->value) &&
                     !(upper->kind == LAM_BOUND_INCLUDED && number > upper->value) &&
                     !(upper->kind == LAM_BOUND_EXCLUDED && number >= upper->value));
}

static PetscBool HasOneValue(const LamKey *key)
{
  return (PetscBool)(key->lower.kind == LAM_BOUND_INCLUDED && key->upper.kind == LAM_BOUND_INCLUDED &&
                     key->lower.value == key->upper.value);
}

void LamKeyBoundsText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  const char *space = key->unit ? " " : "", *unit = key->unit ? key->unit : "";
  int used = 0;

  text[0] = '\0';
  if (HasOneValue(key)) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "exactly %g%s%s", (double)key->lower.value, space, unit);
    return;
  }
  if (key->lower.kind != LAM_BOUND_NONE)
    used = snprintf(text, LAM_KEY_TEXT_LENGTH, "%s %g%s%s", LamBoundWords(&key->lower, PETSC_TRUE),
                    (double)key->lower.value, space, unit);
  if (key->upper.kind != LAM_BOUND_NONE)
    snprintf(text + used, (size_t)(LAM_KEY_TEXT_LENGTH - used), "%s%s %.9g%s%s", used ? " and " : "",
             LamBoundWords(&key->upper, PETSC_FALSE), (double)key->upper.value, space, unit);
}

#define TYPE_PHRASE(type, word, phrase) phrase,

/* Expected text of one component: "bonded or contact", "a stress with its unit, larger than 0 MPa". */
static void SingleText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  static const char *const articles[] = {"a length",           "a stress",
                                         "an angle",           "a time",
                                         "a temperature",      "a rate",
                                         "a molar energy",     "a permeability",
                                         "an energy per area", "a stress per length",
                                         "a conductivity"};
  static const char *const phrases[] = {LAM_KEY_TYPES(TYPE_PHRASE)};
  const char *what = key->unit ? articles[key->dimension] : phrases[key->type];
  char bounds[LAM_KEY_TEXT_LENGTH];
  int used = 0;

  for (PetscInt i = 0; i < key->name_count && used < LAM_KEY_TEXT_LENGTH; i++)
    used += snprintf(text + used, (size_t)(LAM_KEY_TEXT_LENGTH - used), "%s%s", i ? " or " : "", key->names[i]);
  if (key->type == LAM_KEY_NAME) return;
  LamKeyBoundsText(key, bounds);
  snprintf(text, LAM_KEY_TEXT_LENGTH, "%s%s%s%.200s%s%s", what, key->unit ? " with its unit" : "",
           bounds[0] ? ", " : "", bounds, key->free_word ? ", or " : "", key->free_word ? key->free_word : "");
}

void LamKeyExpectation(const LamKey *key, PetscBool single, char text[LAM_KEY_TEXT_LENGTH])
{
  const PetscBool tensor = (PetscBool)(key->type == LAM_KEY_TENSOR || key->type == LAM_KEY_QUANTITY_TENSOR);
  char what[LAM_KEY_TEXT_LENGTH];

  SingleText(key, what);
  if (tensor && !single) {
    snprintf(what, sizeof(what), "2x2 or 3x3 %s", key->unit ? "values with units" : "plain numbers");
  } else if (key->size && !single) {
    snprintf(what, sizeof(what), "a list of %d", (int)key->size);
  } else if (key->type == LAM_KEY_NAME || key->type == LAM_KEY_BOOL || key->size || tensor) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%s", what); /* sufficient, or the example is of the whole value */
    return;
  }
  if (HasOneValue(key))
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%s", key->example);
  else
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%.300s, such as %s", what, key->example);
}
