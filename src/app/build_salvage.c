/*
  A damaged database is made anew of its sound records: a merge of one file. The old one gets a second name first, so
  that there is no instant without a file.
*/
#include "build_salvage.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static PetscBool IsSameFile(const char a[], const char b[])
{
  struct stat one, other;

  return (PetscBool)(!stat(a, &one) && !stat(b, &other) && one.st_dev == other.st_dev && one.st_ino == other.st_ino);
}

/* A run that was killed in between has left the name. */
static PetscErrorCode NameDamaged(const char path[], const char damaged[])
{
  PetscFunctionBeginUser;
  if (!link(path, damaged)) PetscFunctionReturn(0);
  PetscCheck(errno == EEXIST, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", damaged, strerror(errno));
  PetscCheck(IsSameFile(path, damaged), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; the damaged %s would be kept there: rename it or remove it", damaged, path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildSalvage(const LamScene *scene, LamGrid grid, const char path[], void (*tell)(const char words[]),
                               LamMergeReport *report)
{
  char damaged[PETSC_MAX_PATH_LEN], *real = realpath(path, NULL), *text;
  const char *const files[] = {damaged};
  LamMergeOptions options = {.salvage = PETSC_TRUE, .scene = scene, .stop = LamStopRequested, .tell = tell};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCheck(real && snprintf(damaged, sizeof(damaged), "%s.damaged", real) < (int)sizeof(damaged), PETSC_COMM_SELF,
             PETSC_ERR_FILE_OPEN, "%s: %s", path, real ? "the path is too long" : strerror(errno));
  PetscCall(LamGridGetText(grid, &text));
  options.grid = text;
  PetscCall(NameDamaged(real, damaged));
  ierr = LamDatabaseMerge(real, 1, files, &options, report);
  if (IsSameFile(real, damaged)) unlink(damaged); /* nothing was made */
  PetscCall(PetscFree(text));
  free(real);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
