/*
  Physical quantities: a number and a unit, converted to SI with udunits2.

  udunits2 treats reciprocals as convertible (metre and 1/metre) and radian as dimensionless. Dimensions are therefore
  compared by base units and their powers.
*/
#include "quantity_text.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <udunits2.h>

const char *const LamDimensionNames[] = {"length",          "stress",
                                         "angle",           "time",
                                         "temperature",     "rate",
                                         "molar energy",    "permeability",
                                         "energy per area", "stress per length",
                                         "conductivity"};
const char *const LamDimensionExamples[] = {"75 um",   "0.1 MPa",     "30 deg",         "2 h",
                                            "20 degC", "0.1 /day",    "60 kJ/mol",      "1e-7 m/s/MPa",
                                            "1 J/m^2", "1000 MPa/mm", "1e-10 m^2/s/MPa"};

enum { BASE_UNITS = 6 };
static const char *const base_symbols[BASE_UNITS] = {"m", "kg", "s", "rad", "K", "mol"};
static const int dimension_powers[][BASE_UNITS] = {
    [LAM_DIMENSION_LENGTH] = {1, 0, 0, 0, 0, 0},
    [LAM_DIMENSION_STRESS] = {-1, 1, -2, 0, 0, 0},
    [LAM_DIMENSION_ANGLE] = {0, 0, 0, 1, 0, 0},
    [LAM_DIMENSION_TIME] = {0, 0, 1, 0, 0, 0},
    [LAM_DIMENSION_TEMPERATURE] = {0, 0, 0, 0, 1, 0},
    [LAM_DIMENSION_RATE] = {0, 0, -1, 0, 0, 0},
    [LAM_DIMENSION_MOLAR_ENERGY] = {2, 1, -2, 0, 0, -1},
    [LAM_DIMENSION_PERMEABILITY] = {2, -1, 1, 0, 0, 0}, /* m/s per Pa */
    [LAM_DIMENSION_AREAL_ENERGY] = {0, 1, -2, 0, 0, 0},
    [LAM_DIMENSION_STIFFNESS] = {-2, 1, -2, 0, 0, 0},
    [LAM_DIMENSION_CONDUCTIVITY] = {3, -1, 1, 0, 0, 0}, /* m/s per Pa/m */
};

/* The units database: read at first use (which takes some milliseconds), freed at exit. */
static ut_system *unit_system = NULL;

static void UnitSystemFree(void)
{
  ut_free_system(unit_system);
  unit_system = NULL;
}

