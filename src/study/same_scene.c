/*
  Whether a scene, and the contents of the files that it names, are those with which a file was begun: work that goes on
  with others would mix two.
*/
#include "study.h"
#include <string.h>

static size_t LineLength(const char text[])
{
  return strcspn(text, "\n");
}

/* Number from 1 of the first line that differs, and the rest of both texts from there on. */
static int DifferentLine(const char **before, const char **now)
{
  int line = 1;

  for (;; line++) {
    const size_t a = LineLength(*before), b = LineLength(*now);

    if (a != b || strncmp(*before, *now, a) || !(*before)[a] || !(*now)[b]) return line;
    *before += a + 1;
    *now += b + 1;
  }
}

PetscErrorCode LamCheckSameScene(const char path[], const char before[], const char files_before[],
                                 const LamScene *scene)
{
  const char *now = scene->text;
  char *files, changed[PETSC_MAX_PATH_LEN] = "";

  PetscFunctionBeginUser;
  if (strcmp(before, now)) {
    const int line = DifferentLine(&before, &now);

    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
            "%s: belongs to another scene; line %d was \"%.*s\" and is \"%.*s\"; restore it, or leave out --resume",
            path, line, (int)LineLength(before), before, (int)LineLength(now), now);
  }
  if (!files_before) PetscFunctionReturn(0); /* a file of version 0.1 */
  PetscCall(LamSceneDescribeFiles(scene, &files));
  if (strcmp(files_before, files)) {
    const int line = DifferentLine(&files_before, &(const char *){files});

    PetscCall(PetscStrncpy(changed, scene->files[PetscMin(line, scene->file_count) - 1].path, sizeof(changed)));
  }
  PetscCall(PetscFree(files));
  PetscCheck(!changed[0], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: was begun with another content of %s, which %s names; restore that file, or leave out --resume", path,
             changed, scene->path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCheckSameSceneFile(const char path[], const LamScene *scene)
{
  PetscBool has_scene, has_files;
  char *text = NULL, *files = NULL;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(path, "/scene", &has_scene, &text));
  PetscCall(LamFileReadText(path, LAM_SCENE_FILES, &has_files, &files));
  ierr = LamCheckSameScene(path, has_scene ? text : "", has_files ? files : NULL, scene);
  PetscCall(PetscFree(text));
  PetscCall(PetscFree(files));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
