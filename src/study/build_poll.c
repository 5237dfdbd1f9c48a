/*
  What a table says to the states of a sample box.
*/
#include "build.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* States asked: suction is one dimension more. */
enum { BONDED_STATES = 2048, CONTACT_STATES = 4096 };
#define QUANTILE 0.95
#define ENOUGH 0.995

static int CompareKeys(const void *a, const void *b)
{
  const PetscInt64 x = *(const PetscInt64 *)a, y = *(const PetscInt64 *)b;

  return (x > y) - (x < y);
}

static int CompareReals(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return (x > y) - (x < y);
}

/* What a cell lacks, and how many states wait for it. */
typedef struct {
  PetscInt n, states;
  PetscInt64 keys[LAM_MAX_NEEDS];
} Wish;

static int CompareWishes(const void *a, const void *b)
{
  const Wish *x = a, *y = b;

  for (PetscInt i = 0; i < PetscMin(x->n, y->n); i++)
    if (x->keys[i] != y->keys[i]) return x->keys[i] < y->keys[i] ? -1 : 1;
  return (x->n > y->n) - (x->n < y->n);
}

/* Most states for a node first. */
static int CompareDemand(const void *a, const void *b)
{
  const Wish *x = a, *y = b;
  const PetscInt64 first = (PetscInt64)x->states * y->n, second = (PetscInt64)y->states * x->n;

  return first != second ? (first > second ? -1 : 1) : CompareWishes(a, b);
}

/* One wish for each cell; returns their number. */
static PetscInt MergeWishes(PetscInt n, Wish wishes[])
{
  PetscInt merged = 0;

  if (n) qsort(wishes, (size_t)n, sizeof(*wishes), CompareWishes);
  for (PetscInt i = 0; i < n; i++) {
    if (merged && !CompareWishes(&wishes[i], &wishes[merged - 1]))
      wishes[merged - 1].states++;
    else
      wishes[merged++] = wishes[i];
  }
  return merged;
}

static PetscBool Contains(PetscInt n, const PetscInt64 keys[], PetscInt64 key)
{
  return (PetscBool)(n && bsearch(&key, keys, (size_t)n, sizeof(*keys), CompareKeys));
}

/* Leaves out what is on its way. */
static void LeaveOut(const LamRound *under_way, Wish *wish)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < wish->n && under_way; i++)
    if (!Contains(under_way->n, under_way->keys, wish->keys[i])) wish->keys[n++] = wish->keys[i];
  if (under_way) wish->n = n;
}

/* Sorts the keys and keeps one of each. */
static void SortUnique(LamPoll *poll)
{
  PetscInt n = 0;

  if (!poll->lacking) return;
  qsort(poll->keys, (size_t)poll->lacking, sizeof(*poll->keys), CompareKeys);
  for (PetscInt i = 1; i < poll->lacking; i++)
    if (poll->keys[i] != poll->keys[n]) poll->keys[++n] = poll->keys[i];
  poll->lacking = n + 1;
}

/* The nodes of the cells that most states wait for, at least `enough` of them where so many are lacking. */
static PetscErrorCode ChooseNodes(PetscInt n, Wish wishes[], PetscInt enough, LamPoll *poll)
{
  const PetscInt cells = MergeWishes(n, wishes);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)cells * LAM_MAX_NEEDS + 1, &poll->keys));
  if (cells) qsort(wishes, (size_t)cells, sizeof(*wishes), CompareDemand);
  for (PetscInt c = 0; c < cells && poll->lacking < enough; c++) {
    PetscCall(PetscArraycpy(poll->keys + poll->lacking, wishes[c].keys, wishes[c].n));
    poll->lacking += wishes[c].n;
    if (poll->lacking >= enough) SortUnique(poll); /* cells share nodes */
  }
  SortUnique(poll);
  PetscFunctionReturn(0);
}

/* One state; *error is infinite where the table does not reach it. */
static PetscErrorCode Ask(LamTable table, const LamLoad *load, PetscReal accuracy, LamPoll *poll, Wish *wish,
                          PetscReal *error)
{
  LamResponse answer;

  PetscFunctionBeginUser;
  PetscCall(LamTableQuery(table, load, PETSC_INFINITY, &answer));
  *error = LamResponseHasFields(&answer) ? answer.error_estimate : INFINITY;
  if (LamResponseHasFields(&answer) && answer.error_estimate <= accuracy) {
    poll->answered++;
    PetscFunctionReturn(0);
  }
  PetscCall(LamTableNeeds(table, load, accuracy, &wish->n, wish->keys));
  if (wish->n) PetscFunctionReturn(0);
  if (!poll->refused++) {
    PetscCall(LamTableQuery(table, load, accuracy, &answer));
    PetscCall(PetscStrncpy(poll->reason, answer.reason, sizeof(poll->reason)));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode AskAll(const LamScene *scene, const PetscInt states[], LamTable table, PetscReal accuracy,
                             PetscInt enough, const LamRound *under_way, LamPoll *poll)
{
  PetscReal *errors, error;
  Wish *wishes;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(poll->asked, &errors));
  PetscCall(PetscMalloc1(poll->asked, &wishes));
  for (PetscInt i = 0; i < poll->asked; i++) {
    LamLoad load;

    LamSampleLoad(scene, states[i], &load);
    wishes[n].n = 0;
    wishes[n].states = 1;
    PetscCall(Ask(table, &load, accuracy, poll, &wishes[n], &error));
    LeaveOut(under_way, &wishes[n]);
    if (wishes[n].n) n++;
    if (isfinite(error)) errors[poll->reached++] = error;
  }
  qsort(errors, (size_t)poll->reached, sizeof(*errors), CompareReals);
  poll->error = poll->reached ? errors[(PetscInt)(QUANTILE * (PetscReal)(poll->reached - 1))] : NAN;
  PetscCall(PetscFree(errors));
  PetscCall(ChooseNodes(n, wishes, enough, poll));
  PetscCall(PetscFree(wishes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPollMake(const LamScene *scene, const LamShard *shard, LamDatabase database, PetscReal accuracy,
                           PetscInt enough, const LamRound *under_way, LamPoll *poll)
{
  const PetscBool contact = (PetscBool)(scene->micro.interface == LAM_INTERFACE_CONTACT);
  PetscErrorCode ierr;
  PetscInt *states;
  LamTable table;

  PetscFunctionBeginUser;
  *poll = (LamPoll){0};
  PetscCall(LamShardStates(scene, shard, contact ? CONTACT_STATES : BONDED_STATES, &poll->asked, &states));
  PetscCall(LamDatabaseGetTable(database, &table));
  ierr = AskAll(scene, states, table, accuracy, enough, under_way, poll);
  PetscCall(LamTableDestroy(&table));
  PetscCall(PetscFree(states));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscBool LamPollIsDone(const LamPoll *poll)
{
  return (PetscBool)((PetscReal)poll->answered >= ENOUGH * (PetscReal)(poll->asked - poll->refused));
}

PetscErrorCode LamPollDestroy(LamPoll *poll)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(poll->keys));
  PetscFunctionReturn(0);
}
