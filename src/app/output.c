/*
  Output of solved states, as JSON Lines and as a human-readable table, in physical units.
*/
#include "app.h"
#include <lamella/ellipticity.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PASCAL_TO_MPA 1e-6

/* ---- JSON ---- */

/* One member in physical units: stresses in MPa. */
static json_t *MemberToJSON(const LamMember *m, const LamResponse *response, PetscReal MPa)
{
  const char *at = (const char *)response + m->offset;
  const PetscReal scale = PetscPowReal(MPa, m->stress_power);

  switch (m->type) {
  case LAM_MEMBER_REAL:
    return m->count > 1 ? LamJSONReals(m->count, (const PetscReal *)(const void *)at, scale)
                        : LamJSONReal(*(const PetscReal *)(const void *)at * scale);
  case LAM_MEMBER_INT: {
    const PetscInt count = *(const PetscInt *)(const void *)at;

    return count == LAM_UNKNOWN_COUNT ? json_null() : json_integer(count);
  }
  case LAM_MEMBER_BOOL:
    return json_boolean(*(const PetscBool *)(const void *)at);
  case LAM_MEMBER_ENUM:
    return json_string(m->names[*(const int *)(const void *)at]);
  case LAM_MEMBER_TEXT:
    return json_string(at);
  }
  return NULL;
}

/* Whether a member is printed. Derivatives are printed with --tangent, as are quantities that follow from the
   tangent, which a database response always has; reason and distance are printed only for some states. */
static PetscBool IsPrinted(const LamMember *m, const LamResponse *response, PetscBool tangent)
{
  static const char *const derivatives[] = {
      "tangent",    "P_turgor",        "energy_turgor",    "energy_turgor2",
      "P_cohesion", "energy_cohesion", "energy_cohesion2", "energy_turgor_cohesion"};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(derivatives); i++)
    if (!strcmp(m->name, derivatives[i])) return tangent;
  if (!strcmp(m->name, "tangent_error_estimate"))
    return (PetscBool)(tangent && response->source == LAM_SOURCE_DATABASE);
  if (!strcmp(m->name, "ellipticity") || !strncmp(m->name, "localisation", strlen("localisation")))
    return (PetscBool)(tangent || response->source == LAM_SOURCE_DATABASE);
  if (!strcmp(m->name, "reason")) return (PetscBool)(response->status != LAM_CONVERGED);
  if (!strcmp(m->name, "distance")) return (PetscBool)(response->source == LAM_SOURCE_DATABASE);
  return PETSC_TRUE;
}

PetscErrorCode LamResponseToJSON(const LamResponse *response, const LamScales *scales, PetscInt state,
                                 PetscBool tangent, json_t **object)
{
  json_t *o = json_object();

  PetscFunctionBeginUser;
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a JSON object");
  if (state >= 0) json_object_set_new(o, "state", json_integer(state));
  for (const LamMember *m = LamResponseMembers; m->name; m++)
    if (IsPrinted(m, response, tangent))
      json_object_set_new(o, m->name, MemberToJSON(m, response, scales->stress * PASCAL_TO_MPA));
  *object = o;
  PetscFunctionReturn(0);
}

static PetscErrorCode FlushOutput(void)
{
  PetscFunctionBeginUser;
  PetscCheck(!fflush(stdout) && !ferror(stdout), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "standard output: %s",
             strerror(errno));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPrintJSON(json_t *object)
{
  char *text = LamAppIsRoot() ? json_dumps(object, JSON_REAL_PRECISION(17)) : NULL;

  PetscFunctionBeginUser;
  json_decref(object);
  if (!LamAppIsRoot()) PetscFunctionReturn(0);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_LIB, "an object cannot be written as JSON");
  LamConsoleClear();
  printf("%s\n", text);
  free(text);
  PetscCall(FlushOutput());
  PetscFunctionReturn(0);
}

/* The columns of tissue whose cells can part; `broken` is of law lamella. */
static void PrintContactHeader(LamInterfaceLawType interface, const char *const texts[7])
{
  if (!LamCellsPart(interface)) return;
  printf(" %9s %9s %8s", texts[0], texts[1], texts[2]);
  if (interface == LAM_INTERFACE_LAMELLA) printf(" %8s", texts[3]);
  printf(" %8s %9s %8s", texts[4], texts[5], texts[6]);
}

