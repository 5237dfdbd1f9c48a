/* The net work of closed cycles of strain, to rounding: Gauss points between the faces of cells that it crosses. */
#ifndef LAM_SUPPORT_STRAIN_CYCLE_H
#define LAM_SUPPORT_STRAIN_CYCLE_H

#include "analytic_table.h"

/* Net work of the polygon of n loads over the range of the energy on it; NaN where a state has no answer. */
double CycleWork(const AnalyticTable *t, int n, const LamLoad loads[]);
/* Corners of a cycle all over the cells of AddRough(t, 2, ..). */
void CycleCorners(const AnalyticTable *t, int n, uint64_t *seed, LamLoad loads[]);

#endif
