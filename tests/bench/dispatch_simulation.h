/*
  The simulation of a job from its beginning to its end: results, failures, and what it comes to.
*/
#ifndef LAM_DISPATCH_SIMULATION_H
#define LAM_DISPATCH_SIMULATION_H

#include "dispatch_rounds.h"

/* ---- results ---- */

static PetscErrorCode SendUp(Model *m, PetscInt number)
{
  const Costs *costs = m->costs;
  Inner *leader = &m->inner[number];
  PetscReal arrival;

  PetscFunctionBeginUser;
  if (leader->message < 0) PetscFunctionReturn(0);
  arrival = Handle(leader, leader->free, costs->message + leader->bytes * costs->byte) + costs->latency +
            leader->bytes / costs->bandwidth;
  PetscCall(EventPush(&m->queue, (Event){arrival, leader->message, RESULTS_UP, (int)number}));
  leader->message = -1;
  leader->hurry = PETSC_FALSE;
  leader->bytes = 0;
  leader->sent++;
  PetscFunctionReturn(0);
}

static PetscReal BytesUp(const Model *m)
{
  return m->c->leaders_write ? m->costs->node_bytes : m->costs->result_bytes;
}

/* A leader keeps the result for the next bundle, and with files of their own writes it. */
static PetscErrorCode Gather(Model *m, PetscInt number, PetscInt64 piece)
{
  const Costs *costs = m->costs;
  const PetscReal grain = (PetscReal)RoundOf(m, piece)->grain;
  Inner *leader = &m->inner[number];

  PetscFunctionBeginUser;
  if (m->c->leaders_write) {
    const PetscBool due =
        (PetscBool)(leader->free - leader->last_commit >= PetscMax(COMMIT_SECONDS, COMMIT_SHARE * costs->commit));

    Handle(leader, leader->free, grain * costs->commit_record + (due ? costs->commit : 0));
    if (due) leader->last_commit = leader->free;
  }
  if (leader->message < 0) {
    PetscCall(NewMessage(m, &leader->message));
    PetscCall(EventPush(&m->queue, (Event){leader->free + costs->bundle_age, leader->sent, BUNDLE_AGED, (int)number}));
  }
  PetscCall(AppendPiece(m, leader->message, piece));
  leader->bytes += grain * BytesUp(m);
  PetscFunctionReturn(0);
}

/* After a leader has answered something: a full bundle at once; where it has no more work, what has come so far. */
static PetscErrorCode SendUpInTime(Model *m, PetscInt number)
{
  Inner *leader = &m->inner[number];

  PetscFunctionBeginUser;
  if (number == ROOT || leader->message < 0) PetscFunctionReturn(0);
  if (leader->bytes >= m->costs->bundle_bytes) {
    PetscCall(SendUp(m, number));
  } else if (!leader->hurry && !LamScheduleWaiting(leader->schedule)) {
    leader->hurry = PETSC_TRUE;
    PetscCall(EventPush(&m->queue, (Event){leader->free, leader->sent, BUNDLE_AGED, (int)number}));
  }
  PetscFunctionReturn(0);
}

/* `rank` worked on it; -1: it comes from a leader. */
static PetscErrorCode Deliver(Model *m, PetscInt number, PetscInt child, PetscInt rank, PetscInt64 piece)
{
  Inner *inner = &m->inner[number];
  PetscBool first;

  PetscFunctionBeginUser;
  PetscCall(LamScheduleDone(inner->schedule, child, inner->free, piece, &first));
  if (rank >= 0 && first) m->used += SecondsOf(m, piece) / m->speed[rank];
  if (!first)
    m->outcome->copies++;
  else if (number != ROOT)
    PetscCall(Gather(m, number, piece));
  else
    PetscCall(Accept(m, piece));
  PetscFunctionReturn(0);
}

/* ---- events ---- */

static PetscErrorCode OnOwnResult(Model *m, PetscInt number, Event event)
{
  Inner *inner = &m->inner[number];

  PetscFunctionBeginUser;
  if (inner->debt > 0) { /* messages have made it later */
    event.time += inner->debt;
    inner->work_end += inner->debt;
    m->free[event.whom] += inner->debt;
    inner->debt = 0;
    PetscCall(EventPush(&m->queue, event));
    PetscFunctionReturn(0);
  }
  Handle(inner, PetscMax(inner->free, event.time), m->costs->piece);
  inner->working = PETSC_FALSE;
  PetscCall(Deliver(m, number, SELF, event.whom, event.what));
  PetscCall(SendUpInTime(m, number));
  if (number == ROOT) PetscCall(Advance(m));
  PetscCall(WorkItself(m, number));
  if (number == ROOT) PetscCall(NoteStarved(m, inner->free));
  PetscFunctionReturn(0);
}

