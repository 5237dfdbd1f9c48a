/* Scene files: any text is read or refused as the user's mistake, in words, and leaves no memory behind. */
#include "fuzz.h"
#include <lamella/scene.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  FuzzStart(argc, argv);
  FuzzCountMemory();
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char *text = malloc(size + 1);
  LamScene *scene;
  PetscErrorCode code;

  memcpy(text, data, size);
  text[size] = '\0';
  code = LamSceneReadText("scene.yaml", text, &scene);
  FuzzCheck(!code || (code == PETSC_ERR_USER_INPUT && FuzzMessage()[0]), "error %d: %s", code, FuzzMessage());
  FuzzCheck(!LamSceneDestroy(&scene), "the scene cannot be destroyed");
  FuzzCheck(!FuzzMemoryLeft(), "%zu bytes are left", FuzzMemoryLeft());
  free(text);
  return 0;
}
