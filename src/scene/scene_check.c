/*
  Validates a scene document against the table of keys and reads its values.
*/
#include "scene_keys.h"
#include "quantity_text.h"
#include "word_distance.h"
#include <math.h>
#include <string.h>

enum { PATH_LENGTH = 80 };

/* The most likely intended key for an unknown one in `map`: a similar key there, otherwise one of this name
   elsewhere. */
static const LamKey *NearestKey(const LamKey *map, const char name[])
{
  PetscInt best = (PetscInt)strlen(name) / 3 + 1;
  const LamKey *nearest = NULL, *key;

  for (PetscInt i = 0; (key = LamKeyAt(i)); i++) {
    PetscInt distance;
    if (!LamKeyIsChild(key, map)) continue;
    distance = LamWordDistance(name, LamKeyName(key));
    if (distance <= best && distance < (PetscInt)strlen(name)) {
      if (!nearest || distance < best) nearest = key;
      best = distance;
    }
  }
  for (PetscInt i = 0; !nearest && (key = LamKeyAt(i)); i++) {
    if (!strcmp(LamKeyName(key), name)) nearest = key;
  }
  return nearest;
}

static PetscErrorCode FailUnknown(const LamNode *node, const LamKey *map)
{
  const LamKey *nearest = NearestKey(map, node->name), *key;
  char meant[PATH_LENGTH + 20] = "", known[LAM_KEY_TEXT_LENGTH] = "";
  size_t used = 0;

  PetscFunctionBeginUser;
  if (nearest) {
    snprintf(meant, sizeof(meant), "did you mean %s? ",
             LamKeyIsChild(nearest, map) ? LamKeyName(nearest) : nearest->path);
  }
  for (PetscInt i = 0; used < sizeof(known) && (key = LamKeyAt(i)); i++) {
    if (!LamKeyIsChild(key, map)) continue;
    used += (size_t)snprintf(known + used, sizeof(known) - used, "%s%s", used ? ", " : "", LamKeyName(key));
  }
  if (!strcmp(node->name, "lamella_tissue"))
    PetscCall(
        LamSceneRaise(node, LAM_MISTAKE_NAME, NULL,
                      "this is a tissue file, not a scene; write a scene with rve: {tissue: FILE} that names it"));
  PetscCall(LamSceneRaise(node, LAM_MISTAKE_NAME, NULL, "%s; %sknown here: %s",
                          node->is_null && strchr("0123456789.-", node->name[0])
                              ? "is a value without a key; write its key and a colon before it"
                              : "unknown key",
                          meant, known));
  PetscFunctionReturn(0);
}

/* True if the next entry of a list or map in brackets follows a plain number without a blank behind the comma. */
static PetscBool GoesOn(const LamNode *node)
{
  const LamNode *next = node->next;
  const char *end, *rest;

  if (node->kind != LAM_NODE_SCALAR || !next || (next->name ? !next->is_null : next->kind != LAM_NODE_SCALAR))
    return PETSC_FALSE;
  rest = next->name ? next->name : next->text;
  (void)LamNumberScan(node->text, &end);
  return (PetscBool)(end > node->text && !*end && rest[0] >= '0' && rest[0] <= '9' &&
                     (next->name ? next->name_line : next->line) == node->line &&
                     (next->name ? next->name_column : next->column) == node->column + (int)(end - node->text) + 1);
}

/* True if a decimal comma has split a number in brackets. Of a list this is a guess, made only where other commas have
   a blank behind them. */
static PetscBool IsSplitByComma(const LamNode *node)
{
  PetscBool blanks = PETSC_FALSE;

  if (!node->index) return GoesOn(node);
  for (const LamNode *item = node->parent->first; item->next; item = item->next)
    if (!GoesOn(item)) blanks = PETSC_TRUE;
  return (PetscBool)(blanks && GoesOn(node));
}

/* The reason for a list of the wrong length, unless a comma has split an entry. */
static const char *LengthReason(const LamNode *list, const char reason[])
{
  for (const LamNode *row = list->first; row; row = row->next) {
    if (IsSplitByComma(row)) return LAM_DECIMAL_COMMA;
    for (const LamNode *item = row->first; item; item = item->next)
      if (IsSplitByComma(item)) return LAM_DECIMAL_COMMA;
  }
  return reason;
}

