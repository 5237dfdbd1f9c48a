/* Stresses and integrals of a wall element, for pictures and measures. */
#include "element_points.h"
#include "wall_ellipticity.h"

/* F, I4 - 1 and the stresses of positions u, without independent stresses: A lacks what these multiply. */
LAM_INLINE void FindWallStress(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                               const PetscReal u[][2], PetscReal F33, LamPoints F[4], LamPoints extension,
                               LamElementStress *local, PointStress *at)
{
  LamPoints H[4], dilation;
  LamKernel1 volume;

  *local = (LamElementStress){0};
  (void)Kinematics(geometry, u, F33, H, dilation);
  LamVolumetric(wall, dilation, PETSC_FALSE, &volume);
  Pressures(geometry, &volume, local);
  FindStress(geometry, law, wall, H, F33, local, at);
  Deformation(H, F);
  Extension(geometry, H, extension);
}

LAM_CLONES static void ElementForces(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                     const PetscReal u[][2], PetscReal F33, PetscReal f[LAM_ELEMENT_DOFS])
{
  LamPoints F[4], extension;
  LamElementStress local;
  PointStress at;

  FindWallStress(geometry, law, wall, u, F33, F, extension, &local, &at);
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt i = 0; i < 2; ++i) {
      LamPoints part;

      LAM_EACH_POINT(g)
      {
        part[g] = at.P[2 * i][g] * geometry->shape[0][a][g] + at.P[2 * i + 1][g] * geometry->shape[1][a][g];
      }
      f[2 * a + i] = Total(part);
    }
}

void LamElementForces(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const LamPoints *history, const PetscReal u[][2], PetscReal F33, PetscReal f[LAM_ELEMENT_DOFS])
{
  ElementForces(geometry, law, wall, u, F33, f);
  if (history) LamHistoryForces(geometry, history, u, f);
}

LAM_CLONES static void ElementFields(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                     const LamPoints *history, const PetscReal u[][2], PetscReal F33,
                                     PetscReal fibre[LAM_GAUSS], PetscReal stress[LAM_GAUSS])
{
  LamPoints F[4], extension;
  LamElementStress local;
  PointStress at;

  FindWallStress(geometry, law, wall, u, F33, F, extension, &local, &at);
  TiltedExtension(geometry, wall, F33, extension);
  if (history) LamHistoryPoints(geometry, history, (const LamPoints *)F, &at);
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal scale = 1.0 / (geometry->weight[g] * (F[0][g] * F[3][g] - F[1][g] * F[2][g]) * F33);
    const PetscReal s11 = scale * (at.P[0][g] * F[0][g] + at.P[1][g] * F[1][g]); /* sigma = P F^T / J */
    const PetscReal s12 = scale * (at.P[0][g] * F[2][g] + at.P[1][g] * F[3][g]);
    const PetscReal s22 = scale * (at.P[2][g] * F[2][g] + at.P[3][g] * F[3][g]);

    fibre[g] = PetscSqrtReal(1.0 + extension[g]);
    stress[g] = 0.5 * (s11 + s22) + PetscSqrtReal(0.25 * PetscSqr(s11 - s22) + s12 * s12);
  }
}

void LamElementFields(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const LamPoints *history, const PetscReal u[][2], PetscReal F33, PetscReal fibre[LAM_GAUSS],
                      PetscReal stress[LAM_GAUSS])
{
  ElementFields(geometry, law, wall, history, u, F33, fibre, stress);
}

LAM_CLONES static void ElementWallPoints(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                         const LamPoints *history, const PetscReal u[][2], PetscReal F33,
                                         LamWallPoint points[LAM_GAUSS])
{
  LamPoints F[4], Fm[2], extension, along; /* of the fibres, and of the wall in the section */
  LamElementStress local;
  PointStress at;
  PetscReal h[2][2];

  FindWallStress(geometry, law, wall, u, F33, F, extension, &local, &at);
  if (history) LamHistoryPoints(geometry, history, (const LamPoints *)F, &at);
  AlongFibre(geometry, F, Fm);
  StructureTensor(geometry, wall, h);
  for (PetscInt g = 0; g < LAM_POINTS; ++g) along[g] = extension[g];
  TiltedExtension(geometry, wall, F33, extension);
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal w = geometry->weight[g], I4 = 1.0 + along[g], f[4] = {F[0][g], F[1][g], F[2][g], F[3][g]};
    PetscReal tm[2], A[4][4];

    points[g].energy = at.energy[g];
    points[g].reference = w;
    points[g].volume = w * F33 * (f[0] * f[3] - f[1] * f[2]);
    points[g].stretch = w * PetscSqrtReal(1.0 + extension[g]);
    /* w J sigma = (w P) F^T; m = Fm / |Fm| */
    for (PetscInt k = 0; k < 2; ++k) tm[k] = (Fm[0][g] * f[k] + Fm[1][g] * f[2 + k]) / I4; /* F^T m / |Fm| */
    points[g].tension =
        Fm[0][g] * (at.P[0][g] * tm[0] + at.P[1][g] * tm[1]) + Fm[1][g] * (at.P[2][g] * tm[0] + at.P[3][g] * tm[1]);
    for (PetscInt r = 0; r < 4; ++r)
      for (PetscInt c = r; c < 4; ++c) {
        const PetscReal geometric = r / 2 == c / 2 ? 2.0 * h[r % 2][c % 2] * local.sx[g] : 0.0;

        A[r][c] = A[c][r] = at.A[r][c][g] + w * geometric;
      }
    points[g].ellipticity = LamShearBandStiffness((const PetscReal(*)[4])A, f);
    points[g].kinked = points[g].ellipticity < 0.0 ? w : 0.0;
  }
}

void LamElementWallPoints(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                          const LamPoints *history, const PetscReal u[][2], PetscReal F33,
                          LamWallPoint points[LAM_GAUSS])
{
  ElementWallPoints(geometry, law, wall, history, u, F33, points);
}
