/* Files that are no scenes, by accident or on purpose: each is refused with a message, none crashes the reader. */
#include "support/test.h"
#include "test_scene.h"
#include "test_scene_message.h"
#include <stdlib.h>
#include <unistd.h>

#define SCENE LAMELLA_SOURCE_DIR "/tests/scenes/tissue-block.yaml"

enum { MESSAGE_LIMIT = 900 };

static void AssertRefusedText(const char text[], const char fragment[])
{
  LamScene *scene;
  PetscErrorCode error;

  CATCH(LamSceneReadText("scene.yaml", text, &scene), error);
  assert_int_equal(error, PETSC_ERR_USER_INPUT);
  assert_null(scene);
  assert_true(strlen(scene_message) < MESSAGE_LIMIT);
  if (!strstr(scene_message, fragment)) fail_msg("\"%s\" lacks \"%s\"", scene_message, fragment);
}

static void AssertRefusedFile(const char path[], const char fragment[])
{
  LamScene *scene;
  PetscErrorCode error;

  CATCH(LamSceneRead(path, &scene), error);
  assert_int_equal(error, PETSC_ERR_USER_INPUT);
  assert_null(scene);
  if (!strstr(scene_message, fragment)) fail_msg("\"%s\" lacks \"%s\"", scene_message, fragment);
}

static char *Repeat(const char start[], const char part[], size_t times, const char end[])
{
  const size_t length = strlen(part);
  char *text = malloc(strlen(start) + times * length + strlen(end) + 1), *p = text + strlen(start);

  strcpy(text, start);
  for (size_t i = 0; i < times; i++, p += length) memcpy(p, part, length);
  strcpy(p, end);
  return text;
}

static void AssertRefusedRepeat(const char start[], const char part[], size_t times, const char end[],
                                const char fragment[])
{
  char *text = Repeat(start, part, times, end);

  AssertRefusedText(text, fragment);
  free(text);
}

TEST_IS(a_missing_file_is_named,
        AssertRefusedFile("no/such/scene.yaml", "no/such/scene.yaml: the scene cannot be opened: No such file"));

TEST_IS(a_directory_is_refused, AssertRefusedFile(LAMELLA_SOURCE_DIR "/tests", "Is a directory"));

TEST_IS(an_endless_file_is_refused, AssertRefusedFile("/dev/zero", "larger than 1024 kB"));

TEST_IS(a_text_beyond_1_MB_is_refused,
        AssertRefusedRepeat("", "# comment\n", 110000, "version: 1\n", "larger than 1024 kB"));

TEST(a_file_with_null_bytes_is_refused)
{
  char path[] = "lamella-scene-XXXXXX";
  const int file = mkstemp(path);

  assert_true(file >= 0);
  assert_int_equal(write(file, "version: 1\n\0garbage", 19), 19);
  close(file);
  AssertRefusedFile(path, "byte 11 is 0x00");
  unlink(path);
}

TEST(empty_files_are_refused)
{
  AssertRefusedText("", "1:1: the file holds no scene");
  AssertRefusedText("# only a comment\n", "the file holds no scene");
  AssertRefusedText("---\n", "the file holds no scene");
}

TEST(invalid_UTF8_is_refused)
{
  AssertRefusedText("version: \xff\xfe\xc0\n", "scene.yaml:1:10: byte 0xff is no UTF-8");
  AssertRefusedText("# \xc3\xa4\n\xc3\xa4\xe0\x80\xaf",
                    "scene.yaml:2:2: byte 0xe0 is no UTF-8");                     /* an overlong slash */
  AssertRefusedText("# \xed\xa0\x80\n", "scene.yaml:1:3: byte 0xed is no UTF-8"); /* half of a pair */
  AssertRefusedText("# \xf0\x9f\x8d", "scene.yaml:1:3: byte 0xf0 is no UTF-8");   /* cut */
}

/* libfyaml never returned. */
TEST_IS(a_directive_that_is_no_UTF8_is_refused, AssertRefusedText("%a\xd0\n", "scene.yaml:1:3: byte 0xd0 is no UTF-8"));

TEST(deep_nesting_is_refused)
{
  AssertRefusedRepeat("rve: ", "[", 100000, "", "nested more than 32 levels");
  AssertRefusedRepeat("", "{a: ", 100000, "", "nested more than 32 levels");
}

