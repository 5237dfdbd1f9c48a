/*
  Whole studies, as run by the program's commands: build a database, solve a body in an FE2 run.

  Needs PetscInitialize. Studies are collective over PETSC_COMM_WORLD. They report to a LamReporter on rank 0, and
  print nothing.
*/
#ifndef LAMELLA_STUDY_H
#define LAMELLA_STUDY_H

#include <lamella/macro.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Receives reports of a running study, on rank 0. The reporter and its members may be NULL. */
typedef struct {
  void *ctx; /* of both; borrowed */
  /* A message for the user. warning: results may be unreliable; otherwise it is a note. */
  void (*message)(void *ctx, PetscBool warning, const char text[]);
  /* failed: included in done; total 0: not known yet. */
  PetscErrorCode (*progress)(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed);
} LamReporter;

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

/* ---- a body ---- */

typedef enum { LAM_FE2_DIRECT, LAM_FE2_CACHE, LAM_FE2_DATABASE } LamFE2Response;
LAM_EXPORT extern const char *const LamFE2ResponseNames[]; /* "direct", ... */

typedef struct {
  LamFE2Response response;   /* direct: an RVE solve per material point; cache: queries, and solves of missing states;
                                database: queries only */
  const char *database_path; /* NULL: none; needed by the last two */
  const char *out_path;      /* HDF5 results, with .xdmf and .csv beside it; NULL: none */
  PetscBool resume;          /* continue after the last complete step of out_path */
  LamReporter reporter;
  /* Called after each step, on rank 0; nondimensional, scales of the scene. May be NULL. ctx: the reporter's. */
  PetscErrorCode (*step)(void *ctx, const LamScales *scales, const LamMacroStep *step);
} LamFE2Options;

/* Solves the macroscale problem of a scene (`macro`). message [LAM_MESSAGE_LENGTH]: why it did not converge. */
LAM_EXPORT PetscErrorCode LamStudyFE2(const char scene_path[], const LamFE2Options *options, LamMacroReason *reason,
                                      char message[]);

LAM_C_END

#endif
