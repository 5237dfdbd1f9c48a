/*
  A build: fills a response database over the sample box of a scene.

    LamBuild build = {.path = ..., .team_size = 1, .shard = {1, 1}};
    LamBuildPrepare(&build, scene_path);  LamBuildTable(&build);  LamBuildDestroy(&build);
*/
#ifndef LAM_BUILD_RUN_H
#define LAM_BUILD_RUN_H

#include "build.h"
#include "node_work.h"

/* What is to be committed next: records in the order of the file. */
typedef struct {
  PetscInt n, room;
  PetscInt64 *keys;       /* [n]; owned */
  LamResponse *responses; /* [n]; owned */
} LamPending;

typedef struct LamBuild_s {
  LamScene *scene;
  const char *path;
  LamReporter reporter;
  /* After each commit, on rank 0; ctx: the reporter's. May be NULL. */
  PetscErrorCode (*committed)(void *ctx, const struct LamBuild_s *build);
  PetscBool resume;
  PetscInt team_size; /* ranks that solve one RVE together */
  LamShard shard;
  PetscMPIInt rank, size;
  MPI_Comm team, leaders; /* of this rank; leaders: the first ranks of all teams, MPI_COMM_NULL on the others */
  LamRVE rve;
  LamGrid grid;
  LamNodeWork work;
  PetscReal start;

  /* on rank 0 */
  LamRecordWriter writer;
  LamDatabase file; /* what was there before; NULL: nothing */
  LamRounds rounds;
  LamPending pending;
  PetscBool opening;       /* rounds are being opened: nodes that arrive meanwhile open none */
  PetscInt64 added, there; /* committed by this run; nodes that rounds have found in the file */
  PetscInt64 failed;       /* without a solution, of those committed */
  PetscReal last_commit, commit_seconds, all_commits; /* when it ended; what it took, and all of them, s */
  PetscReal last_taken;                               /* when a record was last taken for the file in its turn */
} LamBuild;

/* Nodes in the file that this build has requested, and those of them without a solution. */
PetscInt64 LamBuildRecords(const LamBuild *build);
PetscInt64 LamBuildFailed(const LamBuild *build);

/* ---- build_table.c; collective ---- */

/* Reads the scene and chooses its mesh. PETSC_ERR_USER_INPUT where it has no sample box. */
PetscErrorCode LamBuildPrepare(LamBuild *build, const char scene_path[]);

/* Fills the file at build->path from build->scene, whose mesh is chosen.  */
PetscErrorCode LamBuildTable(LamBuild *build);
PetscErrorCode LamBuildDestroy(LamBuild *build); /* with its scene; NULL: it has none */

/* ---- build_start.c ---- */

/* Rank 0: opens or makes the file, its grid and what comes with it; the rounds begin. Needs the RVE. */
PetscErrorCode LamBuildStart(LamBuild *build);

/* ---- build_commit.c: rank 0 ---- */

/* This record comes next in the file. */
PetscErrorCode LamBuildTake(LamBuild *build, PetscInt64 key, const LamResponse *response);
/* Takes solved nodes in the order of the rounds; `in_turn`: up to the first node that is not solved. */
PetscErrorCode LamBuildTakeSolved(LamBuild *build, PetscBool in_turn);
/* Commits what was taken where it is time. */
PetscErrorCode LamBuildCommitInTime(LamBuild *build);
/* At a stop, and at the end: takes all that is solved, and commits it. `build`: a LamBuild. */
PetscErrorCode LamBuildCommitAll(void *build);

#endif
