/* Shear out of the section: derivatives with respect to the third component of the nodes' positions. */
#include "element_points.h"

/* At the points, times the weights: derivatives with respect to g, and mixed ones with F11 F12 F21 F22 F33. */
typedef struct {
  LamPoints P[2], A[2][2], mixed[LAM_KERNEL_COMPONENTS][2];
} PointShear;

/* Adds the fibres; dE/dg = 2 d g + 2 (1 - 3 d) c q m. */
static void AddFibres(const LamElementGeometry *geometry, const LamWall *wall, const LamPoints F[4], PetscReal F33,
                      const LamElementStress *stress, PointShear *at)
{
  const PetscReal d = wall->dispersion, *m = geometry->fibre;
  const Tilt tilt = FibreTilt(wall);
  LamPoints axial, dE[LAM_KERNEL_COMPONENTS], dEg[2];
  PetscReal h[2][2];

  StructureTensor(geometry, wall, h);
  FibreStrainGradient((const PetscReal(*)[2])h, F, dE);
  FibreStrain33(geometry, wall, F33, dE[4]);
  FibreAxial(geometry, wall, F33, axial);
  for (PetscInt k = 0; k < 2; ++k) LAM_EACH_POINT(g)
    {
      const PetscReal shear = geometry->shear ? geometry->shear[k][g] : 0.0;

      dEg[k][g] = 2.0 * (d * shear + (1.0 - 3.0 * d) * tilt.c * axial[g] * m[k]);
    }
  for (PetscInt k = 0; k < 2; ++k) LAM_EACH_POINT(g)
    {
      const PetscReal w = geometry->weight[g], s = w * stress->sx[g], dds = w * stress->dds[g];

      at->P[k][g] += s * dEg[k][g];
      for (PetscInt l = 0; l < 2; ++l) at->A[k][l][g] += dds * dEg[k][g] * dEg[l][g] + 2.0 * s * h[k][l];
      for (PetscInt r = 0; r < LAM_KERNEL_COMPONENTS; ++r) at->mixed[r][k][g] += dds * dE[r][g] * dEg[k][g];
      at->mixed[4][k][g] += s * 2.0 * (1.0 - 3.0 * d) * tilt.c * tilt.s * m[k]; /* d2E/dF33dg */
    }
}

static void FindShear(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const LamPoints H[4], PetscReal F33, const LamElementStress *stress, PointShear *at)
{
  static const LamPoints none[2];
  LamShearKernel k;
  LamPoints F[4];

  law->shear(wall, H, F33 - 1.0, geometry->shear ? geometry->shear : none, PETSC_TRUE, &k);
  LAM_EACH_POINT(g)
  {
    const PetscReal w = geometry->weight[g];

    for (PetscInt i = 0; i < 2; ++i) {
      at->P[i][g] = w * k.P[5 + i][g];
      for (PetscInt j = 0; j < 2; ++j) at->A[i][j][g] = w * k.A[5 + PetscMin(i, j)][5 + PetscMax(i, j)][g];
      for (PetscInt r = 0; r < LAM_KERNEL_COMPONENTS; ++r) at->mixed[r][i][g] = w * k.A[r][5 + i][g];
    }
  }
  Deformation(H, F);
  if (law->fibre) AddFibres(geometry, wall, (const LamPoints *)F, F33, stress, at);
}

void LamElementShear(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                     const LamPoints *history, const PetscReal u[][2], PetscReal F33, const LamElementStress *stress,
                     LamElementAxial *out)
{
  PointShear at;
  LamPoints H[4];

  *out = (LamElementAxial){0};
  Gradient(geometry, u, H);
  FindShear(geometry, law, wall, (const LamPoints *)H, F33, stress, &at);
  for (PetscInt k = 0; k < 4 && history; ++k) /* history : E, of E = 1/2 (g (x) g) */
    LAM_EACH_POINT(g)
    {
      at.A[k / 2][k % 2][g] += geometry->weight[g] * history[k == 0 ? 0 : k == 3 ? 2 : 1][g];
    }
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal *dN[2] = {geometry->dN[2 * g], geometry->dN[2 * g + 1]};

    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
      PetscReal row[2], mixed[LAM_KERNEL_COMPONENTS];

      for (PetscInt l = 0; l < 2; ++l) row[l] = dN[0][a] * at.A[0][l][g] + dN[1][a] * at.A[1][l][g];
      for (PetscInt r = 0; r < LAM_KERNEL_COMPONENTS; ++r)
        mixed[r] = dN[0][a] * at.mixed[r][0][g] + dN[1][a] * at.mixed[r][1][g];
      out->f[a] += dN[0][a] * at.P[0][g] + dN[1][a] * at.P[1][g];
      out->f33[a] += mixed[4];
      for (PetscInt b = 0; b < LAM_ELEMENT_NODES; ++b) {
        out->K[a][b] += row[0] * dN[0][b] + row[1] * dN[1][b];
        for (PetscInt i = 0; i < 2; ++i)
          out->mixed[a][2 * b + i] += mixed[2 * i] * dN[0][b] + mixed[2 * i + 1] * dN[1][b];
      }
    }
  }
}
