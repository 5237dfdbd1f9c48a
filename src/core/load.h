#ifndef LAM_LOAD_H
#define LAM_LOAD_H

#include <lamella/response.h>

/* The load at parameter t of the straight load path from a (0) to b (1). */
LamLoad LamLoadBetween(const LamLoad *a, const LamLoad *b, PetscReal t);

/* F is the right stretch U with these principal logarithmic strains; angle: of the first principal direction. */
LamLoad LamLoadOfStrains(PetscReal first, PetscReal second, PetscReal angle, PetscReal turgor, PetscReal cohesion);

#endif
