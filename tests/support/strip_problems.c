#include "strip_problems.h"

StripProblem DefaultStrip(PetscInt rows, double bulk)
{
  return (StripProblem){.wall = {.law = LAM_WALL_FIBRE_MOONEY_RIVLIN,
                                 .C1 = 1.0 / 1.1,
                                 .C2 = 0.1 / 1.1,
                                 .C4 = 10.0 / 1.1,
                                 .bulk_modulus = bulk},
                        .psi = 0.5 * PETSC_PI,
                        .a = 1.5,
                        .b = 0.2,
                        .length = 0.5,
                        .columns = 2,
                        .rows = rows};
}

/* Gauss point g of element e: place, x1, x2, F and P in the plane. */
typedef struct {
  double X[2], x[2], F[4], P[4];
} StripPoint;

static StripPoint StripAtPoint(const Strip *strip, PetscInt e, PetscInt g)
{
  const Blocks *b = &strip->blocks;
  const LamElementGeometry *geometry = &b->geometry[e];
  double x[LAM_ELEMENT_NODES][2], N[LAM_ELEMENT_NODES], dN[LAM_ELEMENT_NODES][2], xi, eta, weight, p = 0.0, Fm[2];
  StripPoint point = {0};
  LamKernel matrix;
  LamKernel1 fibre;

  BlocksGather(b, e, x);
  LamGaussPoint(g, &xi, &eta, &weight);
  LamShape(xi, eta, N, dN);
  for (int a = 0; a < LAM_ELEMENT_NODES; a++) {
    for (int d = 0; d < 2; d++) {
      point.X[d] += N[a] * b->X[b->elements[e][a]][d];
      point.x[d] += N[a] * x[a][d];
    }
    for (int c = 0; c < 4; c++) point.F[c] += x[a][c / 2] * geometry->dN[2 * g + c % 2][a];
  }
  for (int i = 0; i < 2; i++) Fm[i] = point.F[2 * i] * geometry->fibre[0] + point.F[2 * i + 1] * geometry->fibre[1];
  for (int k = 0; k < LAM_PRESSURES; k++) p += geometry->psi[g][k] * b->stress[e].px[k];
  LamMatrixAt(b->law, &b->wall, point.F, 1.0, &matrix);
  b->law->fibre(&b->wall, Fm[0] * Fm[0] + Fm[1] * Fm[1] - 1.0, &fibre);
  for (int c = 0; c < 4; c++)
    point.P[c] =
        matrix.P[c] + p * (c % 3 ? -1.0 : 1.0) * point.F[3 - c] + 2.0 * fibre.d * Fm[c / 2] * geometry->fibre[c % 2];
  return point;
}

/* Mean of P22 + a x1, which is uniform. */
static double StripMeanNormal(const Strip *strip)
{
  double sum = 0.0, area = 0.0;

  for (PetscInt e = 0; e < strip->blocks.element_count; ++e)
    for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
      const StripPoint point = StripAtPoint(strip, e, g);

      sum += strip->blocks.geometry[e].weight[g] * (point.P[3] + strip->problem->a * point.x[0]);
      area += strip->blocks.geometry[e].weight[g];
    }
  return sum / area;
}

static void StripCompare(const Strip *strip, StripErrors *errors)
{
  const StripProblem *p = strip->problem;
  const double mean = StripMeanNormal(strip), largest = PetscMax(fabs(p->b), fabs(p->a + p->b));
  double sum[5] = {0}, area = 0.0;

  for (PetscInt e = 0; e < strip->blocks.element_count; ++e)
    for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
      const StripPoint point = StripAtPoint(strip, e, g);
      const double weight = strip->blocks.geometry[e].weight[g], tau = p->a * point.X[1] + p->b;
      const double f = ShearProfile(&p->wall, p->psi, p->a, p->b, point.X[1]);

      sum[0] += weight * PetscSqr(point.x[0] - point.X[0] - f);
      sum[1] += weight * PetscSqr(point.F[1] - ShearOfStress(&p->wall, p->psi, tau));
      sum[2] += weight * PetscSqr(point.x[1] - point.X[1]);
      sum[3] += weight * PetscSqr((point.P[1] - tau) / largest);
      sum[4] += weight * PetscSqr((point.P[3] + p->a * point.x[0] - mean) / largest);
      area += weight;
    }
  errors->displacement = sqrt(sum[0] / area);
  errors->gradient = sqrt(sum[1] / area);
  errors->lateral = sqrt(sum[2] / area);
  errors->shear = sqrt(sum[3] / area);
  errors->normal = sqrt(sum[4] / area);
  errors->nodal = 0.0;
  for (PetscInt node = 0; node < strip->blocks.node_count; ++node) {
    const double *X = strip->blocks.X[node];
    const double f = ShearProfile(&p->wall, p->psi, p->a, p->b, X[1]);

    errors->nodal = PetscMax(errors->nodal, fabs(strip->blocks.x[node][0] - X[0] - f));
  }
}

PetscErrorCode ComputeStrip(StripProblem problem, StripErrors *errors)
{
  Strip strip;

  PetscFunctionBeginUser;
  PetscCall(StripCreate(&problem, &strip));
  PetscCall(StripSolve(&strip, &errors->iterations));
  StripCompare(&strip, errors);
  PetscCall(StripDestroy(&strip));
  PetscFunctionReturn(0);
}
