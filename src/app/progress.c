/*
  Interactive progress: a bar, the rate and the remaining time, on a terminal only.
*/
#include "app.h"
#include "clock.h"
#include <unistd.h>

enum { BAR_WIDTH = 24 };
#define REDRAW_SECONDS 0.1

static void PrintDuration(PetscReal seconds)
{
  const long s = (long)(seconds + 0.5);

  if (s >= 3600)
    fprintf(stderr, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  else
    fprintf(stderr, "%ld:%02ld", s / 60, s % 60);
}

PetscErrorCode LamProgressStart(LamProgress *progress, PetscInt64 total, PetscBool quiet)
{
  PetscFunctionBeginUser;
  *progress = (LamProgress){.on = (PetscBool)(!quiet && LamAppIsRoot() && isatty(STDERR_FILENO)), .total = total};
  progress->start = LamClock();
  PetscFunctionReturn(0);
}

void LamProgressSetTotal(LamProgress *progress, PetscInt64 total)
{
  progress->total = total;
}

PetscErrorCode LamProgressUpdate(LamProgress *progress, PetscInt64 done, PetscInt64 failed)
{
  PetscReal now, rate;
  int filled;

  PetscFunctionBeginUser;
  if (!progress->on) PetscFunctionReturn(0);
  now = LamClock();
  if (done < progress->total && now - progress->drawn < REDRAW_SECONDS) PetscFunctionReturn(0);
  if (!progress->drawn) progress->first = done; /* work done by an earlier run does not count for the rate */
  progress->drawn = now;
  filled = progress->total > 0 ? (int)(BAR_WIDTH * PetscMin(done, progress->total) / progress->total) : BAR_WIDTH;
  fputs("\r\033[K[", stderr);
  for (int i = 0; i < BAR_WIDTH; i++) fputc(i < filled ? '#' : '.', stderr);
  fprintf(stderr, "] %lld/%lld", (long long)done, (long long)progress->total);
  rate = now > progress->start ? (PetscReal)(done - progress->first) / (now - progress->start) : 0;
  if (rate > 0) {
    fprintf(stderr, "  %.3g/s  ", rate);
    PrintDuration((PetscReal)(progress->total - done) / rate);
    fputs(" left", stderr);
  }
  if (failed) fprintf(stderr, "  %lld failed", (long long)failed);
  PetscFunctionReturn(0);
}

PetscErrorCode LamProgressEnd(LamProgress *progress)
{
  PetscFunctionBeginUser;
  if (progress->on) fputs("\r\033[K", stderr);
  progress->on = PETSC_FALSE;
  PetscFunctionReturn(0);
}
