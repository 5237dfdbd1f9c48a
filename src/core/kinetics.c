/*
  Kinetic laws, pointwise.
*/
#include <lamella/kinetics.h>
#include <lamella/scene.h>
#include <math.h>
#include <string.h>

enum { STEP_ITERATIONS = 30 };
#define STEP_EXACT 1e-14

#define NAME(symbol, name) name,
const char *const LamKineticLawNames[] = {LAM_KINETIC_LAWS(NAME)};

/* log(1 + exp(x)) without overflow */
static PetscReal Softplus(PetscReal x)
{
  return x > 0 ? x + log1p(exp(-x)) : log1p(exp(x));
}

PetscReal LamRateAt(const LamRate *rate, PetscReal temperature)
{
  PetscReal exponent = -rate->activation / LAM_GAS_CONSTANT * (1 / temperature - 1 / rate->reference);

  if (rate->deactivation > 0) {
    const PetscReal D = rate->deactivation / LAM_GAS_CONSTANT, half = 1 / rate->half_activity;

    exponent += Softplus(D * (half - 1 / rate->reference)) - Softplus(D * (half - 1 / temperature));
  }
  return rate->rate * exp(exponent);
}

PetscInt LamKineticsStates(const LamKinetics *kinetics)
{
  static const PetscInt states[] = {
      [LAM_KINETIC_CONSTANT] = 0,      [LAM_KINETIC_FIRST_ORDER] = 1,   [LAM_KINETIC_FRACTIONAL] = 1,
      [LAM_KINETIC_TWO_FRACTIONS] = 2, [LAM_KINETIC_AUTOCATALYTIC] = 2, [LAM_KINETIC_TABLE] = 0,
  };

  return states[kinetics->law];
}

void LamKineticsStart(const LamKinetics *kinetics, PetscReal x[])
{
  const PetscBool two = (PetscBool)(kinetics->law == LAM_KINETIC_TWO_FRACTIONS);
  const PetscInt states = LamKineticsStates(kinetics);

  if (states > 0) x[0] = two ? kinetics->share : 1;
  if (states > 1) x[1] = two ? 1 - kinetics->share : kinetics->enzyme;
}

/* Piecewise linear, constant outside the table. */
static PetscReal TableFactor(const LamKinetics *kinetics, PetscReal t)
{
  const PetscReal *time = kinetics->time, *factor = kinetics->factor;
  PetscInt k = 1;

  if (t <= time[0]) return factor[0];
  while (k < kinetics->count && time[k] < t) k++;
  if (k == kinetics->count) return factor[k - 1];
  return factor[k - 1] + (factor[k] - factor[k - 1]) * (t - time[k - 1]) / (time[k] - time[k - 1]);
}

PetscReal LamKineticsFactor(const LamKinetics *kinetics, PetscReal t, const PetscReal x[], PetscReal slope[])
{
  const PetscBool two = (PetscBool)(kinetics->law == LAM_KINETIC_TWO_FRACTIONS);

  slope[0] = 1;
  slope[1] = two ? 1 : 0;
  if (kinetics->law == LAM_KINETIC_CONSTANT) return 1;
  if (kinetics->law == LAM_KINETIC_TABLE) return TableFactor(kinetics, t);
  return two ? x[0] + x[1] : x[0];
}

