/*
  lamella sensitivity: how figures of a scene's test depend on its uncertain keys. python/lamella/sensitivity.py finds
  it.
*/
#include "app.h"

typedef struct {
  const char *scene, *output, *figure;
  PetscInt evaluations, seed, processes;
  PetscBool overwrite, json;
} Request;

static PetscErrorCode Run(const Request *r, int *exit_status)
{
  json_t *o =
      json_pack("{s:s, s:s*, s:s*, s:i, s:i, s:b, s:b}", "scene", r->scene, "output", r->output, "figure", r->figure,
                "evaluations", (int)r->evaluations, "seed", (int)r->seed, "overwrite", r->overwrite, "json", r->json);

  PetscFunctionBeginUser;
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "an argument is not in UTF-8");
  if (r->processes) json_object_set_new(o, "processes", json_integer(r->processes));
  PetscCall(LamPythonRun(&LamPythonSensitivity, o, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandSensitivity(LamArgs *args, int *exit_status)
{
  Request r = {.evaluations = 1000};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "FOLDER", "sensitivity.json, for plot, and samples.csv", &r.output},
      LAM_OVERWRITE_OPTION(r.overwrite),
      {0, "evaluations", LAM_OPTION_FROM_1, "N", "about so many tests are solved (default: 1000)", &r.evaluations},
      {0, "figure", LAM_OPTION_TEXT, "NAME,...", "these alone, as modulus,peak.stress (default: all that there are)",
       &r.figure},
      {0, "seed", LAM_OPTION_FROM_0, "N", "another one draws other samples (default: 0)", &r.seed},
      {0, "processes", LAM_OPTION_FROM_1, "N", "tests at a time (default: as many as processors)", &r.processes},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &r.json},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "sensitivity SCENE [-o FOLDER] [--evaluations N] [--figure NAME,...] [--seed N]\n"
                            "                           [--processes N] [--overwrite] [--json]",
                            "Finds how figures of the scene's test depend on its uncertain keys.", options, 1, &r.scene,
                            &done, exit_status));
  if (!done) PetscCall(Run(&r, exit_status));
  PetscFunctionReturn(0);
}
