/*
  Error messages for scene files: position, key, value, what is wrong and what would be right.
*/
#include "scene_yaml.h"
#include <stdarg.h>
#include <string.h>

/* PETSc truncates messages at about a thousand characters: each part of unknown length has its own limit. */
enum { MESSAGE_LENGTH = 900, NAME_SHOWN = 120, KEY_LENGTH = 120, VALUE_SHOWN = 60, DETAIL_LENGTH = 560 };

/* The path of a node from the root, "load[2].ramp.to". */
static void NodePath(const LamNode *node, char path[KEY_LENGTH])
{
  size_t used;

  path[0] = '\0';
  if (!node || !node->parent) return;
  NodePath(node->parent, path);
  used = strlen(path);
  if (node->index) {
    snprintf(path + used, KEY_LENGTH - used, "[%" PetscInt_FMT "]", node->index - 1);
  } else if (node->name) {
    snprintf(path + used, KEY_LENGTH - used, "%s%.40s", used ? "." : "", node->name);
  }
}

/* Copies text as one line, without control characters, truncated after `shown` bytes (not within a UTF-8 sequence). */
static void CopyPrintable(const char text[], size_t shown, char copy[VALUE_SHOWN + 4])
{
  size_t length = strlen(text), n = PetscMin(length, shown);

  while (n < length && n > 0 && ((unsigned char)text[n] & 0xC0) == 0x80) n--;
  for (size_t i = 0; i < n; i++) copy[i] = (unsigned char)text[i] < 0x20 || text[i] == 0x7F ? ' ' : text[i];
  memcpy(copy + n, n < length ? "..." : "", n < length ? 4 : 1);
}

static void Compose(const LamNode *node, LamMistake mistake, const char key[], const char format[], va_list arguments,
                    char message[MESSAGE_LENGTH])
{
  const PetscBool at_name = (PetscBool)(mistake == LAM_MISTAKE_NAME || (mistake == LAM_MISTAKE_MISSING && node->name));
  const char *full = node->document->name;
  const size_t length = strlen(full);
  const char *name = full + (length > NAME_SHOWN ? length - NAME_SHOWN : 0);
  char path[KEY_LENGTH], shown[VALUE_SHOWN + 4] = "", detail[DETAIL_LENGTH];
  size_t used;

  NodePath(node, path);
  used = strlen(path);
  if (key) snprintf(path + used, KEY_LENGTH - used, "%s%s", used ? "." : "", key);
  if (mistake == LAM_MISTAKE_VALUE && node->text) CopyPrintable(node->text, VALUE_SHOWN, shown);
  vsnprintf(detail, sizeof(detail), format, arguments);
  snprintf(message, MESSAGE_LENGTH, "%s%s:%d:%d: %s%s%s%s%s", name == full ? "" : "...", name,
           at_name ? node->name_line : node->line, at_name ? node->name_column : node->column, path,
           path[0] ? ": " : "", shown, shown[0] ? ": " : "", detail);
}

const char *LamScenePlaceText(const LamScene *scene, const LamScenePlace *place, char text[LAM_PLACE_TEXT])
{
  const size_t length = strlen(scene->path);
  const char *name = scene->path + (length > NAME_SHOWN ? length - NAME_SHOWN : 0);
  const int used = snprintf(text, LAM_PLACE_TEXT, "%s%s", name == scene->path ? "" : "...", name);

  if (place->line) snprintf(text + used, (size_t)(LAM_PLACE_TEXT - used), ":%d:%d", place->line, place->column);
  return text;
}

PetscErrorCode LamSceneRaise(const LamNode *node, LamMistake mistake, const char key[], const char format[], ...)
{
  char message[MESSAGE_LENGTH];
  va_list arguments;

  PetscFunctionBeginUser;
  va_start(arguments, format);
  Compose(node, mistake, key, format, arguments, message);
  va_end(arguments);
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s", message);
}

PetscErrorCode LamSceneWarn(LamScene *scene, const LamNode *node, LamMistake mistake, const char key[],
                            const char format[], ...)
{
  char message[MESSAGE_LENGTH];
  va_list arguments;

  PetscFunctionBeginUser;
  va_start(arguments, format);
  Compose(node, mistake, key, format, arguments, message);
  va_end(arguments);
  PetscCall(PetscRealloc((size_t)(scene->warning_count + 1) * sizeof(*scene->warnings), &scene->warnings));
  PetscCall(PetscStrallocpy(message, &scene->warnings[scene->warning_count]));
  scene->warning_count++;
  PetscFunctionReturn(0);
}
