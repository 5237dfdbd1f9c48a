/*
  Terminal output, files and diagram of tradeoff.
*/
#ifndef LAM_TRADEOFF_REPORT_H
#define LAM_TRADEOFF_REPORT_H

#include "app.h"
#include "tradeoff.h"

void LamTradeoffPrint(const LamTradeoff *t);
PetscErrorCode LamTradeoffPrintJSON(const LamTradeoff *t);
/* Writes DIR/tradeoff.json, DIR/model.json; the folder must exist. */
PetscErrorCode LamTradeoffWrite(const LamTradeoff *t, const char directory[]);
/* Draws the diagram; the ending of `path` selects the format. */
PetscErrorCode LamTradeoffPlot(const LamTradeoff *t, const char path[]);

#endif
