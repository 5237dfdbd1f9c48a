/*
  Packed states: the data copied by LamRVEStateCopy, one after another.
*/
#include "solve.h"
#include <string.h>

/* Writes `bytes` at *at, or only counts if `to` is NULL; advances *at. */
static void Put(const void *from, size_t bytes, char *to, size_t *at)
{
  if (to && bytes) memcpy(to + *at, from, bytes);
  *at += bytes;
}

static void Get(const char *from, size_t *at, void *to, size_t bytes)
{
  if (bytes) memcpy(to, from + *at, bytes);
  *at += bytes;
}

static void PutState(LamRVEState s, char *to, size_t *at)
{
  Put(s->y, (size_t)s->n * sizeof(*s->y), to, at);
  Put(s->lambda, (size_t)s->multipliers * sizeof(*s->lambda), to, at);
  Put(s->hats, (size_t)s->faces * sizeof(*s->hats), to, at);
  Put(&s->load, sizeof(s->load), to, at);
  Put(&s->branch, sizeof(s->branch), to, at);
  Put(&s->solved, sizeof(s->solved), to, at);
  if (s->bonded) PutState(s->bonded, to, at);
}

static void GetState(const char *from, size_t *at, LamRVEState s)
{
  Get(from, at, s->y, (size_t)s->n * sizeof(*s->y));
  Get(from, at, s->lambda, (size_t)s->multipliers * sizeof(*s->lambda));
  Get(from, at, s->hats, (size_t)s->faces * sizeof(*s->hats));
  Get(from, at, &s->load, sizeof(s->load));
  Get(from, at, &s->branch, sizeof(s->branch));
  Get(from, at, &s->solved, sizeof(s->solved));
  if (s->bonded) GetState(from, at, s->bonded);
}

PetscErrorCode LamRVEStateSize(LamRVEState state, size_t *bytes)
{
  PetscFunctionBeginUser;
  *bytes = 0;
  PutState(state, NULL, bytes);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStatePack(LamRVEState state, void *bytes)
{
  size_t at = 0;

  PetscFunctionBeginUser;
  PutState(state, bytes, &at);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEStateUnpack(const void *bytes, LamRVEState state)
{
  size_t at = 0;

  PetscFunctionBeginUser;
  GetState(bytes, &at, state);
  PetscFunctionReturn(0);
}
