/*
  Method
    A state is a cell that touches none of its periodic images: F = e^x I with x large enough. By symmetry the walls
    face each other at their middles, so that 2 e^x - (smallest gap) is the cell's width. a and its derivatives are
    those of a cubic spline in tau. The energy is the quintic Hermite polynomial in s of the exact first and second
    derivatives. The Taylor step in p uses cubic Hermite polynomials in tau, with derivatives from five-point
    differences.
*/
#include "free_cell.h"
#include <lamella/lattice.h>
#include <lamella/tissue.h>
#include "json.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

#define FIRST_STRAIN 0.15 /* of the states; increased by STRAIN_STEP up to MAX_STRAIN until all cells float */
#define STRAIN_STEP 0.1
#define MAX_STRAIN 0.8
#define MIN_KNOTS 5   /* of the five-point differences */
#define MAX_PLANES 63 /* of a file that is not damaged (grid.h) */

/* The arrays of LamFreeCell with one number per knot. */
#define COLUMNS 13
#define PLAIN_COLUMNS 8 /* those of one plane, too */
#define JSON_COLUMNS 11
static const struct {
  const char *name;
  size_t offset;
} columns[COLUMNS] = {{"suction", offsetof(LamFreeCell, suction)},
                      {"strain", offsetof(LamFreeCell, strain)},
                      {"strain_curvature", offsetof(LamFreeCell, strain_curvature)},
                      {"energy", offsetof(LamFreeCell, energy)},
                      {"slope", offsetof(LamFreeCell, slope)},
                      {"curvature", offsetof(LamFreeCell, curvature)},
                      {"turgor_slope", offsetof(LamFreeCell, turgor_slope)},
                      {"turgor_curvature", offsetof(LamFreeCell, turgor_curvature)},
                      {"axial", offsetof(LamFreeCell, axial)},
                      {"axial_curvature", offsetof(LamFreeCell, axial_curvature)},
                      {"turgor_axial", offsetof(LamFreeCell, turgor_axial)},
                      {NULL, offsetof(LamFreeCell, strain_z2)},
                      {NULL, offsetof(LamFreeCell, curvature_z2)}};

static PetscReal **ColumnOf(LamFreeCell *cell, PetscInt k)
{
  return (PetscReal **)(void *)((char *)cell + columns[k].offset);
}

static PetscInt ColumnCount(const LamFreeCell *cell, PetscInt of_all)
{
  return cell->planes > 1 ? of_all : PLAIN_COLUMNS;
}

/* Numbers of a column: suctions are those of all planes. */
static PetscInt ColumnLength(const LamFreeCell *cell, PetscInt k)
{
  return k ? LamFreeCellStates(cell) : cell->n;
}

/* Allocates all columns of cell->planes in one block, owned by the first. */
static PetscErrorCode Allocate(PetscInt n, LamFreeCell *cell)
{
  const PetscInt count = ColumnCount(cell, COLUMNS);
  PetscReal *block;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(count * n * cell->planes, &block));
  cell->n = n;
  for (PetscInt k = 0; k < count; k++) *ColumnOf(cell, k) = n ? block + k * LamFreeCellStates(cell) : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFreeCellDestroy(LamFreeCell *cell)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(cell->suction));
  PetscCall(PetscFree(cell->records));
  memset(cell, 0, sizeof(*cell));
  PetscFunctionReturn(0);
}

/* ---- the states ---- */

static LamLoad LoadOf(PetscReal x, PetscReal F33, PetscReal suction, PetscReal cohesion)
{
  const PetscReal stretch = PetscExpReal(x);

  return (LamLoad){.F = {stretch, 0, 0, 0, stretch, 0, 0, 0, F33}, .turgor = suction - cohesion, .cohesion = cohesion};
}

static PetscBool Floats(const LamResponse *r)
{
  return (PetscBool)(r->status == LAM_CONVERGED && r->floating_cells == 1 && r->min_gap > 0);
}

/* Cells that differ, or that are held by a grip, do not all float at one suction. Several cells in a period drift apart
   arbitrarily, and no gap determines their width. Neither does it of a cell that is no regular hexagon. */
