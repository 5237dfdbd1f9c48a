/*
  The map of extremes: solves the states of extremes_case.h, judges each, and writes one line of JSON for each to a
  file; a run that was interrupted goes on where it ended.

    extremes FILE.jsonl [--first ID] [--count N] [--jobs J] [--no-routes]     N states, by default all pairs of ends
    extremes FILE.jsonl --ids LIST [...]                                      those of a file of numbers
    extremes FILE.jsonl --picture                                             SVG of the pairs
    extremes --scene ID                                                       the scene of a state
    extremes --list [--first ID] [--count N]                                  their quantities

  States are solved by worker processes, so that a crash or an endless run is an entry of the map, too. Exit status 3: a
  state is not finite, slow or has crashed; estimates that are too small are counted.
*/
#include "extremes_picture.h"
#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <jansson.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MAX_JOBS = 64 };
#define PATIENCE 300.0 /* s of processor time for a state with its routes, after which a worker is ended */

typedef struct {
  pid_t process;
  int questions, answers; /* pipes */
  PetscInt id;            /* being solved; -1: idle */
  double since;
} Worker;

typedef struct {
  const char *path;
  PetscInt first, end, jobs;
  PetscBool routes;
  const char *list; /* file of numbers; NULL: all */
  char *done;       /* [end - first] */
  int file;
} Run;

/* Processor time of a worker, s: what else runs on the machine does not make a state slow. */
static double Clock(pid_t process)
{
  struct timespec t = {0};
  clockid_t clock;

  if (!clock_getcpuclockid(process, &clock)) clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static json_t *Real(PetscReal value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

static json_t *Response(const LamResponse *r)
{
  json_t *P = json_array();

  for (int i = 0; i < 9; i++) json_array_append_new(P, Real(r->P[i]));
  return json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:i, s:i, s:i, s:i, s:i}", "status", LamStatusNames[r->status],
                   "reason", r->reason, "P", P, "energy", Real(r->energy), "lumen", Real(r->lumen_fraction), "estimate",
                   Real(r->error_estimate), "branch", (int)r->branch, "floating", (int)r->floating_cells, "zero_modes",
                   (int)r->zero_modes, "unknowns", (int)r->unknowns, "factorisations", (int)r->factorisations);
}

static json_t *Line(const ExtremesCase *c, const ExtremesResult *r, PetscBool routes)
{
  json_t *object = json_object(), *axes = json_object();

  json_object_set_new(object, "id", json_integer(c->id));
  json_object_set_new(object, "verdict", json_string(ExtremesVerdictNames[r->verdict]));
  json_object_set_new(object, "contact", json_boolean(c->contact));
  if (c->pair[0] >= 0)
    json_object_set_new(object, "pair",
                        json_pack("[s, s]", ExtremesAxisNames[c->pair[0]], ExtremesAxisNames[c->pair[1]]));
  for (int k = 0; k < EXTREMES_AXIS_COUNT; k++) json_object_set_new(axes, ExtremesAxisNames[k], Real(c->value[k]));
  json_object_set_new(object, "axes", axes);
  json_object_set_new(object, "seconds", Real(r->seconds));
  json_object_set_new(object, "state", Response(&r->state));
  if (routes && r->state.status == LAM_CONVERGED) {
    json_object_set_new(object, "path_error", Real(r->path_error));
    json_object_set_new(object, "other_error", Real(r->other_error));
    json_object_set_new(object, "mesh_error", Real(r->mesh_error));
    json_object_set_new(object, "path", Response(&r->path));
    if (c->contact) json_object_set_new(object, "other", Response(&r->other));
    if (r->finer.unknowns) json_object_set_new(object, "finer", Response(&r->finer));
  }
  return object;
}

/* One write to a file opened for appending: lines of several workers do not mix. */
static void Append(int file, json_t *object)
{
  char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(12));
  const size_t length = strlen(text);

  text[length] = '\n';
  if (write(file, text, length + 1) != (ssize_t)length + 1) fprintf(stderr, "extremes: %s\n", strerror(errno));
  free(text);
  json_decref(object);
}

/* ---- a worker ---- */

static PetscErrorCode Work(const Run *run, int questions, int answers)
{
  PetscInt id;

  PetscFunctionBeginUser;
  while (read(questions, &id, sizeof(id)) == sizeof(id) && id >= 0) {
    ExtremesCase c;
    ExtremesResult result;

    ExtremesCaseMake(id, &c);
    PetscCall(ExtremesJudge(&c, run->routes, &result));
    Append(run->file, Line(&c, &result, run->routes));
    if (write(answers, &id, sizeof(id)) != sizeof(id)) break;
  }
  PetscFunctionReturn(0);
}

static void Start(const Run *run, Worker *worker)
{
  int questions[2], answers[2];

  if (pipe(questions) || pipe(answers)) exit(1);
  worker->process = fork();
  if (worker->process == 0) {
    PetscErrorCode ierr;

    close(questions[1]);
    close(answers[0]);
    ierr = PetscInitialize(NULL, NULL, NULL, NULL);
    if (!ierr) ierr = Work(run, questions[0], answers[1]);
    _exit(ierr ? 1 : 0);
  }
  close(questions[0]);
  close(answers[1]);
  worker->questions = questions[1];
  worker->answers = answers[0];
  worker->id = -1;
}

