/*
  How long `lamella build` takes to decide on a round: LamCoverageCompute on the first nodes of a database, and on all
  of them; the prediction of what a node will cost. Prints figures, asserts nothing. bench_coverage [DATABASE.h5 ...];
  without one, of a database that it builds.
*/
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <build.h>
#include <lamella/study.h>
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
  PetscCall(LamCoverageCompute(scene, &whole, table, scene->accuracy, n, NULL, (LamMeanwhile){0}, &coverage));
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

static PetscErrorCode BuildAndRun(void)
{
  char folder[] = "/tmp/bench_coverage.XXXXXX", path[64];
  LamBuildResult result;

  PetscFunctionBeginUser;
  PetscCheck(mkdtemp(folder), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", folder);
  snprintf(path, sizeof(path), "%s/block.h5", folder);
  PetscCall(LamStudyBuild(LAMELLA_SOURCE_DIR "/tests/scenes/tissue-block.yaml", path, &(LamBuildOptions){0}, &result));
  PetscCall(Run(path));
  remove(path);
  rmdir(folder);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  if (argc < 2 && BuildAndRun()) return 1;
  for (int i = 1; i < argc; i++)
    if (Run(argv[i])) return 1;
  return PetscFinalize() ? 1 : 0;
}
