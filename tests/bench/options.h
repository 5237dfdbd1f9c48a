/* Options of bench programs, as in --states 30. They are PETSc's, which is initialised before. */
#ifndef LAM_BENCH_OPTIONS_H
#define LAM_BENCH_OPTIONS_H

#include <petscsys.h>
#include <stdio.h>
#include <stdlib.h>

/* The number behind an option, or `usual`. Ends the program where it is not within the limits. */
static inline int NumberOption(const char name[], PetscInt usual, PetscInt least, PetscInt most)
{
  PetscInt n = usual;

  PetscCallAbort(PETSC_COMM_SELF, PetscOptionsGetInt(NULL, NULL, name, &n, NULL));
  if (n >= least && n <= most) return (int)n;
  fprintf(stderr, "%s %d: must be from %d to %d\n", name, (int)n, (int)least, (int)most);
  exit(1);
}

/* The place in `names`, of which there are n, of the word behind an option; n without the option. */
static inline int ChoiceOption(const char name[], const char *const names[], int n)
{
  PetscInt choice = n;
  PetscBool has;

  PetscCallAbort(PETSC_COMM_SELF, PetscOptionsGetEList(NULL, NULL, name, names, n, &choice, &has));
  return (int)choice;
}

static inline PetscBool HasOption(const char name[])
{
  PetscBool has;

  PetscCallAbort(PETSC_COMM_SELF, PetscOptionsHasName(NULL, NULL, name, &has));
  return has;
}

/* PetscFinalize, before which options that the program does not have are named. The status of main. */
static inline int EndBench(void)
{
  return PetscOptionsLeft(NULL) || PetscFinalize() ? 1 : 0;
}

#endif
