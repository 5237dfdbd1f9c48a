/*
  Output of processes.
*/
#ifndef LAM_PROCESS_REPORT_H
#define LAM_PROCESS_REPORT_H

#include "fe2_report.h"
#include "process_run.h"

/* ---- at a material point; ctx: a LamConsole ---- */
/* Prints the last state of the history: a row of a table (the first with its header) or a JSON object. */
PetscErrorCode LamProcessReport(void *ctx, const LamProcessStudy *study);
PetscErrorCode LamProcessReportEnd(const LamConsole *console, const LamProcessStudy *study, LamProcessReason reason,
                                   const char message[]);

/* ---- of a body; rank 0 ---- */
PetscErrorCode LamBodyReport(void *ctx, const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory);
PetscErrorCode LamBodyReportEnd(const LamBodyStudy *study);

#endif
