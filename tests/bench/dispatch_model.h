/*
  A simulation of `lamella build` on many ranks: which rank does what at what time. The decisions are those of the
  program (schedule.c); ranks, messages, the file and its rounds are modelled.

  Model
    Inner ranks (rank 0, leaders) have a LamSchedule each. They answer messages in the order of their arrival, between
    two factorisations where they work on a piece of their own. Rank 0 besides commits what has come, and makes the next
    round when the last but one is complete; messages wait meanwhile. A message takes processor time at both ends, a
    latency, and its bytes the bandwidth; the network itself is never full.
    A piece may stand for several of the same round (its grain), so that a rank gets no more than a given number of
    pieces in a round: work, messages and bytes are those of all of them.
    A failure of a machine ends the job. It is started again, asks for the rounds that are complete as the first time,
    and solves what was not committed.
*/
#ifndef LAM_DISPATCH_MODEL_H
#define LAM_DISPATCH_MODEL_H

#include <schedule.h>
#include "event_queue.h"
#include "work_table.h"

/* What things cost, in s and bytes; docs/results/scaling.md says how they were measured. */
typedef struct {
  PetscReal latency, bandwidth; /* of the network, s and bytes/s */
  PetscReal message, byte;      /* processor time of one message, and of each byte of it, at one end */
  PetscReal piece;              /* of its description or result, at an inner rank */
  PetscReal pause;              /* longest sleep of a rank that has nothing to do */
  PetscReal describe_bytes, result_bytes, node_bytes; /* node: what rank 0 keeps of a result */
  PetscReal bundle_bytes, bundle_age;                 /* a leader's results go up when they are so many or so old */
  PetscReal answer, answer_root;                      /* that the schedules of leaders and of rank 0 are told */
  PetscReal commit, commit_record;                    /* of a commit, and of each record in it */
  PetscReal poll, poll_node, choose; /* of a round's decision, of each node in the table, of each in the round */
  PetscReal restart, read_record;    /* after a failure: until the job runs, and to read a record */
} Costs;

typedef enum { SPEED_UNIFORM, SPEED_SPREAD, SPEED_SLOW } Speeds;

typedef struct {
  PetscInt ranks;
  PetscInt group;     /* see LamDispatchCreate; at least `ranks`: flat */
  PetscInt64 samples; /* of all rounds */
  PetscReal scale;    /* of all times of work, the factorisation included */
  PetscReal grain;    /* pieces a rank and round at most; 0: each for itself */
  Speeds speeds;
  PetscInt64 least_round; /* pieces; the larger one of this and a share of what is there. 0: one round */
  PetscInt round_share, open_rounds;
  PetscInt jobs;           /* that share the ranks and the samples and know nothing of each other */
  PetscBool leaders_write; /* what they are given, to files of their own; rank 0 keeps the table alone */
  PetscInt machine;        /* ranks of one */
  PetscReal mtbf;          /* mean time between failures of a machine, s; 0: none fails */
  uint64_t seed;
} Case;

/* Shares of ranks x time, besides counts. */
typedef struct {
  PetscReal seconds, work; /* work: mean time of a piece */
  PetscReal busy;          /* pieces whose results were used */
  PetscReal starved;       /* idle while rank 0 had nothing to hand out */
  PetscReal waiting;       /* idle while it had */
  PetscReal lost;          /* pieces that were done twice, or whose results a failure took, and the time until all ran
                              again */
  PetscReal handing, committing, polling; /* of rank 0's time */
  PetscReal leading;                      /* of the busiest leader's time, messages */
  PetscInt rounds, failures;
  PetscInt64 events, records, copies; /* copies: results that were dropped */
} Outcome;

enum { RESULT, WORK_DOWN, RESULTS_UP, BUNDLE_AGED, FAILURE };
enum { ROOT = 0, SELF = 0, MOST_AT_ONCE = 64, DRAWN_ONE_BY_ONE = 256 };
/* As in cmd_build.c. */
#define COMMIT_SECONDS 1.0
#define COMMIT_SHARE 50.0
enum { COMMIT_RECORDS = 65536 };

typedef struct {
  PetscInt n, room, next_free;
  PetscInt64 *pieces; /* owned */
} Message;

