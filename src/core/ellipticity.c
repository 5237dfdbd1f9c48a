/*
  Smallest eigenvalue of the acoustic tensor over all directions.

  Method. With N = (cos, sin)(phi/2) the acoustic tensor Q_ik = A_ijkl N_j N_l is linear in (1, cos phi, sin phi).
  With its half trace T and the deviator d = ((Q11 - Q22)/2, Q12) the smallest eigenvalue is
    f(phi) = T - |d|,     f' = T' - d.d'/|d|.
  Where d vanishes f has a kink, which is a maximum: its minima are smooth. The condition f' = 0, squared, is a
  trigonometric polynomial of degree 4, so that f has at most four minima. Samples bracket them, and Newton's method
  on f', safeguarded by bisection, converges to rounding.

  Reference: Ogden, Non-linear Elastic Deformations (1984), Section 6.2.7 (strong ellipticity).
*/
#include <lamella/ellipticity.h>
#include <math.h>

#define SAMPLES 48 /* over a full turn of phi */
#define STEPS 40
#define TIE 1e-9       /* relative to the size of A: smaller differences count as ties */
#define HALF_TURN 1e-7 /* angles this close to a half turn are 0 up to rounding */

/* Half trace and deviator, coefficients of 1, cos phi, sin phi. */
typedef struct {
  PetscReal trace[3], deviator[2][3];
} Acoustic;

static void AcousticMake(const PetscReal A[16], Acoustic *q)
{
  const PetscReal Q[3][3] = {{A[0], A[5], A[1] + A[4]},                  /* 11: N1 N1, N2 N2, N1 N2 */
                             {A[10], A[15], A[11] + A[14]},              /* 22 */
                             {0.5 * (A[2] + A[8]), 0.5 * (A[7] + A[13]), /* 12 */
                              0.5 * (A[3] + A[6] + A[9] + A[12])}};
  PetscReal c[3][3];

  for (int k = 0; k < 3; k++) {
    c[k][0] = 0.5 * (Q[k][0] + Q[k][1]);
    c[k][1] = 0.5 * (Q[k][0] - Q[k][1]);
    c[k][2] = 0.5 * Q[k][2];
  }
  for (int k = 0; k < 3; k++) {
    q->trace[k] = 0.5 * (c[0][k] + c[1][k]);
    q->deviator[0][k] = 0.5 * (c[0][k] - c[1][k]);
    q->deviator[1][k] = c[2][k];
  }
}

static inline PetscReal At(const PetscReal c[3], PetscReal cosine, PetscReal sine)
{
  return c[0] + c[1] * cosine + c[2] * sine;
}

static inline PetscReal Smallest(const Acoustic *q, PetscReal cosine, PetscReal sine)
{
  const PetscReal d0 = At(q->deviator[0], cosine, sine), d1 = At(q->deviator[1], cosine, sine);

  return At(q->trace, cosine, sine) - PetscSqrtReal(d0 * d0 + d1 * d1);
}

/* f' and f''. */
static void Slopes(const Acoustic *q, PetscReal phi, PetscReal slope[2])
{
  const PetscReal c = cos(phi), s = sin(phi);
  PetscReal size2 = 0, along = 0, first2 = 0, bend = 0;

  slope[0] = -q->trace[1] * s + q->trace[2] * c;
  slope[1] = -q->trace[1] * c - q->trace[2] * s;
  for (int k = 0; k < 2; k++) {
    const PetscReal d = At(q->deviator[k], c, s);
    const PetscReal first = -q->deviator[k][1] * s + q->deviator[k][2] * c, second = q->deviator[k][0] - d;

    size2 += d * d;
    along += d * first;
    first2 += first * first;
    bend += d * second;
  }
  if (!(size2 > 0)) return;
  slope[0] -= along / PetscSqrtReal(size2);
  slope[1] -= (first2 + bend - along * along / size2) / PetscSqrtReal(size2);
}

