/* Comparison of responses whose reference or current configurations are turned against each other. */
#ifndef LAM_SUPPORT_TURNED_RESPONSE_H
#define LAM_SUPPORT_TURNED_RESPONSE_H

#include "test.h"
#include "tissue.h"

static const double turned_identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* Q A R^T. */
void TurnTensor(const double Q[9], const double A[9], const double R[9], double out[9]);
void RotationTensor(double angle, double Q[9]);
/* Largest |b - Q a R^T| of the stress. */
double TurnedStressError(const LamResponse *a, const LamResponse *b, const double Q[9], const double R[9]);
/* The same of the in-plane tangent, over its first entry. */
double TurnedTangentError(const LamResponse *a, const LamResponse *b, const double Q[9], const double R[9]);
/* b must be a with the current configuration turned by Q and the reference one by R: P -> Q P R^T, A likewise. */
void AssertTurnedResponse(const LamResponse *a, const LamResponse *b, const double Q[9], const double R[9],
                          double tolerance);

#endif
