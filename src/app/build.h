/*
  Private to `lamella build`: which states the table is asked, and which nodes it lacks.
*/
#ifndef LAM_BUILD_H
#define LAM_BUILD_H

#include "app.h"

/*
  The state number `index` (0, 1, ...) of the scene's sample box: point index + 1 of the Halton sequence with bases
  2, 3, 5, 7 for two principal logarithmic strains, the angle between the first and face normal 0, and turgor. F is the
  right stretch U. With six-fold symmetry 30 degrees of angle are all there is, else 90.
  Source: J. H. Halton, Numer. Math. 2 (1960) 84-90.
*/
void LamSampleLoad(const LamScene *scene, PetscInt64 index, LamLoad *load);

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

/* `enough`: of what is lacking, so many nodes are listed, of the cells that most states wait for. */
PetscErrorCode LamPollMake(const LamScene *scene, LamDatabase database, PetscReal accuracy, PetscInt enough,
                           LamPoll *poll);
/* Whether enough of the box is answered: the last states of 200 are not chased. */
PetscBool LamPollIsDone(const LamPoll *poll);
PetscErrorCode LamPollDestroy(LamPoll *poll);

/*
  ---- rounds: rank 0 decides which nodes are solved ----

  A round is all nodes that the table of the rounds before it lacks. With an accuracy, rounds go on until enough of the
  box is answered to it; with a count, to any accuracy, then to 1/8, 1/16, ..., until there are so many nodes. With an
  accuracy they also end where two one after another have answered less than 1 % of the box more, and half of it is
  answered. What a round asks for depends on the scene, the grid and the rounds before it only: records that the file
  has got already are used in place of solves in the round that asks for their keys, and in no other. So a build that
  was interrupted comes to the same nodes as one that was not, whatever else the file holds.
*/
typedef struct {
  PetscInt64 key;
  const LamResponse *record; /* borrowed from the file */
} LamKnownNode;

typedef struct {
  const LamScene *scene; /* borrowed */
  LamDatabase table;     /* nodes of complete rounds; owned */
  PetscInt known_count;
  LamKnownNode *known;     /* [known_count], sorted; owned */
  PetscInt64 most;         /* nodes at most */
  PetscInt64 nodes;        /* in the table */
  PetscInt64 known_failed; /* without an answer, of those that were known */
  PetscReal accuracy;      /* that is asked for now */
  LamPoll poll;            /* of the table */
  PetscInt best, idle;     /* most states that a table has answered; rounds one after another that hardly added to it */
  /* the round under way: the first n keys of the poll */
  PetscInt n;
  LamResponse *responses; /* [n]; owned */
  PetscInt missing;       /* of the n: to be solved */
  PetscInt *place;        /* [missing] in responses; owned */
} LamRounds;

/* `file`: what was there before, NULL: nothing; it must outlive the rounds. Takes the grid over. */
PetscErrorCode LamRoundsCreate(const LamScene *scene, LamDatabase file, LamGrid *grid, LamRounds *rounds);
/* The next round of which something is missing; missing = 0: there is none, the build is at its end. */
PetscErrorCode LamRoundsNext(LamRounds *rounds);
/* Whether the rounds ended because they hardly added anything. */
PetscBool LamRoundsAreIdle(const LamRounds *rounds);
/* All responses are there: the round goes into the table. */
PetscErrorCode LamRoundsComplete(LamRounds *rounds);
/* Share of the box that is answered: to the accuracy, or with a count at all. */
PetscReal LamRoundsAnswered(const LamRounds *rounds);
PetscErrorCode LamRoundsDestroy(LamRounds *rounds);

#endif
