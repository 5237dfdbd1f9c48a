/*
  What rank 0 of the simulated job decides and writes: rounds and commits, as build_rounds.c and cmd_build.c do.
*/
#ifndef LAM_DISPATCH_ROUNDS_H
#define LAM_DISPATCH_ROUNDS_H

#include "dispatch_model.h"

/* All pieces of the round that are not committed; after a failure under new numbers. */
static PetscErrorCode AddPieces(Model *m, PetscInt number)
{
  Round *round = &m->round[number];

  PetscFunctionBeginUser;
  for (int class = 0; class < WORK_CLASSES; class ++) {
    const PetscInt64 missing = round->total[class] - round->committed[class];
    const PetscInt64 first = PieceOf(class, number, round->numbers);

    if (missing) PetscCall(LamScheduleAdd(m->inner[ROOT].schedule, first, missing, CostOf(m, first)));
  }
  round->numbers += round->count;
  PetscFunctionReturn(0);
}

/* Few pieces are drawn one by one, many in the shares of the classes. */
static void FillRound(Model *m, Round *round)
{
  const PetscBool few = (PetscBool)(round->count < DRAWN_ONE_BY_ONE);
  PetscInt64 records = 0;

  for (int class = 0; class < WORK_CLASSES; class ++) {
    records += m->table->classes[class].n;
    round->total[class] = few ? 0 : ShareOfClass(m->table, round->count, class);
  }
  for (PetscInt64 i = 0; i < round->count && few; i++) {
    PetscInt64 record = (PetscInt64)(Random(m) * (double)records);
    int class = 0;

    while (record >= m->table->classes[class].n) record -= m->table->classes[class ++].n;
    round->total[class]++;
  }
}

static PetscErrorCode NewRound(Model *m)
{
  const PetscInt64 rest = m->c->samples - m->nodes;
  const PetscInt64 wanted = m->c->least_round ? PetscMax(m->c->least_round, m->table_nodes / m->c->round_share) : rest;
  const PetscInt64 size = PetscMin(rest, wanted);
  Round *round;

  PetscFunctionBeginUser;
  if (m->decided == m->round_room) {
    m->round_room = PetscMax(64, 2 * m->round_room);
    PetscCall(PetscRealloc((size_t)m->round_room * sizeof(*m->round), &m->round));
  }
  round = &m->round[m->decided];
  *round = (Round){.grain = 1};
  if (m->c->grain > 0) round->grain = PetscMax(1, (PetscInt64)((PetscReal)size / (m->c->grain * m->c->ranks)));
  round->count = size / round->grain;
  FillRound(m, round);
  m->nodes += round->count * round->grain;
  PetscCall(AddPieces(m, m->decided++));
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(Model *m)
{
  Inner *root = &m->inner[ROOT];
  const PetscReal seconds =
      m->c->leaders_write ? 0 : m->costs->commit + (PetscReal)m->uncommitted * m->costs->commit_record;

  PetscFunctionBeginUser;
  Handle(root, root->free, seconds);
  root->handling -= seconds;
  m->committing += seconds;
  m->commit_seconds = seconds;
  m->outcome->records += m->uncommitted;
  m->uncommitted = 0;
  for (PetscInt64 i = 0; i < m->pending_n; i++) {
    RoundOf(m, m->pending[i])->committed[ClassOfPiece(m->pending[i])]++;
    if (m->c->mtbf > 0) m->saved += SecondsOf(m, m->pending[i]);
  }
  m->pending_n = 0;
  m->last_commit = root->free;
  PetscFunctionReturn(0);
}

static PetscReal PollSeconds(const Model *m)
{
  return m->c->least_round ? m->costs->poll + (PetscReal)m->table_nodes * m->costs->poll_node : 0;
}

static PetscBool IsComplete(const Round *round)
{
  return (PetscBool)(round->arrived == round->count);
}

/* The next round, where it is time for it and samples are left. */
static PetscErrorCode Decide(Model *m, PetscBool *any)
{
  Inner *root = &m->inner[ROOT];

  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  for (; m->complete < m->decided && IsComplete(&m->round[m->complete]); m->complete++)
    m->table_nodes += m->round[m->complete].count * m->round[m->complete].grain;
  while (m->nodes < m->c->samples && m->decided < m->complete + m->c->open_rounds) {
    PetscReal seconds = PollSeconds(m);

    PetscCall(NewRound(m));
    if (m->c->least_round)
      seconds += m->costs->choose * (PetscReal)(m->round[m->decided - 1].count * m->round[m->decided - 1].grain);
    Handle(root, root->free, seconds);
    root->handling -= seconds;
    m->polling += seconds;
    m->polled += seconds;
    *any = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* A result that nobody else has brought. */
static PetscErrorCode Accept(Model *m, PetscInt64 piece)
{
  Round *round = RoundOf(m, piece);

  PetscFunctionBeginUser;
  round->arrived++;
  m->uncommitted += round->grain;
  if (m->pending_n == m->pending_room) {
    m->pending_room = PetscMax(1024, 2 * m->pending_room);
    PetscCall(PetscRealloc((size_t)m->pending_room * sizeof(*m->pending), &m->pending));
  }
  m->pending[m->pending_n++] = piece;
  PetscFunctionReturn(0);
}

static PetscBool AllArrived(const Model *m)
{
  return (PetscBool)(m->nodes >= m->c->samples && m->complete == m->decided);
}

/* After results have come to rank 0. */
static PetscErrorCode Advance(Model *m)
{
  PetscBool any;

  PetscFunctionBeginUser;
  PetscCall(Decide(m, &any));
  if (any) PetscCall(HandOut(m, ROOT));
  if (AllArrived(m) || m->uncommitted >= COMMIT_RECORDS ||
      m->inner[ROOT].free - m->last_commit >= PetscMax(COMMIT_SECONDS, COMMIT_SHARE * m->commit_seconds))
    PetscCall(Commit(m));
  if (AllArrived(m)) m->end = m->inner[ROOT].free;
  PetscFunctionReturn(0);
}

#endif