#define LamCallUT(call)                                                                                                \
  do {                                                                                                                 \
    ut_status lam_ut_status_ = (call);                                                                                 \
    PetscCheck(lam_ut_status_ == UT_SUCCESS, PETSC_COMM_SELF, PETSC_ERR_LIB, "udunits2: %s failed with status %d",     \
               #call, (int)lam_ut_status_);                                                                            \
  } while (0)

static PetscErrorCode UnitSystemGet(void)
{
  ut_unit *degree;

  PetscFunctionBeginUser;
  if (unit_system) PetscFunctionReturn(0);
  ut_set_error_message_handler(ut_ignore);
  unit_system = ut_read_xml(NULL);
  PetscCheck(unit_system, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
             "the units database of udunits2 cannot be read (status %d); is udunits2 installed completely?",
             (int)ut_get_status());
  PetscCheck(!atexit(UnitSystemFree), PETSC_COMM_SELF, PETSC_ERR_LIB, "atexit failed");
  degree = ut_get_unit_by_name(unit_system, "degree");
  PetscCheck(degree, PETSC_COMM_SELF, PETSC_ERR_LIB, "the units database of udunits2 lacks the degree");
  LamCallUT(ut_map_name_to_unit("deg", UT_ASCII, degree));
  ut_free(degree);
  PetscFunctionReturn(0);
}

/* A decomposed unit: x units are scale x + offset in SI; powers of the base units. */
typedef struct {
  double scale, offset;
  int powers[BASE_UNITS];
  PetscBool plain; /* PETSC_FALSE: it contains a logarithm or other base units */
} UnitParts;

static void AddBaseUnit(UnitParts *parts, const ut_unit *unit, int power)
{
  const char *symbol = ut_get_symbol(unit, UT_ASCII);

  for (int i = 0; symbol && i < BASE_UNITS; i++) {
    if (!strcmp(symbol, base_symbols[i])) {
      parts->powers[i] += power;
      return;
    }
  }
  parts->plain = PETSC_FALSE;
}

static ut_status VisitBasic(const ut_unit *unit, void *arg)
{
  AddBaseUnit((UnitParts *)arg, unit, 1);
  return UT_SUCCESS;
}

static ut_status VisitProduct(const ut_unit *unit, int count, const ut_unit *const *basic, const int *powers, void *arg)
{
  for (int i = 0; i < count; i++) AddBaseUnit((UnitParts *)arg, basic[i], powers[i]);
  return UT_SUCCESS;
}

static ut_status VisitTimestamp(const ut_unit *unit, const ut_unit *time, double origin, void *arg)
{
  ((UnitParts *)arg)->plain = PETSC_FALSE;
  return UT_SUCCESS;
}

static ut_status VisitLogarithmic(const ut_unit *unit, double base, const ut_unit *reference, void *arg)
{
  ((UnitParts *)arg)->plain = PETSC_FALSE;
  return UT_SUCCESS;
}

static ut_status VisitGalilean(const ut_unit *unit, double scale, const ut_unit *underlying, double offset, void *arg);

static const ut_visitor visitor = {VisitBasic, VisitProduct, VisitGalilean, VisitTimestamp, VisitLogarithmic};

static ut_status VisitGalilean(const ut_unit *unit, double scale, const ut_unit *underlying, double offset, void *arg)
{
  UnitParts *parts = (UnitParts *)arg;

  parts->offset += parts->scale * scale * offset;
  parts->scale *= scale;
  return ut_accept_visitor(underlying, &visitor, arg);
}

PetscBool LamTextIsNonFinite(const char text[])
{
  static const char *const words[] = {"nan", ".nan", "inf", ".inf", "infinity"};
  const char *word = text + strspn(text, " +-");
  size_t length = strcspn(word, " ");

  for (size_t i = 0; i < sizeof(words) / sizeof(words[0]); i++) {
    if (strlen(words[i]) == length && !strncasecmp(word, words[i], length)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscReal LamNumberScan(const char text[], const char **end)
{
  const char *s = text;
  size_t digits;

  /* strtod also accepts hexadecimal numbers and non-finite names; here *end then points to the x */
  *end = text;
  if (*s == '+' || *s == '-') s++;
  digits = strspn(s, "0123456789");
  s += digits;
  if (*s == '.') {
    digits += strspn(s + 1, "0123456789");
    s += 1 + strspn(s + 1, "0123456789");
  }
  if (!digits) return 0.0;
  if (*s == 'e' || *s == 'E') {
    const char *exponent = s + 1;
    if (*exponent == '+' || *exponent == '-') exponent++;
    if (isdigit((unsigned char)*exponent)) s = exponent + strspn(exponent, "0123456789");
  }
  *end = s;
  return strtod(text, NULL);
}

PetscBool LamTextHasDecimalComma(const char end[])
{
  return (PetscBool)(end[0] == ',' && isdigit((unsigned char)end[1]));
}

/* Decomposes the unit; *known: whether udunits2 recognises it. */
static PetscErrorCode UnitRead(const char text[], UnitParts *parts, PetscBool *known)
{
  ut_unit *unit;

  PetscFunctionBeginUser;
  PetscCall(UnitSystemGet());
  *parts = (UnitParts){.scale = 1.0, .plain = PETSC_TRUE};
  unit = ut_parse(unit_system, text, UT_UTF8);
  *known = unit ? PETSC_TRUE : PETSC_FALSE;
  if (unit) {
    ut_status status = ut_accept_visitor(unit, &visitor, parts);
    ut_free(unit);
    LamCallUT(status);
  }
  PetscFunctionReturn(0);
}

/* The usual unit that differs only by capital letters; NULL: none. */
static const char *UnitMeant(const char unit[])
{
  static const char *const usual[] = {"Pa",   "kPa", "MPa",  "GPa",     "um",    "mm",   "nm",     "cm",    "deg",
                                      "rad",  "min", "h",    "day",     "degC",  "K",    "kJ/mol", "J/mol", "/s",
                                      "/min", "/h",  "/day", "m/s/MPa", "J/m^2", "J/m2", "mJ/m^2", "N/m",   "MPa/mm"};

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(usual); k++)
    if (!strcasecmp(usual[k], unit)) return usual[k];
  return NULL;
}

/* True if zero is a factor in the unit: udunits2 rejects that, and leaks the memory of the name after it. */
static PetscBool HasZero(const char unit[])
{
  for (const char *c = unit; *c; c++) {
    char *end;

    if (!strchr(" .*/(", *c) || (c > unit && c[-1] == '*')) continue; /* ** 0 is an exponent */
    if (strtod(c + 1, &end) == 0 && end > c + 1) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* A rate may be written as the reciprocal of a time; returns the length of the prefix "/" or "1/". */
static size_t ReciprocalLength(const char unit[])
{
  const size_t length = unit[0] == '1' && unit[1] == '/' ? 2 : unit[0] == '/' ? 1 : 0;

  return length ? length + strspn(unit + length, " \t") : 0;
}

static PetscErrorCode QuantityConvert(PetscReal number, const char unit_text[], LamDimension dimension, PetscReal *si,
                                      char reason[LAM_REASON_LENGTH])
{
  const size_t skipped = dimension == LAM_DIMENSION_RATE ? ReciprocalLength(unit_text) : 0;
  const LamDimension expected = skipped ? LAM_DIMENSION_TIME : dimension;
  const char *text = unit_text + skipped;
  char unit[48];
  size_t length = strlen(text);
  UnitParts parts;
  PetscBool known = PETSC_FALSE;

  PetscFunctionBeginUser;
  while (length && isspace((unsigned char)text[length - 1])) length--;
  snprintf(unit, sizeof(unit), "%.*s", (int)PetscMin(length, sizeof(unit)), text);
  /* a factor, sign or bracket in the unit is probably a mistake */
  if (length < sizeof(unit) && (isalpha((unsigned char)unit[0]) || (unsigned char)unit[0] >= 0x80) && !HasZero(unit)) {
    PetscCall(UnitRead(unit, &parts, &known));
  }
  if (!known) {
    const char *meant = UnitMeant(unit);

    snprintf(reason, LAM_REASON_LENGTH, "the unit \"%s\" is unknown%s%s%s", unit, meant ? " (did you mean " : "",
             meant ? meant : "", meant ? "?)" : "");
  } else if (!parts.plain || memcmp(parts.powers, dimension_powers[expected], sizeof(parts.powers)) ||
             (parts.offset != 0.0 && dimension != LAM_DIMENSION_TEMPERATURE)) {
    snprintf(reason, LAM_REASON_LENGTH, "\"%s\" is not a unit of %s", unit, LamDimensionNames[expected]);
  } else {
    *si = skipped ? number / parts.scale : number * parts.scale + parts.offset;
    if (!isfinite(*si)) snprintf(reason, LAM_REASON_LENGTH, "is too large");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamQuantityRead(const char text[], LamDimension dimension, PetscReal *si, char reason[LAM_REASON_LENGTH])
{
  const char *start = text + strspn(text, " \t"), *end;
  PetscReal number = LamNumberScan(start, &end);

  PetscFunctionBeginUser;
  *si = 0.0;
  reason[0] = '\0';
  if (LamTextIsNonFinite(start)) {
    snprintf(reason, LAM_REASON_LENGTH, "is not a finite number");
  } else if (end == start) {
    snprintf(reason, LAM_REASON_LENGTH, "is not a number with a unit");
  } else if (LamTextHasDecimalComma(end)) {
    snprintf(reason, LAM_REASON_LENGTH, LAM_DECIMAL_COMMA);
  } else if (!isfinite(number)) {
    snprintf(reason, LAM_REASON_LENGTH, "is too large");
  } else {
    const char *unit = end + strspn(end, " \t");
    if (*unit)
      PetscCall(QuantityConvert(number, unit, dimension, si, reason));
    else
      snprintf(reason, LAM_REASON_LENGTH, "has no unit");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamQuantityParse(const char text[], LamDimension dimension, PetscReal *si)
{
  char reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(LamQuantityRead(text, dimension, si, reason));
  PetscCheck(!reason[0], PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%.60s: %s; write a %s with its unit, such as %s", text,
             reason, LamDimensionNames[dimension], LamDimensionExamples[dimension]);
  PetscFunctionReturn(0);
}

const char *LamTimeUnit(PetscReal duration, PetscReal *seconds)
{
  static const struct {
    const char *name;
    PetscReal seconds;
  } units[] = {{"day", 86400}, {"h", 3600}, {"min", 60}, {"s", 1}};
  size_t k = 0;

  while (k + 1 < PETSC_STATIC_ARRAY_LENGTH(units) && duration < 2 * units[k].seconds) k++;
  *seconds = units[k].seconds;
  return units[k].name;
}