static PetscErrorCode HasOneHexagon(const LamMicrostructure *micro, PetscBool *has)
{
  LamSymmetry symmetry;

  PetscFunctionBeginUser;
  *has = (PetscBool)(LamCellsPart(micro->interface) && !micro->is_patch && !micro->cell &&
                     micro->cells[0] * micro->cells[1] == 1 && LamCellFaces(micro, 0) == LAM_FACES);
  if (!*has || !micro->tissue) PetscFunctionReturn(0);
  PetscCall(LamMicrostructureSymmetry(micro, &symmetry));
  *has = LamSymmetryIsHexagonal(&symmetry);
  PetscFunctionReturn(0);
}

/* Solves all states, then those that do not float again at larger stretch. *left: number that never floated. */
static PetscErrorCode SolveStates(const LamFreeCell *cell, PetscReal z_min, LamResponder solver, PetscInt *left)
{
  const PetscInt n = LamFreeCellStates(cell);
  PetscInt *missing, *points;
  LamResponse *answers;
  LamLoad *loads;

  PetscFunctionBeginUser;
  *left = n;
  PetscCall(PetscMalloc4(n, &missing, n, &points, n, &answers, n, &loads));
  for (PetscInt j = 0; j < n; j++) missing[j] = j;
  for (PetscReal x = FIRST_STRAIN; *left > 0 && x < MAX_STRAIN; x += STRAIN_STEP) {
    const PetscInt asked = *left;

    for (PetscInt i = 0; i < asked; i++) {
      const PetscReal z = z_min + cell->z_step * (PetscReal)(missing[i] / cell->n);

      loads[i] = LoadOf(x, PetscExpReal(z), cell->suction[missing[i] % cell->n], cell->cohesion);
      points[i] = -1;
    }
    PetscCall(LamResponderRespond(solver, asked, loads, points, answers));
    *left = 0;
    for (PetscInt i = 0; i < asked; i++) {
      const PetscInt j = missing[i];

      if (Floats(&answers[i]))
        cell->records[j] = answers[i];
      else
        missing[(*left)++] = j;
    }
  }
  PetscCall(PetscFree4(missing, points, answers, loads));
  PetscFunctionReturn(0);
}

/* ---- knots ---- */

/* Knots lie at tau_j = first + j step. */
typedef struct {
  PetscReal first, step;
} Knots;

static Knots KnotsOf(const LamFreeCell *cell)
{
  const PetscReal first = log1p(cell->suction[0] / cell->scale), last = log1p(cell->suction[cell->n - 1] / cell->scale);

  return (Knots){first, (last - first) / (PetscReal)(cell->n - 1)};
}

static void PlaceKnots(PetscReal suction_min, PetscReal suction_max, LamFreeCell *cell)
{
  Knots knots;

  cell->suction[0] = suction_min;
  cell->suction[cell->n - 1] = suction_max;
  knots = KnotsOf(cell);
  for (PetscInt j = 1; j < cell->n - 1; j++)
    cell->suction[j] = cell->scale * expm1(knots.first + knots.step * (PetscReal)j);
}

/* Returns the knot left of s; t in [0, 1]: position of s between this knot and the next, in tau. */
static PetscInt Locate(const LamFreeCell *cell, PetscReal s, PetscReal *step, PetscReal *t)
{
  const Knots knots = KnotsOf(cell);
  const PetscReal place = (log1p(s / cell->scale) - knots.first) / knots.step;
  const PetscInt j = PetscMax(0, PetscMin(cell->n - 2, (PetscInt)place));

  *step = knots.step;
  *t = place - (PetscReal)j;
  return j;
}

/*
  Second derivatives m of the spline: m_{j-1} + 4 m_j + m_{j+1} = 6 d_j, d_j the second differences over step^2.
  Not-a-knot means m_0 - 2 m_1 + m_2 = 0, which makes m_1 = d_1, and so at the other end; the rest is tridiagonal.
*/
static PetscErrorCode FitSpline(PetscInt n, PetscReal step, const PetscReal a[], PetscReal m[])
{
  PetscReal *c;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &c));
  for (PetscInt j = 1; j < n - 1; j++) m[j] = (a[j - 1] - 2.0 * a[j] + a[j + 1]) / (step * step);
  if (n == 3) m[2] = m[1];               /* the parabola */
  for (PetscInt j = 2; j < n - 2; j++) { /* m[j] = (stored value) - c[j] m[j + 1], c[1] = 0 */
    const PetscReal pivot = 4.0 - c[j - 1];

    m[j] = (6.0 * m[j] - m[j - 1]) / pivot;
    c[j] = 1.0 / pivot;
  }
  for (PetscInt j = n - 3; j > 1; j--) m[j] -= c[j] * m[j + 1];
  m[0] = 2.0 * m[1] - m[2];
  m[n - 1] = 2.0 * m[n - 2] - m[n - 3];
  PetscCall(PetscFree(c));
  PetscFunctionReturn(0);
}

