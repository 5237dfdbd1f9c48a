/*
  Loading of the walls: measures of tearing, and of whether turgor still keeps the walls in tension.

  Method. Integrals over the walls run along each face, through the whole thickness: each mitred element column has
  three Gauss points along the face; their values, integrated through the thickness, define a quadratic function.
  Means over a length of one wall thickness converge under refinement; point values at the corners of the lumen do
  not.

  The stiffness of the wall material against shear bands (wall_ellipticity.h) is averaged in the same way. At the
  corners stresses are singular, so point values there would depend on the mesh.

  Tension is the Cauchy stress along the fibre relative to that of the surrounding fluid, -p of its own cell.
*/
#include "measure.h"

#define SAMPLES 8 /* per element column: sub-intervals of the running integrals */

enum { REFERENCE, VOLUME, STRETCH, ENERGY, TENSION, SOFTNESS, INTEGRALS };

/* Running integrals along one face, [along * SAMPLES + 1] each. */
typedef struct {
  PetscReal *running[INTEGRALS];
  PetscReal kinked; /* reference volume, of all faces so far */
} WallSums;

/* Integral of the quadratic function with value 1 at Gauss point g and 0 at the other two, from -1 to xi. */
static PetscReal QuadraticIntegral(PetscInt g, PetscReal xi)
{
  const PetscReal r2 = 0.6, r = PetscSqrtReal(r2), cubic = (xi * xi * xi + 1.0) / 3.0;
  const PetscReal square = 0.5 * (xi * xi - 1.0);

  if (g == 1) return xi + 1.0 - cubic / r2;
  return (cubic + (g == 0 ? -r : r) * square) / (2.0 * r2);
}

/* Fraction of the integral of Gauss point g along the face up to the end of sub-interval s. */
static void SetShares(PetscReal share[SAMPLES][3])
{
  for (PetscInt s = 0; s < SAMPLES; ++s)
    for (PetscInt g = 0; g < 3; ++g)
      share[s][g] = QuadraticIntegral(g, -1.0 + 2.0 * (PetscReal)(s + 1) / SAMPLES) / QuadraticIntegral(g, 1.0);
}

static void WallPoints(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscInt e, LamWallPoint points[LAM_GAUSS])
{
  PetscReal u[LAM_ELEMENT_NODES][2];

  LamGatherDisplacements(rve, load->F, y, e, u);
  LamElementWallPoints(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), LamHistoryOf(rve, e),
                       (const PetscReal(*)[2])u, load->F[8], points);
}

/* Integrals through the wall at the three Gauss points along the face of element column i; adds the kinked volume. */
static void SumThroughWall(LamRVE rve, const LamLoad *load, PetscInt face, PetscInt i, PetscReal column[3][INTEGRALS],
                           PetscReal *kinked)
{
  const PetscReal turgor = LamTurgor(rve, load, rve->y, rve->mesh.tissue->cell[face]);
  const PetscReal scale = rve->memory ? rve->memory->step.scale : 1.0; /* energies are those of the moduli given */

  for (PetscInt h = 0; h < 3; ++h)
    for (PetscInt q = 0; q < INTEGRALS; ++q) column[h][q] = 0.0;
  for (PetscInt m = 0; m < rve->mesh.through; ++m) {
    const PetscInt e = LamMeshElement(&rve->mesh, face, i, m);
    LamWallPoint points[LAM_GAUSS];

    WallPoints(rve, load, rve->y, e, points);
    for (PetscInt g = 0; g < LAM_GAUSS; ++g) { /* g / 3 counts along the face, g % 3 through the wall */
      PetscReal *sum = column[g / 3];

      sum[REFERENCE] += points[g].reference;
      sum[VOLUME] += points[g].volume;
      sum[STRETCH] += points[g].stretch;
      sum[ENERGY] += points[g].energy / scale;
      sum[TENSION] += points[g].tension + turgor * points[g].volume;
      sum[SOFTNESS] -= points[g].ellipticity;
      *kinked += points[g].kinked;
    }
  }
}

