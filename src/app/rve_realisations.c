/*
  lamella rve --realisations: how large a period must be. The package in python/lamella/tissue makes the tissues and has
  `lamella rve` solve them.
*/
#include "rve_realisations.h"

PetscBool LamRealisationsFit(const LamRealisations *r, const char unused[], int *exit_status)
{
  if (!r->count && r->cells)
    return LamUsageError("rve", exit_status, "--cells is of --realisations N, which is missing");
  return (PetscBool)(!r->count || LamPythonStudyFits("rve", "realisations", unused, exit_status));
}

PetscErrorCode LamRealisationsRun(const LamRealisations *r, const char scene[], const char folder[],
                                  PetscBool overwrite, PetscBool json, PetscBool quiet, int *exit_status)
{
  json_t *o =
      json_pack("{s:s, s:s, s:i, s:b, s:b, s:b, s:s*}", "scene", scene, "output", folder ? folder : "realisations",
                "realisations", (int)r->count, "overwrite", overwrite, "json", json, "quiet", quiet, "cells", r->cells);

  PetscFunctionBeginUser;
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: a name is not in UTF-8", scene);
  if (r->processes) json_object_set_new(o, "processes", json_integer(r->processes));
  PetscCall(LamPythonRun(&LamPythonRealisations, o, exit_status));
  PetscFunctionReturn(0);
}
