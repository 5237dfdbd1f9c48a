/*
  Node data from responses and from the bytes of files.
*/
#include "node_data.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

/* The entries of a response's member that a node keeps. */
typedef struct {
  size_t member; /* offset in LamResponse */
  PetscInt count;
  PetscInt number[21];
} Row;

#define IN_PLANE 0, 1, 3, 4
#define ONE_REAL(name)                                                                                                 \
  offsetof(LamResponse, name), 1,                                                                                      \
  {                                                                                                                    \
    0                                                                                                                  \
  }
#define IN_PLANE_AND_33(name)                                                                                          \
  offsetof(LamResponse, name), 5,                                                                                      \
  {                                                                                                                    \
    IN_PLANE, 8                                                                                                        \
  }

/* In the order of LamNodeData. */
static const Row reals[] = {
    {offsetof(LamResponse, load.F), 4, {IN_PLANE}},
    {ONE_REAL(load.turgor)},
    {ONE_REAL(load.cohesion)},
    {ONE_REAL(energy)},
    {IN_PLANE_AND_33(P)},
    {offsetof(LamResponse, tangent),
     21,
     {IN_PLANE, 9, 10, 12, 13, 27, 28, 30, 31, 36, 37, 39, 40, 72, 73, 75, 76, 80}}, /* 27 i + 9 j + 3 k + l */
    {IN_PLANE_AND_33(P_turgor)},
    {ONE_REAL(energy_turgor)},
    {ONE_REAL(energy_turgor2)},
    {IN_PLANE_AND_33(P_cohesion)},
    {ONE_REAL(energy_cohesion)},
    {ONE_REAL(energy_cohesion2)},
    {ONE_REAL(energy_turgor_cohesion)},
};

#define ONE_INDICATOR(name, rule) {offsetof(LamResponse, name), 1, {0}},
#define THREE_INDICATORS(name, rule) {offsetof(LamResponse, name), 3, {0, 1, 2}},
static const Row indicators[] = {LAM_NODE_INDICATORS(ONE_INDICATOR, THREE_INDICATORS)};

/* Of each count: offset in LamResponse, offset in LamNodeData. */
#define COUNT(name) {offsetof(LamResponse, name), offsetof(LamNodeData, name)},
static const size_t counts[][2] = {LAM_NODE_COUNTS(COUNT)};
_Static_assert(PETSC_STATIC_ARRAY_LENGTH(counts) == LAM_NODE_INTS, "counts of a node");

#define FIRST_REAL offsetof(LamNodeData, F)
#define FIRST_INDICATOR offsetof(LamNodeData, lumen_fraction)
_Static_assert(offsetof(LamNodeData, lumen_fraction) - FIRST_REAL == LAM_NODE_REALS * sizeof(PetscReal),
               "reals of a node are contiguous");
_Static_assert(offsetof(LamNodeData, kinked_fraction) + sizeof(float) - FIRST_INDICATOR ==
                   LAM_NODE_FLOATS * sizeof(float),
               "indicators of a node are contiguous");

static PetscReal *Reals(LamNodeData *node)
{
  return (PetscReal *)((char *)node + FIRST_REAL);
}

static float *Indicators(LamNodeData *node)
{
  return (float *)((char *)node + FIRST_INDICATOR);
}

/* ---- from a response ---- */

void LamNodeDataFromResponse(const LamResponse *response, PetscInt64 key, LamNodeData *node)
{
  PetscReal *real = Reals(node);
  float *indicator = Indicators(node);

  node->key = key;
  node->status = response->status;
  node->stable = response->stable;
  for (int k = 0; k < LAM_NODE_INTS; k++)
    *(PetscInt *)((char *)node + counts[k][1]) = *(const PetscInt *)((const char *)response + counts[k][0]);
  for (size_t r = 0; r < PETSC_STATIC_ARRAY_LENGTH(reals); r++)
    for (PetscInt k = 0; k < reals[r].count; k++)
      *real++ = ((const PetscReal *)((const char *)response + reals[r].member))[reals[r].number[k]];
  for (size_t r = 0; r < PETSC_STATIC_ARRAY_LENGTH(indicators); r++)
    for (PetscInt k = 0; k < indicators[r].count; k++)
      *indicator++ = (float)((const PetscReal *)((const char *)response + indicators[r].member))[k];
}

/* ---- from bytes ---- */

/* Byte offsets of the rows' numbers in a record. */
static void Places(const size_t member[], size_t count, const Row rows[], size_t place[])
{
  for (size_t r = 0; r < count; r++) {
    const size_t place_of_row = member[LamResponseMemberIndex(rows[r].member)];

    for (PetscInt k = 0; k < rows[r].count; k++)
      *place++ = place_of_row == LAM_NOT_IN_FILE ? LAM_NOT_IN_FILE
                                                 : place_of_row + (size_t)rows[r].number[k] * sizeof(PetscReal);
  }
}

#define MEMBER(name) LamResponseMemberIndex(offsetof(LamResponse, name))

void LamNodeLayoutMake(size_t key, const size_t member[], LamNodeLayout *layout)
{
  Places(member, PETSC_STATIC_ARRAY_LENGTH(reals), reals, layout->real);
  Places(member, PETSC_STATIC_ARRAY_LENGTH(indicators), indicators, layout->indicator);
  layout->key = key;
  layout->status = member[MEMBER(status)];
  layout->stable = member[MEMBER(stable)];
  for (int k = 0; k < LAM_NODE_INTS; k++) layout->count[k] = member[LamResponseMemberIndex(counts[k][0])];
}

static inline PetscReal Real(const unsigned char *bytes, size_t place)
{
  PetscReal value;

  if (place == LAM_NOT_IN_FILE) return NAN;
  memcpy(&value, bytes + place, sizeof(value));
  return value;
}

static inline PetscInt64 Integer(const unsigned char *bytes)
{
  PetscInt64 value;

  memcpy(&value, bytes, sizeof(value));
  return value;
}

static inline PetscInt Count(const unsigned char *bytes, size_t place)
{
  return place == LAM_NOT_IN_FILE ? LAM_UNKNOWN_COUNT : (PetscInt)Integer(bytes + place);
}

void LamNodeDataFromBytes(const LamNodeLayout *layout, const unsigned char *bytes, LamNodeData *node)
{
  PetscReal *real = Reals(node);
  float *indicator = Indicators(node);

  node->key = Integer(bytes + layout->key);
  node->status = (LamStatus)bytes[layout->status];
  node->stable = (PetscBool)bytes[layout->stable];
  for (int k = 0; k < LAM_NODE_INTS; k++) *(PetscInt *)((char *)node + counts[k][1]) = Count(bytes, layout->count[k]);
  for (int k = 0; k < LAM_NODE_REALS; k++) real[k] = Real(bytes, layout->real[k]);
  for (int k = 0; k < LAM_NODE_FLOATS; k++) indicator[k] = (float)Real(bytes, layout->indicator[k]);
  /* as LamRecordUnpack does; the fractions are the first two indicators */
  if (isnan(node->energy_turgor)) node->energy_turgor = -Real(bytes, layout->indicator[0]);
  if (isnan(node->energy_cohesion)) node->energy_cohesion = Real(bytes, layout->indicator[1]);
}
