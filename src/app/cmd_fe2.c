/*
  lamella fe2: the macroscale problem of a scene, its material answered by RVE solves, a database or both.

  Rank 0 writes the files. Where it cannot, it says so and the other ranks return the same error in silence.
*/
#include "app.h"
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <lamella/clock.h>
#include <unistd.h>
#include "fe2_file.h"
#include "interruptible.h"
#include "node_solver.h"
#include "shared_grid.h"

typedef enum { RESPONSE_DIRECT, RESPONSE_CACHE, RESPONSE_DATABASE } ResponseType;
static const char *const ResponseNames[] = {"direct", "cache", "database"};

typedef struct {
  /* what the command line says */
  const char *scene_path, *database_path, *out_path, *response_name;
  PetscBool json, quiet;
  ResponseType response;

  MPI_Comm comm;
  LamScene *scene;
  LamMacro macro;
  PetscBool stopped; /* before it began: nothing is written */
  LamRVE rve;
  LamDatabase database;
  LamNodeChain chain; /* of the cache's nodes */
  LamNodeSolver nodes;
  LamResponder direct, solver, cache; /* direct behind the signals' `solver`; destroy NULL: not in use */

  /* rank 0 only */
  LamRecordWriter records; /* appends what the cache solves to the database's file */
  PetscInt recorded;       /* records of the database that are in its file */
  PetscInt64 next_key;     /* of a state that belongs to no grid */
  char *grid_text;         /* to be written; NULL: the file has it */
  LamFE2File out;
  LamProgress progress;

  /* totals of the converged steps */
  PetscInt64 queries, hits, solves, failures;
  PetscInt steps, newton_iterations;
  PetscReal start;
} Run;

/* Makes an error of rank 0 everyone's. */
static PetscErrorCode ShareError(MPI_Comm comm, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, comm));
  /* no SETERRQ: the message has been printed where the error arose */
  PetscFunctionReturn((PetscErrorCode)code);
}

/* ---- what answers ---- */

/* PETSC_FALSE, with a message, where the options contradict each other. */
static PetscBool ChooseResponse(Run *run)
{
  run->response = run->database_path ? RESPONSE_CACHE : RESPONSE_DIRECT;
  for (int k = 0; k < 3 && run->response_name; k++) {
    if (strcmp(run->response_name, ResponseNames[k])) continue;
    run->response = (ResponseType)k;
    run->response_name = NULL;
  }
  if (run->response_name)
    fprintf(stderr, "lamella fe2: --response %s: unknown; there are direct, cache, database\n", run->response_name);
  else if (run->response == RESPONSE_DATABASE && !run->database_path)
    fprintf(stderr, "lamella fe2: --response database needs a database; give -d DB.h5\n");
  else if (run->response == RESPONSE_DIRECT && run->database_path)
    fprintf(stderr, "lamella fe2: --response direct uses no database; leave out -d, or choose cache or database\n");
  else
    return PETSC_TRUE;
  return PETSC_FALSE;
}

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

/* PETSC_FALSE, with a message, where a file would be written over by another. */
static PetscBool CheckPaths(const Run *run)
{
  const char *dot = run->out_path ? strrchr(run->out_path, '.') : NULL;

  if (dot && !strcmp(dot, ".xdmf"))
    fprintf(stderr, "lamella fe2: -o %s: name the HDF5 file, %.*s.h5; the .xdmf file is written beside it\n",
            run->out_path, (int)(dot - run->out_path), run->out_path);
  else if (run->out_path && run->database_path && SameFile(run->out_path, run->database_path))
    fprintf(stderr, "lamella fe2: -o %s is the database of -d; the results would replace it\n", run->out_path);
  else
    return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Loads the database, on all ranks; the mesh of the RVE, where the scene leaves it open, is the database's. */
static PetscErrorCode OpenDatabase(Run *run)
{
  LamMicrostructure *micro = &run->scene->micro, stored;
  int exists = run->database_path && !access(run->database_path, F_OK);

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&exists, 1, MPI_INT, 0, run->comm));
  if (!exists && run->response != RESPONSE_DATABASE) PetscFunctionReturn(0);
  PetscCall(LamDatabaseOpen(run->database_path, &run->database));
  PetscCall(LamDatabaseGetMicrostructure(run->database, &stored, NULL, NULL));
  if (!micro->along) micro->along = stored.along;
  if (!micro->through) micro->through = stored.through;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckDatabase(Run *run)
{
  char *json, wanted[LAM_HASH_LENGTH];
  const char *hash;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetMicrostructure(run->database, NULL, NULL, &hash));
  PetscCall(LamMicrostructureDescribe(&run->scene->micro, &json, wanted));
  PetscCall(PetscFree(json));
  PetscCheck(!strcmp(hash, wanted), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds microstructure %s, the scene %s describes %s; give a database built from this scene",
             run->database_path, hash, run->scene_path, wanted);
  PetscCall(LamDatabaseGetRecords(run->database, &run->recorded, NULL, NULL));
  PetscFunctionReturn(0);
}