static PetscErrorCode OnResult(Model *m, Event event)
{
  const Costs *costs = m->costs;
  const PetscInt number = ParentOf(m, event.whom), child = ChildNumber(m, event.whom);
  const PetscReal grain = (PetscReal)RoundOf(m, event.what)->grain;
  Inner *inner = &m->inner[number];

  PetscFunctionBeginUser;
  if (inner->computes && child == SELF) {
    PetscCall(OnOwnResult(m, number, event));
    PetscFunctionReturn(0);
  }
  Handle(inner, Notices(m, inner, event.time),
         grain * (costs->message + costs->result_bytes * costs->byte + costs->piece));
  PetscCall(Deliver(m, number, child, event.whom, event.what));
  PetscCall(HandOutTo(m, number, child));
  PetscCall(WorkItself(m, number));
  PetscCall(SendUpInTime(m, number));
  if (number == ROOT) PetscCall(Advance(m));
  PetscFunctionReturn(0);
}

static PetscErrorCode OnResultsUp(Model *m, Event event)
{
  const PetscInt n = m->message[event.what].n, child = event.whom - 1;
  Inner *root = &m->inner[ROOT];
  PetscReal records = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) records += (PetscReal)RoundOf(m, m->message[event.what].pieces[i])->grain;
  Handle(root, Notices(m, root, event.time),
         m->costs->message + records * (BytesUp(m) * m->costs->byte + m->costs->piece));
  for (PetscInt i = 0; i < n; i++) PetscCall(Deliver(m, ROOT, child, -1, m->message[event.what].pieces[i]));
  FreeMessage(m, (PetscInt)event.what);
  PetscCall(HandOutTo(m, ROOT, child));
  PetscCall(Advance(m));
  PetscFunctionReturn(0);
}

static PetscErrorCode OnWorkDown(Model *m, Event event)
{
  const PetscInt n = m->message[event.what].n;
  Inner *leader = &m->inner[event.whom];
  PetscReal pieces = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt64 piece = m->message[event.what].pieces[i];

    PetscCall(LamScheduleAdd(leader->schedule, piece, 1, CostOf(m, piece)));
    pieces += (PetscReal)RoundOf(m, piece)->grain;
  }
  Handle(leader, Notices(m, leader, event.time),
         m->costs->message + pieces * (m->costs->describe_bytes * m->costs->byte + m->costs->piece));
  FreeMessage(m, (PetscInt)event.what);
  PetscCall(HandOut(m, event.whom));
  PetscFunctionReturn(0);
}

/* ---- failures ---- */

static PetscErrorCode PlanFailure(Model *m)
{
  const PetscReal machines = ceil((PetscReal)m->c->ranks / (PetscReal)m->c->machine);

  PetscFunctionBeginUser;
  if (m->c->mtbf > 0)
    PetscCall(EventPush(&m->queue, (Event){m->started - log(Random(m)) * m->c->mtbf / machines, 0, FAILURE, 0}));
  PetscFunctionReturn(0);
}

static PetscErrorCode StartTree(Model *m)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->inner_count; i++) {
    PetscCall(LamScheduleDestroy(&m->inner[i].schedule));
    PetscCall(CreateInner(m, i));
  }
  for (PetscInt r = 0; r < m->c->ranks; r++) m->free[r] = m->started;
  m->last_commit = m->started;
  PetscCall(PlanFailure(m));
  PetscFunctionReturn(0);
}

/* What was not committed is gone; SPEED_UNIFORM. */
static PetscErrorCode OnFailure(Model *m, Event event)
{
  PetscFunctionBeginUser;
  m->outcome->failures++;
  m->lost += m->used - m->saved;
  m->used = m->saved;
  m->queue.n = 0;
  m->pending_n = m->uncommitted = 0;
  m->started = event.time + m->costs->restart + m->polled + (PetscReal)m->outcome->records * m->costs->read_record;
  m->lost += (PetscReal)m->c->ranks * (m->started - event.time);
  PetscCall(StartTree(m));
  m->complete = 0;
  m->table_nodes = 0;
  for (PetscInt r = 0; r < m->decided; r++) {
    m->round[r].arrived = 0;
    for (int class = 0; class < WORK_CLASSES; class ++) m->round[r].arrived += m->round[r].committed[class];
    PetscCall(AddPieces(m, r));
  }
  PetscCall(NoteStarved(m, m->started));
  PetscCall(HandOut(m, ROOT));
  PetscFunctionReturn(0);
}

static PetscErrorCode OnEvent(Model *m, Event event)
{
  Inner *leader = &m->inner[event.whom];

  PetscFunctionBeginUser;
  switch (event.kind) {
  case RESULT:
    PetscCall(OnResult(m, event));
    break;
  case WORK_DOWN:
    PetscCall(OnWorkDown(m, event));
    break;
  case RESULTS_UP:
    PetscCall(OnResultsUp(m, event));
    break;
  case BUNDLE_AGED:
    if (leader->sent != event.what) break; /* it has gone */
    Handle(leader, Notices(m, leader, event.time), 0);
    PetscCall(SendUp(m, event.whom));
    break;
  case FAILURE:
    PetscCall(OnFailure(m, event));
    break;
  }
  PetscFunctionReturn(0);
}

