/*
  lamella fe2: the macroscale problem of a scene, its material answered by RVE solves, a database or both.
*/
#include "fe2_run.h"
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <lamella/clock.h>
#include <unistd.h>

/* Whether two paths name one file, which need not exist yet: then its folder counts. */
static PetscBool SameFile(const char a[], const char b[])
{
  const char *const paths[2] = {a, b}, *names[2];
  char folder[PETSC_MAX_PATH_LEN];
  struct stat s[2];

  if (!stat(a, &s[0]) && !stat(b, &s[1])) return (PetscBool)(s[0].st_dev == s[1].st_dev && s[0].st_ino == s[1].st_ino);
  for (int i = 0; i < 2; i++) {
    const char *slash = strrchr(paths[i], '/');
    snprintf(folder, sizeof(folder), "%.*s/.", slash ? (int)(slash - paths[i]) : 1, slash ? paths[i] : ".");
    if (stat(folder, &s[i])) return PETSC_FALSE;
    names[i] = slash ? slash + 1 : paths[i];
  }
  return (PetscBool)(!strcmp(names[0], names[1]) && s[0].st_dev == s[1].st_dev && s[0].st_ino == s[1].st_ino);
}

PetscBool LamFE2CheckPaths(const char command[], const LamFE2Run *run)
{
  const char *dot = run->out_path ? strrchr(run->out_path, '.') : NULL;

  if (dot && !strcmp(dot, ".xdmf"))
    fprintf(stderr, "lamella %s: -o %s: name the HDF5 file, %.*s.h5; the .xdmf file is written beside it\n", command,
            run->out_path, (int)(dot - run->out_path), run->out_path);
  else if (run->out_path && run->database_path && SameFile(run->out_path, run->database_path))
    fprintf(stderr, "lamella %s: -o %s is the database of -d; the results would replace it\n", command, run->out_path);
  else if (run->resume && !run->out_path)
    fprintf(stderr, "lamella fe2: --resume goes on with the results of a run; give -o OUT.h5, too\n");
  else
    return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool LamFE2CheckTissuePaths(const char command[], const LamFE2Run *run)
{
  const LamFE2Tissues *tissues = &run->tissues;

  for (PetscInt t = 0; run->out_path && t < tissues->count; t++) {
    const LamFE2Tissue *tissue = &tissues->tissues[t];

    if (!tissue->database_path[0] || !SameFile(run->out_path, tissue->database_path)) continue;
    if (LamAppIsRoot())
      fprintf(stderr, "lamella %s: -o %s is the database of %s; the results would replace it\n", command, run->out_path,
              tissue->name[0] ? tissue->name : "-d");
    return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Reads and checks everything; nothing is written before the responder stands, too. */
static PetscErrorCode Prepare(LamFE2Run *run, PetscBool *finished)
{
  PetscFunctionBeginUser;
  run->start = LamClock();
  PetscCall(LamSceneRead(run->scene_path, &run->scene));
  PetscCall(LamMacroCreate(run->comm, &run->macro));
  PetscCall(LamMacroSetScene(run->macro, run->scene));
  PetscCall(LamMacroSetUp(run->macro));
  if (run->resume) PetscCall(LamFE2CheckpointFind(run, finished));
  if (!*finished) PetscCall(LamFE2PrepareResponse(run));
  PetscCall(LamSummaryCreate(run->scene, &run->summary));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2ShareError(MPI_Comm comm, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, comm));
  /* no SETERRQ: the message has been printed where the error arose */
  PetscFunctionReturn((PetscErrorCode)code);
}

PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes)
{
  struct rusage usage;

  PetscFunctionBeginUser;
  getrusage(RUSAGE_SELF, &usage);
  *megabytes = (PetscReal)usage.ru_maxrss / 1024; /* Linux counts kilobytes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, megabytes, 1, MPIU_REAL, MPIU_MAX, comm));
  PetscFunctionReturn(0);
}

/* Rank 0: files, the row or object of the step. */
static PetscErrorCode EndStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields,
                              PetscReal peak_memory)
{
  PetscFunctionBeginUser;
  if (fields->point_count) {
    PetscCall(LamSummaryAdd(&run->summary, step, fields));
    LamSummaryFind(&run->summary);
  }
  PetscCall(LamFE2RecordStep(run, step, fields));
  PetscCall(LamFE2ReportStep(run, step, peak_memory));
  PetscCall(LamProgressUpdate(&run->progress, run->totals.steps + 1, 0));
  PetscFunctionReturn(0);
}

static void Count(const LamMacroStep *step, LamFE2Totals *totals)
{
  totals->steps++;
  totals->newton_iterations += step->newton_iterations;
  totals->queries += step->queries;
  totals->hits += step->hits;
  totals->solves += step->solves;
  totals->failures += step->failures;
}

/* LamMacroMonitor */
static PetscErrorCode StepDone(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  LamFE2Run *run = (LamFE2Run *)ctx;
  LamMacroFields fields = {0};
  PetscErrorCode ierr = 0;
  PetscReal peak_memory;

  PetscFunctionBeginUser;
  PetscCall(LamPeakMemory(run->comm, &peak_memory));
  if (run->out_path || !run->json) PetscCall(LamMacroGetFields(macro, &fields));
  if (LamAppIsRoot()) ierr = EndStep(run, step, &fields, peak_memory);
  PetscCall(LamMacroFieldsDestroy(&fields));
  PetscCall(LamFE2ShareError(run->comm, ierr));
  Count(step, &run->totals);
  *stop = LamStopRequested(); /* of any rank: a signal may reach only one of them */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stop, 1, MPIU_BOOL, MPI_LOR, run->comm));
  if (step->complete) PetscCall(LamFE2CheckpointSave(run, *stop));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveAndClose(LamFE2Run *run, int *exit_status)
{
  const PetscInt total = run->scene->macro.steps + (run->scene->macro.inflate ? 1 : 0);
  char message[LAM_MESSAGE_LENGTH], status[LAM_MESSAGE_LENGTH + 32] = "done";
  int signal_status = LAM_EXIT_OK;
  LamMacroReason reason;
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&run->progress, total, (PetscBool)(run->quiet || (!run->json && isatty(STDOUT_FILENO)))));
  PetscCall(LamMacroSetMonitor(run->macro, StepDone, run));
  PetscCall(LamMacroSetCutback(run->macro, LamFE2ReportCutback, run));
  PetscCall(LamMacroSolve(run->macro, &reason, message));
  PetscCall(LamProgressEnd(&run->progress));
  if (reason != LAM_MACRO_STOPPED) ierr = LamFE2Zoom(run);
  PetscCall(LamFE2ShareError(run->comm, ierr));
  if (reason == LAM_MACRO_STOPPED) {
    signal_status = LamStopExitStatus();
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &signal_status, 1, MPI_INT, MPI_MAX, run->comm));
    PetscCall(PetscStrncpy(status, "stopped", sizeof(status)));
  }
  if (reason == LAM_MACRO_NOT_CONVERGED) PetscCall(PetscSNPrintf(status, sizeof(status), "not converged: %s", message));
  *exit_status = reason == LAM_MACRO_NOT_CONVERGED ? LAM_EXIT_UNSOLVED : signal_status;
  if (LamAppIsRoot()) {
    ierr = LamFE2CloseFiles(run, status);
    if (!run->json) PetscCall(LamFE2ReportEnd(run));
    if (reason == LAM_MACRO_NOT_CONVERGED) fprintf(stderr, "lamella fe2: %s: %s\n", run->scene_path, message);
  }
  PetscCall(LamFE2ShareError(run->comm, ierr));
  if (reason == LAM_MACRO_DONE) PetscCall(LamFE2CheckpointRemove(run));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Destroy(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamMacroDestroy(&run->macro));
  PetscCall(LamArchiveClose(&run->archive, PETSC_FALSE));
  PetscCall(LamFE2Disconnect(run));
  PetscCall(LamSummaryDestroy(&run->summary));
  PetscCall(LamSceneDestroy(&run->scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamFE2Run *run, int *exit_status)
{
  PetscBool finished = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(Prepare(run, &finished));
  if (finished) PetscFunctionReturn(0);
  if (!LamFE2CheckTissuePaths("fe2", run)) {
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  PetscCall(LamFE2Connect(run));
  if (run->stopped) {
    *exit_status = LamStopExitStatus();
    PetscFunctionReturn(0);
  }
  PetscCall(LamFE2OpenFiles(run));
  PetscCall(LamFE2CheckpointStart(run));
  PetscCall(SolveAndClose(run, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandFE2(LamArgs *args, int *exit_status)
{
  LamFE2Run run = {.walls = 1, .wall_ratio = {1, 1, 1}};
  PetscErrorCode ierr;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "response database; a cache adds to it what it solves",
       &run.database_path},
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5", "results, with OUT.xdmf (for ParaView) and OUT.csv (curves) beside it",
       &run.out_path},
      {0, "response", LAM_OPTION_TEXT, "TYPE",
       "direct: solve an RVE per material point (default); cache: query, solve what is missing (default with -d); "
       "database: query only",
       &run.response_name},
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on behind the last complete step of OUT.h5, where there is one",
       &run.resume},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per load step on stdout", &run.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "fe2 SCENE [-d DB.h5] [-o OUT.h5] [--response TYPE] [--resume] [--json] [--quiet]",
                            "Solves the macroscale problem of a scene.", options, 1, &run.scene_path, &done,
                            exit_status));
  if (done) PetscFunctionReturn(0);
  if (!LamFE2ChooseResponse("fe2", &run) || !LamFE2CheckPaths("fe2", &run)) {
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  PetscCall(LamAppInitialize(args));
  run.comm = PETSC_COMM_WORLD;
  ierr = Solve(&run, exit_status);
  if (ierr) PetscCall(LamFE2CloseAfterError(&run));
  PetscCall(ierr);
  PetscCall(LamFE2Destroy(&run));
  PetscFunctionReturn(0);
}
