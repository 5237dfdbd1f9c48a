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

static PetscErrorCode Lack(LamPoll *poll, PetscInt n, const PetscInt64 keys[], PetscInt *capacity)
{
  PetscFunctionBeginUser;
  if (poll->lacking + n > *capacity) {
    SortUnique(poll);
    *capacity = PetscMax(*capacity, 2 * (poll->lacking + n));
    PetscCall(PetscRealloc((size_t)*capacity * sizeof(*poll->keys), &poll->keys));
  }
  if (n) PetscCall(PetscArraycpy(poll->keys + poll->lacking, keys, n));
  poll->lacking += n;
  PetscFunctionReturn(0);
}

/* One state; *error is infinite where the table does not reach it. */
static PetscErrorCode Ask(LamTable table, const LamLoad *load, PetscReal accuracy, LamPoll *poll, PetscInt *capacity,
                          PetscReal *error)
{
  PetscInt64 keys[LAM_MAX_NEEDS];
  LamResponse answer;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamTableQuery(table, load, PETSC_INFINITY, &answer));
  *error = LamResponseHasFields(&answer) ? answer.error_estimate : INFINITY;
  if (LamResponseHasFields(&answer) && answer.error_estimate <= accuracy) {
    poll->answered++;
    PetscFunctionReturn(0);
  }
  PetscCall(LamTableNeeds(table, load, accuracy, &n, keys));
  PetscCall(Lack(poll, n, keys, capacity));
  if (n) PetscFunctionReturn(0);
  if (!poll->refused++) {
    PetscCall(LamTableQuery(table, load, accuracy, &answer));
    PetscCall(PetscStrncpy(poll->reason, answer.reason, sizeof(poll->reason)));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode AskAll(const LamScene *scene, LamTable table, PetscReal accuracy, LamPoll *poll)
{
  PetscReal *errors, error;
  PetscInt capacity = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(poll->asked, &errors));
  for (PetscInt i = 0; i < poll->asked; i++) {
    LamLoad load;

    LamSampleLoad(scene, i, &load);
    PetscCall(Ask(table, &load, accuracy, poll, &capacity, &error));
    if (isfinite(error)) errors[poll->reached++] = error;
  }
  qsort(errors, (size_t)poll->reached, sizeof(*errors), CompareReals);
  poll->error = poll->reached ? errors[(PetscInt)(QUANTILE * (PetscReal)(poll->reached - 1))] : NAN;
  PetscCall(PetscFree(errors));
  SortUnique(poll);
  PetscFunctionReturn(0);
}

PetscErrorCode LamPollMake(const LamScene *scene, LamDatabase database, PetscReal accuracy, LamPoll *poll)
{
  PetscErrorCode ierr;
  LamTable table;

  PetscFunctionBeginUser;
  *poll = (LamPoll){.asked = scene->micro.interface == LAM_INTERFACE_CONTACT ? CONTACT_STATES : BONDED_STATES};
  PetscCall(LamDatabaseGetTable(database, &table));
  ierr = AskAll(scene, table, accuracy, poll);
  PetscCall(LamTableDestroy(&table));
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
