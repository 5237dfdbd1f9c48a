/*
  Files that can be queried, as `query` and `verify` need them.
*/
#ifndef LAM_QUERY_SOURCE_H
#define LAM_QUERY_SOURCE_H

#include "study.h"

typedef struct {
  LamDatabase database;    /* owned */
  LamScene *scene;         /* scene with which the file was created; owned */
  LamMicrostructure micro; /* of the records; its cells are the database's */
  LamScales scales;
  PetscReal accuracy;                          /* of the scene */
  PetscReal turgor, cohesion;                  /* defaults for queries that do not give them */
  const char *turgor_origin, *cohesion_origin; /* "the scene's", "that of all records" */
} LamQuerySource;

/*
  PETSC_ERR_USER_INPUT for files of other kinds, and of patches, which are not material points. Turgor and cohesion are
  those of the scene; for a file without a grid, those of its records if all have the same.
*/
PetscErrorCode LamQuerySourceOpen(const char path[], LamQuerySource *answers);
PetscErrorCode LamQuerySourceClose(LamQuerySource *answers);

/*
  Parses a query: 4 numbers (plane strain) or 9, row-major, separated by blanks or commas; then optionally a turgor and
  a cohesion with units, "1 0.1 0 1 0.02 MPa 0.001 MPa", each of which may be preceded by a semicolon. Omitted values
  stay as they are in *load. PETSC_FALSE if it is not a query; `problem` then gives the reason and the expected form.
*/
#define LAM_PROBLEM_LENGTH 256
PetscBool LamQueryParse(const char text[], const LamScales *scales, LamLoad *load, char problem[LAM_PROBLEM_LENGTH]);

#endif