static void SumAlongFace(LamRVE rve, const LamLoad *load, const PetscReal share[SAMPLES][3], PetscInt face,
                         WallSums *sums)
{
  for (PetscInt q = 0; q < INTEGRALS; ++q) sums->running[q][0] = 0.0;
  for (PetscInt i = 0; i < rve->mesh.along; ++i) {
    PetscReal column[3][INTEGRALS];

    SumThroughWall(rve, load, face, i, column, &sums->kinked);
    for (PetscInt q = 0; q < INTEGRALS; ++q) {
      PetscReal *running = &sums->running[q][i * SAMPLES];

      for (PetscInt s = 0; s < SAMPLES; ++s)
        running[s + 1] =
            running[0] + share[s][0] * column[0][q] + share[s][1] * column[1][q] + share[s][2] * column[2][q];
    }
  }
}

PetscErrorCode LamWallMeasures(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  const PetscInt count = rve->mesh.along * SAMPLES;
  PetscReal share[SAMPLES][3], tension[3] = {0.0, 0.0, 0.0}, volume[3] = {0.0, 0.0, 0.0}, walls = 0.0, *work;
  LamLargestMean stretch = LAM_NO_MEAN, energy = LAM_NO_MEAN, stress = LAM_NO_MEAN, softness = LAM_NO_MEAN;
  WallSums sums = {.kinked = 0.0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(INTEGRALS * (count + 1), &work));
  for (PetscInt q = 0; q < INTEGRALS; ++q) sums.running[q] = &work[q * (count + 1)];
  SetShares(share);
  for (PetscInt face = 0; face < rve->mesh.tissue->faces; ++face) {
    const PetscReal *reference = sums.running[REFERENCE], *current = sums.running[VOLUME];
    const PetscReal *pull = sums.running[TENSION], thickness = rve->mesh.thickness[face];
    const PetscInt family = rve->mesh.tissue->direction[face] % 3;

    SumAlongFace(rve, load, (const PetscReal(*)[3])share, face, &sums);
    LamTakeLargestMean(&rve->mesh, thickness, face, count, sums.running[STRETCH], reference, &stretch);
    LamTakeLargestMean(&rve->mesh, thickness, face, count, sums.running[ENERGY], reference, &energy);
    LamTakeLargestMean(&rve->mesh, thickness, face, count, pull, current, &stress);
    LamTakeLargestMean(&rve->mesh, thickness, face, count, sums.running[SOFTNESS], reference, &softness);
    walls += reference[count];
    tension[family] += pull[count];
    volume[family] += current[count];
  }
  PetscCall(PetscFree(work));
  response->max_fibre_stretch = stretch.value;
  response->max_wall_energy = energy.value;
  response->max_wall_tension = stress.value;
  PetscCall(PetscArraycpy(response->wall_place, stress.place, 3));
  response->wall_ellipticity = -softness.value;
  PetscCall(PetscArraycpy(response->kink_place, softness.place, 3));
  response->kinked_fraction = sums.kinked / walls;
  for (PetscInt k = 0; k < 3; ++k) response->mean_wall_tension[k] = tension[k] / volume[k];
  PetscFunctionReturn(0);
}

void LamWatchKinks(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal t, LamKinking *kinking)
{
  PetscReal kinked = 0.0, all = 0.0;

  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    LamWallPoint points[LAM_GAUSS];

    WallPoints(rve, load, y, e, points);
    for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
      kinked += points[g].kinked;
      all += points[g].reference;
    }
  }
  kinking->share = kinked / all;
  if (kinking->share <= LAM_KINKED_SHARE)
    kinking->between[0] = kinking->between[1] = t;
  else if (!LamIsKinking(kinking))
    kinking->between[1] = t;
}

PetscErrorCode LamRefuseKinks(const LamKinking *kinking, PetscReal reached, LamStatus status, LamResponse *response)
{
  char place[80] = " already where the way starts";

  PetscFunctionBeginUser;
  if (kinking->between[0] >= 0.0) LamBracketText(kinking->between, place, sizeof(place));
  PetscCall(LamRefuse(response, status,
                      "walls lose ellipticity%s and kink ever finer: %.2g %% of them at %.4g, the last stable state on "
                      "this mesh; `fibres: tension` would not",
                      place, (double)(100.0 * kinking->share), (double)reached));
  PetscFunctionReturn(0);
}
