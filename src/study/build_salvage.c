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

/* Links are followed: the new file takes the place of the old one, not of the link. */
static PetscErrorCode FindNames(const char path[], char real[PETSC_MAX_PATH_LEN], char damaged[PETSC_MAX_PATH_LEN])
{
  char *found = realpath(path, NULL);
  const int error = errno;
  PetscBool fits;

  PetscFunctionBeginUser;
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", path, strerror(error));
  snprintf(real, PETSC_MAX_PATH_LEN, "%s", found);
  fits = (PetscBool)(snprintf(damaged, PETSC_MAX_PATH_LEN, "%s.damaged", found) < PETSC_MAX_PATH_LEN);
  free(found);
  PetscCheck(fits, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: the path is too long", path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildSalvage(const LamScene *scene, LamGrid grid, const char path[], void (*tell)(const char words[]),
                               LamMergeReport *report)
{
  char real[PETSC_MAX_PATH_LEN], damaged[PETSC_MAX_PATH_LEN], *text;
  const char *const files[] = {damaged};
  LamMergeOptions options = {.salvage = PETSC_TRUE, .scene = scene, .stop = LamStopRequested, .tell = tell};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(FindNames(path, real, damaged));
  PetscCall(NameDamaged(real, damaged));
  PetscCall(LamGridGetText(grid, &text));
  options.grid = text;
  ierr = LamDatabaseMerge(real, 1, files, &options, report);
  if (IsSameFile(real, damaged)) unlink(damaged); /* nothing was made */
  PetscCall(PetscFree(text));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
