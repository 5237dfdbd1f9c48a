/*
  Solved states for programs (JSON Lines) and for persons (a table), in physical units.
*/
#include "app.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PASCAL_TO_MPA 1e-6

/* ---- JSON ---- */

json_t *LamJSONReal(PetscReal value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

json_t *LamJSONReals(PetscInt n, const PetscReal values[], PetscReal scale)
{
  json_t *list = json_array();

  for (PetscInt i = 0; i < n; i++) json_array_append_new(list, LamJSONReal(values[i] * scale));
  return list;
}

static void SetReal(json_t *object, const char name[], PetscReal value)
{
  json_object_set_new(object, name, LamJSONReal(value));
}

static void SetInteger(json_t *object, const char name[], PetscInt value)
{
  json_object_set_new(object, name, json_integer(value));
}

static void SetText(json_t *object, const char name[], const char text[])
{
  json_object_set_new(object, name, json_string(text));
}

static void SetInterface(json_t *object, const LamResponse *r, PetscReal MPa)
{
  SetReal(object, "opening_fraction", r->opening_fraction);
  SetReal(object, "debonded_fraction", r->debonded_fraction);
  json_object_set_new(object, "debonded_by_face", LamJSONReals(3, r->debonded_by_face, 1));
  SetReal(object, "open_fraction", r->open_fraction);
  SetReal(object, "max_gap", r->max_gap);
  SetReal(object, "max_traction", r->max_traction * MPa);
  json_object_set_new(object, "mean_face_traction", LamJSONReals(3, r->mean_face_traction, MPa));
  SetInteger(object, "floating_cells", r->floating_cells);
}

static void SetSolution(json_t *object, const LamResponse *r)
{
  json_object_set_new(object, "stable", json_boolean(r->stable));
  SetInteger(object, "negative_eigenvalues", r->negative_eigenvalues);
  SetInteger(object, "branch", r->branch);
  SetInteger(object, "newton_iterations", r->newton_iterations);
  SetInteger(object, "factorisations", r->factorisations);
  SetReal(object, "seconds", r->seconds);
  SetInteger(object, "unknowns", r->unknowns);
  SetReal(object, "error_estimate", r->error_estimate);
  SetText(object, "source", LamSourceNames[r->source]);
}

PetscErrorCode LamResponseToJSON(const LamResponse *response, const LamScales *scales, PetscInt state,
                                 PetscBool tangent, json_t **object)
{
  const PetscReal MPa = scales->stress * PASCAL_TO_MPA;
  json_t *o = json_object();

  PetscFunctionBeginUser;
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a JSON object");
  if (state >= 0) SetInteger(o, "state", state);
  json_object_set_new(o, "F", LamJSONReals(9, response->load.F, 1));
  SetReal(o, "turgor", response->load.turgor * MPa);
  SetReal(o, "cohesion", response->load.cohesion * MPa);
  SetText(o, "status", LamStatusNames[response->status]);
  if (response->status != LAM_CONVERGED) SetText(o, "reason", response->reason);
  SetReal(o, "energy", response->energy * MPa);
  json_object_set_new(o, "P", LamJSONReals(9, response->P, MPa));
  if (tangent) json_object_set_new(o, "tangent", LamJSONReals(81, response->tangent, MPa));
  SetReal(o, "lumen_fraction", response->lumen_fraction);
  SetInterface(o, response, MPa);
  SetSolution(o, response);
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
  printf("%s\n", text);
  free(text);
  PetscCall(FlushOutput());
  PetscFunctionReturn(0);
}

/* ---- table ---- */

PetscErrorCode LamPrintResponseHeader(void)
{
  PetscFunctionBeginUser;
  if (!LamAppIsRoot()) PetscFunctionReturn(0);
  printf("%5s %7s %7s %7s %7s %7s  %-14s %10s %10s %10s %10s %6s %10s %5s %8s\n", "state", "F11", "F12", "F21", "F22",
         "turgor", "status", "P11", "P12", "P21", "P22", "lumen", "traction", "iter.", "time");
  printf("%5s %7s %7s %7s %7s %7s  %-14s %10s %10s %10s %10s %6s %10s %5s %8s\n", "", "", "", "", "", "MPa", "", "MPa",
         "MPa", "MPa", "MPa", "of V0", "MPa", "", "ms");
  PetscCall(FlushOutput());
  PetscFunctionReturn(0);
}

static void PrintStress(PetscReal value)
{
  if (isfinite(value))
    printf(" %10.3e", (double)value);
  else
    printf(" %10s", "-");
}

PetscErrorCode LamPrintResponseRow(const LamResponse *response, const LamScales *scales, PetscInt state)
{
  const PetscReal MPa = scales->stress * PASCAL_TO_MPA, *F = response->load.F;
  const PetscInt in_plane[4] = {0, 1, 3, 4};

  PetscFunctionBeginUser;
  if (!LamAppIsRoot()) PetscFunctionReturn(0);
  printf("%5" PetscInt_FMT, state);
  for (int k = 0; k < 4; k++) printf(" %7.4f", (double)F[in_plane[k]]);
  printf(" %7.4g  %-14s", (double)(response->load.turgor * MPa), LamStatusNames[response->status]);
  for (int k = 0; k < 4; k++) PrintStress(response->P[in_plane[k]] * MPa);
  if (isfinite(response->lumen_fraction))
    printf(" %6.4f", (double)response->lumen_fraction);
  else
    printf(" %6s", "-");
  PrintStress(response->max_traction * MPa);
  printf(" %5" PetscInt_FMT, response->newton_iterations);
  if (PetscIsInfOrNanReal(response->seconds))
    printf(" %8s\n", "-");
  else
    printf(" %8.2f\n", (double)(1e3 * response->seconds));
  if (response->status != LAM_CONVERGED) printf("      %s\n", response->reason);
  PetscCall(FlushOutput());
  PetscFunctionReturn(0);
}
