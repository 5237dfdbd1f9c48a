/*
  Edit distance by dynamic programming over prefixes.
*/
#include "word_distance.h"
#include <string.h>

enum { MAX_WORD = 40 };

PetscInt LamWordDistance(const char a[], const char b[])
{
  const size_t m = strlen(a), n = strlen(b);
  PetscInt d[MAX_WORD + 1][MAX_WORD + 1];

  if (m > MAX_WORD || n > MAX_WORD) return MAX_WORD;
  for (size_t i = 0; i <= m; i++) d[i][0] = (PetscInt)i;
  for (size_t j = 0; j <= n; j++) d[0][j] = (PetscInt)j;
  for (size_t i = 1; i <= m; i++) {
    for (size_t j = 1; j <= n; j++) {
      d[i][j] = PetscMin(PetscMin(d[i - 1][j], d[i][j - 1]) + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = PetscMin(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[m][n];
}
