/* Every scene of tests/scenes/bad.txt, whose head explains the format, and bad-blocks.txt is refused with the message
   given there. One test for each scene. */
#include "support/test.h"
#include "test_scene_message.h"
#include <stdlib.h>

#define SCENES LAMELLA_SOURCE_DIR "/tests/scenes/"

enum { MAX_LINES = 16, MAX_LENGTH = 512, MAX_CASES = 512 };

typedef struct {
  char line[MAX_LINES][MAX_LENGTH];
  int count;
} Base;

typedef struct {
  char name[64], expected[MAX_LENGTH];
  char part[MAX_LINES][4 * MAX_LENGTH]; /* each line of the base, with what has been put behind it */
  int count, changed;                   /* changed: the line that the last edit changed */
} Case;

static int Find(const Base *base, const char start[], size_t length)
{
  for (int i = 0; i < base->count; i++)
    if (!strncmp(base->line[i], start, length)) return i;
  return -1;
}

static void Edit(Case *scene, const Base *base, const char edit[])
{
  const char *text = edit + 1;
  const int is_entry = text[strspn(text, " ")] == '-';
  const size_t length = edit[0] == '-' ? strcspn(text, "\n") : strcspn(text, ":") + 1;
  const int found = edit[0] == '+' && is_entry ? -1 : Find(base, text, length);

  if (edit[0] == '-' && found < 0) fail_msg("%s: the base has no line \"%s\"", scene->name, text);
  if (found >= 0) {
    scene->changed = found;
    scene->part[found][0] = '\0';
  }
  if (edit[0] == '+') strcat(scene->part[scene->changed], text);
}

static Case *StartCase(const Base *base, char header[])
{
  Case *scene = calloc(1, sizeof(*scene));

  header[strcspn(header, "\n")] = '\0';
  if (sscanf(header, "%63[^:]: %511[^\n]", scene->name, scene->expected) != 2) fail_msg("no case: %s", header);
  scene->count = base->count;
  scene->changed = base->count - 1;
  for (int i = 0; i < base->count; i++) strcpy(scene->part[i], base->line[i]);
  return scene;
}

/* Behind the first `count`; how many there are then. */
static size_t ReadCases(const char path[], size_t count, Case *cases[])
{
  char line[MAX_LENGTH];
  Base base = {.count = 0};
  int in_base = 0;
  FILE *file = fopen(path, "r");

  if (!file) fail_msg("no %s", path);
  while (fgets(line, sizeof(line), file)) {
    if (line[0] == '#') continue;
    if (!strncmp(line, "===", 3)) {
      in_base = 1;
      base.count = 0;
    } else if (line[0] == '\n')
      in_base = 0;
    else if (in_base)
      strcpy(base.line[base.count++], line);
    else if (line[0] == '+' || line[0] == '-')
      Edit(cases[count - 1], &base, line);
    else
      cases[count++] = StartCase(&base, line);
  }
  fclose(file);
  return count;
}

static void is_refused_as_expected(void **state)
{
  const Case *bad = (const Case *)*state;
  char text[8 * MAX_LENGTH] = "", name[80], expected[2 * MAX_LENGTH];
  LamScene *scene;
  PetscErrorCode error;

  for (int i = 0; i < bad->count; i++) strcat(text, bad->part[i]);
  snprintf(name, sizeof(name), "%s.yaml", bad->name);
  snprintf(expected, sizeof(expected), "%s:%s", name, bad->expected);
  CATCH(LamSceneReadText(name, text, &scene), error);
  if (error != PETSC_ERR_USER_INPUT) fail_msg("error %d instead of a refusal of\n%s", error, text);
  assert_null(scene);
  if (!strstr(scene_message, expected)) fail_msg("\"%s\"\n  lacks \"%s\" of\n%s", scene_message, expected, text);
}

int main(void)
{
  Case *cases[MAX_CASES];
  struct CMUnitTest tests[MAX_CASES];
  const size_t count = ReadCases(SCENES "bad-blocks.txt", ReadCases(SCENES "bad.txt", 0, cases), cases);
  int failed;

  for (size_t i = 0; i < count; i++)
    tests[i] =
        (struct CMUnitTest){.name = cases[i]->name, .test_func = is_refused_as_expected, .initial_state = cases[i]};
  failed = _cmocka_run_group_tests("bad scenes", tests, count, NULL, NULL);
  for (size_t i = 0; i < count; i++) free(cases[i]);
  return failed;
}
