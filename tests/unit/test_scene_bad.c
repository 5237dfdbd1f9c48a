/*
  Every scene in tests/scenes/bad is refused with the message that its first line names: "# expect: fragment", where the
  fragment follows "file:". One test for each file.
*/
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include "test_scene_message.h"
#include <dirent.h>
#include <stdlib.h>

#define BAD_SCENES LAMELLA_SOURCE_DIR "/tests/scenes/bad"

static void is_refused_as_expected(void **state)
{
  const char *name = (const char *)*state;
  char path[PETSC_MAX_PATH_LEN], line[512] = "", expected[PETSC_MAX_PATH_LEN + 512];
  LamScene *scene;
  PetscErrorCode error;
  FILE *file;

  snprintf(path, sizeof(path), "%s/%s", BAD_SCENES, name);
  file = fopen(path, "r");
  assert_non_null(file);
  assert_non_null(fgets(line, sizeof(line), file));
  fclose(file);
  line[strcspn(line, "\n")] = '\0';
  assert_int_equal(strncmp(line, "# expect: ", 10), 0);
  /* a long path is shown by its end */
  snprintf(expected, sizeof(expected), "bad/%s:%s", name, line + 10);
  CATCH(LamSceneRead(path, &scene), error);
  if (error != PETSC_ERR_USER_INPUT) fail_msg("%s: error %d instead of a refusal", name, error);
  assert_null(scene);
  if (!strstr(scene_message, expected)) fail_msg("\"%s\"\n  lacks \"%s\"", scene_message, expected);
}

int main(void)
{
  struct dirent **entries;
  const int count = scandir(BAD_SCENES, &entries, NULL, alphasort);
  struct CMUnitTest *tests = calloc(count > 0 ? (size_t)count : 1, sizeof(*tests));
  size_t used = 0;
  int failed;

  for (int i = 0; i < count; i++) {
    char *name = entries[i]->d_name;
    if (!strstr(name, ".yaml")) continue;
    tests[used++] = (struct CMUnitTest){.name = name, .test_func = is_refused_as_expected, .initial_state = name};
  }
  failed = used ? _cmocka_run_group_tests("bad scenes", tests, used, NULL, NULL) : 1;
  for (int i = 0; i < count; i++) free(entries[i]);
  free(entries);
  free(tests);
  return failed;
}
