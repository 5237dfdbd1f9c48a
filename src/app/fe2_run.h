/*
  One run of `lamella fe2`: what its parts share. cmd_fe2.c holds its life, fe2_response.c what answers its material
  points, fe2_tissue.c of which tissue these are, fe2_report.c what is told of each step, fe2_record.c the files of rank
  0.

  Rank 0 writes the files. Where it cannot, it says so and the other ranks return the same error in silence.
*/
#ifndef LAM_FE2_RUN_H
#define LAM_FE2_RUN_H

#include "app.h"
#include "fe2_file.h"
#include "fe2_tissue.h"

typedef enum { LAM_FE2_DIRECT, LAM_FE2_CACHE, LAM_FE2_DATABASE } LamFE2Response;
extern const char *const LamFE2ResponseNames[];

typedef struct {
  /* what the command line says */
  const char *scene_path, *database_path, *out_path, *response_name;
  PetscBool json, quiet;
  LamFE2Response response;

  MPI_Comm comm;
  LamScene *scene;
  LamMacro macro;
  PetscBool stopped; /* before it began: nothing is written */
  LamFE2Tissues tissues;
  LamResponder mosaic; /* of several tissues; destroy NULL: not in use */

  /* rank 0 only */
  LamFE2File out;
  LamProgress progress;

  /* totals of the converged steps */
  PetscInt64 queries, hits, solves, failures;
  PetscInt steps, newton_iterations;
  PetscReal start;
} LamFE2Run;

/* ---- fe2_response.c ---- */
/* Reads --response; PETSC_FALSE, with a message, where the options contradict each other. */
PetscBool LamFE2ChooseResponse(LamFE2Run *run);
/* Finds the tissues, loads their databases, chooses the meshes of their RVEs; collective. */
PetscErrorCode LamFE2PrepareResponse(LamFE2Run *run);
/* Wires the responder that the options ask for to the macroscale solver; run->stopped: a signal came before. */
PetscErrorCode LamFE2Connect(LamFE2Run *run);
PetscErrorCode LamFE2Disconnect(LamFE2Run *run); /* after the macroscale solver's end */

/* ---- fe2_report.c; on rank 0 ---- */
/* The row, after the first step's header, or the JSON object of a step. peak_memory in MB. */
PetscErrorCode LamFE2ReportStep(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory);
PetscErrorCode LamFE2ReportTotals(const LamFE2Run *run);

/* ---- fe2_record.c; on rank 0 but for the first, which is collective ---- */
PetscErrorCode LamFE2OpenFiles(LamFE2Run *run);
/* Adds a step to the results, and to the database what the cache has solved since the last one. */
PetscErrorCode LamFE2RecordStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields);
/* What was solved is kept, whatever the end was. */
PetscErrorCode LamFE2CloseFiles(LamFE2Run *run, const char status[]);
/* After an error, which is the one to tell: no lock is left, and of the cache's solves what can still be written. */
PetscErrorCode LamFE2CloseAfterError(LamFE2Run *run);

/* ---- cmd_fe2.c ---- */
/* Makes an error of rank 0 everyone's. */
PetscErrorCode LamFE2ShareError(MPI_Comm comm, PetscErrorCode ierr);

#endif
