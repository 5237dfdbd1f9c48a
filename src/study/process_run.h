/*
  One run of `lamella process`: what its parts share. cmd_process.c holds its life at a material point,
  process_report.c what is told, process_file.c the results; process_body.c and process_body_file.c are for a body.
*/
#ifndef LAM_PROCESS_RUN_H
#define LAM_PROCESS_RUN_H

#include "fe2_run.h"
#include <lamella/body.h>
#include <lamella/process.h>

/* States in the order of time; stresses in the C1 + C2 of the start. */
typedef struct {
  PetscInt count, capacity;
  LamProcessState *states; /* owned */
} LamProcessHistory;

typedef struct {
  LamFE2Run response; /* what answers the material point: command line and one tissue */
  const char *out_path;
  const char *frames_text;
  PetscInt frames; /* states whose microstructure is kept, beside those of events */
  PetscBool json, quiet;
  LamScene *scene; /* owned by response.scene */
  LamProcess process;
  LamProcessHistory history;
  LamRecordWriter writer; /* NULL without -o */
  LamProgress progress;
  PetscReal start, last_commit;
  PetscInt committed; /* states in the file */
} LamProcessRunState;

/* ---- process_report.c ---- */
/* Row of a table, the first with its header before it, or JSON object, of the last state of the history. */
PetscErrorCode LamProcessReport(const LamProcessRunState *run);
PetscErrorCode LamProcessReportEnd(const LamProcessRunState *run, LamProcessReason reason, const char message[]);

/* ---- process_file.c ---- */
PetscErrorCode LamProcessFileOpen(LamProcessRunState *run);
/* Commits what the file does not have yet; now and then unless `now`. */
PetscErrorCode LamProcessFileAdd(LamProcessRunState *run, PetscBool now);
/* Adds the microstructure at some states, before the file is closed. */
PetscErrorCode LamProcessFrames(LamProcessRunState *run, PetscInt frames);
/* `status`: "done", "stopped", or why it ended. */
PetscErrorCode LamProcessFileClose(LamProcessRunState *run, const char status[]);

/* ---- process_body.c ---- */
/* A body: the scene has a block `macro`. Takes over what the command line said; collective. */
PetscErrorCode LamProcessBody(LamProcessRunState *command, int *exit_status);

/* ---- process_body_file.c; rank 0 ---- */
/* Bodies in the order of time; in the C1 + C2 of the start. */
typedef struct {
  const LamScene *scene; /* borrowed */
  PetscInt count, capacity;
  LamBodyState *states; /* owned */
} LamBodyHistory;
PetscErrorCode LamBodyHistoryAdd(LamBodyHistory *history, const LamBodyState *state);
/* Writes /process of a file of steps; a LamBodyHistory. */
PetscErrorCode LamBodyHistoryWrite(LamRecordWriter writer, void *history);

/* ---- cmd_process.c ---- */
/* Set of LamProcessSetWalls, with a LamFE2Tissue: what is solved directly takes other moduli. */
PetscErrorCode LamProcessChangeWalls(void *tissue, const PetscReal factor[3]);

#endif
