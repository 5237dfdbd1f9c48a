/*
  Parses queries from the command line and from standard input.
*/
#include "query_source.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#define GAPS " \t\r\n\f\v,"
#define WANTED "4 or 9 numbers are wanted, such as 1 0.1 0 1, and may be followed by a turgor, 0.02 MPa, and a cohesion"

static PetscBool EndsWord(char c)
{
  return (PetscBool)(c == '\0' || c == ';' || strchr(GAPS, c));
}

static PetscBool BeginsNumber(char c)
{
  return (PetscBool)(isdigit((unsigned char)c) || c == '+' || c == '-' || c == '.');
}

/* Whether the number at `at` has a unit: in the same word or in the next. */
static PetscBool HasUnit(const char at[])
{
  char *end;

  (void)strtod(at, &end);
  if (end == at) return PETSC_FALSE;
  if (!EndsWord(*end)) return PETSC_TRUE;
  end += strspn(end, GAPS);
  return (PetscBool)(*end && *end != ';' && !BeginsNumber(*end));
}

/* Reads numbers up to a semicolon or the first quantity with a unit; *rest points there. */
static PetscBool ReadNumbers(const char text[], PetscReal numbers[9], int *n, const char **rest,
                             char problem[LAM_PROBLEM_LENGTH])
{
  const char *at = text + strspn(text, GAPS);
  char *end;

  for (*n = 0; *at && *at != ';'; at = end + strspn(end, GAPS)) {
    if ((*n == 4 || *n == 9) && HasUnit(at)) break;
    if (*n == 9) {
      snprintf(problem, LAM_PROBLEM_LENGTH, "more than 9 numbers; " WANTED);
      return PETSC_FALSE;
    }
    numbers[(*n)++] = strtod(at, &end);
    if (end != at && EndsWord(*end)) continue;
    snprintf(problem, LAM_PROBLEM_LENGTH, "\"%.*s\" is no number; " WANTED, (int)PetscMin(strcspn(at, GAPS ";"), 20),
             at);
    return PETSC_FALSE;
  }
  *rest = at;
  return PETSC_TRUE;
}

static PetscBool ReadDeformation(const char text[], PetscReal F[9], const char **rest, char problem[LAM_PROBLEM_LENGTH])
{
  PetscReal numbers[9];
  int n;

  if (!ReadNumbers(text, numbers, &n, rest, problem)) return PETSC_FALSE;
  if (n != 4 && n != 9) {
    snprintf(problem, LAM_PROBLEM_LENGTH, "%d number%s%s; " WANTED, n, n == 1 ? "" : "s",
             strchr(text, ',') ? " (the decimal sign is the point)" : "");
    return PETSC_FALSE;
  }
  for (int i = 0; i < 9; i++) F[i] = n == 9 ? numbers[i] : i == 8;
  for (int i = 0; n == 4 && i < 4; i++) F[3 * (i / 2) + i % 2] = numbers[i];
  return PETSC_TRUE;
}

/* Position after the quantity at `at`: a semicolon, the next number, or the end. */
static const char *QuantityEnd(const char at[])
{
  for (;;) {
    at += strcspn(at, GAPS ";");
    at += strspn(at, GAPS);
    if (!*at || *at == ';' || BeginsNumber(*at)) return at;
  }
}

static PetscBool ReadStress(const char text[], int length, const LamScales *scales, PetscReal *stress,
                            char problem[LAM_PROBLEM_LENGTH])
{
  char quantity[64];
  PetscReal pascal;

  snprintf(quantity, sizeof(quantity), "%.*s", length, text);
  if (LamQuantityParse(quantity, LAM_DIMENSION_STRESS, &pascal)) {
    snprintf(problem, LAM_PROBLEM_LENGTH, "\"%s\" is no stress with its unit, such as 0.02 MPa", quantity);
    return PETSC_FALSE;
  }
  *stress = pascal / scales->stress;
  return PETSC_TRUE;
}

PetscBool LamQueryParse(const char text[], const LamScales *scales, LamLoad *load, char problem[LAM_PROBLEM_LENGTH])
{
  PetscReal *const stresses[] = {&load->turgor, &load->cohesion};
  const char *at, *end;

  if (!ReadDeformation(text, load->F, &at, problem)) return PETSC_FALSE;
  for (size_t i = 0; *at; at = end, i++) {
    if (*at == ';') at++;
    at += strspn(at, GAPS);
    end = QuantityEnd(at);
    if (i == PETSC_STATIC_ARRAY_LENGTH(stresses)) {
      snprintf(problem, LAM_PROBLEM_LENGTH, "\"%.20s\" is more than a turgor and a cohesion", at);
      return PETSC_FALSE;
    }
    if (!ReadStress(at, (int)(end - at), scales, stresses[i], problem)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
