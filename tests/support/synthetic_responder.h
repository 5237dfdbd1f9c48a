/*
  A material with known answers, behind the responder table: compressible neo-Hookean tissue under turgor,
    Psi = mu/2 (tr C - 3 - 2 ln J) + lambda/2 (ln J)^2 - (phi p + c p^2 / 2) J,
  whose lumen (phi + c p) J grows with the turgor as that of cells with soft walls.
  It can refuse to answer far from the reference state, or far from the last accepted state of the point.
*/
#ifndef LAM_SUPPORT_SYNTHETIC_RESPONDER_H
#define LAM_SUPPORT_SYNTHETIC_RESPONDER_H

#include <lamella/response.h>
#include <math.h>
#include <string.h>

typedef struct {
  PetscReal mu, lambda, phi, c;
  PetscReal largest_strain;                /* |F - 1| beyond which there is no answer */
  PetscReal largest_step;                  /* |F - F accepted| beyond which there is no answer */
  const char *reason;                      /* why there is none */
  PetscInt points;                         /* of which accepted states are kept */
  PetscReal (*accepted)[9], (*current)[9]; /* [points] */
  PetscInt accepts, rejects, calls;
  LamResponderCounters counters;
  PetscErrorCode (*respond)(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                            LamResponse responses[]); /* SyntheticRespond */
} Synthetic;

PetscReal SyntheticInverseTranspose(const PetscReal F[9], PetscReal G[9]);
void SyntheticEvaluate(const Synthetic *material, const LamLoad *load, LamResponse *response);
PetscErrorCode SyntheticRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                LamResponse responses[]);
/* mu = 1, lambda = 2, phi = 1, c = 0, no limits; *material may be changed afterwards. */
PetscErrorCode SyntheticCreate(PetscInt points, LamResponder *responder, Synthetic **material);

#endif