/* By a word: the end of its pipe would not come, which workers that started later hold open, too. */
static void End(Worker *worker)
{
  const PetscInt no_more = -1;

  if (write(worker->questions, &no_more, sizeof(no_more)) < 0 && errno != EPIPE)
    fprintf(stderr, "extremes: %s\n", strerror(errno));
  close(worker->questions);
  close(worker->answers);
  waitpid(worker->process, NULL, 0);
}

/* ---- the run ---- */

/* Calls `take` with each line of the file of the run; PETSC_FALSE: there is none. */
static PetscBool ForLines(const char path[], void (*take)(json_t *object, void *ctx), void *ctx)
{
  FILE *file = fopen(path, "r");
  char *line = NULL;
  size_t size = 0;

  while (file && getline(&line, &size, file) > 0) {
    json_t *object = json_loads(line, 0, NULL);

    if (object) take(object, ctx);
    json_decref(object);
  }
  free(line);
  if (file) fclose(file);
  return (PetscBool)(file != NULL);
}

static void TakeDone(json_t *object, void *ctx)
{
  Run *run = ctx;
  const PetscInt id = (PetscInt)json_integer_value(json_object_get(object, "id"));

  if (id >= run->first && id < run->end) run->done[id - run->first] = 1;
}

/* A line that a kill has cut ends where it was cut. */
static void EndLine(int file)
{
  char last = '\n';
  const off_t size = lseek(file, 0, SEEK_END);

  if (size > 0 && pread(file, &last, 1, size - 1) == 1 && last != '\n' && write(file, "\n", 1) != 1)
    fprintf(stderr, "extremes: %s\n", strerror(errno));
}

/* All but those of the list count as done. */
static void ReadList(Run *run)
{
  FILE *file = fopen(run->list, "r");
  int id;

  memset(run->done, 1, (size_t)(run->end - run->first));
  while (file && fscanf(file, "%d", &id) == 1)
    if (id >= run->first && id < run->end) run->done[id - run->first] = 0;
  if (file) fclose(file);
}

static PetscInt Next(Run *run)
{
  for (PetscInt id = run->first; id < run->end; id++)
    if (!run->done[id - run->first]) {
      run->done[id - run->first] = 1;
      return id;
    }
  return -1;
}

/* A worker that died or does not come back. */
static void Bury(Run *run, Worker *worker, PetscBool late)
{
  ExtremesCase c;
  ExtremesResult result = {.verdict = late ? EXTREMES_SLOW : EXTREMES_CRASH,
                           .seconds = Clock(worker->process) - worker->since};

  if (late) kill(worker->process, SIGKILL);
  ExtremesCaseMake(worker->id, &c);
  PetscCallAbort(PETSC_COMM_SELF, LamResponseInit(&(LamLoad){0}, &result.state));
  Append(run->file, Line(&c, &result, PETSC_FALSE));
  fprintf(stderr, "\nextremes: state %d: %s\n", (int)worker->id, ExtremesVerdictNames[result.verdict]);
  End(worker);
  Start(run, worker);
}

/* Gives every idle worker a state; the number of those at work. */
static PetscInt Deal(Run *run, Worker workers[])
{
  PetscInt busy = 0;

  for (PetscInt w = 0; w < run->jobs; w++) {
    if (workers[w].id < 0) {
      workers[w].id = Next(run);
      workers[w].since = Clock(workers[w].process);
      if (workers[w].id >= 0 && write(workers[w].questions, &workers[w].id, sizeof(PetscInt)) < 0) exit(1);
    }
    busy += workers[w].id >= 0;
  }
  return busy;
}

static void Supervise(Run *run)
{
  Worker workers[MAX_JOBS];
  PetscInt solved = 0;
  struct pollfd answers[MAX_JOBS];

  for (PetscInt w = 0; w < run->jobs; w++) Start(run, &workers[w]);
  while (Deal(run, workers)) {
    for (PetscInt w = 0; w < run->jobs; w++) answers[w] = (struct pollfd){workers[w].answers, POLLIN, 0};
    poll(answers, (nfds_t)run->jobs, 1000);
    for (PetscInt w = 0; w < run->jobs; w++) {
      PetscInt id;

      if (workers[w].id < 0) continue;
      if (answers[w].revents && read(workers[w].answers, &id, sizeof(id)) != sizeof(id))
        Bury(run, &workers[w], PETSC_FALSE);
      else if (answers[w].revents)
        workers[w].id = -1, solved++;
      else if (Clock(workers[w].process) - workers[w].since > PATIENCE)
        Bury(run, &workers[w], PETSC_TRUE);
    }
    if (isatty(STDERR_FILENO)) fprintf(stderr, "\r%d", (int)solved);
  }
  for (PetscInt w = 0; w < run->jobs; w++) End(&workers[w]);
}

