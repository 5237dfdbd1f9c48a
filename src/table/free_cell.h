/*
  Floating cells: the state of tissue whose cells are all separated, as a function of suction alone.

  A cell without contact is inflated by s = turgor + cohesion and does not depend on F. With the potential
    Phi = Psi - g J,
  its Phi depends on s alone (and, to O(p / bulk modulus), on p at fixed s). It touches its neighbours where the spacing
  of the lattice in one of the three directions has the stretch exp(a(s)); a(s) is the logarithm of the free cell's
  width over 2 apothems. So all states with lattice strains above a(s) are known exactly.
  All of it depends on F33, too, and can be tabulated at several F33: planes.
*/
#ifndef LAM_FREE_CELL_H
#define LAM_FREE_CELL_H

#include <jansson.h>
#include <lamella/response.h>

/* Knots evenly spaced in tau = ln(1 + s / scale). Numbers of all planes follow one another: [planes * n] for [n]. */
typedef struct {
  PetscInt n, planes;                             /* planes: knots of z = ln F33; 1: F33 = 1 */
  PetscReal z_step;                               /* between planes */
  PetscReal scale;                                /* of suction */
  PetscReal cohesion;                             /* g of the states: turgor is s - g */
  PetscReal *suction, *strain, *strain_curvature; /* [n] s, a(s), d2a/dtau2 of the cubic spline (not-a-knot) */
  PetscReal *energy, *slope, *curvature;          /* [n] Phi, dPhi/ds, d2Phi/ds2 along the states */
  PetscReal *turgor_slope, *turgor_curvature;     /* [n] dPhi/dp and d2Phi/dp2 at fixed s */
  PetscReal *axial, *axial_curvature,
      *turgor_axial;                   /* [n] dPhi/dz, d2Phi/dz2, d2Phi/dpdz at fixed s; one plane: NULL */
  PetscReal *strain_z2, *curvature_z2; /* [n] second derivatives in z of the splines of a and d2a/dtau2; not in JSON */
  LamResponse *records;                /* [n] the states, for indicators; not in the JSON: NULL when read */
} LamFreeCell;

/* F33 of the planes: exp(z_min + k z_step), k < n. One plane: F33 = exp(z_min). */
typedef struct {
  PetscInt n;
  PetscReal z_min, z_step;
} LamFreePlanes;

/* Number of states. */
static inline PetscInt LamFreeCellStates(const LamFreeCell *cell)
{
  return cell->n * cell->planes;
}

/*
  Solves n states at equal stretches in both directions, large enough that all cells float, for s from suction_min
  (> 0) to suction_max; n >= 5; one plane (NULL: F33 = 1), or at least three. Returns n = 0 and no error where the
  tissue has no such states (bonded; a patch; cells that differ; a state that fails or does not float), and for periods
  of more than one cell: these drift apart, and no gap determines their width. For identical cells pass a microstructure
  and a solver of one cell instead.
*/
PetscErrorCode LamFreeCellMake(const LamMicrostructure *micro, PetscReal cohesion, PetscReal suction_min,
                               PetscReal suction_max, PetscReal scale, PetscInt n, const LamFreePlanes *planes,
                               LamResponder solver, LamFreeCell *cell);
PetscErrorCode LamFreeCellDestroy(LamFreeCell *cell);
/* a(s) and its first two derivatives with respect to s (C2); s must be within the knots. */
void LamFreeCellStrain(const LamFreeCell *cell, PetscReal s, PetscReal strain[3]);
/* The same at w planes from the first one: a, a_s, a_ss, a_z, a_zz, a_sz (C2 in both). */
void LamFreeCellStrains(const LamFreeCell *cell, PetscReal s, PetscReal w, PetscReal strain[6]);
/*
  energy: Phi(s) and its first two derivatives (quintic Hermite, C2). turgor: dPhi/dp and d2Phi/dp2 at fixed s (C1),
  each with its first two derivatives with respect to tau = ln(1 + s / scale).
*/
void LamFreeCellEnergy(const LamFreeCell *cell, PetscInt plane, PetscReal s, PetscReal energy[3],
                       PetscReal turgor[2][3]);
/* Of one plane, besides: dPhi/dz, d2Phi/dz2, d2Phi/dpdz at fixed s (C1), each with its derivatives in tau. */
void LamFreeCellAxial(const LamFreeCell *cell, PetscInt plane, PetscReal s, PetscReal axial[3][3]);
/* To and from JSON, with all digits. PETSC_ERR_USER_INPUT naming `path` if the object is not a free cell. */
PetscErrorCode LamFreeCellToJSON(const LamFreeCell *cell, json_t **object);
PetscErrorCode LamFreeCellFromJSON(const char path[], json_t *object, LamFreeCell *cell);

#endif
