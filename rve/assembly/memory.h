/*
  Walls with memory in the RVE (wall_memory.h): in a step they are elastic with a history that is constant.

  LamMemoryTake sets the step up from the state at its start, LamMemoryKeep finds the past of the next one. An instant
  later, duration 0, the stresses of a state are those that it has.
*/
#ifndef LAM_RVE_MEMORY_H
#define LAM_RVE_MEMORY_H

#include "wall_memory.h"

/* Energies per V0 since the undeformed tissue. */
typedef struct {
  PetscReal elastic;    /* W of the walls as if they had no memory, */
  PetscReal retarded;   /* less what relaxation has saved of their work: the sum is stored or dissipated; <= 0 */
  PetscReal dissipated; /* by dashpots */
  PetscReal step;       /* energy of the walls in the potential of the step that led here */
} LamMemoryLedger;

typedef struct {
  LamMemoryStep step;
  LamWall *wall;                               /* [cell] moduli times step.scale, but for U */
  LamPoints (*history)[LAM_MEMORY_COMPONENTS]; /* [element] */
  LamMemoryPair *past;                         /* [element][1 + terms] at the start of the step, ... */
  LamMemoryLedger ledger;                      /* ... and there */
  PetscReal work;                              /* likewise, as in the state */
} LamMemory;

#endif