/* z2: second derivatives in z of the splines through the numbers of all planes at each knot. */
static PetscErrorCode FitPlanes(const LamFreeCell *cell, const PetscReal column[], PetscReal z2[])
{
  const PetscInt planes = cell->planes;
  PetscReal *a, *m;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(planes, &a, planes, &m));
  for (PetscInt j = 0; j < cell->n; j++) {
    for (PetscInt k = 0; k < planes; k++) a[k] = column[k * cell->n + j];
    PetscCall(FitSpline(planes, cell->z_step, a, m));
    for (PetscInt k = 0; k < planes; k++) z2[k * cell->n + j] = m[k];
  }
  PetscCall(PetscFree2(a, m));
  PetscFunctionReturn(0);
}

static PetscErrorCode FitAllPlanes(const LamFreeCell *cell)
{
  PetscFunctionBeginUser;
  if (cell->planes == 1) PetscFunctionReturn(0);
  PetscCall(FitPlanes(cell, cell->strain, cell->strain_z2));
  PetscCall(FitPlanes(cell, cell->strain_curvature, cell->curvature_z2));
  PetscFunctionReturn(0);
}

/*
  Phi = Psi - g J at fixed F: along the states g is fixed and dp = ds; at fixed s dg = -dp. d/dz = F33 d/dF33.
*/
static void Tabulate(LamFreeCell *cell)
{
  for (PetscInt j = 0; j < LamFreeCellStates(cell); j++) {
    const LamResponse *r = &cell->records[j];
    const PetscReal *F = r->load.F, J = F[0] * F[4] * F[8];

    cell->strain[j] = PetscLogReal(F[0] - 0.5 * r->min_gap);
    cell->energy[j] = r->energy - cell->cohesion * J;
    cell->slope[j] = r->energy_turgor;
    cell->curvature[j] = r->energy_turgor2;
    cell->turgor_slope[j] = r->energy_turgor - r->energy_cohesion + J;
    cell->turgor_curvature[j] = r->energy_turgor2 - 2.0 * r->energy_turgor_cohesion + r->energy_cohesion2;
    if (cell->planes == 1) continue;
    cell->axial[j] = F[8] * r->P[8] - cell->cohesion * J;
    cell->axial_curvature[j] = F[8] * F[8] * r->tangent[80] + cell->axial[j];
    cell->turgor_axial[j] = F[8] * (r->P_turgor[8] - r->P_cohesion[8]) + J;
  }
}

PetscErrorCode LamFreeCellMake(const LamMicrostructure *micro, PetscReal cohesion, PetscReal suction_min,
                               PetscReal suction_max, PetscReal scale, PetscInt n, const LamFreePlanes *planes,
                               LamResponder solver, LamFreeCell *cell)
{
  static const LamFreePlanes plane_strain = {.n = 1};
  PetscBool hexagon;
  PetscInt left;

  PetscFunctionBeginUser;
  if (!planes) planes = &plane_strain;
  PetscCheck(n >= MIN_KNOTS && (planes->n == 1 || planes->n > 2) && scale > 0 && suction_min >= 0 &&
                 suction_max > suction_min,
             PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%d knots of suction from %g to %g, scale %g", (int)n,
             (double)suction_min, (double)suction_max, (double)scale);
  memset(cell, 0, sizeof(*cell));
  PetscCall(HasOneHexagon(micro, &hexagon));
  if (!hexagon) PetscFunctionReturn(0);
  cell->planes = planes->n;
  cell->z_step = planes->z_step;
  PetscCall(Allocate(n, cell));
  PetscCall(PetscMalloc1(LamFreeCellStates(cell), &cell->records));
  cell->scale = scale;
  cell->cohesion = cohesion;
  PlaceKnots(suction_min, suction_max, cell);
  PetscCall(SolveStates(cell, planes->z_min, solver, &left));
  if (left > 0) {
    PetscCall(LamFreeCellDestroy(cell));
    PetscFunctionReturn(0);
  }
  Tabulate(cell);
  for (PetscInt k = 0; k < cell->planes; k++)
    PetscCall(FitSpline(n, KnotsOf(cell).step, cell->strain + k * n, cell->strain_curvature + k * n));
  PetscCall(FitAllPlanes(cell));
  PetscFunctionReturn(0);
}

