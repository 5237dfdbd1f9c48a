#include "turned_response.h"

void TurnTensor(const double Q[9], const double A[9], const double R[9], double out[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      out[3 * i + j] = 0.0;
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) out[3 * i + j] += Q[3 * i + k] * A[3 * k + l] * R[3 * j + l];
    }
}

void RotationTensor(double angle, double Q[9])
{
  for (int i = 0; i < 9; i++) Q[i] = turned_identity[i];
  Q[0] = Q[4] = cos(angle);
  Q[3] = sin(angle);
  Q[1] = -Q[3];
}

double TurnedStressError(const LamResponse *a, const LamResponse *b, const double Q[9], const double R[9])
{
  double P[9], error = 0.0;

  TurnTensor(Q, a->P, R, P);
  for (int i = 0; i < 9; i++) error = fmax(error, fabs(b->P[i] - P[i]));
  return error;
}

double TurnedTangentError(const LamResponse *a, const LamResponse *b, const double Q[9], const double R[9])
{
  static const int plane[4] = {0, 1, 3, 4};
  double error = 0.0;

  for (int m = 0; m < 4; m++)
    for (int n = 0; n < 4; n++) {
      const int i = plane[m] / 3, j = plane[m] % 3, k = plane[n] / 3, l = plane[n] % 3;
      double expected = 0.0;

      for (int c = 0; c < 16; c++) {
        const int p = c & 1, q = (c >> 1) & 1, r = (c >> 2) & 1, s = (c >> 3) & 1;

        expected += Q[3 * i + p] * R[3 * j + q] * Q[3 * k + r] * R[3 * l + s] * a->tangent[9 * (3 * p + q) + 3 * r + s];
      }
      error = fmax(error, fabs(b->tangent[9 * plane[m] + plane[n]] - expected) / fabs(a->tangent[0]));
    }
  return error;
}

/* Largest |b - Q a Q^T| of a symmetric tensor of the current configuration: 11, 22, 12. */
static double TurnedMomentError(const double a[3], const double b[3], const double Q[9])
{
  const double A[9] = {a[0], a[2], 0, a[2], a[1], 0, 0, 0, 0};
  double B[9];

  TurnTensor(Q, A, Q, B);
  return fmax(fabs(b[0] - B[0]), fmax(fabs(b[1] - B[4]), fabs(b[2] - B[1])));
}

void AssertTurnedResponse(const LamResponse *a, const LamResponse *b, const double Q[9], const double R[9],
                          double tolerance)
{
  assert_int_equal(a->status, LAM_CONVERGED);
  assert_int_equal(b->status, LAM_CONVERGED);
  assert_near(TurnedStressError(a, b, Q, R), 0.0, tolerance);
  assert_near(TurnedTangentError(a, b, Q, R), 0.0, tolerance);
  assert_near(b->energy, a->energy, tolerance);
  assert_near(b->lumen_fraction, a->lumen_fraction, tolerance);
  assert_near(b->opening_fraction, a->opening_fraction, tolerance);
  assert_near(b->debonded_fraction, a->debonded_fraction, tolerance);
  assert_near(b->max_traction, a->max_traction, tolerance);
  assert_near(TurnedMomentError(a->fabric, b->fabric, Q), 0.0, tolerance);
  assert_near(TurnedMomentError(a->opening_moment, b->opening_moment, Q), 0.0, tolerance);
}
