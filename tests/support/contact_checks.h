/* Figures of contact tissue that the tests assert and the bench program prints: the independent values of
   data/contact.json, complementarity and penetration, tractions that statics alone fixes, and the effective-stress
   principle. */
#ifndef LAM_SUPPORT_CONTACT_CHECKS_H
#define LAM_SUPPORT_CONTACT_CHECKS_H

#include "contact_tissue.h"
#include "effective_stress.h"
#include "reference_values.h"

/* ---- independent values ---- */

#define CONTACT_CASES_MAX 8
typedef struct {
  double shear, turgor;  /* MPa */
  double error, allowed; /* largest difference of a stress component, MPa */
  double lumen;          /* difference of the lumen fraction */
  LamResponse response;
} ContactReferenceCase;

/* Solves every case of the file with along x through elements a face. Those without turgor are for information only. */
PetscErrorCode CompareContact(const char path[], PetscInt along, PetscInt through, int *count,
                              ContactReferenceCase list[CONTACT_CASES_MAX]);

/* ---- complementarity, penetration and equilibrium ---- */

#define PENETRATION_LOADS 3
#define MODERATE_LOADS 2 /* the first ones */
LamLoad PenetrationLoad(int k);

typedef struct {
  double product;  /* max |lambda gap| over all hats, in (C1 + C2) apothems */
  double tension;  /* largest -lambda, in C1 + C2 */
  double overlap;  /* largest negative weighted gap of a hat, in apothems */
  double residual; /* norm of the forces that are left, over the Newton tolerance */
  LamResponse response;
} Complementarity;

PetscErrorCode ComputeComplementarity(const LamMicrostructure *micro, const LamLoad *load, Complementarity *out);

/* ---- tractions that statics alone fixes ---- */

/*
  One frictionless cell: faces 0, 1, 2 push with forces F_k along the mean normals m_k of the walls that touch, and
    (P - g cof F) V0 = -sum_k F_k m_k (x) L_k.
  That fixes F_k, so the mean tractions t_k = g - F_k / length_k. At small strains, with the reference's normals n_k,
  and with tractions that are small against the moduli, it reads t_k = 2 n_k.Sigma n_k - tr(Sigma)/2 with the in-plane
  Cauchy stress Sigma = P F^T / J.
*/
typedef struct {
  double reference; /* error of the formula of small strains */
  double current;   /* of the current faces: directions of their contact forces, lengths of their chords */
  LamResponse response;
} StaticTractions; /* errors: largest difference to mean_face_traction over the spread between faces */

double TractionError(const LamResponse *r, const double t[3]);
/* At F = 1 + strain * (a fixed direction); turgor and cohesion in MPa. */
PetscErrorCode ComputeStaticTractions(double strain, double turgor, double cohesion, StaticTractions *out);

/* ---- effective-stress principle ---- */

#define PRINCIPLE_PAIRS 3
#define PRINCIPLE_LOADS 3
/* Turgor and cohesion act through their sum s = p + g: P + p J F^-T at equal s, for pairs (p, g). Returns the largest
   difference of a component from that of the first pair, over s. bulk_modulus in C1. */
PetscErrorCode ComputePrinciple(LamMicrostructure micro, double bulk_modulus, double difference[PRINCIPLE_LOADS],
                                int *converged);

#endif
