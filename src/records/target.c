/*
  What may stand under the name of a file that a command writes.
*/
#include "target.h"
#include "disk.h"
#include "record_internal.h"
#include <errno.h>
#include <fnmatch.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TEXT_READ = 1 << 16, COLUMN_LENGTH = 256 };

/* ---- paths ---- */

PetscErrorCode LamTargetBeside(const char hdf5[], const char ending[], char path[PETSC_MAX_PATH_LEN])
{
  const char *dot = strrchr(hdf5, '.');
  int stem = (int)strlen(hdf5);

  PetscFunctionBeginUser;
  if (dot && ending[0] && (!strcmp(dot, ".h5") || !strcmp(dot, ".hdf5"))) stem = (int)(dot - hdf5);
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%.*s%s", stem, hdf5, ending));
  PetscFunctionReturn(0);
}

/* The folder of a file, with "/." behind it. */
static void FolderOf(const char path[], char folder[PETSC_MAX_PATH_LEN])
{
  const char *slash = strrchr(path, '/');

  snprintf(folder, PETSC_MAX_PATH_LEN, "%.*s/.", slash ? (int)(slash - path) : 1, slash ? path : ".");
}

PetscBool LamTargetIsSame(const char a[], const char b[])
{
  const char *const paths[2] = {a, b}, *names[2];
  char folder[PETSC_MAX_PATH_LEN];
  struct stat s[2];

  if (!stat(a, &s[0]) && !stat(b, &s[1])) return (PetscBool)(s[0].st_dev == s[1].st_dev && s[0].st_ino == s[1].st_ino);
  for (int i = 0; i < 2; i++) {
    const char *slash = strrchr(paths[i], '/');

    FolderOf(paths[i], folder);
    if (stat(folder, &s[i])) return PETSC_FALSE;
    names[i] = slash ? slash + 1 : paths[i];
  }
  return (PetscBool)(!strcmp(names[0], names[1]) && s[0].st_dev == s[1].st_dev && s[0].st_ino == s[1].st_ino);
}

static PetscErrorCode CheckNoInput(const char path[], const LamScene *scene)
{
  PetscBool input;

  PetscFunctionBeginUser;
  input = LamTargetIsSame(path, scene->path);
  for (PetscInt k = 0; k < scene->file_count; k++)
    if (LamTargetIsSame(path, scene->files[k].path)) input = PETSC_TRUE;
  PetscCheck(!input, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is an input of this command, and would be replaced by its output; give another file name", path);
  PetscFunctionReturn(0);
}

/* A file that is there may be replaced by another, and so its folder must take new files. */
static PetscErrorCode CheckFolder(const char path[])
{
  char folder[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  FolderOf(path, folder);
  PetscCheck(!access(folder, W_OK | X_OK), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: cannot be made: %s%s", path,
             strerror(errno), errno == ENOENT ? "; make the folder first" : "");
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckPlain(const char path[], PetscBool *has_content)
{
  struct stat status;
  const PetscBool exists = (PetscBool)!stat(path, &status);

  PetscFunctionBeginUser;
  PetscCheck(!exists || S_ISREG(status.st_mode), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists and is a %s; give another file name", path,
             S_ISDIR(status.st_mode) ? "folder" : "device, pipe or socket");
  *has_content = (PetscBool)(exists && status.st_size > 0);
  PetscFunctionReturn(0);
}

/* ---- HDF5 files ---- */

/* Whatever the reason why a file cannot be read, it must not be replaced. */
static PetscErrorCode CheckKind(const char path[], const char kind[])
{
  char present[LAM_NAME_LENGTH] = "";
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = LamFileReadKind(path, present);
  PetscCall(PetscPopErrorHandler());
  PetscCheck(!ierr, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists and is not a file of lamella, or a damaged one; give another file name, or --overwrite", path);
  PetscCheck(!strcmp(present, kind), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists and is of kind \"%s\", \"%s\" is to be written; give another file name, or --overwrite", path,
             present, kind);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTargetFind(const char path[], const char kind[], LamWriteMode mode, char target[PETSC_MAX_PATH_LEN])
{
  PetscBool has_content;

  PetscFunctionBeginUser;
  PetscCall(CheckPlain(path, &has_content));
  PetscCheck(LamPathFollow(path, target) && strlen(target) + 8 < PETSC_MAX_PATH_LEN, PETSC_COMM_SELF,
             access(path, F_OK) ? PETSC_ERR_USER_INPUT : PETSC_ERR_FILE_OPEN, "%s: %s", path,
             strlen(path) + 8 < PETSC_MAX_PATH_LEN ? "is a link that leads to no file; give another file name"
                                                   : "the path is too long");
  if (has_content && mode == LAM_WRITE_CREATE) PetscCall(CheckKind(target, kind));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTargetCheck(const char path[], const char kind[], PetscBool overwrite, const LamScene *scene)
{
  char target[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(CheckNoInput(path, scene));
  PetscCall(LamTargetFind(path, kind, LamTargetMode(overwrite), target));
  PetscCall(CheckFolder(target));
  PetscFunctionReturn(0);
}

/* ---- texts ---- */

/* Whether a column of a table, of n letters, is one of a kind's. */
static PetscBool HasColumn(const LamTextKind *kind, const char column[], size_t n)
{
  char name[COLUMN_LENGTH];

  snprintf(name, sizeof(name), "%.*s", (int)n, column);
  for (const char *const *c = kind->columns; *c; c++)
    if (!fnmatch(*c, name, 0)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool IsHeadOf(const LamTextKind *kind, const char line[])
{
  const size_t n = strlen(kind->begins), ends = kind->ends ? strlen(kind->ends) : 0;
  const char *end = line + strlen(line) - ends;

  if (strncmp(line, kind->begins, n) || end < line + n || (ends && strcmp(end, kind->ends))) return PETSC_FALSE;
  for (line += n; line < end; line += strcspn(line, ",")) {
    if (*line++ != ',' || !HasColumn(kind, line, strcspn(line, ","))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Whether Lamella wrote the text. */
static PetscBool IsOf(const LamTextKind *kind, char text[])
{
  char *end = strchr(text, '\n');

  if (!kind->columns)
    return (PetscBool)(!fnmatch(kind->begins, text, 0) || (kind->before && !fnmatch(kind->before, text, 0)));
  if (!end) return PETSC_FALSE;
  *end = '\0';
  return IsHeadOf(kind, text);
}

static PetscErrorCode CheckTextKind(const char path[], const LamTextKind *kind)
{
  char *text;
  PetscBool ours;
  FILE *file = fopen(path, "rb");

  PetscFunctionBeginUser;
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: exists and cannot be read: %s; give another file name",
             path, strerror(errno));
  PetscCall(PetscMalloc1(TEXT_READ, &text));
  text[fread(text, 1, TEXT_READ - 1, file)] = '\0';
  fclose(file);
  ours = IsOf(kind, text);
  PetscCall(PetscFree(text));
  PetscCheck(ours, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists and is not %s, which is to be written there; give another file name, or --overwrite", path,
             kind->what);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTargetCheckText(const char hdf5[], const LamTextKind *kind, PetscBool overwrite,
                                  const LamScene *scene)
{
  char path[PETSC_MAX_PATH_LEN];
  PetscBool has_content;

  PetscFunctionBeginUser;
  PetscCall(LamTargetBeside(hdf5, kind->ending, path));
  PetscCall(CheckNoInput(path, scene));
  PetscCall(CheckPlain(path, &has_content));
  PetscCall(CheckFolder(path));
  if (has_content && !overwrite) PetscCall(CheckTextKind(path, kind));
  PetscFunctionReturn(0);
}
