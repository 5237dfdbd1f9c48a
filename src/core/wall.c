/*
  Run-time queries of the lists of wall laws and their parameters.
*/
#include <lamella/wall.h>
#include <ctype.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define LAW_NAME(symbol, name, fibres, help) name,
#define LAW_FIBRES(symbol, name, fibres, help) fibres,
#define FIBRES_NAME(symbol, name) name,
#define PARAMETER_NAME(X, name, ...) #name,
#define IS_MODULUS PETSC_TRUE
#define IS_NUMBER PETSC_FALSE
#define IS_ALWAYS PETSC_FALSE
#define IS_BY_LAW PETSC_FALSE
#define IS_OPTIONAL PETSC_TRUE
#define PARAMETER(X, name, law, kind, need, symbol, example, help, ...)                                                \
  {#law, help, symbol, IS_##kind, IS_##need, offsetof(LamWall, name)},

const char *const LamWallLawNames[] = {LAM_WALL_LAWS(LAW_NAME)};
const char *const LamFibresNames[] = {LAM_FIBRES(FIBRES_NAME)};
const char *const LamWallParameterNames[] = {LAM_WALL_PARAMETERS(PARAMETER_NAME, )};
static const PetscBool law_fibres[] = {LAM_WALL_LAWS(LAW_FIBRES)};
static const struct {
  const char *law, *help, *symbol;
  PetscBool is_modulus, is_optional;
  size_t offset;
} parameters[] = {LAM_WALL_PARAMETERS(PARAMETER, )};

PetscReal *LamWallAt(LamWall *wall, PetscInt parameter)
{
  return (PetscReal *)((char *)wall + parameters[parameter].offset);
}

PetscReal LamWallGet(const LamWall *wall, PetscInt parameter)
{
  return *(const PetscReal *)((const char *)wall + parameters[parameter].offset);
}

PetscBool LamWallLawHas(LamWallLawType law, PetscInt parameter)
{
  const char *owner = parameters[parameter].law;

  return (PetscBool)(!strcmp(owner, "all") || !strcmp(owner, LamWallLawNames[law]));
}

PetscBool LamWallLawHasFibres(LamWallLawType law)
{
  return law_fibres[law];
}

PetscReal LamWallFibreModulus(const LamWall *wall)
{
  switch (wall->law) {
  case LAM_WALL_FIBRE_MOONEY_RIVLIN:
    return wall->C4;
  case LAM_WALL_FIBRE_EXPONENTIAL: /* at rest tr C = 3 to first order */
    return 2.0 * wall->k1 * PetscSqr(1.0 - 3.0 * wall->dispersion);
  default:
    return 0.0;
  }
}

LamWallLawType LamWallOwner(PetscInt parameter)
{
  PetscInt law = 0;

  while (!LamWallLawHas((LamWallLawType)law, parameter)) law++;
  return (LamWallLawType)law;
}

const char *LamWallLacking(LamWallLawType law, PetscInt parameter)
{
  return law_fibres[law] ? LamWallParameterNames[parameter] : "fibres";
}

PetscBool LamWallParameterIsModulus(PetscInt parameter)
{
  return parameters[parameter].is_modulus;
}

PetscBool LamWallParameterIsOptional(PetscInt parameter)
{
  return parameters[parameter].is_optional;
}

const char *LamWallParameterSymbol(PetscInt parameter)
{
  return parameters[parameter].symbol;
}

const char *LamWallParameterWords(PetscInt parameter, size_t size, char text[])
{
  const char *help = parameters[parameter].help;

  snprintf(text, size, "%c%s", tolower((unsigned char)help[0]), help + 1);
  return text;
}

void LamWallScale(LamWall *wall, PetscReal by, PetscReal over)
{
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    if (parameters[k].is_modulus) *LamWallAt(wall, k) *= by, *LamWallAt(wall, k) /= over;
  wall->bulk_modulus *= by;
  wall->bulk_modulus /= over;
}

void LamWallMultiply(LamWall *wall, const PetscReal factor[LAM_WALL_PARAMETER_COUNT])
{
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++) *LamWallAt(wall, k) *= factor[k];
}

PetscReal LamWallRatios(const LamWall *wall, const PetscReal factor[LAM_WALL_PARAMETER_COUNT],
                        PetscReal ratio[LAM_WALL_PARAMETER_COUNT])
{
  const PetscReal shear = wall->C1 * factor[LAM_WALL_C1] + wall->C2 * factor[LAM_WALL_C2];

  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    ratio[k] = parameters[k].is_modulus ? factor[k] / shear : factor[k];
  return shear;
}
