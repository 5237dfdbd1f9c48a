#include "element.h"
#include "wall_ellipticity.h"

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
    geometry->psi[g][0] = 1.0;
    geometry->psi[g][1] = dX * geometry->fibre[0] + dY * geometry->fibre[1];
    geometry->psi[g][2] = -dX * geometry->fibre[1] + dY * geometry->fibre[0];
  }
  for (PetscInt pass = 0; pass < 2; ++pass)
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
      PetscReal norm = 0.0;

      for (PetscInt l = 0; l < k; ++l) {
        PetscReal dot = 0.0;

        for (PetscInt g = 0; g < LAM_GAUSS; ++g) dot += geometry->weight[g] * geometry->psi[g][k] * geometry->psi[g][l];
        for (PetscInt g = 0; g < LAM_GAUSS; ++g) geometry->psi[g][k] -= dot * geometry->psi[g][l];
      }
      for (PetscInt g = 0; g < LAM_GAUSS; ++g) norm += geometry->weight[g] * PetscSqr(geometry->psi[g][k]);
      for (PetscInt g = 0; g < LAM_GAUSS; ++g) geometry->psi[g][k] /= PetscSqrtReal(norm);
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
  PressureBasis(point, geometry);
  PetscFunctionReturn(0);
}

/* In-plane displacement gradient H at point g: H11 H12 H21 H22. */
static inline void Gradient(const LamElementGeometry *geometry, PetscInt g, const PetscReal u[][2], PetscReal H[4])
{
  H[0] = H[1] = H[2] = H[3] = 0.0;
  for (PetscInt a = 0; a < 9; ++a) {
    const PetscReal dX = geometry->dN[2 * g][a], dY = geometry->dN[2 * g + 1][a];

    H[0] += u[a][0] * dX;
    H[1] += u[a][0] * dY;
    H[2] += u[a][1] * dX;
    H[3] += u[a][1] * dY;
  }
}

/* F = 1 + H. */
static inline void Deformation(const PetscReal H[4], PetscReal F[4])
{
  F[0] = 1.0 + H[0];
  F[1] = H[1];
  F[2] = H[2];
  F[3] = 1.0 + H[3];
}

static inline PetscReal Det(const PetscReal F[4])
{
  return F[0] * F[3] - F[1] * F[2];
}

/* F33 det F - 1. */
static inline PetscReal Dilation(const PetscReal H[4], PetscReal F33)
{
  return F33 * (H[0] + H[3] + (H[0] * H[3] - H[1] * H[2])) + (F33 - 1.0);
}

/* H and the projected dilatation theta - 1 at all Gauss points. Returns PETSC_FALSE if a volume is not positive. */
static inline PetscBool Kinematics(const LamElementGeometry *geometry, const PetscReal u[][2], PetscReal F33,
                                   PetscReal H[LAM_GAUSS][4], PetscReal dilation[LAM_GAUSS])
{
  PetscReal c[LAM_PRESSURES] = {0.0, 0.0, 0.0};
  PetscBool valid = PETSC_TRUE;

  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    PetscReal local;

    Gradient(geometry, g, u, H[g]);
    local = Dilation(H[g], F33);
    if (!(1.0 + local > 0.0)) valid = PETSC_FALSE;
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) c[k] += geometry->weight[g] * geometry->psi[g][k] * local;
  }
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    dilation[g] = 0.0;
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) dilation[g] += geometry->psi[g][k] * c[k];
    if (!(1.0 + dilation[g] > 0.0)) valid = PETSC_FALSE;
  }
  return valid;
}

/* I4 - 1, I4 = |Fm|^2; m is a unit vector. */
static inline PetscReal Extension(const LamElementGeometry *geometry, const PetscReal H[4])
{
  const PetscReal *m = geometry->fibre, Hm[2] = {H[0] * m[0] + H[1] * m[1], H[2] * m[0] + H[3] * m[1]};

  return 2.0 * (m[0] * Hm[0] + m[1] * Hm[1]) + (Hm[0] * Hm[0] + Hm[1] * Hm[1]);
}

