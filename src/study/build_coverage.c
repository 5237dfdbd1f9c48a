/*
  Coverage of the sample box by a table, and the nodes that the table lacks.
*/
#include "build.h"
#include "gather.h"
#include <math.h>
#include <stdlib.h>

/* Number of states in the box; contact tissue has suction as a further dimension. Twice as many with a range of F33. */
enum { BONDED_STATES = 2048, CONTACT_STATES = 4096 };
enum { BETWEEN_LOOKS = 32 }; /* states: a tenth of a millisecond, short for a solve, long for a look at messages */
#define QUANTILE 0.95
#define ENOUGH 0.995

/* The nodes that a grid cell lacks, and the number of states that need them. */
typedef struct {
  PetscInt n, states;
  PetscInt64 keys[LAM_MAX_NEEDS];
} Need;

static int CompareNeeds(const void *a, const void *b)
{
  const Need *x = a, *y = b;

  for (PetscInt i = 0; i < PetscMin(x->n, y->n); i++)
    if (x->keys[i] != y->keys[i]) return x->keys[i] < y->keys[i] ? -1 : 1;
  return (x->n > y->n) - (x->n < y->n);
}

/* Descending by states per lacking node. */
static int CompareDemand(const void *a, const void *b)
{
  const Need *x = a, *y = b;
  const PetscInt64 first = (PetscInt64)x->states * y->n, second = (PetscInt64)y->states * x->n;

  return first != second ? (first > second ? -1 : 1) : CompareNeeds(a, b);
}

/* Merges equal needs, leaving one per cell; returns their number. */
static PetscInt MergeNeeds(PetscInt n, Need needs[])
{
  PetscInt merged = 0;

  if (n) qsort(needs, (size_t)n, sizeof(*needs), CompareNeeds);
  for (PetscInt i = 0; i < n; i++) {
    if (merged && !CompareNeeds(&needs[i], &needs[merged - 1]))
      needs[merged - 1].states++;
    else
      needs[merged++] = needs[i];
  }
  return merged;
}

/* Leaves out nodes of the round under way. */
static void LeaveOut(const LamRound *under_way, Need *need)
{
  PetscInt n = 0;

  if (!under_way) return;
  for (PetscInt i = 0; i < need->n; i++)
    if (LamFindKey(under_way->n, under_way->keys, need->keys[i]) < 0) need->keys[n++] = need->keys[i];
  need->n = n;
}

/* Collects nodes of the cells with the largest demand until there are at least `enough`. */
static PetscErrorCode ChooseNodes(PetscInt n, Need needs[], PetscInt enough, LamCoverage *coverage)
{
  const PetscInt cells = MergeNeeds(n, needs);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)cells * LAM_MAX_NEEDS + 1, &coverage->keys));
  if (cells) qsort(needs, (size_t)cells, sizeof(*needs), CompareDemand);
  for (PetscInt c = 0; c < cells && coverage->lacking < enough; c++) {
    PetscCall(PetscArraycpy(coverage->keys + coverage->lacking, needs[c].keys, needs[c].n));
    coverage->lacking += needs[c].n;
    if (coverage->lacking >= enough || c == cells - 1) /* cells share nodes */
      LamSortUnique(&coverage->lacking, coverage->keys, sizeof(*coverage->keys), LamCompareKeys);
  }
  PetscFunctionReturn(0);
}

/* Queries one state; *error is infinite if the table has no response. */
static PetscErrorCode QueryState(LamTable table, const LamLoad *load, PetscReal accuracy, LamCoverage *coverage,
                                 Need *need, PetscReal *error)
{
  LamResponse response;

  PetscFunctionBeginUser;
  PetscCall(LamTableNeeds(table, load, accuracy, error, &need->n, need->keys));
  if (isfinite(*error) && *error <= accuracy) {
    coverage->covered++;
    PetscFunctionReturn(0);
  }
  if (need->n) PetscFunctionReturn(0);
  if (!coverage->refused++) {
    PetscCall(LamTableQuery(table, load, accuracy, &response));
    PetscCall(PetscStrncpy(coverage->reason, response.reason, sizeof(coverage->reason)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamCoverageCompute(const LamScene *scene, const LamShard *shard, LamDatabase database,
                                  PetscReal accuracy, PetscInt enough, const LamRound *under_way,
                                  LamMeanwhile meanwhile, LamCoverage *coverage)
{
  const PetscBool contact = LamCellsPart(scene->micro.interface);
  const PetscBool axial = (PetscBool)(scene->sample.F33_max > scene->sample.F33_min);
  PetscReal *errors, error, wedge;
  PetscInt *states, n = 0;
  LamTable table;
  Need *needs;

  PetscFunctionBeginUser;
  *coverage = (LamCoverage){0};
  PetscCall(LamShardStates(scene, shard, (contact ? CONTACT_STATES : BONDED_STATES) * (axial ? 2 : 1),
                           &coverage->states, &states));
  PetscCall(LamSampleWedge(&scene->micro, &wedge));
  PetscCall(LamDatabaseGetTable(database, &table));
  PetscCall(PetscMalloc2(coverage->states, &errors, coverage->states, &needs));
  for (PetscInt i = 0; i < coverage->states; i++) {
    LamLoad load;

    if (meanwhile.call && i % BETWEEN_LOOKS == 0) PetscCall(meanwhile.call(meanwhile.ctx));
    LamSampleLoad(scene, wedge, states[i], &load);
    needs[n].n = 0;
    needs[n].states = 1;
    PetscCall(QueryState(table, &load, accuracy, coverage, &needs[n], &error));
    LeaveOut(under_way, &needs[n]);
    if (needs[n].n) n++;
    if (isfinite(error)) errors[coverage->reached++] = error;
  }
  PetscCall(PetscSortReal(coverage->reached, errors));
  coverage->error = coverage->reached ? errors[(PetscInt)(QUANTILE * (PetscReal)(coverage->reached - 1))] : NAN;
  PetscCall(ChooseNodes(n, needs, enough, coverage));
  PetscCall(PetscFree2(errors, needs));
  PetscCall(LamTableDestroy(&table));
  PetscCall(PetscFree(states));
  PetscFunctionReturn(0);
}

PetscBool LamCoverageIsDone(const LamCoverage *coverage)
{
  return (PetscBool)((PetscReal)coverage->covered >= ENOUGH * (PetscReal)(coverage->states - coverage->refused));
}

PetscErrorCode LamCoverageDestroy(LamCoverage *coverage)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(coverage->keys));
  PetscFunctionReturn(0);
}
