/*
  lamella plot: a picture of a file's contents.
*/
#include "app.h"
#include "plot_slice.h"
#include <stdio.h>
#include <string.h>

static const struct {
  const char *kind;
  PetscErrorCode (*plot)(const LamPlotRequest *request);
  const char *(*field)(size_t i); /* NULL beyond the last */
} Plots[] = {{"rve", LamPlotRVE, LamPlotRVEField},
             {"fe2", LamPlotFE2, LamPlotFE2Field},
             {"database", LamPlotDatabase, LamPlotDatabaseField},
             {"map", LamPlotMap, LamPlotMapField},
             {"process", LamPlotProcess, LamPlotRVEField}};

void LamPlotVisitFields(void (*visit)(void *ctx, const char name[]), void *ctx)
{
  for (size_t p = 0; p < PETSC_STATIC_ARRAY_LENGTH(Plots); p++) {
    const char *name;

    for (size_t i = 0; (name = Plots[p].field(i)); i++) visit(ctx, name);
  }
}

/* Replaces FILE.h5 by FILE.png. */
static PetscErrorCode DefaultOutput(const char input[], size_t size, char output[])
{
  size_t length = strlen(input);

  PetscFunctionBeginUser;
  if (length > 3 && !strcmp(input + length - 3, ".h5")) length -= 3;
  PetscCheck(length + 5 <= size, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the name is too long", input);
  memcpy(output, input, length);
  memcpy(output + length, ".png", 5);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandPlot(LamArgs *args, int *exit_status)
{
  LamConsole console = {.command = "plot"};
  LamPlotRequest request = {.state = LAM_PLOT_PEAK, .reporter = LamConsoleReporter(&console)};
  const char *input;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "FIG.png|.svg|.pdf", "the picture (default: FILE.png)", &request.output},
      {0, "state", LAM_OPTION_STATE, "N|last", "state of an RVE file, step of an fe2 file (default: at the peak load)",
       &request.state},
      {0, "field", LAM_OPTION_TEXT, "NAME", "field that gives the colours (docs/reference/pictures.md lists them)",
       &request.field},
      {0, "strip", LAM_OPTION_FLAG, NULL, "up to eight states beside each other, with one colour scale",
       &request.strip},
      {0, "film", LAM_OPTION_FLAG, NULL,
       "of a process: a page (PDF) or a numbered file for each state whose cells, or body, the file has",
       &request.film},
      {0, "map", LAM_OPTION_TEXT, "MAP.h5", "of a process: its way over this map of failure", &request.map},
      {0, "angle", LAM_OPTION_TEXT, "ANGLE",
       "slice through a table: first principal axis to the normal of face 0, \"15 deg\" (default: 0)", &request.angle},
      {0, "suction", LAM_OPTION_TEXT, "PRESSURE",
       "slice of contact tissue: turgor + cohesion, \"0.02 MPa\" (default: in the middle)", &request.suction},
      {0, "turgor", LAM_OPTION_TEXT, "PRESSURE", "slice of bonded tissue, \"0.02 MPa\" (default: that of the nodes)",
       &request.turgor},
      {0, "accuracy", LAM_OPTION_ACCURACY, "SHARE", "slice: the error that is asked for (default: that of the file)",
       &request.accuracy},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL}};
  char kind[LAM_NAME_LENGTH], name[PETSC_MAX_PATH_LEN];
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "plot FILE.h5 [-o FIG.png|.svg|.pdf] [--state N|last | --strip] [--field NAME] [--film]\n"
                            "                    [--map MAP.h5] [--angle ANGLE] [--suction PRESSURE | --turgor "
                            "PRESSURE] [--accuracy SHARE] [--quiet]",
                            "Draws what the file holds.", options, 1, &input, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!request.output) {
    PetscCall(DefaultOutput(input, sizeof name, name));
    request.output = name;
  }
  PetscCall(LamCanvasCheckPath(request.output));
  request.input = input;
  PetscCall(LamFileReadKind(input, kind));
  if (strcmp(kind, "database")) PetscCall(LamSliceRefuse(&request));
  PetscCheck(!request.strip || !strcmp(kind, "rve") || !strcmp(kind, "fe2") || !strcmp(kind, "process"),
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of kind \"%s\"; --strip draws files of rve, fe2 and process", input, kind);
  PetscCheck(!strcmp(kind, "process") || ((!request.film || !strcmp(kind, "fe2")) && !request.map), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "%s: is of kind \"%s\"; --film and --map draw files of process", input, kind);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Plots); i++) {
    if (strcmp(kind, Plots[i].kind)) continue;
    PetscCall(Plots[i].plot(&request));
    LamConsoleClear(&console);
    printf("wrote %s\n", request.output);
    *exit_status = LAM_EXIT_OK;
    PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
          "%s: is of kind \"%s\"; plot draws rve, fe2, database, map and process files", input, kind);
}
