/*
  The output of `info` on a file, as JSON.
*/
#include "database_internal.h"
#include "range.h"
#include "record_json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PA_PER_MPA 1e6

/* Principal logarithmic strains in the plane, from C = F^T F; F: 11 12 21 22. */
static void PrincipalStrains(const PetscReal F[4], PetscReal strain[2])
{
  const PetscReal C11 = F[0] * F[0] + F[2] * F[2], C22 = F[1] * F[1] + F[3] * F[3], C12 = F[0] * F[1] + F[2] * F[3];
  const PetscReal mean = 0.5 * (C11 + C22), radius = hypot(0.5 * (C11 - C22), C12);

  strain[0] = 0.5 * log(mean - radius);
  strain[1] = 0.5 * log(mean + radius);
}

/* Ranges of the converged records, and the number of records of each status. */
typedef struct {
  LamRange strain, turgor, cohesion;
  PetscInt counts[LAM_STATUS_COUNT];
} Summary;

static void Count(Summary *s, LamStatus status, const PetscReal F[4], PetscReal turgor, PetscReal cohesion)
{
  PetscReal principal[2];

  s->counts[status]++;
  if (status != LAM_CONVERGED) return;
  PrincipalStrains(F, principal);
  LamRangeWiden(&s->strain, principal[0]);
  LamRangeWiden(&s->strain, principal[1]);
  LamRangeWiden(&s->turgor, turgor);
  LamRangeWiden(&s->cohesion, cohesion);
}

static void Summarise(LamDatabase db, Summary *s)
{
  const LamRange nothing = {PETSC_INFINITY, PETSC_NINFINITY};

  *s = (Summary){.strain = nothing, .turgor = nothing, .cohesion = nothing};
  for (PetscInt i = 0; i < db->nodes.count; i++) {
    const LamNodeData *node = &db->nodes.data[i];

    Count(s, node->status, node->F, node->turgor, node->cohesion);
  }
  for (PetscInt i = 0; i < db->scatter.n; i++) {
    const LamResponse *r = &db->scatter.records[i];
    const PetscReal F[4] = {r->load.F[0], r->load.F[1], r->load.F[3], r->load.F[4]};

    Count(s, r->status, F, r->load.turgor, r->load.cohesion);
  }
}

/* Stresses in MPa. */
static json_t *Coverage(const LamHeader *h, const Summary *s)
{
  const PetscReal MPa = h->scales.stress / PA_PER_MPA;

  return json_pack("{s:o, s:o, s:o}", "principal_log_strain", LamRangeToJSON(&s->strain, 1), "turgor",
                   LamRangeToJSON(&s->turgor, MPa), "cohesion", LamRangeToJSON(&s->cohesion, MPa));
}

static json_t *Statuses(const Summary *s)
{
  json_t *object = json_object();

  for (int i = 0; i < LAM_STATUS_COUNT; i++)
    if (s->counts[i]) json_object_set_new(object, LamStatusNames[i], json_integer(s->counts[i]));
  return object;
}

static json_t *Microstructures(LamDatabase db)
{
  return json_pack("[{s:s, s:o, s:f, s:f}]", "hash", db->header.hash, "description",
                   json_loads(db->header.description, 0, NULL), "apothem_m", db->header.scales.length, "stress_unit_Pa",
                   db->header.scales.stress);
}

static PetscErrorCode AddTable(LamDatabase db, json_t *object)
{
  LamTable table;
  json_t *described;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetTable(db, &table));
  if (!table) PetscFunctionReturn(0);
  PetscCall(LamTableDescribe(table, db->header.scales.stress / PA_PER_MPA, &described));
  PetscCall(LamTableDestroy(&table));
  json_object_set_new(object, "table", described);
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseGetInfo(LamDatabase db, const char *json[])
{
  const LamHeader *h = &db->header;
  Summary summary;
  json_t *object;
  char *text;

  PetscFunctionBeginUser;
  Summarise(db, &summary);
  object = json_pack("{s:s, s:I, s:I, s:i, s:o, s:o, s:o, s:f}", "kind", h->kind, "records", (json_int_t)db->n,
                     "failed", (json_int_t)(db->n - summary.counts[LAM_CONVERGED]), "format_version", h->format_version,
                     "microstructures", Microstructures(db), "statuses", Statuses(&summary), "coverage",
                     Coverage(h, &summary), "accuracy", h->accuracy);
  json_object_set_new(object, "scattered", json_integer(db->scatter.n));
  PetscCall(AddTable(db, object));
  json_object_set_new(object, "writer", LamWriterToJSON(db->path));
  json_object_set_new(object, "creator", LamTextToJSON(h->creator));
  json_object_set_new(object, "created", LamTextToJSON(h->created));
  json_object_set_new(object, "host", LamTextToJSON(h->host));
  json_object_set_new(object, "command", LamTextToJSON(h->command));
  json_object_set_new(object, "libraries",
                      json_pack("{s:o, s:o, s:o}", "PETSc", LamTextToJSON(h->petsc), "HDF5", LamTextToJSON(h->hdf5),
                                "MPI", LamTextToJSON(h->mpi)));
  text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(15));
  json_decref(object);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "the file's header is damaged: a text in it is not UTF-8");
  PetscCall(PetscFree(db->info));
  PetscCall(PetscStrallocpy(text, &db->info));
  free(text);
  *json = db->info;
  PetscFunctionReturn(0);
}