void LamKineticsRates(const LamKinetics *kinetics, PetscReal temperature, const PetscReal x[], PetscReal rate[],
                      PetscReal J[LAM_KINETIC_STATES][LAM_KINETIC_STATES])
{
  const PetscReal k = LamRateAt(&kinetics->rate, temperature), k2 = LamRateAt(&kinetics->second, temperature);
  const PetscReal plateau = kinetics->law == LAM_KINETIC_FIRST_ORDER ? 0 : kinetics->plateau;

  memset(J, 0, LAM_KINETIC_STATES * LAM_KINETIC_STATES * sizeof(PetscReal));
  switch (kinetics->law) {
  case LAM_KINETIC_FIRST_ORDER:
  case LAM_KINETIC_FRACTIONAL:
    rate[0] = -k * (x[0] - plateau);
    J[0][0] = -k;
    break;
  case LAM_KINETIC_TWO_FRACTIONS:
    rate[0] = -k * x[0];
    rate[1] = -k2 * x[1];
    J[0][0] = -k;
    J[1][1] = -k2;
    break;
  case LAM_KINETIC_AUTOCATALYTIC:
    rate[0] = -k * x[1] * (x[0] - plateau);
    rate[1] = k2 * x[1] * (1 - x[1]);
    J[0][0] = -k * x[1];
    J[0][1] = -k * (x[0] - plateau);
    J[1][1] = k2 * (1 - 2 * x[1]);
    break;
  default:
    break;
  }
}

/* Newton's method; at most two states. */
PetscBool LamKineticsStep(const LamKinetics *law, PetscReal temperature, PetscReal c, const PetscReal start[],
                          const PetscReal slope[], PetscReal x[])
{
  const PetscInt n = LamKineticsStates(law);

  for (PetscInt it = 0; it < STEP_ITERATIONS; it++) {
    PetscReal rate[LAM_KINETIC_STATES] = {0}, J[LAM_KINETIC_STATES][LAM_KINETIC_STATES] = {{0}}, r[2] = {0}, d[2];

    LamKineticsRates(law, temperature, x, rate, J);
    for (PetscInt i = 0; i < n; i++) r[i] = slope[i] + c * (x[i] - start[i]) - rate[i];
    const PetscReal a = c - J[0][0], b = -J[0][1], e = -J[1][0], f = n > 1 ? c - J[1][1] : 1;
    const PetscReal determinant = n > 1 ? a * f - b * e : a;

    d[0] = n > 1 ? (f * r[0] - b * r[1]) / determinant : r[0] / a;
    d[1] = n > 1 ? (a * r[1] - e * r[0]) / determinant : 0;
    for (PetscInt i = 0; i < n; i++) x[i] -= d[i];
    if (!isfinite(x[0] + d[1])) return PETSC_FALSE;
    if (PetscAbsReal(d[0]) + PetscAbsReal(d[1]) <= STEP_EXACT) return PETSC_TRUE;
  }
  return PETSC_TRUE; /* to rounding */
}

static PetscBool RatesAgree(const LamRate *one, const LamRate *other)
{
  return (PetscBool)(one->rate == other->rate && one->activation == other->activation &&
                     one->deactivation == other->deactivation && one->reference == other->reference &&
                     one->half_activity == other->half_activity);
}

PetscReal LamKineticsLargest(const LamKinetics *kinetics)
{
  const PetscBool has_plateau =
      (PetscBool)(kinetics->law == LAM_KINETIC_FRACTIONAL || kinetics->law == LAM_KINETIC_AUTOCATALYTIC);
  PetscReal largest = has_plateau ? PetscMax(1.0, kinetics->plateau) : 1.0;

  for (PetscInt i = 0; i < kinetics->count; i++) largest = PetscMax(largest, kinetics->factor[i]);
  return largest;
}

PetscBool LamKineticsAgree(const LamKinetics *one, const LamKinetics *other)
{
  if (one->law != other->law || one->count != other->count) return PETSC_FALSE;
  for (PetscInt k = 0; k < one->count; k++)
    if (one->time[k] != other->time[k] || one->factor[k] != other->factor[k]) return PETSC_FALSE;
  return (PetscBool)(RatesAgree(&one->rate, &other->rate) && RatesAgree(&one->second, &other->second) &&
                     one->plateau == other->plateau && one->share == other->share && one->enzyme == other->enzyme);
}

PetscBool LamTransportHasPotentials(const LamScene *scene)
{
  const LamTransportSpec *spec = &scene->process.transport;

  if (!spec->given || isinf(spec->apoplast)) return PETSC_FALSE;
  return (PetscBool)(spec->cell_to_cell > 0 || (spec->apoplast > 0 && scene->process.water.permeability > 0));
}