/* Of a line, as a number; -1: none. */
static int Verdict(json_t *object)
{
  const char *verdict = json_string_value(json_object_get(object, "verdict"));

  for (int v = 0; v < EXTREMES_VERDICT_COUNT && verdict; v++)
    if (!strcmp(verdict, ExtremesVerdictNames[v])) return v;
  return -1;
}

static void TakeVerdict(json_t *object, void *ctx)
{
  const json_int_t id = json_integer_value(json_object_get(object, "id"));

  if (id >= 0 && id < ExtremesPairCount()) ((int *)ctx)[id] = Verdict(object);
}

static int Draw(const Run *run)
{
  int *verdicts = malloc((size_t)ExtremesPairCount() * sizeof(*verdicts));
  PetscBool is_read;

  for (PetscInt id = 0; id < ExtremesPairCount(); id++) verdicts[id] = -1;
  is_read = ForLines(run->path, TakeVerdict, verdicts);
  ExtremesPicture(verdicts);
  free(verdicts);
  return is_read ? 0 : 1;
}

static void TakeCount(json_t *object, void *ctx)
{
  PetscInt(*counts)[2] = ctx;
  const int verdict = Verdict(object);

  if (verdict >= 0) counts[verdict][json_is_true(json_object_get(object, "contact"))]++;
}

/* Counts by verdict, bonded and in contact, of what the file holds of this run; whether nothing is worse than an
   estimate that is too small. */
static PetscBool Summarise(const Run *run)
{
  PetscInt counts[EXTREMES_VERDICT_COUNT][2] = {{0}}, bad = 0;

  ForLines(run->path, TakeCount, counts);
  printf("%-16s %8s %8s\n", "verdict", "bonded", "contact");
  for (int v = 0; v < EXTREMES_VERDICT_COUNT; v++) {
    printf("%-16s %8d %8d\n", ExtremesVerdictNames[v], (int)counts[v][0], (int)counts[v][1]);
    if (v > EXTREMES_WRONG) bad += counts[v][0] + counts[v][1];
  }
  return (PetscBool)!bad;
}

static int PrintScene(PetscInt id)
{
  ExtremesCase c;
  char text[EXTREMES_TEXT];

  ExtremesCaseMake(id, &c);
  ExtremesSceneWrite(&c, &(ExtremesRoute){.finer = 1, .ramp = 1}, sizeof(text), text);
  fputs(text, stdout);
  return 0;
}

static int PrintList(const Run *run)
{
  for (PetscInt id = run->first; id < run->end; id++) {
    ExtremesCase c;

    ExtremesCaseMake(id, &c);
    printf("%d %d", (int)id, (int)c.contact);
    for (PetscInt k = 0; k < EXTREMES_AXIS_COUNT; k++) printf(" %.4g", (double)c.value[k]);
    putchar('\n');
  }
  return 0;
}

static int Usage(void)
{
  fprintf(stderr, "extremes FILE.jsonl [--first ID] [--count N] [--ids LIST] [--jobs J] [--no-routes]\n"
                  "extremes FILE.jsonl --picture\nextremes --list [--first ID] [--count N]\nextremes --scene ID\n");
  return 1;
}

static int SolveAll(Run *run)
{
  run->done = calloc((size_t)(run->end - run->first), 1);
  if (run->list) ReadList(run);
  ForLines(run->path, TakeDone, run);
  run->file = open(run->path, O_RDWR | O_CREAT | O_APPEND, 0644);
  EndLine(run->file);
  signal(SIGPIPE, SIG_IGN);
  Supervise(run);
  close(run->file);
  free(run->done);
  return Summarise(run) ? 0 : 3;
}

int main(int argc, char **argv)
{
  static const struct option names[] = {{"scene", required_argument, NULL, 's'},
                                        {"count", required_argument, NULL, 'n'},
                                        {"first", required_argument, NULL, 'f'},
                                        {"jobs", required_argument, NULL, 'j'},
                                        {"ids", required_argument, NULL, 'i'},
                                        {"no-routes", no_argument, NULL, 'r'},
                                        {"picture", no_argument, NULL, 'p'},
                                        {"list", no_argument, NULL, 'l'},
                                        {0}};
  Run run = {.first = 0, .end = ExtremesPairCount(), .jobs = 1, .routes = PETSC_TRUE};
  PetscInt count = -1;
  int option, what = 0;

  while ((option = getopt_long(argc, argv, "", names, NULL)) != -1) {
    if (option == '?') return Usage();
    if (option == 's') return PrintScene(atoi(optarg));
    if (option == 'n') count = atoi(optarg);
    if (option == 'f') run.first = atoi(optarg);
    if (option == 'j') run.jobs = PetscMin(MAX_JOBS, PetscMax(1, atoi(optarg)));
    if (option == 'i') run.list = optarg, run.end = 1000000;
    if (option == 'r') run.routes = PETSC_FALSE;
    if (option == 'p' || option == 'l') what = option;
  }
  run.path = argv[optind];
  if (count >= 0 || run.first >= run.end) run.end = run.first + PetscMax(1, count);
  if (what == 'l') return PrintList(&run);
  if (!run.path) return Usage();
  return what == 'p' ? Draw(&run) : SolveAll(&run);
}
