/*
  A hash map from places to items, by open addressing with linear probing; at most half full.
*/
#include "table.h"

static size_t Slot(const LamPlaceMap *map, PetscInt64 key)
{
  uint64_t h = (uint64_t)key * 0x9E3779B97F4A7C15u; /* 2^64 over the golden ratio */

  return (size_t)(h >> 20) & (map->size - 1);
}

PetscErrorCode LamPlaceMapCreate(PetscInt n, LamPlaceMap *map)
{
  PetscFunctionBeginUser;
  map->size = 16;
  while (map->size < 2 * (size_t)n) map->size *= 2;
  PetscCall(PetscMalloc1(map->size, &map->keys));
  PetscCall(PetscMalloc1(map->size, &map->items));
  for (size_t k = 0; k < map->size; k++) map->items[k] = -1;
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlaceMapDestroy(LamPlaceMap *map)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(map->keys));
  PetscCall(PetscFree(map->items));
  map->size = 0;
  PetscFunctionReturn(0);
}

PetscInt LamPlaceMapGet(const LamPlaceMap *map, PetscInt64 key)
{
  if (!map->size) return -1;
  for (size_t k = Slot(map, key);; k = (k + 1) & (map->size - 1))
    if (map->items[k] < 0 || map->keys[k] == key) return map->items[k];
}

void LamPlaceMapSet(LamPlaceMap *map, PetscInt64 key, PetscInt item)
{
  size_t k = Slot(map, key);

  while (map->items[k] >= 0) k = (k + 1) & (map->size - 1);
  map->keys[k] = key;
  map->items[k] = item;
}

PetscInt64 LamPlaceMapKey(const int i[3])
{
  PetscInt64 key = 0;

  for (int k = 0; k < 3; k++) key = (key << 15) | (PetscInt64)(i[k] + LAM_GRID_REACH);
  return key;
}
