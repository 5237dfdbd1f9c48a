/*
  An FE2 run: the macroscale problem of a scene, its material points answered by RVE solves, a database or both.

    fe2_run.c         its life
    fe2_response.c    responders of the material points
    fe2_tissue.c      which tissue each point has
    fe2_record.c      the files of rank 0
    fe2_checkpoint.c  what an interrupted run goes on from
    fe2_zoom.c        the microstructure at chosen points

    LamFE2Run run = LAM_FE2_RUN;
    run.comm = ..., run.scene_path = ..., run.out_path = ...;   options below
    LamFE2Prepare(&run, &finished);  LamFE2Solve(&run, &reason, message);  LamFE2Destroy(&run);

  Rank 0 writes the files. Where it cannot, the error is raised there, and the other ranks return the same code.
*/
#ifndef LAM_FE2_RUN_H
#define LAM_FE2_RUN_H

#include "fe2_file.h"
#include "fe2_summary.h"
#include "fe2_tissue.h"
#include "study.h"

/* Of the reported steps. */
typedef struct {
  PetscInt64 queries, hits, solves, failures;
  PetscInt steps, newton_iterations;
} LamFE2Totals;

typedef struct LamFE2Run_s {
  /* options; all borrowed */
  MPI_Comm comm;
  const char *scene_path;    /* read, unless `scene` is given */
  const char *database_path; /* NULL: none */
  const char *out_path;      /* results; NULL: none */
  PetscBool resume;          /* goes on behind the last complete step of out_path, where there is one */
  LamFE2Response response;
  LamReporter reporter;
  /* After each step, on rank 0, once files and totals before it are written; ctx: the reporter's. May be NULL. */
  PetscErrorCode (*step)(void *ctx, const struct LamFE2Run_s *run, const LamMacroStep *step, PetscReal peak_memory);
  PetscBool all_fields; /* the summary is wanted although nothing is written */

  LamScene *scene;
  LamMacro macro;
  PetscBool stopped;      /* before the first step: nothing is written */
  PetscBool resumed;      /* goes on from a complete step: OUT.h5 has it */
  PetscInt resumed_steps; /* that earlier runs have reported */
  PetscReal saved, save_seconds,
      all_save_seconds; /* when the checkpoint was written last, how long that took, and all */
  LamArchive archive;   /* what it goes on from, until that is read; NULL: it begins anew */
  LamFE2Tissues tissues;
  LamResponder mosaic; /* of several tissues; destroy NULL: not in use */

  /* rank 0 only */
  LamFE2File out;
  LamSummary summary;
  PetscReal walls;        /* moduli over those of the tissues: of a process; else 1 */
  PetscBool walls_differ; /* their parameters do not change alike: each over that is */
  PetscReal wall_ratio[LAM_WALL_PARAMETER_COUNT];

  LamFE2Totals totals;
  PetscReal start;
} LamFE2Run;

#define LAM_FE2_RUN ((LamFE2Run){.walls = 1})

/* ---- fe2_run.c; collective ---- */
/* Reads and checks everything; nothing is written. *finished: with `resume`, out_path has all steps already. */
PetscErrorCode LamFE2Prepare(LamFE2Run *run, PetscBool *finished);
/* message [LAM_MESSAGE_LENGTH]: why it did not converge. LAM_MACRO_STOPPED: by LamStopRequest. */
PetscErrorCode LamFE2Solve(LamFE2Run *run, LamMacroReason *reason, char message[]);
PetscErrorCode LamFE2Destroy(LamFE2Run *run);

/* ---- fe2_response.c ---- */
/* Finds the tissues, loads their databases, chooses the meshes of their RVEs; collective. */
PetscErrorCode LamFE2PrepareResponse(LamFE2Run *run);
/* Wires the responder that the options ask for to the macroscale solver; run->stopped: a request to stop came before.
 */
PetscErrorCode LamFE2Connect(LamFE2Run *run);
PetscErrorCode LamFE2Disconnect(LamFE2Run *run); /* after the macroscale solver's end */
/* The same for one tissue: its database and mesh; its responder, unless a request to stop comes before (run->stopped).
 */
PetscErrorCode LamFE2PrepareTissue(LamFE2Run *run, LamFE2Tissue *tissue);
PetscErrorCode LamFE2ConnectTissue(LamFE2Run *run, LamFE2Tissue *tissue, LamResponder **responder);
PetscErrorCode LamFE2DisconnectTissue(LamFE2Tissue *tissue);
/* The RVE of this tissue with each parameter of its walls multiplied. */
PetscErrorCode LamFE2ChangeWalls(LamRVE rve, const LamMicrostructure *micro,
                                 const PetscReal factor[LAM_WALL_PARAMETER_COUNT]);
/* The same of a LamFE2Tissue; a set of LamProcessSetWalls. */
PetscErrorCode LamFE2ChangeTissueWalls(void *tissue, const PetscReal factor[LAM_WALL_PARAMETER_COUNT]);

/* ---- fe2_record.c; on rank 0 but for the first, which is collective ---- */
PetscErrorCode LamFE2OpenFiles(LamFE2Run *run);
/* Adds a step to the results, and to the database what the cache has solved since the last one. */
PetscErrorCode LamFE2RecordStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields);
/* Of one tissue: starts to append to its database's file; appends what the cache has solved since the last time. */
PetscErrorCode LamFE2OpenTissueFile(LamFE2Tissue *tissue);
PetscErrorCode LamFE2RecordTissue(LamFE2Tissue *tissue);
/* What was solved is kept, whatever the end was. */
PetscErrorCode LamFE2CloseFiles(LamFE2Run *run, const char status[]);
/* After an error, which is the one to tell: no lock is left, and of the cache's solves what can still be written. */
PetscErrorCode LamFE2CloseAfterError(LamFE2Run *run);

/* ---- fe2_checkpoint.c; collective ---- */
/*
  With --resume: looks for OUT.h5.ckpt and checks that it is of this run; *finished: OUT.h5 has all steps of this scene
  already. Before databases are opened: LamFE2CheckpointRows says which records of a tissue's were known.
*/
PetscErrorCode LamFE2CheckpointFind(LamFE2Run *run, PetscBool *finished);
PetscErrorCode LamFE2CheckpointRows(LamFE2Run *run, LamArchive archive, LamFE2Tissue *tissue);
/* Takes over what was found, once responder and files stand; else starts OUT.h5.ckpt, so that a database that grows
   meanwhile does not change what the run would have answered. */
PetscErrorCode LamFE2CheckpointStart(LamFE2Run *run);
/* After a complete step, and after the files have it: where it is due, so that all of them take 2 % of the time at
   most, or where the run is to end. */
PetscErrorCode LamFE2CheckpointSave(LamFE2Run *run, PetscBool ends);
PetscErrorCode LamFE2CheckpointRemove(LamFE2Run *run);

/* ---- fe2_zoom.c ---- */
/* Adds to the results, after the last step, the microstructure at some material points (`macro.zoom`). Collective. */
PetscErrorCode LamFE2Zoom(LamFE2Run *run);

#endif
