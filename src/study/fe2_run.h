/*
  An FE2 run: the macroscale problem of a scene, with material points evaluated by RVE solves, a database or both.

    fe2_run.c         lifecycle
    fe2_tear.c        why a body that tears has no next state
    fe2_response.c    responders of the material points
    fe2_certify.c     reactions corrected by direct solves
    fe2_tissue.c      tissue of each point
    fe2_record.c      files of rank 0
    fe2_checkpoint.c  checkpoints of an interrupted run
    fe2_zoom.c        microstructure at chosen points

    LamFE2Run run = LAM_FE2_RUN;
    run.comm = ..., run.scene_path = ..., run.out_path = ...;   options below
    LamFE2Prepare(&run, &finished);  LamFE2Solve(&run);  LamFE2Destroy(&run);

  Rank 0 writes the files. If it fails, it raises the error, and the other ranks return the same code.
*/
#ifndef LAM_FE2_RUN_H
#define LAM_FE2_RUN_H

#include "fe2_file.h"
#include "fe2_summary.h"
#include "fe2_tissue.h"
#include "study.h"

/* Totals over the reported steps. */
typedef struct {
  PetscInt64 queries, hits, solves, failures;
  PetscInt steps, newton_iterations;
  PetscReal largest_force, force; /* on a side: of all steps, and of the last */
  unsigned int pressed;           /* bit b: the side of macro.boundary[b] has had a force */
} LamFE2Totals;

typedef struct LamFE2Run_s {
  /* options; all borrowed */
  MPI_Comm comm;
  const char *scene_path;    /* read, unless `scene` is given */
  const char *database_path; /* NULL: none */
  const char *out_path;      /* results; NULL: none */
  PetscBool overwrite;       /* files that Lamella did not write, too */
  PetscBool resume;          /* resume after the last complete step of out_path, if there is one */
  LamCertify certify;        /* which reactions of interpolated responses are corrected by direct solves */
  LamFE2Response response;
  LamReporter reporter;
  /* Called after each step, on rank 0: the files have the step, `totals` do not yet include it. May be NULL. */
  PetscErrorCode (*step)(void *ctx, const struct LamFE2Run_s *run, const LamMacroStep *step, PetscReal peak_memory);
  void *step_ctx;
  PetscBool all_fields; /* compute the summary even if nothing is written */

  LamScene *scene;
  LamMacro macro;
  PetscBool stopped;      /* stopped before the first step: nothing is written */
  PetscBool resumed;      /* resumed from a complete step, which OUT.h5 has */
  PetscInt resumed_steps; /* steps reported by earlier runs */
  PetscReal save_seconds; /* duration of all checkpoints */
  LamArchive archive;     /* the checkpoint to resume from, until it is read; NULL: none */
  LamFE2Tissues tissues;
  LamResponder heterogeneous; /* responder for several tissues; NULL: not in use */
  LamResponder reference;     /* direct one for several tissues, with `certify`; NULL: not in use */

  /* rank 0 only */
  LamFE2File out;
  LamSummary summary;
  PetscReal walls; /* common factor of the wall moduli over those of the tissues, in a process; else 1 */
  PetscBool
      walls_differ; /* parameters also change by `factors`, over those of the tissues and without the common factor */
  LamTissueFactors factors;

  LamFE2Totals totals;
  PetscReal broken; /* broken_fraction of the last step of this run; 0: there is none */
  PetscReal start;
  LamMacroReason reason;            /* LAM_MACRO_STOPPED: by LamStopRequest */
  char message[LAM_MESSAGE_LENGTH]; /* why it did not converge */
} LamFE2Run;

#define LAM_FE2_RUN ((LamFE2Run){.walls = 1})

/* ---- fe2_run.c; collective ---- */
/* Reads and checks all input; writes nothing. *finished: with `resume`, out_path already has all steps. */
PetscErrorCode LamFE2Prepare(LamFE2Run *run, PetscBool *finished);
PetscErrorCode LamFE2Solve(LamFE2Run *run); /* sets reason and message */
PetscErrorCode LamFE2Destroy(LamFE2Run *run);
/* Writes, counts and reports a step; done, total: progress. */
PetscErrorCode LamFE2EndStep(LamFE2Run *run, const LamMacroStep *step, PetscInt64 done, PetscInt64 total);
/* Connects the responders, opens the files, and calls `follow`, which solves all steps and says how they ended:
   stopped, or a status. Then adds the zooms and closes the files, also after an error. */
typedef PetscErrorCode (*LamFE2Follow)(void *ctx, PetscBool *stopped, size_t size, char status[]);
PetscErrorCode LamFE2FollowInFiles(LamFE2Run *run, LamFE2Follow follow, void *ctx);

/* ---- fe2_tear.c ---- */
/* Counts a step's forces. */
void LamFE2NoteForce(LamFE2Totals *totals, const LamMacroSpec *spec, const LamMacroStep *step);
/* Warns of plates and indenters that have not touched the body in any step. */
void LamFE2WarnOfObstacles(const LamFE2Run *run);
/* Adds to run->message, of a run that did not converge, what a lamella that breaks has to do with it, and what helps;
   broken: broken_fraction of the last step. */