/* The last reason printed in the present table, and its state; empty: none. */
static struct {
  char reason[sizeof(((LamResponse *)0)->reason)];
  PetscInt state;
} printed;

PetscErrorCode LamPrintResponseHeader(LamInterfaceLawType interface, LamSource source)
{
  static const char *const names[7] = {"cohesion", "opening", "debonded", "broken", "open", "largest", "floating"};
  static const char *const units[7] = {"MPa", "of V0", "share", "share", "share", "gap/a", "cells"};
  const PetscBool solve = (PetscBool)(source == LAM_SOURCE_SOLVE);

  PetscFunctionBeginUser;
  if (!LamAppIsRoot()) PetscFunctionReturn(0);
  LamConsoleClear();
  printed.reason[0] = '\0';
  printf("%5s %7s %7s %7s %7s %9s  %-14s %10s %10s %10s %10s %6s %10s", "state", "F11", "F12", "F21", "F22", "turgor",
         "status", "P11", "P12", "P21", "P22", "lumen", "traction");
  PrintContactHeader(interface, names);
  printf(" %s\n", solve ? "iter.     time    error" : "error est. indicators     time");
  printf("%5s %7s %7s %7s %7s %9s  %-14s %10s %10s %10s %10s %6s %10s", "", "", "", "", "", "MPa", "", "MPa", "MPa",
         "MPa", "MPa", "of V0", "MPa");
  PrintContactHeader(interface, units);
  printf(" %s\n", solve ? "            ms        %" : "         %                  us");
  PetscCall(FlushOutput());
  PetscFunctionReturn(0);
}

void LamPrintColumn(int width, int decimals, char notation, PetscReal value)
{
  const char format[] = {' ', '%', '*', '.', '*', notation, '\0'};

  if (isfinite(value))
    printf(format, width, decimals, (double)value);
  else
    printf(" %*s", width, "-");
}

#define NOISE 1e-12 /* what rounding leaves, in C1 + C2, of stresses and forces that are 0 */

PetscReal LamWithoutNoise(PetscReal value)
{
  return fabs(value) < NOISE ? 0 : value;
}

static void PrintContact(const LamResponse *response, LamInterfaceLawType interface, PetscReal MPa)
{
  const PetscReal floating = response->floating_cells == LAM_UNKNOWN_COUNT ? NAN : (PetscReal)response->floating_cells;

  LamPrintColumn(9, 4, 'g', response->load.cohesion * MPa);
  LamPrintColumn(9, 2, 'e', response->opening_fraction);
  LamPrintColumn(8, 4, 'f', response->debonded_fraction);
  if (interface == LAM_INTERFACE_LAMELLA) LamPrintColumn(8, 4, 'f', response->broken_fraction);
  LamPrintColumn(8, 4, 'f', response->open_fraction);
  LamPrintColumn(9, 2, 'e', response->max_gap);
  LamPrintColumn(8, 0, 'f', floating);
}

/* Last columns of a row: the cost of a solve, or the reliability of a database response. */
static void PrintTail(const LamResponse *response)
{
  if (response->source == LAM_SOURCE_SOLVE) {
    printf(" %5" PetscInt_FMT, response->newton_iterations);
    LamPrintColumn(8, 2, 'f', 1e3 * response->seconds);
    LamPrintColumn(8, 3, 'f', 100 * response->error_estimate);
  } else {
    LamPrintColumn(10, 4, 'f', 100 * response->error_estimate);
    printf(" %10s", !LamResponseHasFields(response) ? "-" : response->indicators_trusted ? "trusted" : "doubtful");
    LamPrintColumn(8, 1, 'f', 1e6 * response->seconds);
  }
}

/* False for sealed cells and cells that differ, whose pressures are not the prescribed turgor. */
static PetscBool HasTurgorOfLoad(const LamResponse *r)
{
  const PetscReal rounding = 1e-12 * fabs(r->load.turgor);

  return (PetscBool)(!isfinite(r->turgor_mean) ||
                     (fabs(r->turgor_mean - r->load.turgor) <= rounding && r->turgor_spread <= rounding));
}

