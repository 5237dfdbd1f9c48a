/*
  Responders that answer from a database: alone, or with a solver for what it lacks.
*/
#ifndef LAMELLA_CACHE_H
#define LAMELLA_CACHE_H

#include <lamella/database.h>
#include <lamella/response.h>

/*
  database only (solver NULL): a question out of reach is answered with LAM_OUT_OF_REACH.
  cache (solver given): misses of one `respond` are gathered over `comm`, put in an order that does not depend on the
  ranks, thinned (a question within the trust radius of a chosen one waits for its answer), solved, added to the
  database of every rank, then answered. Within a load step a material point keeps the record it was answered from
  while that is in reach, so the answers are smooth.
  accuracy: wanted relative error of the stress; it sets the trust radius. Borrows database and solver.
*/
PetscErrorCode LamCacheResponderCreate(MPI_Comm comm, LamDatabase database, LamResponder *solver, PetscReal accuracy,
                                       PetscInt points, LamResponder *responder);

#endif
