/*
  What the program prints, writes and draws of tradeoff.
*/
#ifndef LAM_TRADEOFF_REPORT_H
#define LAM_TRADEOFF_REPORT_H

#include "app.h"
#include "tradeoff.h"

void LamTradeoffPrint(const LamTradeoff *t);
PetscErrorCode LamTradeoffPrintJSON(const LamTradeoff *t);
/* DIR/tradeoff.json, DIR/model.json; the folder is there. */
PetscErrorCode LamTradeoffWrite(const LamTradeoff *t, const char directory[]);
/* The diagram; the ending of `path` says the format. */
PetscErrorCode LamTradeoffPlot(const LamTradeoff *t, const char path[]);

#endif
