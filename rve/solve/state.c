/*
  States of the RVE: created, copied, packed, kept from a solution.
*/
#include "solve.h"

#define MOST_PARTS 19

/* The data of a state, which are copied or packed one after another. */
typedef struct {
  void *at;
  size_t bytes;
} Part;

/* Those that a state has: bonded tissue has no multipliers. */
static PetscInt FindParts(LamRVEState s, Part parts[MOST_PARTS])
{
  const Part all[MOST_PARTS] = {{s->y, (size_t)s->n * sizeof(*s->y)},
                                {s->lambda, (size_t)s->multipliers * sizeof(*s->lambda)},
                                {s->hats, (size_t)s->faces * sizeof(*s->hats)},
                                {&s->load, sizeof(s->load)},
                                {&s->branch, sizeof(s->branch)},
                                {&s->solved, sizeof(s->solved)},
                                {&s->width, sizeof(s->width)},
                                {s->energy, s->multipliers || s->pairs ? sizeof(s->energy) : 0},
                                {s->history, (size_t)s->points * sizeof(*s->history)},
                                {&s->spent, s->points ? sizeof(s->spent) : 0},
                                {&s->released, s->points ? sizeof(s->released) : 0},
                                {&s->work, s->points || s->pairs ? sizeof(s->work) : 0},
                                {&s->juice, s->points ? sizeof(s->juice) : 0},
                                {&s->spilt, s->cells ? sizeof(s->spilt) : 0},
                                {s->burst, (size_t)s->cells * sizeof(*s->burst)},
                                {s->past, (size_t)s->pairs * sizeof(*s->past)},
                                {&s->ledger, s->pairs ? sizeof(s->ledger) : 0},
                                {&s->given, s->axial ? sizeof(s->given) : 0},
                                {s->z, (size_t)s->axial * sizeof(*s->z)}};
  PetscInt count = 0;

  for (PetscInt k = 0; k < MOST_PARTS; ++k)
    if (all[k].bytes) parts[count++] = all[k];
  return count;
}

