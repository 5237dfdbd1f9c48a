/*
  Whole studies, as run by the program's commands: build and verify a database, map failure, solve a body in an FE2
  run, follow tissue in time, weigh errors against time.

  Needs PetscInitialize. Studies are collective over PETSC_COMM_WORLD. They report to a LamReporter on rank 0, and
  print nothing.
*/
#ifndef LAMELLA_STUDY_H
#define LAMELLA_STUDY_H

#include <lamella/body.h>
#include <lamella/reporter.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Requests that the running study commits its results and returns; `number`: the signal that is the reason, SIGTERM
   if there is none. May be called in a signal handler. */
LAM_EXPORT void LamStopRequest(int number);

/* ---- a response database ---- */

typedef struct {
  PetscBool resume;            /* continue an existing database; otherwise an existing one is an error */
  PetscInt shard, shard_count; /* part `shard` (from 1) of the sample box; 0: all of it */
  PetscInt ranks_per_rve;      /* ranks that factor the matrices of one RVE together; 0: one */
  LamReporter reporter;
} LamBuildOptions;

typedef struct {
  PetscInt64 records, added, failed; /* in the file, added by this build, without a response */
  PetscReal answered; /* fraction of the sample box in which the database responds to the scene's accuracy */
  PetscReal error;    /* estimated error of P below which 95 % of the states are; NaN: unknown */
  PetscReal seconds;
  PetscBool stopped; /* by LamStopRequest */
} LamBuildResult;

/* Builds the database at database_path over the sample box of a scene (`sample`). result: on rank 0. */
LAM_EXPORT PetscErrorCode LamStudyBuild(const char scene_path[], const char database_path[],
                                        const LamBuildOptions *options, LamBuildResult *result);

/* ---- a database verified ---- */

typedef struct {
  PetscInt samples;   /* responses that are compared with fresh solves */
  PetscInt seed;      /* another one draws other states */
  PetscReal accuracy; /* relative error of P that is asked for; 0: that of the database */
  LamReporter reporter;
} LamVerifyOptions;

typedef struct {
  PetscInt queries, responses; /* random states queried; those with a response */
  PetscInt compared, beyond;   /* responses compared with a converged solve; those with an error above the accuracy */
  PetscReal error;             /* of P, below which 95 % of those compared are; NaN: none compared */
  PetscReal seconds;
  PetscBool stopped;
} LamVerifyResult;

/* Queries a database at random states, and solves those with a response afresh. result: on rank 0. */
LAM_EXPORT PetscErrorCode LamStudyVerify(const char database_path[], const LamVerifyOptions *options,
                                         LamVerifyResult *result);

/* ---- a failure map ---- */

typedef struct {
  PetscBool resume; /* continue an existing file */
  LamReporter reporter;
} LamMapOptions;

typedef struct {
  PetscInt points, solved, unknown; /* in the file, solved by this run, of unknown failure */
  PetscReal seconds;
  PetscBool stopped;
} LamMapResult;

/* Finds how tissue fails over two quantities of a scene (`map`), and writes it to map_path. result: on rank 0. */
LAM_EXPORT PetscErrorCode LamStudyMap(const char scene_path[], const char map_path[], const LamMapOptions *options,
                                      LamMapResult *result);

/* ---- a body ---- */

typedef enum { LAM_FE2_DIRECT, LAM_FE2_CACHE, LAM_FE2_DATABASE } LamFE2Response;
LAM_EXPORT extern const char *const LamFE2ResponseNames[]; /* "direct", ... */

typedef struct {
  LamFE2Response response;   /* direct: an RVE solve per material point; cache: queries, and solves of missing states,
                                with a lamella that breaks models of the points; database: queries only */
  const char *database_path; /* NULL: none; needed by the last one */
  const char *out_path;      /* HDF5 results, with .xdmf and .csv beside it; NULL: none */
  PetscBool resume;          /* continue after the last complete step of out_path */
  LamReporter reporter;
  /* Called after each step, on rank 0; nondimensional, scales of the scene. May be NULL. ctx: the reporter's. */
  PetscErrorCode (*step)(void *ctx, const LamScales *scales, const LamMacroStep *step);
} LamFE2Options;

/* Solves the macroscale problem of a scene (`macro`). message [LAM_MESSAGE_LENGTH]: why it did not converge. */
LAM_EXPORT PetscErrorCode LamStudyFE2(const char scene_path[], const LamFE2Options *options, LamMacroReason *reason,
                                      char message[]);

/* ---- tissue that changes in time ---- */

typedef struct {
  LamFE2Response response;              /* as in LamFE2Options, but a cache needs no database */
  const char *database_path, *out_path; /* likewise */
  PetscInt frames; /* at a material point: number of states whose cells are stored, evenly spread; 0: events, ends */
  LamReporter reporter;
  /* Called for each output time and each event, on rank 0, for a material point or for a body; in the scene's scales.
     May be NULL. ctx: the reporter's. */
  PetscErrorCode (*point)(void *ctx, const LamScales *scales, const LamProcessState *state);
  PetscErrorCode (*body)(void *ctx, const LamScales *scales, const LamBodyState *state);
} LamProcessOptions;

/* Follows the tissue of a scene (`process`) at a material point, or that of its body if it has one (`macro`). message
   [LAM_PROCESS_MESSAGE]: why it ended early. */
LAM_EXPORT PetscErrorCode LamStudyProcess(const char scene_path[], const LamProcessOptions *options,
                                          LamProcessReason *reason, char message[]);

/* ---- error against time ---- */

/* A setting of one parameter that trades error for time. Errors are the largest over the states, relative (`opening`:
   difference); NaN: unknown, or not of this family. */
typedef struct {
  const char *family, *setting;            /* "mesh", "12 x 4" */
  PetscBool planned;                       /* that of the scene and the planner */
  PetscInt runs;                           /* 0: left out, for this reason: */
  const char *reason;                      /* "": none */
  PetscReal core_seconds;                  /* median of the runs */
  PetscReal P, tangent, opening, reaction; /* errors; reaction: also of the work of a body */
} LamTradeoffSetting;

typedef struct {
  const char *family; /* "mesh", "strategy", "cells", "tolerance", "database" or "macro"; NULL: all */
  PetscInt repeats;
  PetscReal seconds; /* time limit of all measurements */
  LamReporter reporter;
  /* Called for each setting at the end. May be NULL. ctx: the reporter's. */
  PetscErrorCode (*setting)(void *ctx, const LamTradeoffSetting *setting);
} LamTradeoffOptions;

/* Measures error and time of the settings of a scene, on one rank. *solved: the plan and a reference have results. */
LAM_EXPORT PetscErrorCode LamStudyTradeoff(const char scene_path[], const LamTradeoffOptions *options,
                                           PetscBool *solved);

LAM_C_END

#endif
