/*
  Interpolation between databases: one more axis, along which walls vary in space or time.

  Databases of microstructures that differ in one number, wall thickness t/a or a wall parameter, are the knots of the
  axis. Between them the potentials are combined with fixed weights (blend.h), so that stress and tangent are the
  exact derivatives of one potential.
*/
#ifndef LAMELLA_PARAMETRIC_DATABASE_H
#define LAMELLA_PARAMETRIC_DATABASE_H

#include <lamella/database.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_FAMILY_MODULUS(name) #name "/C1"
#define LAM_FAMILY_NUMBER(name) #name
#define LAM_FAMILY_OF_WALL(X, name, law, kind, ...) X(LAM_FAMILY_##name, LAM_FAMILY_##kind(name))
#define LAM_FAMILY_AXES(X)                                                                                             \
  X(LAM_FAMILY_WALL_THICKNESS, "wall_thickness") /* t/a */                                                             \
  LAM_WALL_OWN_PARAMETERS(LAM_FAMILY_OF_WALL, X)                                                                       \
  X(LAM_FAMILY_MATRIX, "C2/C1")
typedef enum { LAM_FAMILY_AXES(LAM_ENUM_ENTRY) LAM_FAMILY_AXIS_COUNT } LamParametricAxis;
LAM_EXPORT extern const char *const LamParametricAxisNames[];

typedef struct LamParametricDatabase_s *LamParametricDatabase;

/*
  n >= 2 databases, in any order; borrowed; do not add to them during queries. PETSC_ERR_USER_INPUT if they differ in
  more than one of these numbers (in units of C1 + C2 and apothems), in none, or two are equal.
*/
LAM_EXPORT PetscErrorCode LamParametricDatabaseCreate(PetscInt n, const LamDatabase databases[],
                                                      LamParametricDatabase *family);
LAM_EXPORT PetscErrorCode LamParametricDatabaseDestroy(LamParametricDatabase *family);
/* The axis and the range of its knots. */
LAM_EXPORT PetscErrorCode LamParametricDatabaseGetAxis(LamParametricDatabase family, LamParametricAxis *axis,
                                                       PetscReal *least, PetscReal *most);
/*
  The response at `value` of the axis; load and response in units of C1 + C2. LAM_OUT_OF_REACH if one of the databases
  is, or the value is outside the knots. error_estimate: the databases' estimates plus the change of P when the knot
  farthest from the value is left out (with two knots: a quarter of the change between them). Thread-safe as
  LamDatabaseQuery.
*/
LAM_EXPORT PetscErrorCode LamParametricDatabaseQuery(LamParametricDatabase family, PetscReal value, const LamLoad *load,
                                                     PetscReal accuracy, LamResponse *response);

LAM_C_END

#endif
