/*
  Method. A scene gives all of A, as a database does of an F with a small out-of-plane shear; of an F without, a database gives
  all but the entries with an index pair 13, 23, 31 or 32, which are NaN. With such an F they do not enter the rest of
  C, and are left out of the sums by factors that are 0. What remains unknown of C is the stiffness against shear out of
  the plane: C_1313 and C_2323 are set to C_1212, and C_1323 to 0: any value would do, since it multiplies no strain, but
  0 would make a host's matrix singular where it keeps that freedom.
*/
#include "stress.h"
#include <math.h>

static const int First[SIX] = {0, 1, 2, 0, 0, 1}, Second[SIX] = {0, 1, 2, 1, 2, 2};
static const int Component[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

static double Determinant(const double F[9])
{
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}

static void Invert(const double F[9], double inverse[3][3])
{
  const double J = Determinant(F);

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3; /* cofactor of F_ji */

      inverse[i][j] = (F[3 * c + a] * F[3 * d + b] - F[3 * c + b] * F[3 * d + a]) / J;
    }
  }
}

static double MaterialTangent(const double inverse[3][3], const double A[81], const double S[SIX], int a, int b)
{
  const int I = First[a], J = Second[a], K = First[b], L = Second[b];
  double sum = 0;

  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      const double factor = inverse[I][i] * inverse[K][k];

      if (factor != 0) sum += factor * (A[27 * i + 9 * J + 3 * k + L] - (i == k ? S[Component[J][L]] : 0));
    }
  }
  return sum;
}

void StressMaterial(const double F[9], const double P[9], const double A[81], double S[SIX], double C[SIX][SIX])
{
  double inverse[3][3];

  Invert(F, inverse);
  for (int a = 0; a < SIX; a++) {
    S[a] = 0;
    for (int i = 0; i < 3; i++) S[a] += inverse[First[a]][i] * P[3 * i + Second[a]];
  }
  for (int a = 0; a < SIX; a++) /* the mean of both orders: P33 of a database may be interpolated apart */
    for (int b = 0; b < SIX; b++)
      C[a][b] = (MaterialTangent(inverse, A, S, a, b) + MaterialTangent(inverse, A, S, b, a)) / 2;
  for (int a = 0; a < SIX; a++)
    for (int b = 0; b < SIX; b++)
      if (isnan(C[a][b])) C[a][b] = a == b ? C[3][3] : 0;
}

static double PushedForward(const double F[9], double C[SIX][SIX], int a, int b)
{
  const int i = First[a], j = Second[a], k = First[b], l = Second[b];
  double sum = 0;

  for (int I = 0; I < 3; I++)
    for (int J = 0; J < 3; J++)
      for (int K = 0; K < 3; K++)
        for (int L = 0; L < 3; L++)
          sum += F[3 * i + I] * F[3 * j + J] * F[3 * k + K] * F[3 * l + L] * C[Component[I][J]][Component[K][L]];
  return sum;
}

void StressSpatial(const double F[9], const double S[SIX], double C[SIX][SIX], double s[SIX], double jaumann[SIX][SIX])
{
  const double J = Determinant(F);

  for (int a = 0; a < SIX; a++) {
    s[a] = 0;
    for (int I = 0; I < 3; I++)
      for (int K = 0; K < 3; K++) s[a] += F[3 * First[a] + I] * S[Component[I][K]] * F[3 * Second[a] + K] / J;
  }
  for (int a = 0; a < SIX; a++) {
    for (int b = 0; b < SIX; b++) {
      const int i = First[a], j = Second[a], k = First[b], l = Second[b];

      jaumann[a][b] = PushedForward(F, C, a, b) / J + ((i == k) * s[Component[j][l]] + (i == l) * s[Component[j][k]] +
                                                       (j == k) * s[Component[i][l]] + (j == l) * s[Component[i][k]]) /
                                                          2;
    }
  }
}
