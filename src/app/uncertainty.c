/*
  lamella rve and lamella process --uncertainty: what is not known of a scene, carried through its prediction.
  python/lamella/uncertainty.py draws the samples and has the command solve them.
*/
#include "uncertainty.h"

PetscErrorCode LamUncertaintyRun(const LamUncertainty *u, const char scene[], const char folder[], PetscBool overwrite,
                                 PetscBool json, PetscBool quiet, int *exit_status)
{
  json_t *o =
      json_pack("{s:s, s:s, s:s*, s:i, s:b, s:b, s:b, s:b}", "command", u->command, "scene", scene, "output", folder,
                "samples", (int)u->count, "failure", u->failure, "overwrite", overwrite, "json", json, "quiet", quiet);

  PetscFunctionBeginUser;
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: a name is not in UTF-8", scene);
  if (u->processes) json_object_set_new(o, "processes", json_integer(u->processes));
  PetscCall(LamPythonRun(&LamPythonUncertainty, o, exit_status));
  PetscFunctionReturn(0);
}
