/*
  Attributes of record files: texts and numbers of exactly the types that Lamella writes. Other types are rejected
  before HDF5 reads a value.
*/
#include "record_internal.h"
#include <string.h>

#define TEXT_BYTES 65536 /* HDF5's limit for attributes */

/* ---- writing ---- */

PetscErrorCode LamAttributeWriteNumber(const char path[], hid_t object, const char name[], hid_t file_type,
                                       hid_t memory_type, const void *value)
{
  hid_t space, attribute;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Screate(H5S_SCALAR));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE,
              attribute = H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Awrite(attribute, memory_type, value));
  PetscCall(LamCloseHDF5(path, attribute, space));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTextTypeCreate(const char path[], const char text[], hid_t *type)
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, *type = H5Tcopy(H5T_C_S1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tset_size(*type, strlen(text) + 1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tset_cset(*type, H5T_CSET_UTF8));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeWriteText(const char path[], hid_t object, const char name[], const char text[])
{
  hid_t type;

  PetscFunctionBeginUser;
  PetscCall(LamTextTypeCreate(path, text, &type));
  PetscCall(LamAttributeWriteNumber(path, object, name, type, type, text));
  PetscCall(LamCloseHDF5(path, type));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeUpdate(const char path[], hid_t object, const char name[], hid_t memory_type,
                                  const void *value)
{
  hid_t attribute;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, attribute = H5Aopen(object, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Awrite(attribute, memory_type, value));
  PetscCall(LamCloseHDF5(path, attribute));
  PetscFunctionReturn(0);
}

/* ---- reading ---- */

PetscErrorCode LamAttributeHas(const char path[], hid_t object, const char name[], PetscBool *has)
{
  htri_t exists;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, exists = H5Aexists(object, name));
  *has = (PetscBool)(exists > 0);
  PetscFunctionReturn(0);
}

typedef struct {
  hid_t attribute, type, space;
} Opened;

static PetscErrorCode Open(const char path[], hid_t object, const char name[], Opened *o)
{
  PetscBool has;

  PetscFunctionBeginUser;
  *o = (Opened){H5I_INVALID_HID, H5I_INVALID_HID, H5I_INVALID_HID};
  PetscCall(LamAttributeHas(path, object, name, &has));
  PetscCheck(has, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is missing; the file is damaged or was not written by lamella", path, name);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->attribute = H5Aopen(object, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->type = H5Aget_type(o->attribute));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->space = H5Aget_space(o->attribute));
  PetscCheck(H5Sget_simple_extent_type(o->space) == H5S_SCALAR, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is not one value" LAM_FOREIGN, path, name);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadNumber(const char path[], const char name[], const Opened *o, hid_t file_type,
                                 hid_t memory_type, void *value)
{
  PetscFunctionBeginUser;
  PetscCheck(H5Tequal(o->type, file_type) > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is of another type than lamella writes" LAM_FOREIGN, path, name);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Aread(o->attribute, memory_type, value));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeReadNumber(const char path[], hid_t object, const char name[], hid_t file_type,
                                      hid_t memory_type, void *value)
{
  PetscErrorCode ierr;
  Opened o;

  PetscFunctionBeginUser;
  ierr = Open(path, object, name, &o);
  if (!ierr) ierr = ReadNumber(path, name, &o, file_type, memory_type, value);
  PetscCall(LamCloseHDF5(path, o.space, o.type, o.attribute));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Allocates *text, also if it cannot be read. */
static PetscErrorCode ReadText(const char path[], const char name[], const Opened *o, char **text)
{
  PetscFunctionBeginUser;
  PetscCheck(
      H5Tget_class(o->type) == H5T_STRING && H5Tis_variable_str(o->type) == 0 && H5Tget_size(o->type) <= TEXT_BYTES,
      PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: attribute \"%s\" is not a text of fixed length" LAM_FOREIGN, path, name);
  PetscCall(PetscCalloc(H5Tget_size(o->type) + 1, text));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Aread(o->attribute, o->type, *text));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeReadText(const char path[], hid_t object, const char name[], char **text)
{
  PetscErrorCode ierr;
  Opened o;

  PetscFunctionBeginUser;
  *text = NULL;
  ierr = Open(path, object, name, &o);
  if (!ierr) ierr = ReadText(path, name, &o, text);
  if (ierr) PetscCall(PetscFree(*text));
  PetscCall(LamCloseHDF5(path, o.space, o.type, o.attribute));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
