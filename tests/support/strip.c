#include "strip.h"
#include "kernels.h"

static void StripPlace(void *ctx, PetscInt i, PetscInt j, PetscReal X[2])
{
  const StripProblem *problem = (const StripProblem *)ctx;

  X[0] = problem->length * (double)i / (double)(2 * problem->columns);
  X[1] = (double)j / (double)(2 * problem->rows);
}

/* What is held, where it starts (simple shear; generalised where that is held), and which components repeat others. */
static PetscErrorCode StripConstrain(Strip *strip)
{
  const StripProblem *p = strip->problem;
  const PetscInt across = 2 * p->columns + 1, nodes = strip->blocks.node_count;
  const double slide = ShearProfile(&p->wall, p->psi, p->a, p->b, 1.0);
  Blocks *b = &strip->blocks;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * nodes, &strip->map));
  for (PetscInt node = 0; node < nodes; ++node) {
    const PetscBool bottom = (PetscBool)(node < across), top = (PetscBool)(node >= nodes - across);
    const PetscBool guided = (PetscBool)(p->free_face && node % across == 0);
    const PetscBool repeats = (PetscBool)(!p->free_face && node % across == across - 1);

    b->held[node][0] = (PetscBool)(bottom || guided || (top && !p->pulled));
    b->held[node][1] = (PetscBool)(bottom || guided || top);
    b->x[node][0] += p->free_face ? ShearProfile(&p->wall, p->psi, p->a, p->b, b->X[node][1]) : slide * b->X[node][1];
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscInt before = 2 * (node - 2 * p->columns) + d;

      if (b->held[node][d])
        strip->map[2 * node + d] = -1;
      else
        strip->map[2 * node + d] = repeats ? strip->map[before] : strip->size++;
    }
  }
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, 2 * nodes, strip->size, 1, NULL, &strip->prolongation));
  for (PetscInt i = 0; i < 2 * nodes; ++i)
    PetscCall(MatSetValue(strip->prolongation, i, strip->map[i], 1.0, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(strip->prolongation, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(strip->prolongation, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode StripCreate(StripProblem *problem, Strip *strip)
{
  const PetscInt nodes = (2 * problem->columns + 1) * (2 * problem->rows + 1);
  PetscInt first;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(strip, sizeof(*strip)));
  strip->problem = problem;
  PetscCall(BlocksCreate(nodes, problem->columns * problem->rows, 0, 0, &strip->blocks));
  strip->blocks.wall = problem->wall;
  strip->blocks.fibre[0] = cos(problem->psi);
  strip->blocks.fibre[1] = sin(problem->psi);
  PetscCall(LamWallLawGet(problem->wall.law, &strip->blocks.law));
  PetscCall(BlocksAddGrid(&strip->blocks, problem->columns, problem->rows, StripPlace, problem, &first));
  PetscCall(StripConstrain(strip));
  PetscFunctionReturn(0);
}

PetscErrorCode StripDestroy(Strip *strip)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&strip->prolongation));
  PetscCall(PetscFree(strip->map));
  PetscCall(BlocksDestroy(&strip->blocks));
  PetscFunctionReturn(0);
}

/* Adds -forces and tangent of the pressure a `length` on the right side: -p int N_a (dx2, -dx1) on quadratic edges. */
static PetscErrorCode StripAddPressure(const Strip *strip, Mat K, PetscReal residual[])
{
  static const double C[3][3] = {/* int N_a dN_b */
                                 {-1.0 / 2.0, 2.0 / 3.0, -1.0 / 6.0},
                                 {-2.0 / 3.0, 0.0, 2.0 / 3.0},
                                 {1.0 / 6.0, -2.0 / 3.0, 1.0 / 2.0}};
  const Blocks *b = &strip->blocks;
  const PetscInt across = 2 * strip->problem->columns + 1;
  const double pressure = strip->problem->a * strip->problem->length;

  PetscFunctionBeginUser;
  for (PetscInt edge = 0; edge < strip->problem->rows && !strip->problem->free_face; ++edge)
    for (PetscInt k = 0; k < 3; ++k)
      for (PetscInt l = 0; l < 3; ++l) {
        const PetscInt from = (2 * edge + k + 1) * across - 1, to = (2 * edge + l + 1) * across - 1;

        for (PetscInt d = 0; d < 2; ++d) {
          const double slope = (d == 0 ? pressure : -pressure) * C[k][l];

          residual[2 * from + d] += slope * b->x[to][1 - d];
          PetscCall(MatSetValue(K, 2 * from + d, 2 * to + 1 - d, slope, ADD_VALUES));
        }
      }
  PetscFunctionReturn(0);
}