/* Reads and checks everything; nothing is written before the responder stands, too. */
static PetscErrorCode Prepare(Run *run)
{
  LamPlan plan;

  PetscFunctionBeginUser;
  run->start = LamClock();
  PetscCall(LamSceneRead(run->scene_path, &run->scene));
  PetscCall(LamMacroCreate(run->comm, &run->macro));
  PetscCall(LamMacroSetScene(run->macro, run->scene));
  PetscCall(LamMacroSetUp(run->macro));
  if (run->response != RESPONSE_DIRECT) PetscCall(OpenDatabase(run));
  PetscCall(LamPlanMake(run->scene, &plan));
  run->scene->micro = plan.micro;
  if (run->database)
    PetscCall(CheckDatabase(run));
  else if (run->response == RESPONSE_CACHE)
    PetscCall(LamDatabaseCreateEmpty(run->scene, &run->database));
  PetscFunctionReturn(0);
}

/* A new database has no grid yet, nor has one that is older than the grid. */
static PetscErrorCode GiveGrid(Run *run)
{
  PetscBool complete;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(run->database, &grid));
  if (grid) PetscFunctionReturn(0);
  if (LamAppIsRoot() && run->recorded && !run->quiet)
    fprintf(stderr,
            "lamella fe2: %s: its %" PetscInt_FMT
            " records belong to no grid; a grid is added, on which new ones lie\n",
            run->database_path, run->recorded);
  PetscCall(LamSharedGridMake(run->comm, run->scene, &run->solver, run->database, &run->grid_text, &complete));
  run->stopped = (PetscBool)!complete;
  PetscFunctionReturn(0);
}

/* Nodes in the file are equal to those of `build`. */
static PetscErrorCode CreateNodeSolver(Run *run)
{
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(run->database, &grid));
  PetscCall(
      LamNodeChainCreate(run->rve, run->scene->micro.interface, grid, LAM_NODE_MEMORY, LamStopRequested, &run->chain));
  run->nodes = (LamNodeSolver){run->chain, LamNodeChainSolve};
  PetscFunctionReturn(0);
}

/* Wires the responder that the options ask for to the macroscale solver. */
static PetscErrorCode Connect(Run *run)
{
  PetscInt points;

  PetscFunctionBeginUser;
  PetscCall(LamMacroGetPointCount(run->macro, &points));
  if (run->response != RESPONSE_DATABASE) {
    PetscCall(LamRVECreate(PETSC_COMM_SELF, &run->rve));
    PetscCall(LamRVESetMicrostructure(run->rve, &run->scene->micro));
    PetscCall(LamRVESetStrategy(run->rve, run->scene->strategy));
    PetscCall(LamRVESetUp(run->rve));
    PetscCall(LamRVESetInterrupt(run->rve, LamStopInterrupt, NULL));
    /* behind a cache no point keeps a state: all its solves start from the reference */
    PetscCall(LamRVEResponderCreate(run->rve, run->response == RESPONSE_DIRECT ? points : 0, &run->direct));
    PetscCall(LamInterruptibleResponderCreate(&run->direct, LamStopRequested, &run->solver));
  }
  PetscCall(LamMacroSetStop(run->macro, LamStopRequested));
  if (run->response == RESPONSE_DIRECT) {
    PetscCall(LamMacroSetResponder(run->macro, &run->solver));
    PetscFunctionReturn(0);
  }
  if (run->response == RESPONSE_CACHE) {
    PetscCall(GiveGrid(run));
    if (run->stopped) PetscFunctionReturn(0);
    PetscCall(CreateNodeSolver(run));
  }
  PetscCall(LamCacheResponderCreate(run->comm, run->database, run->rve ? &run->solver : NULL, &run->nodes,
                                    run->scene->accuracy, points, &run->cache));
  PetscCall(LamMacroSetResponder(run->macro, &run->cache));
  PetscFunctionReturn(0);
}

