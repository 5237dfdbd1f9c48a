/*
  Numbers and text of files as JSON. The caller owns what is returned.
*/
#ifndef LAM_JSON_H
#define LAM_JSON_H

#include <petscsys.h>
#include <jansson.h>

json_t *LamJSONReal(PetscReal value);                                        /* null where not finite */
json_t *LamJSONReals(PetscInt n, const PetscReal values[], PetscReal scale); /* each times `scale` */
/* Text of a file that may be damaged: where it is no UTF-8, question marks in place of what is no ASCII. */
json_t *LamJSONText(const char text[]);

#endif
