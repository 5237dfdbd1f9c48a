/* Databases of the analytic tissue, node by node. */
#ifndef LAM_SUPPORT_ANALYTIC_TABLE_H
#define LAM_SUPPORT_ANALYTIC_TABLE_H

#include <grid.h>
#include "analytic_tissue.h"
#include "random_reals.h"

typedef struct {
  AnalyticTissue tissue;
  LamScene scene;
  LamGrid grid; /* the database's */
  LamDatabase database;
} AnalyticTable;

/* A test on an `AnalyticTable *t` that `open` gives. */
#define TABLE_TEST(name, open) TEST_ON(name, AnalyticTable, t, *t = open, AnalyticTableClose(t))

LamScene AnalyticScene(const AnalyticTissue *tissue);
/* LamGridCreate with the tissue as solver. */
PetscErrorCode AnalyticGridCreate(const LamScene *scene, AnalyticTissue *tissue, LamGrid *grid);
/* With the free cells' states, without any other node. */
AnalyticTable AnalyticTableOpenScene(AnalyticTissue tissue, LamScene scene);
AnalyticTable AnalyticTableOpen(PetscBool contact, double orientation);
void AnalyticTableClose(AnalyticTable *t);
/* The key of a place, whichever way its axes lie; z: 0 without the axis F33. */
PetscInt64 KeyAt(const AnalyticTable *t, const int i[3], int j, int z);
PetscInt64 KeyOf(const AnalyticTable *t, const int i[3], int j); /* z = 0 */
LamResponse AnswerOf(const AnalyticTable *t, PetscInt64 key);
PetscBool HasKey(const AnalyticTable *t, PetscInt64 key);
void AddKey(AnalyticTable *t, PetscInt64 key);
/* At all knots of F33. */
void AddPlace(AnalyticTable *t, const int i[3], int j);
/* A node whose solve failed. */
void AddFailed(AnalyticTable *t, const int i[3], int j);
/* All nodes of a block of cells of a level, corner `first`; j: every `along` units of suction. */
void AddBlock(AnalyticTable *t, int level, const int first[3], int cells, int along);
/* The state at a place, turned by an angle. v: along suction; bonded: none; w: along F33, in knots from the first. */
LamLoad LoadAt(const AnalyticTable *t, const double u[3], double v, double angle);
LamLoad LoadAtF33(const AnalyticTable *t, const double u[3], double v, double w, double angle);
LamResponse AskFor(const AnalyticTable *t, const LamLoad *load, double accuracy);
/* To any accuracy. */
LamResponse Ask(const AnalyticTable *t, const LamLoad *load);
/* Whether there is an answer. */
PetscBool Answers(const AnalyticTable *t, const LamLoad *load, LamResponse *r);
/* The answers at load +- h of one of its numbers, and the slope of a member for h = ANSWER_STEP. */
void AnswerPair(const AnalyticTable *t, const LamLoad *load, size_t offset, double h, LamResponse pair[2]);
#define ANSWER_STEP 1e-6
#define ANSWER_SLOPE(pair, member) (((pair)[1].member - (pair)[0].member) / (2 * ANSWER_STEP))
/* Root cells of a block, and of the finer nodes of two levels some; also some halves and quarters of suction.
   Of the finer nodes the share `failing` has no solution. With the axis F33 a quarter of the finer knots is missing. */
void AddRough(AnalyticTable *t, int cells, double failing, uint64_t *seed);

#endif
