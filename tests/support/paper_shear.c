#include "paper_shear.h"
#include "kernels.h"

ShearState RandomShear(uint64_t *seed)
{
  ShearState state = {.wall = {.law = LAM_WALL_FIBRE_MOONEY_RIVLIN}};

  state.wall.C1 = RandomReal(seed, 0.0, 1.0);
  state.wall.C2 = 1.0 - state.wall.C1;
  state.wall.C4 = RandomReal(seed, 0.0, 20.0);
  state.wall.bulk_modulus = 1000.0;
  state.psi = RandomReal(seed, 0.0, PETSC_PI);
  state.s = RandomReal(seed, -1.2, 1.2);
  return state;
}

/* The p of the paper where the volumetric part of the wall law vanishes, J = 1: its matrix is a deviator by itself. */
static double DeviatoricPressure(const LamWall *wall, double s)
{
  return (wall->C1 - wall->C2) * (1.0 + s * s / 3.0);
}

PetscErrorCode KernelStress(const ShearState *state, double P[5])
{
  const double F[4] = {1.0, state->s, 0.0, 1.0}, M[2] = {cos(state->psi), sin(state->psi)};
  const double Fm[2] = {M[0] + state->s * M[1], M[1]};
  const LamWallLaw *law;
  MatrixPoint matrix;
  KernelPoint fibre, u;

  PetscFunctionBeginUser;
  PetscCall(LamWallLawGet(LAM_WALL_FIBRE_MOONEY_RIVLIN, &law));
  matrix = MatrixAt(law, &state->wall, F, 1.0);
  fibre = FibreAt(law, &state->wall, Fm[0] * Fm[0] + Fm[1] * Fm[1] - 1.0);
  u = VolumetricAt(&state->wall, 0.0);
  P[4] = matrix.P[4] + u.d;
  for (int c = 0; c < 4; c++) {
    const double cof = c == 1 ? 0.0 : (c == 2 ? -state->s : 1.0);

    P[c] = matrix.P[c] + u.d * cof + 2.0 * fibre.d * Fm[c / 2] * M[c % 2];
  }
  PetscFunctionReturn(0);
}

static double LargestStress(const ExactShear *stress)
{
  double largest = fabs(stress->sigma33);

  for (int c = 0; c < 4; c++) largest = fmax(largest, fmax(fabs(stress->sigma[c]), fabs(stress->P[c])));
  return largest;
}

double TractionError(const ShearState *state, const double P[5], double angle)
{
  const double p = DeviatoricPressure(&state->wall, state->s), N[2] = {cos(angle), sin(angle)};
  const ExactShear exact = ShearStress(&state->wall, state->psi, state->s, p);
  const FaceTraction t = ShearTraction(&exact, state->s, N);
  const double n[2] = {1.0 / hypot(1.0, state->s), -state->s / hypot(1.0, state->s)};
  const double t1[2] = {P[0] * n[0], P[2] * n[0]}; /* on X1 = const */
  double error = 0.0;

  for (int i = 0; i < 2; i++)
    error = fmax(error, fabs((P[2 * i] * N[0] + P[2 * i + 1] * N[1]) / t.stretch - t.cauchy[i]));
  error = fmax(error, fabs(t1[0] * n[0] + t1[1] * n[1] - InterfaceNormal(&state->wall, state->psi, state->s, p)));
  error = fmax(error, fabs(t1[1] * n[0] - t1[0] * n[1] - InterfaceShear(&state->wall, state->psi, state->s)));
  return error / (1.0 + LargestStress(&exact));
}

static PetscErrorCode AddKernelErrors(const ShearState *state, double angle, ShearErrors *errors)
{
  const double s = state->s;
  const ExactShear exact = ShearStress(&state->wall, state->psi, s, DeviatoricPressure(&state->wall, s));
  const double scale = 1.0 + LargestStress(&exact);
  double P[5] = {0};

  PetscFunctionBeginUser;
  PetscCall(KernelStress(state, P));
  for (int i = 0; i < 2; i++) {
    const double sigma[2] = {P[2 * i] + s * P[2 * i + 1], P[2 * i + 1]}; /* P F^T */

    for (int j = 0; j < 2; j++) {
      errors->nominal = fmax(errors->nominal, fabs(P[2 * i + j] - exact.P[2 * i + j]) / scale);
      errors->cauchy = fmax(errors->cauchy, fabs(sigma[j] - exact.sigma[2 * i + j]) / scale);
    }
  }
  errors->nominal = fmax(errors->nominal, fabs(P[4] - exact.P33) / scale);
  errors->traction = fmax(errors->traction, TractionError(state, P, angle));
  PetscFunctionReturn(0);
}

/* A parallelogram, on which quadratic shape functions hold f(X2) = s X2 + r X2^2 exactly. */
typedef struct {
  double X[LAM_ELEMENT_NODES][2], x[LAM_ELEMENT_NODES][2], r;
  LamElementGeometry geometry;
} ShearElement;