/*
  Fibre strain E = h:C - 1 with h = d 1 + (1 - 3 d) M (x) M, d the dispersion, C with F33; E = I4 - 1 for d = 0.
  Its derivatives are dE/dF = 2 F h, d2E/dFdF = 2 (1 (x) h), dE/dF33 = 2 d F33.
*/
static inline PetscReal FibreStrain(const LamElementGeometry *geometry, const LamWall *wall, const PetscReal H[4],
                                    PetscReal F33)
{
  const PetscReal extension = Extension(geometry, H), H2 = H[0] * H[0] + H[1] * H[1] + H[2] * H[2] + H[3] * H[3];

  if (wall->dispersion == 0.0) return extension;
  return extension +
         wall->dispersion * (2.0 * (H[0] + H[3]) + H2 + (F33 - 1.0) * (F33 + 1.0) /* I1 - 3 */ - 3.0 * extension);
}

/* A m. */
static inline void AlongFibre(const LamElementGeometry *geometry, const PetscReal A[4], PetscReal Am[2])
{
  Am[0] = A[0] * geometry->fibre[0] + A[1] * geometry->fibre[1];
  Am[1] = A[2] * geometry->fibre[0] + A[3] * geometry->fibre[1];
}

/* dE/dF. */
static inline void FibreStrainGradient(const LamElementGeometry *geometry, const LamWall *wall, const PetscReal F[4],
                                       PetscReal dE[4])
{
  PetscReal Fm[2];

  AlongFibre(geometry, F, Fm);
  for (PetscInt r = 0; r < 4; ++r) dE[r] = 2.0 * Fm[r / 2] * geometry->fibre[r % 2];
  if (wall->dispersion == 0.0) return;
  for (PetscInt r = 0; r < 4; ++r) dE[r] += wall->dispersion * (2.0 * F[r] - 3.0 * dE[r]);
}

/* Adds factor/2 times the part of d2E/dFdF that the dispersion multiplies, 2 (1 (x) (1 - 3 M (x) M)). */
static inline void AddDispersedCurvature(const LamElementGeometry *geometry, PetscReal factor, PetscReal A[4][4])
{
  const PetscReal *m = geometry->fibre;

  if (factor == 0.0) return;
  for (PetscInt i = 0; i < 4; i += 2)
    for (PetscInt j = 0; j < 2; ++j)
      for (PetscInt l = 0; l < 2; ++l) A[i + j][i + l] += factor * ((PetscReal)(j == l) - 3.0 * m[j] * m[l]);
}

PetscBool LamElementIsValid(const LamElementGeometry *geometry, const PetscReal u[][2], PetscReal F33)
{
  PetscReal H[LAM_GAUSS][4], dilation[LAM_GAUSS];

  return Kinematics(geometry, u, F33, H, dilation);
}

void LamElementEnergy(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const PetscReal u[][2], PetscReal F33, PetscReal *energy, PetscBool *valid)
{
  PetscReal H[LAM_GAUSS][4], dilation[LAM_GAUSS];

  *valid = Kinematics(geometry, u, F33, H, dilation);
  if (!*valid) return;
  *energy = 0.0;
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    LamKernel matrix;
    LamKernel1 volume, fibre = {0};

    law->matrix(wall, H[g], F33 - 1.0, &matrix);
    LamVolumetric(wall, dilation[g], &volume);
    if (law->fibre) law->fibre(wall, FibreStrain(geometry, wall, H[g], F33), &fibre);
    *energy += geometry->weight[g] * (matrix.W + volume.W + fibre.W);
  }
  *valid = (PetscBool)isfinite(*energy);
}

