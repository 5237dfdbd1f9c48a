/*
  Parses quantities without raising errors, so that the caller can add the position.
*/
#ifndef LAM_QUANTITY_TEXT_H
#define LAM_QUANTITY_TEXT_H

#include <lamella/scene.h>

#define LAM_REASON_LENGTH 160

extern const char *const LamDimensionNames[];    /* "length", "stress", "angle" */
extern const char *const LamDimensionExamples[]; /* an example of each dimension for messages: "75 um" */

/*
  Reads a decimal number in YAML syntax from the start of text. *end is where it stops; *end == text: no number. NaN
  and infinities are not numbers here; a number too large for a double is read as infinite.
*/
PetscReal LamNumberScan(const char text[], const char **end);
/* True if a number ends where a decimal comma stands: `end` of "11,25 um". */
PetscBool LamTextHasDecimalComma(const char end[]);
#define LAM_DECIMAL_COMMA "has a decimal comma, and the decimal sign is the point"
PetscBool LamTextIsNonFinite(const char text[]); /* "nan", ".inf", "-Infinity", ... */

/* A suitable unit of time for a duration, and its length in s. */
const char *LamTimeUnit(PetscReal duration, PetscReal *seconds);

/*
  As LamQuantityParse, but for invalid text `reason` says why; otherwise it is empty. Only failures of the units
  library are errors.
*/
PetscErrorCode LamQuantityRead(const char text[], LamDimension dimension, PetscReal *si,
                               char reason[LAM_REASON_LENGTH]);

#endif
