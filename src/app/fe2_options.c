/*
  Options of `fe2` and `process`, and conflicts between them.
*/
#include "app.h"
#include "fe2_report.h"
#include <string.h>

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

PetscBool LamFE2CheckPaths(const char command[], const LamFE2Run *run, int *exit_status)
{
  if (!LamOutputIsHDF5(command, run->out_path, exit_status)) return PETSC_FALSE;
  if (run->out_path && run->database_path && LamTargetIsSame(run->out_path, run->database_path))
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

    if (tissue->database_path[0] && LamTargetIsSame(run->out_path, tissue->database_path))
      return LamUsageError(command, exit_status, "-o %s is the database of %s; the results would replace it",
                           run->out_path, tissue->name[0] ? tissue->name : "-d");
  }
  return PETSC_TRUE;
}
