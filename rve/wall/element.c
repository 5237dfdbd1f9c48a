#include "element_points.h"

void LamGaussPoint(PetscInt g, PetscReal *xi, PetscReal *eta, PetscReal *weight)
{
  const PetscReal r = PetscSqrtReal((PetscReal)3.0 / 5.0);
  const PetscReal point[3] = {-r, 0.0, r}, w[3] = {(PetscReal)5.0 / 9.0, (PetscReal)8.0 / 9.0, (PetscReal)5.0 / 9.0};

  *xi = point[g % 3];
  *eta = point[g / 3];
  *weight = w[g % 3] * w[g / 3];
}

/* Quadratic Lagrange functions at -1, 0, 1. */
static void Quadratic(PetscReal t, PetscReal N[3], PetscReal d[3])
{
  N[0] = 0.5 * t * (t - 1.0);
  N[1] = 1.0 - t * t;
  N[2] = 0.5 * t * (t + 1.0);
  d[0] = t - 0.5;
  d[1] = -2.0 * t;
  d[2] = t + 0.5;
}

void LamShape(PetscReal xi, PetscReal eta, PetscReal N[9], PetscReal dN[9][2])
{
  static const PetscInt at[9][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}};
  PetscReal Nx[3], Ny[3], dx[3], dy[3];

  Quadratic(xi, Nx, dx);
  Quadratic(eta, Ny, dy);
  for (PetscInt a = 0; a < 9; ++a) {
    N[a] = Nx[at[a][0]] * Ny[at[a][1]];
    dN[a][0] = dx[at[a][0]] * Ny[at[a][1]];
    dN[a][1] = Nx[at[a][0]] * dy[at[a][1]];
  }
}

/* sum w a b */
static PetscReal Overlap(const LamElementGeometry *geometry, const LamPoints a, const LamPoints b)
{
  PetscReal sum = 0.0;

  for (PetscInt g = 0; g < LAM_GAUSS; ++g) sum += geometry->weight[g] * a[g] * b[g];
  return sum;
}

/* Orthonormalises 1, X - X_c, Y - Y_c over the element (modified Gram-Schmidt, twice for thin elements). */
static void PressureBasis(const PetscReal point[LAM_GAUSS][2], LamElementGeometry *geometry)
{
  PetscReal area = 0.0, centre[2] = {0.0, 0.0};

  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    area += geometry->weight[g];
    for (PetscInt d = 0; d < 2; ++d) centre[d] += geometry->weight[g] * point[g][d];
  }
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal dX = point[g][0] - centre[0] / area, dY = point[g][1] - centre[1] / area;

    /* axes along and across the wall: in thin elements X and Y could be nearly parallel functions */
    geometry->psi[0][g] = 1.0;
    geometry->psi[1][g] = dX * geometry->fibre[0] + dY * geometry->fibre[1];
    geometry->psi[2][g] = -dX * geometry->fibre[1] + dY * geometry->fibre[0];
  }
  for (PetscInt pass = 0; pass < 2; ++pass)
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
      PetscReal norm;

      for (PetscInt l = 0; l < k; ++l) {
        const PetscReal dot = Overlap(geometry, geometry->psi[k], geometry->psi[l]);

        LAM_EACH_POINT(g) geometry->psi[k][g] -= dot * geometry->psi[l][g];
      }
      norm = PetscSqrtReal(Overlap(geometry, geometry->psi[k], geometry->psi[k]));
      LAM_EACH_POINT(g) geometry->psi[k][g] /= norm;
    }
}