/* Adds -forces of the shear traction a + b at X2 = 1, where nominal and Cauchy tractions are the same. */
static void StripAddTraction(const Strip *strip, PetscReal residual[])
{
  static const double share[3] = {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};
  const StripProblem *p = strip->problem;
  const PetscInt first = strip->blocks.node_count - 2 * p->columns - 1;
  const double force = (p->a + p->b) * p->length / (double)p->columns;

  for (PetscInt e = 0; e < p->columns && p->pulled; ++e)
    for (PetscInt k = 0; k < 3; ++k) residual[2 * (first + 2 * e + k)] -= share[k] * force;
}

/* Residual of the free components, and K of all, assembled. */
static PetscErrorCode StripAssemble(Strip *strip, Mat K, PetscReal reduced[])
{
  const PetscInt all = 2 * strip->blocks.node_count;
  PetscReal *residual;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(all, &residual));
  PetscCall(BlocksAddWalls(&strip->blocks, K, residual, &valid));
  PetscCheck(valid, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "an element of the strip is inside out");
  PetscCall(StripAddPressure(strip, K, residual));
  StripAddTraction(strip, residual);
  PetscCall(MatAssemblyBegin(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(K, MAT_FINAL_ASSEMBLY));
  for (PetscInt i = 0; i < all; ++i)
    if (strip->map[i] >= 0) reduced[strip->map[i]] += residual[i];
  PetscCall(PetscFree(residual));
  PetscFunctionReturn(0);
}

/* One Newton step, or none where the residual is below `tolerance`. */
static PetscErrorCode StripIterate(Strip *strip, double tolerance, PetscBool *done)
{
  const PetscInt all = 2 * strip->blocks.node_count;
  PetscReal *residual, *y, *step, largest = 0.0;
  Mat K, reduced;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(strip->size, &residual, strip->size, &y, all, &step));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, all, all, 60, NULL, &K));
  PetscCall(StripAssemble(strip, K, residual));
  for (PetscInt i = 0; i < strip->size; ++i) {
    largest = PetscMax(largest, PetscAbsReal(residual[i]));
    residual[i] *= -1.0;
  }
  *done = (PetscBool)(largest <= tolerance);
  if (!*done) {
    PetscCall(MatPtAP(K, strip->prolongation, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &reduced));
    PetscCall(BlocksFactorAndSolve(reduced, strip->size, residual, y, NULL));
    PetscCall(MatDestroy(&reduced));
    for (PetscInt i = 0; i < all; ++i) step[i] = strip->map[i] < 0 ? 0.0 : y[strip->map[i]];
    BlocksStep(&strip->blocks, step);
  }
  PetscCall(MatDestroy(&K));
  PetscCall(PetscFree3(residual, y, step));
  PetscFunctionReturn(0);
}

PetscErrorCode StripSolve(Strip *strip, PetscInt *iterations)
{
  const StripProblem *p = strip->problem;
  const double slenderness = PetscMax(4.0, p->length * (double)p->rows / (double)p->columns);
  const double tolerance =
      PetscMax(1e-12, 4.0 * PETSC_MACHINE_EPSILON * (p->wall.bulk_modulus + p->wall.C4) * slenderness);
  PetscBool done = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (*iterations = 0; *iterations < BLOCKS_ITERATIONS; ++*iterations) {
    PetscCall(StripIterate(strip, tolerance, &done));
    if (done) break;
  }
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "no equilibrium of the strip in %d iterations",
             BLOCKS_ITERATIONS);
  PetscFunctionReturn(0);
}

/* ---- against generalised shear ---- */

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
  MatrixPoint matrix;
  KernelPoint fibre;

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
  for (int k = 0; k < LAM_PRESSURES; k++) p += geometry->psi[k][g] * b->stress[e].px[k];
  matrix = MatrixAt(b->law, &b->wall, point.F, 1.0);
  fibre = FibreAt(b->law, &b->wall, Fm[0] * Fm[0] + Fm[1] * Fm[1] - 1.0);
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
