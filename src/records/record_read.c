/*
  Reading record files: the header. Every size and type is checked before it is used.
*/
#include "record_internal.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- header ---- */

PetscErrorCode LamHeaderDestroy(LamHeader *header)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(header->command));
  PetscCall(PetscFree(header->description));
  PetscCall(LamMicrostructureDestroy(&header->micro));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadProvenance(const char path[], hid_t file, LamHeader *h)
{
  PetscFunctionBeginUser;
  PetscCall(LamAttributeCopyText(path, file, "creator", sizeof(h->creator), h->creator));
  PetscCall(LamAttributeCopyText(path, file, "created", sizeof(h->created), h->created));
  PetscCall(LamAttributeCopyText(path, file, "host", sizeof(h->host), h->host));
  PetscCall(LamAttributeCopyText(path, file, "petsc_version", sizeof(h->petsc), h->petsc));
  PetscCall(LamAttributeCopyText(path, file, "hdf5_version", sizeof(h->hdf5), h->hdf5));
  PetscCall(LamAttributeCopyText(path, file, "mpi_version", sizeof(h->mpi), h->mpi));
  PetscCall(LamAttributeReadText(path, file, "command", &h->command));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadScales(const char path[], hid_t file, LamHeader *h)
{
  const struct {
    const char *name;
    PetscReal *value;
    PetscBool is_unit; /* positive, however small */
  } rows[] = {{"length_unit_m", &h->scales.length, PETSC_TRUE},
              {"stress_unit_Pa", &h->scales.stress, PETSC_TRUE},
              {"macro_length_unit_m", &h->scales.macro_length, PETSC_FALSE},
              {"accuracy", &h->accuracy, PETSC_FALSE}};

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
    PetscCall(LamAttributeReadNumber(path, file, rows[i].name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rows[i].value));
    PetscCheck(isfinite(*rows[i].value) && *rows[i].value >= 0 && (!rows[i].is_unit || *rows[i].value > 0),
               PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: attribute \"%s\" is %g; the file is damaged", path,
               rows[i].name, (double)*rows[i].value);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadMicrostructure(const char path[], hid_t file, LamHeader *h)
{
  char name[64], hash[LAM_HASH_LENGTH], *json;
  H5G_info_t info;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeCopyText(path, file, "microstructure", sizeof(h->hash), h->hash));
  snprintf(name, sizeof(name), "/microstructures/%s/description", h->hash);
  PetscCall(LamFileGetText(path, file, name, &h->description));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Gget_info_by_name(file, "/microstructures", &info, H5P_DEFAULT));
  PetscCheck(info.nlinks == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds %d microstructures; this version reads files of one", path, (int)info.nlinks);
  PetscCall(LamMicrostructureParse(path, h->description, &h->micro));
  PetscCall(LamMicrostructureDescribe(&h->micro, &json, hash));
  PetscCall(PetscFree(json));
  PetscCheck(!strcmp(hash, h->hash), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the description of microstructure %s has been changed (its hash is %s)", path, h->hash, hash);
  PetscFunctionReturn(0);
}

/* Another version may have other attributes, so the version goes before the checksum. */
static PetscErrorCode CheckFormat(const char path[], hid_t file, PetscInt *format_version)
{
  char format[16] = "";
  PetscBool has;
  int version;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeHas(path, file, "format", &has));
  if (has) PetscCall(LamAttributeCopyText(path, file, "format", sizeof(format), format));
  PetscCheck(!strcmp(format, LAM_FORMAT_NAME), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: was not written by lamella (attribute \"format\" is \"%s\", not \"%s\")", path, format,
             LAM_FORMAT_NAME);
  PetscCall(LamAttributeReadNumber(path, file, "format_version", H5T_STD_I32LE, H5T_NATIVE_INT, &version));
  PetscCheck(version == LAM_FORMAT_VERSION, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has format version %d; this lamella reads version %d", path, version, LAM_FORMAT_VERSION);
  *format_version = version;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckSum(const char path[], hid_t file, PetscBool *matches)
{
  PetscBool sound;
  uint32_t sum;

  PetscFunctionBeginUser;
  PetscCall(LamHeaderSum(path, file, &sum));
  PetscCall(LamSumMatches(path, file, LAM_SUM, sum, &sound));
  if (matches) *matches = sound;
  PetscCheck(sound || matches, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the header is damaged (an attribute of the root has been changed: its checksum differs)" LAM_SALVAGE,
             path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeaderReadRoot(const char path[], hid_t file, PetscBool *matches, LamHeader *header)
{
  PetscFunctionBeginUser;
  memset(header, 0, sizeof(*header));
  PetscCall(CheckFormat(path, file, &header->format_version));
  PetscCall(LamAttributeCopyText(path, file, "kind", sizeof(header->kind), header->kind));
  PetscCall(ReadProvenance(path, file, header));
  PetscCall(ReadScales(path, file, header));
  PetscCall(CheckSum(path, file, matches));
  PetscCall(ReadMicrostructure(path, file, header));
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeaderRead(const char path[], hid_t file, LamHeader *header)
{
  PetscFunctionBeginUser;
  PetscCall(LamHeaderReadRoot(path, file, NULL, header));
  PetscCall(LamCommittedRead(path, file, &header->committed));
  PetscFunctionReturn(0);
}