/* px = q = sum w psi U'(theta), stress->H = sum w psi psi U''(theta). Returns the volumetric energy. */
static inline PetscReal Pressures(const LamElementGeometry *geometry, const LamWall *wall,
                                  const PetscReal dilation[LAM_GAUSS], LamElementStress *stress)
{
  PetscReal energy = 0.0;

  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
    stress->px[k] = 0.0;
    for (PetscInt l = 0; l < LAM_PRESSURES; ++l) stress->H[k][l] = 0.0;
  }
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal *psi = geometry->psi[g];
    LamKernel1 volume;

    LamVolumetric(wall, dilation[g], &volume);
    energy += geometry->weight[g] * volume.W;
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
      stress->px[k] += geometry->weight[g] * psi[k] * volume.d;
      for (PetscInt l = 0; l < LAM_PRESSURES; ++l) stress->H[k][l] += geometry->weight[g] * psi[k] * psi[l] * volume.dd;
    }
  }
  return energy;
}

static inline PetscReal AtPoint(const LamElementGeometry *geometry, PetscInt g, const PetscReal p[LAM_PRESSURES])
{
  return geometry->psi[g][0] * p[0] + geometry->psi[g][1] * p[1] + geometry->psi[g][2] * p[2];
}

/*
  Stress w P and tangent w A at point g. The stress uses px and sx (of u), the tangent uses the independent p* and s*.
  LamElementEvaluate adds the projection term of the pressure. Returns the energy without U.
*/
static inline PetscReal PointStress(const LamElementGeometry *geometry, PetscInt g, const LamWallLaw *law,
                                    const LamWall *wall, const PetscReal H[4], PetscReal F33, LamElementStress *stress,
                                    PetscReal P[4], PetscReal A[4][4])
{
  const PetscReal w = geometry->weight[g], cof[4] = {1.0 + H[3], -H[2], -H[1], 1.0 + H[0]}, *m = geometry->fibre;
  const PetscReal p = F33 * AtPoint(geometry, g, stress->px), p_star = F33 * AtPoint(geometry, g, stress->p);
  PetscReal energy;
  LamKernel k;

  law->matrix(wall, H, F33 - 1.0, &k);
  energy = k.W;
  for (PetscInt r = 0; r < 4; ++r) {
    P[r] = w * (k.P[r] + p * cof[r]);
    for (PetscInt c = 0; c < 4; ++c) A[r][c] = w * k.A[r][c];
  }
  A[0][3] += w * p_star;
  A[3][0] += w * p_star;
  A[1][2] -= w * p_star;
  A[2][1] -= w * p_star;
  if (law->fibre) {
    PetscReal F[4], dE[4];
    LamKernel1 fibre;

    Deformation(H, F);
    FibreStrainGradient(geometry, wall, F, dE);
    law->fibre(wall, FibreStrain(geometry, wall, H, F33), &fibre);
    energy += fibre.W;
    stress->sx[g] = fibre.d;
    stress->dds[g] = fibre.dd;
    for (PetscInt r = 0; r < 4; ++r) {
      P[r] += w * fibre.d * dE[r];
      for (PetscInt c = 0; c < 4; ++c) {
        A[r][c] += w * fibre.dd * dE[r] * dE[c];
        if (r / 2 == c / 2) A[r][c] += w * 2.0 * stress->s[g] * m[r % 2] * m[c % 2];
      }
    }
    AddDispersedCurvature(geometry, w * 2.0 * stress->s[g] * wall->dispersion, A);
  }
  return w * energy;
}

/* Adds rows^T block: K_ik[a][b] += sum_r left[r][a] right[r][b], over padded rows. */
static inline void AddProduct(PetscInt rows, const PetscReal left[][LAM_PADDED_NODES],
                              const PetscReal right[][LAM_PADDED_NODES], PetscReal K[9][LAM_PADDED_NODES])
{
  for (PetscInt a = 0; a < 9; ++a)
    for (PetscInt r = 0; r < rows; ++r)
      for (PetscInt b = 0; b < LAM_PADDED_NODES; ++b) K[a][b] += left[r][a] * right[r][b];
}