PetscErrorCode LamElementSetGeometry(const PetscReal X[][2], const PetscReal fibre[2], LamElementGeometry *geometry)
{
  PetscReal point[LAM_GAUSS][2];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(geometry, sizeof(*geometry)));
  geometry->fibre[0] = fibre[0];
  geometry->fibre[1] = fibre[1];
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    PetscReal xi, eta, w, N[9], d[9][2], G[2][2] = {{0, 0}, {0, 0}}, det;

    LamGaussPoint(g, &xi, &eta, &w);
    LamShape(xi, eta, N, d);
    point[g][0] = point[g][1] = 0.0;
    for (PetscInt a = 0; a < 9; ++a)
      for (PetscInt i = 0; i < 2; ++i) {
        point[g][i] += N[a] * X[a][i];
        for (PetscInt J = 0; J < 2; ++J) G[i][J] += X[a][i] * d[a][J];
      }
    det = G[0][0] * G[1][1] - G[0][1] * G[1][0];
    PetscCheck(det > 0.0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "element is inside out: Jacobian %g", (double)det);
    geometry->weight[g] = w * det;
    for (PetscInt a = 0; a < 9; ++a) {
      geometry->dN[2 * g][a] = (d[a][0] * G[1][1] - d[a][1] * G[1][0]) / det;
      geometry->dN[2 * g + 1][a] = (d[a][1] * G[0][0] - d[a][0] * G[0][1]) / det;
    }
  }
  for (PetscInt J = 0; J < 2; ++J)
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      LAM_EACH_POINT(g) geometry->shape[J][a][g] = geometry->dN[2 * PetscMin(g, LAM_GAUSS - 1) + J][a];
  PressureBasis(point, geometry);
  PetscFunctionReturn(0);
}

LAM_CLONES static PetscBool ElementIsValid(const LamElementGeometry *geometry, const PetscReal u[][2], PetscReal F33)
{
  LamPoints H[4], dilation;

  return Kinematics(geometry, u, F33, H, dilation);
}

PetscBool LamElementIsValid(const LamElementGeometry *geometry, const PetscReal u[][2], PetscReal F33)
{
  return ElementIsValid(geometry, u, F33);
}

LAM_CLONES static void ElementEnergy(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                     const PetscReal u[][2], PetscReal F33, PetscReal *energy, PetscBool *valid)
{
  LamPoints H[4], dilation, sum;
  LamKernel1 volume, fibre;
  LamKernel matrix;

  *valid = Kinematics(geometry, u, F33, H, dilation);
  if (!*valid) return;
  MatrixKernel(geometry, law, wall, H, F33, PETSC_FALSE, &matrix);
  LamVolumetric(wall, dilation, PETSC_TRUE, &volume);
  Fibres(geometry, law, wall, H, F33, &fibre);
  LAM_EACH_POINT(g) sum[g] = geometry->weight[g] * (matrix.W[g] + volume.W[g] + fibre.W[g]);
  *energy = Total(sum);
  *valid = (PetscBool)isfinite(*energy);
}

void LamElementEnergy(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const LamPoints *history, const PetscReal u[][2], PetscReal F33, PetscReal *energy,
                      PetscBool *valid)
{
  ElementEnergy(geometry, law, wall, u, F33, energy, valid);
  if (history && *valid) *energy += LamHistoryEnergy(geometry, history, u, F33);
}

/* K[a][b] += sum_r left[r][a] right[r][b], over padded rows; three rows of K at a time stay in registers. */
LAM_INLINE void AddProduct(PetscInt rows, const PetscReal left[][LAM_PADDED_NODES],
                           const PetscReal right[][LAM_PADDED_NODES], PetscReal K[LAM_ELEMENT_NODES][LAM_PADDED_NODES])
{
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; a += 3) {
    PetscReal sum[3][LAM_PADDED_NODES];

    for (PetscInt t = 0; t < 3; ++t)
      for (PetscInt b = 0; b < LAM_PADDED_NODES; ++b) sum[t][b] = K[a + t][b];
    for (PetscInt r = 0; r < rows; ++r)
      for (PetscInt t = 0; t < 3; ++t)
        for (PetscInt b = 0; b < LAM_PADDED_NODES; ++b) sum[t][b] += left[r][a + t] * right[r][b];
    for (PetscInt t = 0; t < 3; ++t)
      for (PetscInt b = 0; b < LAM_PADDED_NODES; ++b) K[a + t][b] = sum[t][b];
  }
}

