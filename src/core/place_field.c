#include <lamella/place_field.h>
#include <errno.h>
#include <math.h>
#include <muParserDLL.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gather.h"
#include "quantity_text.h"

enum { MAX_ROWS = 1000000 };

typedef struct {
  PetscReal x[2], value;
} Row;

struct LamPlaceField_s {
  char *name, *text;       /* text: the expression, or the path of the table */
  muParserHandle_t parser; /* NULL: a table */
  PetscReal x[2];          /* the parser's variables */

  PetscInt n[2];
  PetscReal *knots[2]; /* ascending */
  PetscReal *values;   /* [n[0]][n[1]] */
};

/* ---- expressions ---- */

/* An empty handler: errors are queried after each call. */
static void KeepQuiet(muParserHandle_t parser) {}

static PetscReal Evaluate(LamPlaceField field, int *count)
{
  muFloat_t *values;

  values = mupEvalMulti(field->parser, count);
  return *count > 0 && values ? values[*count - 1] : NAN;
}

PetscErrorCode LamPlaceFieldFromExpression(const char name[], const char text[], LamPlaceField *field,
                                           char reason[LAM_PLACE_FIELD_REASON])
{
  static const char *const variables[] = {"x", "y"};
  LamPlaceField f;
  int count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *field = f;
  reason[0] = '\0';
  PetscCall(PetscStrallocpy(name, &f->name));
  PetscCall(PetscStrallocpy(text, &f->text));
  f->parser = mupCreate(muBASETYPE_FLOAT);
  mupSetErrorHandler(f->parser, KeepQuiet);
  for (int i = 0; i < 2; i++) mupDefineVar(f->parser, variables[i], &f->x[i]);
  mupDefineConst(f->parser, "pi", PETSC_PI);
  mupSetExpr(f->parser, f->text);
  (void)Evaluate(f, &count);
  if (mupError(f->parser))
    snprintf(reason, LAM_PLACE_FIELD_REASON, "is no expression of x and y: %s; write one, in mm",
             mupGetErrorMsg(f->parser));
  else if (count != 1)
    snprintf(reason, LAM_PLACE_FIELD_REASON, "is %d expressions; write one", count);
  if (reason[0]) PetscCall(LamPlaceFieldDestroy(field));
  PetscFunctionReturn(0);
}

static PetscErrorCode EvaluateExpression(LamPlaceField field, const PetscReal X[2], PetscReal *value)
{
  char place[100]; /* PETSc's own formatting writes 2. for 2 */
  int count = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) field->x[i] = X[i];
  *value = Evaluate(field, &count);
  if (mupError(field->parser) || !isfinite(*value)) {
    snprintf(place, sizeof(place), "is %g at x = %g mm, y = %g mm", *value, X[0], X[1]);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s: %s; it must be finite in the whole body", field->name,
            field->text, place);
  }
  PetscFunctionReturn(0);
}

/* ---- tables ---- */

/* Exactly three numbers. */
static PetscBool ReadRow(const char line[], Row *row)
{
  PetscReal *const numbers[] = {&row->x[0], &row->x[1], &row->value};

  for (int i = 0; i < 3; i++) {
    const char *end;

    line += strspn(line, " \t");
    *numbers[i] = LamNumberScan(line, &end);
    if (end == line || !isfinite(*numbers[i])) return PETSC_FALSE;
    line = end + strspn(end, " \t\r\n");
    if (i < 2 && *line++ != ',') return PETSC_FALSE;
  }
  return (PetscBool) !*line;
}

/* Reads all lines except the first. */
static PetscErrorCode ReadRows(FILE *stream, PetscInt *n, Row **rows, char reason[])
{
  PetscInt capacity = 64, number = 0;
  size_t size = 0;
  char *line = NULL;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(capacity, rows));
  while (!reason[0] && getline(&line, &size, stream) >= 0) {
    if (!number++ || !line[strspn(line, " \t\r\n")]) continue;
    if (*n == capacity) PetscCall(PetscRealloc(sizeof(Row) * (size_t)(capacity *= 2), rows));
    if (*n == MAX_ROWS)
      snprintf(reason, LAM_PLACE_FIELD_REASON, "has more than %d rows", (int)MAX_ROWS);
    else if (!ReadRow(line, &(*rows)[(*n)++]))
      snprintf(
          reason, LAM_PLACE_FIELD_REASON,
          "line %d is not three numbers x, y, value; separate them by commas, and write the decimal sign as a point",
          (int)number);
  }
  free(line);
  PetscFunctionReturn(0);
}

static int CompareReals(const void *first, const void *second)
{
  const PetscReal a = *(const PetscReal *)first, b = *(const PetscReal *)second;

  return (a > b) - (a < b);
}

/* The distinct values, ascending. */
static PetscErrorCode FindKnots(PetscInt n, const Row rows[], PetscInt axis, PetscInt *count, PetscReal **knots)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, knots));
  for (PetscInt k = 0; k < n; k++) (*knots)[k] = rows[k].x[axis];
  *count = n;
  LamSortUnique(count, *knots, sizeof(PetscReal), CompareReals);
  PetscFunctionReturn(0);
}

