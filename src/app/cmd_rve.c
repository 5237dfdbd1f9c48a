/*
  lamella rve: solves the RVE along the scene's load.

  Each state starts from the last converged one, so the states are sequential and rank 0 solves them; further ranks help
  to factor the matrices of large RVEs, otherwise they wait.
*/
#include "app.h"
#include "rve_realisations.h"
#include "rve_run.h"
#include "uncertainty.h"
#include "clock.h"
#include <math.h>
#include <string.h>

typedef struct {
  LamConsole console; /* the reporter's ctx; first */
  const char *scene_path;
  PetscBool tangent;
  PetscBool told_smooth; /* that a state is of the smooth law of contact */
  LamRVERun run;
} Command;

/* ---- reports ---- */

/* In-plane entries; rows and columns 11, 12, 21, 22. */
static void PrintTangent(const LamResponse *response, PetscReal MPa)
{
  const PetscInt in_plane[4] = {0, 1, 3, 4};

  for (int i = 0; i < 4 && LamResponseHasFields(response); i++) {
    printf("%*s", 13, i ? "" : "dP/dF, MPa:");
    for (int j = 0; j < 4; j++) printf(" %13.6e", (double)(response->tangent[9 * in_plane[i] + in_plane[j]] * MPa));
    putchar('\n');
  }
}

/* Prints separation and error estimate from the second mesh. */
static void PrintSecondMesh(const LamResponse responses[2])
{
  const LamSeparation separation = LamSeparationOf(responses);

  if (!LamResponseHasFields(&responses[0])) return;
  if (separation == LAM_SEPARATION_UNKNOWN) {
    printf("      second mesh: %s: %s\n", LamStatusNames[responses[1].status], responses[1].reason);
    return;
  }
  printf("      second mesh: P differs by %.2g %%, debonded by %.2g, open by %.2g; ",
         (double)(100 * responses[0].error_estimate), (double)responses[0].debonded_spread,
         (double)responses[0].open_spread);
  if (separation == LAM_SEPARATION_NONE)
    printf("not separated\n");
  else
    printf("separated (%s)\n", LamSeparationNames[separation]);
}

static void SetSecondMesh(json_t *object, const LamResponse responses[2])
{
  const LamSeparation separation = LamSeparationOf(responses);

  json_object_set_new(object, "separated",
                      separation == LAM_SEPARATION_UNKNOWN ? json_null()
                                                           : json_boolean(separation != LAM_SEPARATION_NONE));
  if (!LamResponseHasFields(&responses[1]))
    json_object_set_new(object, "second_mesh_reason", json_string(responses[1].reason));
}

/* The prescribed components of P; null where F is prescribed. */
static void SetPrescribed(json_t *object, const LamStressControl *control, PetscReal MPa)
{
  PetscReal P[9];
  PetscBool any = PETSC_FALSE;

  for (int i = 0; i < 9 && control; i++) {
    P[i] = control->given[i] ? control->P[i] : NAN;
    if (control->given[i]) any = PETSC_TRUE;
  }
  if (any) json_object_set_new(object, "P_prescribed", LamJSONReals(9, P, MPa));
}

/* For a period of several cells: whether the pattern has that period or the one of a single cell. */
static PetscErrorCode SetCellDifference(json_t *object, const LamRVERun *run, const LamResponse *response)
{
  const LamMicrostructure *micro = &run->scene->micro;
  PetscReal difference;

  PetscFunctionBeginUser;
  if (micro->tissue || micro->is_patch || micro->cells[0] * micro->cells[1] == 1 || !LamResponseHasFields(response))
    PetscFunctionReturn(0);
  PetscCall(LamRVEGetCellDifference(run->meshes.rve[0], run->meshes.state[0], &difference));
  json_object_set_new(object, "cell_difference", json_real(difference));
  PetscFunctionReturn(0);
}

