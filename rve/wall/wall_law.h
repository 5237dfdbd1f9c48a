/*
  Wall laws: a table of kernels, each an energy density with its first and second derivatives at points of the wall.

  W = W_matrix(F, F33) + W_fibre(E) + U(J),  plane strain with a prescribed stretch F33 along the prism axis.
  The matrix part is isochoric. U is the same for every law: U(J) = kappa/4 (J^2 - 1 - 2 ln J), applied to the
  projected dilatation (element.h). E = I4 - 1, I4 = M.CM with the full C and M along the wall (Mihai, Safar & Wyatt,
  eq. 4.1); with a dispersion d of the fibres E = d (I1 - 3) + (1 - 3 d) (I4 - 1), I1 = tr C (Gasser, Ogden & Holzapfel,
  J. R. Soc. Interface 3 (2006) 15-35: the generalised structure tensor). Fibres may leave the section by an angle, and
  there may be shear out of it (matrix_shear.c). Kernels take deviations from the undeformed
  wall, H = F - 1, E and J - 1, so that energy and stress keep full relative accuracy at small strains. Unit of energies
  and stresses: C1 + C2.
  A new law is one kernel file and one row in wall_law.c.
*/
#ifndef LAM_RVE_WALL_LAW_H
#define LAM_RVE_WALL_LAW_H

#include <petscsys.h>
#include <lamella/scene.h>
#include "clones.h"

/* Kernels take all points of an element at once: nine, padded to whole vector registers. Loops over points are written
   so that the compiler vectorises them. */
#define LAM_POINTS 12
typedef PetscReal LamPoints[LAM_POINTS];
#define LAM_EACH_POINT(g) for (PetscInt g = 0; g < LAM_POINTS; ++g)

/* Components of (F, F33), and of (H, H33), in kernels: 0..3 are F11 F12 F21 F22, 4 is F33. */
#define LAM_KERNEL_COMPONENTS 5

typedef struct {
  LamPoints W;
  LamPoints P[LAM_KERNEL_COMPONENTS];                        /* dW/dF */
  LamPoints A[LAM_KERNEL_COMPONENTS][LAM_KERNEL_COMPONENTS]; /* d2W/dFdF, [r][c] with r <= c */
} LamKernel;

/* The same of what shear out of the section adds: components 5 and 6 are g = (F31, F32) in the frame of the section. */
#define LAM_SHEAR_COMPONENTS 7
typedef struct {
  LamPoints W;
  LamPoints P[LAM_SHEAR_COMPONENTS];
  LamPoints A[LAM_SHEAR_COMPONENTS][LAM_SHEAR_COMPONENTS];
} LamShearKernel;

typedef struct {
  LamPoints W, d, dd; /* energy, first and second derivative with respect to the one argument */
} LamKernel1;

typedef struct {
  LamWallLawType type;
  /* Isochoric matrix at F = 1 + H, F33 = 1 + H33; requires det F > 0 and F33 > 0. Without `derivatives` W alone. */
  void (*matrix)(const LamWall *wall, const LamPoints H[4], PetscReal H33, PetscBool derivatives, LamKernel *out);
  /* What shear g out of the section adds to it. */
  void (*shear)(const LamWall *wall, const LamPoints H[4], PetscReal H33, const LamPoints g[2], PetscBool derivatives,
                LamShearKernel *out);
  /* Fibres as a function of their strain E; NULL if the law has no fibres. */
  void (*fibre)(const LamWall *wall, const LamPoints strain, LamKernel1 *out);
} LamWallLaw;

PetscErrorCode LamWallLawGet(LamWallLawType type, const LamWallLaw **law);

/* Kernels, one file each. */
void LamMatrixMooneyRivlin(const LamWall *wall, const LamPoints H[4], PetscReal H33, PetscBool derivatives,
                           LamKernel *out);
void LamMatrixShear(const LamWall *wall, const LamPoints H[4], PetscReal H33, const LamPoints g[2],
                    PetscBool derivatives, LamShearKernel *out);
void LamFibreQuadratic(const LamWall *wall, const LamPoints strain, LamKernel1 *out);
void LamFibreExponential(const LamWall *wall, const LamPoints strain, LamKernel1 *out);

#define LAM_LOG_SERIES 0.1 /* largest |e| for which the series serves, ... */
#define LAM_LOG_TERMS 14   /* ... to quadruple precision with as many terms */
/* e - ln(1 + e) for e > -1, without cancellation near 0: with s = e/(2 + e) it is 2 s/(1 - s) - 2 artanh s. */
LAM_INLINE void LamLogRest(const LamPoints e, LamPoints rest)
{
  LAM_EACH_POINT(g)
  {
    const PetscReal s = e[g] / (2.0 + e[g]), s2 = s * s;
    PetscReal sum = 0.0;

    for (PetscInt k = LAM_LOG_TERMS; k > 0; --k) sum = sum * s2 + 1.0 / (PetscReal)(2 * k + 1);
    rest[g] = 2.0 * s2 * (1.0 / (1.0 - s) - s * sum);
  }
  LAM_EACH_POINT(g)
  {
    if (PetscAbsReal(e[g]) > LAM_LOG_SERIES) rest[g] = e[g] - PetscLogReal(1.0 + e[g]);
  }
}

/* U(J) = kappa/4 (J^2 - 1 - 2 ln J), J = 1 + dilation > 0; energy: whether W is wanted. */
LAM_INLINE void LamVolumetric(const LamWall *wall, const LamPoints dilation, PetscBool energy, LamKernel1 *out)
{
  if (energy) LamLogRest(dilation, out->W);
  LAM_EACH_POINT(g)
  {
    const PetscReal inverse = 1.0 / (1.0 + dilation[g]);

    if (energy) out->W[g] = 0.25 * wall->bulk_modulus * (dilation[g] * dilation[g] + 2.0 * out->W[g]);
    out->d[g] = 0.5 * wall->bulk_modulus * dilation[g] * (2.0 + dilation[g]) * inverse;
    out->dd[g] = 0.5 * wall->bulk_modulus * (1.0 + inverse * inverse);
  }
}

#endif