/* For tissue that localises over lengths beyond the RVE. */
static void PrintLocalisation(const LamResponse *r, PetscReal MPa)
{
  if (!LamResponseHasFields(r) || !LamEllipticityIsLost(r->ellipticity)) return;
  printf("      the tangent has lost ellipticity (%.3g MPa): the tissue localises, in bands whose normal is at %.1f "
         "degrees and whose sides move at %.1f degrees\n",
         (double)(r->ellipticity * MPa), (double)LamBandAngle(r->localisation_normal),
         (double)LamBandAngle(r->localisation_mode));
}

#define SEEN 0.005 /* share of the contact force that is told */

/* What is not seen in the columns of contact: walls that do not face each other, the end of a branch. */
static void PrintOddContact(const LamResponse *response, PetscReal MPa)
{
  if (response->third_fraction > SEEN)
    printf("      %.2g %% of the contact force acts between walls that do not face each other at rest\n",
           (double)(100 * response->third_fraction));
  if (response->lumen_contact > SEEN)
    printf("      %.2g %% of the contact force acts within lumens\n", (double)(100 * response->lumen_contact));
  if (response->burst_fraction > 0)
    printf("      %.3g %% of the cells have burst; their juice was %.3g of V0\n",
           (double)(100 * response->burst_fraction), (double)response->juice);
  if (response->jumped)
    printf("      the branch of the state before has ended: this is the next minimum, %.3g MPa lower in energy\n",
           (double)(response->energy_released * MPa));
}

/* Texts that differ in their numbers only. */
static PetscBool SameWords(const char a[], const char b[])
{
  static const char digits[] = "0123456789.";

  for (;; a++, b++) {
    a += strspn(a, digits);
    b += strspn(b, digits);
    if (*a != *b || !*a) return (PetscBool)(*a == *b);
  }
}

/* A reason that the last one printed in the table has, too, is replaced by the number of its state. */
static void PrintReason(const char reason[], PetscInt state)
{
  if (SameWords(printed.reason, reason)) {
    printf("      as in state %" PetscInt_FMT "\n", printed.state);
  } else {
    printf("      %s\n", reason);
    snprintf(printed.reason, sizeof(printed.reason), "%s", reason);
    printed.state = state;
  }
}

PetscErrorCode LamPrintResponseRow(const LamResponse *response, const LamScales *scales, LamInterfaceLawType interface,
                                   PetscInt state)
{
  const PetscReal MPa = scales->stress * PASCAL_TO_MPA, *F = response->load.F;
  const PetscInt in_plane[4] = {0, 1, 3, 4};

  PetscFunctionBeginUser;
  if (!LamAppIsRoot()) PetscFunctionReturn(0);
  LamConsoleClear();
  printf("%5" PetscInt_FMT, state);
  for (int k = 0; k < 4; k++) LamPrintColumn(7, 4, 'f', F[in_plane[k]]);
  printf(" %9.4g  %-14s", (double)(response->load.turgor * MPa), LamStatusNames[response->status]);
  for (int k = 0; k < 4; k++) LamPrintColumn(10, 3, 'e', LamWithoutNoise(response->P[in_plane[k]]) * MPa);
  LamPrintColumn(6, 4, 'f', response->lumen_fraction);
  LamPrintColumn(10, 3, 'e', response->max_traction * MPa);
  if (LamCellsPart(interface)) PrintContact(response, interface, MPa);
  PrintTail(response);
  putchar('\n');
  if (LamResponseHasFields(response) && F[8] != 1)
    printf("      F33 %.4f, P33 %.3e MPa\n", (double)F[8], (double)(LamWithoutNoise(response->P[8]) * MPa));
  for (int k = 0; k < 4; k++) {
    static const int out_of_plane[4] = {2, 5, 6, 7};
    const int c = out_of_plane[k], i = c / 3 + 1, j = c % 3 + 1;

    if (LamResponseHasFields(response) && F[c] != 0)
      printf("      F%d%d %.4f, P%d%d %.3e MPa\n", i, j, (double)F[c], i, j,
             (double)(LamWithoutNoise(response->P[c]) * MPa));
  }
  if (LamResponseHasFields(response) && !HasTurgorOfLoad(response))
    printf("      pressure in the lumens %.4g MPa, spread %.3g MPa\n", (double)(response->turgor_mean * MPa),
           (double)(response->turgor_spread * MPa));
  PrintOddContact(response, MPa);
  PrintLocalisation(response, MPa);
  if (response->status != LAM_CONVERGED) PrintReason(response->reason, state);
  PetscCall(FlushOutput());
  PetscFunctionReturn(0);
}
