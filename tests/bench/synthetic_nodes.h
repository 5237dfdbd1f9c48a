/* What bench programs on record files share: nodes with made-up numbers, and the memory of the process. */
#ifndef LAM_BENCH_SYNTHETIC_NODES_H
#define LAM_BENCH_SYNTHETIC_NODES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "measure.h"
#include "grid.h"

static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                                 "  mesh: {along: 6, through: 2}\n"
                                 "  turgor: {mode: prescribed, pressure: 0.02 MPa}\n";

/* A line of /proc/self/status in MB: VmRSS, the memory held now; VmHWM, the most so far. */
static inline double Memory(const char name[])
{
  FILE *file = fopen("/proc/self/status", "r");
  char line[256];
  double MB = 0;

  while (file && fgets(line, sizeof(line), file))
    if (!strncmp(line, name, strlen(name))) MB = atof(line + strlen(name) + 1) * 1024 / 1e6;
  if (file) fclose(file);
  return MB;
}

/* Every number differs, as in a file of solves. */
static inline PetscErrorCode Synthetic(LamGrid grid, PetscInt64 key, PetscInt64 number, LamResponse *response)
{
  PetscReal next = 0.1 + 1e-6 * (double)number;
  LamLoad load;

  PetscFunctionBeginUser;
  PetscCall(LamGridNodeLoad(grid, key, &load));
  PetscCall(LamResponseInit(&load, response));
  for (const LamMember *m = LamResponseMembers; m->name; m++)
    for (PetscInt i = 0; m->type == LAM_MEMBER_REAL && i < m->count; i++)
      ((PetscReal *)((char *)response + m->offset))[i] = next += 1e-3;
  response->load = load;
  response->status = LAM_CONVERGED;
  response->stable = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* A new file with the grid in it. */
static inline PetscErrorCode OpenNodes(const char path[], const LamScene *scene, LamGrid grid, LamRecordWriter *writer)
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamGridGetText(grid, &text));
  PetscCall(LamRecordWriterOpen(path, "database", LAM_WRITE_CREATE, scene, writer));
  PetscCall(LamRecordWriterText(*writer, LAM_GRID_NAME, text));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

#endif
