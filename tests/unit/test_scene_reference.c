/*
  docs/reference/scene.md is what the table of keys says. LAMELLA_UPDATE_DOCS=1 in the environment rewrites it instead.
*/
#include "support/test.h"
#include <lamella/scene.h>
#include <stdlib.h>
#include <string.h>

#define REFERENCE LAMELLA_SOURCE_DIR "/docs/reference/scene.md"

static char *Generate(size_t *length)
{
  char *text = NULL;
  FILE *out = open_memstream(&text, length);

  assert_non_null(out);
  assert_int_equal(LamSceneReference(out), 0);
  fclose(out);
  return text;
}

TEST(the_reference_in_docs_is_up_to_date)
{
  size_t length, read;
  char *text = Generate(&length), *stored = malloc(length + 2);
  const char *update = getenv("LAMELLA_UPDATE_DOCS");
  FILE *file;

  if (update && !strcmp(update, "1")) {
    file = fopen(REFERENCE, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
  }
  file = fopen(REFERENCE, "r");
  assert_non_null(file);
  read = fread(stored, 1, length + 1, file);
  fclose(file);
  if (read != length || memcmp(text, stored, length)) fail_msg("run this test with LAMELLA_UPDATE_DOCS=1");
  free(text);
  free(stored);
}

TEST(an_unwritable_file_is_an_error)
{
  FILE *full = fopen("/dev/full", "w");

  if (!full) skip();
  assert_int_equal(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL), 0);
  assert_int_equal(LamSceneReference(full), PETSC_ERR_FILE_WRITE);
  assert_int_equal(PetscPopErrorHandler(), 0);
  fclose(full);
}
