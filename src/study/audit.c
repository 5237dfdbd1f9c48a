/*
  Random queries to a database; its responses compared with fresh solves.

  Method
    Principal logarithmic strains, turgor and the angle of the first principal direction are uniform over the box. The
    angle covers all in-plane directions, so that the symmetry used by the database is tested too. The states are
    random, not from the sequence of `build`: at the states of that sequence the database is most accurate.
    Source of the random numbers: splitmix64 (Steele, Lea & Flood, OOPSLA 2014, Figure 12).
*/
#include "audit.h"
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { MOST_ASKED = 1000 };

/* ---- the box ---- */

/* [least, most] of a member of `coverage` in the database's `info`; false if no record is usable. */
static PetscBool ReadRange(const json_t *coverage, const char name[], PetscReal unit, PetscReal range[2])
{
  const json_t *pair = json_object_get(coverage, name);

  for (size_t i = 0; i < 2; i++) range[i] = json_number_value(json_array_get(pair, i)) / unit;
  return (PetscBool)json_is_array(pair);
}

static PetscErrorCode FindCoverage(const LamQuerySource *from, LamAuditBox *box)
{
  const char *text;
  PetscBool found;
  json_t *info, *coverage;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetInfo(from->database, &text));
  info = json_loads(text, 0, NULL);
  coverage = json_object_get(info, "coverage");
  found = (PetscBool)(ReadRange(coverage, "principal_log_strain", 1, box->strain) &&
                      ReadRange(coverage, "turgor", 1e-6 * from->scales.stress, box->turgor));
  json_decref(info);
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no usable record (converged, stable): there is nothing to verify", from->scene->path);
  box->origin = "what its records span";
  PetscFunctionReturn(0);
}

static PetscErrorCode FindBox(const LamQuerySource *from, LamAuditBox *box)
{
  const LamSample *sample = &from->scene->sample;

  PetscFunctionBeginUser;
  *box = (LamAuditBox){.strain = {sample->stretch_min, sample->stretch_max},
                       .turgor = {sample->turgor_min, sample->turgor_max},
                       .cohesion = from->cohesion,
                       .F33 = {1, 1},
                       .origin = "the sample box of its scene"};
  if (!from->scene->has_sample) PetscCall(FindCoverage(from, box));
  if (!(sample->F33_max > sample->F33_min)) PetscFunctionReturn(0);
  box->F33[0] = sample->F33_min;
  box->F33[1] = sample->F33_max;
  PetscFunctionReturn(0);
}

/* ---- queries ---- */

static PetscReal Uniform(uint64_t *state, PetscReal least, PetscReal most)
{
  uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  z ^= z >> 31;
  return least + (most - least) * (PetscReal)(z >> 11) * 0x1p-53;
}

static LamLoad Draw(const LamAuditBox *box, uint64_t *state)
{
  const PetscReal first = Uniform(state, box->strain[0], box->strain[1]);
  const PetscReal second = Uniform(state, box->strain[0], box->strain[1]);
  const PetscReal angle = Uniform(state, 0, PETSC_PI);

  const PetscReal turgor = Uniform(state, box->turgor[0], box->turgor[1]);
  LamLoad load = LamLoadOfStrains(first, second, angle, turgor, box->cohesion);

  if (box->F33[1] > box->F33[0]) load.F[8] = exp(Uniform(state, log(box->F33[0]), log(box->F33[1])));
  return load;
}

static void Count(json_t *counts, const char key[])
{
  json_object_set_new(counts, key, json_integer(1 + json_integer_value(json_object_get(counts, key))));
}

/* Counts a reason with its numbers replaced by '#', since they differ from state to state. */
static void CountReason(json_t *counts, const char reason[])
{
  char key[sizeof(((LamResponse *)0)->reason)];
  size_t n = 0;

  for (const char *at = reason; *at;) {
    const size_t length = strspn(at, "+-.0123456789e");

    if (isdigit((unsigned char)*at) || (strchr("+-.", *at) && isdigit((unsigned char)at[1]))) {
      key[n++] = '#';
      at += length;
    } else {
      key[n++] = *at++;
    }
  }
  key[n] = '\0';
  Count(counts, key);
}

static PetscErrorCode Ask(LamAudit *a)
{
  uint64_t state = (uint64_t)a->seed;

  PetscFunctionBeginUser;
  while (a->answered < a->wanted && a->asked / MOST_ASKED < a->wanted && !LamStopRequested()) {
    const LamLoad load = Draw(&a->box, &state);
    LamResponse answer;

    PetscCall(LamDatabaseQuery(a->from->database, &load, a->accuracy, &answer));
    a->asked++;
    if (answer.status == LAM_CONVERGED)
      a->loads[a->answered++] = load;
    else
      CountReason(a->refused, answer.reason);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamAuditCreate(const LamQuerySource *from, PetscReal accuracy, PetscInt samples, PetscInt seed,
                              LamAudit *audit)
{
  PetscFunctionBeginUser;
  *audit = (LamAudit){.from = from, .accuracy = accuracy, .wanted = samples, .seed = seed};
  audit->refused = json_object();
  audit->unsolved = json_object();
  PetscCall(FindBox(from, &audit->box));
  PetscCall(PetscMalloc1(samples, &audit->loads));
  PetscCall(PetscCalloc1(samples, &audit->results));
  PetscCall(Ask(audit));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAuditDestroy(LamAudit *audit)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(audit->loads));
  PetscCall(PetscFree(audit->results));
  json_decref(audit->refused);
  json_decref(audit->unsolved);
  PetscFunctionReturn(0);
}

/* ---- comparison with solves ---- */

/* Repeats the query: its response (two kilobytes) is not stored. */
PetscErrorCode LamAuditCompare(LamAudit *audit, PetscInt i, const LamResponse *fresh)
{
  LamAudited *result = &audit->results[i];
  LamMicrostructure micro;
  LamStressScale scale;
  LamResponse answer;

  PetscFunctionBeginUser;
  audit->solved++;
  if (fresh->status != LAM_CONVERGED) {
    Count(audit->unsolved, LamStatusNames[fresh->status]);
    PetscFunctionReturn(0);
  }
  PetscCall(LamDatabaseGetMicrostructure(audit->from->database, &micro, NULL, NULL));
  scale = LamStressScaleOf(&micro);
  PetscCall(LamDatabaseQuery(audit->from->database, &audit->loads[i], audit->accuracy, &answer));
  *result = (LamAudited){.compared = PETSC_TRUE,
                         .estimate = answer.error_estimate,
                         .error = LamStressError(scale, answer.P, fresh->P),
                         .axial = audit->box.F33[1] > audit->box.F33[0] ? LamAxialError(scale, answer.P, fresh->P)
                                                                        : (PetscReal)NAN,
                         .tangent = LamTangentError(scale, answer.tangent, fresh->tangent),
                         .tangent_estimate = answer.tangent_error_estimate,
                         .opening = fabs(answer.opening_fraction - fresh->opening_fraction),
                         .lumen = fabs(answer.lumen_fraction - fresh->lumen_fraction),
                         .query_seconds = answer.seconds,
                         .solve_seconds = fresh->seconds};
  PetscFunctionReturn(0);
}
