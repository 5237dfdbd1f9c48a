/*
  Which nodes are solved, round by round.
*/
#include "build.h"
#include <math.h>
#include <stdlib.h>

enum { MOST_NODES = 200000 }; /* with an accuracy */
/* Nodes of a round: so many, or a share of what is there. Few, so that the next round asks a better table. */
enum { LEAST_ROUND = 100, ROUND_SHARE = 4 };
/* With an accuracy: what a round is to add to the answered share, once that is large, and how often it may add less. */
#define LEAST_GAIN 0.01
#define WELL_ANSWERED 0.5
enum { MOST_IDLE = 2 };
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
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetRecords(file, &n, &records, &keys));
  PetscCall(PetscMalloc1(n, &rounds->known));
  for (PetscInt i = 0; i < n; i++) {
    if (LamKeyIsFreeCell(keys[i])) {
      PetscCall(LamDatabaseAdd(rounds->table, 1, &keys[i], &records[i]));
      rounds->nodes++;
    } else if (LamKeyIsNode(keys[i]))
      rounds->known[rounds->known_count++] = (LamKnownNode){keys[i], &records[i]};
  }
  if (rounds->known_count) qsort(rounds->known, (size_t)rounds->known_count, sizeof(*rounds->known), CompareKnown);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRoundsCreate(const LamScene *scene, LamDatabase file, LamGrid *grid, LamRounds *rounds)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  *rounds = (LamRounds){.scene = scene,
                        .most = scene->sample.count ? scene->sample.count : MOST_NODES,
                        .accuracy = scene->sample.count ? PETSC_INFINITY : scene->sample.accuracy};
  PetscCall(LamDatabaseCreateEmpty(scene, &rounds->table));
  PetscCall(LamGridGetRecords(*grid, &n, &keys, &records));
  PetscCall(LamDatabaseAdd(rounds->table, n, keys, records));
  rounds->nodes = n;
  PetscCall(LamDatabaseSetGrid(rounds->table, grid));
  if (file) PetscCall(FindKnown(file, rounds));
  PetscFunctionReturn(0);
}

static PetscErrorCode Poll(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  PetscCall(LamPollDestroy(&rounds->poll));
  PetscCall(LamPollMake(rounds->scene, rounds->table, rounds->accuracy,
                        PetscMax(LEAST_ROUND, rounds->nodes / ROUND_SHARE), &rounds->poll));
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

/* Asks the table; with a count for more and more, until it lacks something. */
static PetscErrorCode PollUntilLacking(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  PetscCall(Poll(rounds));
  while (rounds->scene->sample.count && LamPollIsDone(&rounds->poll) && rounds->accuracy > LAST_ACCURACY) {
    rounds->accuracy = PetscMin(FIRST_ACCURACY, rounds->accuracy / 2);
    PetscCall(Poll(rounds));
  }
  Compare(rounds);
  rounds->n = 0;
  if (!LamPollIsDone(&rounds->poll) && !LamRoundsAreIdle(rounds))
    rounds->n = (PetscInt)PetscMin(rounds->poll.lacking, rounds->most - rounds->nodes);
  PetscFunctionReturn(0);
}

/* Fills in what is known, and lists what is not. */
static PetscErrorCode LookUp(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(rounds->responses));
  PetscCall(PetscFree(rounds->place));
  PetscCall(PetscMalloc1(rounds->n, &rounds->responses));
  PetscCall(PetscMalloc1(rounds->n, &rounds->place));
  rounds->missing = 0;
  for (PetscInt i = 0; i < rounds->n; i++) {
    const LamKnownNode wanted = {.key = rounds->poll.keys[i]};
    const LamKnownNode *found = NULL;

    if (rounds->known_count)
      found = bsearch(&wanted, rounds->known, (size_t)rounds->known_count, sizeof(wanted), CompareKnown);
    if (!found) {
      rounds->place[rounds->missing++] = i;
      continue;
    }
    rounds->responses[i] = *found->record;
    rounds->known_failed += found->record->status != LAM_CONVERGED;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamRoundsNext(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  for (;;) {
    PetscCall(PollUntilLacking(rounds));
    PetscCall(LookUp(rounds));
    if (rounds->missing || !rounds->n) break;
    PetscCall(LamRoundsComplete(rounds));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamRoundsComplete(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  PetscCall(LamDatabaseAdd(rounds->table, rounds->n, rounds->poll.keys, rounds->responses));
  rounds->nodes += rounds->n;
  rounds->n = rounds->missing = 0;
  PetscFunctionReturn(0);
}

PetscReal LamRoundsAnswered(const LamRounds *rounds)
{
  const PetscInt n = rounds->scene->sample.count ? rounds->poll.reached : rounds->poll.answered;

  return rounds->poll.asked ? (PetscReal)n / (PetscReal)rounds->poll.asked : 0;
}

PetscErrorCode LamRoundsDestroy(LamRounds *rounds)
{
  PetscFunctionBeginUser;
  PetscCall(LamPollDestroy(&rounds->poll));
  PetscCall(LamDatabaseClose(&rounds->table));
  PetscCall(PetscFree(rounds->known));
  PetscCall(PetscFree(rounds->responses));
  PetscCall(PetscFree(rounds->place));
  PetscFunctionReturn(0);
}
