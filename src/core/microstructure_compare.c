/*
  Compares the canonical descriptions of two microstructures, value by value.
*/
#include "microstructure_compare.h"
#include "names.h"
#include <jansson.h>

/* Keys of a scene for the names of a description, where they differ; the rest is `rve.` before the name. What counts in
   a description is a ratio: of lengths to the apothem, of moduli to C1 + C2. */
static const struct {
  const char *name, *key;
  double factor;
} Keys[] = {
    {"wall_thickness", "rve.cell.wall_thickness over apothem", 1},
    {"length", "rve.cell.length over apothem", 1},
    {"orientation", "rve.cell.orientation (deg)", 180 / PETSC_PI},
    {"interface.clearance", "rve.interface.clearance over apothem", 1},
    {"interface.width", "rve.interface.width over apothem", 1},
    {"interface.stiffness", "rve.interface.stiffness over (C1 + C2)/apothem", 1},
    {"interface.strength", "rve.interface.strength over C1 + C2", 1},
    {"interface.fracture_energy", "rve.interface.fracture_energy over (C1 + C2) apothem", 1},
    {"interface.shear_strength", "rve.interface.shear.strength over C1 + C2", 1},
    {"interface.shear_energy", "rve.interface.shear.fracture_energy over (C1 + C2) apothem", 1},
    {"interface.junction_length", "rve.interface.junction.length over apothem", 1},
    {"relaxation", "rve.wall.relaxation", 1},
    {"tearing", "strength.wall_fracture_energy", 1},
    {"tearing.strength", "strength.wall over C1 + C2", 1},
    {"tearing.fracture_energy", "strength.wall_fracture_energy over (C1 + C2) apothem", 1},
    {"tearing.stiffness", "stiffness of cuts over (C1 + C2)/apothem", 1},
    {"cell", "rve.variation", 1},
    {"patch", "rve.patch", 1},
    {"wall.fibre_angle", "rve.wall.fibre_angle (deg)", 180 / PETSC_PI},
    {"wall.bulk_modulus", "rve.wall.bulk_modulus over C1 + C2", 1},
};

enum { NAME_LENGTH = 80, VALUE_LENGTH = 40 };

static void KeyOf(const char name[], char key[NAME_LENGTH], double *factor)
{
  *factor = 1;
  snprintf(key, NAME_LENGTH, "rve.%s", name);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(Keys); k++) {
    if (strcmp(Keys[k].name, name)) continue;
    snprintf(key, NAME_LENGTH, "%s", Keys[k].key);
    *factor = Keys[k].factor;
  }
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++) {
    if (strncmp(name, "wall.", 5) || strcmp(name + 5, LamWallParameterNames[k])) continue;
    if (LamWallParameterIsModulus(k)) snprintf(key, NAME_LENGTH, "rve.%s over C1 + C2", name);
  }
}

static void ArrayText(const json_t *array, char text[VALUE_LENGTH])
{
  char one[VALUE_LENGTH];

  snprintf(text, VALUE_LENGTH, "[");
  for (size_t i = 0; i < json_array_size(array); i++) {
    snprintf(one, sizeof(one), "%s%.6g", i ? ", " : "", json_number_value(json_array_get(array, i)));
    strncat(text, one, VALUE_LENGTH - 1 - strlen(text));
  }
  strncat(text, "]", VALUE_LENGTH - 1 - strlen(text));
}

static void ValueText(const json_t *value, double factor, char text[VALUE_LENGTH])
{
  if (json_is_number(value))
    snprintf(text, VALUE_LENGTH, "%.6g", factor * json_number_value(value));
  else if (json_is_string(value))
    snprintf(text, VALUE_LENGTH, "%s", json_string_value(value));
  else if (json_is_number(json_array_get(value, 0)))
    ArrayText(value, text);
  else
    snprintf(text, VALUE_LENGTH, value ? "another" : "not given");
}

/* A list of differences. */
typedef struct {
  const char *where; /* of the second values */
  char *text;        /* LAM_DIFFERENCE_LENGTH */
} List;

/* Appends one difference; what no longer fits is left out. */
static void Append(const List *list, const char name[], const json_t *one, const json_t *other)
{
  char key[NAME_LENGTH], values[2][VALUE_LENGTH], words[2 * NAME_LENGTH + 2 * VALUE_LENGTH + 20];
  double factor;

  KeyOf(name, key, &factor);
  ValueText(one, factor, values[0]);
  ValueText(other, factor, values[1]);
  snprintf(words, sizeof(words), "%s is %s, in %.*s %s", key, values[0], NAME_LENGTH, list->where, values[1]);
  if (strlen(list->text) + strlen(words) + 3 < LAM_DIFFERENCE_LENGTH)
    LamNamesAppend(LAM_DIFFERENCE_LENGTH, list->text, "; ", words);
}

static void Compare(const List *list, const char name[], json_t *one, json_t *other)
{
  char inner[NAME_LENGTH];
  const char *key;
  json_t *value;

  if (json_equal(one, other)) return;
  if (!json_is_object(one) || !json_is_object(other)) {
    Append(list, name, one, other);
    return;
  }
  json_object_foreach(one, key, value)
  {
    snprintf(inner, sizeof(inner), "%s%s%s", name, name[0] ? "." : "", key);
    Compare(list, inner, value, json_object_get(other, key));
  }
  json_object_foreach(other, key, value)
  {
    snprintf(inner, sizeof(inner), "%s%s%s", name, name[0] ? "." : "", key);
    if (!json_object_get(one, key)) Compare(list, inner, NULL, value);
  }
}

PetscErrorCode LamMicrostructureCompare(const LamMicrostructure *one, const LamMicrostructure *other,
                                        const char where[], char text[LAM_DIFFERENCE_LENGTH])
{
  const LamMicrostructure *micro[2] = {one, other};
  const List list = {where, text};
  char *json, hash[LAM_HASH_LENGTH];
  json_t *root[2];

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) {
    PetscCall(LamMicrostructureDescribe(micro[i], &json, hash));
    root[i] = json_loads(json, 0, NULL);
    PetscCall(PetscFree(json));
  }
  text[0] = '\0';
  Compare(&list, "", root[0], root[1]);
  for (int i = 0; i < 2; i++) json_decref(root[i]);
  PetscFunctionReturn(0);
}
