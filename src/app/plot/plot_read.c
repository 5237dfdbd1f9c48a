/*
  Reads and checks arrays that a picture requires.
*/
#include "plot.h"

/* rows < 0: any number. */
static PetscErrorCode Check(const char path[], const char name[], PetscBool found, PetscInt rank,
                            const PetscInt dims[4], PetscInt rows, PetscInt columns)
{
  PetscInt size = 1;

  PetscFunctionBeginUser;
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no %s; it is damaged, or older than this program",
             path, name);
  for (PetscInt i = 1; i < rank; i++) size *= dims[i];
  PetscCheck(rank > 0 && dims[0] > 0 && size == columns && (rows < 0 || dims[0] == rows), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT,
             "%s: %s is damaged: %" PetscInt_FMT " rows of %" PetscInt_FMT " numbers do not fit the rest of the file",
             path, name, rank > 0 ? dims[0] : 0, size);
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotHas(const char path[], const char name[], PetscBool *has)
{
  PetscInt rank, dims[4];
  PetscReal *values = NULL;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadReals(path, name, has, &rank, dims, &values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotReadReals(const char path[], const char name[], PetscInt rows, PetscInt columns,
                                PetscReal **values)
{
  PetscBool found;
  PetscInt rank, dims[4];

  PetscFunctionBeginUser;
  PetscCall(LamFileReadReals(path, name, &found, &rank, dims, values));
  PetscCall(Check(path, name, found, rank, dims, rows, columns));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotReadInts(const char path[], const char name[], PetscInt rows, PetscInt columns, PetscInt **values)
{
  PetscBool found;
  PetscInt rank, dims[4];

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(path, name, &found, &rank, dims, values));
  PetscCall(Check(path, name, found, rank, dims, rows, columns));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotReadText(const char path[], const char name[], char **text)
{
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(path, name, &found, text));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no %s; it is damaged, or older than this program",
             path, name);
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotGetRecords(LamDatabase database, LamPlotRecords *r)
{
  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetRecords(database, &r->n, &r->records, &r->keys));
  PetscCall(LamDatabaseGetMicrostructure(database, &r->micro, &r->scales, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotReadPoints(const char path[], const char name[], PetscInt rows, PetscInt *count,
                                 PetscReal **points)
{
  PetscBool found;
  PetscInt rank, dims[4], columns;
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadReals(path, name, &found, &rank, dims, &values));
  columns = found && rank == 2 && dims[1] == 3 ? 3 : 2;
  PetscCall(Check(path, name, found, rank, dims, rows, columns));
  PetscCall(PetscMalloc1(2 * dims[0], points));
  for (PetscInt i = 0; i < 2 * dims[0]; i++) (*points)[i] = values[columns * (i / 2) + i % 2];
  *count = dims[0];
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

/* For triangles alone: extends six columns to nine, the last three -1. */
static PetscErrorCode Widen(PetscInt count, PetscInt **elements)
{
  PetscInt *wide;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(9 * count, &wide));
  for (PetscInt i = 0; i < 9 * count; i++) wide[i] = i % 9 < 6 ? (*elements)[6 * (i / 9) + i % 9] : -1;
  PetscCall(PetscFree(*elements));
  *elements = wide;
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotReadElements(const char path[], const char name[], PetscInt node_count, PetscInt *count,
                                   PetscInt **elements)
{
  PetscBool found;
  PetscInt rank, dims[4];

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(path, name, &found, &rank, dims, elements));
  PetscCall(Check(path, name, found, rank, dims, -1, found && rank == 2 && dims[1] == 6 ? 6 : 9));
  if (dims[1] == 6) PetscCall(Widen(dims[0], elements));
  for (PetscInt i = 0; i < 9 * dims[0]; i++) {
    const PetscInt node = (*elements)[i];
    const PetscBool unused = (PetscBool)(i % 9 >= 6 && LamElementNodes(&(*elements)[i - i % 9]) == 6);
    PetscCheck(unused ? node == -1 : node >= 0 && node < node_count, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: %s is damaged: there is no node %" PetscInt_FMT, path, name, node);
  }
  *count = dims[0];
  PetscFunctionReturn(0);
}
