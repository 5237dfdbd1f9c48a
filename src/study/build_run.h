/*
  A build: fills a response database over the sample box of a scene.

    LamBuild build = {.path = ..., .team_size = 1, .shard = {1, 1}};
    LamBuildPrepare(&build, scene_path);  LamBuildTable(&build);  LamBuildDestroy(&build);
*/
#ifndef LAM_BUILD_RUN_H
#define LAM_BUILD_RUN_H

#include "build.h"
#include "node_work.h"

/* Records to be committed next, in the order of the file. */
typedef struct {
  PetscInt n, room;
  PetscInt64 *keys;       /* [n]; owned */
  LamResponse *responses; /* [n]; owned */
} LamPending;

typedef struct LamBuild_s {
  LamScene *scene;
  const char *path;
  LamReporter reporter;
  /* Called after each commit, on rank 0, with the reporter's ctx. May be NULL. */
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
  LamRounds rounds;
  LamPending pending;
  PetscBool opening;                                  /* rounds are being opened: prevents recursion */
  PetscInt64 added, there;                            /* committed by this run; found in the file by rounds */
  PetscInt64 failed;                                  /* committed records that did not converge */
  PetscReal last_commit, commit_seconds, all_commits; /* end of the last commit; its duration; total duration, s */
  PetscReal last_taken;                               /* time when a record was last queued in order */
} LamBuild;

/* Number of requested nodes that are in the file; number of those that did not converge. */
PetscInt64 LamBuildRecords(const LamBuild *build);
PetscInt64 LamBuildFailed(const LamBuild *build);

/* ---- build_table.c; collective ---- */

/* Reads the scene and chooses its mesh. PETSC_ERR_USER_INPUT if it has no sample box. */
PetscErrorCode LamBuildPrepare(LamBuild *build, const char scene_path[]);

/* Fills the file at build->path from build->scene, whose mesh must be chosen. */
PetscErrorCode LamBuildTable(LamBuild *build);
PetscErrorCode LamBuildDestroy(LamBuild *build); /* also destroys its scene, if any */

/* ---- build_start.c ---- */

/* Opens or creates, on rank 0, the file and its grid with the records of free cells, which all leaders solve; creates
   the rounds. Needs the RVE. Collective over the leaders. */
PetscErrorCode LamBuildStart(LamBuild *build);

/* ---- build_commit.c: rank 0 ---- */

/* Appends a record to those pending. */
PetscErrorCode LamBuildTake(LamBuild *build, PetscInt64 key, const LamResponse *response);
/* Queues solved nodes in the order of the rounds; `in_turn`: up to the first unsolved node only. */
PetscErrorCode LamBuildTakeSolved(LamBuild *build, PetscBool in_turn);
/* Commits pending records if a commit is due. */
PetscErrorCode LamBuildCommitInTime(LamBuild *build);
/* At a stop and at the end: queues and commits all solved nodes. `build`: a LamBuild. */
PetscErrorCode LamBuildCommitAll(void *build);

#endif
