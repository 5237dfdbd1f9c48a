/*
  Readings of a mechanical test as JSON. Stresses in MPa, energies in kJ/m^3; of a body that is no box forces in N/mm
  and energies in N mm/mm, of an axisymmetric one N and N mm.
*/
#include "mechanical_test.h"
#include "json.h"
#include <math.h>

static json_t *MarkToJSON(const LamTest *test, LamTestMark mark)
{
  if (!isfinite(mark.strain)) return json_null();
  return json_pack("{s:o, s:o}", test->is_force ? "displacement" : "strain", LamJSONReal(mark.strain),
                   test->is_force ? "reaction" : "stress", LamJSONReal(mark.stress * test->unit));
}

static json_t *AtToJSON(const LamTest *test, PetscReal strain)
{
  PetscReal stress = NAN, secant = NAN, tangent = NAN;

  (void)LamTestAt(test, strain, &stress, &secant, &tangent);
  return json_pack("{s:o, s:o, s:o, s:o}", test->is_force ? "displacement" : "strain", LamJSONReal(strain),
                   test->is_force ? "reaction" : "stress", LamJSONReal(stress * test->unit), "secant_modulus",
                   LamJSONReal(secant * test->unit), "tangent_modulus", LamJSONReal(tangent * test->unit));
}

/* What the curve is of. */
static json_t *CurveToJSON(const LamTest *test)
{
  const char component[3] = {(char)('1' + test->component / 3), (char)('1' + test->component % 3), '\0'};
  json_t *o;

  o = test->side ? json_pack("{s:s}", "boundary", test->side) : json_pack("{s:s}", "component", component);
  if (test->is_force) return o;
  if (test->inflated) json_object_set_new(o, "F_inflated", LamJSONReals(9, test->F0, 1));
  json_object_set_new(o, "reference", json_string(LamAreaNames[test->area]));
  return o;
}

json_t *LamTestToJSON(const LamTest *test, PetscInt count, const PetscReal strain[])
{
  const PetscReal energy = test->unit * (test->is_force ? 1 : 1e3);
  json_t *o = CurveToJSON(test), *at = json_array();
  LamTestReadings r;

  LamTestRead(test, &r);
  for (PetscInt k = 0; k < count; k++) json_array_append_new(at, AtToJSON(test, strain[k]));
  json_object_update_new(o, json_pack("{s:o, s:o, s:o, s:o, s:b, s:o, s:o, s:o, s:o}", "modulus",
                                      LamJSONReal(r.modulus * test->unit), "poisson", LamJSONReal(r.poisson),
                                      "bioyield", MarkToJSON(test, r.bioyield), "peak", MarkToJSON(test, r.peak),
                                      "peak_passed", r.passed, "energy_to_peak", LamJSONReal(r.energy_to_peak * energy),
                                      "work", LamJSONReal(r.work * energy), "returned",
                                      LamJSONReal(r.returned * energy), "at", at));
  return o;
}
