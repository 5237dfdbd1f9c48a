/*
  What answers the material points of a macroscale run: RVE solves, a database, or both.
*/
#include "fe2_run.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "interruptible.h"
#include "shared_grid.h"

const char *const LamFE2ResponseNames[] = {"direct", "cache", "database"};

PetscBool LamFE2ChooseResponse(LamFE2Run *run)
{
  run->response = run->database_path ? LAM_FE2_CACHE : LAM_FE2_DIRECT;
  for (int k = 0; k < 3 && run->response_name; k++) {
    if (strcmp(run->response_name, LamFE2ResponseNames[k])) continue;
    run->response = (LamFE2Response)k;
    run->response_name = NULL;
  }
  if (run->response_name)
    fprintf(stderr, "lamella fe2: --response %s: unknown; there are direct, cache, database\n", run->response_name);
  else if (run->response == LAM_FE2_DATABASE && !run->database_path)
    fprintf(stderr, "lamella fe2: --response database needs a database; give -d DB.h5\n");
  else if (run->response == LAM_FE2_DIRECT && run->database_path)
    fprintf(stderr, "lamella fe2: --response direct uses no database; leave out -d, or choose cache or database\n");
  else
    return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Loads the database, on all ranks; the mesh of the RVE, where the scene leaves it open, is the database's. */
static PetscErrorCode OpenDatabase(LamFE2Run *run)
{
  LamMicrostructure *micro = &run->scene->micro, stored;
  int exists = run->database_path && !access(run->database_path, F_OK);

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&exists, 1, MPI_INT, 0, run->comm));
  if (!exists && run->response != LAM_FE2_DATABASE) PetscFunctionReturn(0);
  PetscCall(LamDatabaseOpen(run->database_path, &run->database));
  PetscCall(LamDatabaseGetMicrostructure(run->database, &stored, NULL, NULL));
  if (!micro->along) micro->along = stored.along;
  if (!micro->through) micro->through = stored.through;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckDatabase(LamFE2Run *run)
{
  char *json, wanted[LAM_HASH_LENGTH];
  const char *hash;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetMicrostructure(run->database, NULL, NULL, &hash));
  PetscCall(LamMicrostructureDescribe(&run->scene->micro, &json, wanted));
  PetscCall(PetscFree(json));
  PetscCheck(!strcmp(hash, wanted), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds microstructure %s, the scene %s describes %s; give a database built from this scene",
             run->database_path, hash, run->scene_path, wanted);
  PetscCall(LamDatabaseGetRecords(run->database, &run->recorded, NULL, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2PrepareResponse(LamFE2Run *run)
{
  LamPlan plan;

  PetscFunctionBeginUser;
  if (run->response != LAM_FE2_DIRECT) PetscCall(OpenDatabase(run));
  PetscCall(LamPlanMake(run->scene, &plan));
  run->scene->micro = plan.micro;
  if (run->database)
    PetscCall(CheckDatabase(run));
  else if (run->response == LAM_FE2_CACHE)
    PetscCall(LamDatabaseCreateEmpty(run->scene, &run->database));
  PetscFunctionReturn(0);
}

/* A new database has no grid yet, nor has one that is older than the grid. */
static PetscErrorCode GiveGrid(LamFE2Run *run)
{
  PetscBool complete;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(run->database, &grid));
  if (grid) PetscFunctionReturn(0);
  if (LamAppIsRoot() && run->recorded && !run->quiet)
    fprintf(stderr,
            "lamella fe2: %s: its %" PetscInt_FMT
            " records belong to no grid; a grid is added, on which new ones lie\n",
            run->database_path, run->recorded);
  PetscCall(LamSharedGridMake(run->comm, run->scene, &run->solver, run->database, &run->grid_text, &complete));
  run->stopped = (PetscBool)!complete;
  PetscFunctionReturn(0);
}

/* Nodes in the file are equal to those of `build`. */
static PetscErrorCode CreateNodeSolver(LamFE2Run *run)
{
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(run->database, &grid));
  PetscCall(
      LamNodeChainCreate(run->rve, run->scene->micro.interface, grid, LAM_NODE_MEMORY, LamStopRequested, &run->chain));
  run->nodes = (LamNodeSolver){run->chain, LamNodeChainSolve};
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Connect(LamFE2Run *run)
{
  PetscInt points;

  PetscFunctionBeginUser;
  PetscCall(LamMacroGetPointCount(run->macro, &points));
  if (run->response != LAM_FE2_DATABASE) {
    PetscCall(LamRVECreate(PETSC_COMM_SELF, &run->rve));
    PetscCall(LamRVESetMicrostructure(run->rve, &run->scene->micro));
    PetscCall(LamRVESetStrategy(run->rve, run->scene->strategy));
    PetscCall(LamRVESetUp(run->rve));
    PetscCall(LamRVESetInterrupt(run->rve, LamStopInterrupt, NULL));
    /* behind a cache no point keeps a state: all its solves start from the reference */
    PetscCall(LamRVEResponderCreate(run->rve, run->response == LAM_FE2_DIRECT ? points : 0, &run->direct));
    PetscCall(LamInterruptibleResponderCreate(&run->direct, LamStopRequested, &run->solver));
  }
  PetscCall(LamMacroSetStop(run->macro, LamStopRequested));
  if (run->response == LAM_FE2_DIRECT) {
    PetscCall(LamMacroSetResponder(run->macro, &run->solver));
    PetscFunctionReturn(0);
  }
  if (run->response == LAM_FE2_CACHE) {
    PetscCall(GiveGrid(run));
    if (run->stopped) PetscFunctionReturn(0);
    PetscCall(CreateNodeSolver(run));
  }
  PetscCall(LamCacheResponderCreate(run->comm, run->database, run->rve ? &run->solver : NULL, &run->nodes,
                                    run->scene->accuracy, points, &run->cache));
  PetscCall(LamMacroSetResponder(run->macro, &run->cache));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Disconnect(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  if (run->cache.destroy) PetscCall(run->cache.destroy(&run->cache.ctx));
  if (run->solver.destroy) PetscCall(run->solver.destroy(&run->solver.ctx));
  PetscCall(LamNodeChainDestroy(&run->chain));
  if (run->direct.destroy) PetscCall(run->direct.destroy(&run->direct.ctx));
  PetscCall(LamRVEDestroy(&run->rve));
  PetscCall(LamDatabaseClose(&run->database));
  PetscCall(PetscFree(run->grid_text));
  PetscFunctionReturn(0);
}