/* The minimum in [low, high], where f' changes from negative to positive. */
static PetscReal Refine(const Acoustic *q, PetscReal low, PetscReal high)
{
  PetscReal phi = 0.5 * (low + high);

  for (int k = 0; k < STEPS && high - low > 1e-15; k++) {
    PetscReal slope[2], next;

    Slopes(q, phi, slope);
    if (slope[0] == 0) break;
    *(slope[0] < 0 ? &low : &high) = phi;
    next = phi - slope[0] / slope[1];
    if (!(slope[1] > 0) || !(next > low && next < high)) next = 0.5 * (low + high);
    if (fabs(next - phi) < 1e-15) break;
    phi = next;
  }
  return phi;
}

/* Of the two unit vectors on a line, the one with an angle in [0, pi). */
static void SetDirection(PetscReal angle, PetscReal direction[2])
{
  while (angle < -HALF_TURN) angle += PETSC_PI;
  while (angle >= PETSC_PI - HALF_TURN) angle -= PETSC_PI;
  direction[0] = cos(angle);
  direction[1] = sin(angle);
}

/* Unit eigenvector of the smallest eigenvalue; if the eigenvalues are equal, the direction perpendicular to N. */
static void SetMode(const Acoustic *q, PetscReal phi, LamBand *band)
{
  const PetscReal c = cos(phi), s = sin(phi), d0 = At(q->deviator[0], c, s), d1 = At(q->deviator[1], c, s);
  const PetscReal rounding = 1e-13 * (fabs(At(q->trace, c, s)) + fabs(band->value));
  PetscReal angle = 0.5 * atan2(-d1, -d0);

  if (hypot(d0, d1) <= rounding) angle = 0.5 * phi + 0.5 * PETSC_PI;
  SetDirection(0.5 * phi, band->normal);
  SetDirection(angle, band->mode);
}

/* Samples f over a full turn. */
static void Sample(const Acoustic *q, PetscReal f[SAMPLES])
{
  const PetscReal c1 = cos(2 * PETSC_PI / SAMPLES), s1 = sin(2 * PETSC_PI / SAMPLES);
  PetscReal c = 1, s = 0;

  for (int k = 0; k < SAMPLES; k++) {
    const PetscReal turned = c * c1 - s * s1;

    f[k] = Smallest(q, c, s);
    s = s * c1 + c * s1;
    c = turned;
  }
}

void LamBandFind(const PetscReal A[16], LamBand *band)
{
  const PetscReal step = 2 * PETSC_PI / SAMPLES;
  PetscReal f[SAMPLES], size = 0, sum = 0, best = 0;
  Acoustic q;

  *band = (LamBand){NAN, {NAN, NAN}, {NAN, NAN}};
  for (int i = 0; i < 16; i++) {
    size = PetscMax(size, fabs(A[i]));
    sum += A[i];
  }
  if (!isfinite(sum)) return;
  AcousticMake(A, &q);
  Sample(&q, f);
  band->value = f[0];
  for (int k = 0; k < SAMPLES; k++) {
    const PetscReal before = f[(k + SAMPLES - 1) % SAMPLES], after = f[(k + 1) % SAMPLES];
    PetscReal phi, value;

    if (f[k] > before || f[k] > after) continue;
    phi = Refine(&q, (k - 1) * step, (k + 1) * step);
    value = Smallest(&q, cos(phi), sin(phi));
    if (value >= band->value - TIE * size) continue;
    band->value = value;
    best = phi;
  }
  SetMode(&q, best, band);
}

void LamResponseFindBand(LamResponse *r)
{
  PetscReal A[16];
  LamBand band;

  for (int ij = 0; ij < 4; ij++)
    for (int kl = 0; kl < 4; kl++) A[4 * ij + kl] = r->tangent[9 * (3 * (ij / 2) + ij % 2) + 3 * (kl / 2) + kl % 2];
  LamBandFind(A, &band);
  r->ellipticity = band.value;
  for (int i = 0; i < 2; i++) {
    r->localisation_normal[i] = band.normal[i];
    r->localisation_mode[i] = band.mode[i];
  }
  r->localisation_normal[2] = r->localisation_mode[2] = isnan(band.value) ? NAN : 0;
}

PetscReal LamBandAngle(const PetscReal direction[])
{
  return atan2(direction[1], direction[0]) * 180 / PETSC_PI;
}
