/*
  The wall element: nine-node quadrilateral, discontinuous linear pressure (Q2/P1disc), 3 x 3 Gauss points. Quantities
  at the points are arrays over them (wall_law.h).

  Energy of one element. The input is the nodal displacement u; its gradient H = F - 1 avoids cancellation at small
  strains.
    Pi_e = sum_g w_g [ W_matrix(F_g) + W_fibre(E_g) + U(theta_g) ],
    theta = projection of J = F33 det F onto span(psi_0, psi_1, psi_2),
  where the psi_k span the linear functions of the reference coordinates and are orthonormal on the element, so
  theta = psi.c with c = sum w psi J. Everything below is a derivative of Pi_e. The pressure is p = psi.q,
  q = sum w psi U'(theta).

  Independent stresses (Magisano, Leonetti & Garcea, IJNME 2017; Haggblad & Sundberg, Comput. Struct. 1983): the tangent
  uses p* and s* = dW_fibre/dE, which are updated by their own linearised equations; the residual is the gradient of
  the energy. Newton then converges in few full steps for kappa, C4 >> C1.

  Walls with memory (wall_memory.h) add history : E with the constant `history` of the step, components 11, 12, 22, 33
  at the points; NULL: no memory.
*/
#ifndef LAM_RVE_ELEMENT_H
#define LAM_RVE_ELEMENT_H

#include "mesh.h"
#include "wall_law.h"

#define LAM_GAUSS 9
#define LAM_PADDED_NODES 12 /* nodes padded to whole vector registers */
#define LAM_ELEMENT_DOFS 18 /* dof = 2 node + component */
#define LAM_PRESSURES 3

typedef struct {
  PetscReal dN[2 * LAM_GAUSS][LAM_PADDED_NODES]; /* [2 g + J][node]: dN/dX_J; padding is zero */
  LamPoints shape[2][LAM_ELEMENT_NODES];         /* [J][node]: the same; padded with the last point */
  LamPoints weight;                              /* quadrature weight times reference area; padding is zero */
  LamPoints psi[LAM_PRESSURES];
  PetscReal fibre[2]; /* M, in the section */
  /* [2] shear g = (F31, F32) out of the section at the points, in a frame whose third axis is that of the cells; held
     by all functions below but LamElementShear. NULL: none; borrowed */
  const LamPoints *shear;
} LamElementGeometry;

/* Independent stresses, and the stresses at the last evaluated displacements. */
typedef struct {
  PetscReal p[LAM_PRESSURES], px[LAM_PRESSURES]; /* p*; at the last evaluated u */
  LamPoints s, sx, dds;                          /* s*; at the last evaluated u; d2W_fibre/dE^2 there */
  PetscReal H[LAM_PRESSURES][LAM_PRESSURES];     /* dq/dc = sum w psi psi U'' */
} LamElementStress;

/* X[9][2]: reference positions; fibre: unit vector along the wall. */
PetscErrorCode LamElementSetGeometry(const PetscReal X[][2], const PetscReal fibre[2], LamElementGeometry *geometry);

typedef struct {
  PetscReal energy;
  PetscReal f[LAM_ELEMENT_DOFS];                   /* dPi_e/dx */
  PetscReal K[LAM_ELEMENT_DOFS][LAM_ELEMENT_DOFS]; /* tangent, symmetric */
} LamElementResult;

/* Returns PETSC_FALSE if det F or theta is not positive at a Gauss point. */
PetscBool LamElementIsValid(const LamElementGeometry *geometry, const PetscReal u[][2], PetscReal F33);

/* Energy only. *valid is PETSC_FALSE if det F or theta is not positive, or if the energy overflows. */
void LamElementEnergy(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const LamPoints *history, const PetscReal u[][2], PetscReal F33, PetscReal *energy,
                      PetscBool *valid);

/* Energy, residual dPi_e/dx, and tangent with the independent stresses. Updates px, sx, dds and H of `stress`; *valid
   as for LamElementEnergy. */
