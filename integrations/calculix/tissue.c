/*
  Threads: the list of materials and the RVEs, which the library solves in one thread at a time, are behind one lock;
  databases are queried by all threads at once.

  States: a host restores its state variables where it cuts an increment back, but they cannot hold the state of an RVE.
  So they hold its number, given once, and the library holds two states of a point: that of `begin`, from which all
  iterations of an increment start, and that which the last of them has reached. Where the number at the start of an
  increment is that of the second, the host has accepted it, and the first is forgotten.
*/
#include "tissue.h"
#include <lamella/bind.h>
#include <ctype.h>
#include <dirent.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

LAM_EXPORT const char *LamErrorMessage(void); /* of error.h, which wants the headers of PETSc */

enum { NAME = 81, PATH = 4096, LOAD = 11 /* numbers of a load in bind.h */ };

/* Out-of-plane components of F that differ by less from those of plane strain are rounding of a host's arithmetic: 2e-10 was
   seen in CalculiX. A solve with such a shear takes several times as long as one without. */
static const double ROUNDED = 1e-6;
/* Between F at the end of an increment and at the start of the next: more than rounding, and less than any strain that
   tells two states apart. */
static const double SAME_STATE = 1e-6;

typedef struct {
  double number; /* 0: undeformed tissue */
  double F[9];
  void *bytes; /* owned; NULL for undeformed tissue */
} State;

typedef struct {
  State begin, end;
} Point;

struct Tissue_s {
  Tissue next;
  char name[NAME];
  LamBindDatabase database; /* NULL: a scene */
  LamBindRVE rve;
  size_t state_size;
  double unit, accuracy, cohesion; /* Pa, 1, Pa */
  int elements, points;            /* rows and columns of `states` */
  Point **states;                  /* by element and integration point; of a scene */
};

static pthread_mutex_t Lock = PTHREAD_MUTEX_INITIALIZER;
static Tissue Tissues;
static double LastNumber;
static struct {
  size_t P, tangent, status, reason;
  int status_member;
} Offset; /* in a response */

void TissueFail(const char format[], ...)
{
  static pthread_mutex_t once = PTHREAD_MUTEX_INITIALIZER; /* several threads may fail at a time */
  va_list words;

  pthread_mutex_lock(&once);
  va_start(words, format);
  printf("\n *ERROR in Lamella: ");
  vprintf(format, words);
  printf("\n\n");
  va_end(words);
  fflush(stdout);
  exit(201); /* as CalculiX does */
}

static void Check(int code)
{
  if (code) TissueFail("%s", LamErrorMessage());
}

static void *Allocate(void *old, size_t bytes)
{
  void *new = realloc(old, bytes);

  if (!new) TissueFail("no memory for %zu bytes", bytes);
  return new;
}

/* ---- materials ---- */

/* Whether the names are the same irrespective of capitals; an underscore of the host's may stand for a point. */
static int IsFileOf(const char name[], const char file[])
{
  for (; *name && *file; name++, file++)
    if (tolower((unsigned char)*name) != tolower((unsigned char)*file) && !(*name == '_' && *file == '.')) return 0;
  return !*name && !*file;
}

static void FindFile(const char material[], char path[PATH])
{
  const char *at = strrchr(material, '@'), *name = at ? at + 1 : material, *told = getenv("LAMELLA_FOLDER");
  const char *folder = told ? told : ".";
  DIR *files = opendir(folder);
  struct dirent *file;

  if (!files) TissueFail("material %s: the folder %s cannot be read", material, folder);
  path[0] = '\0';
  while ((file = readdir(files))) {
    if (!IsFileOf(name, file->d_name)) continue;
    if (path[0]) TissueFail("material %s: both %s and %s/%s have its name", material, path, folder, file->d_name);
    snprintf(path, PATH, "%s/%s", folder, file->d_name);
  }
  closedir(files);
  if (!path[0])
    TissueFail(
        "material %s: there is no file %s in the folder %s; capitals do not matter, an underscore may stand for a "
        "point, and the variable LAMELLA_FOLDER names another folder",
        material, name, folder);
}

static int IsDatabase(const char path[])
{
  const size_t length = strlen(path);

  return length > 3 && !strcasecmp(&path[length - 3], ".h5");
}

