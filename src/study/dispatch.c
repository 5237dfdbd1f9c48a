/*
  The tree of ranks that hand out work, and work.

  Method
    Every rank runs one loop: it takes what has come in, hands out, and else does a piece itself, the messages being
    answered between its factorisations too. No rank waits for another with a message of its own: sends are not
    blocking, so two that write to each other at once do not hold each other up.
    A leader has what it was given wait in a schedule of its own and sends results up in bundles. The end comes from
    rank 0: `stop` goes down the tree, `home` comes up behind the last results, so that no message is left over.
*/
#include "dispatch.h"
#include <signal.h>
#include <lamella/clock.h>
#include "mail.h"
#include "schedule.h"
#include <math.h>
#include <string.h>
#include <time.h>

enum { TAG_WORK = 1, TAG_RESULT, TAG_DROP, TAG_SIGNAL, TAG_STOP, TAG_HOME };
enum { SELF = 0, MOST_AT_ONCE = 64 };
/* A rank that works looks for messages so often at most, s: looking takes some time, too. */
#define LOOK_TIME 2e-3
/* From a result to the next piece, s: rank 0 may be deciding on a round or committing. */
#define ANSWER_TIME 0.05
/* A leader's bundle of results goes up when it is so large, or its first result so old, bytes and s. */
#define BUNDLE_BYTES 65536
#define BUNDLE_AGE 0.02
/* A rank that has nothing to do sleeps for so long, s: others may want the processor. */
#define LEAST_PAUSE 2e-5
#define LONGEST_PAUSE 1e-3

/* A piece that came from above and has not been done. */
typedef struct {
  LamBundleItem item;
  char *bytes;       /* owned */
  PetscBool dropped; /* another rank has done it */
} Received;

struct LamDispatch_s {
  PetscMPIInt rank, size;
  LamDispatchJob job;
  LamMail mail;
  LamSchedule schedule;
  PetscMPIInt parent;          /* -1: rank 0 */
  PetscInt children;           /* of the schedule; number SELF is this rank, where it computes */
  PetscMPIInt *child;          /* [children]: ranks; owned */
  PetscBool computes;          /* rank 0 of many does not */
  PetscBool news;              /* pieces were added: all children may take some */
  PetscInt received, room;     /* pieces from above */
  Received *inputs;            /* [received]; owned */
  PetscInt64 unfinished;       /* on rank 0: pieces without a result */
  LamBundle results, incoming; /* for the parent; work space */
  PetscReal results_since;
  void *input;         /* work space */
  void *desk, *result; /* of the piece under way; owned */
  PetscBool stopping, signalled, working;
  PetscInt64 current;               /* the piece under way */
  PetscBool dropped;                /* it has been done by another rank */
  PetscBool failed;                 /* rank 0 wants no more results */
  PetscInt at_home;                 /* children that have gone home */
  PetscReal pause, service, looked; /* looked: when it last took messages while it worked */
  PetscErrorCode ierr;              /* of a call from LamDispatchServeWaiting */
};

/* ---- pieces from above ---- */

static Received *FindInput(LamDispatch d, PetscInt64 piece)
{
  for (PetscInt i = 0; i < d->received; i++)
    if (d->inputs[i].item.piece == piece) return &d->inputs[i];
  return NULL;
}

static PetscErrorCode KeepInput(LamDispatch d, const LamBundleItem *item, const void *bytes)
{
  Received *input;

  PetscFunctionBeginUser;
  if (d->received == d->room) {
    d->room = PetscMax(16, 2 * d->room);
    PetscCall(PetscRealloc((size_t)d->room * sizeof(*d->inputs), &d->inputs));
  }
  input = &d->inputs[d->received++];
  *input = (Received){.item = *item};
  PetscCall(PetscMalloc(item->size, &input->bytes));
  if (item->size) memcpy(input->bytes, bytes, item->size);
  PetscFunctionReturn(0);
}

