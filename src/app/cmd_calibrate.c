/*
  lamella calibrate: values of keys with which scenes repeat what was measured. python/lamella/calibration.py finds
  them.
*/
#include "app.h"

typedef struct {
  const char *const *files; /* scene and data in turn, behind the last NULL */
  const char *output;
  PetscInt count, starts, processes;
  PetscBool profile, overwrite, json;
} Request;

static PetscErrorCode Calibrate(const Request *r, int *exit_status)
{
  json_t *files = json_array(), *o;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < r->count; k++) json_array_append_new(files, json_string(r->files[k]));
  o = json_pack("{s:o, s:s*, s:b, s:b, s:b}", "files", files, "output", r->output, "profile", r->profile, "overwrite",
                r->overwrite, "json", r->json);
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "an argument is not in UTF-8");
  if (r->starts) json_object_set_new(o, "starts", json_integer(r->starts));
  if (r->processes) json_object_set_new(o, "processes", json_integer(r->processes));
  PetscCall(LamPythonRun(&LamPythonCalibrate, o, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandCalibrate(LamArgs *args, int *exit_status)
{
  const char **names;
  Request r = {.output = NULL};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "FOLDER", "fit.json, for plot", &r.output},
      LAM_OVERWRITE_OPTION(r.overwrite),
      {0, "starts", LAM_OPTION_FROM_1, "N", "places from which the fit starts (default: 4)", &r.starts},
      {0, "profile", LAM_OPTION_FLAG, NULL,
       "intervals without a straight line in place of the model: for what is badly known", &r.profile},
      {0, "processes", LAM_OPTION_FROM_1, "N", "fits at a time (default: as many as processors)", &r.processes},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &r.json},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(args->argc + 1, &names));
  PetscCall(LamOptionsParse(args,
                            "calibrate SCENE DATA.csv [SCENE DATA.csv]... [-o FOLDER] [--starts N] [--profile]\n"
                            "                         [--processes N] [--overwrite] [--json]",
                            "Finds values of the scenes' uncertain keys from measured curves and figures.", options, -2,
                            names, &done, exit_status));
  r.files = names;
  while (!done && r.files[r.count]) r.count++;
  if (!done && r.count % 2)
    (void)LamUsageError("calibrate", exit_status, "a scene and its data are wanted in turn: %s has no data",
                        r.files[r.count - 1]);
  else if (!done)
    PetscCall(Calibrate(&r, exit_status));
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}
