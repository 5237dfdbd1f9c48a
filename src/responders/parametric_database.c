#include <lamella/parametric_database.h>
#include <lamella/blend.h>
#include <lamella/tissue.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SAME 1e-9 /* relative */

const char *const LamParametricAxisNames[] = {LAM_FAMILY_AXES(LAM_NAME_ENTRY) NULL};

struct LamParametricDatabase_s {
  LamParametricAxis axis;
  PetscInt n;
  PetscReal *values;      /* of the knots, ascending */
  LamDatabase *databases; /* of the knots; borrowed */
};

/* ---- the axis ---- */

/* The wall parameter of an axis other than the wall thickness. */
static PetscInt OwnParameter(LamParametricAxis axis)
{
  return LAM_WALL_C2 + (PetscInt)(axis - LAM_FAMILY_WALL_THICKNESS);
}

static PetscReal AxisValue(const LamMicrostructure *micro, LamParametricAxis axis)
{
  switch (axis) {
  case LAM_FAMILY_WALL_THICKNESS:
    return micro->wall_thickness;
  case LAM_FAMILY_MATRIX:
    return micro->wall.C2 / micro->wall.C1;
  default:
    return LamWallGet(&micro->wall, OwnParameter(axis)) /
           (LamWallParameterIsModulus(OwnParameter(axis)) ? micro->wall.C1 : 1);
  }
}

static PetscBool Same(PetscReal a, PetscReal b)
{
  return (PetscBool)(fabs(a - b) <= SAME * (fabs(a) + fabs(b)));
}

/* Compares everything but the axes. Fibre moduli are in units of C1 + C2, so that C2/C1 can vary alone. */
static PetscBool SameOtherwise(const LamMicrostructure *a, const LamMicrostructure *b)
{
  return (PetscBool)(!a->cell && !b->cell && a->is_patch == b->is_patch && a->cells[0] == b->cells[0] &&
                     a->cells[1] == b->cells[1] && a->interface == b->interface && a->wall.law == b->wall.law &&
                     a->wall.fibres == b->wall.fibres && Same(a->wall.bulk_modulus, b->wall.bulk_modulus) &&
                     Same(a->clearance, b->clearance) && Same(1 + a->orientation, 1 + b->orientation) &&
                     LamTissuesAgree(a->tissue, b->tissue, SAME));
}

static PetscErrorCode FindAxis(PetscInt n, const LamDatabase databases[], LamParametricAxis *axis)
{
  LamMicrostructure first, other;
  PetscBool differs[LAM_FAMILY_AXIS_COUNT] = {PETSC_FALSE};
  int count = 0;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetMicrostructure(databases[0], &first, NULL, NULL));
  for (PetscInt i = 1; i < n; i++) {
    PetscCall(LamDatabaseGetMicrostructure(databases[i], &other, NULL, NULL));
    PetscCheck(
        SameOtherwise(&first, &other), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
        "database %d is of other tissue than the first; they may differ in t/a or one parameter of the wall alone "
        "(moduli in units of C1 + C2)",
        (int)i + 1);
    differs[LAM_FAMILY_WALL_THICKNESS] |= !Same(first.wall_thickness, other.wall_thickness);
    differs[LAM_FAMILY_MATRIX] |= !Same(first.wall.C1, other.wall.C1);
    for (PetscInt k = LAM_FAMILY_WALL_THICKNESS + 1; k < LAM_FAMILY_MATRIX; k++)
      differs[k] |= !Same(LamWallGet(&first.wall, OwnParameter((LamParametricAxis)k)),
                          LamWallGet(&other.wall, OwnParameter((LamParametricAxis)k)));
  }
  for (int k = 0; k < LAM_FAMILY_AXIS_COUNT; k++) {
    if (differs[k]) *axis = (LamParametricAxis)k;
    count += differs[k];
  }
  PetscCheck(count == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "the databases differ in %d of t/a and the parameters of the wall; one is wanted", count);
  PetscFunctionReturn(0);
}