/* ---- interpolation ---- */

void LamFreeCellStrain(const LamFreeCell *cell, PetscReal s, PetscReal strain[3])
{
  PetscReal h, t, first, second;
  const PetscInt j = Locate(cell, s, &h, &t);
  const PetscReal u = 1.0 - t, rate = 1.0 / (s + cell->scale); /* dtau/ds */
  const PetscReal *a = &cell->strain[j], *m = &cell->strain_curvature[j];

  strain[0] = u * a[0] + t * a[1] + h * h / 6.0 * ((u * u * u - u) * m[0] + (t * t * t - t) * m[1]);
  first = (a[1] - a[0]) / h + h / 6.0 * ((1.0 - 3.0 * u * u) * m[0] + (3.0 * t * t - 1.0) * m[1]);
  second = u * m[0] + t * m[1];
  strain[1] = first * rate;
  strain[2] = (second - first) * rate * rate;
}

/* Value and two derivatives of a cubic spline at t in [0, 1] of a step h; y, m: values and second derivatives. */
static void Spline(PetscReal h, PetscReal t, const PetscReal y[2], const PetscReal m[2], PetscReal value[3])
{
  const PetscReal u = 1.0 - t;

  value[0] = u * y[0] + t * y[1] + h * h / 6.0 * ((u * u * u - u) * m[0] + (t * t * t - t) * m[1]);
  value[1] = (y[1] - y[0]) / h + h / 6.0 * ((1.0 - 3.0 * u * u) * m[0] + (3.0 * t * t - 1.0) * m[1]);
  value[2] = u * m[0] + t * m[1];
}

void LamFreeCellStrains(const LamFreeCell *cell, PetscReal s, PetscReal w, PetscReal strain[6])
{
  const PetscInt n = cell->n, k = PetscMax(0, PetscMin(cell->planes - 2, (PetscInt)w));
  PetscReal h, t, at[2][3][2], a[3][3]; /* at: of a and its second derivative, [order in z][knot] */
  const PetscInt j = Locate(cell, s, &h, &t);
  const PetscReal rate = 1.0 / (s + cell->scale);

  for (int of = 0; of < 2; of++)
    for (int e = 0; e < 2; e++) {
      const PetscReal *y = of ? cell->strain_curvature : cell->strain, *m = of ? cell->curvature_z2 : cell->strain_z2;
      const PetscInt low = k * n + j + e;
      PetscReal value[3];

      Spline(cell->z_step, w - (PetscReal)k, (PetscReal[]){y[low], y[low + n]}, (PetscReal[]){m[low], m[low + n]},
             value);
      for (int d = 0; d < 3; d++) at[of][d][e] = value[d];
    }
  for (int d = 0; d < 3; d++) Spline(h, t, at[0][d], at[1][d], a[d]);
  strain[0] = a[0][0];
  strain[1] = a[0][1] * rate;
  strain[2] = (a[0][2] - a[0][1]) * rate * rate;
  strain[3] = a[1][0];
  strain[4] = a[2][0];
  strain[5] = a[1][1] * rate;
}

/* f[i][k]: k-th derivative in t of the quintic Hermite function of value, slope, curvature (i = 0, 1, 2) at t = 0. The
   functions of the end t = 1 are these at 1 - t, that of the slope with opposite sign. */
