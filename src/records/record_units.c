/*
  What the numbers of a record are in: attributes of /records for programs that read the file. Lamella itself knows.
*/
#include "record_internal.h"
#include <string.h>

#define UNITS "units"
#define AXES "axes"
#define STRESS_UNIT "stress_unit" /* with _MPa the name of the attribute that has its value */

enum { TEXT = LAM_MAX_MEMBERS * 64 }; /* bytes: a line per member, half as long at most */

static const char *UnitOf(const LamMember *m)
{
  if (m->stress_power == 0) return m->unit ? m->unit : "1";
  return m->stress_power > 0 ? STRESS_UNIT : "1/" STRESS_UNIT;
}

/* NULL for a single number. */
static const char *AxesOf(const LamMember *m)
{
  return m->count == 9 ? "i j" : m->count == 81 ? "i j k l" : m->axes;
}

/* A line "member: words" for every member for which there are words. */
static void List(const char *(*words)(const LamMember *m), char text[TEXT])
{
  size_t end = 0;

  text[0] = '\0';
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    if (m->type != LAM_MEMBER_REAL || !words(m)) continue;
    end += (size_t)snprintf(text + end, TEXT - end, "%s%s: %s", end ? "\n" : "", m->name, words(m));
  }
}

static uint32_t Sum(const char units[], const char axes[], double MPa)
{
  uint32_t sum = LamBytesSum(0, units, strlen(units) + 1);

  sum = LamBytesSum(sum, axes, strlen(axes) + 1);
  return LamBytesSum(sum, &MPa, sizeof(MPa));
}

PetscErrorCode LamRecordUnitsWrite(const char path[], hid_t dataset, const LamScales *scales)
{
  const double MPa = scales->stress * 1e-6;
  char units[TEXT], axes[TEXT];

  PetscFunctionBeginUser;
  List(UnitOf, units);
  List(AxesOf, axes);
  PetscCall(LamAttributeWriteText(path, dataset, UNITS, units));
  PetscCall(LamAttributeWriteText(path, dataset, AXES, axes));
  PetscCall(LamAttributeWriteNumber(path, dataset, STRESS_UNIT "_MPa", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &MPa));
  PetscCall(LamSumWrite(path, dataset, LAM_UNITS_SUM, Sum(units, axes, MPa)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordUnitsCheck(const char path[], hid_t dataset)
{
  char *units = NULL, *axes = NULL;
  PetscBool has, sound = PETSC_TRUE;
  PetscErrorCode ierr;
  double MPa;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeHas(path, dataset, LAM_UNITS_SUM, &has));
  if (!has) PetscFunctionReturn(0);
  ierr = LamAttributeReadText(path, dataset, UNITS, &units);
  if (!ierr) ierr = LamAttributeReadText(path, dataset, AXES, &axes);
  if (!ierr) ierr = LamAttributeReadNumber(path, dataset, STRESS_UNIT "_MPa", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &MPa);
  if (!ierr) ierr = LamSumMatches(path, dataset, LAM_UNITS_SUM, Sum(units, axes, MPa), &sound);
  PetscCall(PetscFree(units));
  PetscCall(PetscFree(axes));
  PetscCall(ierr);
  PetscCheck(sound, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the units of the records are damaged (their checksum differs)", path);
  PetscFunctionReturn(0);
}
