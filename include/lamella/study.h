/*
  Whole studies, as the program's commands make them: a database built, a body solved in an FE2 run.

  Needs PetscInitialize. Studies are collective over PETSC_COMM_WORLD. What they report goes to a LamReporter, on rank
  0; they print nothing.
*/
#ifndef LAMELLA_STUDY_H
#define LAMELLA_STUDY_H

#include <lamella/macro.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* What a study reports while it runs, on rank 0. It, or its members, may be NULL. */
typedef struct {
  void *ctx; /* of both; borrowed */
  /* A sentence for a person. A warning says that results may not be what they seem; else it is a note. */
  void (*message)(void *ctx, PetscBool warning, const char text[]);
  /* `failed` of those done; total 0: not known yet. */
  PetscErrorCode (*progress)(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed);
} LamReporter;

/* Asks the study under way to commit what it has and to return; `number`: the signal that is the reason, SIGTERM for
   want of one. May be called in a signal handler. */
LAM_EXPORT void LamStopRequest(int number);

/* ---- a response database ---- */

typedef struct {
  PetscBool resume;            /* goes on with a database that is there; else one that is there is an error */
  PetscInt shard, shard_count; /* part `shard` (from 1 on) of the sample box; 0: all of it */
  PetscInt ranks_per_rve;      /* ranks that factor the matrices of one RVE together; 0: one */
  LamReporter reporter;
} LamBuildOptions;

typedef struct {
  PetscInt64 records, added, failed; /* in the file, by this build, without a response */
  PetscReal answered; /* share of the sample box that the database responds in, to the scene's accuracy */
  PetscReal error;    /* estimated error of P that 95 % of the states stay below; NaN: not known */
  PetscReal seconds;
  PetscBool stopped; /* by LamStopRequest */
} LamBuildResult;

/* Fills the database at database_path over the sample box of a scene (`sample`). result: on rank 0. */
LAM_EXPORT PetscErrorCode LamStudyBuild(const char scene_path[], const char database_path[],
                                        const LamBuildOptions *options, LamBuildResult *result);

/* ---- a body ---- */

typedef enum { LAM_FE2_DIRECT, LAM_FE2_CACHE, LAM_FE2_DATABASE } LamFE2Response;
LAM_EXPORT extern const char *const LamFE2ResponseNames[]; /* "direct", ... */

typedef struct {
  LamFE2Response response;   /* solves an RVE per material point; queries and solves what is missing; queries only */
  const char *database_path; /* NULL: none; needed by the last two */
  const char *out_path;      /* HDF5 results, with .xdmf and .csv beside it; NULL: none */
  PetscBool resume;          /* goes on behind the last complete step of out_path */
  LamReporter reporter;
  /* After each step, on rank 0; nondimensional, by the scales of the scene. May be NULL. ctx: the reporter's. */
  PetscErrorCode (*step)(void *ctx, const LamScales *scales, const LamMacroStep *step);
} LamFE2Options;

/* Solves the macroscale problem of a scene (`macro`). message [LAM_MESSAGE_LENGTH]: why it did not converge. */
LAM_EXPORT PetscErrorCode LamStudyFE2(const char scene_path[], const LamFE2Options *options, LamMacroReason *reason,
                                      char message[]);

LAM_C_END

#endif