PetscErrorCode LamRVEStateSize(LamRVEState state, size_t *bytes)
{
  Part parts[MOST_PARTS];
  const PetscInt count = FindParts(state, parts);

  PetscFunctionBeginUser;
  *bytes = 0;
  for (PetscInt k = 0; k < count; ++k) *bytes += parts[k].bytes;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStatePack(LamRVEState state, void *bytes)
{
  Part parts[MOST_PARTS];
  const PetscInt count = FindParts(state, parts);
  char *to = bytes;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < count; to += parts[k++].bytes) PetscCall(PetscMemcpy(to, parts[k].at, parts[k].bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStateGetSpilt(LamRVEState state, PetscReal *spilt)
{
  PetscFunctionBeginUser;
  *spilt = state->spilt;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStateUnpack(const void *bytes, LamRVEState state)
{
  Part parts[MOST_PARTS];
  const PetscInt count = FindParts(state, parts);
  const char *from = bytes;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < count; from += parts[k++].bytes) PetscCall(PetscMemcpy(parts[k].at, from, parts[k].bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStateCopy(LamRVEState from, LamRVEState to)
{
  Part source[MOST_PARTS], target[MOST_PARTS];
  const PetscInt count = FindParts(from, source);

  PetscFunctionBeginUser;
  PetscCheck(from->n == to->n && from->multipliers == to->multipliers, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
             "states of different RVEs");
  (void)FindParts(to, target);
  for (PetscInt k = 0; k < count; ++k) PetscCall(PetscMemmove(target[k].at, source[k].at, source[k].bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCopyHistory(LamRVEState from, LamRVEState to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->history, from->history, to->points));
  to->spent = from->spent;
  to->released = from->released;
  to->work = from->work;
  to->juice = from->juice;
  to->spilt = from->spilt;
  PetscCall(PetscArraycpy(to->burst, from->burst, to->cells));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCopyMemory(LamRVEState from, LamRVEState to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->past, from->past, to->pairs));
  to->ledger = from->ledger;
  if (to->pairs) to->work = from->work;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStateCreate(LamRVE rve, LamRVEState *state)
{
  PetscFunctionBeginUser;
  PetscCheck(rve->is_set_up, PETSC_COMM_SELF, PETSC_ERR_ORDER, "LamRVESetUp comes before LamRVEStateCreate");
  PetscCall(PetscNew(state));
  (*state)->n = rve->length;
  (*state)->multipliers = rve->contact ? rve->contact->count : 0;
  (*state)->faces = rve->contact ? rve->contact->face_count : 0;
  (*state)->points = rve->layer ? rve->layer->count : 0;
  (*state)->cells = rve->mesh.cuts ? rve->mesh.cell_count : 0;
  (*state)->axial = rve->antiplane ? rve->mesh.class_count : 0;
  (*state)->pairs = LamMemoryPairs(rve);
  PetscCall(PetscMalloc2((*state)->axial, &(*state)->z, (*state)->pairs, &(*state)->past));
  PetscCall(PetscMalloc5((*state)->n, &(*state)->y, (*state)->multipliers, &(*state)->lambda, (*state)->faces,
                         &(*state)->hats, (*state)->points, &(*state)->history, (*state)->cells, &(*state)->burst));
  PetscCall(LamRVEStateReset(rve, *state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStateReset(LamRVE rve, LamRVEState state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(state->y, rve->mesh.class_X, rve->ndof));
  PetscCall(PetscArrayzero(state->y + rve->ndof, rve->linear->lumens));
  PetscCall(PetscArrayzero(state->lambda, state->multipliers));
  for (PetscInt f = 0; f < state->faces; ++f) {
    state->hats[f][0] = rve->contact->faces[f].low;
    state->hats[f][1] = rve->contact->faces[f].high;
  }
  PetscCall(PetscArrayzero(state->z, state->axial));
  state->given = LAM_REFERENCE_LOAD;
  state->load = LAM_REFERENCE_LOAD;
  state->branch = 0;
  state->solved = PETSC_FALSE;
  state->width = 0.0;
  for (PetscInt k = 0; k < LAM_ENERGY_COUNT; ++k) state->energy[k] = NAN;
  for (PetscInt p = 0; p < state->points; ++p) state->history[p] = LAM_UNDAMAGED;
  for (PetscInt c = 0; c < state->cells; ++c) state->burst[c] = PETSC_FALSE;
  state->spent = state->released = state->work = state->juice = state->spilt = 0.0;
  PetscCall(PetscArrayzero(state->past, state->pairs));
  state->ledger = (LamMemoryLedger){0};
  if (!rve->layer && !rve->memory) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < LAM_ENERGY_COUNT; ++k) state->energy[k] = 0.0; /* it is the state at its load */
  LamLumenAreas(rve, state->y, rve->seal.area);
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c)
    state->energy[6] -= LamWholeTurgorFactor(rve, c) * rve->seal.area[c] / rve->mesh.V0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStateDestroy(LamRVEState *state)
{
  PetscFunctionBeginUser;
  if (!*state) PetscFunctionReturn(0);
  PetscCall(PetscFree2((*state)->z, (*state)->past));
  PetscCall(PetscFree5((*state)->y, (*state)->lambda, (*state)->hats, (*state)->history, (*state)->burst));
  PetscCall(PetscFree(*state));
  PetscFunctionReturn(0);
}

void LamKeepState(LamRVE rve, const LamLoad *load, PetscInt branch, LamRVEState state)
{
  for (PetscInt i = 0; i < rve->ndof; ++i) state->y[i] = rve->y[i];
  for (PetscInt c = 0; c < rve->linear->lumens; ++c) state->y[rve->ndof + c] = LamTurgor(rve, load, rve->y, c);
  for (PetscInt h = 0; h < state->multipliers; ++h) state->lambda[h] = rve->contact->lambda[h];
  for (PetscInt f = 0; f < state->faces; ++f) {
    state->hats[f][0] = rve->contact->faces[f].first;
    state->hats[f][1] = rve->contact->faces[f].last;
  }
  state->solved = PETSC_TRUE;
  state->width = rve->contact && !rve->contact->exact ? rve->smooth->width : 0.0;
  LamLayerKeep(rve, load, state);
  LamKeepAxial(rve, state);
  LamMemoryKeep(rve, load, state);
  state->load = state->given = *load;
  state->branch = branch;
}
