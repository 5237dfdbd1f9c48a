/*
  The terminal of a study: its messages, and a bar with the rate and the remaining time, on a terminal only.
*/
#include "app.h"
#include "clock.h"
#include <unistd.h>

enum { BAR_WIDTH = 24 };
#define REDRAW_SECONDS 0.1
#define ERASE "\r\033[K" /* the line of the bar */

static void PrintDuration(PetscReal seconds)
{
  const long s = (long)(seconds + 0.5);

  if (s >= 3600)
    fprintf(stderr, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  else
    fprintf(stderr, "%ld:%02ld", s / 60, s % 60);
}

static void PrintMessage(void *ctx, PetscBool warning, const char text[])
{
  const LamConsole *console = (const LamConsole *)ctx;

  if (!warning && console->quiet) return;
  if (console->drawn) fputs(ERASE, stderr); /* the next update draws the bar again */
  fprintf(stderr, "lamella %s: %s\n", console->command, text);
}

static void PrintBar(PetscInt64 done, PetscInt64 total)
{
  const int filled = (int)(BAR_WIDTH * PetscMin(done, total) / total);

  fputc('[', stderr);
  for (int i = 0; i < BAR_WIDTH; i++) fputc(i < filled ? '#' : '.', stderr);
  fputs("] ", stderr);
}

/* Message and progress functions of a LamReporter; work done by an earlier run does not count for the rate. */
static PetscErrorCode UpdateBar(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  LamConsole *console = (LamConsole *)ctx;
  const PetscReal now = LamClock();
  PetscReal rate;

  PetscFunctionBeginUser;
  if (console->quiet || console->has_rows || !LamAppIsRoot() || !isatty(STDERR_FILENO)) PetscFunctionReturn(0);
  if (console->drawn && (done < total || !total) && now - console->drawn < REDRAW_SECONDS) PetscFunctionReturn(0);
  if (!console->drawn) {
    console->start = now;
    console->first = done;
  }
  console->drawn = now;
  fputs(ERASE, stderr);
  if (total > 0) PrintBar(done, total);
  fprintf(stderr, "%lld", (long long)done);
  if (total > 0) fprintf(stderr, "/%lld", (long long)total);
  rate = now > console->start ? (PetscReal)(done - console->first) / (now - console->start) : 0;
  if (rate > 0) fprintf(stderr, "  %.3g/s", rate);
  if (rate > 0 && total > 0) {
    fputs("  ", stderr);
    PrintDuration((PetscReal)(total - done) / rate);
    fputs(" left", stderr);
  }
  if (failed) fprintf(stderr, "  %lld failed", (long long)failed);
  PetscFunctionReturn(0);
}

LamReporter LamConsoleReporter(LamConsole *console)
{
  return (LamReporter){console, PrintMessage, UpdateBar};
}

void LamConsoleClear(LamConsole *console)
{
  if (console->drawn) fputs(ERASE, stderr);
  console->drawn = 0;
}

void LamTellStopped(const LamConsole *console, const char path[], PetscBool resumes)
{
  if (!LamStopRequested() || !LamAppIsRoot()) return;
  if (!path)
    fprintf(stderr, "lamella %s: stopped: without -o OUT.h5 nothing is kept\n", console->command);
  else if (resumes)
    fprintf(stderr, "lamella %s: stopped: the same command with --resume goes on with %s\n", console->command, path);
  else
    fprintf(stderr, "lamella %s: stopped: %s has what came before; the same command begins anew\n", console->command,
            path);
}

PetscErrorCode LamShareOutcome(PetscBool unsolved, int *exit_status)
{
  PetscFunctionBeginUser;
  *exit_status = LamStopRequested() ? LamStopExitStatus() : unsolved ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
  PetscCallMPI(MPI_Bcast(exit_status, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
