/*
  Reads single arrays and texts, opening the file for each.
*/
#include "record_internal.h"
#include <string.h>

/* Exactly one of the three is read. */
typedef struct {
  const char *array, *text; /* a name, or NULL */
  hid_t type;               /* of the array's values in the file */
  LamFileArray values;
  char *kind; /* [LAM_NAME_LENGTH], or NULL */
} Request;

static PetscErrorCode GetKind(const char path[], hid_t file, char kind[LAM_NAME_LENGTH])
{
  LamHeader header;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = LamHeaderRead(path, file, &header);
  if (!ierr) ierr = PetscStrncpy(kind, header.kind, LAM_NAME_LENGTH);
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Get(const char path[], hid_t file, void *ctx)
{
  Request *r = ctx;

  PetscFunctionBeginUser;
  if (r->kind) PetscCall(GetKind(path, file, r->kind));
  if (r->array) PetscCall(LamFileGetArray(path, file, r->array, r->type, &r->values));
  if (r->text) PetscCall(LamFileHas(path, file, r->text, &r->values.found));
  if (r->text && r->values.found) PetscCall(LamFileGetText(path, file, r->text, (char **)&r->values.values));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadReals(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                PetscInt dims[4], PetscReal **values)
{
  Request r = {.array = name, .type = H5T_IEEE_F64LE};

  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, Get, &r));
  *found = r.values.found;
  *rank = r.values.rank;
  *values = r.values.values;
  PetscCall(PetscArraycpy(dims, r.values.dims, r.values.rank));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadInts(const char path[], const char name[], PetscBool *found, PetscInt *rank, PetscInt dims[4],
                               PetscInt **values)
{
  Request r = {.array = name, .type = H5T_STD_I64LE};

  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, Get, &r));
  *found = r.values.found;
  *rank = r.values.rank;
  *values = NULL;
  if (!r.values.found) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(dims, r.values.dims, r.values.rank));
  PetscCall(PetscMalloc1(r.values.count + 1, values));
  for (PetscInt i = 0; i < r.values.count; i++) (*values)[i] = (PetscInt)((const PetscInt64 *)r.values.values)[i];
  PetscCall(PetscFree(r.values.values));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadText(const char path[], const char name[], PetscBool *found, char **text)
{
  Request r = {.text = name};

  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, Get, &r));
  *found = r.values.found;
  *text = r.values.values;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadKind(const char path[], char kind[LAM_NAME_LENGTH])
{
  Request r = {.kind = kind};

  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, Get, &r));
  PetscFunctionReturn(0);
}