static void FindMembers(void)
{
  const char *name, *unit, *help;
  size_t offset;
  int count;
  char type;

  for (int i = 0; (name = LamBindMember(i, &type, &count, &offset, &unit, &help)); i++) {
    if (!strcmp(name, "P")) Offset.P = offset;
    if (!strcmp(name, "tangent")) Offset.tangent = offset;
    if (!strcmp(name, "reason")) Offset.reason = offset;
    if (!strcmp(name, "status")) {
      Offset.status = offset;
      Offset.status_member = i;
    }
  }
}

static void OpenScene(const char path[], Tissue t)
{
  double numbers[4];
  LamBindScene scene;

  Check(LamBindSceneRead(path, NULL, &scene));
  Check(LamBindSceneIsMaterial(scene));
  LamBindSceneNumbers(scene, numbers);
  t->cohesion = numbers[3];
  Check(LamBindRVECreate(scene, &t->rve));
  Check(LamBindRVEStateSize(t->rve, &t->state_size));
  LamBindSceneDestroy(scene);
}

static Tissue Open(const char name[], int n, const double constants[])
{
  Tissue t = Allocate(NULL, sizeof(*t));
  double numbers[5];
  char path[PATH];
  int wanted;

  Check(LamBindStart());
  FindMembers();
  *t = (struct Tissue_s){.next = Tissues};
  snprintf(t->name, sizeof(t->name), "%s", name);
  FindFile(name, path);
  wanted = IsDatabase(path) ? 2 : 1;
  if (n != wanted)
    TissueFail("material %s: %d constants; %s wants %s", name, n, path,
               wanted == 1 ? "1: the unit of stress in Pa"
                           : "2: the unit of stress in Pa, and the largest estimated error at which it answers");
  t->unit = constants[0];
  if (!(t->unit > 0) || isinf(t->unit)) TissueFail("material %s: unit of stress %g Pa", name, t->unit);
  if (wanted == 1) {
    OpenScene(path, t);
  } else {
    t->accuracy = constants[1];
    if (!(t->accuracy > 0)) TissueFail("material %s: largest estimated error %g: above 0", name, t->accuracy);
    Check(LamBindDatabaseOpen(path, &t->database));
    LamBindDatabaseNumbers(t->database, numbers);
    t->cohesion = numbers[3];
  }
  return Tissues = t;
}

Tissue TissueFind(const char name[], int length, int n, const double constants[])
{
  char trimmed[NAME];
  Tissue t;

  snprintf(trimmed, sizeof(trimmed), "%.*s", TissueTrim(name, length), name);
  pthread_mutex_lock(&Lock);
  for (t = Tissues; t && strcmp(t->name, trimmed); t = t->next) continue;
  if (!t) t = Open(trimmed, n, constants);
  pthread_mutex_unlock(&Lock);
  return t;
}

/* ---- states ---- */

static Point *FindPoint(Tissue t, int element, int point)
{
  if (element >= t->elements) {
    t->states = Allocate(t->states, (size_t)(2 * element + 1) * sizeof(*t->states));
    while (t->elements < 2 * element + 1) t->states[t->elements++] = NULL;
  }
  if (point >= t->points) { /* rows hold as many points as the largest so far; rarely more than once */
    for (int e = 0; e < t->elements; e++) {
      if (!t->states[e]) continue;
      t->states[e] = Allocate(t->states[e], (size_t)(point + 1) * sizeof(Point));
      memset(&t->states[e][t->points], 0, (size_t)(point + 1 - t->points) * sizeof(Point));
    }
    t->points = point + 1;
  }
  if (!t->states[element]) {
    t->states[element] = Allocate(NULL, (size_t)t->points * sizeof(Point));
    memset(t->states[element], 0, (size_t)t->points * sizeof(Point));
  }
  return &t->states[element][point];
}

/* Whether the state belongs to a point with this number and F at the start of an increment. */
static int IsStateOf(const State *state, double number, const double F0[9])
{
  double difference = 0;

  for (int i = 0; i < 9; i++) difference = fmax(difference, fabs(F0[i] - (state->bytes ? state->F[i] : i % 4 == 0)));
  return number == state->number && difference <= SAME_STATE;
}

/* Makes the RVE go on from the state with which the increment begins. */
static void Begin(Tissue t, const TissueLoad *load, double number, Point *p)
{
  if (p->end.bytes && IsStateOf(&p->end, number, load->F0)) {
    free(p->begin.bytes);
    p->begin = p->end;
    p->end = (State){0};
  }
  if (!IsStateOf(&p->begin, number, load->F0))
    TissueFail(
        "material %s, element %d, point %d: the increment begins with state %.0f at F = %.6g %.6g %.6g %.6g, which "
        "is not the last accepted one, %.0f. States of a scene are in the program's memory: a run cannot be "
        "restarted from a file, nor go back; take a database",
        t->name, load->element, load->point, number, load->F0[0], load->F0[1], load->F0[3], load->F0[4],
        p->begin.number);
  Check(p->begin.bytes ? LamBindRVESetState(t->rve, p->begin.bytes) : LamBindRVEReset(t->rve));
}

