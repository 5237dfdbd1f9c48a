/*
  Stores document nodes in struct members, nondimensional.
*/
#include "scene_keys.h"
#include <math.h>
#include <string.h>

/* in SI; within these limits nothing over- or underflows, such as work, a stress times an area */
#define LARGEST_SCALE 1e100

/* Larger ratios to the apothem and to C1 + C2 leave no significant digits for the walls in double precision. */
#define LARGEST_RATIO 1e9

PetscErrorCode LamSceneScale(const LamNode *node, PetscReal si, PetscReal scale, PetscReal *number)
{
  PetscFunctionBeginUser;
  *number = si / scale;
  LamSceneCheck(!node || fabs(*number) <= LARGEST_RATIO, node,
                "is beyond all measure against the cell's apothem or C1 + C2; check units");
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneCheckScale(const LamNode *node, PetscReal si)
{
  PetscFunctionBeginUser;
  LamSceneCheck(si >= 1.0 / LARGEST_SCALE && si <= LARGEST_SCALE, node,
                "is %g in SI units, beyond %g to %g, all that is reckoned with; check units", (double)si,
                1.0 / LARGEST_SCALE, LARGEST_SCALE);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneResolvePath(const LamNode *node, char path[PETSC_MAX_PATH_LEN])
{
  const char *name = node->document->name, *slash = strrchr(name, '/');
  const int folder = node->text[0] == '/' || !slash ? 0 : (int)(slash - name) + 1;

  PetscFunctionBeginUser;
  LamSceneCheck(folder + strlen(node->text) < PETSC_MAX_PATH_LEN, node, "the path is too long");
  snprintf(path, PETSC_MAX_PATH_LEN, "%.*s%s", folder, name, node->text);
  PetscFunctionReturn(0);
}

/* Reads a default from the table as if it were in a file. */
static PetscErrorCode ReadDefault(const LamKey *key, LamValue *value)
{
  LamDocument document;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = LamDocumentParse(key->path, key->default_value, &document);
  if (!ierr) ierr = LamSceneReadNode(document.root, key);
  if (!ierr) *value = document.root->value;
  PetscCall(LamDocumentDestroy(&document));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* A component in the struct's units: um in apothems, mm in macro lengths, stresses in C1 + C2, what is made of these
   likewise, the rest in SI. */
static PetscErrorCode StoreReal(const LamNode *node, const LamKey *key, const LamScales *scales, PetscReal si,
                                PetscReal *number)
{
  PetscFunctionBeginUser;
  *number = si;
  if (!key->unit) PetscFunctionReturn(0);
  if (key->dimension == LAM_DIMENSION_STRESS) PetscCall(LamSceneScale(node, si, scales->stress, number));
  if (key->dimension == LAM_DIMENSION_LENGTH)
    PetscCall(LamSceneScale(node, si, strcmp(key->unit, "mm") ? scales->length : scales->macro_length, number));
  if (key->dimension == LAM_DIMENSION_PERMEABILITY)
    PetscCall(LamSceneScale(node, si * scales->stress, scales->length, number));
  if (key->dimension == LAM_DIMENSION_CONDUCTIVITY)
    PetscCall(LamSceneScale(node, si * scales->stress, PetscSqr(scales->macro_length), number));
  if (key->dimension == LAM_DIMENSION_AREAL_ENERGY)
    PetscCall(LamSceneScale(node, si, scales->stress * scales->length, number));
  if (key->dimension == LAM_DIMENSION_STIFFNESS)
    PetscCall(LamSceneScale(node, si * scales->length, scales->stress, number));
  PetscFunctionReturn(0);
}

static PetscErrorCode StoreText(const LamNode *node, const LamKey *key, char text[])
{
  PetscFunctionBeginUser;
  LamSceneCheck(strlen(node->text) < key->room, node, "is too long; names have less than %d letters", (int)key->room);
  if (key->type == LAM_KEY_PATH)
    PetscCall(LamSceneResolvePath(node, text));
  else
    PetscCall(PetscStrncpy(text, node->text, key->room));
  PetscFunctionReturn(0);
}

static PetscErrorCode Store(const LamNode *node, const LamKey *key, const LamValue *value, const LamScales *scales,
                            char *target)
{
  const PetscBool is_enum =
      (PetscBool)(key->type == LAM_KEY_NAME || key->type == LAM_KEY_BOOL); /* a PetscBool is one */
  const size_t size = is_enum ? sizeof(int) : key->type == LAM_KEY_INTEGER ? sizeof(PetscInt) : sizeof(PetscReal);
  void *place = target + key->offset;

  PetscFunctionBeginUser;
  if (key->type == LAM_KEY_TEXT || key->type == LAM_KEY_PATH) {
    PetscCall(StoreText(node, key, place));
    PetscFunctionReturn(0);
  }
  PetscCheck(key->room == (size_t)value->count * size, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%s does not fit its member",
             key->path);
  for (PetscInt c = 0; c < value->count; c++) {
    if (is_enum)
      ((int *)place)[c] = (int)value->number[c];
    else if (key->type == LAM_KEY_INTEGER)
      ((PetscInt *)place)[c] = (PetscInt)value->number[c];
    else
      PetscCall(StoreReal(node, key, scales, value->number[c], (PetscReal *)place + c));
    if (key->given) ((PetscBool *)(target + key->given))[c] = (PetscBool)!value->is_free[c];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneGet(const LamNode *base, const char path[], const LamNode **node, LamValue *value)
{
  const size_t skip = strlen(base->key->path);
  const LamKey *key = LamKeyFind(path);

  PetscFunctionBeginUser;
  *value = (LamValue){0};
  *node = LamNodeFind(base, path + skip + (skip ? 1 : 0));
  if (*node)
    *value = (*node)->value;
  else if (key->default_value)
    PetscCall(ReadDefault(key, value));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneFillRecord(const LamNode *base, const LamScales *scales, const char record[], void *target)
{
  const char *path = base->key->path;
  const LamKey *key;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; (key = LamKeyAt(i)); i++) {
    const LamNode *node;
    LamValue value;

    if (!key->record || strcmp(key->record, record) || strncmp(key->path, path, strlen(path))) continue;
    PetscCall(LamSceneGet(base, key->path, &node, &value));
    if (value.count) PetscCall(Store(node, key, &value, scales, target));
  }
  PetscFunctionReturn(0);
}