static void SetFromInflated(json_t *object, const LamRVERun *run, const LamResponse *response)
{
  PetscReal F[9], P[9];

  if (!run->scene->inflate || !LamResponseHasFields(response)) return;
  LamTestMeasures(&run->test, response, F, P);
  json_object_set_new(object, "from_inflated", LamFromInflatedToJSON(F, P, &run->scene->scales));
}

/* The time of a state, on which walls with memory depend, and what they have dissipated. */
static void PrintTime(const LamRVERun *run, const LamResponse *response)
{
  const PetscReal energy = run->scene->scales.stress * 1e-3;

  if (!LamWallsRelax(&run->scene->micro) || !LamAppIsRoot()) return;
  printf("      at %.6g s", (double)run->time);
  if (LamResponseHasFields(response))
    printf(": stored %.4g, dissipated %.4g kJ/m^3", (double)(response->stored * energy),
           (double)(response->dissipated * energy));
  putchar('\n');
}

static PetscErrorCode PrintObject(const Command *command, const LamRVERun *run, const LamResponse responses[2])
{
  const LamScales *scales = &run->scene->scales;
  json_t *object;

  PetscFunctionBeginUser;
  PetscCall(LamResponseToJSON(&responses[0], scales, run->solved, command->tangent, &object));
  if (LamWallsRelax(&run->scene->micro)) json_object_set_new(object, "time", json_real((double)run->time));
  SetPrescribed(object, LamRVERunControl(run, run->solved), scales->stress * 1e-6);
  SetFromInflated(object, run, &responses[0]);
  PetscCall(SetCellDifference(object, run, &responses[0]));
  if (run->second_mesh) SetSecondMesh(object, responses);
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

/* The first state of the smooth law, unless the scene asks for that law. */
static void TellSmoothLaw(const LamRVERun *run, const LamResponse *response, Command *command)
{
  if (command->told_smooth || !(response->contact_width > 0) || run->scene->micro.sharpness == LAM_SHARPNESS_SMOOTH)
    return;
  command->told_smooth = PETSC_TRUE;
  if (LamAppIsRoot())
    printf("      by the smooth law of contact, width %.3g of the apothem; of further states contact_width tells\n",
           (double)response->contact_width);
}

/* `state` of a LamRVERun; ctx: a Command. */
static PetscErrorCode Report(void *ctx, const LamRVERun *run, const LamResponse responses[2])
{
  Command *command = (Command *)ctx;
  const LamScales *scales = &run->scene->scales;
  LamResponse shown = responses[0];

  PetscFunctionBeginUser;
  if (command->console.json) {
    PetscCall(PrintObject(command, run, responses));
    PetscFunctionReturn(0);
  }
  if (run->scene->inflate) LamTestMeasures(&run->test, &responses[0], shown.load.F, shown.P);
  PetscCall(LamPrintResponseRow(&shown, scales, run->scene->micro.interface, run->solved));
  PrintTime(run, &shown);
  TellSmoothLaw(run, &shown, command);
  if (run->second_mesh) PrintSecondMesh(responses);
  if (run->find_failure) LamFailurePrintState(&responses[0], &run->scene->strength, scales);
  if (command->tangent) PrintTangent(&responses[0], scales->stress * 1e-6);
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintCrackObject(const LamCrack *crack, PetscReal um, PetscReal energy, PetscReal toughness,
                                       PetscReal MPa)
{
  PetscFunctionBeginUser;
  PetscCall(LamPrintJSON(
      json_pack("{s:{s:i, s:i, s:i, s:o, s:o, s:o, s:o}}", "crack", "begins", (int)crack->begins, "last",
                (int)crack->last, "faces", (int)crack->faces, "length", LamJSONReal(crack->length[1] * um),
                "resistance", LamJSONReal(crack->resistance * energy), "modulus", LamJSONReal(crack->modulus * MPa),
                "toughness", LamJSONReal(crack->toughness * toughness))));
  PetscFunctionReturn(0);
}

/* um, J/m^2, kPa m^(1/2) and MPa. */
static PetscErrorCode PrintCrack(const LamRVERun *run, PetscBool json)
{
  const LamScales *scales = &run->scene->scales;
  const PetscReal um = scales->length * 1e6, energy = scales->stress * scales->length, MPa = scales->stress * 1e-6;
  const PetscReal toughness = scales->stress * 1e-3 * sqrt(scales->length);
  const LamCrack *crack = &run->crack;

  PetscFunctionBeginUser;
  if (!run->scene->micro.notch_columns) PetscFunctionReturn(0);
  if (json) {
    PetscCall(PrintCrackObject(crack, um, energy, toughness, MPa));
    PetscFunctionReturn(0);
  }
  if (!crack->begins) {
    printf("crack: it has not grown from the notch\n");
    PetscFunctionReturn(0);
  }
  printf("crack: grows from the notch from state %d on (F22 %.4f, P22 %.4g MPa); %.4g um along %d faces by state %d "
         "(F22 %.4f)\n",
         (int)crack->begins, (double)crack->F22[0], (double)(crack->P22[0] * MPa), (double)(crack->length[1] * um),
         (int)crack->faces, (int)crack->last, (double)crack->F22[1]);
  if (isfinite(crack->resistance))
    printf("  resistance: %.4g J/m^2 dissipated per area of growth\n", (double)(crack->resistance * energy));
  if (isfinite(crack->toughness))
    printf("  toughness: K = %.4g kPa m^(1/2), of linear elastic tissue with a modulus of %.4g MPa in plane strain\n",
           (double)(crack->toughness * toughness), (double)(crack->modulus * MPa));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportEnd(const Command *command)
{
  const LamRVERun *run = &command->run;
  const PetscBool json = command->console.json;

  PetscFunctionBeginUser;
  if (run->find_onset) PetscCall(LamOnsetPrint(&run->onset, &run->scene->scales, json));
  if (run->find_failure) PetscCall(LamFailurePrint(&run->failure, &run->scene->scales, json));
  if (run->readings) PetscCall(LamTestPrint(&run->test, &command->console.test, json));
  PetscCall(PrintCrack(run, json));
  if (json) PetscFunctionReturn(0);
  printf("%" PetscInt_FMT " of %" PetscInt_FMT " states solved, %" PetscInt_FMT " failed, %.3g s\n",
         run->solved - run->failed, run->scene->load_count, run->failed, LamClock() - run->start);
  if (run->out_path) printf("wrote %s\n", run->out_path);
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

static int ExitStatus(const LamRVERun *run)
{
  if (LamStopRequested()) return LamStopExitStatus();
  if (run->failed || LamOnsetIsUnsolved(&run->onset)) return LAM_EXIT_UNSOLVED;
  return run->failure.mode == LAM_FAILURE_UNKNOWN ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
}

/* Whether states can be looked for from other starts, if that is asked for; otherwise sets the exit status. */
static PetscBool GlobalFits(const Command *command, int *exit_status)
{
  const LamRVERun *run = &command->run;

  if (!run->global) return PETSC_TRUE;
  if (!LamCellsPart(run->scene->micro.interface))
    return LamUsageError("rve", exit_status, "--global: %s is bonded; leave it out, or write law: contact",
                         command->scene_path);
  if (run->second_mesh || run->find_failure)
    return LamUsageError("rve", exit_status, "--global does not go with a second mesh; ask for one of the two");
  if (run->scene->controls)
    return LamUsageError("rve", exit_status, "--global: %s prescribes stress; leave it out, or prescribe all of F",
                         command->scene_path);
  return PETSC_TRUE;
}

/* Strengths judge nothing without --failure, unless walls tear at theirs. */
static void NoteStrength(const LamRVERun *run)
{
  const LamStrength *s = &run->scene->strength;
  const PetscBool given = (PetscBool)(isfinite(s->wall) || isfinite(s->lamella_normal) || isfinite(s->lamella_shear));

  if (given && !run->find_failure && !LamWallsTear(&run->scene->micro))
    LamReportNote(&run->reporter, "%s: strength: is not used without --failure, which says how the tissue fails first",
                  run->scene->path);
}

static PetscErrorCode RunOnRoot(Command *command, int *exit_status)
{
  LamRVERun *run = &command->run;
  LamConsole *console = &command->console;

  PetscFunctionBeginUser;
  run->reporter = LamConsoleReporter(console);
  run->state = Report;
  run->start = LamClock();
  run->derivatives = command->tangent;
  run->walls = console->json;
  PetscCall(LamSceneRead(command->scene_path, &run->scene));
  NoteStrength(run);
  if (!GlobalFits(command, exit_status)) {
    PetscCall(LamRVERunDestroy(run));
    PetscFunctionReturn(0);
  }
  if (!run->second_mesh || LamCellsPart(run->scene->micro.interface) ||
      LamUsageError("rve", exit_status,
                    "%s: the cells of %s are bonded and never separate; leave it out, or write law: contact",
                    run->find_onset ? "--onset" : "--second-mesh", command->scene_path)) {
    PetscCall(LamRVERunPrepare(run));
    if (!console->json) PetscCall(LamPrintResponseHeader(run->scene->micro.interface, LAM_SOURCE_SOLVE));
    PetscCall(LamRVERunSolve(run));
    LamConsoleClear();
    PetscCall(ReportEnd(command));
    LamTellStopped(console, run->out_path, PETSC_FALSE);
    *exit_status = ExitStatus(run);
  }
  PetscCall(LamRVERunDestroy(run));
  PetscFunctionReturn(0);
}

/* The name of an option that is given and does not go with realisations or samples; NULL: there is none. */
static const char *NotOfStudies(const Command *command)
{
  const LamRVERun *run = &command->run;

  return command->tangent                   ? "tangent"
         : run->find_onset                  ? "onset"
         : run->second_mesh                 ? "second-mesh"
         : run->global                      ? "global"
         : run->no_estimate                 ? "no-estimate"
         : run->monitor                     ? "monitor"
         : command->console.test.readings   ? "readings"
         : command->console.test.at != NULL ? "at"
                                            : NULL;
}

/* Whether the options of studies fit together and with the others; otherwise says what does not. */
static PetscBool StudiesFit(const Command *command, const LamRealisations *realisations,
                            const LamUncertainty *uncertainty, int *exit_status)
{
  const char *unused = NotOfStudies(command);

  if (realisations->processes && !realisations->count && !uncertainty->count)
    return LamUsageError("rve", exit_status,
                         "--processes is of --realisations N or --uncertainty N, which are missing");
  if (!LamRealisationsFit(realisations, !unused && command->run.find_failure ? "failure" : unused, exit_status))
    return PETSC_FALSE;
  return (
      PetscBool)(!uncertainty->count ||
                 LamPythonStudyFits("rve", "uncertainty", realisations->count ? "realisations" : unused, exit_status));
}

static PetscErrorCode RunStudy(const Command *command, const LamRealisations *realisations, LamUncertainty *uncertainty,
                               int *exit_status)
{
  const LamConsole *console = &command->console;

  PetscFunctionBeginUser;
  uncertainty->processes = realisations->processes;
  uncertainty->failure = command->run.find_failure;
  if (uncertainty->count)
    PetscCall(LamUncertaintyRun(uncertainty, command->scene_path, command->run.out_path, command->run.overwrite,
                                console->json, console->quiet, exit_status));
  else
    PetscCall(LamRealisationsRun(realisations, command->scene_path, command->run.out_path, command->run.overwrite,
                                 console->json, console->quiet, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandRVE(LamArgs *args, int *exit_status)
{
  Command command = {.console.command = "rve"};
  LamRVERun *run = &command.run;
  LamRealisations realisations = {.count = 0};
  LamUncertainty uncertainty = {.command = "rve"};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5",
       "states and fields, for plot and query, with OUT.xdmf (for ParaView) and OUT.csv (a table) beside it",
       &run->out_path},
      LAM_OVERWRITE_OPTION(run->overwrite),
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per state on stdout", &command.console.json},
      {0, "tangent", LAM_OPTION_FLAG, NULL, "the effective tangent too", &command.tangent},
      {0, "second-mesh", LAM_OPTION_FLAG, NULL,
       "solve contact tissue on a mesh with twice the elements along a face, too: errors, and whether cells separate",
       &run->second_mesh},
      {0, "onset", LAM_OPTION_FLAG, NULL,
       "find where along the load the cells begin to separate, on two meshes (includes --second-mesh)",
       &run->find_onset},
      {0, "failure", LAM_OPTION_FLAG, NULL,
       "what walls and lamella bear, and how the tissue fails first along the load (contact: includes --second-mesh)",
       &run->find_failure},
      {0, "global", LAM_OPTION_FLAG, NULL,
       "contact: start each state from the undeformed tissue, too, and take that of lowest energy", &run->global},
      LAM_TEST_OPTIONS(command.console.test, " (always where the load begins with inflate)"),
      {0, "no-estimate", LAM_OPTION_FLAG, NULL,
       "no estimate of the error: saves three quarters of the time of bonded tissue, half in contact",
       &run->no_estimate},
      {0, "realisations", LAM_OPTION_FROM_2, "N",
       "how large a period must be: solve N tissues like the scene's, which lamella tissue has made; -o is a folder",
       &realisations.count},
      {0, "cells", LAM_OPTION_TEXT, "N,...", "cells in a period of the realisations (default: the scene's tissue)",
       &realisations.cells},
      LAM_UNCERTAINTY_OPTION(uncertainty),
      {0, "processes", LAM_OPTION_FROM_1, "N", "realisations or samples at a time (default: as many as processors)",
       &realisations.processes},
      {0, "monitor", LAM_OPTION_FLAG, NULL, "each Newton iteration on stderr", &run->monitor},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &command.console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(
      args,
      "rve SCENE [-o OUT.h5] [--overwrite] [--json] [--tangent] [--second-mesh] [--onset] [--failure]\n"
      "           [--readings] [--at STRAIN,...] [--global] [--no-estimate] [--monitor] [--quiet]\n"
      "       lamella rve SCENE --realisations N [--cells N,...] [--processes N] [-o FOLDER]\n"
      "           [--overwrite] [--json] [--quiet]\n"
      "       lamella rve SCENE --uncertainty N [--failure] [--processes N] [-o FOLDER] [--overwrite] [--json]\n"
      "           [--quiet]",
      "Solves the representative volume element along the scene's load.", options, 1, &command.scene_path, &done,
      exit_status));
  if (done || !StudiesFit(&command, &realisations, &uncertainty, exit_status)) PetscFunctionReturn(0);
  if (realisations.count || uncertainty.count) {
    PetscCall(RunStudy(&command, &realisations, &uncertainty, exit_status));
    PetscFunctionReturn(0);
  }
  if (!LamTestReadOptions("rve", &command.console.test, exit_status) ||
      !LamOutputIsHDF5("rve", run->out_path, exit_status))
    PetscFunctionReturn(0);
  run->readings = command.console.test.readings;
  if (run->find_onset) run->second_mesh = PETSC_TRUE;
  PetscCall(args->start(args));
  if (LamAppIsRoot()) {
    const PetscErrorCode ierr = RunOnRoot(&command, exit_status);

    PetscCall(LamRVEDismiss(PETSC_COMM_WORLD));
    PetscCall(ierr);
  } else {
    PetscCall(LamRVEServe(PETSC_COMM_WORLD, LamStopInterrupt, NULL));
  }
  PetscFunctionReturn(0);
}
