/* How far P + p J F^-T of bonded tissue depends on the turgor p: what the test asserts and the bench program prints. */
#ifndef LAM_SUPPORT_EFFECTIVE_STRESS_H
#define LAM_SUPPORT_EFFECTIVE_STRESS_H

#include "tissue.h"

/* P + p J F^-T in plane strain, F33 = 1. */
void EffectiveStress(const LamResponse *r, double S[9]);
/* Largest |S(p) - S(0)| / |S(0)| over a few stretched and sheared states, p = 0.05 MPa. */
PetscErrorCode EffectiveStressRemainder(double bulk_modulus, double *remainder);

#endif
