/*
  Wall laws and their parameters. The wall struct, scene files and their reference, descriptions and hashes, `check`,
  `map`, kinetics and parametric databases are generated from these lists.

  A new law needs one row in LAM_WALL_LAWS, rows for its own parameters, one kernel file in rve/wall, a row in
  wall_law.c, and its stiffness at rest in LamWallFibreModulus.
*/
#ifndef LAMELLA_WALL_H
#define LAMELLA_WALL_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* L(symbol, name, PETSC_TRUE if it has fibres, help in a list of all laws) */
#define LAM_WALL_LAWS(L)                                                                                               \
  L(LAM_WALL_FIBRE_MOONEY_RIVLIN, "fibre_mooney_rivlin", PETSC_TRUE, "Mooney-Rivlin with fibres along the wall; ")     \
  L(LAM_WALL_FIBRE_EXPONENTIAL, "fibre_exponential", PETSC_TRUE, "with fibres that stiffen exponentially; ")           \
  L(LAM_WALL_MOONEY_RIVLIN, "mooney_rivlin", PETSC_FALSE, "without fibres.")

/*
  M(X, name, law, kind, need, symbol in pictures, example, help, bounds...); X is passed through. law: `all`, or the
  name of the only law with this parameter. kind: MODULUS (a stress in C1 + C2; scaled by "walls" of kinetics and by
  fields of cells) or NUMBER. need: ALWAYS; BY_LAW (required by its law); OPTIONAL (default 0).
*/
#define LAM_WALL_MATRIX_PARAMETERS(M, X)                                                                               \
  M(X, C1, all, MODULUS, ALWAYS, "$C_1$", "0.1 MPa", "First Mooney-Rivlin modulus", ABOVE(0))                          \
  M(X, C2, all, MODULUS, ALWAYS, "$C_2$", "0.01 MPa", "Second Mooney-Rivlin modulus", FROM(0))
#define LAM_WALL_OWN_PARAMETERS(M, X)                                                                                  \
  M(X, C4, fibre_mooney_rivlin, MODULUS, BY_LAW, "$C_4$", "1 MPa", "Fibre modulus", FROM(0))                           \
  M(X, k1, fibre_exponential, MODULUS, BY_LAW, "$k_1$", "0.5 MPa", "Modulus of exponential fibres", FROM(0))           \
  M(X, k2, fibre_exponential, NUMBER, BY_LAW, "$k_2$", "5", "Exponent of the fibres", FROM(0))                         \
  M(X, dispersion, fibre_exponential, NUMBER, OPTIONAL, "dispersion", "0.1",                                           \
    "Dispersion of the fibres about the wall: 0 all along it, 1/3 in all directions", FROM(0), TO(1.0 / 3.0))
#define LAM_WALL_PARAMETERS(M, X) LAM_WALL_MATRIX_PARAMETERS(M, X) LAM_WALL_OWN_PARAMETERS(M, X)

#define LAM_WALL_LAW_ENUM(symbol, name, fibres, help) symbol,
#define LAM_WALL_ENUM(prefix, name, ...) prefix##name,
#define LAM_WALL_MEMBER(X, name, ...) PetscReal name;

#define LAM_FIBRES(X)                                                                                                  \
  X(LAM_FIBRES_BOTH, "both")                                                                                           \
  X(LAM_FIBRES_TENSION, "tension")
typedef enum { LAM_WALL_LAWS(LAM_WALL_LAW_ENUM) LAM_WALL_LAW_COUNT } LamWallLawType;
typedef enum { LAM_FIBRES_BOTH, LAM_FIBRES_TENSION, LAM_FIBRES_COUNT } LamFibres;
typedef enum {
  LAM_WALL_PARAMETERS(LAM_WALL_ENUM, LAM_WALL_) /* LAM_WALL_C1, ... */
  LAM_WALL_PARAMETER_COUNT
} LamWallParameter;
LAM_EXPORT extern const char *const LamWallLawNames[];       /* "fibre_mooney_rivlin", ... */
LAM_EXPORT extern const char *const LamFibresNames[];        /* "both", "tension" */
LAM_EXPORT extern const char *const LamWallParameterNames[]; /* "C1", ... */

/* Wall material. Moduli are in C1 + C2 (so C1 + C2 = 1); parameters that the law does not have are 0. */
typedef struct {
  LamWallLawType law;
  LamFibres fibres;
  LAM_WALL_PARAMETERS(LAM_WALL_MEMBER, )
  PetscReal bulk_modulus;
  PetscReal fibre_angle; /* rad: between the fibres and the section of the cells; 0: along the wall, pi/2: along X3 */
} LamWall;

/* Stress relaxation of walls, a Prony series: the moduli are the instantaneous ones, and of a stress that a strain has
   caused, volume changes aside, 1 - sum share (1 - exp(-t/time)) are left after a time t. */
#define LAM_RELAXATION_TERMS 3
typedef struct {
  PetscInt terms;                        /* 0: walls have no memory */
  PetscReal share[LAM_RELAXATION_TERMS]; /* > 0, less than 1 in all */
  PetscReal time[LAM_RELAXATION_TERMS];  /* s */
} LamRelaxation;

/* Access to parameters by index; `parameter` is a LamWallParameter. */
LAM_EXPORT PetscReal *LamWallAt(LamWall *wall, PetscInt parameter);
LAM_EXPORT PetscReal LamWallGet(const LamWall *wall, PetscInt parameter);
LAM_EXPORT PetscBool LamWallLawHas(LamWallLawType law, PetscInt parameter);
LAM_EXPORT PetscBool LamWallLawHasFibres(LamWallLawType law);
LAM_EXPORT LamWallLawType LamWallOwner(PetscInt parameter); /* a law with this parameter */
LAM_EXPORT const char *LamWallLacking(LamWallLawType law,
                                      PetscInt parameter); /* "fibres" or "C4", for a law without C4 */
LAM_EXPORT PetscBool LamWallParameterIsModulus(PetscInt parameter);
LAM_EXPORT PetscBool LamWallParameterIsOptional(PetscInt parameter); /* may be left out, and is 0 then */
LAM_EXPORT const char *LamWallParameterSymbol(PetscInt parameter);   /* for pictures: "$C_4$" */
/* Writes "fibre modulus" to `text`, and returns it. */
LAM_EXPORT const char *LamWallParameterWords(PetscInt parameter, size_t size, char text[]);

/* C4 of quadratic fibres with the same stiffness at zero strain; 0 without fibres. */
LAM_EXPORT PetscReal LamWallFibreModulus(const LamWall *wall);

/* Multiplies all moduli by `by / over`, of which one is 1, so that only one rounding occurs. */
LAM_EXPORT void LamWallScale(LamWall *wall, PetscReal by, PetscReal over);
/* Multiplies each parameter by its factor; the bulk modulus is unchanged. */
LAM_EXPORT void LamWallMultiply(LamWall *wall, const PetscReal factor[LAM_WALL_PARAMETER_COUNT]);
/*
  For a wall whose parameters are multiplied by `factor`: returns the new C1 + C2. ratio: for moduli, the factor over
  the new C1 + C2; for numbers, the factor.
*/
LAM_EXPORT PetscReal LamWallRatios(const LamWall *wall, const PetscReal factor[LAM_WALL_PARAMETER_COUNT],
                                   PetscReal ratio[LAM_WALL_PARAMETER_COUNT]);

LAM_C_END

#endif
