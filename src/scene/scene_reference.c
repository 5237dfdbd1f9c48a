/*
  The scene reference, docs/reference/scene.md, from the table of keys.
*/
#include "scene_keys.h"
#include "quantity_text.h"
#include <string.h>

static const char *const introduction =
    "# Scene files\n\n"
    "<!-- Generated from the tables of keys in src/scene; after a change there run the test test_scene_reference with\n"
    "     LAMELLA_UPDATE_DOCS=1 in the environment. -->\n\n"
    "A scene is a YAML file that describes the tissue and what is to be done with it. It holds only the blocks it\n"
    "needs: `rve` always, `load` for `lamella rve`, `sample` for `lamella build`, `macro` for `lamella fe2`,\n"
    "`load` and `map` for `lamella map`.\n"
    "Examples: [shear-bonded.yaml](../../tests/scenes/shear-bonded.yaml) (a cell under turgor, sheared),\n"
    "[shear-contact.yaml](../../tests/scenes/shear-contact.yaml) (cells that come apart while their turgor falls),\n"
    "[shear-dry.yaml](../../tests/scenes/shear-dry.yaml) (dry cells, sheared until they separate),\n"
    "[uniaxial.yaml](../../tests/scenes/uniaxial.yaml) (a cell that swells, then stretched with its sides free),\n"
    "[hexagons-dry.yaml](../../tests/scenes/hexagons-dry.yaml) and\n"
    "[hexagons-turgid.yaml](../../tests/scenes/hexagons-turgid.yaml) (a patch of cells between grips, empty and under "
    "turgor),\n"
    "[uneven-cells.yaml](../../tests/scenes/uneven-cells.yaml) (cells that differ),\n"
    "[shear-sealed.yaml](../../tests/scenes/shear-sealed.yaml) (cells that keep their water),\n"
    "[failure.yaml](../../tests/scenes/failure.yaml) (bonded cells pulled until something gives way) and\n"
    "[tissue-block.yaml](../../tests/scenes/tissue-block.yaml) (a block of tissue, inflated and sheared).\n\n"
    "* **Quantities** carry a unit that udunits2 knows, such as `75 um`, `0.1 MPa`, `2 bar`, `30 deg`, `0.5 rad`.\n"
    "  A bare number is an error where a dimension is needed, and so is a unit where a plain number is.\n"
    "* **Ratios, strains and deformation gradients** are plain numbers.\n"
    "* **Mistakes** are refused before anything is solved: unknown keys, keys given twice, missing keys and units,\n"
    "  wrong dimensions, impossible values. The message names file, line, column, key and value, says what is wrong "
    "and\n"
    "  what would be right. The first mistake ends the reading.\n"
    "* **Anchors and aliases** of YAML may be used; merge keys (`<<`), tags and several documents may not. A file has\n"
    "  at most 1 MB.\n"
    "\n"
    "*Required* means: wherever the block it belongs to is given. In paths, `[]` stands for each item of a list.\n";

static const char *TypeText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  static const char *const types[] = {"map",
                                      "list",
                                      "",
                                      "number",
                                      "whole number",
                                      "",
                                      "true or false",
                                      "text",
                                      "2x2 or 3x3 numbers",
                                      "2x2 or 3x3 stresses"};
  const char *type = key->type == LAM_KEY_QUANTITY ? LamDimensionNames[key->dimension] : types[key->type];
  size_t used = 0;

  if (key->type != LAM_KEY_NAME) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, key->size ? "[%s, %s]" : "%s", type, type);
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
  fprintf(out, " | ");
  if (key->required)
    fprintf(out, "*required*");
  else if (key->default_value)
    fprintf(out, "`%s`", key->default_value);
  else if (key->default_words)
    fprintf(out, "%s", key->default_words);
  if (key->type == LAM_KEY_MAP || key->type == LAM_KEY_LIST)
    fprintf(out, " | | %s |\n", key->help);
  else
    fprintf(out, " | `%s` | %s |\n", key->example, key->help);
}

/* Does the key belong to the top-level block, or is it the block itself? */
static PetscBool KeyIsIn(const LamKey *key, const char block[])
{
  const size_t length = strlen(block);

  return !strncmp(key->path, block, length) && (!key->path[length] || strchr(".[", key->path[length])) ? PETSC_TRUE
                                                                                                       : PETSC_FALSE;
}

static void WriteHeader(FILE *out, const char title[], const char help[])
{
  fprintf(out, "\n## %s\n\n%s%s", title, help, help[0] ? "\n\n" : "");
  fprintf(out, "| key | value | default | example | meaning |\n|---|---|---|---|---|\n");
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
