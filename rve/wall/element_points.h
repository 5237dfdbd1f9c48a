/*
  Kinematics and stresses at all points of a wall element: the inner part of element.c and element_fields.c.
*/
#ifndef LAM_RVE_ELEMENT_POINTS_H
#define LAM_RVE_ELEMENT_POINTS_H

#include "element.h"

/* Sum over all points; padding is zero. Four partial sums, so that it is vectorised. */
LAM_INLINE PetscReal Total(const LamPoints v)
{
  PetscReal s[4];

  for (PetscInt k = 0; k < 4; ++k) s[k] = v[k] + v[4 + k] + v[8 + k];
  return (s[0] + s[1]) + (s[2] + s[3]);
}

/* sum w psi_k v */
LAM_INLINE void Moments(const LamElementGeometry *geometry, const LamPoints v, PetscReal c[LAM_PRESSURES])
{
  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
    LamPoints part;

    LAM_EACH_POINT(g) part[g] = geometry->weight[g] * geometry->psi[k][g] * v[g];
    c[k] = Total(part);
  }
}

/* sum psi_k p_k */
LAM_INLINE void AtPoints(const LamElementGeometry *geometry, const PetscReal p[LAM_PRESSURES], LamPoints v)
{
  LAM_EACH_POINT(g) v[g] = geometry->psi[0][g] * p[0] + geometry->psi[1][g] * p[1] + geometry->psi[2][g] * p[2];
}

/* In-plane displacement gradient: H11 H12 H21 H22. */
LAM_INLINE void Gradient(const LamElementGeometry *geometry, const PetscReal u[][2], LamPoints H[4])
{
  for (PetscInt r = 0; r < 4; ++r) {
    LamPoints sum = {0.0};

    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      LAM_EACH_POINT(g) sum[g] += u[a][r / 2] * geometry->shape[r % 2][a][g];
    LAM_EACH_POINT(g) H[r][g] = sum[g];
  }
}

/* F = 1 + H. */
LAM_INLINE void Deformation(const LamPoints H[4], LamPoints F[4])
{
  for (PetscInt r = 0; r < 4; ++r) LAM_EACH_POINT(g) F[r][g] = H[r][g] + (PetscReal)(r == 0 || r == 3);
}

/* Sign of a component of cof F, whose components are those of F in reverse. */
LAM_INLINE PetscReal CofactorSign(PetscInt r)
{
  return r == 0 || r == 3 ? 1.0 : -1.0;
}

/* H, and J - 1 at all points and projected: theta - 1. Returns PETSC_FALSE if a volume is not positive. */
LAM_INLINE PetscBool Kinematics(const LamElementGeometry *geometry, const PetscReal u[][2], PetscReal F33,
                                LamPoints H[4], LamPoints dilation)
{
  LamPoints local;
  PetscReal c[LAM_PRESSURES];
  PetscInt positive = 0;

  Gradient(geometry, u, H);
  LAM_EACH_POINT(g)
  {
    local[g] = F33 * (H[0][g] + H[3][g] + (H[0][g] * H[3][g] - H[1][g] * H[2][g])) + (F33 - 1.0);
  }
  Moments(geometry, local, c);
  AtPoints(geometry, c, dilation);
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) positive += (1.0 + local[g] > 0.0) + (1.0 + dilation[g] > 0.0);
  return (PetscBool)(positive == 2 * LAM_GAUSS);
}

/* A m. */
LAM_INLINE void AlongFibre(const LamElementGeometry *geometry, const LamPoints A[4], LamPoints Am[2])
{
  const PetscReal *m = geometry->fibre;

  for (PetscInt i = 0; i < 2; ++i) LAM_EACH_POINT(g) Am[i][g] = A[2 * i][g] * m[0] + A[2 * i + 1][g] * m[1];
}

/* I4 - 1, I4 = |Fm|^2; m is a unit vector. */
LAM_INLINE void Extension(const LamElementGeometry *geometry, const LamPoints H[4], LamPoints extension)
{
  const PetscReal *m = geometry->fibre;
  LamPoints Hm[2];

  AlongFibre(geometry, H, Hm);
  LAM_EACH_POINT(g)
  {
    extension[g] = 2.0 * (m[0] * Hm[0][g] + m[1] * Hm[1][g]) + (Hm[0][g] * Hm[0][g] + Hm[1][g] * Hm[1][g]);
  }
}

/* Cosine and sine of the angle at which the fibres leave the section. */
typedef struct {
  PetscReal c, s;
} Tilt;
LAM_INLINE Tilt FibreTilt(const LamWall *wall)
{
  if (wall->fibre_angle == 0.0) return (Tilt){1.0, 0.0};
  return (Tilt){PetscCosReal(wall->fibre_angle), PetscSinReal(wall->fibre_angle)};
}

