#include "tissue_file.h"
#include <jansson.h>
#include <math.h>
#include <string.h>
#include "polygons.h"
#include "quantity_text.h"

#define MUST(condition, ...) PetscCheck(condition, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, __VA_ARGS__)

typedef struct {
  const char *path;
  json_t *root;
  PetscReal unit; /* of lengths, m */
  LamPolygons polygons;
  PetscInt faces, *first, *corner, *face_class;
  PetscReal (*vertex)[2], *setback, *share;
  LamTissueFile *file;
} Reader;

static PetscErrorCode ListOf(const Reader *r, const char key[], json_t **list)
{
  PetscFunctionBeginUser;
  *list = json_object_get(r->root, key);
  MUST(json_is_array(*list) && json_array_size(*list) > 0, "%s: %s: %s; it is a list", r->path, key,
       *list ? "is no list, or an empty one" : "missing");
  PetscFunctionReturn(0);
}

/* A length of an item of a list, or of the value itself (item -1). */
static PetscErrorCode LengthOf(const Reader *r, const json_t *value, const char key[], PetscInt item, PetscReal least,
                               PetscReal *length)
{
  char place[32] = "";

  PetscFunctionBeginUser;
  if (item >= 0) (void)snprintf(place, sizeof(place), "[%d]", (int)item);
  MUST(json_is_number(value) && isfinite(json_number_value(value)) && json_number_value(value) >= least,
       "%s: %s%s: is no number%s; write one, in the unit of the file", r->path, key, place,
       least == 0.0 ? " from 0 on" : "");
  *length = json_number_value(value) * r->unit;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadHead(Reader *r)
{
  static const char *const keys[] = {"lamella_tissue", "unit",  "period",  "wall_thickness", "corner_radius",
                                     "vertices",       "cells", "classes", "face_classes",   "made_by"};
  const json_t *version, *unit;
  char reason[LAM_REASON_LENGTH], text[64];
  const char *key;
  json_t *value;

  PetscFunctionBeginUser;
  version = json_object_get(r->root, "lamella_tissue");
  unit = json_object_get(r->root, "unit");
  MUST(json_is_integer(version) && json_integer_value(version) == 1,
       "%s: is no tissue file that this version knows: it has no lamella_tissue: 1", r->path);
  MUST(json_is_string(unit) && strlen(json_string_value(unit)) < 40,
       "%s: unit: missing; write one of lengths, such as "
       "\"um\"",
       r->path);
  (void)snprintf(text, sizeof(text), "1 %s", json_string_value(unit));
  PetscCall(LamQuantityRead(text, LAM_DIMENSION_LENGTH, &r->unit, reason));
  MUST(!reason[0] && r->unit > 0.0, "%s: unit: %s: %s", r->path, json_string_value(unit), reason);
  json_object_foreach(r->root, key, value)
  {
    PetscBool known = PETSC_FALSE;

    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(keys); k++) known |= !strcmp(key, keys[k]);
    MUST(known, "%s: %.60s: unknown; remarks belong in made_by", r->path, key);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadPair(const Reader *r, const json_t *pair, const char key[], PetscInt item, PetscReal x[2])
{
  PetscFunctionBeginUser;
  MUST(json_is_array(pair) && json_array_size(pair) == 2, "%s: %s[%d]: is no pair [x, y]", r->path, key, (int)item);
  for (size_t d = 0; d < 2; d++) PetscCall(LengthOf(r, json_array_get(pair, d), key, item, -INFINITY, &x[d]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadPeriod(Reader *r)
{
  const json_t *period = json_object_get(r->root, "period");

  PetscFunctionBeginUser;
  r->polygons.is_patch = r->file->is_patch = (PetscBool)(period == NULL);
  if (!period) PetscFunctionReturn(0);
  MUST(json_is_array(period) && json_array_size(period) == 2, "%s: period: is no list of two vectors", r->path);
  for (size_t k = 0; k < 2; k++)
    PetscCall(ReadPair(r, json_array_get(period, k), "period", (PetscInt)k, r->polygons.period[k]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadVertices(Reader *r)
{
  json_t *list;

  PetscFunctionBeginUser;
  PetscCall(ListOf(r, "vertices", &list));
  r->polygons.vertices = (PetscInt)json_array_size(list);
  PetscCall(PetscMalloc1(r->polygons.vertices, &r->vertex));
  for (PetscInt v = 0; v < r->polygons.vertices; v++)
    PetscCall(ReadPair(r, json_array_get(list, (size_t)v), "vertices", v, r->vertex[v]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadCells(Reader *r)
{
  json_t *list;
  PetscInt k = 0;

  PetscFunctionBeginUser;
  PetscCall(ListOf(r, "cells", &list));
  r->polygons.cells = (PetscInt)json_array_size(list);
  PetscCall(PetscMalloc1(r->polygons.cells + 1, &r->first));
  r->first[0] = 0;
  for (PetscInt c = 0; c < r->polygons.cells; c++) {
    const json_t *cell = json_array_get(list, (size_t)c);

    MUST(json_is_array(cell), "%s: cells[%d]: is no list of vertices", r->path, (int)c);
    r->first[c + 1] = r->first[c] + (PetscInt)json_array_size(cell);
  }
  r->faces = r->first[r->polygons.cells];
  PetscCall(PetscMalloc1(r->faces, &r->corner));
  for (PetscInt c = 0; c < r->polygons.cells; c++) {
    const json_t *cell = json_array_get(list, (size_t)c);

    for (size_t i = 0; i < json_array_size(cell); i++) {
      const json_t *vertex = json_array_get(cell, i);

      MUST(json_is_integer(vertex), "%s: cells[%d]: has an entry that is no number of a vertex", r->path, (int)c);
      r->corner[k++] = (PetscInt)PetscMax(-1, PetscMin(json_integer_value(vertex), PETSC_MAX_INT));
    }
  }
  PetscFunctionReturn(0);
}

/* A value for all, or a list of `count`; the caller reads item k of it by ItemOf. */
static PetscErrorCode CheckCount(const Reader *r, const json_t *value, const char key[], PetscInt count,
                                 const char things[])
{
  PetscFunctionBeginUser;
  MUST(!json_is_array(value) || json_array_size(value) == (size_t)count, "%s: %s: has %d entries for %d %s", r->path,
       key, (int)json_array_size(value), (int)count, things);
  PetscFunctionReturn(0);
}

static const json_t *ItemOf(const json_t *value, PetscInt k)
{
  return json_is_array(value) ? json_array_get(value, (size_t)k) : value;
}

/* Walls leave the edges of a vertex where the arc of a corner of 120 degrees would. */
static PetscErrorCode ReadRadii(Reader *r)
{
  const json_t *value = json_object_get(r->root, "corner_radius");

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(r->polygons.vertices, &r->setback));
  if (!value) PetscFunctionReturn(0);
  PetscCall(CheckCount(r, value, "corner_radius", r->polygons.vertices, "vertices"));
  for (PetscInt v = 0; v < r->polygons.vertices; v++) {
    PetscReal radius;

    PetscCall(LengthOf(r, ItemOf(value, v), "corner_radius", json_is_array(value) ? v : -1, 0.0, &radius));
    r->setback[v] = radius / sqrt(3.0);
  }
  PetscFunctionReturn(0);
}

/* The thickness of the walls of a cell: their mean, and the share of each face. */
static PetscErrorCode ReadWalls(Reader *r, const json_t *value, PetscInt cell)
{
  const PetscInt first = r->first[cell], n = r->first[cell + 1] - first, item = json_is_array(value) ? cell : -1;
  const json_t *own = ItemOf(value, cell);
  PetscReal sum = 0.0;

  PetscFunctionBeginUser;
  PetscCall(CheckCount(r, own, "wall_thickness", n, "faces of a cell"));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(LengthOf(r, ItemOf(own, k), "wall_thickness", item, 0.0, &r->share[first + k]));
    MUST(r->share[first + k] > 0.0, "%s: wall_thickness: 0 in cells[%d]; walls have a thickness", r->path, (int)cell);
    sum += r->share[first + k] / (PetscReal)n;
  }
  for (PetscInt k = 0; k < n; k++) r->share[first + k] /= sum;
  r->file->thickness[cell] = sum;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadThickness(Reader *r)
{
  const json_t *value = json_object_get(r->root, "wall_thickness");

  PetscFunctionBeginUser;
  if (!value) PetscFunctionReturn(0);
  PetscCall(CheckCount(r, value, "wall_thickness", r->polygons.cells, "cells"));
  PetscCall(PetscMalloc1(r->faces, &r->share));
  PetscCall(PetscMalloc1(r->polygons.cells, &r->file->thickness));
  for (PetscInt c = 0; c < r->polygons.cells; c++) PetscCall(ReadWalls(r, value, c));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadClasses(Reader *r)
{
  const json_t *cells = json_object_get(r->root, "classes"), *faces = json_object_get(r->root, "face_classes");

  PetscFunctionBeginUser;
  if (cells) {
    MUST(json_is_array(cells), "%s: classes: is no list", r->path);
    PetscCall(CheckCount(r, cells, "classes", r->polygons.cells, "cells"));
    PetscCall(PetscMalloc1(r->polygons.cells, &r->file->class));
  }
  for (PetscInt c = 0; c < r->polygons.cells && cells; c++) {
    const json_t *class = json_array_get(cells, (size_t)c);

    MUST(json_is_integer(class) && json_integer_value(class) >= 0 && json_integer_value(class) < PETSC_MAX_INT,
         "%s: classes[%d]: is no number from 0 on", r->path, (int)c);
    r->file->class[c] = (PetscInt)json_integer_value(class);
  }
  if (!faces) PetscFunctionReturn(0);
  MUST(json_is_array(faces), "%s: face_classes: is no list", r->path);
  PetscCall(CheckCount(r, faces, "face_classes", r->polygons.cells, "cells"));
  PetscCall(PetscMalloc1(r->faces, &r->face_class));
  for (PetscInt c = 0; c < r->polygons.cells; c++) {
    const json_t *own = json_array_get(faces, (size_t)c);

    MUST(json_is_array(own), "%s: face_classes[%d]: is no list", r->path, (int)c);
    PetscCall(CheckCount(r, own, "face_classes", r->first[c + 1] - r->first[c], "faces of a cell"));
    for (PetscInt k = r->first[c]; k < r->first[c + 1]; k++) {
      const json_t *class = json_array_get(own, (size_t)(k - r->first[c]));

      MUST(json_is_integer(class) && json_integer_value(class) >= 0 && json_integer_value(class) <= 2,
           "%s: face_classes[%d]: has an entry that is not 0, 1 or 2", r->path, (int)c);
      r->face_class[k] = (PetscInt)json_integer_value(class);
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadAll(Reader *r)
{
  PetscFunctionBeginUser;
  MUST(json_is_object(r->root), "%s: is no tissue file, a map with the key lamella_tissue", r->path);
  PetscCall(ReadHead(r));
  PetscCall(ReadPeriod(r));
  PetscCall(ReadVertices(r));
  PetscCall(ReadCells(r));
  PetscCall(ReadRadii(r));
  PetscCall(ReadThickness(r));
  PetscCall(ReadClasses(r));
  r->polygons.vertex = r->vertex;
  r->polygons.first = r->first;
  r->polygons.corner = r->corner;
  r->polygons.setback = r->setback;
  r->polygons.share = r->share;
  r->polygons.face_class = r->face_class;
  PetscCall(LamTissueFromPolygons(&r->polygons, &r->file->apothem, &r->file->tissue));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTissueFileDestroy(LamTissueFile *file)
{
  PetscFunctionBeginUser;
  PetscCall(LamTissueDestroy(&file->tissue));
  PetscCall(PetscFree(file->thickness));
  PetscCall(PetscFree(file->class));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTissueFileRead(const char path[], LamPatchSides sides, PetscReal orientation, LamTissueFile *file)
{
  Reader r = {.path = path, .file = file, .polygons = {.name = path, .sides = sides, .orientation = orientation}};
  json_error_t error;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  (void)PetscMemzero(file, sizeof(*file));
  r.root = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
  MUST(r.root || error.line > 0, "%s: the tissue cannot be read: %s", path, error.text);
  MUST(r.root, "%s:%d:%d: is no JSON: %s", path, error.line, error.column, error.text);
  ierr = ReadAll(&r);
  json_decref(r.root);
  PetscCall(PetscFree(r.vertex));
  PetscCall(PetscFree(r.first));
  PetscCall(PetscFree(r.corner));
  PetscCall(PetscFree(r.setback));
  PetscCall(PetscFree(r.share));
  PetscCall(PetscFree(r.face_class));
  if (ierr) PetscCall(LamTissueFileDestroy(file));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
