#include "schedule.h"
#include <math.h>

/* Pieces of like cost wait together: four classes to a doubling. */
enum { CLASSES = 256, CLASS_OF_ONE = 96, CLASSES_PER_DOUBLING = 4 };
/* Of a child's pieces, before its speed is believed; the older half is forgotten after so many more. */
enum { ENOUGH_TO_JUDGE = 16, MEMORY = 256 };
enum { MOST_AHEAD = 1000 };
#define SLOW 0.4 /* of the mean speed */

/* Pieces first .. first + count - 1. */
typedef struct {
  PetscInt64 first, count;
  PetscReal cost; /* of each */
} Range;

/* A queue: ranges begin .. n - 1. */
typedef struct {
  PetscInt begin, n, room;
  Range *ranges; /* owned */
} Class;

typedef struct {
  PetscInt64 piece;
  PetscReal cost;
  PetscInt other;  /* a child that has it, too; -1: none */
  PetscBool stale; /* the other was faster */
} Held;

/* What has been done, and in what time all ranks together would have done it. */
typedef struct {
  PetscInt64 pieces;
  PetscReal cost, seconds;
} Work;

typedef struct {
  PetscInt capacity;
  PetscInt n, room;
  PetscInt shared; /* of the n, those that another child has, too */
  Held *held;      /* [n], in the order they were given; owned */
  PetscReal since; /* the last result, or the piece that ended its idleness */
  Work work;       /* seconds: of the child, whatever its capacity */
  PetscBool slow;
} Child;

struct LamSchedule_s {
  PetscInt children, capacity, slow;
  Child *child; /* [children]; owned */
  PetscReal answer;
  Class queue[CLASSES];
  PetscInt64 waiting, out, stale;
  PetscInt occupied; /* ranks that have a piece */
  PetscReal waiting_cost;
  Work work; /* seconds: of one rank, summed over ranks */
};

/* ---- the queue ---- */

static int ClassOf(PetscReal cost)
{
  const PetscReal class = CLASS_OF_ONE + CLASSES_PER_DOUBLING * log2(cost);

  return (int)PetscMax(0, PetscMin(CLASSES - 1, class));
}

PetscErrorCode LamScheduleAdd(LamSchedule schedule, PetscInt64 first, PetscInt64 count, PetscReal cost)
{
  Class *class = &schedule->queue[ClassOf(cost)];
  Range *last = class->n > class->begin ? &class->ranges[class->n - 1] : NULL;

  PetscFunctionBeginUser;
  PetscCheck(cost > 0 && isfinite(cost), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "a cost of %g", (double)cost);
  schedule->waiting += count;
  schedule->waiting_cost += (PetscReal)count * cost;
  if (last && last->cost == cost && last->first + last->count == first) {
    last->count += count;
    PetscFunctionReturn(0);
  }
  if (class->begin == class->n) class->begin = class->n = 0;
  if (class->n == class->room) {
    class->room = PetscMax(16, 2 * class->room);
    PetscCall(PetscRealloc((size_t) class->room * sizeof(*class->ranges), &class->ranges));
  }
  class->ranges[class->n++] = (Range){first, count, cost};
  PetscFunctionReturn(0);
}

/* The range that holds the longest piece, or the shortest; NULL: none waits. */
static Range *Extreme(LamSchedule s, PetscBool longest, Class **owner)
{
  for (int i = 0; i < CLASSES; i++) {
    Class *class = &s->queue[longest ? CLASSES - 1 - i : i];

    *owner = class;
    if (class->begin < class->n) return &class->ranges[longest ? class->begin : class->n - 1];
  }
  return NULL;
}

/* Takes the first piece of the range of the longest, or the last one of that of the shortest. */
static Held Pop(LamSchedule s, Class *class, Range *range, PetscBool longest)
{
  const Held held = {
      .piece = longest ? range->first++ : range->first + range->count - 1, .cost = range->cost, .other = -1};

  range->count--;
  if (!range->count) {
    if (longest)
      class->begin++;
    else
      class->n--;
  }
  s->waiting--;
  s->waiting_cost = s->waiting ? s->waiting_cost - held.cost : 0;
  return held;
}

/* ---- speeds ---- */

static void Remember(Work *work, PetscReal cost, PetscReal seconds)
{
  if (work->pieces >= 2 * MEMORY) {
    work->pieces /= 2;
    work->cost /= 2;
    work->seconds /= 2;
  }
  work->pieces++;
  work->cost += cost;
  work->seconds += seconds;
}