/* Lower Cholesky factor of the symmetric positive definite 3 x 3 matrix H. */
static inline void Cholesky3(const PetscReal H[3][3], PetscReal L[3][3])
{
  for (PetscInt i = 0; i < 3; ++i)
    for (PetscInt j = 0; j <= i; ++j) {
      PetscReal v = H[i][j];

      for (PetscInt k = 0; k < j; ++k) v -= L[i][k] * L[j][k];
      L[i][j] = i == j ? PetscSqrtReal(v) : v / L[j][j];
    }
}

/* Adds D^T H D, D = dc/dx: the stiffness of the projected pressure. With H = L L^T it is E^T E, E = L^T D. */
static inline void AddProjection(const PetscReal H[3][3], const PetscReal D[2][LAM_PRESSURES][LAM_PADDED_NODES],
                                 PetscReal K[3][9][LAM_PADDED_NODES])
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

void LamElementEvaluate(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                        const PetscReal u[][2], PetscReal F33, LamElementStress *stress, LamElementResult *out,
                        PetscBool *valid)
{
  PetscReal H[LAM_GAUSS][4], dilation[LAM_GAUSS];
  PetscReal T[3][2 * LAM_GAUSS][LAM_PADDED_NODES];           /* A dN for the component pairs 11, 12, 22 */
  PetscReal K[3][9][LAM_PADDED_NODES] = {{{0}}};             /* blocks 11, 12, 22 */
  PetscReal D[2][LAM_PRESSURES][LAM_PADDED_NODES] = {{{0}}}; /* dc/dx */
  PetscReal f[2][LAM_PADDED_NODES] = {{0}};

  *valid = Kinematics(geometry, u, F33, H, dilation);
  if (!*valid) return;
  out->energy = Pressures(geometry, wall, dilation, stress);
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal *dX = geometry->dN[2 * g], *dY = geometry->dN[2 * g + 1];
    const PetscReal cof[4] = {1.0 + H[g][3], -H[g][2], -H[g][1], 1.0 + H[g][0]};
    PetscReal P[4], A[4][4];

    out->energy += PointStress(geometry, g, law, wall, H[g], F33, stress, P, A);
    for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) {
      f[0][a] += P[0] * dX[a] + P[1] * dY[a];
      f[1][a] += P[2] * dX[a] + P[3] * dY[a];
    }
    for (PetscInt J = 0; J < 2; ++J)
      for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) {
        T[0][2 * g + J][a] = A[J][0] * dX[a] + A[J][1] * dY[a];
        T[1][2 * g + J][a] = A[J][2] * dX[a] + A[J][3] * dY[a];
        T[2][2 * g + J][a] = A[2 + J][2] * dX[a] + A[2 + J][3] * dY[a];
      }
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
      const PetscReal c = geometry->weight[g] * geometry->psi[g][k] * F33;

      for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) {
        D[0][k][a] += c * (cof[0] * dX[a] + cof[1] * dY[a]);
        D[1][k][a] += c * (cof[2] * dX[a] + cof[3] * dY[a]);
      }
    }
  }
  *valid = (PetscBool)isfinite(out->energy);
  if (!*valid) return;
  for (PetscInt block = 0; block < 3; ++block) AddProduct(2 * LAM_GAUSS, geometry->dN, T[block], K[block]);
  AddProjection(stress->H, D, K);
  for (PetscInt a = 0; a < 9; ++a) {
    out->f[2 * a] = f[0][a];
    out->f[2 * a + 1] = f[1][a];
    for (PetscInt b = 0; b < 9; ++b) {
      out->K[2 * a][2 * b] = K[0][a][b];
      out->K[2 * a][2 * b + 1] = K[1][a][b];
      out->K[2 * b + 1][2 * a] = K[1][a][b];
      out->K[2 * a + 1][2 * b + 1] = K[2][a][b];
    }
  }
}

