/*
  What record files and checkpoints keep of the files that a scene names.
*/
#include <lamella/scene.h>
#include <stdio.h>
#include <string.h>

PetscErrorCode LamSceneDescribeFiles(const LamScene *scene, char **text)
{
  size_t length = 1, used = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < scene->file_count; k++) length += LAM_HASH_LENGTH + 2 + strlen(scene->files[k].name);
  PetscCall(PetscCalloc1(length, text));
  for (PetscInt k = 0; k < scene->file_count; k++)
    used += (size_t)snprintf(*text + used, length - used, "%s %s\n", scene->files[k].hash, scene->files[k].name);
  PetscFunctionReturn(0);
}
