/*
  The states of a sample box, and its shards.

  Method
    States: a low-discrepancy sequence; state i does not depend on the number of states.
    Shards: recursive coordinate bisection. The states are split along the coordinate of largest range, in proportion
    to the number of shards on either side, until each part is one shard. Shards are boxes because nearby states share
    nodes.
*/
#include "build.h"
#include <lamella/tissue.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Radical inverse: the digits of i in the given base, mirrored at the radix point. */
static PetscReal RadicalInverse(PetscInt64 i, PetscInt64 base)
{
  PetscReal place = 1, sum = 0;

  for (; i; i /= base) {
    place /= (PetscReal)base;
    sum += place * (PetscReal)(i % base);
  }
  return sum;
}

static PetscReal Between(PetscReal min, PetscReal max, PetscReal share)
{
  return min + (max - min) * share;
}

PetscErrorCode LamSampleWedge(const LamMicrostructure *micro, PetscReal *wedge)
{
  LamSymmetry symmetry;

  PetscFunctionBeginUser;
  *wedge = PETSC_PI / 2;
  PetscCall(LamMicrostructureSymmetry(micro, &symmetry));
  if (LamSymmetryIsHexagonal(&symmetry)) *wedge = PETSC_PI / 6;
  PetscFunctionReturn(0);
}

void LamSampleLoad(const LamScene *scene, PetscReal wedge, PetscInt64 index, LamLoad *load)
{
  const LamSample *box = &scene->sample;
  const LamMicrostructure *micro = &scene->micro;
  const PetscReal first = Between(box->stretch_min, box->stretch_max, RadicalInverse(index + 1, 2));
  const PetscReal second = Between(box->stretch_min, box->stretch_max, RadicalInverse(index + 1, 3));
  const PetscReal angle = micro->orientation + wedge * RadicalInverse(index + 1, 5);
  const PetscReal turgor = Between(box->turgor_min, box->turgor_max, RadicalInverse(index + 1, 7));

  *load = LamLoadOfStrains(first, second, angle, turgor, scene->cohesion);
  if (box->F33_max > box->F33_min)
    load->F[8] = PetscExpReal(Between(log(box->F33_min), log(box->F33_max), RadicalInverse(index + 1, 11)));
}

/* ---- shards ---- */

enum { COORDINATES = 5 }; /* U11, U22, U12, turgor, ln F33 */

typedef struct {
  PetscInt number;
  PetscReal at[COORDINATES];
  int along; /* coordinate to compare */
} State;

static int CompareStates(const void *a, const void *b)
{
  const State *x = a, *y = b;
  const PetscReal p = x->at[x->along], q = y->at[y->along];

  if (p != q) return p > q ? 1 : -1;
  return (x->number > y->number) - (x->number < y->number);
}

static PetscReal Spread(PetscInt n, const State states[], int along)
{
  PetscReal least = states[0].at[along], most = least;

  for (PetscInt i = 1; i < n; i++) {
    least = PetscMin(least, states[i].at[along]);
    most = PetscMax(most, states[i].at[along]);
  }
  return most - least;
}

/* Reduces states[0 .. *n - 1] to those of the shard. */
static void Cut(LamShard shard, PetscInt *n, State states[])
{
  while (shard.count > 1 && *n > 1) {
    const PetscInt parts = shard.count / 2, low = (PetscInt)((PetscInt64)*n * parts / shard.count);
    int along = 0;

    for (int c = 1; c < COORDINATES; c++)
      if (Spread(*n, states, c) > Spread(*n, states, along)) along = c;
    for (PetscInt i = 0; i < *n; i++) states[i].along = along;
    qsort(states, (size_t)*n, sizeof(*states), CompareStates);
    if (shard.index <= parts) {
      shard.count = parts;
      *n = low;
      continue;
    }
    shard = (LamShard){shard.index - parts, shard.count - parts};
    *n -= low;
    for (PetscInt i = 0; i < *n; i++) states[i] = states[i + low];
  }
}

static int CompareNumbers(const void *a, const void *b)
{
  const PetscInt x = *(const PetscInt *)a, y = *(const PetscInt *)b;

  return (x > y) - (x < y);
}

/* Turgor is scaled so that its range equals the strain range of the box. */
static State StateOf(const LamScene *scene, PetscReal wedge, PetscInt number)
{
  const LamSample *box = &scene->sample;
  const PetscReal range = box->turgor_max - box->turgor_min, strain = box->stretch_max - box->stretch_min;
  LamLoad load;

  LamSampleLoad(scene, wedge, number, &load);
  return (State){number,
                 {load.F[0], load.F[4], load.F[1], range > 0 ? strain * (load.turgor - box->turgor_min) / range : 0,
                  log(load.F[8])},
                 0};
}

PetscErrorCode LamShardStates(const LamScene *scene, const LamShard *shard, PetscInt asked, PetscInt *n,
                              PetscInt **states)
{
  PetscReal wedge;
  State *all;

  PetscFunctionBeginUser;
  PetscCall(LamSampleWedge(&scene->micro, &wedge));
  PetscCall(PetscMalloc1(asked, &all));
  for (PetscInt i = 0; i < asked; i++) all[i] = StateOf(scene, wedge, i);
  *n = asked;
  Cut(*shard, n, all);
  PetscCall(PetscMalloc1(*n, states));
  for (PetscInt i = 0; i < *n; i++) (*states)[i] = all[i].number;
  qsort(*states, (size_t)*n, sizeof(**states), CompareNumbers); /* order of the sequence */
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscBool LamShardParse(const char text[], LamShard *shard)
{
  char rest;
  int index, count;

  if (sscanf(text, "%d/%d%c", &index, &count, &rest) != 2 || index < 1 || index > count) return PETSC_FALSE;
  *shard = (LamShard){index, count};
  return PETSC_TRUE;
}