typedef struct {
  LamSchedule schedule;
  PetscInt first, children;             /* rank or inner rank of child 0, and how many there are */
  PetscBool computes;                   /* it is its own child SELF */
  PetscReal free;                       /* has answered all that has come in */
  PetscReal handling;                   /* in all */
  PetscBool working;                    /* on a piece of its own */
  PetscReal work_begin, work_end, debt; /* debt: time of messages that were answered meanwhile */
  PetscInt message;                     /* results that wait to go up; -1: none */
  PetscBool hurry;                      /* they go up when the messages that have come are answered */
  PetscReal bytes, last_commit;
  PetscInt64 sent;
} Inner;

/* Numbers in simulated pieces, each of which stands for `grain` real ones. */
typedef struct {
  PetscInt64 count, grain, arrived, numbers; /* numbers: that have been used in each class */
  PetscInt64 total[WORK_CLASSES], committed[WORK_CLASSES];
} Round;

typedef struct {
  const Case *c;
  const Costs *costs;
  const WorkTable *table;
  EventQueue queue;
  PetscInt inner_count, members; /* members: ranks of a group; 1: flat */
  Inner *inner;                  /* [inner_count]; owned */
  PetscReal *free, *speed;       /* [ranks] of the work that it was given; owned */
  PetscInt messages, first_free;
  Message *message; /* owned */
  PetscInt decided, complete, round_room;
  Round *round;                                              /* [decided]; owned */
  PetscInt64 nodes, table_nodes;                             /* of decided rounds, of complete ones */
  PetscInt64 uncommitted, pending_n, pending_room, *pending; /* uncommitted: real records */
  PetscInt starved_n, starved_room;
  PetscReal *starved; /* [starved_n]: rank 0 runs out, has pieces again, ... */
  PetscReal *starved_sum;
  PetscReal last_commit, commit_seconds; /* the end of the last one, and what it took */
  PetscReal end, started, polled;
  PetscReal used, saved; /* time of results; those that are committed */
  PetscReal idle, starving, lost, committing, polling;
  uint64_t random;
  Outcome *outcome;
} Model;

/* ---- pieces: class, round and number in one ---- */

enum { CLASS_SHIFT = 56, ROUND_SHIFT = 40 };

static PetscInt64 PieceOf(int class, PetscInt round, PetscInt64 number)
{
  return (PetscInt64) class << CLASS_SHIFT | (PetscInt64)round << ROUND_SHIFT | number;
}

static int ClassOfPiece(PetscInt64 piece)
{
  return (int)(piece >> CLASS_SHIFT);
}

static Round *RoundOf(const Model *m, PetscInt64 piece)
{
  return &m->round[piece >> ROUND_SHIFT & 0xffff];
}

static PetscReal SecondsOf(const Model *m, PetscInt64 piece)
{
  const PetscInt64 grain = RoundOf(m, piece)->grain;
  PetscReal sum = 0;

  for (PetscInt64 i = 0; i < grain; i++)
    sum += DrawWork(m->table, ClassOfPiece(piece), MixBits((uint64_t)piece + m->c->seed) + (uint64_t)i);
  return m->c->scale * sum;
}

static PetscReal CostOf(const Model *m, PetscInt64 piece)
{
  return (PetscReal)RoundOf(m, piece)->grain * m->table->classes[ClassOfPiece(piece)].predicted;
}

static double Random(Model *m)
{
  m->random = MixBits(m->random);
  return ((double)(m->random >> 11) + 0.5) / 9007199254740992.0;
}

/* ---- the tree, as LamDispatchCreate makes it ---- */

static PetscInt ParentOf(const Model *m, PetscInt rank)
{
  return m->members == 1 ? ROOT : 1 + (rank - 1) / m->members;
}

static PetscInt ChildNumber(const Model *m, PetscInt rank)
{
  return m->members == 1 ? rank : (rank - 1) % m->members;
}

static PetscBool HandsOutToLeaders(const Model *m, PetscInt inner)
{
  return (PetscBool)(inner == ROOT && m->members > 1);
}