/* Raises "<reason>; write <expectation>". */
static PetscErrorCode FailValue(const LamNode *node, const LamKey *key, PetscBool single, const char reason[])
{
  char expected[LAM_KEY_TEXT_LENGTH];

  PetscFunctionBeginUser;
  LamKeyExpectation(key, single, expected);
  PetscCall(LamSceneRaise(node, LAM_MISTAKE_VALUE, NULL, "%s; write %s",
                          IsSplitByComma(node) ? LAM_DECIMAL_COMMA : reason, expected));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckKind(const LamNode *node, const LamKey *key, PetscBool single, LamNodeKind kind)
{
  static const char *const kinds[] = {"a single value", "a map", "a list"};
  char reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  if (node->is_null) PetscCall(FailValue(node, key, single, "has no value"));
  snprintf(reason, sizeof(reason), "is %s where %s belongs", kinds[node->kind], kinds[kind]);
  if (node->kind != kind) PetscCall(FailValue(node, key, single, reason));
  PetscFunctionReturn(0);
}

/* Scans a number without a unit; returns the reason if it is not one. */
static const char *ScanPlain(const char text[], LamKeyType type, PetscReal *number)
{
  const char *end;

  *number = LamNumberScan(text, &end);
  if (LamTextIsNonFinite(text)) return "is not a finite number";
  if (end == text) return "is not a number";
  if (LamTextHasDecimalComma(end)) return LAM_DECIMAL_COMMA;
  if (*end) return "is not a plain number";
  if (!isfinite(*number)) return "is too large";
  return type == LAM_KEY_INTEGER && strspn(text, "+-0123456789") != strlen(text) ? "is not a whole number" : "";
}

static const char *ScanName(const char text[], const LamKey *key, PetscReal *number)
{
  for (PetscInt i = 0; i < key->name_count; i++) {
    *number = (PetscReal)i;
    if (!strcmp(text, key->names[i])) return "";
  }
  return "is none of the names known here";
}

/* The bounds of a key in SI. */
static PetscErrorCode BoundsInSI(const LamKey *key, LamBound bounds[2])
{
  char text[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  bounds[0] = key->lower;
  bounds[1] = key->upper;
  for (int i = 0; i < 2; i++) {
    if (bounds[i].kind == LAM_BOUND_NONE || !key->unit) continue;
    snprintf(text, sizeof(text), "%.17g %s", (double)bounds[i].value, key->unit);
    PetscCall(LamQuantityParse(text, key->dimension, &bounds[i].value));
  }
  PetscFunctionReturn(0);
}

/* Reads one component of a value from a scalar. */
static PetscErrorCode ReadSingle(const LamNode *node, const LamKey *key, LamValue *value)
{
  char quantity[LAM_REASON_LENGTH];
  const char *reason = "";
  PetscReal number = 0.0;
  LamBound bounds[2];

  PetscFunctionBeginUser;
  PetscCall(CheckKind(node, key, PETSC_TRUE, LAM_NODE_SCALAR));
  if (key->free_word && !strcmp(node->text, key->free_word)) {
    value->is_free[value->count++] = PETSC_TRUE;
    PetscFunctionReturn(0);
  }
  if (key->type == LAM_KEY_QUANTITY || key->type == LAM_KEY_QUANTITY_TENSOR) {
    PetscCall(LamQuantityRead(node->text, key->dimension, &number, quantity));
    reason = quantity;
  } else if (key->type == LAM_KEY_NAME) {
    reason = ScanName(node->text, key, &number);
  } else if (key->type == LAM_KEY_BOOL) {
    number = !strcasecmp(node->text, "true");
    if (number == 0.0 && strcasecmp(node->text, "false") != 0) reason = "is not a truth value";
  } else if (key->type != LAM_KEY_TEXT && key->type != LAM_KEY_PATH) {
    reason = ScanPlain(node->text, key->type, &number);
  }
  PetscCall(BoundsInSI(key, bounds));
  if (!reason[0] && !LamBoundsHold(&bounds[0], &bounds[1], number)) reason = "is out of range";
  if (reason[0]) PetscCall(FailValue(node, key, PETSC_TRUE, reason));
  value->number[value->count++] = number;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadVector(LamNode *node, const LamKey *key)
{
  char reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(CheckKind(node, key, PETSC_FALSE, LAM_NODE_LIST));
  snprintf(reason, sizeof(reason), "has %d entr%s", (int)node->count, node->count == 1 ? "y" : "ies");
  if (node->count != key->size) PetscCall(FailValue(node, key, PETSC_FALSE, LengthReason(node, reason)));
  for (LamNode *item = node->first; item; item = item->next) PetscCall(ReadSingle(item, key, &node->value));
  PetscFunctionReturn(0);
}

/* Reads a tensor of two rows of two or three rows of three; 2x2 plain numbers are completed with F33 = 1. */
static PetscErrorCode ReadTensor(LamNode *node, const LamKey *key)
{
  LamValue read = {0};
  PetscBool square;

  PetscFunctionBeginUser;
  PetscCall(CheckKind(node, key, PETSC_FALSE, LAM_NODE_LIST));
  square = (PetscBool)(node->count == 2 || node->count == 3);
  for (const LamNode *row = node->first; row; row = row->next)
    if (row->kind != LAM_NODE_LIST || row->count != node->count) square = PETSC_FALSE;
  if (!square) PetscCall(FailValue(node, key, PETSC_FALSE, LengthReason(node, "is no square tensor")));
  for (const LamNode *row = node->first; row; row = row->next)
    for (const LamNode *item = row->first; item; item = item->next) PetscCall(ReadSingle(item, key, &read));
  node->value.count = LAM_VALUE_SIZE;
  if (key->type == LAM_KEY_TENSOR)
    node->value.number[8] = 1.0;
  else
    for (PetscInt i = 0; i < LAM_VALUE_SIZE; i++) node->value.is_free[i] = PETSC_TRUE;
  for (PetscInt i = 0; i < read.count; i++) {
    const PetscInt to = (PetscInt)(3 * (i / node->count) + i % node->count);

    node->value.number[to] = read.number[i];
    node->value.is_free[to] = read.is_free[i];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadList(LamNode *node, const LamKey *key)
{
  char path[PATH_LENGTH];
  const LamKey *item_key;

  PetscFunctionBeginUser;
  PetscCall(CheckKind(node, key, PETSC_FALSE, LAM_NODE_LIST));
  if (!node->count) PetscCall(FailValue(node, key, PETSC_FALSE, "is empty"));
  snprintf(path, sizeof(path), "%s[]", key->path);
  item_key = LamKeyFind(path);
  PetscCheck(item_key, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the table of scene keys lacks %s", path);
  for (LamNode *item = node->first; item; item = item->next) PetscCall(LamSceneReadNode(item, item_key));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadMap(LamNode *node, const LamKey *key)
{
  const LamKey *child;

  PetscFunctionBeginUser;
  PetscCall(CheckKind(node, key, PETSC_FALSE, LAM_NODE_MAP));
  for (LamNode *entry = node->first; entry; entry = entry->next) {
    char path[PATH_LENGTH];
    const LamKey *entry_key = NULL;
    const int length = snprintf(path, sizeof(path), "%s%s%s", key->path, key->path[0] ? "." : "", entry->name);

    if (length < PATH_LENGTH) entry_key = LamKeyFind(path);
    if (!entry_key || !LamKeyIsChild(entry_key, key)) PetscCall(FailUnknown(entry, key));
    if (IsSplitByComma(entry)) PetscCall(FailValue(entry, entry_key, PETSC_FALSE, LAM_DECIMAL_COMMA));
    PetscCall(LamSceneReadNode(entry, entry_key));
  }
  for (PetscInt i = 0; (child = LamKeyAt(i)); i++) {
    const char *name = LamKeyName(child);
    char expected[LAM_KEY_TEXT_LENGTH];
    if (!child->required || !LamKeyIsChild(child, key)) continue;
    LamKeyExpectation(child, PETSC_FALSE, expected);
    LamSceneRequire(LamNodeFind(node, name), node, name, "missing; write %s", expected);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneNeed(const LamNode *map, const char path[])
{
  const LamKey *key = LamKeyFind(path);
  char expected[LAM_KEY_TEXT_LENGTH];

  PetscFunctionBeginUser;
  LamKeyExpectation(key, PETSC_FALSE, expected);
  LamSceneRequire(LamNodeFind(map, LamKeyName(key)), map, LamKeyName(key), "missing; write %s", expected);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadNode(LamNode *node, const LamKey *key)
{
  PetscFunctionBeginUser;
  node->key = key;
  switch (key->type) {
  case LAM_KEY_MAP:
    PetscCall(ReadMap(node, key));
    break;
  case LAM_KEY_LIST:
    PetscCall(ReadList(node, key));
    break;
  case LAM_KEY_TENSOR:
  case LAM_KEY_QUANTITY_TENSOR:
    PetscCall(ReadTensor(node, key));
    break;
  default:
    if (key->size)
      PetscCall(ReadVector(node, key));
    else
      PetscCall(ReadSingle(node, key, &node->value));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneCheckKeys(LamDocument *document)
{
  const LamNode start = {.document = document, .line = 1, .column = 1};

  PetscFunctionBeginUser;
  LamSceneCheck(document->root && !document->root->is_null, &start,
                "the file holds no scene; a scene starts with version: 1");
  PetscCall(LamSceneReadNode(document->root, LamKeyFind("")));
  PetscFunctionReturn(0);
}
