/*
  Conversion of numbers and text to JSON. The caller owns the result.
*/
#ifndef LAM_JSON_H
#define LAM_JSON_H

#include <petscsys.h>
#include <jansson.h>

json_t *LamJSONReal(PetscReal value);                                        /* null if not finite */
json_t *LamJSONReals(PetscInt n, const PetscReal values[], PetscReal scale); /* each times `scale` */
/* Text of a file that may be damaged: if it is not valid UTF-8, non-ASCII bytes become question marks. */
json_t *LamJSONText(const char text[]);

#endif
