/*
  Quantities in text without raising an error, so that the caller can add where they stand.
*/
#ifndef LAM_QUANTITY_TEXT_H
#define LAM_QUANTITY_TEXT_H

#include <lamella/scene.h>

#define LAM_REASON_LENGTH 160

extern const char *const LamDimensionNames[];    /* "length", "stress", "angle" */
extern const char *const LamDimensionExamples[]; /* a quantity of each, for messages: "75 um" */

/*
  Reads a plain decimal number, as YAML writes it, from the start of text. *end is where it stops; *end == text: no
  number there. NaN and infinities are no numbers here, one too large for a double is read as infinite.
*/
PetscReal LamNumberScan(const char text[], const char **end);
PetscBool LamTextIsNonFinite(const char text[]); /* "nan", ".inf", "-Infinity", ... */

/*
  As LamQuantityParse, but what is wrong with the text goes to reason, which stays empty where all is well; only
  failures of the units library are errors.
*/
PetscErrorCode LamQuantityRead(const char text[], LamDimension dimension, PetscReal *si,
                               char reason[LAM_REASON_LENGTH]);

#endif