/* Rank 0's files: the results, and the database where the cache adds to it. */
static PetscErrorCode OpenFiles(Run *run)
{
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  if (run->out_path) PetscCall(LamFE2FileOpen(run->out_path, run->scene, &run->out));
  if (run->response != RESPONSE_CACHE || !run->database_path) PetscFunctionReturn(0);
  PetscCall(LamRecordWriterOpen(run->database_path, "database", LAM_WRITE_APPEND, run->scene, &run->records));
  if (run->grid_text) PetscCall(LamRecordWriterText(run->records, LAM_GRID_NAME, run->grid_text));
  PetscCall(LamRecordWriterGetKeys(run->records, &n, &keys));
  run->next_key = LAM_CACHE_KEY;
  for (PetscInt k = 0; k < n; k++) run->next_key = PetscMax(run->next_key, keys[k] + 1);
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenFilesOnRoot(Run *run)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Barrier(run->comm)); /* all ranks have read the database: rank 0 may write to it */
  if (LamAppIsRoot()) ierr = OpenFiles(run);
  PetscCall(ShareError(run->comm, ierr));
  PetscFunctionReturn(0);
}

/* ---- what is told of a step ---- */

/* Largest memory of a rank, MB. */
static PetscErrorCode PeakMemory(MPI_Comm comm, PetscReal *megabytes)
{
  struct rusage usage;

  PetscFunctionBeginUser;
  getrusage(RUSAGE_SELF, &usage);
  *megabytes = (PetscReal)usage.ru_maxrss / 1024; /* Linux counts kilobytes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, megabytes, 1, MPIU_REAL, MPIU_MAX, comm));
  PetscFunctionReturn(0);
}

/* Factors from nondimensional to N per mm of thickness, and MPa. */
static PetscReal ForceUnit(const Run *run)
{
  return run->scene->scales.stress * run->scene->scales.macro_length * 1e-3;
}

static PetscReal MPa(const Run *run)
{
  return run->scene->scales.stress * 1e-6;
}

static PetscErrorCode PrintStepJSON(const Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  const LamScales *scales = &run->scene->scales;
  json_t *reaction = json_object(), *object;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < step->boundary_count; s++)
    json_object_set_new(reaction, step->boundary[s], LamJSONReals(2, step->reaction[s], ForceUnit(run)));
  object = json_pack("{s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o}", "step",
                     (json_int_t)step->step, "load_factor", LamJSONReal(step->load_factor), "reaction", reaction,
                     "work", LamJSONReal(step->work * scales->stress * PetscSqr(scales->macro_length)),
                     "debonded_fraction", LamJSONReal(step->debonded_fraction), "max_gap", LamJSONReal(step->max_gap),
                     "turgor_mean", LamJSONReal(step->turgor_mean * MPa(run)), "newton_iterations",
                     (json_int_t)step->newton_iterations, "cutbacks", (json_int_t)step->cutbacks, "queries",
                     (json_int_t)step->queries, "hits", (json_int_t)step->hits, "solves", (json_int_t)step->solves,
                     "failures", (json_int_t)step->failures, "seconds", LamJSONReal(step->seconds), "peak_memory_mb",
                     LamJSONReal(peak_memory), "residuals", LamJSONReals(step->residual_count, step->residuals, 1));
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

static void PrintHeader(const Run *run, const LamMacroStep *step)
{
  printf("Reactions in N per mm of thickness; residuals relative to the forces of the elements.\n%4s %7s", "step",
         "load");
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    for (int i = 0; i < 2; i++) printf(" %*s.%c", 9, step->boundary[s], "xy"[i]);
  }
  printf(" %5s %8s %8s %8s %8s  %s\n", "iter.", "queries", "hits", "solves", "seconds", "residuals");
}

