/*
  The files that a scene names, with hashes of their contents: what a run that is resumed compares, and what no output
  may replace.
*/
#include "scene_keys.h"
#include "hash.h"
#include <stdio.h>

/* Empty if the file cannot be read: whoever needs it says so. */
static void HashFile(const char path[], char hash[LAM_HASH_LENGTH])
{
  FILE *stream = fopen(path, "rb");
  uint64_t sum = LAM_HASH_START;
  char block[1 << 16];
  size_t n;

  hash[0] = '\0';
  if (!stream) return;
  while ((n = fread(block, 1, sizeof(block), stream)) > 0) sum = LamHashBytes(sum, block, n);
  if (!ferror(stream)) snprintf(hash, LAM_HASH_LENGTH, "%016llx", (unsigned long long)sum);
  fclose(stream);
}

static PetscErrorCode AddFiles(const LamNode *node, LamScene *scene)
{
  PetscFunctionBeginUser;
  for (const LamNode *child = node->first; child; child = child->next) PetscCall(AddFiles(child, scene));
  if (node->key && node->key->type == LAM_KEY_PATH && node->kind == LAM_NODE_SCALAR && !node->is_null) {
    LamSceneFile *file;
    char path[PETSC_MAX_PATH_LEN];

    PetscCall(LamSceneResolvePath(node, path));
    PetscCall(PetscRealloc((size_t)(scene->file_count + 1) * sizeof(*scene->files), &scene->files));
    file = &scene->files[scene->file_count++];
    PetscCall(PetscStrallocpy(node->text, &file->name));
    PetscCall(PetscStrallocpy(path, &file->path));
    HashFile(path, file->hash);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildFiles(const LamNode *root, LamScene *scene)
{
  PetscFunctionBeginUser;
  PetscCall(AddFiles(root, scene));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneDestroyFiles(LamScene *scene)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < scene->file_count; k++) {
    PetscCall(PetscFree(scene->files[k].name));
    PetscCall(PetscFree(scene->files[k].path));
  }
  PetscCall(PetscFree(scene->files));
  PetscFunctionReturn(0);
}
