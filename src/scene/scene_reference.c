/*
  Writes the scene reference, docs/reference/scene.md, from the table of keys.
*/
#include "scene_keys.h"
#include "quantity_text.h"
#include <string.h>

static const char *const introduction =
    "# Scene files\n\n"
    "<!-- Generated from the tables of keys in src/scene; after a change there run the test test_scene_reference with\n"
    "     LAMELLA_UPDATE_DOCS=1 in the environment. -->\n\n"
    "A scene is a YAML file that describes tissue and what is to be solved. It holds only the blocks it needs:\n"
    "`rve` always, `load` for `lamella rve`, `sample` for `build`, `macro` for `fe2`, `load` and `map` for `map`,\n"
    "`process` for `process`. Examples are in tests/scenes; besides those of the [tutorial](../tutorial.md):\n"
    "[uneven-cells.yaml](../../tests/scenes/uneven-cells.yaml) (cells that differ),\n"
    "[hexagons-dry.yaml](../../tests/scenes/hexagons-dry.yaml) (a patch of cells between grips),\n"
    "[shear-sealed.yaml](../../tests/scenes/shear-sealed.yaml) (cells that keep their water).\n\n"
    "* **Quantities** carry a unit that udunits2 knows, such as `75 um`, `0.1 MPa`, `2 bar`, `30 deg`; ratios,\n"
    "  strains and deformation gradients are plain numbers.\n"
    "* **Mistakes** are refused before anything is solved; the message names file, line, column, key and value,\n"
    "  and what would be right. The first mistake ends the reading.\n"
    "* **YAML**: anchors and aliases may be used; merge keys (`<<`), tags and several documents may not. A file\n"
    "  has at most 1 MB.\n\n"
    "*Required* means: wherever the block it belongs to is given. In paths, `[]` stands for each item of a list.\n";

#define TYPE_WORD(type, word, phrase) word,

static const char *TypeText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  static const char *const types[] = {LAM_KEY_TYPES(TYPE_WORD)};
  const char *type = key->type == LAM_KEY_QUANTITY ? LamDimensionNames[key->dimension] : types[key->type];
  size_t used = 0;

  if (key->type != LAM_KEY_NAME) {
    snprintf(text, LAM_KEY_TEXT_LENGTH,
             key->size == 3 ? "[%s, %s, %s]"
             : key->size    ? "[%s, %s]"
                            : "%s",
             type, type, type);
    return text;
  }
  for (PetscInt i = 0; i < key->name_count && used < LAM_KEY_TEXT_LENGTH; i++) {
    used += (size_t)snprintf(text + used, LAM_KEY_TEXT_LENGTH - used, "%s`%s`", i ? ", " : "", key->names[i]);
  }
  return text;
}

static void WriteRow(FILE *out, const LamKey *key)
{
  char type[LAM_KEY_TEXT_LENGTH], bounds[LAM_KEY_TEXT_LENGTH];

  LamKeyBoundsText(key, bounds);
  fprintf(out, "| `%s` | %s%s%s", key->path, TypeText(key, type), bounds[0] ? ", " : "", bounds);
  if (key->free_word) fprintf(out, ", or `%s`", key->free_word);
  if (key->type >= LAM_KEY_TEXT || key->size) fprintf(out, ", such as `%s`", key->example);
  fprintf(out, " | ");
  if (key->required)
    fprintf(out, "*required*");
  else if (key->default_value)
    fprintf(out, "`%s`", key->default_value);
  else if (key->default_words)
    fprintf(out, "%s", key->default_words);
  fprintf(out, " | %s |\n", key->help);
}

/* True if the key belongs to the top-level block, or is the block itself. */
static PetscBool KeyIsIn(const LamKey *key, const char block[])
{
  const size_t length = strlen(block);

  return !strncmp(key->path, block, length) && (!key->path[length] || strchr(".[", key->path[length])) ? PETSC_TRUE
                                                                                                       : PETSC_FALSE;
}

static void WriteHeader(FILE *out, const char title[], const char help[])
{
  fprintf(out, "\n## %s\n\n%s%s", title, help, help[0] ? "\n\n" : "");
  fprintf(out, "| key | value | default | meaning |\n|---|---|---|---|\n");
}

PetscErrorCode LamSceneReference(FILE *out)
{
  const LamKey *root = LamKeyFind(""), *key, *block;

  PetscFunctionBeginUser;
  fputs(introduction, out);
  WriteHeader(out, "Top level", "");
  for (PetscInt i = 0; (key = LamKeyAt(i)); i++) {
    if (LamKeyIsChild(key, root)) WriteRow(out, key);
  }
  for (PetscInt b = 0; (block = LamKeyAt(b)); b++) {
    if (!LamKeyIsChild(block, root) || (block->type != LAM_KEY_MAP && block->type != LAM_KEY_LIST)) continue;
    WriteHeader(out, block->path, block->help);
    for (PetscInt i = 0; (key = LamKeyAt(i)); i++) {
      if (key != block && KeyIsIn(key, block->path)) WriteRow(out, key);
    }
  }
  PetscCheck(!ferror(out) && !fflush(out), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE,
             "the scene reference cannot be written");
  PetscFunctionReturn(0);
}
