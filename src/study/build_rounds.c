/*
  Which nodes are solved, round by round.
*/
#include "build.h"
#include <math.h>
#include <stdlib.h>

enum { MOST_NODES = 200000 }; /* with an accuracy */
/* A round is so large a share of what is there, where that is more than the scene's `round`: few nodes, so that the
   next round asks a better table. */
enum { ROUND_SHARE = 12 };
/* With an accuracy: what a round is to add to the answered share, once that is large, and how often it may add less. */
#define LEAST_GAIN 0.003
#define WELL_ANSWERED 0.5
enum { MOST_IDLE = 6 };
/* With a count: the first accuracy after any, and the last. */
#define FIRST_ACCURACY 0.125
#define LAST_ACCURACY 1e-6

static int CompareKnown(const void *a, const void *b)
{
  const PetscInt64 x = ((const LamKnownNode *)a)->key, y = ((const LamKnownNode *)b)->key;

  return (x > y) - (x < y);
}

/* The nodes of the file; those of free cells belong to the grid and are in the table from the start. */
static PetscErrorCode FindKnown(LamDatabase file, LamRounds *rounds)
{
  const PetscBool from_grid = (PetscBool)(rounds->nodes > 0);
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetRecords(file, &n, &records, &keys));
  PetscCall(PetscMalloc1(n, &rounds->known));
  for (PetscInt i = 0; i < n; i++) {
    if (LamKeyIsFreeCell(keys[i])) {
      if (from_grid) continue;
      PetscCall(LamDatabaseAdd(rounds->table, 1, &keys[i], &records[i]));
      rounds->nodes++;
    } else if (LamKeyIsNode(keys[i]))
      rounds->known[rounds->known_count++] = (LamKnownNode){keys[i], &records[i]};
  }
  if (rounds->known_count) qsort(rounds->known, (size_t)rounds->known_count, sizeof(*rounds->known), CompareKnown);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRoundsCreate(const LamScene *scene, const LamShard *shard, LamDatabase file, LamGrid *grid,
                               LamRounds *rounds)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  *rounds = (LamRounds){.scene = scene,
                        .shard = shard,
                        .most = PetscMax(1, (scene->sample.count ? scene->sample.count : MOST_NODES) / shard->count),
                        .accuracy = scene->sample.count ? PETSC_INFINITY : scene->sample.accuracy};
  PetscCall(LamDatabaseCreateEmpty(scene, &rounds->table));
  PetscCall(LamGridGetRecords(*grid, &n, &keys, &records));
  PetscCall(LamDatabaseAdd(rounds->table, n, keys, records));
  rounds->nodes = n;
  rounds->grid = *grid;
  PetscCall(LamDatabaseSetGrid(rounds->table, grid));
  PetscCall(LamNodeCostsCreate(rounds->grid, &rounds->costs));
  if (file) PetscCall(FindKnown(file, rounds));
  PetscFunctionReturn(0);
}

const LamResponse *LamRoundsKnown(const LamRounds *rounds, PetscInt64 key)
{
  const LamKnownNode wanted = {.key = key};
  const LamKnownNode *found = NULL;

  if (rounds->known_count)
    found = bsearch(&wanted, rounds->known, (size_t)rounds->known_count, sizeof(wanted), CompareKnown);
  return found ? found->record : NULL;
}

/* ---- what is asked for ---- */

static PetscErrorCode Poll(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  PetscCall(LamPollDestroy(&rounds->poll));
  PetscCall(LamPollMake(rounds->scene, rounds->shard, rounds->table, rounds->accuracy,
                        PetscMax(rounds->scene->sample.round / rounds->shard->count + 1, rounds->nodes / ROUND_SHARE),
                        rounds->open ? rounds->round : NULL, &rounds->poll));
  PetscFunctionReturn(0);
}

PetscBool LamRoundsAreIdle(const LamRounds *rounds)
{
  return (PetscBool)(!rounds->scene->sample.count && rounds->idle >= MOST_IDLE);
}

/* What the last round has brought. */
static void Compare(LamRounds *rounds)
{
  const LamPoll *poll = &rounds->poll;
  const PetscBool gained = (PetscBool)(poll->answered >= rounds->best + LEAST_GAIN * poll->asked);

  rounds->idle = gained || poll->answered < WELL_ANSWERED * poll->asked ? 0 : rounds->idle + 1;
  rounds->best = PetscMax(rounds->best, poll->answered);
}

