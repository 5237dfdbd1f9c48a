/*
  Studies of tissue that changes in time.

    process_point.c process_file.c process_frames.c    at a material point
    process_body.c process_body_file.c                 of a body
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

/* At a material point. */
typedef struct LamProcessStudy_s {
  LamFE2Run response;   /* options and one tissue: the responder of the material point */
  const char *out_path; /* NULL: none */
  PetscInt frames;      /* number of states whose microstructure is stored, in addition to those of events */
  LamScene *scene;      /* owned by response.scene */
  /* Called after each state, the last one of the history; ctx: that of the response's reporter. May be NULL. */
  PetscErrorCode (*state)(void *ctx, const struct LamProcessStudy_s *study);

  LamProcess process;
  LamProcessHistory history;
  LamRecordWriter writer; /* NULL without a file */
  PetscReal start, last_commit;
  PetscInt committed; /* states in the file */
} LamProcessStudy;

#define LAM_PROCESS_PARTS 1000 /* parts of the duration, for progress reports */

/* ---- process_point.c; on one rank ---- */
/* message [LAM_PROCESS_MESSAGE]: why it ended before its duration. */
PetscErrorCode LamProcessSolvePoint(LamProcessStudy *study, LamProcessReason *reason, char message[]);
PetscErrorCode LamProcessStudyDestroy(LamProcessStudy *study);

/* ---- process_file.c ---- */
PetscErrorCode LamProcessFileOpen(LamProcessStudy *study);
/* Commits the states that are not in the file yet; only at intervals unless `now`. */
PetscErrorCode LamProcessFileAdd(LamProcessStudy *study, PetscBool now);
/* Adds the microstructure at some states, before the file is closed. */
PetscErrorCode LamProcessFrames(LamProcessStudy *study, PetscInt frames);
/* `status`: "done", "stopped", or why it ended. */
PetscErrorCode LamProcessFileClose(LamProcessStudy *study, const char status[]);

/* ---- process_body_file.c; rank 0 ---- */
/* Bodies ordered by time; in units of the initial C1 + C2. */
typedef struct {
  const LamScene *scene; /* borrowed */
  PetscInt count, capacity;
  LamBodyState *states; /* owned */
} LamBodyHistory;
PetscErrorCode LamBodyHistoryAdd(LamBodyHistory *history, const LamBodyState *state);
/* Writes /process of a file of steps; `history`: a LamBodyHistory. */
PetscErrorCode LamBodyHistoryWrite(LamRecordWriter writer, void *history);

/* ---- process_body.c; collective ---- */
typedef struct LamBodyStudy_s {
  LamFE2Run fe2; /* options, body and tissues */
  /* Called after each state, on rank 0; ctx: that of the reporter. May be NULL. */
  PetscErrorCode (*state)(void *ctx, const struct LamBodyStudy_s *study, const LamBodyState *state,
                          PetscReal peak_memory);
  LamBody body;
  LamBodyHistory history; /* rank 0 */
} LamBodyStudy;
/* Reads and checks all input; writes nothing. */
PetscErrorCode LamBodyStudyPrepare(LamBodyStudy *study);
PetscErrorCode LamBodyStudySolve(LamBodyStudy *study, LamProcessReason *reason, char message[]);
PetscErrorCode LamBodyStudyDestroy(LamBodyStudy *study);

#endif
