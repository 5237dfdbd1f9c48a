/*
  The discrete problem of the RVE in more digits than those of PetscReal: what the shipped code would answer if it did
  not round. Mesh, element, wall laws, turgor, contact and condensation are the very sources of rve/, compiled once more
  with another PetscReal (extended_source.h).

  Method. From the positions and multipliers that the double-precision solver has found, Newton's method on the extended
  residual, with the double-precision factor as tangent: iterative refinement. Of contact the active set and the
  junction status are those found; they are discrete, and rounding does not move them unless it decides a tie.
*/
#ifndef LAM_TEST_EXTENDED_H
#define LAM_TEST_EXTENDED_H

#define EXTENDED_PARAMETERS 16 /* at most, of a wall */

/* As LamMicrostructure and LamLoad, in double precision; all cells alike, periodic. Everything is taken as exact. */
typedef struct {
  double thickness, orientation, grading, clearance;
  int cells[2], along, through;
  int law, fibres, contact;
  double parameter[EXTENDED_PARAMETERS], bulk_modulus; /* of the wall, as in lamella/wall.h */
  double F[9], turgor, cohesion;
} ExtendedCase;

/* Where to start: what the double-precision solver has found. */
typedef struct {
  const double *y;      /* [class][2] */
  const double *lambda; /* [multipliers]; of bonded tissue NULL, like the next two */
  const int (*hats)[2];
  const int *active;
  /* solution [n] of the double-precision system, unknowns as in rve/ */
  int (*solve)(void *ctx, const double rhs[], double solution[]);
  void *ctx;
} ExtendedStart;

typedef struct {
  double P[9], energy, lumen, opening;
  double tangent[81];
  double residual; /* norm of what is left */
  double moved;    /* largest change of a position, apothems */
  double rounding; /* norm of the double-precision positions' own residual, evaluated in extended precision */
  int iterations;
} ExtendedAnswer;

/* 113 bits; slow. */
int ExtendedQuad(const ExtendedCase *c, const ExtendedStart *start, int tangent, ExtendedAnswer *answer);
/* 64 bits where the processor has them: 2000 times the digits of a double, some ten times the time. */
int ExtendedLong(const ExtendedCase *c, const ExtendedStart *start, int tangent, ExtendedAnswer *answer);

#endif