PetscErrorCode LamFE2ExplainTear(LamFE2Run *run);

/* ---- fe2_response.c ---- */
/* Whether the points of a tissue hold models of their own instead of a cache: those of a lamella that breaks, whose
   responses depend on what each has been through. */
PetscBool LamFE2HoldsModels(const LamFE2Run *run, const LamFE2Tissue *tissue);
PetscBool LamFE2AllHoldModels(const LamFE2Run *run);
/* Determines the tissues, loads their databases, chooses the meshes of their RVEs; collective. */
PetscErrorCode LamFE2PrepareResponse(LamFE2Run *run);
/* Creates the responder selected by run->response and sets it on the macroscale solver. run->stopped: a stop was
   requested before that was done. */
PetscErrorCode LamFE2Connect(LamFE2Run *run);
PetscErrorCode LamFE2Disconnect(LamFE2Run *run); /* after the macroscale solver's end */
/* The same for one tissue: its database and mesh; its responder, unless a stop is requested first (run->stopped). */
PetscErrorCode LamFE2PrepareTissue(LamFE2Run *run, LamFE2Tissue *tissue);
/* The scene's microstructure becomes that of the tissue, with the mesh found for it; relaxation stays. */
void LamFE2TakeMesh(const LamFE2Tissue *tissue, LamScene *scene);
PetscErrorCode LamFE2ConnectTissue(LamFE2Run *run, LamFE2Tissue *tissue, LamResponder *responder);
PetscErrorCode LamFE2DisconnectTissue(LamFE2Tissue *tissue);
/* Multiplies each wall parameter of the RVE, and strengths and energies of its lamella and of walls that tear, relative
   to those in `micro`, by its factor. */
PetscErrorCode LamFE2ChangeRVE(LamRVE rve, const LamMicrostructure *micro, const LamTissueFactors *factors);
/* The same for a LamFE2Tissue; callback for LamProcessSetTissue. */
PetscErrorCode LamFE2ChangeTissue(void *tissue, const LamTissueFactors *factors);

/* Creates the RVE and the direct responder of a tissue; a responder that solves each point from its last state, as far
   as the memory of the scene goes. */
PetscErrorCode LamFE2CreateSolver(LamFE2Run *run, LamFE2Tissue *tissue);
PetscErrorCode LamFE2CreateDirect(LamFE2Run *run, LamFE2Tissue *tissue, LamResponder *responder);

/* ---- fe2_certify.c ---- */
/* Corrects the reactions that run->certify selects by direct solves; after LamFE2Connect. */
PetscErrorCode LamFE2Certify(LamFE2Run *run);

/* ---- fe2_record.c; on rank 0, except the first two, which are collective ---- */
/* Raises an error if the results, and the checkpoint where there is one, would replace other files, or cannot be
   written. */
PetscErrorCode LamFE2CheckTargets(const LamFE2Run *run, PetscBool checkpoint);
PetscErrorCode LamFE2OpenFiles(LamFE2Run *run);
/* Adds a step to the summary and the results, and the cache's new records to the database file. */
PetscErrorCode LamFE2RecordStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields);
/* For one tissue: opens its database file for appending; appends the cache's records since the last call. */
PetscErrorCode LamFE2OpenTissueFile(LamFE2Tissue *tissue);
PetscErrorCode LamFE2RecordTissue(LamFE2Tissue *tissue);
PetscErrorCode LamFE2CloseTissueFile(LamFE2Tissue *tissue); /* with the records since then */
/* Records not yet written are written first, however the run ended. */
PetscErrorCode LamFE2CloseFiles(LamFE2Run *run, const char status[]);

/* ---- fe2_checkpoint.c; collective ---- */
/*
  With --resume: looks for OUT.h5.ckpt and checks that it is of this run; *finished: OUT.h5 already has all steps of
  this scene. LamFE2CheckpointRows, called before databases are opened, reads which records of a tissue's database the
  run had used.
*/
PetscErrorCode LamFE2CheckpointFind(LamFE2Run *run, PetscBool *finished);
PetscErrorCode LamFE2CheckpointRows(LamFE2Run *run, LamArchive archive, LamFE2Tissue *tissue);
/* Restores the checkpoint that was found, once responder and files exist; else writes a first OUT.h5.ckpt, so that
   responses after a resume do not depend on records that other runs add to the database meanwhile. */
PetscErrorCode LamFE2CheckpointStart(LamFE2Run *run);
/* Raises an error if another file has the checkpoint's name. */
PetscErrorCode LamFE2CheckpointCheckTarget(const LamFE2Run *run);
/* Called after a complete step is in the files. */
PetscErrorCode LamFE2CheckpointSave(LamFE2Run *run);
PetscErrorCode LamFE2CheckpointRemove(LamFE2Run *run);

/* ---- fe2_zoom.c ---- */
/* Adds the microstructure at some material points (`macro.zoom`) to the results, after the last step. Collective. */
PetscErrorCode LamFE2Zoom(LamFE2Run *run);

#endif