void LamElementUpdateStress(const LamElementGeometry *geometry, const LamWall *wall, const PetscReal u[][2],
                            const PetscReal du[][2], PetscReal F33, PetscReal dF33, PetscReal alpha,
                            LamElementStress *stress)
{
  PetscReal dc[LAM_PRESSURES] = {0.0, 0.0, 0.0};

  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    PetscReal H[4], F[4], dF[4], Fm[2], dFm[2], dJ, half; /* dE/2 */

    Gradient(geometry, g, u, H);
    Deformation(H, F);
    Gradient(geometry, g, du, dF);
    dJ = F33 * (F[3] * dF[0] - F[2] * dF[1] - F[1] * dF[2] + F[0] * dF[3]) + dF33 * Det(F);
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) dc[k] += geometry->weight[g] * geometry->psi[g][k] * dJ;
    AlongFibre(geometry, F, Fm);
    AlongFibre(geometry, dF, dFm);
    half = Fm[0] * dFm[0] + Fm[1] * dFm[1];
    if (wall->dispersion != 0.0)
      half += wall->dispersion * (F[0] * dF[0] + F[1] * dF[1] + F[2] * dF[2] + F[3] * dF[3] + F33 * dF33 - 3.0 * half);
    stress->s[g] += alpha * (stress->sx[g] + stress->dds[g] * 2.0 * half - stress->s[g]);
  }
  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
    PetscReal q = stress->px[k];

    for (PetscInt l = 0; l < LAM_PRESSURES; ++l) q += stress->H[k][l] * dc[l];
    stress->p[k] += alpha * (q - stress->p[k]);
  }
}

PetscBool LamElementSetConsistentStress(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                                        const PetscReal u[][2], PetscReal F33, LamElementStress *stress)
{
  PetscReal H[LAM_GAUSS][4], dilation[LAM_GAUSS];

  if (!Kinematics(geometry, u, F33, H, dilation)) return PETSC_FALSE;
  (void)Pressures(geometry, wall, dilation, stress);
  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) stress->p[k] = stress->px[k];
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    LamKernel1 fibre = {0};

    if (law->fibre) law->fibre(wall, FibreStrain(geometry, wall, H[g], F33), &fibre);
    if (!isfinite(fibre.W)) return PETSC_FALSE;
    stress->s[g] = stress->sx[g] = fibre.d;
    stress->dds[g] = fibre.dd;
  }
  return PETSC_TRUE;
}

void LamElementStretch33(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                         const PetscReal u[][2], PetscReal F33, const LamElementStress *stress, PetscReal *force,
                         PetscReal fx[LAM_ELEMENT_DOFS], PetscReal *ff)
{
  PetscReal Df[LAM_PRESSURES] = {0.0, 0.0, 0.0}, HDf[LAM_PRESSURES], H[LAM_GAUSS][4], F[LAM_GAUSS][4];

  *force = *ff = 0.0;
  for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; ++i) fx[i] = 0.0;
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    Gradient(geometry, g, u, H[g]);
    Deformation(H[g], F[g]);
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) Df[k] += geometry->weight[g] * geometry->psi[g][k] * Det(F[g]);
  }
  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) {
    HDf[k] = 0.0;
    for (PetscInt l = 0; l < LAM_PRESSURES; ++l) HDf[k] += stress->H[k][l] * Df[l];
    *ff += Df[k] * HDf[k];
  }
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal w = geometry->weight[g], cof[4] = {F[g][3], -F[g][2], -F[g][1], F[g][0]};
    /* the pressure field changes by dp with F33; p* dcof is the geometric part */
    const PetscReal p = AtPoint(geometry, g, stress->px), p_star = AtPoint(geometry, g, stress->p);
    const PetscReal dp = AtPoint(geometry, g, HDf), dE33 = 2.0 * wall->dispersion * F33;
    PetscReal dE[4];
    LamKernel k;

    law->matrix(wall, H[g], F33 - 1.0, &k);
    if (law->fibre) {
      FibreStrainGradient(geometry, wall, F[g], dE);
      k.P[4] += stress->sx[g] * dE33;
      k.A[4][4] += stress->dds[g] * dE33 * dE33 + 2.0 * wall->dispersion * stress->s[g];
      for (PetscInt r = 0; r < 4; ++r) k.A[r][4] += stress->dds[g] * dE33 * dE[r];
    }
    *force += w * (k.P[4] + p * Det(F[g]));
    *ff += w * k.A[4][4];
    for (PetscInt a = 0; a < 9; ++a)
      for (PetscInt i = 0; i < 2; ++i)
        for (PetscInt J = 0; J < 2; ++J)
          fx[2 * a + i] += w * (k.A[2 * i + J][4] + (p_star + F33 * dp) * cof[2 * i + J]) * geometry->dN[2 * g + J][a];
  }
}

