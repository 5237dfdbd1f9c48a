/*
  The terminal of a command: its messages, and on stderr, if it is a terminal, a line that says what is being done, how
  much of it, and how long the rest will take. The line is drawn where a study reports progress or looks for a request
  to stop. Everything that is printed removes it first (LamConsoleClear).
*/
#include "app.h"
#include "clock.h"
#include <string.h>
#include <unistd.h>

enum { BAR_WIDTH = 24 };
#define REDRAW_SECONDS 0.1
#define SILENT_SECONDS 1.0 /* of an activity without progress, before the line appears */
#define ERASE "\r\033[K"   /* the line */

/* There is one terminal, and so one line. */
static struct {
  const LamConsole *console; /* whose; NULL: none is drawn */
  char activity[128];
  PetscReal start, drawn;         /* of the activity; of the line, 0: it is not on the screen */
  PetscInt64 done, total, failed; /* the last report, */
  PetscReal reported;             /* and its time; 0: there is none */
  PetscInt64 first;               /* done in the first report: before this run */
  PetscReal began;                /* time of the first report */
} Line;

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
  LamConsoleClear();
  fprintf(stderr, "lamella %s: %s\n", console->command, text);
}

static void PrintBar(PetscInt64 done, PetscInt64 total)
{
  const int filled = (int)(BAR_WIDTH * PetscMin(done, total) / total);

  fputs(" [", stderr);
  for (int i = 0; i < BAR_WIDTH; i++) fputc(i < filled ? '#' : '.', stderr);
  fputc(']', stderr);
}

static void Draw(PetscReal now)
{
  const PetscReal time = Line.reported - Line.began;
  const PetscReal rate = time > 0 ? (PetscReal)(Line.done - Line.first) / time : 0;

  Line.drawn = now;
  fprintf(stderr, ERASE "lamella %s:", Line.console->command);
  if (Line.activity[0]) fprintf(stderr, " %s", Line.activity);
  if (Line.total > 0) PrintBar(Line.done, Line.total);
  if (Line.reported > 0) fprintf(stderr, " %lld", (long long)Line.done);
  if (Line.total > 0) fprintf(stderr, "/%lld", (long long)Line.total);
  if (Line.failed) fprintf(stderr, ", %lld failed", (long long)Line.failed);
  fputs("  ", stderr);
  PrintDuration(now - Line.start);
  if (rate > 0) fprintf(stderr, "  %.3g/s", (double)rate);
  if (rate > 0 && Line.total > 0) {
    fputs("  ", stderr);
    PrintDuration(PetscMax(0, (PetscReal)(Line.total - Line.done) / rate - (now - Line.reported)));
    fputs(" left", stderr);
  }
  fflush(stderr);
}

/* A new activity is counted from its own start. */
static void FollowActivity(PetscReal now)
{
  if (Line.start > 0 && !strcmp(Line.activity, LamActivity())) return;
  (void)snprintf(Line.activity, sizeof(Line.activity), "%s", LamActivity());
  Line.start = now;
  Line.done = Line.total = Line.failed = 0;
  Line.reported = 0;
}

/* `watch` of LamStopSetWatch. */
static void Watch(void)
{
  const PetscReal now = LamClock();

  FollowActivity(now);
  if (now - Line.drawn < REDRAW_SECONDS || now - Line.start < SILENT_SECONDS) return;
  Draw(now);
}

/* `progress` of a LamReporter. */
static PetscErrorCode UpdateLine(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  const PetscReal now = LamClock();

  PetscFunctionBeginUser;
  if (Line.console != ctx) PetscFunctionReturn(0);
  FollowActivity(now);
  if (!(Line.reported > 0)) {
    Line.first = done;
    Line.began = now;
  }
  Line.done = done;
  Line.total = total;
  Line.failed = failed;
  Line.reported = now;
  if (Line.drawn > 0 && (done < total || !total) && now - Line.drawn < REDRAW_SECONDS) PetscFunctionReturn(0);
  Draw(now);
  PetscFunctionReturn(0);
}

LamReporter LamConsoleReporter(LamConsole *console)
{
  const PetscBool shown = (PetscBool)(!console->quiet && LamAppIsRoot() && isatty(STDERR_FILENO));

  Line.console = shown ? console : NULL;
  LamStopSetWatch(shown ? Watch : NULL);
  return (LamReporter){console, PrintMessage, UpdateLine};
}

void LamConsoleClear(void)
{
  if (Line.drawn > 0) fputs(ERASE, stderr);
  Line.drawn = 0;
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
