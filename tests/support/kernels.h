/* Kernels of a wall law at one point. */
#ifndef TEST_KERNELS_H
#define TEST_KERNELS_H

#include "wall_law.h"

typedef struct {
  double W, P[LAM_KERNEL_COMPONENTS], A[LAM_KERNEL_COMPONENTS][LAM_KERNEL_COMPONENTS];
} MatrixPoint;

typedef struct {
  double W, d, dd;
} KernelPoint;

MatrixPoint MatrixAt(const LamWallLaw *law, const LamWall *wall, const double F[4], double F33);
KernelPoint FibreAt(const LamWallLaw *law, const LamWall *wall, double strain);
KernelPoint VolumetricAt(const LamWall *wall, double dilation);

#endif