static PetscReal Speed(const Work *work)
{
  return work->seconds > 0 ? work->cost / work->seconds : 0;
}

/* Of one rank below the child. */
static PetscReal RankSpeed(const Child *child)
{
  return Speed(&child->work) / child->capacity;
}

static void Judge(LamSchedule s, Child *child)
{
  const PetscBool slow = (PetscBool)(child->work.pieces >= ENOUGH_TO_JUDGE * (PetscInt64)PetscMin(child->capacity, 8) &&
                                     RankSpeed(child) < SLOW * Speed(&s->work));

  s->slow += (PetscInt)slow - (PetscInt)child->slow;
  child->slow = slow;
}

/* ---- who gets what ---- */

/*
  So many pieces the child shall have: one for each of its ranks; ahead of them one more, one for those on the way to
  the ranks where it hands out itself, and what is done while it waits for an answer. Towards the end its part of the
  rest.
*/
static PetscInt64 Share(LamSchedule s, const Child *child)
{
  const PetscReal piece = s->work.pieces ? s->work.seconds / (PetscReal)s->work.pieces : 0;
  const PetscReal ahead = 1 + (child->capacity > 1) + (piece > 0 ? floor(s->answer / piece) : 0);
  const PetscReal rest = (PetscReal)(s->waiting - (s->capacity - s->occupied)) / (PetscReal)s->capacity;

  return child->capacity + (PetscInt64)(child->capacity * PetscMax(0, PetscMin(PetscMin(MOST_AHEAD, ahead), rest)));
}

/* Whether this child would be done with the piece after all the others are done with everything else. */
static PetscBool ComesLast(LamSchedule s, const Child *child, const Range *range)
{
  const PetscReal speed = Speed(&s->work);

  if (!child->slow) return PETSC_FALSE;
  return (PetscBool)(range->cost / RankSpeed(child) > s->waiting_cost / (speed * s->capacity) + range->cost / speed);
}

static PetscErrorCode Hold(LamSchedule s, Child *child, PetscReal now, Held held)
{
  PetscFunctionBeginUser;
  if (child->n == child->room) {
    child->room = PetscMax(4, 2 * child->room);
    PetscCall(PetscRealloc((size_t)child->room * sizeof(*child->held), &child->held));
  }
  if (!child->n) child->since = now;
  child->held[child->n++] = held;
  s->occupied += child->n <= child->capacity;
  s->out++;
  PetscFunctionReturn(0);
}

/* The last piece of a child that nobody else has, from held[first] on; NULL: there is none. */
static Held *LastUncopied(const Child *child, PetscInt first)
{
  if (child->n - first <= child->shared) return NULL;
  for (PetscInt i = child->n - 1; i >= first; i--)
    if (child->held[i].other < 0) return &child->held[i];
  return NULL;
}

/*
  For a child that has nothing to do, a piece of another: one that is not begun, of the child that is longest without a
  result, or else any one of a slow child. NULL: there is none.
*/
static Held *FindToCopy(LamSchedule s, const Child *taker, PetscInt *from)
{
  PetscReal since = PETSC_INFINITY;
  Held *found = NULL;

  for (PetscInt c = 0; c < s->children && (s->out > s->occupied || s->slow); c++) {
    const Child *holder = &s->child[c];
    Held *held;

    if (holder == taker || holder->since >= since) continue;
    held = LastUncopied(holder, holder->slow ? 0 : holder->capacity);
    if (!held) continue;
    found = held;
    *from = c;
    since = holder->since;
  }
  return found;
}

