/*
  lamella validate: published measurements against what Lamella finds for them. python/lamella/validation has them.
*/
#include "app.h"

PetscErrorCode LamCommandValidate(LamArgs *args, int *exit_status)
{
  const char *output = NULL, *only = NULL;
  PetscBool list = PETSC_FALSE, overwrite = PETSC_FALSE, json = PETSC_FALSE, done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "FOLDER", "the page validation.md, and its picture", &output},
      LAM_OVERWRITE_OPTION(overwrite),
      {0, "only", LAM_OPTION_TEXT, "NAME,...", "experiments (default: all)", &only},
      {0, "list", LAM_OPTION_FLAG, NULL, "the names of the experiments, and nothing else", &list},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per experiment on stdout, and a summary", &json},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };
  json_t *o;

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "validate [-o FOLDER] [--only NAME,...] [--list] [--overwrite] [--json]",
                            "Solves published experiments and compares with what was measured.", options, 0, NULL,
                            &done, exit_status));
  if (done) PetscFunctionReturn(0);
  o = json_pack("{s:s*, s:s*, s:b, s:b, s:b}", "output", output, "only", only, "list", list, "overwrite", overwrite,
                "json", json);
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "an argument is not in UTF-8");
  PetscCall(LamPythonRun(&LamPythonValidate, o, exit_status));
  PetscFunctionReturn(0);
}