/* Lower Cholesky factor of the symmetric positive definite 3 x 3 matrix H. */
LAM_INLINE void Cholesky3(const PetscReal H[3][3], PetscReal L[3][3])
{
  for (PetscInt i = 0; i < 3; ++i)
    for (PetscInt j = 0; j <= i; ++j) {
      PetscReal v = H[i][j];

      for (PetscInt k = 0; k < j; ++k) v -= L[i][k] * L[j][k];
      L[i][j] = i == j ? PetscSqrtReal(v) : v / L[j][j];
    }
}

/* Adds D^T H D, D = dc/dx: the stiffness of the projected pressure. With H = L L^T it is E^T E, E = L^T D. */
LAM_INLINE void AddProjection(const PetscReal H[3][3], const PetscReal D[2][LAM_PRESSURES][LAM_PADDED_NODES],
                              PetscReal K[3][LAM_ELEMENT_NODES][LAM_PADDED_NODES])
{
  PetscReal L[3][3] = {{0}}, E[2][LAM_PRESSURES][LAM_PADDED_NODES] = {{{0}}};

  Cholesky3(H, L);
  for (PetscInt i = 0; i < 2; ++i)
    for (PetscInt r = 0; r < 3; ++r)
      for (PetscInt k = r; k < 3; ++k)
        for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) E[i][r][a] += L[k][r] * D[i][k][a];
  AddProduct(LAM_PRESSURES, E[0], E[0], K[0]);
  AddProduct(LAM_PRESSURES, E[0], E[1], K[1]);
  AddProduct(LAM_PRESSURES, E[1], E[1], K[2]);
}

LAM_CLONES static void ElementEvaluate(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                       const PetscReal u[][2], PetscReal F33, LamElementStress *stress,
                                       LamElementResult *out, PetscBool *valid)
{
  LamPoints H[4], dilation, energy;
  PetscReal T[3][2 * LAM_GAUSS][LAM_PADDED_NODES];           /* A dN for the component pairs 11, 12, 22 */
  PetscReal K[3][LAM_ELEMENT_NODES][LAM_PADDED_NODES];       /* blocks 11, 12, 22 */
  PetscReal D[2][LAM_PRESSURES][LAM_PADDED_NODES] = {{{0}}}; /* dc/dx */
  PetscReal f[2][LAM_PADDED_NODES] = {{0}};
  LamKernel1 volume;
  PointStress at;

  *valid = Kinematics(geometry, u, F33, H, dilation);
  if (!*valid) return;
  LamVolumetric(wall, dilation, PETSC_TRUE, &volume);
  Pressures(geometry, &volume, stress);
  FindStress(geometry, law, wall, H, F33, stress, &at);
  LAM_EACH_POINT(g) energy[g] = at.energy[g] + geometry->weight[g] * volume.W[g];
  out->energy = Total(energy);
  *valid = (PetscBool)isfinite(out->energy);
  if (!*valid) return;
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal *dX = geometry->dN[2 * g], *dY = geometry->dN[2 * g + 1];
    PetscReal cof[2][LAM_PADDED_NODES]; /* dJ/dx */

    for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) {
      f[0][a] += at.P[0][g] * dX[a] + at.P[1][g] * dY[a];
      f[1][a] += at.P[2][g] * dX[a] + at.P[3][g] * dY[a];
      T[0][2 * g][a] = at.A[0][0][g] * dX[a] + at.A[0][1][g] * dY[a];
      T[0][2 * g + 1][a] = at.A[0][1][g] * dX[a] + at.A[1][1][g] * dY[a];
      T[1][2 * g][a] = at.A[0][2][g] * dX[a] + at.A[0][3][g] * dY[a];
      T[1][2 * g + 1][a] = at.A[1][2][g] * dX[a] + at.A[1][3][g] * dY[a];
      T[2][2 * g][a] = at.A[2][2][g] * dX[a] + at.A[2][3][g] * dY[a];
      T[2][2 * g + 1][a] = at.A[2][3][g] * dX[a] + at.A[3][3][g] * dY[a];
      cof[0][a] = (1.0 + H[3][g]) * dX[a] - H[2][g] * dY[a];
      cof[1][a] = (1.0 + H[0][g]) * dY[a] - H[1][g] * dX[a];
    }
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
      const PetscReal c = geometry->weight[g] * geometry->psi[k][g] * F33;

      for (PetscInt i = 0; i < 2; ++i)
        for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) D[i][k][a] += c * cof[i][a];
    }
  }
  for (PetscInt block = 0; block < 3; ++block) {
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      for (PetscInt b = 0; b < LAM_PADDED_NODES; ++b) K[block][a][b] = 0.0;
    AddProduct(2 * LAM_GAUSS, geometry->dN, T[block], K[block]);
  }
  AddProjection(stress->H, D, K);
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
    out->f[2 * a] = f[0][a];
    out->f[2 * a + 1] = f[1][a];
    for (PetscInt b = 0; b < LAM_ELEMENT_NODES; ++b) {
      out->K[2 * a][2 * b] = K[0][a][b];
      out->K[2 * a][2 * b + 1] = K[1][a][b];
      out->K[2 * b + 1][2 * a] = K[1][a][b];
      out->K[2 * a + 1][2 * b + 1] = K[2][a][b];
    }
  }
}