static PetscErrorCode ForgetInput(LamDispatch d, PetscInt64 piece)
{
  Received *input = FindInput(d, piece);

  PetscFunctionBeginUser;
  if (!input) PetscFunctionReturn(0);
  PetscCall(PetscFree(input->bytes));
  *input = d->inputs[--d->received];
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeWork(LamDispatch d)
{
  LamBundleItem item;
  const void *bytes;
  size_t at = 0;

  PetscFunctionBeginUser;
  while (LamBundleNext(&d->incoming, &at, &item, &bytes)) {
    PetscCall(KeepInput(d, &item, bytes));
    PetscCall(LamScheduleAdd(d->schedule, item.piece, 1, item.cost));
    d->news = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* What a rank needs for the piece: on rank 0 it is described now, elsewhere it has come from above. */
static PetscErrorCode FindOut(LamDispatch d, PetscInt child, PetscInt64 piece, LamBundleItem *item, const void **bytes)
{
  PetscFunctionBeginUser;
  if (d->parent < 0) {
    *item = (LamBundleItem){.piece = piece, .cost = LamScheduleCost(d->schedule, child, piece)};
    *bytes = d->input;
    if (d->job.describe) PetscCall(d->job.describe(d->job.ctx, piece, d->input, &item->size));
  } else {
    const Received *input = FindInput(d, piece);

    PetscCheck(input, PETSC_COMM_SELF, PETSC_ERR_PLIB, "piece %lld has no input", (long long)piece);
    *item = input->item;
    *bytes = input->bytes;
  }
  PetscFunctionReturn(0);
}

/* ---- results ---- */

static PetscErrorCode SendResults(LamDispatch d)
{
  PetscFunctionBeginUser;
  if (d->results.n) PetscCall(LamMailSend(&d->mail, d->parent, TAG_RESULT, &d->results));
  PetscFunctionReturn(0);
}

/* Those of a rank that hands out to nobody go at once. */
static PetscErrorCode SendResultsInTime(LamDispatch d)
{
  const PetscBool leads = (PetscBool)(d->children > 1);

  PetscFunctionBeginUser;
  if (d->parent < 0 || !d->results.n) PetscFunctionReturn(0);
  if (!leads || d->results.n >= BUNDLE_BYTES || !LamScheduleWaiting(d->schedule) ||
      LamClock() - d->results_since > BUNDLE_AGE)
    PetscCall(SendResults(d));
  PetscFunctionReturn(0);
}

/* Another rank was faster: what is not done yet need not be. A result without bytes comes back. */
static PetscErrorCode Drop(LamDispatch d, PetscInt child, PetscInt64 piece)
{
  const LamBundleItem item = {.piece = piece};
  LamBundle bundle = {0};

  PetscFunctionBeginUser;
  if (d->computes && child == SELF) {
    if (d->working && d->current == piece) d->dropped = PETSC_TRUE;
    PetscFunctionReturn(0);
  }
  PetscCall(LamBundleAppend(&bundle, &item, NULL));
  PetscCall(LamMailSend(&d->mail, d->child[child], TAG_DROP, &bundle));
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeDrop(LamDispatch d)
{
  LamBundleItem item;
  const void *bytes;
  size_t at = 0;

  PetscFunctionBeginUser;
  while (LamBundleNext(&d->incoming, &at, &item, &bytes)) {
    Received *input = FindInput(d, item.piece);
    const PetscInt child = LamScheduleHolder(d->schedule, item.piece);

    if (!input) continue; /* the result is on its way */
    input->dropped = PETSC_TRUE;
    if (child >= 0) PetscCall(Drop(d, child, item.piece));
  }
  PetscFunctionReturn(0);
}

/* A result from `child`: to the caller on rank 0, up the tree elsewhere. */
static PetscErrorCode Deliver(LamDispatch d, PetscInt child, const LamBundleItem *item, const void *bytes)
{
  PetscBool first;

  PetscFunctionBeginUser;
  PetscCall(LamScheduleDone(d->schedule, child, LamClock(), item->piece, &first));
  if (!first || d->failed) PetscFunctionReturn(0);
  if (LamScheduleStale(d->schedule)) {
    const PetscInt other = LamScheduleHolder(d->schedule, item->piece);

    if (other >= 0) PetscCall(Drop(d, other, item->piece));
  }
  if (d->parent < 0) {
    d->unfinished--;
    PetscCall(d->job.worked(d->job.ctx, item->piece, bytes));
  } else {
    if (!d->results.n) d->results_since = LamClock();
    PetscCall(LamBundleAppend(&d->results, item, bytes));
    PetscCall(ForgetInput(d, item->piece));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeResults(LamDispatch d, PetscInt child)
{
  LamBundle bundle = d->incoming; /* `worked` may lead to other messages */
  LamBundleItem item;
  PetscErrorCode ierr = 0;
  const void *bytes;
  size_t at = 0;

  PetscFunctionBeginUser;
  d->incoming = (LamBundle){0};
  while (!ierr && LamBundleNext(&bundle, &at, &item, &bytes)) ierr = Deliver(d, child, &item, bytes);
  PetscCall(LamBundleDestroy(&bundle));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- handing out ---- */

static PetscErrorCode HandOutTo(LamDispatch d, PetscInt child)
{
  PetscInt64 pieces[MOST_AT_ONCE];
  PetscInt n = MOST_AT_ONCE;

  PetscFunctionBeginUser;
  while (n == MOST_AT_ONCE && !d->stopping && !LamStopRequested()) {
    LamBundle bundle = {0};

    PetscCall(LamScheduleTake(d->schedule, child, LamClock(), MOST_AT_ONCE, &n, pieces));
    for (PetscInt i = 0; i < n; i++) {
      LamBundleItem item;
      const void *bytes;

      PetscCall(FindOut(d, child, pieces[i], &item, &bytes));
      PetscCall(LamBundleAppend(&bundle, &item, bytes));
    }
    if (n) PetscCall(LamMailSend(&d->mail, d->child[child], TAG_WORK, &bundle));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode HandOut(LamDispatch d)
{
  PetscFunctionBeginUser;
  if (!d->news) PetscFunctionReturn(0);
  d->news = PETSC_FALSE;
  for (PetscInt c = d->computes ? SELF + 1 : SELF; c < d->children; c++) PetscCall(HandOutTo(d, c));
  PetscFunctionReturn(0);
}

/* ---- messages ---- */

static PetscErrorCode SendEmpty(LamDispatch d, PetscMPIInt rank, PetscMPIInt tag)
{
  LamBundle nothing = {0};

  PetscFunctionBeginUser;
  PetscCall(LamMailSend(&d->mail, rank, tag, &nothing));
  PetscFunctionReturn(0);
}

static PetscErrorCode Stop(LamDispatch d)
{
  PetscFunctionBeginUser;
  if (d->stopping) PetscFunctionReturn(0);
  d->stopping = PETSC_TRUE;
  for (PetscInt c = d->computes ? SELF + 1 : SELF; c < d->children; c++) PetscCall(SendEmpty(d, d->child[c], TAG_STOP));
  PetscFunctionReturn(0);
}

/* A signal that has reached this rank or one below it, to rank 0. */
static PetscErrorCode PassSignalOn(LamDispatch d)
{
  PetscFunctionBeginUser;
  if (d->signalled || !LamStopRequested() || d->parent < 0) PetscFunctionReturn(0);
  d->signalled = PETSC_TRUE;
  PetscCall(SendEmpty(d, d->parent, TAG_SIGNAL));
  PetscFunctionReturn(0);
}

static PetscInt FindChild(LamDispatch d, PetscMPIInt rank)
{
  PetscInt c = d->computes ? SELF + 1 : SELF;

  while (c < d->children && d->child[c] != rank) c++;
  return c;
}

static PetscErrorCode Take(LamDispatch d, PetscMPIInt rank, PetscMPIInt tag)
{
  const PetscInt child = rank == d->parent ? -1 : FindChild(d, rank);

  PetscFunctionBeginUser;
  switch (tag) {
  case TAG_WORK:
    PetscCall(TakeWork(d));
    break;
  case TAG_RESULT:
    PetscCall(TakeResults(d, child));
    PetscCall(HandOutTo(d, child));
    break;
  case TAG_DROP:
    PetscCall(TakeDrop(d));
    break;
  case TAG_SIGNAL:
    if (!LamStopSignal()) LamStopRequest(SIGTERM);
    break;
  case TAG_STOP:
    PetscCall(Stop(d));
    break;
  case TAG_HOME:
    d->at_home++;
    break;
  }
  PetscFunctionReturn(0);
}

/* Takes all messages that have come in, and answers them. */
static PetscErrorCode Serve(LamDispatch d, PetscBool *any)
{
  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  for (;;) {
    PetscMPIInt rank, tag;
    PetscBool found;

    PetscCall(LamMailReceive(&d->mail, &found, &rank, &tag, &d->incoming));
    if (!found) break;
    *any = PETSC_TRUE;
    PetscCall(Take(d, rank, tag));
  }
  PetscCall(PassSignalOn(d));
  PetscCall(HandOut(d));
  PetscCall(SendResultsInTime(d));
  PetscFunctionReturn(0);
}

PetscBool LamDispatchServeWaiting(void *dispatch)
{
  LamDispatch d = dispatch;
  const PetscReal begin = LamClock();
  PetscBool any;

  if (d->size > 1 && d->working && !d->ierr && begin - d->looked >= LOOK_TIME) {
    d->ierr = Serve(d, &any);
    d->looked = LamClock();
    d->service += d->looked - begin;
  }
  return (PetscBool)(d->ierr || d->stopping || d->dropped || LamStopRequested());
}

PetscReal LamDispatchServiceTime(LamDispatch dispatch)
{
  return dispatch->service;
}

/* ---- own work ---- */

/* One that another rank has done leaves a result without bytes, one that is given up at a stop leaves none. */
static PetscErrorCode DoPiece(LamDispatch d, PetscInt64 piece)
{
  const Received *input = FindInput(d, piece);
  LamBundleItem item;
  const void *bytes;
  size_t size = d->job.result_size;

  PetscFunctionBeginUser;
  PetscCall(FindOut(d, SELF, piece, &item, &bytes));
  if (item.size) memcpy(d->desk, bytes, item.size); /* messages come in while it is worked on */
  memset(d->result, 0, d->job.result_size);
  d->dropped = (PetscBool)(input && input->dropped);
  d->current = piece;
  d->working = PETSC_TRUE;
  if (!d->dropped) PetscCall(d->job.work(d->job.ctx, piece, d->desk, d->result, &size));
  d->working = PETSC_FALSE;
  PetscCall(d->ierr);
  if (d->stopping || LamStopRequested()) PetscFunctionReturn(0);
  item.size = d->dropped ? 0 : size;
  d->dropped = PETSC_FALSE;
  PetscCall(Deliver(d, SELF, &item, d->result));
  PetscFunctionReturn(0);
}

static PetscErrorCode WorkOnce(LamDispatch d, PetscBool *any)
{
  PetscInt64 piece;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  if (d->computes && !d->stopping && !LamStopRequested())
    PetscCall(LamScheduleTake(d->schedule, SELF, LamClock(), 1, &n, &piece));
  if (n) PetscCall(DoPiece(d, piece));
  *any = (PetscBool)(n > 0);
  PetscFunctionReturn(0);
}

static void Pause(LamDispatch d)
{
  const struct timespec pause = {0, (long)(1e9 * d->pause)};

  if (d->pause >= LEAST_PAUSE) nanosleep(&pause, NULL);
  d->pause = PetscMin(LONGEST_PAUSE, d->pause ? 2 * d->pause : LEAST_PAUSE / 8); /* at first it only looks again */
}

/* Once around: messages, a piece, or a rest. */
static PetscErrorCode Turn(LamDispatch d)
{
  PetscBool came = PETSC_FALSE, worked = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(Serve(d, &came));
  PetscCall(WorkOnce(d, &worked));
  if (worked) d->news = PETSC_TRUE; /* `worked` may have added pieces */
  if (came || worked)
    d->pause = 0;
  else
    Pause(d);
  PetscFunctionReturn(0);
}

/* ---- beginning and end ---- */

/* Behind the last results, when all below have gone. */
static PetscErrorCode GoHome(LamDispatch d)
{
  const PetscInt below = d->children - (d->computes ? 1 : 0);

  PetscFunctionBeginUser;
  PetscCall(Stop(d));
  while (d->at_home < below) PetscCall(Turn(d));
  if (d->parent < 0) PetscFunctionReturn(0);
  PetscCall(SendResults(d));
  PetscCall(SendEmpty(d, d->parent, TAG_HOME));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchAdd(LamDispatch dispatch, PetscInt64 first, PetscInt64 count, PetscReal cost)
{
  PetscFunctionBeginUser;
  PetscCall(LamScheduleAdd(dispatch->schedule, first, count, cost));
  dispatch->unfinished += count;
  dispatch->news = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode RunAll(LamDispatch d, PetscErrorCode (*stopped)(void *ctx), void *ctx)
{
  PetscFunctionBeginUser;
  while (d->unfinished && !LamStopRequested()) PetscCall(Turn(d));
  if (LamStopRequested() && stopped) PetscCall(stopped(ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchRun(LamDispatch dispatch, PetscErrorCode (*stopped)(void *ctx), void *ctx,
                              PetscBool *complete)
{
  PetscErrorCode ierr = RunAll(dispatch, stopped, ctx);

  PetscFunctionBeginUser;
  dispatch->failed = (PetscBool)(ierr != 0); /* the others are sent home all the same */
  if (!ierr)
    ierr = GoHome(dispatch);
  else
    (void)GoHome(dispatch);
  PetscCall(ierr);
  *complete = (PetscBool)!dispatch->unfinished;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchServe(LamDispatch dispatch)
{
  PetscFunctionBeginUser;
  while (!dispatch->stopping) PetscCall(Turn(dispatch));
  PetscCall(GoHome(dispatch));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchShare(LamDispatch dispatch, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, dispatch->mail.comm));
  if (code) return (PetscErrorCode)code;
  PetscFunctionReturn(0);
}

/* ---- the tree ---- */

/*
  Up to `group` ranks take pieces from rank 0. Of more, ranks 1 .. size - 1 form groups of like size, about as many as a
  group has ranks; the first of each leads it.
*/
static PetscErrorCode FindFamily(LamDispatch d, PetscInt group, PetscInt **capacity)
{
  const PetscInt others = d->size - 1;
  const PetscInt members = others <= group ? 1 : PetscMin(group, (PetscInt)ceil(sqrt((double)others)));
  const PetscInt leader = d->rank ? 1 + (d->rank - 1) / members * members : 0;
  const PetscInt last = PetscMin(d->size, leader + members);
  const PetscBool leads = (PetscBool)(d->rank == leader);

  PetscFunctionBeginUser;
  d->parent = (PetscMPIInt)(!d->rank ? -1 : leads ? 0 : leader);
  d->computes = (PetscBool)(d->rank || members == 1);
  d->children = d->rank ? (leads ? last - leader : 1) : (others + members - 1) / members + (d->computes ? 1 : 0);
  PetscCall(PetscMalloc1(d->children, &d->child));
  PetscCall(PetscMalloc1(d->children, capacity));
  for (PetscInt c = 0; c < d->children; c++) {
    const PetscInt below = d->rank ? d->rank + c : d->computes && !c ? 0 : 1 + (c - (d->computes ? 1 : 0)) * members;

    d->child[c] = (PetscMPIInt)below;
    (*capacity)[c] = d->rank || !below ? 1 : PetscMin(members, d->size - below);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchCreate(MPI_Comm comm, const LamDispatchJob *job, PetscInt group, LamDispatch *dispatch)
{
  PetscInt *capacity;
  LamDispatch d;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  d->job = *job;
  PetscCallMPI(MPI_Comm_dup(comm, &d->mail.comm));
  PetscCallMPI(MPI_Comm_rank(comm, &d->rank));
  PetscCallMPI(MPI_Comm_size(comm, &d->size));
  PetscCall(FindFamily(d, group ? group : LAM_DISPATCH_GROUP, &capacity));
  PetscCall(LamScheduleCreate(d->children, capacity, ANSWER_TIME, &d->schedule));
  PetscCall(PetscFree(capacity));
  PetscCall(PetscMalloc(job->input_size + 1, &d->input));
  PetscCall(PetscMalloc(job->input_size + 1, &d->desk));
  PetscCall(PetscMalloc(job->result_size + 1, &d->result));
  *dispatch = d;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchGetRank(LamDispatch dispatch, PetscMPIInt *rank, PetscMPIInt *size)
{
  PetscFunctionBeginUser;
  *rank = dispatch->rank;
  *size = dispatch->size;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch)
{
  LamDispatch d = *dispatch;

  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(0);
  PetscCall(LamMailDestroy(&d->mail));
  PetscCallMPI(MPI_Comm_free(&d->mail.comm));
  PetscCall(LamScheduleDestroy(&d->schedule));
  for (PetscInt i = 0; i < d->received; i++) PetscCall(PetscFree(d->inputs[i].bytes));
  PetscCall(PetscFree(d->inputs));
  PetscCall(LamBundleDestroy(&d->results));
  PetscCall(LamBundleDestroy(&d->incoming));
  PetscCall(PetscFree(d->child));
  PetscCall(PetscFree(d->input));
  PetscCall(PetscFree(d->desk));
  PetscCall(PetscFree(d->result));
  PetscCall(PetscFree(*dispatch));
  PetscFunctionReturn(0);
}