void LamElementEvaluate(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                        const LamPoints *history, const PetscReal u[][2], PetscReal F33, LamElementStress *stress,
                        LamElementResult *out, PetscBool *valid);

/* Updates the independent stresses: stress* += alpha (stress(u) + d stress(u).(du, dF33) - stress*), at the u of the
   last evaluation. */
void LamElementUpdateStress(const LamElementGeometry *geometry, const LamWall *wall, const PetscReal u[][2],
                            const PetscReal du[][2], PetscReal F33, PetscReal dF33, PetscReal alpha,
                            LamElementStress *stress);

/* Sets the independent stresses to the stresses at u. Returns PETSC_FALSE if u is not valid. */
PetscBool LamElementSetConsistentStress(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                        const PetscReal u[][2], PetscReal F33, LamElementStress *stress);

/* Derivatives with respect to F33 at fixed u. force = dPi_e/dF33 uses the stresses of the last evaluation. fx =
   d2Pi_e/dx dF33 and ff = d2Pi_e/dF33^2 use the independent stresses, as the tangent does. */
void LamElementStretch33(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                         const LamPoints *history, const PetscReal u[][2], PetscReal F33,
                         const LamElementStress *stress, PetscReal *force, PetscReal fx[LAM_ELEMENT_DOFS],
                         PetscReal *ff);

/* dPi_e/dx alone; u must be valid. */
void LamElementForces(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const LamPoints *history, const PetscReal u[][2], PetscReal F33, PetscReal f[LAM_ELEMENT_DOFS]);

/* Fibre stretch sqrt(I4) and largest in-plane principal Cauchy stress at the Gauss points. */
void LamElementFields(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const LamPoints *history, const PetscReal u[][2], PetscReal F33, PetscReal fibre[LAM_GAUSS],
                      PetscReal stress[LAM_GAUSS]);

/* Contribution of one Gauss point to integrals over the wall, per reference thickness. */
typedef struct {
  PetscReal reference, volume; /* reference and current volume */
  PetscReal stretch;           /* int sqrt(I4) dV, reference */
  PetscReal energy;            /* int W_matrix + W_fibre dV, reference, without that of a history */
  PetscReal tension;           /* int m.sigma m dv, current; m: current fibre direction, sigma: Cauchy stress */
  PetscReal ellipticity;       /* int of the smallest stiffness against isochoric shear bands dV (wall_ellipticity.h) */
  PetscReal kinked;            /* reference volume where ellipticity is negative */
} LamWallPoint;
void LamElementWallPoints(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                          const LamPoints *history, const PetscReal u[][2], PetscReal F33,
                          LamWallPoint points[LAM_GAUSS]);

/* Derivatives with respect to the third component z of the positions of the nodes, g = sum z dN, at the u and the
   stress of the last evaluation (with a history: at g = 0): dPi_e/dz, and its derivatives with respect to z, x and F33.
 */
typedef struct {
  PetscReal f[LAM_ELEMENT_NODES], K[LAM_ELEMENT_NODES][LAM_ELEMENT_NODES];
  PetscReal mixed[LAM_ELEMENT_NODES][LAM_ELEMENT_DOFS], f33[LAM_ELEMENT_NODES];
} LamElementAxial;
void LamElementShear(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                     const LamPoints *history, const PetscReal u[][2], PetscReal F33, const LamElementStress *stress,
                     LamElementAxial *out);

/* Nine-node shape functions and their derivatives at (xi, eta) in [-1, 1]^2; node order of LamMesh. */
void LamShape(PetscReal xi, PetscReal eta, PetscReal N[9], PetscReal dN[9][2]);

/* Gauss point g: 3 x 3, abscissae in [-1, 1]. */
void LamGaussPoint(PetscInt g, PetscReal *xi, PetscReal *eta, PetscReal *weight);

#endif
