/*
  lamella tissue: a file of irregular cells with given statistics. The package in python/lamella/tissue makes them.
*/
#include "app.h"

typedef struct {
  const char *output, *size, *variation, *elongation, *direction, *aspect, *wall_thickness, *gas;
  PetscInt cells, seed;
  PetscBool overwrite, json;
} Request;

static PetscErrorCode Make(const Request *r, int *exit_status)
{
  /* members whose value is NULL are left out */
  json_t *o = json_pack("{s:s, s:s, s:i, s:i, s:b, s:b, s:s*, s:s*, s:s*, s:s*, s:s*, s:s*}", "output", r->output,
                        "size", r->size, "cells", (int)r->cells, "seed", (int)r->seed, "overwrite", r->overwrite,
                        "json", r->json, "variation", r->variation, "elongation", r->elongation, "direction",
                        r->direction, "aspect", r->aspect, "wall_thickness", r->wall_thickness, "gas", r->gas);

  PetscFunctionBeginUser;
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "an argument is not in UTF-8");
  PetscCall(LamPythonRun(&LamPythonTissue, o, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandTissue(LamArgs *args, int *exit_status)
{
  Request r = {.output = NULL};
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "OUT.json", "the tissue", &r.output},
      LAM_OVERWRITE_OPTION(r.overwrite),
      {0, "cells", LAM_OPTION_FROM_1, "N", "number of cells in a period", &r.cells},
      {0, "size", LAM_OPTION_TEXT, "LENGTH", "diameter of a circle of the cells' mean area, \"150 um\"", &r.size},
      {0, "variation", LAM_OPTION_TEXT, "SHARE",
       "standard deviation of the cells' area over its mean, 0 to 0.5 (default: 0)", &r.variation},
      {0, "elongation", LAM_OPTION_TEXT, "RATIO", "length of cells over their width, 1 to 3 (default: 1)",
       &r.elongation},
      {0, "direction", LAM_OPTION_TEXT, "ANGLE", "of the length, from X1, \"30 deg\" (default: 0)", &r.direction},
      {0, "aspect", LAM_OPTION_TEXT, "RATIO", "width of the period over its height (default: 1)", &r.aspect},
      {0, "wall-thickness", LAM_OPTION_TEXT, "LENGTH", "of one cell's wall (default: the scene's)", &r.wall_thickness},
      {0, "gas", LAM_OPTION_TEXT, "SHARE", "of air in the volume, 0 to 0.3 (default: 0)", &r.gas},
      {0, "seed", LAM_OPTION_FROM_0, "N", "another one gives other cells (default: 0)", &r.seed},
      {0, "json", LAM_OPTION_FLAG, NULL, "what was asked and what the tissue is, as JSON", &r.json},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL}};
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "tissue -o OUT.json --cells N --size LENGTH [--variation SHARE] [--elongation RATIO]\n"
                            "                      [--direction ANGLE] [--aspect RATIO] [--wall-thickness LENGTH] "
                            "[--gas SHARE]\n"
                            "                      [--seed N] [--overwrite] [--json]",
                            "Makes a file of irregular cells with these statistics, with Python and its package scipy.",
                            options, 0, NULL, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!r.output || !r.cells || !r.size)
    (void)LamUsageError("tissue", exit_status, "-o OUT.json, --cells N and --size LENGTH are wanted: %s is missing",
                        !r.output  ? "the first"
                        : !r.cells ? "the second"
                                   : "the third");
  else if (r.direction && !r.elongation)
    (void)LamUsageError("tissue", exit_status,
                        "--direction: is of --elongation RATIO, which is missing: cells as wide as long have none");
  else
    PetscCall(Make(&r, exit_status));
  PetscFunctionReturn(0);
}