static PetscErrorCode TakeCopies(LamSchedule s, Child *child, PetscReal now, PetscInt most, PetscInt *n,
                                 PetscInt64 pieces[])
{
  PetscFunctionBeginUser;
  while (*n < most && child->n < child->capacity && !child->slow) {
    PetscInt from;
    Held *held = FindToCopy(s, child, &from), copy;

    if (!held) break;
    held->other = (PetscInt)(child - s->child);
    s->child[from].shared++;
    child->shared++;
    copy = *held;
    copy.other = from;
    pieces[(*n)++] = copy.piece;
    PetscCall(Hold(s, child, now, copy));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamScheduleTake(LamSchedule schedule, PetscInt child, PetscReal now, PetscInt most, PetscInt *n,
                               PetscInt64 pieces[])
{
  Child *c = &schedule->child[child];

  PetscFunctionBeginUser;
  *n = 0;
  while (*n < most && schedule->waiting && c->n < Share(schedule, c)) {
    PetscBool longest = PETSC_TRUE;
    Class *class;
    Range *range = Extreme(schedule, longest, &class);
    Held held;

    if (ComesLast(schedule, c, range)) {
      longest = PETSC_FALSE;
      range = Extreme(schedule, longest, &class);
      if (ComesLast(schedule, c, range)) break;
    }
    held = Pop(schedule, class, range, longest);
    pieces[(*n)++] = held.piece;
    PetscCall(Hold(schedule, c, now, held));
  }
  if (!schedule->waiting) PetscCall(TakeCopies(schedule, c, now, most, n, pieces));
  PetscFunctionReturn(0);
}

/* ---- results ---- */

static PetscInt FindHeld(const Child *child, PetscInt64 piece)
{
  PetscInt i = 0;

  while (i < child->n && child->held[i].piece != piece) i++;
  return i;
}

/* The other child that has this piece need not hurry any more. */
static void MarkStale(LamSchedule s, const Held *held)
{
  Child *child = &s->child[held->other];
  const PetscInt i = FindHeld(child, held->piece);

  if (i == child->n) return;
  child->held[i].stale = PETSC_TRUE;
  s->stale++;
}

PetscErrorCode LamScheduleDone(LamSchedule schedule, PetscInt child, PetscReal now, PetscInt64 piece, PetscBool *first)
{
  Child *c = &schedule->child[child];
  const PetscInt i = FindHeld(c, piece);
  const PetscReal seconds = PetscMax(0, now - c->since); /* it was busy for so long since the last result */
  Held held;

  PetscFunctionBeginUser;
  PetscCheck(i < c->n, PETSC_COMM_SELF, PETSC_ERR_PLIB, "child %" PetscInt_FMT " has no piece %lld", child,
             (long long)piece);
  held = c->held[i];
  for (PetscInt k = i; k + 1 < c->n; k++) c->held[k] = c->held[k + 1];
  schedule->occupied -= c->n <= c->capacity;
  c->n--;
  c->shared -= held.other >= 0;
  c->since = now;
  schedule->out--;
  Remember(&c->work, held.cost, seconds);
  Remember(&schedule->work, held.cost, seconds * c->capacity);
  Judge(schedule, c);
  *first = (PetscBool)!held.stale;
  schedule->stale -= held.stale;
  if (held.other >= 0 && !held.stale) MarkStale(schedule, &held);
  PetscFunctionReturn(0);
}

PetscInt LamScheduleHolder(LamSchedule schedule, PetscInt64 piece)
{
  for (PetscInt c = 0; c < schedule->children; c++)
    if (FindHeld(&schedule->child[c], piece) < schedule->child[c].n) return c;
  return -1;
}

PetscInt64 LamScheduleStale(LamSchedule schedule)
{
  return schedule->stale;
}

PetscReal LamScheduleCost(LamSchedule schedule, PetscInt child, PetscInt64 piece)
{
  const Child *c = &schedule->child[child];

  return c->held[FindHeld(c, piece)].cost;
}

PetscInt64 LamScheduleWaiting(LamSchedule schedule)
{
  return schedule->waiting;
}

PetscInt64 LamScheduleOut(LamSchedule schedule)
{
  return schedule->out;
}

/* ---- lifecycle ---- */

PetscErrorCode LamScheduleCreate(PetscInt children, const PetscInt capacity[], PetscReal answer, LamSchedule *schedule)
{
  LamSchedule s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  PetscCall(PetscCalloc1(children, &s->child));
  s->children = children;
  s->answer = answer;
  for (PetscInt c = 0; c < children; c++) {
    s->child[c].capacity = capacity[c];
    s->capacity += capacity[c];
  }
  *schedule = s;
  PetscFunctionReturn(0);
}

PetscErrorCode LamScheduleDestroy(LamSchedule *schedule)
{
  LamSchedule s = *schedule;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (PetscInt c = 0; c < s->children; c++) PetscCall(PetscFree(s->child[c].held));
  for (int i = 0; i < CLASSES; i++) PetscCall(PetscFree(s->queue[i].ranges));
  PetscCall(PetscFree(s->child));
  PetscCall(PetscFree(*schedule));
  PetscFunctionReturn(0);
}
