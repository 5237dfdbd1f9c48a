#include "kernels.h"

static void Fill(double value, LamPoints points)
{
  LAM_EACH_POINT(g) points[g] = value;
}

MatrixPoint MatrixAt(const LamWallLaw *law, const LamWall *wall, const double F[4], double F33)
{
  LamPoints H[4];
  LamKernel k;
  MatrixPoint at;

  for (int r = 0; r < 4; r++) Fill(F[r] - (r == 0 || r == 3), H[r]);
  law->matrix(wall, H, F33 - 1.0, PETSC_TRUE, &k);
  at.W = k.W[0];
  for (int r = 0; r < LAM_KERNEL_COMPONENTS; r++) {
    at.P[r] = k.P[r][0];
    for (int c = r; c < LAM_KERNEL_COMPONENTS; c++) at.A[r][c] = at.A[c][r] = k.A[r][c][0];
  }
  return at;
}

static KernelPoint First(const LamKernel1 *k)
{
  return (KernelPoint){k->W[0], k->d[0], k->dd[0]};
}

KernelPoint FibreAt(const LamWallLaw *law, const LamWall *wall, double strain)
{
  LamPoints strains;
  LamKernel1 k;

  Fill(strain, strains);
  law->fibre(wall, strains, &k);
  return First(&k);
}

KernelPoint VolumetricAt(const LamWall *wall, double dilation)
{
  LamPoints dilations;
  LamKernel1 k;

  Fill(dilation, dilations);
  LamVolumetric(wall, dilations, PETSC_TRUE, &k);
  return First(&k);
}
