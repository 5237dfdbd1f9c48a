/*
  What the program prints of FE2 runs, and the options of the commands that make them.
*/
#ifndef LAM_FE2_REPORT_H
#define LAM_FE2_REPORT_H

#include "app.h"
#include "fe2_run.h"

typedef struct {
  const char *command; /* "fe2" */
  PetscBool json, quiet;
  PetscBool localised; /* has been reported */
  LamProgress progress;
} LamFE2Report;

/* ---- fe2_options.c ---- */
/* Sets run->response from the text of --response, NULL: not given. PETSC_FALSE, with a message, where the options
   contradict each other. */
PetscBool LamFE2ChooseResponse(const char command[], const char name[], LamFE2Run *run);
/* PETSC_FALSE, with a message, where a file would be overwritten by another; the second one, on all ranks, for the
   databases of regions and levels, whose names follow from that of -d. */
PetscBool LamFE2CheckPaths(const char command[], const LamFE2Run *run);
PetscBool LamFE2CheckTissuePaths(const char command[], const LamFE2Run *run);

/* ---- fe2_report.c; on rank 0. ctx: a LamFE2Report ---- */
/* A step as JSON; peak_memory in MB. */
json_t *LamFE2StepToJSON(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory);
/* The row, after the first step's header, or the JSON object of a step; once, that the tissue localises. */
PetscErrorCode LamFE2ReportStep(void *ctx, const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory);
void LamFE2ReportMessage(void *ctx, PetscBool warning, const char text[]);
/* Summary and totals. */
PetscErrorCode LamFE2ReportEnd(const LamFE2Run *run);

#endif