/* Third component of F M, M = (c m, s): c g.m + s F33. */
LAM_INLINE void FibreAxial(const LamElementGeometry *geometry, const LamWall *wall, PetscReal F33, LamPoints axial)
{
  const Tilt tilt = FibreTilt(wall);
  const PetscReal *m = geometry->fibre;

  LAM_EACH_POINT(g) axial[g] = tilt.s * F33;
  if (!geometry->shear) return;
  LAM_EACH_POINT(g) axial[g] += tilt.c * (geometry->shear[0][g] * m[0] + geometry->shear[1][g] * m[1]);
}

/* I4 - 1 of the fibres themselves, where they leave the section or there is shear out of it. */
LAM_INLINE void TiltedExtension(const LamElementGeometry *geometry, const LamWall *wall, PetscReal F33,
                                LamPoints extension)
{
  const Tilt tilt = FibreTilt(wall);
  LamPoints axial;

  if (wall->fibre_angle == 0.0 && !geometry->shear) return;
  FibreAxial(geometry, wall, F33, axial);
  LAM_EACH_POINT(g)
  {
    extension[g] = tilt.c * tilt.c * extension[g] + (axial[g] - tilt.s) * (axial[g] + tilt.s);
  }
}

/*
  Fibre strain E = h:C - 1 with h = d 1 + (1 - 3 d) M (x) M, d the dispersion, C with F33 and g; E = I4 - 1 for d = 0.
  With M = (c m, s) and q = c g.m + s F33 its derivatives are dE/dF = 2 F h, h in the plane, d2E/dFdF = 2 (1 (x) h),
  dE/dF33 = 2 d F33 + 2 (1 - 3 d) s q, dE/dg = 2 d g + 2 (1 - 3 d) c q m.
*/
LAM_INLINE void FibreStrain(const LamElementGeometry *geometry, const LamWall *wall, const LamPoints H[4],
                            PetscReal F33, LamPoints strain)
{
  const PetscReal d = wall->dispersion, out_of_plane = (F33 - 1.0) * (F33 + 1.0);

  Extension(geometry, H, strain);
  TiltedExtension(geometry, wall, F33, strain);
  if (d == 0.0) return;
  LAM_EACH_POINT(g)
  {
    const PetscReal H2 = H[0][g] * H[0][g] + H[1][g] * H[1][g] + H[2][g] * H[2][g] + H[3][g] * H[3][g];

    strain[g] += d * (2.0 * (H[0][g] + H[3][g]) + H2 + out_of_plane /* I1 - 3 */ - 3.0 * strain[g]);
  }
  if (!geometry->shear) return;
  LAM_EACH_POINT(g) strain[g] += d * (PetscSqr(geometry->shear[0][g]) + PetscSqr(geometry->shear[1][g]));
}

/* h, in the plane. */
LAM_INLINE void StructureTensor(const LamElementGeometry *geometry, const LamWall *wall, PetscReal h[2][2])
{
  const PetscReal *m = geometry->fibre, d = wall->dispersion, c = FibreTilt(wall).c;

  for (PetscInt j = 0; j < 2; ++j)
    for (PetscInt l = 0; l < 2; ++l) h[j][l] = d * (PetscReal)(j == l) + (1.0 - 3.0 * d) * c * c * m[j] * m[l];
}

/* dE/dF = 2 F h. */
LAM_INLINE void FibreStrainGradient(const PetscReal h[2][2], const LamPoints F[4], LamPoints dE[4])
{
  for (PetscInt r = 0; r < 4; ++r) LAM_EACH_POINT(g)
    {
      dE[r][g] = 2.0 * (F[r - r % 2][g] * h[0][r % 2] + F[r - r % 2 + 1][g] * h[1][r % 2]);
    }
}

/* dE/dF33. */
LAM_INLINE void FibreStrain33(const LamElementGeometry *geometry, const LamWall *wall, PetscReal F33, LamPoints dE33)
{
  const PetscReal share = 2.0 * (1.0 - 3.0 * wall->dispersion) * FibreTilt(wall).s;

  LAM_EACH_POINT(g) dE33[g] = 2.0 * wall->dispersion * F33;
  if (share == 0.0) return;
  LamPoints axial;

  FibreAxial(geometry, wall, F33, axial);
  LAM_EACH_POINT(g) dE33[g] += share * axial[g];
}

/* Energies and stresses of the fibres at all points; zero without fibres. */
LAM_INLINE void Fibres(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                       const LamPoints H[4], PetscReal F33, LamKernel1 *fibre)
{
  LamPoints strain;

  FibreStrain(geometry, wall, H, F33, strain);
  if (law->fibre)
    law->fibre(wall, strain, fibre);
  else
    LAM_EACH_POINT(g) fibre->W[g] = fibre->d[g] = fibre->dd[g] = 0.0;
}

