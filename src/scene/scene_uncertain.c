/*
  The `uncertain` block of a scene: keys whose values are not known, and between which values they lie. Studies of
  scenes read it from the text (python/lamella/parameters.py); here it is checked.
*/
#include "quantity_text.h"
#include "scene_rows.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const LamKey uncertain_keys[] = {
    {LIST("uncertain"), .default_words = "all values are known",
     .example = "[{key: rve.wall.C1, from: 10 MPa, to: 40 MPa}]",
     .help = "For `calibrate`, `sensitivity` and `--uncertainty`: values that are not known. Within its bounds each is "
             "as likely as any other, in the logarithm where they are above 0."},
    {MAP("uncertain[]"), .example = "{key: rve.wall.C1, from: 10 MPa, to: 40 MPa}",
     .help = "A value that is not known."},
    {TEXT("uncertain[].key"), REQUIRED, .example = "rve.wall.C1",
     .help = "The key of a number in this file, with its blocks; items of lists by number from 0: "
             "`process.kinetics.0.rate`."},
    {TEXT("uncertain[].from"), REQUIRED, .example = "10 MPa", .help = "The least value, as the key takes it."},
    {TEXT("uncertain[].to"), REQUIRED, .example = "40 MPa", .help = "The largest value."},
    {TEXT("uncertain[].mean"), .default_words = "nothing more is known", .example = "20 MPa",
     .help = "With `deviation`: it is normally distributed between the bounds."},
    {TEXT("uncertain[].deviation"), .default_words = "nothing more is known", .example = "3 MPa",
     .help = "Standard deviation."},
};
LAM_KEY_TABLE(LamUncertainKeys, uncertain_keys);

enum { MOST_DIGITS = 6 }; /* of the number of an item */

/* The node of an entry or item; NULL: there is none. */
static const LamNode *Step(const LamNode *node, const char part[], size_t length)
{
  PetscInt index;

  if (node->kind == LAM_NODE_MAP) return LamNodeEntry(node, part, length);
  if (node->kind != LAM_NODE_LIST || length > MOST_DIGITS || strspn(part, "0123456789") != length) return NULL;
  if (length > 1 && part[0] == '0') return NULL; /* one spelling of each number */
  index = (PetscInt)strtol(part, NULL, 10);
  for (node = node->first; node && index--; node = node->next)
    ;
  return node;
}

/* The key of a path, which the file has. */
static PetscErrorCode Follow(const LamNode *block, const LamNode *text, const LamKey **key)
{
  char path[LAM_KEY_TEXT_LENGTH] = "";
  const char *part = text->text;

  PetscFunctionBeginUser;
  LamSceneCheck(strlen(part) < sizeof(path) / 2, text, "is too long for a key");
  for (;;) {
    const size_t length = strcspn(part, "."), used = strlen(path);
    const PetscBool item = (PetscBool)(block->kind == LAM_NODE_LIST);

    snprintf(path + used, sizeof(path) - used, "%s%.*s", item ? "[]" : used ? "." : "", item ? 0 : (int)length, part);
    if (!part[length]) break;
    block = Step(block, part, length);
    LamSceneCheck(block, text, "is not in the file, which has nothing at %.*s; write the key there first",
                  (int)(part + length - text->text), text->text);
    part += length + 1;
  }
  *key = LamKeyFind(path);
  LamSceneCheck(*key && Step(block, part, strlen(part)), text,
                "is not in the file; write the key and a value there first");
  LamSceneCheck(((*key)->type == LAM_KEY_QUANTITY || (*key)->type == LAM_KEY_REAL) && !(*key)->size, text,
                "is not the key of one number");
  PetscFunctionReturn(0);
}

/* As the key takes it; its node remains that of a text. */
static PetscErrorCode ReadValue(const LamNode *entry, const char name[], const LamKey *key, LamNode **node,
                                PetscReal *value)
{
  const LamKey *text;

  PetscFunctionBeginUser;
  *value = NAN;
  *node = LamNodeEntry(entry, name, strlen(name));
  if (!*node) PetscFunctionReturn(0);
  text = (*node)->key;
  (*node)->value = (LamValue){0};
  PetscCall(LamSceneReadNode(*node, key));
  (*node)->key = text;
  *value = (*node)->value.number[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckEntry(const LamNode *root, const LamNode *entry)
{
  LamNode *from, *to, *mean, *deviation;
  PetscReal least, most, middle, spread;
  const char *end;
  const LamKey *key = NULL;
  LamKey unbounded;

  PetscFunctionBeginUser;
  PetscCall(Follow(root, LamNodeFind(entry, "key"), &key));
  unbounded = *key;
  unbounded.lower = unbounded.upper = (LamBound){0};
  PetscCall(ReadValue(entry, "from", key, &from, &least));
  PetscCall(ReadValue(entry, "to", key, &to, &most));
  PetscCall(ReadValue(entry, "mean", key, &mean, &middle));
  PetscCall(ReadValue(entry, "deviation", &unbounded, &deviation, &spread));
  LamSceneCheck(least < most, to, "is not larger than from (%s in line %d); exchange them", from->text, from->line);
  LamSceneCheckName(!mean == !deviation, mean ? mean : deviation, "goes with %s; write it, or leave this out",
                    mean ? "deviation" : "mean");
  LamSceneCheck(!deviation || LamNumberScan(deviation->text, &end) > 0, deviation,
                "is no standard deviation; write one above 0");
  LamSceneCheck(!mean || (middle >= least && middle <= most), mean, "is not between from and to");
  for (const LamNode *other = entry->parent->first; other != entry; other = other->next)
    LamSceneCheck(strcmp(LamNodeFind(other, "key")->text, LamNodeFind(entry, "key")->text) != 0,
                  LamNodeFind(entry, "key"), "is in line %d already; leave one of them out", other->line);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneCheckUncertain(const LamNode *root, LamScene *scene)
{
  const LamNode *list = LamNodeFind(root, "uncertain");

  PetscFunctionBeginUser;
  (void)scene;
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next) PetscCall(CheckEntry(root, entry));
  PetscFunctionReturn(0);
}
