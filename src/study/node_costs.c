#include "node_costs.h"
#include <math.h>

enum { LATEST = 1024, NEAREST = 4 };
#define UNKNOWN_COST 10.0 /* factorisations, before any node is known */

typedef struct {
  PetscReal place[4];
  PetscReal log_cost;
} Learnt;

struct LamNodeCosts_s {
  LamGrid grid; /* borrowed */
  PetscInt n;   /* recorded so far; the latest are kept */
  Learnt learnt[LATEST];
};

PetscErrorCode LamNodeCostsCreate(LamGrid grid, LamNodeCosts *costs)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(costs));
  (*costs)->grid = grid;
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeCostsDestroy(LamNodeCosts *costs)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*costs));
  PetscFunctionReturn(0);
}

PetscErrorCode LamNodeCostsLearn(LamNodeCosts costs, PetscInt64 key, const LamResponse *response)
{
  Learnt *l = &costs->learnt[costs->n++ % LATEST];

  PetscFunctionBeginUser;
  LamGridNodePlace(costs->grid, key, l->place);
  l->log_cost = log(PetscMax(1, (PetscReal)response->factorisations));
  PetscFunctionReturn(0);
}

static PetscReal SquaredDistance(const PetscReal a[4], const PetscReal b[4])
{
  PetscReal sum = 0;

  for (int k = 0; k < 4; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/* Keeps the nearest nodes, sorted by distance. */
static void Insert(PetscReal distance, PetscReal log_cost, PetscInt *n, PetscReal nearest[NEAREST][2])
{
  PetscInt i = *n < NEAREST ? (*n)++ : NEAREST - 1;

  if (i == NEAREST - 1 && *n == NEAREST && nearest[i][0] <= distance) return;
  for (; i > 0 && nearest[i - 1][0] > distance; i--) {
    nearest[i][0] = nearest[i - 1][0];
    nearest[i][1] = nearest[i - 1][1];
  }
  nearest[i][0] = distance;
  nearest[i][1] = log_cost;
}

PetscReal LamNodeCostsPredict(LamNodeCosts costs, PetscInt64 key)
{
  PetscReal place[4], nearest[NEAREST][2], sum = 0;
  PetscInt n = 0;

  if (!costs->n) return UNKNOWN_COST;
  LamGridNodePlace(costs->grid, key, place);
  for (PetscInt i = 0; i < NEAREST; i++) nearest[i][0] = PETSC_INFINITY;
  for (PetscInt i = 0; i < PetscMin(costs->n, LATEST); i++)
    Insert(SquaredDistance(place, costs->learnt[i].place), costs->learnt[i].log_cost, &n, nearest);
  for (PetscInt i = 0; i < n; i++) sum += nearest[i][1];
  return exp(sum / (PetscReal)n);
}
