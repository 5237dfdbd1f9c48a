/*
  Wall laws: a table of pointwise kernels, each an energy density with its first and second derivatives.

  W = W_matrix(F, F33) + W_fibre(E) + U(J),  plane strain with a prescribed stretch F33 along the prism axis.
  The matrix part is isochoric. U is the same for every law: U(J) = kappa/4 (J^2 - 1 - 2 ln J), applied to the
  projected dilatation (element.h). E = I4 - 1, I4 = M.CM with the full C and M along the wall (Mihai, Safar & Wyatt,
  eq. 4.1); with a dispersion d of the fibres E = d (I1 - 3) + (1 - 3 d) (I4 - 1), I1 = tr C (Gasser, Ogden & Holzapfel,
  J. R. Soc. Interface 3 (2006) 15-35: the generalised structure tensor). Kernels take deviations from the undeformed
  wall, H = F - 1, E and J - 1, so that energy and stress keep full relative accuracy at small strains. Unit of energies
  and stresses: C1 + C2.
  A new law is one kernel file and one row in wall_law.c.
*/
#ifndef LAM_RVE_WALL_LAW_H
#define LAM_RVE_WALL_LAW_H

#include <petscsys.h>
#include <lamella/scene.h>

/* Components of (F, F33), and of (H, H33), in kernels: 0..3 are F11 F12 F21 F22, 4 is F33. */
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
  /* Isochoric matrix at F = 1 + H, F33 = 1 + H33; requires det F > 0 and F33 > 0. */
  void (*matrix)(const LamWall *wall, const PetscReal H[4], PetscReal H33, LamKernel *out);
  /* Fibres as a function of their strain E; NULL if the law has no fibres. */
  void (*fibre)(const LamWall *wall, PetscReal strain, LamKernel1 *out);
} LamWallLaw;

PetscErrorCode LamWallLawGet(LamWallLawType type, const LamWallLaw **law);
/* C4 of quadratic fibres with the same stiffness at zero strain; 0 without fibres. */
PetscReal LamWallFibreModulus(const LamWall *wall);

/* Kernels, one file each. */
void LamMatrixMooneyRivlin(const LamWall *wall, const PetscReal H[4], PetscReal H33, LamKernel *out);
void LamFibreQuadratic(const LamWall *wall, PetscReal strain, LamKernel1 *out);
void LamFibreExponential(const LamWall *wall, PetscReal strain, LamKernel1 *out);

/* Matrix kernel evaluated at F instead of H = F - 1. */
static inline void LamMatrixAt(const LamWallLaw *law, const LamWall *wall, const PetscReal F[4], PetscReal F33,
                               LamKernel *out)
{
  const PetscReal H[4] = {F[0] - 1.0, F[1], F[2], F[3] - 1.0};

  law->matrix(wall, H, F33 - 1.0, out);
}

/* e - ln(1 + e) for e > -1, without cancellation near 0: with s = e/(2 + e) it is 2 s/(1 - s) - 2 artanh s. */
static inline PetscReal LamLogRest(PetscReal e)
{
  const PetscReal s = e / (2.0 + e), s2 = s * s;
  PetscReal sum = 0.0, power = 1.0;

  if (PetscAbsReal(e) > 0.1) return e - PetscLogReal(1.0 + e);
  for (PetscInt k = 3; power > PETSC_MACHINE_EPSILON; k += 2, power *= s2) sum += power / (PetscReal)k;
  return 2.0 * s2 * (1.0 / (1.0 - s) - s * sum);
}

/* U(J) = kappa/4 (J^2 - 1 - 2 ln J), J = 1 + dilation > 0. */
static inline void LamVolumetric(const LamWall *wall, PetscReal dilation, LamKernel1 *out)
{
  const PetscReal inverse = 1.0 / (1.0 + dilation);

  out->W = 0.25 * wall->bulk_modulus * (dilation * dilation + 2.0 * LamLogRest(dilation));
  out->d = 0.5 * wall->bulk_modulus * dilation * (2.0 + dilation) * inverse;
  out->dd = 0.5 * wall->bulk_modulus * (1.0 + inverse * inverse);
}

#endif