/* Asks the table; with a count for more and more, until it lacks something. *n: nodes for the next round. */
static PetscErrorCode PollUntilLacking(LamRounds *rounds, PetscInt *n)
{
  const PetscInt under_way = rounds->open ? rounds->round[0].n : 0;

  PetscFunctionBeginUser;
  PetscCall(Poll(rounds));
  while (rounds->scene->sample.count && LamPollIsDone(&rounds->poll) && rounds->accuracy > LAST_ACCURACY) {
    rounds->accuracy = PetscMin(FIRST_ACCURACY, rounds->accuracy / 2);
    PetscCall(Poll(rounds));
  }
  Compare(rounds);
  *n = 0;
  if (!LamPollIsDone(&rounds->poll) && !LamRoundsAreIdle(rounds))
    *n = (PetscInt)PetscMax(0, PetscMin(rounds->poll.lacking, rounds->most - rounds->nodes - under_way));
  PetscFunctionReturn(0);
}

/* ---- a round ---- */

static PetscErrorCode RoundDestroy(LamRound *round)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(round->keys));
  PetscCall(PetscFree(round->responses));
  PetscCall(PetscFree(round->order));
  PetscCall(PetscFree(round->cost));
  PetscCall(PetscFree(round->solved));
  PetscCall(PetscFree(round->taken));
  *round = (LamRound){0};
  PetscFunctionReturn(0);
}

static int CompareKeys(const void *a, const void *b)
{
  const PetscInt64 x = *(const PetscInt64 *)a, y = *(const PetscInt64 *)b;

  return (x > y) - (x < y);
}

/* The place of a key in the round, or -1. */
static PetscInt FindKey(const LamRound *round, PetscInt64 key)
{
  const PetscInt64 *found = bsearch(&key, round->keys, (size_t)round->n, sizeof(key), CompareKeys);

  return found ? (PetscInt)(found - round->keys) : -1;
}

/* Fills in what is known, and lists what is not. */
static PetscErrorCode LookUp(LamRounds *rounds, LamRound *round)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < round->n; i++) {
    const LamResponse *found = LamRoundsKnown(rounds, round->keys[i]);

    round->solved[i] = (PetscBool)(found != NULL);
    if (!found) {
      round->order[round->missing++] = i;
      continue;
    }
    round->responses[i] = *found;
    rounds->known_failed += found->status != LAM_CONVERGED;
  }
  PetscFunctionReturn(0);
}

typedef struct {
  PetscInt place;
  PetscReal cost, chain; /* its own, and that of the longest chain of nodes that begins with it */
} Ranked;

static int CompareRanked(const void *a, const void *b)
{
  const Ranked *x = a, *y = b;

  if (x->chain != y->chain) return x->chain > y->chain ? -1 : 1;
  return (x->place > y->place) - (x->place < y->place);
}

/* Costs of the missing nodes, and of the chains of the round that each begins; `chain` [n], 0 for those known. */
static PetscErrorCode RankChains(LamRounds *rounds, const LamRound *round, PetscReal cost[], PetscReal chain[])
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < round->missing; m++) {
    const PetscInt i = round->order[m];

    cost[i] = LamNodeCostsPredict(rounds->costs, round->keys[i]);
  }
  for (PetscInt m = 0; m < round->missing; m++) {
    PetscReal length = 0;
    PetscInt64 key = round->keys[round->order[m]];

    for (; key >= 0; key = LamGridNodeParent(rounds->grid, key)) {
      const PetscInt i = FindKey(round, key);

      if (i < 0 || round->solved[i]) continue;
      length += cost[i];
      chain[i] = PetscMax(chain[i], length);
    }
  }
  PetscFunctionReturn(0);
}

/* The longest chains first: so a parent, whose chain holds its children's, comes before them. */
static PetscErrorCode Sort(LamRounds *rounds, LamRound *round)
{
  const PetscBool chained = (PetscBool)(rounds->scene->micro.interface == LAM_INTERFACE_CONTACT);
  PetscReal *cost, *chain;
  Ranked *ranked;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(round->n, &cost, round->n, &chain));
  PetscCall(PetscMalloc1(round->missing + 1, &ranked));
  PetscCall(RankChains(rounds, round, cost, chain));
  for (PetscInt m = 0; m < round->missing; m++) {
    const PetscInt i = round->order[m];

    ranked[m] = (Ranked){i, cost[i], chained ? chain[i] : cost[i]};
  }
  qsort(ranked, (size_t)round->missing, sizeof(*ranked), CompareRanked);
  for (PetscInt m = 0; m < round->missing; m++) {
    round->order[m] = ranked[m].place;
    round->cost[m] = ranked[m].chain;
  }
  PetscCall(PetscFree2(cost, chain));
  PetscCall(PetscFree(ranked));
  PetscFunctionReturn(0);
}

