/*
  Output of FE2 runs, and the options of the commands that start them.
*/
#ifndef LAM_FE2_REPORT_H
#define LAM_FE2_REPORT_H

#include "app.h"
#include "fe2_run.h"

/* ---- fe2_options.c ---- */
/* Sets run->response from the text of --response, NULL: not given. PETSC_FALSE, with a message, if the options
   conflict. */
PetscBool LamFE2ChooseResponse(const char command[], const char name[], LamFE2Run *run, int *exit_status);
/* PETSC_FALSE, with a message, if one file would overwrite another. The second function checks, on all ranks, the
   databases of regions and levels, whose names are derived from that of -d. */
PetscBool LamFE2CheckPaths(const char command[], const LamFE2Run *run, int *exit_status);
PetscBool LamFE2CheckTissuePaths(const char command[], const LamFE2Run *run, int *exit_status);

/* ---- fe2_report.c; on rank 0. ctx: a LamConsole ---- */
/* A step as JSON; peak_memory in MB. */
json_t *LamFE2StepToJSON(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory);
/* Prints the row (for the first step with the header) or the JSON object of a step; once, a warning that the tissue
   localises. */
PetscErrorCode LamFE2ReportStep(void *ctx, const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory);
/* The unit of reactions: "N per mm of thickness", of an axisymmetric body "N". */
const char *LamFE2ForceName(const LamFE2Run *run);
/* The columns of the reactions: names, or numbers. */
void LamFE2PrintSides(const LamFE2Run *run, const LamMacroStep *step, PetscBool names);
/* Prints summary and totals. */
PetscErrorCode LamFE2ReportEnd(const LamFE2Run *run, const LamConsole *console);
/* What is read off the curve of the loaded side, if asked for. */
PetscErrorCode LamFE2ReportTest(const LamFE2Run *run, const LamConsole *console);

#endif
