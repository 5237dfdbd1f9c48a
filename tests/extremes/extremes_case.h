/*
  The states of the map of extremes: what quantities vary, between which ends, and the scene of a state.

    0 .. ExtremesPairCount() - 1    all pairs of ends of two quantities, the others at their usual values; bonded and in
                                    contact
    from there on                   random: every quantity uniform between its ends, on its own scale
*/
#ifndef LAM_EXTREMES_CASE_H
#define LAM_EXTREMES_CASE_H

#include <petscsys.h>

#define EXTREMES_AXES(X)                                                                                               \
  X(EXTREMES_THICKNESS, "thickness") /* t/a */                                                                         \
  X(EXTREMES_FIBRES, "fibres")       /* C4/C1 */                                                                       \
  X(EXTREMES_BULK, "bulk")           /* kappa/C1 */                                                                    \
  X(EXTREMES_SHEAR, "shear")                                                                                           \
  X(EXTREMES_STRAIN1, "strain1") /* logarithmic */                                                                     \
  X(EXTREMES_STRAIN2, "strain2")                                                                                       \
  X(EXTREMES_TURGOR, "turgor")           /* over C1 */                                                                 \
  X(EXTREMES_COHESION, "cohesion")       /* over C1; contact alone */                                                  \
  X(EXTREMES_CLEARANCE, "clearance")     /* over a; contact alone */                                                   \
  X(EXTREMES_ORIENTATION, "orientation") /* degrees */                                                                 \
  X(EXTREMES_UNITS, "units")             /* 0: pm and GPa, 1: km and uPa */                                            \
  X(EXTREMES_INCREMENT, "increment")     /* of F, from the state just before; 1: from F = I in one go */               \
  X(EXTREMES_ELEMENTS, "elements")       /* in all */                                                                  \
  X(EXTREMES_CELLS, "cells")             /* n x n */                                                                   \
  X(EXTREMES_VARIATION, "variation")     /* of the cells: coefficient of variation */
#define EXTREMES_ENTRY(symbol, name) symbol,
typedef enum { EXTREMES_AXES(EXTREMES_ENTRY) EXTREMES_AXIS_COUNT } ExtremesAxis;
extern const char *const ExtremesAxisNames[];

typedef struct {
  PetscInt id;
  PetscBool contact;
  PetscReal value[EXTREMES_AXIS_COUNT];
  PetscInt pair[2]; /* the axes at their ends; -1: random */
} ExtremesCase;

PetscInt ExtremesPairCount(void);
void ExtremesCaseMake(PetscInt id, ExtremesCase *c);

/* What of the scene a second route changes. */
typedef struct {
  PetscInt finer;     /* factor on the elements along a face and through a wall */
  PetscInt ramp;      /* states on the way to F; 1: in one go */
  PetscBool one_step; /* strategy */
} ExtremesRoute;

/* Text of the scene as a user would write it. */
void ExtremesSceneWrite(const ExtremesCase *c, const ExtremesRoute *route, size_t length, char text[]);

#endif
