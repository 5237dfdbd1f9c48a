/*
  How long `lamella build` takes to decide on a round: LamCoverageCompute on the first nodes of a database, and on all
  of them; the prediction of what a node will cost. Prints figures, asserts nothing. bench_coverage [DATABASE.h5 ...]
*/
#include <stdio.h>
#include <build.h>
#include "measure.h"

static PetscErrorCode Cover(const LamScene *scene, LamDatabase file, PetscInt n)
{
  const LamShard whole = {1, 1};
  const LamResponse *records;
  const PetscInt64 *keys;
  LamDatabase table;
  LamGrid grid;
  LamCoverage coverage;
  double begin;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetRecords(file, NULL, &records, &keys));
  PetscCall(LamDatabaseGetGrid(file, &grid));
  PetscCall(LamGridGetText(grid, &text));
  PetscCall(LamGridFromText("the grid", &scene->micro, text, &grid));
  PetscCall(LamDatabaseCreateEmpty(scene, &table));
  PetscCall(LamDatabaseAdd(table, n, keys, records));
  PetscCall(LamDatabaseSetGrid(table, &grid));
  begin = ProcessorSeconds();
  PetscCall(LamCoverageCompute(scene, &whole, table, scene->accuracy, n, NULL, &coverage));
  printf("%8" PetscInt_FMT " nodes: %5.0f ms for %" PetscInt_FMT " states, %" PetscInt_FMT " nodes lacking\n", n,
         1e3 * (ProcessorSeconds() - begin), coverage.states, coverage.lacking);
  PetscCall(LamCoverageDestroy(&coverage));
  PetscCall(LamDatabaseClose(&table));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

static PetscErrorCode Predict(LamDatabase file, PetscInt n)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscReal sum = 0;
  LamNodeCosts costs;
  LamGrid grid;
  double begin;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetRecords(file, NULL, &records, &keys));
  PetscCall(LamDatabaseGetGrid(file, &grid));
  PetscCall(LamNodeCostsCreate(grid, &costs));
  for (PetscInt i = 0; i < n; i++)
    if (!LamKeyIsFreeCell(keys[i])) PetscCall(LamNodeCostsLearn(costs, keys[i], &records[i]));
  begin = ProcessorSeconds();
  for (PetscInt i = 0; i < n; i++)
    if (!LamKeyIsFreeCell(keys[i])) sum += LamNodeCostsPredict(costs, keys[i]);
  printf("prediction: %.2g us a node (%.3g factorisations on average)\n",
         1e6 * (ProcessorSeconds() - begin) / (double)n, sum / (double)n);
  PetscCall(LamNodeCostsDestroy(&costs));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(const char path[])
{
  LamDatabase file;
  PetscBool found;
  LamScene *scene;
  PetscInt n;
  char *text;

  PetscFunctionBeginUser;
  printf("%s\n", path);
  PetscCall(LamFileReadText(path, "/scene", &found, &text));
  PetscCall(LamSceneReadText(path, text, &scene));
  PetscCall(LamDatabaseOpen(path, &file));
  PetscCall(LamDatabaseGetRecords(file, &n, NULL, NULL));
  for (PetscInt part = 8; part >= 1; part /= 2) PetscCall(Cover(scene, file, n / part));
  PetscCall(Predict(file, n));
  PetscCall(LamDatabaseClose(&file));
  PetscCall(LamSceneDestroy(&scene));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (argc < 2) fprintf(stderr, "usage: bench_coverage DATABASE.h5 ...\n");
  for (int i = 1; i < argc; i++)
    if (Run(argv[i])) return 1;
  return 0; /* tables need neither PetscInitialize nor MPI */
}
