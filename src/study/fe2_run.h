/*
  One run of `lamella fe2`: what its parts share. cmd_fe2.c holds its life, fe2_response.c what answers its material
  points, fe2_tissue.c of which tissue these are, fe2_report.c what is told of each step, fe2_record.c the files of rank
  0, fe2_zoom.c the microstructure at chosen points.

  Rank 0 writes the files. Where it cannot, it says so and the other ranks return the same error in silence.
*/
#ifndef LAM_FE2_RUN_H
#define LAM_FE2_RUN_H

#include "app.h"
#include "fe2_file.h"
#include "fe2_tissue.h"

typedef enum { LAM_FE2_DIRECT, LAM_FE2_CACHE, LAM_FE2_DATABASE } LamFE2Response;
extern const char *const LamFE2ResponseNames[];

/* Of the reported steps. */
typedef struct {
  PetscInt64 queries, hits, solves, failures;
  PetscInt steps, newton_iterations;
} LamFE2Totals;

typedef struct {
  /* what the command line says */
  const char *scene_path, *database_path, *out_path, *response_name;
  PetscBool json, quiet, resume;
  LamFE2Response response;

  MPI_Comm comm;
  LamScene *scene;
  LamMacro macro;
  PetscBool stopped;      /* before it began: nothing is written */
  PetscBool resumed;      /* goes on from a complete step: OUT.h5 has it */
  PetscInt resumed_steps; /* that earlier runs have told */
  PetscReal saved, save_seconds,
      all_save_seconds; /* when the checkpoint was written last, how long that took, and all */
  LamArchive archive;   /* what it goes on from, until that is read; NULL: it begins anew */
  LamFE2Tissues tissues;
  LamResponder mosaic; /* of several tissues; destroy NULL: not in use */

  /* rank 0 only */
  LamFE2File out;
  LamSummary summary;
  LamProgress progress;
  PetscBool localised;     /* has been told */
  PetscReal walls;         /* moduli over those of the tissues: of a process; else 1 */
  PetscReal wall_ratio[3]; /* C1, C2, C4 over that, where they do not change alike */

  LamFE2Totals totals;
  PetscReal start;
} LamFE2Run;

/* ---- fe2_response.c ---- */
/* Reads --response; PETSC_FALSE, with a message, where the options contradict each other. */
PetscBool LamFE2ChooseResponse(const char command[], LamFE2Run *run);
/* Finds the tissues, loads their databases, chooses the meshes of their RVEs; collective. */
PetscErrorCode LamFE2PrepareResponse(LamFE2Run *run);
/* Wires the responder that the options ask for to the macroscale solver; run->stopped: a signal came before. */
PetscErrorCode LamFE2Connect(LamFE2Run *run);
PetscErrorCode LamFE2Disconnect(LamFE2Run *run); /* after the macroscale solver's end */
/* The same for one tissue: its database and mesh; its responder, unless a signal comes before (run->stopped). */
PetscErrorCode LamFE2PrepareTissue(LamFE2Run *run, LamFE2Tissue *tissue);
PetscErrorCode LamFE2ConnectTissue(LamFE2Run *run, LamFE2Tissue *tissue, LamResponder **responder);
PetscErrorCode LamFE2DisconnectTissue(LamFE2Tissue *tissue);
/* The RVE of this tissue with its moduli C1, C2, C4 multiplied. */
PetscErrorCode LamFE2ChangeWalls(LamRVE rve, const LamMicrostructure *micro, const PetscReal factor[3]);

/* ---- fe2_report.c; on rank 0 ---- */
/* A step as JSON; peak_memory in MB. */
json_t *LamFE2StepToJSON(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory);
/* The row, after the first step's header, or the JSON object of a step; once, that the tissue localises. */
PetscErrorCode LamFE2ReportStep(LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory);
/* LamMacroCutback: a line on stderr; on all ranks. */
PetscErrorCode LamFE2ReportCutback(LamMacro macro, const char why[], void *run);
/* Summary and totals. */
PetscErrorCode LamFE2ReportEnd(const LamFE2Run *run);

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

/* ---- cmd_fe2.c ---- */
/* PETSC_FALSE, with a message, where a file would be written over by another; the second one, on all ranks, for the
   databases of regions and levels, whose names follow from that of -d. */
PetscBool LamFE2CheckPaths(const char command[], const LamFE2Run *run);
PetscBool LamFE2CheckTissuePaths(const char command[], const LamFE2Run *run);
/* Largest memory of a rank, MB. */
PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes);
PetscErrorCode LamFE2Destroy(LamFE2Run *run);
/* Makes an error of rank 0 everyone's. */
PetscErrorCode LamFE2ShareError(MPI_Comm comm, PetscErrorCode ierr);

#endif