static void PrintRow(const Run *run, const LamMacroStep *step)
{
  printf("%4" PetscInt_FMT " %7.4f", step->step, (double)step->load_factor);
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    for (int i = 0; i < 2; i++) printf(" %11.4e", (double)(step->reaction[s][i] * ForceUnit(run)));
  }
  printf(" %5" PetscInt_FMT " %8lld %8lld %8lld %8.2f ", step->newton_iterations, (long long)step->queries,
         (long long)step->hits, (long long)step->solves, (double)step->seconds);
  for (PetscInt k = 0; k < step->residual_count; k++) printf(" %.0e", (double)step->residuals[k]);
  putchar('\n');
  fflush(stdout);
}

static PetscErrorCode PrintTotals(const Run *run)
{
  PetscFunctionBeginUser;
  printf("%" PetscInt_FMT " steps, %" PetscInt_FMT " Newton iterations, %lld queries, %lld hits, %lld solves, "
         "%lld failures, %.3g s; response %s\n",
         run->steps, run->newton_iterations, (long long)run->queries, (long long)run->hits, (long long)run->solves,
         (long long)run->failures, LamClock() - run->start, ResponseNames[run->response]);
  PetscFunctionReturn(0);
}

/* ---- after each step ---- */

/* Appends what the cache has solved since the last step, so that a later run finds it. */
static PetscErrorCode RecordSolved(Run *run)
{
  const LamResponse *records;
  const PetscInt64 *in_memory;
  PetscErrorCode ierr;
  PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetAdded(run->database, run->recorded, &n, &records));
  if (!n) PetscFunctionReturn(0);
  PetscCall(LamDatabaseGetRecords(run->database, NULL, NULL, &in_memory));
  PetscCall(PetscMalloc1(n, &keys));
  for (PetscInt k = 0; k < n; k++) {
    keys[k] = in_memory[run->recorded + k];
    if (!LamKeyIsNode(keys[k])) keys[k] = run->next_key++;
  }
  ierr = LamRecordWriterCommit(run->records, n, keys, records);
  PetscCall(PetscFree(keys));
  PetscCall(ierr);
  run->recorded += n;
  PetscFunctionReturn(0);
}

/* Rank 0: files, totals, the row or object of the step. */
static PetscErrorCode RecordStep(Run *run, const LamMacroStep *step, const LamMacroFields *fields,
                                 PetscReal peak_memory)
{
  PetscFunctionBeginUser;
  if (run->records) PetscCall(RecordSolved(run));
  if (run->out) PetscCall(LamFE2FileAddStep(run->out, step, fields));
  if (run->json)
    PetscCall(PrintStepJSON(run, step, peak_memory));
  else {
    if (!run->steps) PrintHeader(run, step);
    PrintRow(run, step);
  }
  run->steps++;
  run->newton_iterations += step->newton_iterations;
  run->queries += step->queries;
  run->hits += step->hits;
  run->solves += step->solves;
  run->failures += step->failures;
  PetscCall(LamProgressUpdate(&run->progress, run->steps, 0));
  PetscFunctionReturn(0);
}

/* LamMacroMonitor */
static PetscErrorCode StepDone(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  Run *run = (Run *)ctx;
  LamMacroFields fields = {0};
  PetscErrorCode ierr = 0;
  PetscReal peak_memory;

  PetscFunctionBeginUser;
  PetscCall(PeakMemory(run->comm, &peak_memory));
  if (run->out_path) PetscCall(LamMacroGetFields(macro, &fields));
  if (LamAppIsRoot()) ierr = RecordStep(run, step, &fields, peak_memory);
  PetscCall(LamMacroFieldsDestroy(&fields));
  PetscCall(ShareError(run->comm, ierr));
  *stop = LamStopRequested(); /* of any rank: a signal may reach only one of them */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stop, 1, MPIU_BOOL, MPI_LOR, run->comm));
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

