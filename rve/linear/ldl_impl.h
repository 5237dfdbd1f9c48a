/*
  The inside of LamLDL: ldl_pattern.c makes what depends on the pattern alone, ldl.c the numbers.
*/
#ifndef LAM_LDL_IMPL_H
#define LAM_LDL_IMPL_H

#include "ldl.h"

typedef double LamFour __attribute__((vector_size(32))); /* a 2 x 2 block by columns; right-hand sides */

/* An unknown that comes last. */
typedef struct {
  PetscInt size;        /* positions that it is coupled with */
  PetscInt *at, *entry; /* [size] which they are, indices into values; owned */
  PetscReal *v;         /* [size] column of V; zero if it is not a constraint at present; owned */
  PetscInt *pairs;      /* [size][size] index into the entries of factor of a pair of them; owned unless it ... */
  PetscBool shares;     /* ... is that of the unknown before, which has the same positions */
} LamConstraint;

/* The columns of a panel that change one or both columns of a later one: rows from the first of these on. */
typedef enum { LAM_TO_FIRST, LAM_TO_SECOND, LAM_TO_BOTH } LamTarget;
typedef struct {
  PetscInt column, width; /* first column, and their number */
  PetscInt skip, count;   /* rows below the panel that come before; rows from there on */
  PetscInt target;        /* index of the first of their targets */
  LamTarget to;
} LamSource;

struct LamLDL_s {
  PetscInt n, blocks, panels, nonzeros;
  PetscInt positions;
  const PetscInt *row; /* borrowed, as `values` is */
  const PetscReal *values;
  PetscReal rho;             /* of the present factor */
  LamConstraint *constraint; /* [n - positions] */
  PetscInt *place;           /* [blocks] column of the factor of a block of unknowns */
  PetscInt *to;              /* [nonzeros] index into the entries of factor */
  PetscInt *start;           /* [blocks+1] first block of a column; the one on the diagonal comes first */
  PetscInt *index;           /* [start[blocks]] its rows, increasing */
  PetscInt *panel;           /* [panels+1] first column of a panel: one, or two with the same rows below */
  PetscInt *first;           /* [panels+1] first source of a panel */
  LamSource *source;         /* [first[panels]] */
  unsigned short *target;    /* places of the rows of sources in the (first) column that they change; 0, 1, 2, ... come
                                first, and sources share what they can */
  LamFour *memory;           /* of the following, which start at a multiple of their size */
  LamFour *factor;           /* [start[blocks]] L, on the diagonal D: d0, d0, d1, d1 */
  LamFour *inverse;          /* [blocks] 1/d0, l, 1/d1 */
  LamFour *work;             /* [2 blocks] */
};

#endif
