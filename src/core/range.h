/*
  Ranges of numbers for `info`.
*/
#ifndef LAM_RANGE_H
#define LAM_RANGE_H

#include <jansson.h>
#include <petscsys.h>

typedef struct {
  PetscReal least, most;
} LamRange;

static inline void LamRangeWiden(LamRange *range, PetscReal value)
{
  range->least = PetscMin(range->least, value);
  range->most = PetscMax(range->most, value);
}

/* An empty range, min > max, is null in JSON. */
static inline json_t *LamRangeToJSON(const LamRange *range, PetscReal scale)
{
  return range->least <= range->most ? json_pack("[f, f]", range->least * scale, range->most * scale) : json_null();
}

#endif
