/*
  Selection of the nodes to solve, in rounds.
*/
#include "build.h"
#include "gather.h"
#include <math.h>
#include <stdlib.h>

enum { MOST_NODES = 200000 }; /* with `sample.accuracy` */
enum {
  ROUND_SHARE = 12
}; /* a round has 1/12 of the table's nodes, or `sample.round`; larger rounds are selected from an older table */
/* With `sample.accuracy`: a round is idle if it adds less than LEAST_GAIN to the covered fraction once that exceeds
   WELL_COVERED. The build ends after MOST_IDLE idle rounds in a row. */
#define LEAST_GAIN 0.003
#define WELL_COVERED 0.5
enum { MOST_IDLE = 6 };
/* With `sample.count`: the first finite accuracy, and the last. */
#define FIRST_ACCURACY 0.125
#define LAST_ACCURACY 1e-8

/* Adds the file's records of free cells to the table where the grid has none. */
static PetscErrorCode AddFreeCells(LamRounds *rounds)
{
  const LamKnownRecords *known = &rounds->known;

  PetscFunctionBeginUser;
  if (rounds->nodes) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < known->n; i++) {
    if (!LamKeyIsFreeCell(known->keys[i])) continue;
    PetscCall(LamDatabaseAdd(rounds->table, 1, &known->keys[i], &known->records[i]));
    rounds->nodes++;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamRoundsCreate(const LamScene *scene, const LamShard *shard, const LamKnownRecords *known,
                               LamGrid *grid, LamRounds *rounds)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  *rounds = (LamRounds){.scene = scene,
                        .shard = shard,
                        .known = *known,
                        .most = PetscMax(1, (scene->sample.count ? scene->sample.count : MOST_NODES) / shard->count),
                        .accuracy = scene->sample.count ? PETSC_INFINITY : scene->sample.accuracy};
  PetscCall(LamDatabaseCreateEmpty(scene, &rounds->table));
  PetscCall(LamGridGetRecords(*grid, &n, &keys, &records));
  PetscCall(LamDatabaseAdd(rounds->table, n, keys, records));
  rounds->nodes = n;
  rounds->grid = *grid;
  PetscCall(LamDatabaseSetGrid(rounds->table, grid));
  PetscCall(LamNodeCostsCreate(rounds->grid, &rounds->costs));
  PetscCall(AddFreeCells(rounds));
  PetscFunctionReturn(0);
}

/* ---- nodes that the table lacks ---- */

static PetscErrorCode Cover(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  PetscCall(LamCoverageDestroy(&rounds->coverage));
  PetscCall(
      LamCoverageCompute(rounds->scene, rounds->shard, rounds->table, rounds->accuracy,
                         PetscMax(rounds->scene->sample.round / rounds->shard->count + 1, rounds->nodes / ROUND_SHARE),
                         rounds->open ? rounds->round : NULL, rounds->meanwhile, &rounds->coverage));
  PetscFunctionReturn(0);
}

PetscBool LamRoundsAreIdle(const LamRounds *rounds)
{
  return (PetscBool)(!rounds->scene->sample.count && rounds->idle >= MOST_IDLE);
}

/* Counts idle rounds in a row. */
static void Compare(LamRounds *rounds)
{
  const LamCoverage *coverage = &rounds->coverage;
  const PetscBool gained = (PetscBool)(coverage->covered >= rounds->best + LEAST_GAIN * coverage->states);

  rounds->idle = gained || coverage->covered < WELL_COVERED * coverage->states ? 0 : rounds->idle + 1;
  rounds->best = PetscMax(rounds->best, coverage->covered);
}

/* *n: number of nodes of the next round. With `sample.count` the tolerance is halved until the table lacks nodes. */
static PetscErrorCode FindLacking(LamRounds *rounds, PetscInt *n)
{
  const PetscInt under_way = rounds->open ? rounds->round[0].n : 0;

  PetscFunctionBeginUser;
  PetscCall(Cover(rounds));
  while (rounds->scene->sample.count && LamCoverageIsDone(&rounds->coverage) && rounds->accuracy > LAST_ACCURACY) {
    rounds->accuracy = PetscMin(FIRST_ACCURACY, rounds->accuracy / 2);
    PetscCall(Cover(rounds));
  }
  Compare(rounds);
  *n = 0;
  if (!LamCoverageIsDone(&rounds->coverage) && !LamRoundsAreIdle(rounds))
    *n = (PetscInt)PetscMax(0, PetscMin(rounds->coverage.lacking, rounds->most - rounds->nodes - under_way));
  PetscFunctionReturn(0);
}

/* ---- a round ---- */

static PetscErrorCode RoundDestroy(LamRound *round)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(round->keys, round->responses, round->order, round->cost, round->solved, round->taken));
  *round = (LamRound){0};
  PetscFunctionReturn(0);
}

/* Copies records of the file into the round and lists the nodes that the file lacks. */
static PetscErrorCode LookUp(LamRounds *rounds, LamRound *round)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < round->n; i++) {
    const LamResponse *found = LamKnownRecordsGet(&rounds->known, round->keys[i], NULL);

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
  PetscReal cost;
} Ranked;

