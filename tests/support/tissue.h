/* The tissue that tests and bench programs share, loads, and one solve from the reference state. */
#ifndef LAM_SUPPORT_TISSUE_H
#define LAM_SUPPORT_TISSUE_H

#include <lamella/lamella.h>

#define TISSUE_STRESS 0.11 /* C1 + C2 of the default tissue, MPa */
/* The default tissue (C1 = 0.1, C2 = 0.01, C4 = 1 MPa) with one cell and the coarse mesh. */
LamMicrostructure DefaultTissue(void);
/* LamStressError of this tissue. */
PetscReal StressError(const PetscReal P[9], const PetscReal P_ref[9]);
LamLoad PlaneLoad(double F11, double F12, double F21, double F22, double turgor);
/* Of walls that have relaxed: elastic tissue whose matrix and fibres have `left` of their moduli; a load with all of F in
   the plane, F33 and turgor. */
LamMicrostructure TissueLeft(LamMicrostructure micro, double left);
LamLoad StretchedLoad(void);
/* An RVE that is set up, and a state of it (or NULL); with lumens that may be sealed. */
PetscErrorCode NewTissue(const LamMicrostructure *micro, LamRVE *rve, LamRVEState *state);
PetscErrorCode NewSealableTissue(const LamMicrostructure *micro, PetscBool sealable, LamRVE *rve, LamRVEState *state);
PetscErrorCode DestroyTissue(LamRVE *rve, LamRVEState *state);
/* Solves one load with a new RVE, from F = I in one go. */
PetscErrorCode SolveOnce(const LamMicrostructure *micro, const LamLoad *load, LamResponse *response);

#endif
