/*
  lamella plot: a picture of what a file holds.
*/
#include "app.h"
#include "plot.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *kind;
  PetscErrorCode (*plot)(const LamPlotRequest *request);
} Plots[] = {{"rve", LamPlotRVE}, {"fe2", LamPlotFE2}, {"database", LamPlotDatabase}, {"map", LamPlotMap}};

/* FILE.h5 becomes FILE.png. */
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

static PetscErrorCode ParseState(const char text[], PetscInt *state)
{
  char *end;
  long value;

  PetscFunctionBeginUser;
  errno = 0;
  value = strtol(text, &end, 10);
  PetscCheck(*text && !*end && !errno && value >= 0 && value <= PETSC_MAX_INT, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--state %s: give the number of a state or step, 0 or above", text);
  *state = (PetscInt)value;
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandPlot(LamArgs *args, int *exit_status)
{
  const char *output = NULL, *state = NULL, *field = NULL, *input;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "FIG.png|.svg|.pdf", "the picture (default: FILE.png)", &output},
      {0, "state", LAM_OPTION_TEXT, "N", "state of an RVE file, step of an fe2 file (default: the last one)", &state},
      {0, "field", LAM_OPTION_TEXT, "NAME", "field that gives the colours (docs/pictures.md lists them)", &field},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL}};
  char kind[LAM_NAME_LENGTH], name[PETSC_MAX_PATH_LEN];
  LamPlotRequest request = {.state = -1};
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "plot FILE.h5 [-o FIG.png|.svg|.pdf] [--state N] [--field NAME]",
                            "Draws what the file holds.", options, 1, &input, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!output) {
    PetscCall(DefaultOutput(input, sizeof name, name));
    output = name;
  }
  PetscCall(LamCanvasCheckPath(output));
  if (state) PetscCall(ParseState(state, &request.state));
  request.input = input;
  request.output = output;
  request.field = field;
  PetscCall(LamFileReadKind(input, kind));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Plots); i++) {
    if (strcmp(kind, Plots[i].kind)) continue;
    PetscCall(Plots[i].plot(&request));
    printf("wrote %s\n", output);
    *exit_status = LAM_EXIT_OK;
    PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: is of kind \"%s\"; plot draws rve, fe2, database and map files",
          input, kind);
}