static PetscErrorCode CreateInner(Model *m, PetscInt number)
{
  Inner *inner = &m->inner[number];
  PetscInt *capacity;

  PetscFunctionBeginUser;
  *inner = (Inner){.message = -1, .free = m->started, .last_commit = m->started, .handling = inner->handling};
  inner->computes = (PetscBool)(!HandsOutToLeaders(m, number));
  inner->first = number == ROOT ? (inner->computes ? 0 : 1) : 1 + (number - 1) * m->members;
  inner->children =
      number ? PetscMin(m->members, m->c->ranks - inner->first) : (inner->computes ? m->c->ranks : m->inner_count - 1);
  PetscCall(PetscMalloc1(inner->children, &capacity));
  for (PetscInt k = 0; k < inner->children; k++)
    capacity[k] = inner->computes ? 1 : PetscMin(m->members, m->c->ranks - 1 - k * m->members);
  PetscCall(LamScheduleCreate(inner->children, capacity, number ? m->costs->answer : m->costs->answer_root,
                              &inner->schedule));
  PetscCall(PetscFree(capacity));
  PetscFunctionReturn(0);
}

/* ---- idle time ---- */

/* How long rank 0 has had nothing to hand out, until then. */
static PetscReal StarvedUntil(const Model *m, PetscReal time)
{
  PetscInt low = 0, high = m->starved_n;

  while (low < high) {
    const PetscInt middle = (low + high) / 2;

    if (m->starved[middle] <= time)
      low = middle + 1;
    else
      high = middle;
  }
  if (!low) return 0;
  return m->starved_sum[low - 1] + (low % 2 ? time - m->starved[low - 1] : 0);
}

static PetscErrorCode NoteStarved(Model *m, PetscReal now)
{
  const PetscBool starved = (PetscBool)!LamScheduleWaiting(m->inner[ROOT].schedule);
  const PetscInt n = m->starved_n;

  PetscFunctionBeginUser;
  if (starved == (PetscBool)(n % 2)) PetscFunctionReturn(0);
  if (n == m->starved_room) {
    m->starved_room = PetscMax(64, 2 * n);
    PetscCall(PetscRealloc((size_t)m->starved_room * sizeof(PetscReal), &m->starved));
    PetscCall(PetscRealloc((size_t)m->starved_room * sizeof(PetscReal), &m->starved_sum));
  }
  m->starved[n] = now;
  m->starved_sum[n] = n ? m->starved_sum[n - 1] + (n % 2 ? now - m->starved[n - 1] : 0) : 0;
  m->starved_n++;
  PetscFunctionReturn(0);
}

static void CountIdle(Model *m, PetscReal from, PetscReal to)
{
  if (to <= from) return;
  m->idle += to - from;
  m->starving += StarvedUntil(m, to) - StarvedUntil(m, from);
}

/* ---- ranks that work ---- */

/* The rank has the piece at time `now`; its result is at the rank above when the event comes. */
static PetscErrorCode Begin(Model *m, PetscInt rank, PetscInt64 piece, PetscReal now)
{
  const Costs *costs = m->costs;
  Inner *own = m->members == 1 ? (rank ? NULL : m->inner) : ChildNumber(m, rank) ? NULL : &m->inner[ParentOf(m, rank)];
  const PetscReal idle = PetscMax(0, now - m->free[rank]); /* it sleeps between two looks, longer and longer */
  const PetscReal begin = PetscMax(m->free[rank], now + PetscMin(idle, costs->pause) / 2) + (own ? 0 : costs->message);
  const PetscReal seconds = SecondsOf(m, piece) / m->speed[rank];
  PetscReal end = begin + seconds;

  PetscFunctionBeginUser;
  CountIdle(m, m->free[rank], begin);
  m->free[rank] = end;
  if (own) {
    own->working = PETSC_TRUE;
    own->work_begin = begin;
    own->work_end = end;
  } else {
    end += costs->message + costs->latency + costs->result_bytes / costs->bandwidth;
  }
  PetscCall(EventPush(&m->queue, (Event){.time = end, .what = piece, .kind = RESULT, .whom = (int)rank}));
  PetscFunctionReturn(0);
}

/* ---- messages ---- */

static PetscErrorCode NewMessage(Model *m, PetscInt *number)
{
  PetscFunctionBeginUser;
  *number = m->first_free;
  if (*number >= 0) {
    m->first_free = m->message[*number].next_free;
    m->message[*number].n = 0;
    PetscFunctionReturn(0);
  }
  if (!(m->messages & (m->messages - 1))) /* room for a power of two */
    PetscCall(PetscRealloc((size_t)PetscMax(1, 2 * m->messages) * sizeof(*m->message), &m->message));
  *number = m->messages++;
  m->message[*number] = (Message){0};
  PetscFunctionReturn(0);
}