static void Quintic(PetscReal t, PetscReal f[3][3])
{
  const PetscReal t2 = t * t, t3 = t2 * t, t4 = t3 * t, t5 = t4 * t;

  f[0][0] = 1.0 - 10.0 * t3 + 15.0 * t4 - 6.0 * t5;
  f[0][1] = -30.0 * t2 + 60.0 * t3 - 30.0 * t4;
  f[0][2] = -60.0 * t + 180.0 * t2 - 120.0 * t3;
  f[1][0] = t - 6.0 * t3 + 8.0 * t4 - 3.0 * t5;
  f[1][1] = 1.0 - 18.0 * t2 + 32.0 * t3 - 15.0 * t4;
  f[1][2] = -36.0 * t + 96.0 * t2 - 60.0 * t3;
  f[2][0] = 0.5 * (t2 - 3.0 * t3 + 3.0 * t4 - t5);
  f[2][1] = t - 4.5 * t2 + 6.0 * t3 - 2.5 * t4;
  f[2][2] = 1.0 - 9.0 * t + 18.0 * t2 - 10.0 * t3;
}

/* Step times d/dtau of the values y at knot j, exact for polynomials of degree 4. */
static PetscReal Difference(PetscInt n, const PetscReal y[], PetscInt j)
{
  static const PetscReal weight[MIN_KNOTS][MIN_KNOTS] = {
      {-25, 48, -36, 16, -3}, {-3, -10, 18, -6, 1}, {1, -8, 0, 8, -1}, {-1, 6, -18, 10, 3}, {3, -16, 36, -48, 25}};
  const PetscInt from = PetscMax(0, PetscMin(n - MIN_KNOTS, j - 2));
  PetscReal sum = 0.0;

  for (PetscInt i = 0; i < MIN_KNOTS; i++) sum += weight[j - from][i] * y[from + i];
  return sum / 12.0;
}

static void Cubic(PetscInt n, const PetscReal y[], PetscInt j, PetscReal step, PetscReal t, PetscReal value[3])
{
  const PetscReal u = 1.0 - t, a = Difference(n, y, j), b = Difference(n, y, j + 1), rise = y[j + 1] - y[j];

  value[0] = y[j] + t * t * (1.0 + 2.0 * u) * rise + u * t * (u * a - t * b);
  value[1] = (6.0 * t * u * rise + u * (1.0 - 3.0 * t) * a + t * (3.0 * t - 2.0) * b) / step;
  value[2] = (6.0 * (1.0 - 2.0 * t) * rise + (6.0 * t - 4.0) * a + (6.0 * t - 2.0) * b) / (step * step);
}

void LamFreeCellEnergy(const LamFreeCell *cell, PetscInt plane, PetscReal s, PetscReal energy[3],
                       PetscReal turgor[2][3])
{
  const PetscInt first = plane * cell->n;
  PetscReal step, tau, left[3][3], right[3][3], power = 1.0;
  const PetscInt j = Locate(cell, s, &step, &tau);
  const PetscReal h = cell->suction[j + 1] - cell->suction[j], t = (s - cell->suction[j]) / h;
  const PetscReal *y = &cell->energy[first + j], *d = &cell->slope[first + j], *c = &cell->curvature[first + j];

  Quintic(t, left);
  Quintic(1.0 - t, right);
  for (PetscInt k = 0; k < 3; k++, power /= h) {
    const PetscReal sign = k == 1 ? -1.0 : 1.0; /* of d/dt at 1 - t */

    energy[k] = power * (left[0][k] * y[0] + h * left[1][k] * d[0] + h * h * left[2][k] * c[0] +
                         sign * (right[0][k] * y[1] - h * right[1][k] * d[1] + h * h * right[2][k] * c[1]));
  }
  Cubic(cell->n, cell->turgor_slope + first, j, step, tau, turgor[0]);
  Cubic(cell->n, cell->turgor_curvature + first, j, step, tau, turgor[1]);
}

void LamFreeCellAxial(const LamFreeCell *cell, PetscInt plane, PetscReal s, PetscReal axial[3][3])
{
  const PetscInt first = plane * cell->n;
  PetscReal step, tau;
  const PetscInt j = Locate(cell, s, &step, &tau);

  Cubic(cell->n, cell->axial + first, j, step, tau, axial[0]);
  Cubic(cell->n, cell->axial_curvature + first, j, step, tau, axial[1]);
  Cubic(cell->n, cell->turgor_axial + first, j, step, tau, axial[2]);
}

/* ---- JSON ---- */

