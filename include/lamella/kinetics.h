/*
  Kinetic laws for tissue properties, and the temperature dependence of their rates.

  A law gives the factor X(t) that multiplies a property, X = 1 initially. It has LamKineticsStates states x, which
  follow ordinary differential equations with rates k(T); docs/theory/process.md.
*/
#ifndef LAMELLA_KINETICS_H
#define LAMELLA_KINETICS_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_GAS_CONSTANT 8.31446261815324 /* J/(mol K), exact by the SI of 2019 */

#define LAM_KINETIC_LAWS(X)                                                                                            \
  X(LAM_KINETIC_CONSTANT, "constant")                /* X = 1 */                                                       \
  X(LAM_KINETIC_FIRST_ORDER, "first_order")          /* X' = -k X */                                                   \
  X(LAM_KINETIC_FRACTIONAL, "fractional_conversion") /* X' = -k (X - plateau) */                                       \
  X(LAM_KINETIC_TWO_FRACTIONS, "two_fractions")      /* X = x1 + x2, x1' = -k x1, x2' = -k2 x2, x2(0) = 1 - share */   \
  X(LAM_KINETIC_AUTOCATALYTIC, "autocatalytic")      /* E' = k2 E (1 - E), X' = -k E (X - plateau) */                  \
  X(LAM_KINETIC_TABLE, "table")                      /* X tabulated over time, piecewise linear */
typedef enum {
#define LAM_KINETIC_ENTRY(symbol, name) symbol,
  LAM_KINETIC_LAWS(LAM_KINETIC_ENTRY)
#undef LAM_KINETIC_ENTRY
      LAM_KINETIC_LAW_COUNT
} LamKineticLaw;
LAM_EXPORT extern const char *const LamKineticLawNames[]; /* "constant", ... */

/*
  k(T) = rate exp[-activation / R (1/T - 1/reference)] (Arrhenius). If deactivation > 0 it is multiplied by (1 +
  exp[deactivation / R (1/half_activity - 1/reference)]) / (1 + exp[deactivation / R (1/half_activity - 1/T)]): the
  enzyme unfolds, half of it at half_activity; k(reference) = rate in both cases. Schoolfield, Sharpe & Magnuson, J.
  theor. Biol. 88 (1981) 719-731, eq. 4, high-temperature part.
*/
typedef struct {
  PetscReal rate;                     /* 1/s, at the reference temperature */
  PetscReal activation, deactivation; /* J/mol; deactivation 0: Arrhenius alone */
  PetscReal reference, half_activity; /* K */
} LamRate;
LAM_EXPORT PetscReal LamRateAt(const LamRate *rate, PetscReal temperature);

typedef struct {
  LamKineticLaw law;
  LamRate rate, second;             /* k, k2 */
  PetscReal plateau, share, enzyme; /* share: of the first fraction; enzyme: E(0) */
  PetscInt count;                   /* of the table */
  PetscReal *time, *factor;         /* [count] time in s, ascending; owned by the scene */
} LamKinetics;

enum { LAM_KINETIC_STATES = 2 }; /* maximum number of states of a law */
LAM_EXPORT PetscInt LamKineticsStates(const LamKinetics *kinetics);
/* States at t = 0. */
LAM_EXPORT void LamKineticsStart(const LamKinetics *kinetics, PetscReal x[]);
/* Returns X; slope: dX/dx_i. */
LAM_EXPORT PetscReal LamKineticsFactor(const LamKinetics *kinetics, PetscReal t, const PetscReal x[],
                                       PetscReal slope[]);
/* rate: dx_i/dt at temperature T; J[i][j]: its derivative with respect to x_j. */
LAM_EXPORT void LamKineticsRates(const LamKinetics *kinetics, PetscReal temperature, const PetscReal x[],
                                 PetscReal rate[], PetscReal J[LAM_KINETIC_STATES][LAM_KINETIC_STATES]);
/* Solves x' = slope + c (x - start) for x, from x, the equation of an implicit step; false: it has no solution. */
LAM_EXPORT PetscBool LamKineticsStep(const LamKinetics *kinetics, PetscReal temperature, PetscReal c,
                                     const PetscReal start[], const PetscReal slope[], PetscReal x[]);
/* The largest factor at any time. */
LAM_EXPORT PetscReal LamKineticsLargest(const LamKinetics *kinetics);
/* True if two laws give the same factor at all times. */
LAM_EXPORT PetscBool LamKineticsAgree(const LamKinetics *one, const LamKinetics *other);

LAM_C_END

#endif
