/*
  What `info` tells of a file, as JSON.
*/
#include "database_internal.h"
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PA_PER_MPA 1e6

typedef struct {
  PetscReal least, most;
} Range;

static void Widen(Range *range, PetscReal value)
{
  range->least = PetscMin(range->least, value);
  range->most = PetscMax(range->most, value);
}

/* An empty range is null: min > max would not be finite. */
static json_t *RangeToJSON(const Range *range, PetscReal scale)
{
  return range->least <= range->most ? json_pack("[f, f]", range->least * scale, range->most * scale) : json_null();
}

/* Principal logarithmic strains in the plane, from C = F^T F. */
static void PrincipalStrains(const PetscReal F[9], PetscReal strain[2])
{
  const PetscReal C11 = F[0] * F[0] + F[3] * F[3], C22 = F[1] * F[1] + F[4] * F[4], C12 = F[0] * F[1] + F[3] * F[4];
  const PetscReal mean = 0.5 * (C11 + C22), radius = hypot(0.5 * (C11 - C22), C12);

  strain[0] = 0.5 * log(mean - radius);
  strain[1] = 0.5 * log(mean + radius);
}

/* What the usable records span, stresses in MPa. */
static json_t *Coverage(LamDatabase db)
{
  const PetscReal MPa = db->header.scales.stress / PA_PER_MPA;
  Range strain = {PETSC_INFINITY, PETSC_NINFINITY}, turgor = strain, cohesion = strain;

  for (PetscInt i = 0; i < db->n; i++) {
    const LamResponse *r = &db->records[i];
    PetscReal principal[2];

    if (r->status != LAM_CONVERGED) continue;
    PrincipalStrains(r->load.F, principal);
    Widen(&strain, principal[0]);
    Widen(&strain, principal[1]);
    Widen(&turgor, r->load.turgor);
    Widen(&cohesion, r->load.cohesion);
  }
  return json_pack("{s:o, s:o, s:o}", "principal_log_strain", RangeToJSON(&strain, 1), "turgor",
                   RangeToJSON(&turgor, MPa), "cohesion", RangeToJSON(&cohesion, MPa));
}

/* Records by status; *failed counts all but the converged. */
static json_t *Statuses(LamDatabase db, PetscInt *failed)
{
  PetscInt counts[LAM_STATUS_COUNT] = {0};
  json_t *object = json_object();

  for (PetscInt i = 0; i < db->n; i++) counts[db->records[i].status]++;
  for (int s = 0; s < LAM_STATUS_COUNT; s++)
    if (counts[s]) json_object_set_new(object, LamStatusNames[s], json_integer(counts[s]));
  *failed = db->n - counts[LAM_CONVERGED];
  return object;
}

static json_t *Microstructures(LamDatabase db)
{
  return json_pack("[{s:s, s:o, s:f, s:f}]", "hash", db->header.hash, "description",
                   json_loads(db->header.description, 0, NULL), "apothem_m", db->header.scales.length, "stress_unit_Pa",
                   db->header.scales.stress);
}

/* Text that may hold anything, as a command line may: null where it is not UTF-8. */
static json_t *Text(const char text[])
{
  json_t *string = text ? json_string(text) : NULL;

  return string ? string : json_null();
}

PetscErrorCode LamDatabaseDescribe(LamDatabase db, char **json)
{
  const LamHeader *h = &db->header;
  PetscInt failed;
  json_t *statuses = Statuses(db, &failed), *object;
  char *text;

  PetscFunctionBeginUser;
  object = json_pack("{s:s, s:I, s:I, s:i, s:o, s:o, s:o, s:f}", "kind", h->kind, "records", (json_int_t)db->n,
                     "failed", (json_int_t)failed, "format_version", (int)h->format_version, "microstructures",
                     Microstructures(db), "statuses", statuses, "coverage", Coverage(db), "accuracy", h->accuracy);
  json_object_set_new(object, "creator", Text(h->creator));
  json_object_set_new(object, "created", Text(h->created));
  json_object_set_new(object, "host", Text(h->host));
  json_object_set_new(object, "command", Text(h->command));
  json_object_set_new(
      object, "libraries",
      json_pack("{s:o, s:o, s:o}", "PETSc", Text(h->petsc), "HDF5", Text(h->hdf5), "MPI", Text(h->mpi)));
  text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(15));
  json_decref(object);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "the file's header is damaged: a text in it is not UTF-8");
  PetscCall(PetscStrallocpy(text, json));
  free(text);
  PetscFunctionReturn(0);
}
