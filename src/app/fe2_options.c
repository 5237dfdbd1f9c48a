/*
  Options of `fe2` and `process`, and conflicts between them.
*/
#include "app.h"
#include "fe2_report.h"
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

PetscBool LamFE2ChooseResponse(const char command[], const char name[], LamFE2Run *run, int *exit_status)
{
  run->response = run->database_path ? LAM_FE2_CACHE : LAM_FE2_DIRECT;
  for (int k = 0; k < 3 && name; k++) {
    if (strcmp(name, LamFE2ResponseNames[k])) continue;
    run->response = (LamFE2Response)k;
    name = NULL;
  }
  if (name)
    return LamUsageError(command, exit_status, "--response %s: unknown; there are direct, cache, database", name);
  if (run->response == LAM_FE2_DATABASE && !run->database_path)
    return LamUsageError(command, exit_status, "--response database needs a database; give -d DB.h5");
  if (run->response == LAM_FE2_DIRECT && run->database_path)
    return LamUsageError(command, exit_status,
                         "--response direct uses no database; leave out -d, or choose cache or database");
  return PETSC_TRUE;
}

/* Whether two paths name the same file. The file need not exist: then its folder is compared. */
static PetscBool SameFile(const char a[], const char b[])
{
  const char *const paths[2] = {a, b}, *names[2];
  char folder[PETSC_MAX_PATH_LEN];
  struct stat s[2];

  if (!stat(a, &s[0]) && !stat(b, &s[1])) return (PetscBool)(s[0].st_dev == s[1].st_dev && s[0].st_ino == s[1].st_ino);
  for (int i = 0; i < 2; i++) {
    const char *slash = strrchr(paths[i], '/');
    snprintf(folder, sizeof(folder), "%.*s/.", slash ? (int)(slash - paths[i]) : 1, slash ? paths[i] : ".");
    if (stat(folder, &s[i])) return PETSC_FALSE;
    names[i] = slash ? slash + 1 : paths[i];
  }
  return (PetscBool)(!strcmp(names[0], names[1]) && s[0].st_dev == s[1].st_dev && s[0].st_ino == s[1].st_ino);
}

PetscBool LamFE2CheckPaths(const char command[], const LamFE2Run *run, int *exit_status)
{
  const char *dot = run->out_path ? strrchr(run->out_path, '.') : NULL;

  if (dot && !strcmp(dot, ".xdmf"))
    return LamUsageError(command, exit_status,
                         "-o %s: name the HDF5 file, %.*s.h5; the .xdmf file is written beside it", run->out_path,
                         (int)(dot - run->out_path), run->out_path);
  if (run->out_path && run->database_path && SameFile(run->out_path, run->database_path))
    return LamUsageError(command, exit_status, "-o %s is the database of -d; the results would replace it",
                         run->out_path);
  if (run->resume && !run->out_path)
    return LamUsageError(command, exit_status, "--resume goes on with the results of a run; give -o OUT.h5, too");
  return PETSC_TRUE;
}

PetscBool LamFE2CheckTissuePaths(const char command[], const LamFE2Run *run, int *exit_status)
{
  for (PetscInt t = 0; run->out_path && t < run->tissues.count; t++) {
    const LamFE2Tissue *tissue = &run->tissues.tissues[t];

    if (tissue->database_path[0] && SameFile(run->out_path, tissue->database_path))
      return LamUsageError(command, exit_status, "-o %s is the database of %s; the results would replace it",
                           run->out_path, tissue->name[0] ? tissue->name : "-d");
  }
  return PETSC_TRUE;
}