PetscErrorCode LamParametricDatabaseCreate(PetscInt n, const LamDatabase databases[], LamParametricDatabase *family)
{
  LamParametricAxis axis = LAM_FAMILY_WALL_THICKNESS;
  LamParametricDatabase f;
  LamMicrostructure micro;
  PetscReal *values;
  PetscInt *order;

  PetscFunctionBeginUser;
  PetscCheck(n >= 2, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "a family needs at least two databases");
  PetscCall(FindAxis(n, databases, &axis));
  PetscCall(PetscNew(&f));
  *family = f;
  f->axis = axis;
  f->n = n;
  PetscCall(PetscMalloc2(n, &f->values, n, &f->databases));
  PetscCall(PetscMalloc2(n, &values, n, &order));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(LamDatabaseGetMicrostructure(databases[i], &micro, NULL, NULL));
    values[i] = AxisValue(&micro, axis);
    order[i] = i;
  }
  PetscCall(PetscSortRealWithPermutation(n, values, order));
  for (PetscInt i = 0; i < n; i++) {
    f->values[i] = values[order[i]];
    f->databases[i] = databases[order[i]];
  }
  PetscCall(PetscFree2(values, order));
  for (PetscInt i = 1; i < n; i++)
    PetscCheck(!Same(f->values[i - 1], f->values[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "two of the databases have %s = %g", LamParametricAxisNames[axis], (double)f->values[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamParametricDatabaseDestroy(LamParametricDatabase *family)
{
  PetscFunctionBeginUser;
  if (!*family) PetscFunctionReturn(0);
  PetscCall(PetscFree2((*family)->values, (*family)->databases));
  PetscCall(PetscFree(*family));
  PetscFunctionReturn(0);
}

PetscErrorCode LamParametricDatabaseGetAxis(LamParametricDatabase family, LamParametricAxis *axis, PetscReal *least,
                                            PetscReal *most)
{
  PetscFunctionBeginUser;
  *axis = family->axis;
  *least = family->values[0];
  *most = family->values[family->n - 1];
  PetscFunctionReturn(0);
}

/* ---- responses ---- */

PetscErrorCode LamParametricDatabaseQuery(LamParametricDatabase f, PetscReal value, const LamLoad *load,
                                          PetscReal accuracy, LamResponse *response)
{
  LamResponse at[LAM_BLEND_TERMS];
  LamBlendTerm terms[LAM_BLEND_TERMS];
  LamMicrostructure micro;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  response->status = LAM_OUT_OF_REACH;
  if (!(value >= f->values[0] * (1 - SAME) && value <= f->values[f->n - 1] * (1 + SAME))) {
    snprintf(response->reason, sizeof(response->reason), "%s = %g is outside the databases, %g to %g",
             LamParametricAxisNames[f->axis], (double)value, (double)f->values[0], (double)f->values[f->n - 1]);
    PetscFunctionReturn(0);
  }
  n = LamBlendAt(f->n, f->values, value, terms);
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(LamDatabaseQuery(f->databases[terms[i].knot], load, accuracy, &at[i]));
    if (at[i].status == LAM_CONVERGED) continue;
    response->status = at[i].status;
    snprintf(response->reason, sizeof(response->reason), "at %s = %g: %.150s", LamParametricAxisNames[f->axis],
             (double)f->values[terms[i].knot], at[i].reason);
    PetscFunctionReturn(0);
  }
  PetscCall(LamDatabaseGetMicrostructure(f->databases[terms[0].knot], &micro, NULL, NULL));
  LamBlend(LamStressScaleOf(&micro), n, terms, at, response);
  if (response->error_estimate > accuracy) {
    response->status = LAM_OUT_OF_REACH;
    snprintf(
        response->reason, sizeof(response->reason),
        "the estimated error between the databases is %.2g %%, the accuracy is %.2g %%; one more database between them "
        "helps",
        100 * response->error_estimate, 100 * accuracy);
  }
  PetscFunctionReturn(0);
}
