/*
  Floating cells: the state of tissue whose cells are all separated, as a function of suction alone.

  A cell without contact is inflated by s = turgor + cohesion and does not depend on F. With the potential
    Phi = Psi - g J,
  its Phi depends on s alone (and, to O(p / bulk modulus), on p at fixed s). It touches its neighbours where the spacing
  of the lattice in one of the three directions has the stretch exp(a(s)); a(s) is the logarithm of the free cell's
  width over 2 apothems. So all states with lattice strains above a(s) are known exactly.
*/
#ifndef LAM_FREE_CELL_H
#define LAM_FREE_CELL_H

#include <jansson.h>
#include <lamella/response.h>

/* Knots evenly spaced in tau = ln(1 + s / scale). */
typedef struct {
  PetscInt n;
  PetscReal scale;                                /* of suction */
  PetscReal cohesion;                             /* g of the states: turgor is s - g */
  PetscReal *suction, *strain, *strain_curvature; /* [n] s, a(s), d2a/dtau2 of the cubic spline (not-a-knot) */
  PetscReal *energy, *slope, *curvature;          /* [n] Phi, dPhi/ds, d2Phi/ds2 along the states */
  PetscReal *turgor_slope, *turgor_curvature;     /* [n] dPhi/dp and d2Phi/dp2 at fixed s */
  LamResponse *records;                           /* [n] the states, for indicators; not in the JSON: NULL when read */
} LamFreeCell;

/*
  Solves n states at equal stretches in both directions, large enough that all cells float, for s from suction_min
  (> 0) to suction_max; n >= 5. Returns n = 0 and no error where the tissue has no such states (bonded; a patch; cells
  that differ; a state that fails or does not float), and for periods of more than one cell: these drift apart, and no
  gap determines their width. For identical cells pass a microstructure and a solver of one cell instead.
*/
PetscErrorCode LamFreeCellMake(const LamMicrostructure *micro, PetscReal cohesion, PetscReal suction_min,
                               PetscReal suction_max, PetscReal scale, PetscInt n, LamResponder solver,
                               LamFreeCell *cell);
PetscErrorCode LamFreeCellDestroy(LamFreeCell *cell);
/* a(s) and its first two derivatives with respect to s (C2); s must be within the knots. */
void LamFreeCellStrain(const LamFreeCell *cell, PetscReal s, PetscReal strain[3]);
/*
  energy: Phi(s) and its first two derivatives (quintic Hermite, C2). turgor: dPhi/dp and d2Phi/dp2 at fixed s (C1),
  each with its first two derivatives with respect to tau = ln(1 + s / scale).
*/
void LamFreeCellEnergy(const LamFreeCell *cell, PetscReal s, PetscReal energy[3], PetscReal turgor[2][3]);
/* To and from JSON, with all digits. PETSC_ERR_USER_INPUT naming `path` if the object is not a free cell. */
PetscErrorCode LamFreeCellToJSON(const LamFreeCell *cell, json_t **object);
PetscErrorCode LamFreeCellFromJSON(const char path[], json_t *object, LamFreeCell *cell);

#endif
