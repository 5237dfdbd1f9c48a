/*
  Strong ellipticity of the wall material at a point, for volume-preserving jumps of F.

  Method. A band of current normal n = (c, s) whose sides slide along m = (-s, c) changes F by (m (x) n) F. With
  C = cos 2 alpha, S = sin 2 alpha of the angle alpha of n,
    m (x) n = (W + C T + S D)/2,   W = (0 -1; 1 0),   T = (0 1; 1 0),   D = (-1 0; 0 1),
  so the stiffness (m (x) n) F : A : (m (x) n) F is x.G x with x = (1, C, S), G symmetric: a quadratic function on the
  unit circle. In the principal axes of its quadratic part, with eigenvalues h1 <= h2, its minimum is at
  x_i = -g_i/(h_i - l) with the root l <= h1 of sum (g_i/(h_i - l))^2 = 1, found by Newton on 1/|x(l)|, which is almost
  linear in l.

  The volumetric part U(J) contributes nothing: J is constant along m (x) n.

  Reference: More and Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553.
*/
#ifndef LAM_RVE_WALL_ELLIPTICITY_H
#define LAM_RVE_WALL_ELLIPTICITY_H

#include <petscsys.h>

/*
  Returns the minimum of h1 x1^2 + h2 x2^2 + 2 (g1 x1 + g2 x2) over x1^2 + x2^2 = 1, for h1 <= h2. Needs only the
  squares g11 = g1^2 and g22 = g2^2: at the minimum the signs of x follow from those of g.
*/
static inline PetscReal LamCircleMinimum(PetscReal h1, PetscReal h2, PetscReal g11, PetscReal g22)
{
  const PetscReal gap = h2 - h1, size = PetscSqrtReal(g11 + g22);
  PetscReal d = PetscMax(PetscSqrtReal(g11), size - gap); /* h1 - l, start from below, where |x| >= 1 */

  if (!(size > 0.0)) return h1;
  if (g11 <= 1e-15 * PetscSqr(size + gap)) { /* the root is l = h1, unless |x2| > 1 there */
    const PetscReal g2 = PetscSqrtReal(g22), x2 = gap > g2 ? g2 / gap : 1.0;

    return h1 + x2 * (x2 * gap - 2.0 * g2);
  }
  for (PetscInt k = 0; k < 20; ++k) {
    const PetscReal i1 = 1.0 / d, i2 = 1.0 / (d + gap), x11 = g11 * i1 * i1, x22 = g22 * i2 * i2;
    const PetscReal step = (PetscSqrtReal(x11 + x22) - 1.0) * (x11 + x22) / (x11 * i1 + x22 * i2);

    d += step;
    if (step < 1e-5 * d) break; /* converges quadratically, and the error enters the minimum squared */
  }
  /* x.H x + 2 g.x = l + g.x; as a function of l it has its maximum at the root */
  return h1 - d - g11 / d - g22 / (d + gap);
}

/* Smallest stiffness over all band directions, negative where ellipticity is lost. A: second derivative of the energy
   in F = (F11 F12 F21 F22), without the volumetric part. */
static inline PetscReal LamShearBandStiffness(const PetscReal A[4][4], const PetscReal F[4])
{
  const PetscReal B[3][4] = {{-F[2], -F[3], F[0], F[1]}, {F[2], F[3], F[0], F[1]}, {-F[0], -F[1], F[2], F[3]}};
  PetscReal G[3][3], mean, half, spread, sum, turned;

  for (PetscInt a = 0; a < 3; ++a) {
    PetscReal AB[4];

    for (PetscInt r = 0; r < 4; ++r)
      AB[r] = A[0][r] * B[a][0] + A[1][r] * B[a][1] + A[2][r] * B[a][2] + A[3][r] * B[a][3];
    for (PetscInt b = 0; b <= a; ++b)
      G[b][a] = 0.25 * (B[b][0] * AB[0] + B[b][1] * AB[1] + B[b][2] * AB[2] + B[b][3] * AB[3]);
  }
  mean = 0.5 * (G[1][1] + G[2][2]);
  half = 0.5 * (G[1][1] - G[2][2]);
  spread = PetscSqrtReal(half * half + G[1][2] * G[1][2]);
  /* squares of g in the principal axes (eigenvalues mean -+ spread), at half the angle of (half, G12) */
  sum = 0.5 * (G[0][1] * G[0][1] + G[0][2] * G[0][2]);
  turned = half * 0.5 * (G[0][1] * G[0][1] - G[0][2] * G[0][2]) + G[1][2] * G[0][1] * G[0][2];
  turned = spread > 0.0 ? turned / spread : sum;
  return G[0][0] +
         LamCircleMinimum(mean - spread, mean + spread, PetscMax(sum - turned, 0.0), PetscMax(sum + turned, 0.0));
}

#endif
