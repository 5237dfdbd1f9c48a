/*
  Cells of any shape in the description of a microstructure (microstructure.c): nondimensional, with 12 digits.
*/
#ifndef LAM_TISSUE_JSON_H
#define LAM_TISSUE_JSON_H

#include <jansson.h>
#include <lamella/tissue.h>
#include <stdio.h>

void LamTissueDescribe(LamTissue tissue, FILE *out);
/* PETSC_FALSE: the description is damaged. */
PetscBool LamTissueParse(const json_t *object, LamTissue *tissue);

#endif
