/*
  lamella rve --realisations: how large a period must be. The package in python/lamella/tissue makes the tissues and has
  `lamella rve` solve them.
*/
#include <stdlib.h>
#include "rve_realisations.h"

/* Each realisation is a process of its own. */
static PetscBool IsUnderLauncher(void)
{
  const char *ranks = getenv("OMPI_COMM_WORLD_SIZE");

  return (PetscBool)(ranks && atoi(ranks) > 1);
}

PetscBool LamRealisationsFit(const LamRealisations *r, const char unused[], int *exit_status)
{
  if (!r->count && (r->cells || r->processes))
    return LamUsageError("rve", exit_status, "--%s is of --realisations N, which is missing",
                         r->cells ? "cells" : "processes");
  if (r->count && unused)
    return LamUsageError("rve", exit_status, "--%s does not go with --realisations; leave it out", unused);
  if (r->count && IsUnderLauncher())
    return LamUsageError("rve", exit_status, "--realisations has processes of its own (--processes): leave mpirun out");
  return PETSC_TRUE;
}

PetscErrorCode LamRealisationsRun(const LamRealisations *r, const char scene[], const char folder[], PetscBool json,
                                  PetscBool quiet, int *exit_status)
{
  json_t *o = json_pack("{s:s, s:s, s:i, s:b, s:b, s:s*}", "scene", scene, "output", folder ? folder : "realisations",
                        "realisations", (int)r->count, "json", json, "quiet", quiet, "cells", r->cells);

  PetscFunctionBeginUser;
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: a name is not in UTF-8", scene);
  if (r->processes) json_object_set_new(o, "processes", json_integer(r->processes));
  PetscCall(LamPythonRun(&LamPythonRealisations, o, exit_status));
  PetscFunctionReturn(0);
}