TEST(a_map_of_many_keys_is_refused)
{
  char *text = malloc(1 << 20), *p = text;

  for (int i = 0; i < 50000; i++) p += sprintf(p, "k%d: 1\n", i);
  AssertRefusedText(text, "more than 256 keys");
  free(text);
}

TEST(too_many_states_are_refused)
{
  AssertRefusedRepeat(RVE "load:\n", "  - {ramp: {to: [[1, 0.1], [0, 1]], steps: 10000}}\n", 101, "",
                      "scene.yaml:106:5: load[100]: {ramp: {to: [[1, 0.1], [0, 1]], steps: 10000}}: "
                      "more than 1000000 states in all");
}

TEST(too_many_boundaries_are_refused)
{
  AssertRefusedRepeat(RVE "macro:\n"
                          "  mesh: {box: [10 mm, 10 mm], elements: [8, 8]}\n"
                          "  boundary:\n"
                          "    - {on: bottom, displacement: [0 mm, 0 mm]}\n",
                      "    - {on: right, pressure: 0.001 MPa}\n", 16, "",
                      "scene.yaml:7:3: macro.boundary: has 17 entries");
}

TEST(multiplying_aliases_are_refused)
{
  AssertRefusedText("a: &a [x, x, x, x, x, x, x, x, x, x]\n"
                    "b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]\n"
                    "c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]\n"
                    "d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]\n"
                    "e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]\n"
                    "f: &f [*e, *e, *e, *e, *e, *e, *e, *e, *e, *e]\n"
                    "g: &g [*f, *f, *f, *f, *f, *f, *f, *f, *f, *f]\n",
                    "values in one file");
}

TEST(an_alias_to_what_contains_it_is_refused)
{
  AssertRefusedText("rve: &a {cell: *a}\n", "no finished value has the anchor &a");
}

TEST(long_values_and_keys_are_shortened)
{
  AssertRefusedRepeat("version: ", "long", 10000, "\n", "longlong...: is not a number");
  AssertRefusedRepeat("", "key", 10000, ": 1\n", "unknown key");
}

TEST(a_long_name_is_shortened)
{
  char *name = Repeat("", "directory/", 300, "scene.yaml");
  LamScene *scene;
  PetscErrorCode error;

  CATCH(LamSceneReadText(name, "version: 2\n", &scene), error);
  free(name);
  assert_int_equal(error, PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(scene_message, "directory/scene.yaml:1:10: version: 2: is out of range; write 1"));
}

TEST_IS(percent_signs_are_shown_as_they_are,
        AssertRefusedText("version: 100%s%n\n", "version: 100%s%n: is not a plain number"));

static char *ReadScene(void)
{
  char *text = calloc(1, 1 << 16);
  FILE *file = fopen(SCENE, "r");

  assert_non_null(file);
  assert_true(fread(text, 1, (1 << 16) - 1, file) > 0);
  fclose(file);
  return text;
}

/* What is wrong is not judged here: that it is answered, with a message, is. */
static void AssertAnswered(const char text[])
{
  LamScene *scene;
  PetscErrorCode error;

  CATCH(LamSceneReadText("scene.yaml", text, &scene), error);
  if (!error)
    assert_int_equal(LamSceneDestroy(&scene), 0);
  else if (error != PETSC_ERR_USER_INPUT || !scene_message[0])
    fail_msg("error %d for\n%s", error, text);
}

TEST(a_scene_cut_anywhere_is_answered)
{
  char *text = ReadScene();

  for (size_t n = strlen(text); n > 0; n--) {
    text[n - 1] = '\0';
    AssertAnswered(text);
  }
  free(text);
}

TEST(a_scene_with_any_byte_changed_is_answered)
{
  static const char bytes[] = "{}[]:,&*-? \n\"'#%|>x0\xc3\t";
  char *text = ReadScene();

  for (size_t i = 0; text[i]; i++) {
    const char kept = text[i];
    text[i] = bytes[i % (sizeof(bytes) - 1)];
    AssertAnswered(text);
    text[i] = bytes[(i * 7 + 3) % (sizeof(bytes) - 1)];
    AssertAnswered(text);
    text[i] = kept;
  }
  free(text);
}