/* Index of the knot at or before x; it is never the last knot. */
static PetscInt FindKnot(PetscInt n, const PetscReal knots[], PetscReal x)
{
  PetscInt at;

  (void)PetscFindReal(x, n, knots, 0, &at);
  return PetscMax(0, PetscMin(at < 0 ? -at - 2 : at, n - 2)); /* not found: -(place to insert) - 1 */
}

static PetscErrorCode FillTable(LamPlaceField f, PetscInt n, const Row rows[], char reason[])
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < 2; a++) PetscCall(FindKnots(n, rows, a, &f->n[a], &f->knots[a]));
  if (f->n[0] < 2 || f->n[1] < 2 || f->n[0] * f->n[1] != n) {
    snprintf(reason, LAM_PLACE_FIELD_REASON,
             "has %d rows for %d x and %d y; a grid has every pair once, and two of each at least", (int)n,
             (int)f->n[0], (int)f->n[1]);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(n, &f->values));
  for (PetscInt k = 0; k < n; k++) f->values[k] = NAN;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt at[2];

    for (int a = 0; a < 2; a++) {
      at[a] = FindKnot(f->n[a], f->knots[a], rows[k].x[a]);
      if (f->knots[a][at[a]] < rows[k].x[a]) at[a]++;
    }
    if (!isnan(f->values[at[0] * f->n[1] + at[1]]))
      snprintf(reason, LAM_PLACE_FIELD_REASON, "has x = %g, y = %g twice", (double)rows[k].x[0], (double)rows[k].x[1]);
    f->values[at[0] * f->n[1] + at[1]] = rows[k].value;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlaceFieldFromTable(const char name[], const char path[], LamPlaceField *field,
                                      char reason[LAM_PLACE_FIELD_REASON])
{
  FILE *stream = fopen(path, "r");
  LamPlaceField f;
  Row *rows;
  PetscInt n;

  PetscFunctionBeginUser;
  *field = NULL;
  reason[0] = '\0';
  if (!stream) {
    snprintf(reason, LAM_PLACE_FIELD_REASON,
             "cannot be opened: %s; a relative path counts from the folder of the scene", strerror(errno));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscNew(&f));
  *field = f;
  PetscCall(PetscStrallocpy(name, &f->name));
  PetscCall(PetscStrallocpy(path, &f->text));
  PetscCall(ReadRows(stream, &n, &rows, reason));
  fclose(stream);
  if (!reason[0]) PetscCall(FillTable(f, n, rows, reason));
  PetscCall(PetscFree(rows));
  if (reason[0]) PetscCall(LamPlaceFieldDestroy(field));
  PetscFunctionReturn(0);
}

static PetscErrorCode EvaluateTable(LamPlaceField f, const PetscReal X[2], PetscReal *value)
{
  PetscInt at[2];
  PetscReal t[2];
  const PetscReal *low, *high;
  char place[160];

  PetscFunctionBeginUser;
  for (int a = 0; a < 2; a++) {
    const PetscReal least = f->knots[a][0], most = f->knots[a][f->n[a] - 1], slack = 1e-9 * (most - least);

    if (!(X[a] >= least - slack && X[a] <= most + slack)) {
      snprintf(place, sizeof(place), "x = %g mm, y = %g mm: %s is from %g to %g mm", X[0], X[1], a ? "y" : "x", least,
               most);
      SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
              "%s: %s: has no value at %s there; extend the table over the whole body", f->name, f->text, place);
    }
    at[a] = FindKnot(f->n[a], f->knots[a], X[a]);
    t[a] = (X[a] - f->knots[a][at[a]]) / (f->knots[a][at[a] + 1] - f->knots[a][at[a]]);
  }
  low = &f->values[at[0] * f->n[1] + at[1]];
  high = low + f->n[1];
  *value = (1 - t[0]) * ((1 - t[1]) * low[0] + t[1] * low[1]) + t[0] * ((1 - t[1]) * high[0] + t[1] * high[1]);
  PetscFunctionReturn(0);
}

/* ---- both ---- */

PetscErrorCode LamPlaceFieldEvaluate(LamPlaceField field, const PetscReal X[2], PetscReal *value)
{
  PetscFunctionBeginUser;
  if (field->parser)
    PetscCall(EvaluateExpression(field, X, value));
  else
    PetscCall(EvaluateTable(field, X, value));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlaceFieldDestroy(LamPlaceField *field)
{
  PetscFunctionBeginUser;
  if (!*field) PetscFunctionReturn(0);
  if ((*field)->parser) mupRelease((*field)->parser);
  PetscCall(PetscFree((*field)->name));
  PetscCall(PetscFree((*field)->text));
  for (int a = 0; a < 2; a++) PetscCall(PetscFree((*field)->knots[a]));
  PetscCall(PetscFree((*field)->values));
  PetscCall(PetscFree(*field));
  PetscFunctionReturn(0);
}