PetscErrorCode LamFreeCellToJSON(const LamFreeCell *cell, json_t **object)
{
  LamFreeCell borrowed = *cell;

  PetscFunctionBeginUser;
  *object = json_pack("{s:f, s:f}", "scale", cell->scale, "cohesion", cell->cohesion);
  PetscCheck(*object, PETSC_COMM_SELF, PETSC_ERR_MEM, "no JSON of a free cell: no memory, or not finite");
  if (cell->planes > 1)
    json_object_update_new(*object,
                           json_pack("{s:I, s:f}", "planes", (json_int_t)cell->planes, "z_step", cell->z_step));
  for (PetscInt k = 0; k < ColumnCount(cell, JSON_COLUMNS); k++)
    json_object_set_new(*object, columns[k].name, LamJSONReals(ColumnLength(cell, k), *ColumnOf(&borrowed, k), 1));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadColumn(const char path[], const json_t *object, PetscInt k, LamFreeCell *cell)
{
  const json_t *list = json_object_get(object, columns[k].name);
  PetscReal *values = *ColumnOf(cell, k);
  const PetscInt n = ColumnLength(cell, k);
  PetscBool good = (PetscBool)(json_is_array(list) && (PetscInt)json_array_size(list) == n);

  PetscFunctionBeginUser;
  for (PetscInt j = 0; good && j < n; j++) {
    good = (PetscBool)json_is_number(json_array_get(list, (size_t)j));
    values[j] = json_number_value(json_array_get(list, (size_t)j));
  }
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: \"%s\" of the free cell is no list of %d numbers; the file is damaged", path, columns[k].name,
             (int)n);
  PetscFunctionReturn(0);
}

/* Checks that the knots are evenly spaced in tau, as Locate assumes. */
static PetscErrorCode CheckKnots(const char path[], const LamFreeCell *cell)
{
  Knots knots;

  PetscFunctionBeginUser;
  PetscCheck(cell->scale > 0 && cell->suction[0] >= 0 && cell->suction[cell->n - 1] > cell->suction[0], PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "%s: suction of the free cell from %g to %g, scale %g; the file is damaged", path,
             (double)cell->suction[0], (double)cell->suction[cell->n - 1], (double)cell->scale);
  knots = KnotsOf(cell);
  for (PetscInt j = 0; j < cell->n; j++) {
    const PetscReal place = (log1p(cell->suction[j] / cell->scale) - knots.first) / knots.step;

    PetscCheck(PetscAbsReal(place - (PetscReal)j) < 1e-6, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: suction %g of the free cell is not the knot %d; the file is damaged", path,
               (double)cell->suction[j], (int)j);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadPlanes(const char path[], json_t *object, LamFreeCell *cell)
{
  json_int_t planes = 1;

  PetscFunctionBeginUser;
  PetscCheck(!json_unpack(object, "{s?I, s?F}", "planes", &planes, "z_step", &cell->z_step) &&
                 (planes == 1 || (planes > 2 && planes <= MAX_PLANES && cell->z_step > 0)),
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: \"planes\" or \"z_step\" of the free cell is not of a grid; the file is damaged", path);
  cell->planes = (PetscInt)planes;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFreeCellFromJSON(const char path[], json_t *object, LamFreeCell *cell)
{
  const PetscInt n = (PetscInt)json_array_size(json_object_get(object, columns[0].name));

  PetscFunctionBeginUser;
  memset(cell, 0, sizeof(*cell));
  PetscCheck(!json_unpack(object, "{s:F, s:F}", "scale", &cell->scale, "cohesion", &cell->cohesion) &&
                 (n == 0 || n >= MIN_KNOTS),
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the free cell has no numbers \"scale\" and \"cohesion\", or %d knots, less than %d; the file is "
             "damaged",
             path, (int)n, MIN_KNOTS);
  PetscCall(ReadPlanes(path, object, cell));
  PetscCall(Allocate(n, cell));
  for (PetscInt k = 0; k < ColumnCount(cell, JSON_COLUMNS); k++) PetscCall(ReadColumn(path, object, k, cell));
  if (n > 0) PetscCall(CheckKnots(path, cell));
  if (n > 0) PetscCall(FitAllPlanes(cell));
  PetscFunctionReturn(0);
}
