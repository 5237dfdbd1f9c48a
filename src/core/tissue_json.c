#include "tissue_json.h"
#include <math.h>

static void WriteIntegers(const char key[], PetscInt n, const PetscInt values[], FILE *out)
{
  fprintf(out, ", \"%s\": [", key);
  for (PetscInt k = 0; k < n; k++) fprintf(out, "%s%d", k ? "," : "", (int)values[k]);
  fprintf(out, "]");
}

static void WriteReals(const char key[], PetscInt n, const PetscReal values[], FILE *out)
{
  fprintf(out, ", \"%s\": [", key);
  for (PetscInt k = 0; k < n; k++)
    fprintf(out, "%s%.12g", k ? "," : "", fabs(values[k]) < 1e-13 ? 0.0 : (double)values[k]);
  fprintf(out, "]");
}

void LamTissueDescribe(LamTissue t, FILE *out)
{
  PetscInt held = 0;

  fprintf(out, "{\"area\": %.12g", (double)t->area);
  WriteReals("period", 4, t->period[0], out);
  WriteIntegers("first", t->cells + 1, t->first, out);
  WriteReals("corner", 2 * t->faces, t->corner[0], out);
  WriteIntegers("partner", t->faces, t->partner, out);
  WriteIntegers("wraps", 2 * t->faces, t->wraps[0], out);
  WriteIntegers("direction", t->faces, t->direction, out);
  WriteReals("share", t->faces, t->share, out);
  WriteReals("setback", t->faces, t->setback, out);
  fprintf(out, ", \"held\": [");
  for (PetscInt k = 0; k < t->faces; k++)
    if (t->held[k]) fprintf(out, "%s%d", held++ ? "," : "", (int)k);
  fprintf(out, "]}");
}

static PetscBool ReadIntegers(const json_t *object, const char key[], PetscInt n, PetscInt least, PetscInt most,
                              PetscInt values[])
{
  const json_t *list = json_object_get(object, key);

  if (!json_is_array(list) || json_array_size(list) != (size_t)n) return PETSC_FALSE;
  for (PetscInt k = 0; k < n; k++) {
    const json_int_t value = json_integer_value(json_array_get(list, (size_t)k));

    if (value < least || value > most) return PETSC_FALSE;
    values[k] = (PetscInt)value;
  }
  return PETSC_TRUE;
}

static PetscBool ReadReals(const json_t *object, const char key[], PetscInt n, PetscReal values[])
{
  const json_t *list = json_object_get(object, key);

  if (!json_is_array(list) || json_array_size(list) != (size_t)n) return PETSC_FALSE;
  for (PetscInt k = 0; k < n; k++) {
    values[k] = json_number_value(json_array_get(list, (size_t)k));
    if (!isfinite(values[k])) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool ReadHeld(const json_t *object, LamTissue t)
{
  const json_t *list = json_object_get(object, "held");

  if (!json_is_array(list)) return PETSC_FALSE;
  for (size_t k = 0; k < json_array_size(list); k++) {
    const json_int_t face = json_integer_value(json_array_get(list, k));

    if (face < 0 || face >= t->faces) return PETSC_FALSE;
    t->held[face] = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

/* Faces of cells, after their first ones; PETSC_FALSE: a partner is not that of its partner. */
static PetscBool Connect(LamTissue t)
{
  if (t->first[0] != 0 || t->first[t->cells] != t->faces) return PETSC_FALSE;
  for (PetscInt c = 0; c < t->cells; c++) {
    if (t->first[c + 1] < t->first[c] + 3) return PETSC_FALSE;
    for (PetscInt k = t->first[c]; k < t->first[c + 1]; k++) t->cell[k] = c;
  }
  for (PetscInt k = 0; k < t->faces; k++)
    if (t->partner[k] >= 0 && t->partner[t->partner[k]] != k) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscBool LamTissueParse(const json_t *object, LamTissue *out)
{
  const size_t cells = json_array_size(json_object_get(object, "first"));
  const size_t faces = json_array_size(json_object_get(object, "partner"));
  const PetscInt n = (PetscInt)faces;
  LamTissue t;

  *out = NULL;
  if (cells < 2 || faces < 3 || faces > PETSC_MAX_INT / 16 || LamTissueAllocate((PetscInt)cells - 1, n, &t))
    return PETSC_FALSE;
  t->area = json_number_value(json_object_get(object, "area"));
  if (t->area > 0.0 && ReadReals(object, "period", 4, t->period[0]) &&
      ReadIntegers(object, "first", t->cells + 1, 0, n, t->first) && ReadReals(object, "corner", 2 * n, t->corner[0]) &&
      ReadIntegers(object, "partner", n, -1, n - 1, t->partner) &&
      ReadIntegers(object, "wraps", 2 * n, -n, n, t->wraps[0]) &&
      ReadIntegers(object, "direction", n, 0, LAM_DIRECTIONS - 1, t->direction) &&
      ReadReals(object, "share", n, t->share) && ReadReals(object, "setback", n, t->setback) && ReadHeld(object, t) &&
      Connect(t)) {
    *out = t;
    return PETSC_TRUE;
  }
  (void)LamTissueDestroy(&t);
  return PETSC_FALSE;
}
