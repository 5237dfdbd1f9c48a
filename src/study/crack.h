/*
  The crack that grows from the notch of a patch: its resistance, and the toughness of the tissue.

    R = (change of the energy dissipated) / (area by which the crack has grown), both per thickness out of the plane
    K = sqrt(E' R),  E': modulus of the tissue in plane strain along X2, with free sides, at the load of the first state

  R is the mean from the state at which the crack begins to grow to the last at which it has grown. K is that of linear
  elastic fracture mechanics, of tissue that is isotropic in its plane, and large against what breaks ahead of the
  crack. Reference. Irwin, J. Appl. Mech. 24 (1957) 361.
*/
#ifndef LAM_CRACK_H
#define LAM_CRACK_H

#include <lamella/response.h>
#include <lamella/scene.h>

typedef struct {
  PetscInt begins, last;    /* states; 0: it has not grown */
  PetscInt faces;           /* of the crack, at the last */
  PetscReal length[2];      /* at both, in apothems */
  PetscReal dissipated[2];  /* at both, (C1 + C2) apothem^2 */
  PetscReal F22[2], P22[2]; /* at both */
  PetscReal resistance;     /* R, (C1 + C2) apothem; NaN: the crack has grown in one step, or not at all */
  PetscReal modulus;        /* E', C1 + C2; NaN: cells of several kinds */
  PetscReal toughness;      /* K, (C1 + C2) apothem^(1/2) */
} LamCrack;

#define LAM_NO_CRACK ((LamCrack){.resistance = NAN, .modulus = NAN, .toughness = NAN})

/* Takes notice of state `number`. */
void LamCrackAdd(LamCrack *crack, const LamMicrostructure *micro, PetscInt number, const LamResponse *response);
/* Sets R, E' and K; first: the load of the first state. */
PetscErrorCode LamCrackConclude(LamCrack *crack, const LamMicrostructure *micro, const LamLoad *first);

#endif
