#include "tradeoff.h"
PetscErrorCode LamTradeoffPlot(const LamTradeoff *t, const char path[])
{
  (void)t;
  (void)path;
  return 0;
}