static PetscErrorCode RoundCreate(LamRounds *rounds, PetscInt n, LamRound *round)
{
  PetscFunctionBeginUser;
  *round = (LamRound){.n = n};
  PetscCall(PetscMalloc1(n, &round->keys));
  PetscCall(PetscArraycpy(round->keys, rounds->poll.keys, n));
  PetscCall(PetscMalloc1(n, &round->responses));
  PetscCall(PetscMalloc1(n, &round->solved));
  PetscCall(PetscMalloc1(n, &round->order));
  PetscCall(LookUp(rounds, round));
  PetscCall(PetscMalloc1(round->missing, &round->cost));
  PetscCall(PetscCalloc1(round->missing, &round->taken));
  PetscCall(Sort(rounds, round));
  PetscFunctionReturn(0);
}

static PetscBool IsComplete(const LamRound *round)
{
  return (PetscBool)(round->arrived == round->missing && round->next == round->missing);
}

/* All responses are there and on the way to the file: the older round goes into the table. */
static PetscErrorCode Close(LamRounds *rounds)
{
  LamRound *round = &rounds->round[0];

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseAdd(rounds->table, round->n, round->keys, round->responses));
  for (PetscInt i = 0; i < round->n; i++)
    PetscCall(LamNodeCostsLearn(rounds->costs, round->keys[i], &round->responses[i]));
  rounds->nodes += round->n;
  PetscCall(RoundDestroy(round));
  rounds->round[0] = rounds->round[1];
  rounds->round[1] = (LamRound){0};
  rounds->open--;
  rounds->dry = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* A round is opened before one that is complete is closed: what it asks for must not depend on which came first. */
PetscErrorCode LamRoundsNext(LamRounds *rounds, LamRound **round)
{
  PetscFunctionBeginUser;
  *round = NULL;
  for (;;) {
    if (rounds->open < LAM_OPEN_ROUNDS && !rounds->dry) {
      PetscInt n = 0;

      PetscCall(PollUntilLacking(rounds, &n));
      rounds->dry = (PetscBool)(n == 0);
      if (rounds->dry) continue;
      *round = &rounds->round[rounds->open];
      PetscCall(RoundCreate(rounds, n, *round));
      rounds->open++;
      break;
    }
    if (!rounds->open || !IsComplete(&rounds->round[0])) break;
    PetscCall(Close(rounds));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamRoundsArrive(LamRounds *rounds, PetscInt64 key, const LamResponse *response)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < rounds->open; r++) {
    LamRound *round = &rounds->round[r];
    const PetscInt i = FindKey(round, key);

    if (i < 0) continue;
    round->responses[i] = *response;
    round->solved[i] = PETSC_TRUE;
    round->arrived++;
    PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_PLIB, "node %lld belongs to no open round", (long long)key);
}

PetscInt64 LamRoundsAsked(const LamRounds *rounds)
{
  PetscInt64 n = rounds->nodes;

  for (PetscInt r = 0; r < rounds->open; r++) n += rounds->round[r].n;
  return n;
}

PetscInt64 LamRoundsThere(const LamRounds *rounds)
{
  PetscInt64 n = LamRoundsAsked(rounds);

  for (PetscInt r = 0; r < rounds->open; r++) n -= rounds->round[r].missing - rounds->round[r].arrived;
  return n;
}

PetscReal LamRoundsAnswered(const LamRounds *rounds)
{
  const PetscInt n = rounds->scene->sample.count ? rounds->poll.reached : rounds->poll.answered;

  return rounds->poll.asked ? (PetscReal)n / (PetscReal)rounds->poll.asked : 0;
}

PetscErrorCode LamRoundsDestroy(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < LAM_OPEN_ROUNDS; r++) PetscCall(RoundDestroy(&rounds->round[r]));
  PetscCall(LamPollDestroy(&rounds->poll));
  PetscCall(LamNodeCostsDestroy(&rounds->costs));
  PetscCall(LamDatabaseClose(&rounds->table));
  PetscCall(PetscFree(rounds->known));
  PetscFunctionReturn(0);
}