void LamElementFields(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                      const PetscReal u[][2], PetscReal F33, PetscReal fibre[LAM_GAUSS], PetscReal stress[LAM_GAUSS])
{
  PetscReal H[LAM_GAUSS][4], dilation[LAM_GAUSS];
  LamElementStress local = {0};

  (void)Kinematics(geometry, u, F33, H, dilation);
  (void)Pressures(geometry, wall, dilation, &local);
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    PetscReal P[4], A[4][4], F[4], scale, s11, s22, s12;

    Deformation(H[g], F);
    scale = 1.0 / (geometry->weight[g] * Det(F) * F33);
    fibre[g] = PetscSqrtReal(1.0 + Extension(geometry, H[g]));
    (void)PointStress(geometry, g, law, wall, H[g], F33, &local, P, A);
    s11 = scale * (P[0] * F[0] + P[1] * F[1]); /* sigma = P F^T / J */
    s12 = scale * (P[0] * F[2] + P[1] * F[3]);
    s22 = scale * (P[2] * F[2] + P[3] * F[3]);
    stress[g] = 0.5 * (s11 + s22) + PetscSqrtReal(0.25 * PetscSqr(s11 - s22) + s12 * s12);
  }
}

/* Adds factor/2 times d2E/dFdF. PointStress multiplies this term by the independent fibre stress. */
static inline void AddFibreCurvature(const LamElementGeometry *geometry, const LamWall *wall, PetscReal factor,
                                     PetscReal A[4][4])
{
  for (PetscInt i = 0; i < 2; ++i)
    for (PetscInt j = 0; j < 2; ++j)
      for (PetscInt l = 0; l < 2; ++l) A[2 * i + j][2 * i + l] += factor * geometry->fibre[j] * geometry->fibre[l];
  AddDispersedCurvature(geometry, factor * wall->dispersion, A);
}

void LamElementWallPoints(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                          const PetscReal u[][2], PetscReal F33, LamWallPoint points[LAM_GAUSS])
{
  PetscReal H[LAM_GAUSS][4], dilation[LAM_GAUSS];
  LamElementStress local = {0};

  (void)Kinematics(geometry, u, F33, H, dilation);
  (void)Pressures(geometry, wall, dilation, &local);
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal w = geometry->weight[g];
    const PetscReal I4 = 1.0 + Extension(geometry, H[g]);
    PetscReal P[4], A[4][4], F[4], Fm[2], tm[2];

    Deformation(H[g], F);
    AlongFibre(geometry, F, Fm);
    points[g].energy = PointStress(geometry, g, law, wall, H[g], F33, &local, P, A);
    points[g].reference = w;
    points[g].volume = w * F33 * Det(F);
    points[g].stretch = w * PetscSqrtReal(I4);
    /* w J sigma = (w P) F^T; m = Fm / |Fm| */
    for (PetscInt k = 0; k < 2; ++k) tm[k] = (Fm[0] * F[k] + Fm[1] * F[2 + k]) / I4; /* F^T m / |Fm| */
    points[g].tension = Fm[0] * (P[0] * tm[0] + P[1] * tm[1]) + Fm[1] * (P[2] * tm[0] + P[3] * tm[1]);
    if (law->fibre) AddFibreCurvature(geometry, wall, 2.0 * w * local.sx[g], A);
    points[g].ellipticity = LamShearBandStiffness((const PetscReal(*)[4])A, F);
    points[g].kinked = points[g].ellipticity < 0.0 ? w : 0.0;
  }
}
