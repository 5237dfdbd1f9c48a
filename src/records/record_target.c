/*
  The file that a writer creates or continues. A new file may only replace one of the same kind, which is lost at the
  first commit.
*/
#include "record_internal.h"
#include <string.h>
#include <sys/stat.h>

/* Whatever the reason why a file cannot be read, it must not be replaced. */
static PetscErrorCode CheckReplaceable(const char path[], const char kind[])
{
  char present[LAM_NAME_LENGTH] = "";
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = LamFileReadKind(path, present);
  PetscCall(PetscPopErrorHandler());
  PetscCheck(!ierr, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists and is not a file of lamella, or a damaged one; give another file name or remove it", path);
  PetscCheck(!strcmp(present, kind), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists and is of kind \"%s\", \"%s\" is to be written; give another file name or remove it", path,
             present, kind);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTargetFind(const char path[], const char kind[], LamWriteMode mode, char target[PETSC_MAX_PATH_LEN])
{
  struct stat status;
  const PetscBool exists = (PetscBool)!stat(path, &status);

  PetscFunctionBeginUser;
  PetscCheck(!exists || S_ISREG(status.st_mode), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists and is a %s; give another file name", path,
             S_ISDIR(status.st_mode) ? "folder" : "device, pipe or socket");
  PetscCheck(LamPathFollow(path, target) && strlen(target) + 8 < PETSC_MAX_PATH_LEN, PETSC_COMM_SELF,
             exists ? PETSC_ERR_FILE_OPEN : PETSC_ERR_USER_INPUT, "%s: %s", path,
             strlen(path) + 8 < PETSC_MAX_PATH_LEN ? "is a link that leads to no file; give another file name"
                                                   : "the path is too long");
  if (exists && status.st_size && mode == LAM_WRITE_CREATE) PetscCall(CheckReplaceable(target, kind));
  PetscFunctionReturn(0);
}
