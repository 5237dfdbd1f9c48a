/*
  A scalar field of the reference position: an expression of x and y, or a table on a grid.
*/
#ifndef LAMELLA_PLACE_FIELD_H
#define LAMELLA_PLACE_FIELD_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_PLACE_FIELD_REASON 200

typedef struct LamPlaceField_s *LamPlaceField;

/*
  `name` identifies the field in messages. For invalid text, or an invalid file, `reason` says why and *field is NULL;
  otherwise `reason` is empty.
    expression  of x and y in mm and the constant pi, in the language of muParser: + - * / ^, comparisons and && ||
                (1 or 0), c ? a : b, sin, sqrt, exp, ln, abs, min, max ...
    table       text file: a first line of names, then lines x, y, value separated by commas, positions in mm; every
                pair of an x and a y of the file once, at least two of each. Bilinear interpolation.
*/
LAM_EXPORT PetscErrorCode LamPlaceFieldFromExpression(const char name[], const char text[], LamPlaceField *field,
                                                      char reason[LAM_PLACE_FIELD_REASON]);
LAM_EXPORT PetscErrorCode LamPlaceFieldFromTable(const char name[], const char path[], LamPlaceField *field,
                                                 char reason[LAM_PLACE_FIELD_REASON]);
/* Evaluates at (X[0], X[1]) in mm. PETSC_ERR_USER_INPUT if the expression is not finite, or the point is outside the
   table. Not thread-safe. */
LAM_EXPORT PetscErrorCode LamPlaceFieldEvaluate(LamPlaceField field, const PetscReal X[2], PetscReal *value);
LAM_EXPORT PetscErrorCode LamPlaceFieldDestroy(LamPlaceField *field);

LAM_C_END

#endif
