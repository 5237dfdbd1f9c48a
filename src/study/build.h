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
  A round of nodes that are asked for together. Those that the file has not got are solved, in the order of `order`,
  which is that of the file, too: what takes longest comes first, but parents before their children.
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

/* What a table says to the first states of the box: each is answered, refused, or waits for nodes. */
typedef struct {
  PetscInt asked;
  PetscInt answered; /* with an estimated error of at most the accuracy */
  PetscInt refused;  /* where no node helps */
  PetscInt reached;  /* with any estimate */
  PetscReal error;   /* estimated error that 95 % of those reached stay below; NaN: none is */
  char reason[192];  /* of the first that is refused */
  PetscInt lacking;
  PetscInt64 *keys; /* [lacking] nodes that it lacks for those that wait, sorted; owned */
} LamPoll;

/* `enough`: of what is lacking, so many nodes are listed, of the cells that most states wait for; none of `under_way`
   (or NULL). */
PetscErrorCode LamPollMake(const LamScene *scene, const LamShard *shard, LamDatabase database, PetscReal accuracy,
                           PetscInt enough, const LamRound *under_way, LamPoll *poll);
/* Whether enough of the box is answered: the last states of 200 are not chased. */
PetscBool LamPollIsDone(const LamPoll *poll);
PetscErrorCode LamPollDestroy(LamPoll *poll);

/*
  ---- rounds: rank 0 decides which nodes are solved ----

  A round is nodes that the table of complete rounds lacks. While one is being solved the next is decided from the table
  without it, so that no rank waits for the last nodes of a round: at most two are open. With an accuracy, rounds go on
  until enough of the box is answered to it; with a count, to any accuracy, then to 1/8, 1/16, ..., until there are so
  many nodes. With an accuracy they also end where some one after another have hardly answered more of the box, and half
  of it is answered. What a round asks for depends on the scene, the grid and the rounds before it only: records that
  the file has got already are used in place of solves in the round that asks for their keys, and in no other. So a
  build that was interrupted comes to the same nodes as one that was not, whatever else the file holds.
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
  PetscInt64 known_failed; /* without an answer, of those that were known */
  PetscReal accuracy;      /* that is asked for now */
  LamPoll poll;            /* of the table */
  PetscInt best, idle;     /* most states that a table has answered; rounds one after another that hardly added to it */
  PetscInt open;           /* rounds under way, the older first */
  LamRound round[LAM_OPEN_ROUNDS];
  PetscBool dry; /* the table asks for nothing but what is under way */
} LamRounds;

/* `file`: what was there before, NULL: nothing; it must outlive the rounds. Takes the grid over. */
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
PetscInt64 LamRoundsAsked(const LamRounds *rounds);
PetscInt64 LamRoundsThere(const LamRounds *rounds);
/* Share of the box that is answered: to the accuracy, or with a count at all. */
PetscReal LamRoundsAnswered(const LamRounds *rounds);
PetscErrorCode LamRoundsDestroy(LamRounds *rounds);

#endif