/* The matrix, with what shear out of the section adds to it. */
LAM_INLINE void MatrixKernel(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                             const LamPoints H[4], PetscReal F33, PetscBool derivatives, LamKernel *out)
{
  LamShearKernel more;

  law->matrix(wall, H, F33 - 1.0, derivatives, out);
  if (!geometry->shear) return;
  law->shear(wall, H, F33 - 1.0, geometry->shear, derivatives, &more);
  LAM_EACH_POINT(g) out->W[g] += more.W[g];
  for (PetscInt r = 0; r < LAM_KERNEL_COMPONENTS && derivatives; ++r) {
    LAM_EACH_POINT(g) out->P[r][g] += more.P[r][g];
    for (PetscInt c = r; c < LAM_KERNEL_COMPONENTS; ++c) LAM_EACH_POINT(g) out->A[r][c][g] += more.A[r][c][g];
  }
}

/* px = q = sum w psi U'(theta), stress->H = sum w psi psi U''(theta). */
LAM_INLINE void Pressures(const LamElementGeometry *geometry, const LamKernel1 *volume, LamElementStress *stress)
{
  Moments(geometry, volume->d, stress->px);
  for (PetscInt l = 0; l < LAM_PRESSURES; ++l) {
    LamPoints part;

    LAM_EACH_POINT(g) part[g] = geometry->psi[l][g] * volume->dd[g];
    Moments(geometry, part, stress->H[l]);
  }
}

/* Energy without U, stress P and tangent A at all points, A [r][c] with r <= c, times the weights. The stress uses px
   and sx (of u), the tangent the independent p* and s*; LamElementEvaluate adds the projection term of the pressure. */
typedef struct {
  LamPoints energy, P[4], A[4][4];
} PointStress;

LAM_INLINE void FindStress(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                           const LamPoints H[4], PetscReal F33, LamElementStress *stress, PointStress *out)
{
  LamPoints F[4], dE[4], p, p_star;
  PetscReal h[2][2];
  LamKernel1 fibre;
  LamKernel k;

  MatrixKernel(geometry, law, wall, H, F33, PETSC_TRUE, &k);
  Fibres(geometry, law, wall, H, F33, &fibre);
  Deformation(H, F);
  StructureTensor(geometry, wall, h);
  FibreStrainGradient((const PetscReal(*)[2])h, F, dE);
  AtPoints(geometry, stress->px, p);
  AtPoints(geometry, stress->p, p_star);
  LAM_EACH_POINT(g)
  {
    out->energy[g] = geometry->weight[g] * (k.W[g] + fibre.W[g]);
    stress->sx[g] = fibre.d[g];
    stress->dds[g] = fibre.dd[g];
  }
  for (PetscInt r = 0; r < 4; ++r) {
    const PetscReal sign = F33 * CofactorSign(r);

    LAM_EACH_POINT(g)
    {
      out->P[r][g] = geometry->weight[g] * (k.P[r][g] + sign * p[g] * F[3 - r][g] + fibre.d[g] * dE[r][g]);
    }
    for (PetscInt c = r; c < 4; ++c) {
      const PetscReal geometric = r / 2 == c / 2 ? 2.0 * h[r % 2][c % 2] : 0.0; /* d2E/dFdF */
      const PetscReal cofactor = r + c == 3 ? sign : 0.0;                       /* d2j/dFdF */

      LAM_EACH_POINT(g)
      {
        out->A[r][c][g] = geometry->weight[g] * (k.A[r][c][g] + fibre.dd[g] * dE[r][g] * dE[c][g] +
                                                 geometric * stress->s[g] + cofactor * p_star[g]);
      }
    }
  }
}

/* E = (H + H^T + H^T H)/2: components 11, 12, 22, 33. */
LAM_INLINE void GreenStrain(const LamPoints H[4], PetscReal H33, LamPoints E[4])
{
  LAM_EACH_POINT(g)
  {
    E[0][g] = H[0][g] + 0.5 * (H[0][g] * H[0][g] + H[2][g] * H[2][g]);
    E[1][g] = 0.5 * (H[1][g] + H[2][g] + H[0][g] * H[1][g] + H[2][g] * H[3][g]);
    E[2][g] = H[3][g] + 0.5 * (H[1][g] * H[1][g] + H[3][g] * H[3][g]);
    E[3][g] = H33 * (1.0 + 0.5 * H33);
  }
}

/* ---- element_history.c: history : E of walls with memory, and its derivatives F history and 1 (x) history ---- */
PetscReal LamHistoryEnergy(const LamElementGeometry *geometry, const LamPoints *history, const PetscReal u[][2],
                           PetscReal F33);
/* Add to what walls without memory have; F33 is not coupled. Points: times the weights. */
void LamHistoryEvaluate(const LamElementGeometry *geometry, const LamPoints *history, const PetscReal u[][2],
                        PetscReal F33, LamElementResult *out);
void LamHistoryForces(const LamElementGeometry *geometry, const LamPoints *history, const PetscReal u[][2],
                      PetscReal f[LAM_ELEMENT_DOFS]);
void LamHistoryStretch33(const LamElementGeometry *geometry, const LamPoints *history, PetscReal F33, PetscReal *force,
                         PetscReal *ff);
void LamHistoryPoints(const LamElementGeometry *geometry, const LamPoints *history, const LamPoints F[4],
                      PointStress *out);

#endif
