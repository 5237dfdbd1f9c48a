/*
  Readings of a mechanical test: the options that ask for them, and what is printed.
*/
#include "app.h"
#include "mechanical_test.h"
#include <math.h>
#include <stdlib.h>

json_t *LamFromInflatedToJSON(const PetscReal F[9], const PetscReal P[9], const LamScales *scales)
{
  return json_pack("{s:o, s:o}", "F", LamJSONReals(9, F, 1), "P", LamJSONReals(9, P, scales->stress * 1e-6));
}

/* Units of stress, modulus, strain and energy, and of energy the factor. */
typedef struct {
  const char *stress, *modulus, *strain, *energy;
  PetscReal factor;
} Units;

static Units UnitsOf(const LamTest *test)
{
  if (!test->is_force) return (Units){"MPa", "MPa", "", "kJ/m^3", test->unit * 1e3};
  if (test->scene->macro.symmetry == LAM_AXISYMMETRIC) return (Units){"N", "N/mm", " mm", "N mm", test->unit};
  return (Units){"N/mm", "MPa", " mm", "N mm/mm", test->unit};
}

static void PrintCurve(const LamTest *test)
{
  const int row = test->component / 3 + 1, column = test->component % 3 + 1;

  if (test->side)
    printf("test: force on %s over its displacement%s", test->side,
           test->is_force ? "" : ", both over edges of the box: apparent stress and strain");
  else
    printf("test: P%d%d over F%d%d%s", row, column, row, column, row == column ? " - 1" : "");
  if (test->inflated && !test->is_force)
    printf(", from the inflated tissue (stretches %.4f and %.4f), per area of the %s", (double)test->F0[0],
           (double)test->F0[4], test->area == LAM_AREA_INFLATED ? "inflated tissue" : "tissue at rest");
  putchar('\n');
}

static void PrintMark(const LamTest *test, const char name[], LamTestMark mark)
{
  const Units units = UnitsOf(test);

  printf("  %s %.4g %s at %.4g%s", name, (double)(mark.stress * test->unit), units.stress, (double)mark.strain,
         units.strain);
}

static void PrintTable(const LamTest *test)
{
  const Units units = UnitsOf(test);
  LamTestReadings r;

  LamTestRead(test, &r);
  PrintCurve(test);
  printf("  modulus %.4g %s at %.4g%s", (double)(r.modulus * test->unit), units.modulus, (double)test->points[0].strain,
         units.strain);
  if (isfinite(r.poisson)) printf(", Poisson's ratio %.3f", (double)r.poisson);
  putchar('\n');
  if (isfinite(r.bioyield.strain)) {
    PrintMark(test, "bioyield", r.bioyield);
    putchar('\n');
  }
  PrintMark(test, r.passed ? "peak" : "no peak; largest", r.peak);
  printf(", energy to it %.4g %s\n", (double)(r.energy_to_peak * units.factor), units.energy);
  printf("  work %.4g %s", (double)(r.work * units.factor), units.energy);
  if (r.returned != 0)
    printf(", of which %.4g %s come back: hysteresis %.2f %%", (double)(r.returned * units.factor), units.energy,
           (double)(100 * (1 - r.returned / r.work)));
  putchar('\n');
}

static void PrintAt(const LamTest *test, PetscReal strain)
{
  const Units units = UnitsOf(test);
  PetscReal stress, secant, tangent;

  if (LamTestAt(test, strain, &stress, &secant, &tangent))
    printf("  at %.4g%s: %s %.4g %s, secant modulus %.4g %s, tangent modulus %.4g %s\n", (double)strain, units.strain,
           test->is_force ? "force" : "stress", (double)(stress * test->unit), units.stress,
           (double)(secant * test->unit), units.modulus, (double)(tangent * test->unit), units.modulus);
  else
    printf("  at %.4g%s: the curve does not come there\n", (double)strain, units.strain);
}

PetscErrorCode LamTestPrint(const LamTest *test, const LamTestOptions *options, PetscBool json)
{
  PetscFunctionBeginUser;
  if (test->count < 2) {
    if (!json) printf("test: there is no curve: fewer than two states of what a load drives are solved\n");
    PetscFunctionReturn(0);
  }
  if (json) {
    PetscCall(LamPrintJSON(json_pack("{s:o}", "test", LamTestToJSON(test, options->count, options->strain))));
    PetscFunctionReturn(0);
  }
  PrintTable(test);
  for (PetscInt k = 0; k < options->count; k++) PrintAt(test, options->strain[k]);
  PetscFunctionReturn(0);
}

/* Numbers between commas; PETSC_FALSE: the text is something else. */
static PetscBool ReadStrains(const char text[], PetscInt *count, PetscReal strain[LAM_MOST_STRAINS])
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

PetscBool LamTestReadOptions(const char command[], LamTestOptions *options, int *exit_status)
{
  if (!options->at) return PETSC_TRUE;
  options->readings = PETSC_TRUE;
  if (!LamListMayBeDecimal(options->at) && ReadStrains(options->at, &options->count, options->strain))
    return PETSC_TRUE;
  (void)LamUsageError(command, exit_status,
                      "--at %s: give at most %d strains, such as --at 0.01,0.05; the decimal sign is the point",
                      options->at, LAM_MOST_STRAINS);
  return PETSC_FALSE;
}
