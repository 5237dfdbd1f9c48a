/*
  Conversion of numbers and text to JSON.
*/
#include "json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *LamJSONReal(PetscReal value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

json_t *LamJSONReals(PetscInt n, const PetscReal values[], PetscReal scale)
{
  json_t *list = json_array();

  for (PetscInt i = 0; i < n; i++) json_array_append_new(list, LamJSONReal(values[i] * scale));
  return list;
}

json_t *LamJSONText(const char text[])
{
  json_t *string = json_string(text);
  char *copy = string ? NULL : strdup(text);

  if (!copy) return string;
  for (char *c = copy; *c; c++)
    if (*c & 0x80) *c = '?';
  string = json_string(copy);
  free(copy);
  return string;
}