static PetscErrorCode AppendPiece(Model *m, PetscInt number, PetscInt64 piece)
{
  Message *message = &m->message[number];

  PetscFunctionBeginUser;
  if (message->n == message->room) {
    message->room = PetscMax(4, 2 * message->room);
    PetscCall(PetscRealloc((size_t)message->room * sizeof(*message->pieces), &message->pieces));
  }
  message->pieces[message->n++] = piece;
  PetscFunctionReturn(0);
}

static void FreeMessage(Model *m, PetscInt number)
{
  m->message[number].next_free = m->first_free;
  m->first_free = number;
}

/* When the inner rank begins to answer what has come at `time`. */
static PetscReal Notices(const Model *m, const Inner *inner, PetscReal time)
{
  const PetscReal slice = m->c->scale * m->table->factorisation;

  if (inner->working)
    time = inner->work_begin + slice * ceil(PetscMax(0, time - inner->work_begin) / slice);
  else
    time += PetscMin(m->costs->pause, PetscMax(0, time - PetscMax(inner->free, inner->work_end))) / 2;
  return PetscMax(time, inner->free);
}

/* The rank answers something for so long; returns when it has. */
static PetscReal Handle(Inner *inner, PetscReal begin, PetscReal seconds)
{
  inner->handling += seconds;
  if (inner->working && begin < inner->work_end + inner->debt) inner->debt += seconds;
  return inner->free = begin + seconds;
}

static PetscErrorCode SendDown(Model *m, PetscInt number, PetscInt child, PetscInt n, const PetscInt64 pieces[])
{
  const Costs *costs = m->costs;
  Inner *inner = &m->inner[number];
  PetscReal bytes = 0, arrival;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) bytes += (PetscReal)RoundOf(m, pieces[i])->grain * costs->describe_bytes;
  arrival =
      Handle(inner, inner->free, costs->message + bytes * costs->byte) + costs->latency + bytes / costs->bandwidth;
  if (HandsOutToLeaders(m, number)) {
    PetscInt message;

    PetscCall(NewMessage(m, &message));
    for (PetscInt i = 0; i < n; i++) PetscCall(AppendPiece(m, message, pieces[i]));
    PetscCall(EventPush(&m->queue, (Event){arrival, message, WORK_DOWN, (int)child + 1}));
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < n; i++) PetscCall(Begin(m, inner->first + child, pieces[i], arrival));
  PetscFunctionReturn(0);
}

static PetscErrorCode HandOutTo(Model *m, PetscInt number, PetscInt child)
{
  Inner *inner = &m->inner[number];
  PetscInt64 pieces[MOST_AT_ONCE];
  PetscInt n = MOST_AT_ONCE;

  PetscFunctionBeginUser;
  while (n == MOST_AT_ONCE) {
    PetscCall(LamScheduleTake(inner->schedule, child, inner->free, MOST_AT_ONCE, &n, pieces));
    if (n) PetscCall(SendDown(m, number, child, n, pieces));
  }
  if (number == ROOT) PetscCall(NoteStarved(m, inner->free));
  PetscFunctionReturn(0);
}

/* Its next own piece, where it has none. */
static PetscErrorCode WorkItself(Model *m, PetscInt number)
{
  Inner *inner = &m->inner[number];
  PetscInt64 piece;
  PetscInt n;

  PetscFunctionBeginUser;
  if (!inner->computes || inner->working) PetscFunctionReturn(0);
  PetscCall(LamScheduleTake(inner->schedule, SELF, inner->free, 1, &n, &piece));
  if (n) PetscCall(Begin(m, inner->first, piece, inner->free));
  PetscFunctionReturn(0);
}

static PetscErrorCode HandOut(Model *m, PetscInt number)
{
  PetscFunctionBeginUser;
  PetscCall(WorkItself(m, number));
  for (PetscInt child = m->inner[number].computes; child < m->inner[number].children; child++)
    PetscCall(HandOutTo(m, number, child));
  PetscFunctionReturn(0);
}

#endif
