/*
  Attributes of record files: texts and numbers of exactly the types that lamella writes. Anything else is refused
  before HDF5 is asked for a value.
*/
#include "record_internal.h"
#include <string.h>

#define TEXT_BYTES 65536 /* HDF5 keeps no more beside an object */

/* ---- writing ---- */

static PetscErrorCode Create(const char path[], hid_t object, const char name[], hid_t type, hid_t memory_type,
                             const void *value)
{
  hid_t space, attribute;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Screate(H5S_SCALAR));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Awrite(attribute, memory_type, value));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Aclose(attribute));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sclose(space));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeWriteText(const char path[], hid_t object, const char name[], const char text[])
{
  hid_t type;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, type = H5Tcopy(H5T_C_S1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tset_size(type, strlen(text) + 1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tset_cset(type, H5T_CSET_UTF8));
  PetscCall(Create(path, object, name, type, type, text));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tclose(type));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeWriteNumber(const char path[], hid_t object, const char name[], hid_t file_type,
                                       hid_t memory_type, const void *value)
{
  PetscFunctionBeginUser;
  PetscCall(Create(path, object, name, file_type, memory_type, value));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeUpdate(const char path[], hid_t object, const char name[], hid_t memory_type,
                                  const void *value)
{
  hid_t attribute;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, attribute = H5Aopen(object, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Awrite(attribute, memory_type, value));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Aclose(attribute));
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

/* Opens an attribute of one element. */
static PetscErrorCode Open(const char path[], hid_t object, const char name[], hid_t *attribute, hid_t *type)
{
  hid_t space;
  PetscBool has;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeHas(path, object, name, &has));
  PetscCheck(has, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is missing; the file is damaged or was not written by lamella", path, name);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, *attribute = H5Aopen(object, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, *type = H5Aget_type(*attribute));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, space = H5Aget_space(*attribute));
  PetscCheck(H5Sget_simple_extent_type(space) == H5S_SCALAR, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is not one value; the file is damaged", path, name);
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(space));
  PetscFunctionReturn(0);
}

static PetscErrorCode Close(const char path[], hid_t attribute, hid_t type)
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Aclose(attribute));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeReadNumber(const char path[], hid_t object, const char name[], hid_t file_type,
                                      hid_t memory_type, void *value)
{
  hid_t attribute, type;

  PetscFunctionBeginUser;
  PetscCall(Open(path, object, name, &attribute, &type));
  PetscCheck(H5Tequal(type, file_type) > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is of another type; the file is damaged", path, name);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Aread(attribute, memory_type, value));
  PetscCall(Close(path, attribute, type));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeReadText(const char path[], hid_t object, const char name[], char **text)
{
  hid_t attribute, type;

  PetscFunctionBeginUser;
  PetscCall(Open(path, object, name, &attribute, &type));
  PetscCheck(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Tget_size(type) <= TEXT_BYTES,
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: attribute \"%s\" is not a text; the file is damaged", path,
             name);
  PetscCall(PetscCalloc(H5Tget_size(type) + 1, text));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Aread(attribute, type, *text));
  PetscCall(Close(path, attribute, type));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAttributeCopyText(const char path[], hid_t object, const char name[], size_t length, char value[])
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeReadText(path, object, name, &text));
  PetscCall(PetscStrncpy(value, text, length));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}
