/*
  Private to the cache: answers from the second-order model of one record that belongs to no grid.
*/
#ifndef LAM_SCATTER_MODEL_H
#define LAM_SCATTER_MODEL_H

#include <lamella/database.h>

/* A record and its image under the symmetry of the lattice. */
typedef struct {
  PetscInt state, image; /* state -1: none */
} LamScatterModel;

/*
  That of the nearest stable record, of whatever branch; none where cells float in it, or where a record that cannot
  answer is less than twice as far.
*/
void LamScatterModelFind(LamDatabase database, const LamLoad *load, LamScatterModel *model);
/* The load of a model's record, from which it is found again. */
LamLoad LamScatterModelLoad(LamDatabase database, const LamScatterModel *model);
/* Of a model that is not none. Out of reach where the estimate of its error is above the accuracy. */
PetscErrorCode LamScatterModelQuery(LamDatabase database, const LamScatterModel *model, const LamLoad *load,
                                    PetscReal accuracy, LamResponse *response);

#endif
