/*
  Hash map from places to items: open addressing, linear probing, at most half full.
*/
#include "table.h"

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

void LamPlaceMapSet(LamPlaceMap *map, PetscInt64 key, PetscInt item)
{
  size_t k = LamPlaceMapSlot(map, key);

  while (map->items[k] >= 0) k = (k + 1) & (map->size - 1);
  map->keys[k] = key;
  map->items[k] = item;
}
