/* Quantiles of measured figures. */
#ifndef LAM_BENCH_QUANTILE_H
#define LAM_BENCH_QUANTILE_H

#include <stdlib.h>

static inline int CompareReals(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;

  return (x > y) - (x < y);
}

/* Sorts `values`. share: 0.5 the median, 1 the largest. 0 where there are none. */
static inline double Quantile(double values[], int n, double share)
{
  const int k = (int)(share * n);

  if (n == 0) return 0.0;
  qsort(values, (size_t)n, sizeof(*values), CompareReals);
  return values[k < n ? k : n - 1];
}

#endif