static void Keep(Tissue t, const TissueLoad *load, Point *p)
{
  p->end.bytes = Allocate(p->end.bytes, t->state_size);
  Check(LamBindRVEGetState(t->rve, p->end.bytes));
  p->end.number = ++LastNumber;
  memcpy(p->end.F, load->F, sizeof(p->end.F));
}

/* ---- responses ---- */

/* The load as a row of bind.h. */
static void FillLoad(Tissue t, const TissueLoad *load, double row[])
{
  memcpy(row, load->F, 9 * sizeof(*row));
  row[9] = load->turgor * t->unit;
  row[10] = t->cohesion;
}

void TissueGradient(const double columns[9], double F[9])
{
  for (int i = 0; i < 9; i++) F[i] = columns[3 * (i % 3) + i / 3];
}

void TissueRound(double F[9])
{
  static const int shears[4] = {2, 5, 6, 7};
  int plane = 1;

  for (int k = 0; k < 4; k++) plane = plane && fabs(F[shears[k]]) <= ROUNDED;
  for (int k = 0; k < 4 && plane; k++) F[shears[k]] = 0;
  if (fabs(F[8] - 1) <= ROUNDED) F[8] = 1;
}

/* Copies what is needed of a response of the library; returns whether it is one of a stable equilibrium. */
static int Take(const Tissue t, const char raw[], TissueResponse *response)
{
  int status;

  memcpy(&status, &raw[Offset.status], sizeof(status));
  memcpy(response->P, &raw[Offset.P], sizeof(response->P));
  memcpy(response->tangent, &raw[Offset.tangent], sizeof(response->tangent));
  for (int i = 0; i < 9; i++) response->P[i] /= t->unit;
  for (int i = 0; i < 81; i++) response->tangent[i] /= t->unit;
  if (!strcmp(LamBindMemberName(Offset.status_member, status), "converged")) return 1;
  snprintf(response->reason, sizeof(response->reason), "%s: %s", LamBindMemberName(Offset.status_member, status),
           &raw[Offset.reason]);
  return 0;
}

static int Solve(Tissue t, const TissueLoad *load, double number, int keep, TissueResponse *response)
{
  double row[LOAD], raw[LamBindResponseSize() / sizeof(double) + 1];
  Point *p;
  int known;

  FillLoad(t, load, row);
  p = FindPoint(t, load->element, load->point);
  Begin(t, load, number, p);
  Check(LamBindRVESolve(t->rve, 1, row, NULL, 1, 0, raw));
  known = Take(t, (const char *)raw, response);
  if (known && keep) Keep(t, load, p);
  return known;
}

static int Query(Tissue t, const TissueLoad *load, TissueResponse *response)
{
  double row[LOAD], raw[LamBindResponseSize() / sizeof(double) + 1];

  FillLoad(t, load, row);
  Check(LamBindDatabaseQuery(t->database, 1, row, t->accuracy, raw));
  return Take(t, (const char *)raw, response);
}

int TissueRespond(Tissue t, const TissueLoad *load, const double begin[TISSUE_VARIABLES], double end[TISSUE_VARIABLES],
                  TissueResponse *response)
{
  double number = 0;
  int known;

  if (t->database) {
    known = Query(t, load, response);
  } else {
    pthread_mutex_lock(&Lock);
    known = Solve(t, load, begin[TISSUE_STATE], end != NULL, response);
    number = LastNumber;
    pthread_mutex_unlock(&Lock);
  }
  if (!known || !end) return known;
  end[TISSUE_STATE] = number;
  end[TISSUE_TURGOR] = load->turgor;
  return 1;
}

void TissueReport(const TissueLoad *load, double time, const char reason[])
{
  static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
  static double last = -1;

  pthread_mutex_lock(&lock);
  if (time != last)
    printf(
        "\n *INFO from Lamella: the increment is halved: element %d, point %d, F = %.6g %.6g %.6g %.6g, turgor %.6g: "
        "%s\n",
        load->element, load->point, load->F[0], load->F[1], load->F[3], load->F[4], load->turgor, reason);
  last = time;
  pthread_mutex_unlock(&lock);
}