void LamElementEvaluate(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                        const LamPoints *history, const PetscReal u[][2], PetscReal F33, LamElementStress *stress,
                        LamElementResult *out, PetscBool *valid)
{
  ElementEvaluate(geometry, law, wall, u, F33, stress, out, valid);
  if (history && *valid) LamHistoryEvaluate(geometry, history, u, F33, out);
}

LAM_CLONES static void ElementUpdateStress(const LamElementGeometry *geometry, const LamWall *wall,
                                           const PetscReal u[][2], const PetscReal du[][2], PetscReal F33,
                                           PetscReal dF33, PetscReal alpha, LamElementStress *stress)
{
  LamPoints H[4], F[4], dF[4], dE[4], dE33, dJ;
  PetscReal dc[LAM_PRESSURES], h[2][2];

  Gradient(geometry, u, H);
  Gradient(geometry, du, dF);
  Deformation(H, F);
  StructureTensor(geometry, wall, h);
  FibreStrainGradient((const PetscReal(*)[2])h, F, dE);
  FibreStrain33(geometry, wall, F33, dE33);
  LAM_EACH_POINT(g)
  {
    const PetscReal strain =
        dE[0][g] * dF[0][g] + dE[1][g] * dF[1][g] + dE[2][g] * dF[2][g] + dE[3][g] * dF[3][g] + dE33[g] * dF33;

    dJ[g] = F33 * (F[3][g] * dF[0][g] - F[2][g] * dF[1][g] - F[1][g] * dF[2][g] + F[0][g] * dF[3][g]) +
            dF33 * (F[0][g] * F[3][g] - F[1][g] * F[2][g]);
    stress->s[g] += alpha * (stress->sx[g] + stress->dds[g] * strain - stress->s[g]);
  }
  Moments(geometry, dJ, dc);
  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
    PetscReal q = stress->px[k];

    for (PetscInt l = 0; l < LAM_PRESSURES; ++l) q += stress->H[k][l] * dc[l];
    stress->p[k] += alpha * (q - stress->p[k]);
  }
}

void LamElementUpdateStress(const LamElementGeometry *geometry, const LamWall *wall, const PetscReal u[][2],
                            const PetscReal du[][2], PetscReal F33, PetscReal dF33, PetscReal alpha,
                            LamElementStress *stress)
{
  ElementUpdateStress(geometry, wall, u, du, F33, dF33, alpha, stress);
}

LAM_CLONES static PetscBool ElementSetConsistentStress(const LamElementGeometry *geometry, const LamWallLaw *law,
                                                       const LamWall *wall, const PetscReal u[][2], PetscReal F33,
                                                       LamElementStress *stress)
{
  LamPoints H[4], dilation;
  LamKernel1 volume, fibre;

  if (!Kinematics(geometry, u, F33, H, dilation)) return PETSC_FALSE;
  LamVolumetric(wall, dilation, PETSC_FALSE, &volume);
  Pressures(geometry, &volume, stress);
  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) stress->p[k] = stress->px[k];
  Fibres(geometry, law, wall, H, F33, &fibre);
  if (!isfinite(Total(fibre.W))) return PETSC_FALSE;
  LAM_EACH_POINT(g)
  {
    stress->s[g] = stress->sx[g] = fibre.d[g];
    stress->dds[g] = fibre.dd[g];
  }
  return PETSC_TRUE;
}

