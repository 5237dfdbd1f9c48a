/*
  Studies of tissue that changes in time.

    process_states.c    /process in the result files
    process_point.c     at a material point
    process_body.c      of a body
*/
#ifndef LAM_PROCESS_RUN_H
#define LAM_PROCESS_RUN_H

#include "fe2_run.h"
#include <lamella/body.h>
#include <lamella/process.h>

/* States ordered by time; stresses in units of the initial C1 + C2. */
typedef struct {
  PetscInt count, capacity;
  LamProcessState *states; /* owned */
} LamProcessHistory;
typedef struct {
  const LamScene *scene; /* borrowed */
  PetscInt count, capacity;
  LamBodyState *states; /* owned */
} LamBodyHistory;

/* ---- process_states.c ---- */
PetscErrorCode LamProcessHistoryWrite(LamRecordWriter writer, const LamScene *scene, const LamProcessHistory *history);
extern const LamTextKind LamProcessTable;
/* The same as a table for spreadsheets, beside the HDF5 file: .csv; F from the inflated tissue, and P. */
PetscErrorCode LamProcessHistoryWriteCSV(const char hdf5[], const LamScene *scene, const LamProcessHistory *history);
PetscErrorCode LamBodyHistoryWrite(LamRecordWriter writer, void *history); /* a LamBodyHistory */
#define LAM_PROCESS_PARTS 100                                              /* of the duration, for progress reports */
PetscInt64 LamProcessProgress(const LamScene *scene, PetscReal time);      /* parts done */

/* ---- process_point.c ---- */
/* At a material point. */
typedef struct LamProcessStudy_s {
  LamFE2Run response;   /* options and one tissue: the responder of the material point */
  const char *out_path; /* NULL: none */
  PetscInt frames;      /* number of states whose microstructure is stored, in addition to those of events */
  LamScene *scene;      /* owned by response.scene */
  /* Called after each state, the last one of the history; ctx: step_ctx of `response`. May be NULL. */
  PetscErrorCode (*state)(void *ctx, const struct LamProcessStudy_s *study);
  PetscErrorCode (*done)(void *ctx, const struct LamProcessStudy_s *study); /* likewise, at the end */

  LamProcess process;
  LamProcessHistory history;
  LamRecordWriter writer; /* NULL without a file */
  PetscReal start, last_commit;
  PetscInt committed; /* states in the file */
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE]; /* why it ended before its duration */
} LamProcessStudy;
/* On rank 0, while further ranks of PETSC_COMM_WORLD wait; all get reason and message. Frees all but the scene. */
PetscErrorCode LamProcessStudyRun(LamProcessStudy *study);

/* ---- process_body.c; collective ---- */
typedef struct LamBodyStudy_s {
  LamFE2Run fe2; /* options, body and tissues; the first member */
  /* Called after each state, on rank 0; ctx: step_ctx of `fe2`. May be NULL. */
  PetscErrorCode (*state)(void *ctx, const struct LamBodyStudy_s *study, const LamBodyState *state,
                          PetscReal peak_memory);
  LamBody body;
  LamBodyHistory history; /* rank 0 */
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE]; /* why it ended before its duration */
} LamBodyStudy;
/* Reads and checks all input; writes nothing. */
PetscErrorCode LamBodyStudyPrepare(LamBodyStudy *study);
PetscErrorCode LamBodyStudySolve(LamBodyStudy *study);
PetscErrorCode LamBodyStudyDestroy(LamBodyStudy *study);

#endif
