/*
  Files that answer questions: what `query` and `verify` need to know of one.
*/
#ifndef LAM_QUERY_SOURCE_H
#define LAM_QUERY_SOURCE_H

#include "study.h"

typedef struct {
  LamDatabase database;    /* owned */
  LamScene *scene;         /* that the file was begun with; owned */
  LamMicrostructure micro; /* that the records are of; its cells are the database's */
  LamScales scales;
  PetscReal accuracy;                          /* the scene's */
  PetscReal turgor, cohesion;                  /* where a question does not say */
  const char *turgor_origin, *cohesion_origin; /* "the scene's", "that of all records" */
} LamQuerySource;

/*
  PETSC_ERR_USER_INPUT for files of other kinds, and of patches, which are no material points. Turgor and cohesion are
  those of the scene; of a file without a grid those of its records, where all have the same.
*/
PetscErrorCode LamQuerySourceOpen(const char path[], LamQuerySource *answers);
PetscErrorCode LamQuerySourceClose(LamQuerySource *answers);

/*
  A question in words: 4 numbers (plane strain) or 9, row-major, separated by blanks or commas; then, where it says so,
  a turgor and a cohesion with their units, "1 0.1 0 1 0.02 MPa 0.001 MPa", before each of which may stand a semicolon.
  What it does not say stays in *load. PETSC_FALSE where it is none; `problem` then tells why and what would be right.
*/
#define LAM_PROBLEM_LENGTH 256
PetscBool LamQueryParse(const char text[], const LamScales *scales, LamLoad *load, char problem[LAM_PROBLEM_LENGTH]);

#endif