/* Rank 0: what was solved is kept, whatever the end was. */
static PetscErrorCode CloseFiles(Run *run, const char status[])
{
  PetscErrorCode ierr = 0, closed;

  PetscFunctionBeginUser;
  if (run->records) {
    ierr = RecordSolved(run); /* of a step that did not converge */
    closed = LamRecordWriterClose(&run->records);
    if (!ierr) ierr = closed;
  }
  closed = LamFE2FileClose(&run->out, status);
  if (!ierr) ierr = closed;
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* After an error, which is the one to tell: no lock is left, and of the cache's solves what can still be written. */
static PetscErrorCode CloseAfterError(Run *run)
{
  PetscFunctionBeginUser;
  if (!LamAppIsRoot()) PetscFunctionReturn(0);
  PetscCall(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  (void)CloseFiles(run, NULL);
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveAndClose(Run *run, int *exit_status)
{
  const PetscInt total = run->scene->macro.steps + (run->scene->macro.inflate ? 1 : 0);
  char message[LAM_MESSAGE_LENGTH], status[LAM_MESSAGE_LENGTH + 32] = "done";
  int signal_status = LAM_EXIT_OK;
  LamMacroReason reason;
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&run->progress, total, (PetscBool)(run->quiet || (!run->json && isatty(STDOUT_FILENO)))));
  PetscCall(LamMacroSetMonitor(run->macro, StepDone, run));
  PetscCall(LamMacroSolve(run->macro, &reason, message));
  PetscCall(LamProgressEnd(&run->progress));
  if (reason == LAM_MACRO_STOPPED) {
    signal_status = LamStopExitStatus();
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &signal_status, 1, MPI_INT, MPI_MAX, run->comm));
    PetscCall(PetscStrncpy(status, "stopped", sizeof(status)));
  }
  if (reason == LAM_MACRO_NOT_CONVERGED) PetscCall(PetscSNPrintf(status, sizeof(status), "not converged: %s", message));
  *exit_status = reason == LAM_MACRO_NOT_CONVERGED ? LAM_EXIT_UNSOLVED : signal_status;
  if (LamAppIsRoot()) {
    ierr = CloseFiles(run, status);
    if (!run->json) PetscCall(PrintTotals(run));
    if (reason == LAM_MACRO_NOT_CONVERGED) fprintf(stderr, "lamella fe2: %s: %s\n", run->scene_path, message);
  }
  PetscCall(ShareError(run->comm, ierr));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamMacroDestroy(&run->macro));
  if (run->cache.destroy) PetscCall(run->cache.destroy(&run->cache.ctx));
  if (run->solver.destroy) PetscCall(run->solver.destroy(&run->solver.ctx));
  PetscCall(LamNodeChainDestroy(&run->chain));
  if (run->direct.destroy) PetscCall(run->direct.destroy(&run->direct.ctx));
  PetscCall(LamRVEDestroy(&run->rve));
  PetscCall(LamDatabaseClose(&run->database));
  PetscCall(PetscFree(run->grid_text));
  PetscCall(LamSceneDestroy(&run->scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(Run *run, int *exit_status)
{
  PetscFunctionBeginUser;
  PetscCall(Prepare(run));
  PetscCall(Connect(run));
  if (run->stopped) {
    *exit_status = LamStopExitStatus();
    PetscFunctionReturn(0);
  }
  PetscCall(OpenFilesOnRoot(run));
  PetscCall(SolveAndClose(run, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandFE2(LamArgs *args, int *exit_status)
{
  Run run = {0};
  PetscErrorCode ierr;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "response database; a cache adds to it what it solves",
       &run.database_path},
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5", "results, with OUT.xdmf beside it for ParaView", &run.out_path},
      {0, "response", LAM_OPTION_TEXT, "TYPE",
       "direct: solve an RVE per material point (default); cache: query, solve what is missing (default with -d); "
       "database: query only",
       &run.response_name},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per load step on stdout", &run.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "fe2 SCENE [-d DB.h5] [-o OUT.h5] [--response TYPE] [--json] [--quiet]",
                            "Solves the macroscale problem of a scene.", options, 1, &run.scene_path, &done,
                            exit_status));
  if (done) PetscFunctionReturn(0);
  if (!ChooseResponse(&run) || !CheckPaths(&run)) {
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  PetscCall(LamAppInitialize(args));
  run.comm = PETSC_COMM_WORLD;
  ierr = Solve(&run, exit_status);
  if (ierr) PetscCall(CloseAfterError(&run));
  PetscCall(ierr);
  PetscCall(Destroy(&run));
  PetscFunctionReturn(0);
}