PetscBool LamElementSetConsistentStress(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                        const PetscReal u[][2], PetscReal F33, LamElementStress *stress)
{
  return ElementSetConsistentStress(geometry, law, wall, u, F33, stress);
}

LAM_CLONES static void ElementStretch33(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                        const PetscReal u[][2], PetscReal F33, const LamElementStress *stress,
                                        PetscReal *force, PetscReal fx[LAM_ELEMENT_DOFS], PetscReal *ff)
{
  const PetscReal d = wall->dispersion, s = FibreTilt(wall).s;
  const PetscReal bend = 2.0 * (d + (1.0 - 3.0 * d) * s * s); /* d2E/dF33^2 */
  PetscReal Df[LAM_PRESSURES], HDf[LAM_PRESSURES], h[2][2], nodes[2][LAM_PADDED_NODES] = {{0.0}};
  LamPoints H[4], F[4], dE[4], dE33, det, p, p_star, dp, first, second, mixed[4];
  LamKernel k;

  Gradient(geometry, u, H);
  Deformation(H, F);
  LAM_EACH_POINT(g) det[g] = F[0][g] * F[3][g] - F[1][g] * F[2][g];
  Moments(geometry, det, Df);
  for (PetscInt i = 0; i < LAM_PRESSURES; ++i)
    HDf[i] = stress->H[i][0] * Df[0] + stress->H[i][1] * Df[1] + stress->H[i][2] * Df[2];
  /* the pressure field changes by dp with F33; p* dcof is the geometric part */
  AtPoints(geometry, stress->px, p);
  AtPoints(geometry, stress->p, p_star);
  AtPoints(geometry, HDf, dp);
  MatrixKernel(geometry, law, wall, H, F33, PETSC_TRUE, &k);
  StructureTensor(geometry, wall, h);
  FibreStrainGradient((const PetscReal(*)[2])h, F, dE);
  FibreStrain33(geometry, wall, F33, dE33);
  LAM_EACH_POINT(g)
  {
    const PetscReal w = geometry->weight[g];

    first[g] = w * (k.P[4][g] + stress->sx[g] * dE33[g] + p[g] * det[g]);
    second[g] = w * (k.A[4][4][g] + stress->dds[g] * dE33[g] * dE33[g] + bend * stress->s[g]);
  }
  *force = Total(first);
  *ff = Total(second) + Df[0] * HDf[0] + Df[1] * HDf[1] + Df[2] * HDf[2];
  for (PetscInt r = 0; r < 4; ++r) LAM_EACH_POINT(g)
    {
      mixed[r][g] = geometry->weight[g] * (k.A[r][4][g] + stress->dds[g] * dE33[g] * dE[r][g] +
                                           (p_star[g] + F33 * dp[g]) * CofactorSign(r) * F[3 - r][g]);
    }
  for (PetscInt g = 0; g < LAM_GAUSS; ++g)
    for (PetscInt r = 0; r < 4; ++r)
      for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) nodes[r / 2][a] += mixed[r][g] * geometry->dN[2 * g + r % 2][a];
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt i = 0; i < 2; ++i) fx[2 * a + i] = nodes[i][a];
}

void LamElementStretch33(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                         const LamPoints *history, const PetscReal u[][2], PetscReal F33,
                         const LamElementStress *stress, PetscReal *force, PetscReal fx[LAM_ELEMENT_DOFS],
                         PetscReal *ff)
{
  ElementStretch33(geometry, law, wall, u, F33, stress, force, fx, ff);
  if (history) LamHistoryStretch33(geometry, history, F33, force, ff);
}
