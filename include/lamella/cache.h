/*
  Responders that answer from a database: alone, or with a solver for what it lacks.
*/
#ifndef LAMELLA_CACHE_H
#define LAMELLA_CACHE_H

#include <lamella/database.h>
#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Solves a node of the database's grid: the same response whoever solves it, and when. Stopped: LAM_OUT_OF_REACH. */
typedef struct {
  void *ctx;
  PetscErrorCode (*solve)(void *ctx, PetscInt64 key, LamResponse *response);
  /* Solves another state, from the solution of the node. NULL: cannot. */
  PetscErrorCode (*solve_near)(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response);
} LamNodeSolver;

/*
  database only (solver NULL): a question that the database cannot answer to the accuracy is LAM_OUT_OF_REACH, with the
  table's reason.
  cache (solver given): what the database lacks for the questions of one `respond` is gathered over `comm`, solved and
  added to the database of every rank: nodes of its grid where they help, else the states asked for. What is added
  depends on the questions alone, neither on the number of ranks nor on their order.
  Within a load step a material point is answered from one table as long as that reaches: an answer does not change
  because other points ask. Where no node helps it holds the second-order model of a state that was solved for it or for
  a point near by, which goes on to answer, also in later load steps, while the estimate of its error is within the
  accuracy; of such answers indicators are those of that state, and not trusted.
  outside: LAM_OUTSIDE_STOP: no state is solved for itself; where no node helps the answer is LAM_OUT_OF_REACH.
  nodes: NULL: `solver` solves them, each from the reference state. accuracy: wanted relative error of the stress
  (LamStressError). Borrows database, solver and nodes.
*/
LAM_EXPORT PetscErrorCode LamCacheResponderCreate(MPI_Comm comm, LamDatabase database, LamResponder *solver,
                                                  const LamNodeSolver *nodes, LamOutside outside, PetscReal accuracy,
                                                  PetscInt points, LamResponder *responder);

LAM_C_END

#endif
