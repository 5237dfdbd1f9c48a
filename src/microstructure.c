/*
  The canonical description of a microstructure: nondimensional, without what has no effect, 12 digits, so that two
  scenes in different units that mean the same tissue have the same text, and the same hash.
*/
#include "record_internal.h"
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define DESCRIPTION_LENGTH 1024

/* 64-bit FNV-1a (Fowler, Noll, Vo): a name, not a protection. */
static uint64_t Hash(const char text[])
{
  uint64_t hash = 0xcbf29ce484222325u;

  for (; *text; text++) hash = (hash ^ (unsigned char)*text) * 0x100000001b3u;
  return hash;
}

/* Rounding errors of unit conversion are some 1e-16, also of a zero. */
static double Clean(PetscReal value)
{
  return fabs(value) < 1e-13 ? 0.0 : (double)value;
}

/*
  The wall's part. Fibres have no effect in a law without them.
*/
static int DescribeWall(const LamWall *wall, size_t size, char text[])
{
  int n = snprintf(text, size, "\"wall\": {\"law\": \"%s\", \"C1\": %.12g, \"C2\": %.12g, ", LamWallLawNames[wall->law],
                   Clean(wall->C1), Clean(wall->C2));

  if (wall->law == LAM_WALL_FIBRE_MOONEY_RIVLIN)
    n += snprintf(text + n, size - (size_t)n, "\"C4\": %.12g, \"fibres\": \"%s\", ", Clean(wall->C4),
                  LamFibresNames[wall->fibres]);
  n += snprintf(text + n, size - (size_t)n, "\"bulk_modulus\": %.12g}", Clean(wall->bulk_modulus));
  return n;
}

PetscErrorCode LamMicrostructureDescribe(const LamMicrostructure *micro, char **json, char hash[LAM_HASH_LENGTH])
{
  char text[DESCRIPTION_LENGTH];
  int n;

  PetscFunctionBeginUser;
  n = snprintf(text, sizeof(text),
               "{\"wall_thickness\": %.12g, \"orientation\": %.12g, \"cells\": [%d, %d], \"mesh\": {\"along\": %d, "
               "\"through\": %d}, ",
               Clean(micro->wall_thickness), Clean(micro->orientation), (int)micro->cells[0], (int)micro->cells[1],
               (int)micro->along, (int)micro->through);
  n += DescribeWall(&micro->wall, sizeof(text) - (size_t)n, text + n);
  n += snprintf(text + n, sizeof(text) - (size_t)n, ", \"interface\": {\"law\": \"%s\"",
                LamInterfaceLawNames[micro->interface]);
  if (micro->interface == LAM_INTERFACE_CONTACT)
    n += snprintf(text + n, sizeof(text) - (size_t)n, ", \"clearance\": %.12g", Clean(micro->clearance));
  snprintf(text + n, sizeof(text) - (size_t)n, "}}");
  snprintf(hash, LAM_HASH_LENGTH, "%016llx", (unsigned long long)Hash(text));
  PetscCall(PetscStrallocpy(text, json));
  PetscFunctionReturn(0);
}

/* Index of `text` in a list of names; -1 where it is not there. */
static int Find(int count, const char *const names[], const char text[])
{
  for (int i = 0; i < count; i++)
    if (!strcmp(names[i], text)) return i;
  return -1;
}

static PetscBool ParseObject(json_t *root, LamMicrostructure *m)
{
  const char *law, *interface, *fibres = LamFibresNames[LAM_FIBRES_BOTH];
  int cells[2], along, through, found[3];

  if (json_unpack(root, "{s:F, s:F, s:[i,i], s:{s:i, s:i}, s:{s:s, s:F, s:F, s?F, s?s, s:F}, s:{s:s, s?F}}",
                  "wall_thickness", &m->wall_thickness, "orientation", &m->orientation, "cells", &cells[0], &cells[1],
                  "mesh", "along", &along, "through", &through, "wall", "law", &law, "C1", &m->wall.C1, "C2",
                  &m->wall.C2, "C4", &m->wall.C4, "fibres", &fibres, "bulk_modulus", &m->wall.bulk_modulus, "interface",
                  "law", &interface, "clearance", &m->clearance))
    return PETSC_FALSE;
  found[0] = Find(LAM_WALL_LAW_COUNT, LamWallLawNames, law);
  found[1] = Find(LAM_FIBRES_COUNT, LamFibresNames, fibres);
  found[2] = Find(LAM_INTERFACE_LAW_COUNT, LamInterfaceLawNames, interface);
  if (found[0] < 0 || found[1] < 0 || found[2] < 0) return PETSC_FALSE;
  m->wall.law = (LamWallLawType)found[0];
  m->wall.fibres = (LamFibres)found[1];
  m->interface = (LamInterfaceLawType)found[2];
  for (int i = 0; i < 2; i++) m->cells[i] = cells[i];
  m->along = along;
  m->through = through;
  return PETSC_TRUE;
}

PetscErrorCode LamMicrostructureParse(const char path[], const char json[], LamMicrostructure *micro)
{
  json_t *root = json_loads(json, 0, NULL);
  PetscBool good;

  PetscFunctionBeginUser;
  memset(micro, 0, sizeof(*micro));
  good = (PetscBool)(root && ParseObject(root, micro));
  json_decref(root);
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the description of the microstructure is damaged: %s",
             path, json);
  PetscFunctionReturn(0);
}
