/*
  Which states the table is asked, and which nodes it lacks.
*/
#ifndef LAM_BUILD_H
#define LAM_BUILD_H

#include "study.h"
#include "node_costs.h"

/*
  The state number `index` (0, 1, ...) of the scene's sample box: point index + 1 of the Halton sequence with bases
  2, 3, 5, 7 for two principal logarithmic strains, the angle between the first and face normal 0, and turgor. F is the
  right stretch U. With six-fold symmetry 30 degrees of angle are all there is, else 90.
  Source: J. H. Halton, Numer. Math. 2 (1960) 84-90.
*/
void LamSampleLoad(const LamScene *scene, PetscInt64 index, LamLoad *load);

/*
  A part of the sample box, for databases that are built apart and merged: parts are boxes of like many states. The
  states of all parts together are those of the whole, so a build that goes on with what was merged lacks next to
  nothing.
*/
typedef struct {
  PetscInt index, count; /* 1 .. count */
} LamShard;

/* From "I/N"; PETSC_FALSE where the text is something else. */
PetscBool LamShardParse(const char text[], LamShard *shard);
/* The states among the first `asked` that belong to the shard: *n numbers, for the caller to free. */
PetscErrorCode LamShardStates(const LamScene *scene, const LamShard *shard, PetscInt asked, PetscInt *n,
                              PetscInt **states);

/*
  Nodes that are requested together. Those that the file lacks are solved in the order of `order`, which is that of the
  file: longest first, but parents before their children.
*/
typedef struct {
  PetscInt n;
  PetscInt64 *keys;       /* [n], sorted; owned */
  LamResponse *responses; /* [n]; owned */
  PetscInt missing;       /* of the n: to be solved */
  PetscInt *order;        /* [missing] places in keys; owned */
  PetscReal *cost;        /* [missing] predicted; owned */
  PetscBool *solved;      /* [n]; owned */
  PetscInt arrived;       /* of those missing */
  PetscBool *taken;       /* [missing]: on the way to the file; owned */
  PetscInt next;          /* those before it are taken */
} LamRound;

/* States of the sample box against a table: each is covered, refused, or lacks nodes. */
typedef struct {
  PetscInt states;
  PetscInt covered; /* with an estimated error within the accuracy */
  PetscInt refused; /* no node would help */
  PetscInt reached; /* with any estimate */
  PetscReal error;  /* 95 % quantile of the estimates of those reached; NaN: none is */
  char reason[192]; /* of the first that is refused */
  PetscInt lacking;
  PetscInt64 *keys; /* [lacking] nodes to be solved, sorted; owned */
} LamCoverage;

/* Lists at least `enough` lacking nodes where there are so many, those of the cells that most states need first; none
   of the round `under_way` (or NULL). */
PetscErrorCode LamCoverageCompute(const LamScene *scene, const LamShard *shard, LamDatabase database,
                                  PetscReal accuracy, PetscInt enough, const LamRound *under_way,
                                  LamCoverage *coverage);
/* Whether 99.5 % of the states that are not refused are covered. */
PetscBool LamCoverageIsDone(const LamCoverage *coverage);
PetscErrorCode LamCoverageDestroy(LamCoverage *coverage);

/*
  ---- rounds: rank 0 decides which nodes are solved ----

  A round: nodes that the table of the complete rounds lacks. The next is decided while one is being solved, from the
  table without it, so that no rank waits for the last nodes of a round: at most two are open. With `sample.accuracy`
  rounds end where the box is covered to it, or where MOST_IDLE of them in a row hardly cover more; with `sample.count`
  at so many nodes, the accuracy being any, then 1/8, 1/16, ... The nodes of a round depend on the scene, the grid and
  the rounds before only: a record in the file takes the place of a solve in the round that lacks its node, and in no
  other. So an interrupted build comes to the nodes of an undisturbed one, whatever else the file holds.
*/
typedef struct {
  PetscInt64 key;
  const LamResponse *record; /* borrowed from the file */
} LamKnownNode;

enum { LAM_OPEN_ROUNDS = 2 };

typedef struct {
  const LamScene *scene; /* borrowed */
  const LamShard *shard; /* borrowed */
  LamGrid grid;          /* the table's */
  LamDatabase table;     /* nodes of complete rounds; owned */
  LamNodeCosts costs;    /* learnt from them; owned */
  PetscInt known_count;
  LamKnownNode *known;     /* [known_count], sorted; owned */
  PetscInt64 most;         /* nodes at most */
  PetscInt64 nodes;        /* in the table */
  PetscInt64 known_failed; /* records of the file without a solution */
  PetscReal accuracy;      /* of this round */
  LamCoverage coverage;    /* of the table */
  PetscInt best, idle;     /* most states covered so far; rounds in a row that hardly added to it */
  PetscInt open;           /* rounds under way, the older first */
  LamRound round[LAM_OPEN_ROUNDS];
  PetscBool dry; /* the table lacks nothing but what is under way */
} LamRounds;

/* `file`: the database to be continued, or NULL; borrowed. Takes the grid over. */
PetscErrorCode LamRoundsCreate(const LamScene *scene, const LamShard *shard, LamDatabase file, LamGrid *grid,
                               LamRounds *rounds);
/*
  Closes rounds that are complete and opens others. *round: one that was opened (call again), NULL: none for the moment;
  with none open the build is at its end.
*/
PetscErrorCode LamRoundsNext(LamRounds *rounds, LamRound **round);
/* The response of a node of an open round that was missing. */
PetscErrorCode LamRoundsArrive(LamRounds *rounds, PetscInt64 key, const LamResponse *response);
/* The record of a node in the file, or NULL. */
const LamResponse *LamRoundsKnown(const LamRounds *rounds, PetscInt64 key);
/* Whether the rounds ended because they hardly added anything. */
PetscBool LamRoundsAreIdle(const LamRounds *rounds);
/* Nodes of the table and of open rounds, and those of them that are there already. */
PetscInt64 LamRoundsRequested(const LamRounds *rounds);
PetscInt64 LamRoundsAvailable(const LamRounds *rounds);
/* Share of the box that is covered: to the accuracy, or with a count at all. */
PetscReal LamRoundsCovered(const LamRounds *rounds);
PetscErrorCode LamRoundsDestroy(LamRounds *rounds);

#endif
