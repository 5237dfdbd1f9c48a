/*
  Private to the cache: responses from the second-order model of one record outside the grid.
*/
#ifndef LAM_SCATTER_MODEL_H
#define LAM_SCATTER_MODEL_H

#include <lamella/database.h>

/* A record and its image under the symmetry of the lattice. */
typedef struct {
  PetscInt state, image; /* state -1: none */
} LamScatterModel;

/*
  Finds the model of the nearest stable record of any branch. None where cells float in it, or where a record without
  a model is at most twice as far away.
*/
void LamScatterModelFind(LamDatabase database, const LamLoad *load, LamScatterModel *model);
/* The load of a model's record; LamScatterModelFind at this load finds the model again. */
LamLoad LamScatterModelLoad(LamDatabase database, const LamScatterModel *model);
/* Evaluates a model (not none). LAM_OUT_OF_REACH where its error estimate exceeds the accuracy. */
PetscErrorCode LamScatterModelQuery(LamDatabase database, const LamScatterModel *model, const LamLoad *load,
                                    PetscReal accuracy, LamResponse *response);

#endif
