/*
  Method. The plane strain of tissue leaves no out-of-plane shear: P and A have none, and A is unknown (NaN) where an
  index pair is 13, 23, 31 or 32. Sums therefore run over pairs within the plane, and 33. The stiffness against shear
  out of the plane, C_1313 = C_2323, is set to C_1212, and C_1323 to 0: any value would do, since it multiplies no
  strain (hosts with such strain are refused), but 0 would make a host's matrix singular where it keeps that freedom.
*/
#include "stress.h"

static const int First[SIX] = {0, 1, 2, 0, 0, 1}, Second[SIX] = {0, 1, 2, 1, 2, 2};
static const int Component[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
enum { PLANE = 4 }; /* 11, 22, 33, 12: components that plane strain has */

/* Of a matrix that couples no direction of the plane with the third. */
static void Invert(const double F[9], double inverse[3][3])
{
  const double J = F[0] * F[4] - F[1] * F[3];
  const double values[3][3] = {{F[4] / J, -F[1] / J, 0}, {-F[3] / J, F[0] / J, 0}, {0, 0, 1 / F[8]}};

  for (int i = 0; i < 9; i++) inverse[i / 3][i % 3] = values[i / 3][i % 3];
}

/* Whether directions i and j are both in the plane, or both out of it. */
static int Coupled(int i, int j)
{
  return (i == 2) == (j == 2);
}

static double MaterialTangent(const double inverse[3][3], const double A[81], const double S[SIX], int a, int b)
{
  const int I = First[a], J = Second[a], K = First[b], L = Second[b];
  double sum = 0;

  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      if (!Coupled(i, I) || !Coupled(k, K)) continue;
      sum += inverse[I][i] * inverse[K][k] * (A[27 * i + 9 * J + 3 * k + L] - (i == k ? S[Component[J][L]] : 0));
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
    for (int i = 0; i < 3 && a < PLANE; i++) S[a] += inverse[First[a]][i] * P[3 * i + Second[a]];
  }
  for (int a = 0; a < SIX; a++) {
    for (int b = 0; b < SIX; b++) {
      const int known = a < PLANE && b < PLANE;

      /* the mean of both orders: P33 of a database is interpolated apart, and not a derivative to the last digit */
      C[a][b] = known ? (MaterialTangent(inverse, A, S, a, b) + MaterialTangent(inverse, A, S, b, a)) / 2 : 0;
    }
  }
  for (int a = PLANE; a < SIX; a++) C[a][a] = C[3][3];
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
  const double J = (F[0] * F[4] - F[1] * F[3]) * F[8];

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