static PetscErrorCode NewShearElement(const ShearState *state, uint64_t *seed, ShearElement *element)
{
  static const double grid[LAM_ELEMENT_NODES][2] = {{-1, -1}, {1, -1}, {1, 1},  {-1, 1}, {0, -1},
                                                    {1, 0},   {0, 1},  {-1, 0}, {0, 0}};
  const double fibre[2] = {cos(state->psi), sin(state->psi)};
  const double edge[2][2] = {{RandomReal(seed, 0.2, 0.5), RandomReal(seed, -0.1, 0.1)},
                             {RandomReal(seed, -0.1, 0.1), RandomReal(seed, 0.2, 0.5)}};

  PetscFunctionBeginUser;
  element->r = RandomReal(seed, -0.5, 0.5);
  for (int a = 0; a < LAM_ELEMENT_NODES; a++) {
    double *X = element->X[a], *x = element->x[a];

    for (int d = 0; d < 2; d++) X[d] = grid[a][0] * edge[0][d] + grid[a][1] * edge[1][d];
    x[0] = X[0] + state->s * X[1] + element->r * X[1] * X[1];
    x[1] = X[1];
  }
  PetscCall(LamElementSetGeometry((const double(*)[2])element->X, fibre, &element->geometry));
  PetscFunctionReturn(0);
}

/* The closed forms at Gauss point g. */
static ExactShear ExactAtPoint(const ShearElement *element, const ShearState *state, int g, double *s)
{
  double xi, eta, weight, N[9], dN[9][2], X2 = 0.0;

  LamGaussPoint(g, &xi, &eta, &weight);
  LamShape(xi, eta, N, dN);
  for (int a = 0; a < LAM_ELEMENT_NODES; a++) X2 += N[a] * element->X[a][1];
  *s = state->s + 2.0 * element->r * X2;
  return ShearStress(&state->wall, state->psi, *s, DeviatoricPressure(&state->wall, *s));
}

/* Nodal forces, fibre stretches and principal stresses that the closed forms give. */
static double ExactElement(const ShearElement *element, const ShearState *state, double f[LAM_ELEMENT_DOFS],
                           double stretch[LAM_GAUSS], double principal[LAM_GAUSS])
{
  double largest = 0.0;

  memset(f, 0, LAM_ELEMENT_DOFS * sizeof(f[0]));
  for (int g = 0; g < LAM_GAUSS; g++) {
    double s;
    const ExactShear exact = ExactAtPoint(element, state, g, &s);
    const double mean = 0.5 * (exact.sigma[0] + exact.sigma[3]), half = 0.5 * (exact.sigma[0] - exact.sigma[3]);

    largest = fmax(largest, LargestStress(&exact));
    stretch[g] = sqrt(1.0 + ShearFibreStrain(state->psi, s));
    principal[g] = mean + hypot(half, exact.sigma[1]);
    for (int a = 0; a < LAM_ELEMENT_NODES; a++)
      for (int c = 0; c < 4; c++)
        f[2 * a + c / 2] += element->geometry.weight[g] * exact.P[c] * element->geometry.dN[2 * g + c % 2][a];
  }
  return 1.0 + largest;
}

static PetscErrorCode AddElementErrors(const ShearState *state, uint64_t *seed, ShearErrors *errors)
{
  double f[LAM_ELEMENT_DOFS], exact[2][LAM_GAUSS], computed[2][LAM_GAUSS], scale;
  const LamWallLaw *law;
  LamElementStress stress = {0};
  LamElementResult result;
  ShearElement element;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(LamWallLawGet(LAM_WALL_FIBRE_MOONEY_RIVLIN, &law));
  PetscCall(NewShearElement(state, seed, &element));
  scale = ExactElement(&element, state, f, exact[0], exact[1]);
  LamElementEvaluate(&element.geometry, law, &state->wall, NULL,
                     (const double(*)[2])Displaced((const double(*)[2])element.X, (const double(*)[2])element.x).u, 1.0,
                     &stress, &result, &valid);
  PetscCheck(valid, PETSC_COMM_SELF, PETSC_ERR_PLIB, "shear turned an element inside out");
  LamElementFields(&element.geometry, law, &state->wall, NULL,
                   (const double(*)[2])Displaced((const double(*)[2])element.X, (const double(*)[2])element.x).u, 1.0,
                   computed[0], computed[1]);
  for (int i = 0; i < LAM_ELEMENT_DOFS; i++) errors->force = fmax(errors->force, fabs(result.f[i] - f[i]) / scale);
  for (int g = 0; g < LAM_GAUSS; g++) {
    errors->stretch = fmax(errors->stretch, fabs(computed[0][g] - exact[0][g]));
    errors->principal = fmax(errors->principal, fabs(computed[1][g] - exact[1][g]) / scale);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ComputeShearErrors(ShearErrors *errors)
{
  uint64_t seed = 41;

  PetscFunctionBeginUser;
  memset(errors, 0, sizeof(*errors));
  for (int k = 0; k < SHEAR_STATES; k++) {
    const ShearState state = RandomShear(&seed);

    PetscCall(AddKernelErrors(&state, RandomReal(&seed, 0.0, PETSC_PI), errors));
    PetscCall(AddElementErrors(&state, &seed, errors));
  }
  PetscFunctionReturn(0);
}
