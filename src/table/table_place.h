/*
  Private to the table: the position of a query in it.
*/
#ifndef LAM_TABLE_PLACE_H
#define LAM_TABLE_PLACE_H

#include "table.h"

/* The position of a query in the table, and the table's data there. */
typedef struct {
  LamLatticeState lattice;
  LamTablePoint point;
  PetscReal free_strain[6]; /* LamGridFreeStrain */
  PetscReal F33;
  PetscBool floating;
  const LamTableCell *leaf; /* finest complete cell; NULL: none */
  PetscBool good;           /* all its states are good */
  LamTableSum sum;
  PetscReal leaf_gradient[3]; /* of the sum up to the leaf */
  const LamTableCell *child;  /* cell of the next finer level, incomplete; NULL: none */
  LamTableCell cells[LAM_FINEST + 1];
} LamTablePlace;

/* ---- table_potential.c ---- */
/* All of the response that follows from the potential: energy, P, tangent and their derivatives in p and g. */
void LamTableFillPotential(LamTable table, const LamTablePlace *place, LamResponse *r);

#endif