/* ---- a whole run ---- */

/* Relative to the ranks that the table was measured on. */
static PetscReal SpeedOfRank(Model *m)
{
  if (m->c->speeds == SPEED_SPREAD) return 1 + 0.1 * sqrt(3.0) * (2 * Random(m) - 1);
  if (m->c->speeds == SPEED_SLOW && Random(m) < 0.01) return 0.1;
  return 1;
}

static PetscErrorCode CreateModel(Model *m)
{
  const PetscInt others = m->c->ranks - 1;

  PetscFunctionBeginUser;
  m->random = m->c->seed;
  m->first_free = -1;
  m->members = others <= m->c->group ? 1 : PetscMin(m->c->group, (PetscInt)ceil(sqrt((double)others)));
  m->inner_count = m->members == 1 ? 1 : 1 + (others + m->members - 1) / m->members;
  PetscCall(PetscCalloc1(m->inner_count, &m->inner));
  PetscCall(PetscMalloc1(m->c->ranks, &m->free));
  PetscCall(PetscMalloc1(m->c->ranks, &m->speed));
  for (PetscInt r = 0; r < m->c->ranks; r++) m->speed[r] = SpeedOfRank(m);
  PetscFunctionReturn(0);
}

static PetscErrorCode DestroyModel(Model *m)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->inner_count; i++) PetscCall(LamScheduleDestroy(&m->inner[i].schedule));
  for (PetscInt i = 0; i < m->messages; i++) PetscCall(PetscFree(m->message[i].pieces));
  PetscCall(PetscFree(m->inner));
  PetscCall(PetscFree(m->free));
  PetscCall(PetscFree(m->speed));
  PetscCall(PetscFree(m->message));
  PetscCall(PetscFree(m->round));
  PetscCall(PetscFree(m->pending));
  PetscCall(PetscFree(m->starved));
  PetscCall(PetscFree(m->starved_sum));
  PetscCall(PetscFree(m->queue.events));
  PetscFunctionReturn(0);
}

static void Summarise(Model *m)
{
  const PetscReal all = (PetscReal)m->c->ranks * m->end;
  Outcome *o = m->outcome;

  for (PetscInt r = m->members == 1 ? 0 : 1; r < m->c->ranks; r++) CountIdle(m, m->free[r], m->end);
  o->seconds = m->end;
  o->work = m->used / (PetscReal)PetscMax(1, o->records);
  o->busy = m->used / all;
  o->starved = m->starving / all;
  o->waiting = (m->idle - m->starving) / all;
  o->lost = m->lost / all;
  o->handing = m->inner[ROOT].handling / m->end;
  o->committing = m->committing / m->end;
  o->polling = m->polling / m->end;
  for (PetscInt i = 1; i < m->inner_count; i++) o->leading = PetscMax(o->leading, m->inner[i].handling / m->end);
  o->rounds = m->decided;
}

/* `told`: called every few million events with the share of samples that have come; NULL: not. */
static PetscErrorCode SimulateDispatch(const Case *c, const Costs *costs, const WorkTable *table, void (*told)(double),
                                       Outcome *outcome)
{
  Model m = {.c = c, .costs = costs, .table = table, .outcome = outcome};

  PetscFunctionBeginUser;
  *outcome = (Outcome){0};
  PetscCall(CreateModel(&m));
  PetscCall(StartTree(&m));
  PetscCall(Advance(&m));
  while (m.end <= 0 && m.queue.n) {
    PetscCall(OnEvent(&m, EventPop(&m.queue)));
    if (told && ++outcome->events % (1 << 22) == 0) told((double)outcome->records / (double)c->samples);
  }
  PetscCheck(m.end > 0 || !c->samples, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "%lld of %lld samples: nothing happens any more", (long long)outcome->records, (long long)c->samples);
  Summarise(&m);
  PetscCall(DestroyModel(&m));
  PetscFunctionReturn(0);
}

/* All jobs of the case: the share that is busy until the last one ends, and the rest as in that one. */
static PetscErrorCode SimulateJobs(const Case *c, const Costs *costs, const WorkTable *table, void (*told)(double),
                                   Outcome *outcome)
{
  PetscReal busy = 0;

  PetscFunctionBeginUser;
  *outcome = (Outcome){0};
  for (PetscInt k = 0; k < c->jobs; k++) {
    Case part = *c;
    Outcome o;

    part.ranks /= c->jobs;
    part.samples /= c->jobs;
    part.seed += (uint64_t)k;
    PetscCall(SimulateDispatch(&part, costs, table, told, &o));
    busy += o.busy * o.seconds / (PetscReal)c->jobs;
    if (o.seconds > outcome->seconds) *outcome = o;
  }
  outcome->busy = busy / outcome->seconds;
  PetscFunctionReturn(0);
}

#endif
