/*
  Wall laws: a table of pointwise kernels, each an energy density with its first and second derivatives.

  W = W_matrix(F, F33) + W_fibre(I4) + U(J),  plane strain with a prescribed stretch F33 along the prism axis.
  The matrix part is isochoric. U is the same for every law: U(J) = kappa/4 (J^2 - 1 - 2 ln J), applied to the
  projected dilatation (element.h). I4 = M.CM with the full C and M along the wall (Mihai, Safar & Wyatt, eq. 4.1).
  Energies and stresses in C1 + C2. A new law is one kernel file and one row in wall_law.c.
*/
#ifndef LAM_RVE_WALL_LAW_H
#define LAM_RVE_WALL_LAW_H

#include <petscsys.h>
#include <lamella/scene.h>

/* Components of (F, F33) in kernels: 0..3 are F11 F12 F21 F22, 4 is F33. */
#define LAM_KERNEL_COMPONENTS 5

typedef struct {
  PetscReal W;
  PetscReal P[LAM_KERNEL_COMPONENTS];                        /* dW/dF */
  PetscReal A[LAM_KERNEL_COMPONENTS][LAM_KERNEL_COMPONENTS]; /* d2W/dFdF, symmetric */
} LamKernel;

typedef struct {
  PetscReal W, d, dd; /* energy, first and second derivative with respect to the one argument */
} LamKernel1;

typedef struct {
  LamWallLawType type;
  /* Isochoric matrix; needs det F > 0 and F33 > 0. */
  void (*matrix)(const LamWall *wall, const PetscReal F[4], PetscReal F33, LamKernel *out);
  /* Fibres as a function of I4; NULL where the law has none. */
  void (*fibre)(const LamWall *wall, PetscReal I4, LamKernel1 *out);
} LamWallLaw;

PetscErrorCode LamWallLawGet(LamWallLawType type, const LamWallLaw **law);

/* Kernels, one file each. */
void LamMatrixMooneyRivlin(const LamWall *wall, const PetscReal F[4], PetscReal F33, LamKernel *out);
void LamFibreQuadratic(const LamWall *wall, PetscReal I4, LamKernel1 *out);

/* U(J) = kappa/4 (J^2 - 1 - 2 ln J), J > 0. */
static inline void LamVolumetric(const LamWall *wall, PetscReal J, LamKernel1 *out)
{
  out->W = 0.25 * wall->bulk_modulus * ((J - 1.0) * (J + 1.0) - 2.0 * PetscLogReal(J));
  out->d = 0.5 * wall->bulk_modulus * (J - 1.0) * (J + 1.0) / J;
  out->dd = 0.5 * wall->bulk_modulus * (1.0 + 1.0 / (J * J));
}

#endif
