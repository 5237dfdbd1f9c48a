/*
  Readings of a mechanical test, human-readable and as JSON. Stresses in MPa, energies in kJ/m^3.
*/
#include "app.h"
#include "mechanical_test.h"
#include <math.h>
#include <stdlib.h>

static void SetMark(json_t *object, const char name[], LamTestMark mark, PetscReal MPa)
{
  json_t *o = isfinite(mark.strain) ? json_object() : json_null();

  if (isfinite(mark.strain)) {
    json_object_set_new(o, "strain", LamJSONReal(mark.strain));
    json_object_set_new(o, "stress", LamJSONReal(mark.stress * MPa));
  }
  json_object_set_new(object, name, o);
}

static PetscErrorCode PrintObject(const LamTest *test, const LamTestReadings *r, json_t *at, PetscReal MPa)
{
  const int row = test->component / 3 + 1, column = test->component % 3 + 1;
  json_t *o = json_object(), *object = json_object();
  char component[3] = {(char)('0' + row), (char)('0' + column), '\0'};

  PetscFunctionBeginUser;
  json_object_set_new(o, "component", json_string(component));
  if (test->scene->inflate) json_object_set_new(o, "F_inflated", LamJSONReals(9, test->F0, 1));
  json_object_set_new(o, "reference", json_string(LamAreaNames[test->scene->area]));
  json_object_set_new(o, "modulus", LamJSONReal(r->modulus * MPa));
  json_object_set_new(o, "poisson", LamJSONReal(r->poisson));
  SetMark(o, "bioyield", r->bioyield, MPa);
  SetMark(o, "peak", r->peak, MPa);
  json_object_set_new(o, "peak_passed", json_boolean(r->passed));
  json_object_set_new(o, "energy_to_peak", LamJSONReal(r->energy_to_peak * MPa * 1e3));
  json_object_set_new(o, "work", LamJSONReal(r->work * MPa * 1e3));
  json_object_set_new(o, "returned", LamJSONReal(r->returned * MPa * 1e3));
  json_object_set_new(o, "at", at);
  json_object_set_new(object, "test", o);
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

static void PrintTable(const LamTest *test, const LamTestReadings *r, PetscReal MPa)
{
  const int row = test->component / 3 + 1, column = test->component % 3 + 1;
  const PetscReal kJ = MPa * 1e3;

  printf("test: P%d%d over F%d%d%s", row, column, row, column, row == column ? " - 1" : "");
  if (test->scene->inflate)
    printf(", from the inflated tissue (stretches %.4f and %.4f), per area of the %s", (double)test->F0[0],
           (double)test->F0[4], test->scene->area == LAM_AREA_INFLATED ? "inflated tissue" : "tissue at rest");
  printf("\n  modulus %.4g MPa at %.4g", (double)(r->modulus * MPa), (double)test->points[0].strain);
  if (isfinite(r->poisson)) printf(", Poisson's ratio %.3f", (double)r->poisson);
  putchar('\n');
  if (isfinite(r->bioyield.strain))
    printf("  bioyield %.4g MPa at %.4g\n", (double)(r->bioyield.stress * MPa), (double)r->bioyield.strain);
  printf("  %s %.4g MPa at %.4g, energy to it %.4g kJ/m^3\n", r->passed ? "peak" : "no peak; largest",
         (double)(r->peak.stress * MPa), (double)r->peak.strain, (double)(r->energy_to_peak * kJ));
  printf("  work %.4g kJ/m^3", (double)(r->work * kJ));
  if (r->returned != 0)
    printf(", of which %.4g kJ/m^3 come back: hysteresis %.2f %%", (double)(r->returned * kJ),
           (double)(100 * (1 - r->returned / r->work)));
  putchar('\n');
}

static void PrintAt(const LamTest *test, PetscReal strain, PetscReal MPa)
{
  PetscReal stress, secant, tangent;

  if (LamTestAt(test, strain, &stress, &secant, &tangent))
    printf("  at %.4g: stress %.4g MPa, secant modulus %.4g MPa, tangent modulus %.4g MPa\n", (double)strain,
           (double)(stress * MPa), (double)(secant * MPa), (double)(tangent * MPa));
  else
    printf("  at %.4g: the curve does not come there\n", (double)strain);
}

static json_t *AtToJSON(const LamTest *test, PetscReal strain, PetscReal MPa)
{
  PetscReal stress = NAN, secant = NAN, tangent = NAN;
  json_t *o = json_object();

  (void)LamTestAt(test, strain, &stress, &secant, &tangent);
  json_object_set_new(o, "strain", LamJSONReal(strain));
  json_object_set_new(o, "stress", LamJSONReal(stress * MPa));
  json_object_set_new(o, "secant_modulus", LamJSONReal(secant * MPa));
  json_object_set_new(o, "tangent_modulus", LamJSONReal(tangent * MPa));
  return o;
}

PetscErrorCode LamTestPrint(const LamTest *test, PetscInt count, const PetscReal strain[], PetscBool json)
{
  const PetscReal MPa = test->scene->scales.stress * 1e-6;
  LamTestReadings readings;
  json_t *at;

  PetscFunctionBeginUser;
  if (test->count < 2) {
    if (!json) printf("test: there is no curve: fewer than two states of a changing component of F or P are solved\n");
    PetscFunctionReturn(0);
  }
  LamTestRead(test, &readings);
  if (!json) {
    PrintTable(test, &readings, MPa);
    for (PetscInt k = 0; k < count; k++) PrintAt(test, strain[k], MPa);
    PetscFunctionReturn(0);
  }
  at = json_array();
  for (PetscInt k = 0; k < count; k++) json_array_append_new(at, AtToJSON(test, strain[k], MPa));
  PetscCall(PrintObject(test, &readings, at, MPa));
  PetscFunctionReturn(0);
}

PetscBool LamTestReadStrains(const char text[], PetscInt *count, PetscReal strain[LAM_MOST_STRAINS])
{
  char *end;

  for (*count = 0; *count < LAM_MOST_STRAINS;) {
    strain[*count] = strtod(text, &end);
    if (end == text || !isfinite(strain[*count])) return PETSC_FALSE;
    ++*count;
    if (!*end) return PETSC_TRUE;
    if (*end != ',') return PETSC_FALSE;
    text = end + 1;
  }
  return PETSC_FALSE;
}
