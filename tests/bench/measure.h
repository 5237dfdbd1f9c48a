/* What bench programs measure with: processor time, peak memory, quantiles. */
#ifndef LAM_BENCH_MEASURE_H
#define LAM_BENCH_MEASURE_H

#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

/* Of this process, s: on a busy machine less noisy than the clock on the wall. */
static inline double ProcessorSeconds(void)
{
  struct timespec t;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Of this process, MiB. */
static inline double PeakMemory(void)
{
  struct rusage usage;

  return getrusage(RUSAGE_SELF, &usage) ? NAN : (double)usage.ru_maxrss / 1024.0;
}

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
