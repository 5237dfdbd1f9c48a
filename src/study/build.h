/*
  Coverage of a sample box by a response table, and the rounds of nodes that extend the table.
*/
#ifndef LAM_BUILD_H
#define LAM_BUILD_H

#include "study.h"
#include "known_records.h"
#include "node_costs.h"

/*
  State number `index` (0, 1, ...) of the scene's sample box: point index + 1 of the Halton sequence with bases
  2, 3, 5, 7, 11 for two principal logarithmic strains, the angle between the first principal direction and face normal
  0, turgor, and ln F33 if the box has a range of it. F in the plane is the right stretch U. The angle ranges over
  `wedge`, radian. Source: J. H. Halton, Numer. Math. 2 (1960) 84-90.
*/
void LamSampleLoad(const LamScene *scene, PetscReal wedge, PetscInt64 index, LamLoad *load);
/* The angle that covers the box: 30 degrees with all motions of a hexagon, else 90, as either stretch comes first. */
PetscErrorCode LamSampleWedge(const LamMicrostructure *micro, PetscReal *wedge);

/*
  One part of the sample box, for databases that are built separately and merged. Shards are boxes with nearly equal
  numbers of states. Together they contain exactly the states of the whole box, so a build that resumes from the merged
  database lacks very few nodes.
*/
typedef struct {
  PetscInt index, count; /* 1 .. count */
} LamShard;

/* Parses "I/N"; returns PETSC_FALSE for any other text. */
PetscBool LamShardParse(const char text[], LamShard *shard);
/* The states with numbers below `asked` that belong to the shard: (*states)[*n], ascending; the caller frees them. */
PetscErrorCode LamShardStates(const LamScene *scene, const LamShard *shard, PetscInt asked, PetscInt *n,
                              PetscInt **states);

/*
  Nodes that are requested together. Nodes missing in the file are solved and written in the order of `order`: longest
  chain first, parents before their children.
*/
typedef struct {
  PetscInt turn; /* number of the round */
  PetscInt n;
  PetscInt64 *keys;       /* [n], sorted; owned */
  LamResponse *responses; /* [n]; owned */
  PetscInt missing;       /* number of nodes to be solved */
  PetscInt *order;        /* [missing] indices into keys; owned */
  PetscReal *cost;        /* [missing] predicted cost; owned */
  PetscBool *solved;      /* [n]; owned */
  PetscInt arrived;       /* missing nodes whose response has arrived */
  PetscBool *taken;       /* [missing] queued for the file; owned */
  PetscInt next;          /* all missing nodes before this one in `order` are taken */
} LamRound;

/* Coverage of the states of the sample box by a table. Each state is covered, refused, or lacks nodes. */
typedef struct {
  PetscInt states;
  PetscInt covered; /* states with an error estimate within the accuracy */
  PetscInt refused; /* states that no further node would cover */
  PetscInt reached; /* states with any error estimate */
  PetscReal error;  /* 95 % quantile of the estimates of the reached states; NaN: none reached */
  char reason[192]; /* of the first refused state */
  PetscInt lacking;
  PetscInt64 *keys; /* [lacking] nodes to be solved, sorted; owned */
} LamCoverage;

/* What is called now and then during a long computation; NULL: nothing. */
typedef struct {
  PetscErrorCode (*call)(void *ctx);
  void *ctx; /* borrowed */
} LamMeanwhile;

/* Lists lacking nodes until there are at least `enough`, starting with the grid cells needed by most states per lacking
   node. Nodes of the round `under_way` (or NULL) are left out. */
PetscErrorCode LamCoverageCompute(const LamScene *scene, const LamShard *shard, LamDatabase database,
                                  PetscReal accuracy, PetscInt enough, const LamRound *under_way,
                                  LamMeanwhile meanwhile, LamCoverage *coverage);
/* Whether at least 99.5 % of the states that are not refused are covered. */
PetscBool LamCoverageIsDone(const LamCoverage *coverage);
PetscErrorCode LamCoverageDestroy(LamCoverage *coverage);

/*
  ---- rounds: rank 0 selects the nodes to solve ----

  A round is a set of nodes that the table of the complete rounds lacks. The next round is selected while one is being
  solved, from the table without it, so that no rank waits for the last nodes of a round. At most two rounds are open.
  With `sample.accuracy`, rounds end when the box is covered to this accuracy, or when MOST_IDLE rounds in a row hardly
  increase the coverage. With `sample.count`, they end at this number of nodes; the accuracy is first unlimited, then
  1/8, 1/16, ... The nodes of a round depend only on the scene, the grid and the earlier rounds. A record in the file
  replaces the solve of its node, in the round that lacks this node only. Therefore a resumed build requests the same
  nodes as an uninterrupted one, whatever else the file holds.
*/
enum { LAM_OPEN_ROUNDS = 2 };

typedef struct {
  const LamScene *scene;   /* borrowed */
  const LamShard *shard;   /* borrowed */
  LamGrid grid;            /* owned by the table */
  LamDatabase table;       /* nodes of complete rounds; owned */
  LamNodeCosts costs;      /* fitted to them; owned */
  LamKnownRecords known;   /* the records of the file; owned */
  PetscInt64 most;         /* largest number of nodes */
  PetscInt64 nodes;        /* in the table */
  PetscInt64 known_failed; /* records found in the file that did not converge */
  PetscReal accuracy;      /* of the current round */
  LamCoverage coverage;    /* of the table */
  PetscInt best, idle;     /* most states covered so far; rounds in a row with little gain */
  PetscInt open;           /* number of open rounds, the older first */
  PetscInt opened;         /* number of rounds so far */
  LamRound round[LAM_OPEN_ROUNDS];
  PetscBool dry;          /* the table lacks no nodes except those of open rounds */
  LamMeanwhile meanwhile; /* during a selection; may call LamRoundsArrive */
} LamRounds;

/* `known`: the records of the database to be resumed. Takes ownership of them and of the grid. */
PetscErrorCode LamRoundsCreate(const LamScene *scene, const LamShard *shard, const LamKnownRecords *known,
                               LamGrid *grid, LamRounds *rounds);
/*
  Closes complete rounds and opens the next. *round: the round that was opened (call again); NULL: none can be opened
  now. If none is open either, the build is finished.
*/
PetscErrorCode LamRoundsNext(LamRounds *rounds, LamRound **round);
/* Stores the response of a missing node of an open round. PETSC_ERR_PLIB if the node is in none. */
PetscErrorCode LamRoundsArrive(LamRounds *rounds, PetscInt64 key, const LamResponse *response);
/* Whether the rounds ended because MOST_IDLE rounds in a row hardly increased the coverage. */
PetscBool LamRoundsAreIdle(const LamRounds *rounds);
/* Number of nodes of the table and of open rounds; number of those that have a response. */
PetscInt64 LamRoundsRequested(const LamRounds *rounds);
PetscInt64 LamRoundsAvailable(const LamRounds *rounds);
/* Fraction of the box's states covered to the accuracy; with `sample.count`, with any error estimate. */
PetscReal LamRoundsCovered(const LamRounds *rounds);
PetscErrorCode LamRoundsDestroy(LamRounds *rounds);

#endif