static int CompareRanked(const void *a, const void *b)
{
  const Ranked *x = a, *y = b;

  if (x->cost != y->cost) return x->cost > y->cost ? -1 : 1;
  return (x->place > y->place) - (x->place < y->place);
}

/* chain[n]: cost of the longest chain of missing nodes that starts at the node. Bonded nodes have no chains. */
static PetscErrorCode PredictChains(LamRounds *rounds, const LamRound *round, PetscReal chain[])
{
  const PetscBool chained = LamCellsPart(rounds->scene->micro.interface);
  PetscReal *cost;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(round->n, &cost));
  for (PetscInt m = 0; m < round->missing; m++)
    cost[round->order[m]] = LamNodeCostsPredict(rounds->costs, round->keys[round->order[m]]);
  for (PetscInt m = 0; m < round->missing; m++) {
    PetscInt64 key = round->keys[round->order[m]];
    PetscReal length = 0;

    for (; key >= 0; key = chained ? LamGridNodeParent(rounds->grid, key) : -1) {
      const PetscInt i = LamFindKey(round->n, round->keys, key);

      if (i < 0 || round->solved[i]) continue;
      length += cost[i];
      chain[i] = PetscMax(chain[i], length);
    }
  }
  PetscCall(PetscFree(cost));
  PetscFunctionReturn(0);
}

/* Longest chains first. A parent precedes its children, because its chain contains theirs. */
static PetscErrorCode Sort(LamRounds *rounds, LamRound *round)
{
  PetscReal *chain;
  Ranked *ranked;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(round->n, &chain));
  PetscCall(PetscMalloc1(round->missing + 1, &ranked));
  PetscCall(PredictChains(rounds, round, chain));
  for (PetscInt m = 0; m < round->missing; m++) ranked[m] = (Ranked){round->order[m], chain[round->order[m]]};
  qsort(ranked, (size_t)round->missing, sizeof(*ranked), CompareRanked);
  for (PetscInt m = 0; m < round->missing; m++) {
    round->order[m] = ranked[m].place;
    round->cost[m] = ranked[m].cost;
  }
  PetscCall(PetscFree(chain));
  PetscCall(PetscFree(ranked));
  PetscFunctionReturn(0);
}

static PetscErrorCode RoundCreate(LamRounds *rounds, PetscInt n, LamRound *round)
{
  PetscFunctionBeginUser;
  *round = (LamRound){.turn = rounds->opened++, .n = n};
  PetscCall(PetscCalloc6(n, &round->keys, n, &round->responses, n, &round->order, n, &round->cost, n, &round->solved, n,
                         &round->taken));
  PetscCall(PetscArraycpy(round->keys, rounds->coverage.keys, n));
  PetscCall(LookUp(rounds, round));
  PetscCall(Sort(rounds, round));
  PetscFunctionReturn(0);
}

static PetscBool IsComplete(const LamRound *round)
{
  return (PetscBool)(round->arrived == round->missing && round->next == round->missing);
}

/* Adds the older round to the table; all its responses have arrived and are queued for the file. */
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

/* Opens a round before closing a complete one, so that its nodes do not depend on the order of arrival. */
PetscErrorCode LamRoundsNext(LamRounds *rounds, LamRound **round)
{
  PetscFunctionBeginUser;
  *round = NULL;
  for (;;) {
    if (rounds->open < LAM_OPEN_ROUNDS && !rounds->dry) {
      PetscInt n = 0;

      PetscCall(FindLacking(rounds, &n));
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
    const PetscInt i = LamFindKey(round->n, round->keys, key);

    if (i < 0) continue;
    round->responses[i] = *response;
    round->solved[i] = PETSC_TRUE;
    round->arrived++;
    PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_PLIB, "node %lld belongs to no open round", (long long)key);
}

PetscInt64 LamRoundsRequested(const LamRounds *rounds)
{
  PetscInt64 n = rounds->nodes;

  for (PetscInt r = 0; r < rounds->open; r++) n += rounds->round[r].n;
  return n;
}

PetscInt64 LamRoundsAvailable(const LamRounds *rounds)
{
  PetscInt64 n = LamRoundsRequested(rounds);

  for (PetscInt r = 0; r < rounds->open; r++) n -= rounds->round[r].missing - rounds->round[r].arrived;
  return n;
}

PetscReal LamRoundsCovered(const LamRounds *rounds)
{
  const PetscInt n = rounds->scene->sample.count ? rounds->coverage.reached : rounds->coverage.covered;

  return rounds->coverage.states ? (PetscReal)n / (PetscReal)rounds->coverage.states : 0;
}

PetscErrorCode LamRoundsDestroy(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < LAM_OPEN_ROUNDS; r++) PetscCall(RoundDestroy(&rounds->round[r]));
  PetscCall(LamCoverageDestroy(&rounds->coverage));
  PetscCall(LamNodeCostsDestroy(&rounds->costs));
  PetscCall(LamDatabaseClose(&rounds->table));
  PetscCall(LamKnownRecordsDestroy(&rounds->known));
  PetscFunctionReturn(0);
}
