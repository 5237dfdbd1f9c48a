/*
  Responders that use a database: alone, or with a solver for states that it lacks.
*/
#ifndef LAMELLA_CACHE_H
#define LAMELLA_CACHE_H

#include <lamella/database.h>
#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Solves a node of the database's grid; the result must not depend on the rank or the time. Stopped:
   LAM_OUT_OF_REACH. */
typedef struct {
  void *ctx;
  PetscErrorCode (*solve)(void *ctx, PetscInt64 key, LamResponse *response);
  /* Solves another state, starting from the solution of the node. NULL: not available. */
  PetscErrorCode (*solve_near)(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response);
} LamNodeSolver;

/*
  database only (solver NULL): a query that the database cannot respond to with the accuracy is LAM_OUT_OF_REACH, with
  the table's reason.

  cache (solver given): the states that the database lacks for the queries of one `respond` are gathered over `comm`,
  solved and added to the database of every rank: nodes of its grid where they help, otherwise the queried states. The
  additions depend only on the queries, not on the number of ranks or their order. Within a load step a material point
  uses one table as long as its accuracy suffices, so that its response does not depend on queries of other points.
  Where no node helps, the point uses the second-order model of a state that was solved for it or for a nearby point,
  also in later load steps, while the error estimate is within the accuracy; the indicators of such responses are
  those of that state, and not trusted.

  outside: LAM_OUTSIDE_STOP: queried states are not solved; where no node helps the response is LAM_OUT_OF_REACH.
  nodes: NULL: `solver` solves them, each from the reference state. accuracy: requested relative error of the stress
  (LamStressError). Borrows database, solver and nodes.
*/
LAM_EXPORT PetscErrorCode LamCacheResponderCreate(MPI_Comm comm, LamDatabase database, LamResponder solver,
                                                  const LamNodeSolver *nodes, LamOutside outside, PetscReal accuracy,
                                                  PetscInt points, LamResponder *responder);

LAM_C_END

#endif
