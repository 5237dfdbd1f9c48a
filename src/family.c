#include <lamella/family.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_KNOTS = 4 };
#define SAME 1e-9 /* relative */

const char *const LamFamilyAxisNames[] = {LAM_FAMILY_AXES(LAM_NAME_ENTRY) NULL};

typedef struct {
  LamDatabase database; /* borrowed */
  PetscReal value;
} Knot;

struct LamFamily_s {
  LamFamilyAxis axis;
  PetscInt n;
  Knot *knots; /* ascending */
};

/* ---- the axis ---- */

static PetscReal AxisValue(const LamMicrostructure *micro, LamFamilyAxis axis)
{
  switch (axis) {
  case LAM_FAMILY_WALL_THICKNESS:
    return micro->wall_thickness;
  case LAM_FAMILY_FIBRES:
    return micro->wall.C4 / micro->wall.C1;
  default:
    return micro->wall.C2 / micro->wall.C1;
  }
}

static PetscBool Same(PetscReal a, PetscReal b)
{
  return (PetscBool)(fabs(a - b) <= SAME * (fabs(a) + fabs(b)));
}

/* All that no axis stands for. Fibres count in C1 + C2, so that C2/C1 may vary alone. */
static PetscBool SameOtherwise(const LamMicrostructure *a, const LamMicrostructure *b)
{
  return (PetscBool)(!a->cell && !b->cell && a->is_patch == b->is_patch && a->cells[0] == b->cells[0] &&
                     a->cells[1] == b->cells[1] && a->interface == b->interface && a->wall.law == b->wall.law &&
                     a->wall.fibres == b->wall.fibres && Same(a->wall.bulk_modulus, b->wall.bulk_modulus) &&
                     Same(a->clearance, b->clearance) && Same(1 + a->orientation, 1 + b->orientation));
}

static PetscErrorCode FindAxis(PetscInt n, const LamDatabase databases[], LamFamilyAxis *axis)
{
  LamMicrostructure first, other;
  PetscBool differs[LAM_FAMILY_AXIS_COUNT] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  int count = 0;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetMicrostructure(databases[0], &first, NULL, NULL));
  for (PetscInt i = 1; i < n; i++) {
    PetscCall(LamDatabaseGetMicrostructure(databases[i], &other, NULL, NULL));
    PetscCheck(SameOtherwise(&first, &other), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "database %d is of other tissue than the first; they may differ in t/a, C4/C1 or C2/C1 alone (moduli in "
               "units of C1 + C2)",
               (int)i + 1);
    differs[LAM_FAMILY_WALL_THICKNESS] |= !Same(first.wall_thickness, other.wall_thickness);
    differs[LAM_FAMILY_MATRIX] |= !Same(first.wall.C1, other.wall.C1);
    differs[LAM_FAMILY_FIBRES] |= !Same(first.wall.C4, other.wall.C4);
  }
  for (int k = 0; k < LAM_FAMILY_AXIS_COUNT; k++) {
    if (differs[k]) *axis = (LamFamilyAxis)k;
    count += differs[k];
  }
  PetscCheck(count == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "the databases differ in %d of t/a, C4/(C1 + C2) and C2/C1; one is wanted", count);
  PetscFunctionReturn(0);
}

static int CompareKnots(const void *first, const void *second)
{
  const PetscReal a = ((const Knot *)first)->value, b = ((const Knot *)second)->value;

  return (a > b) - (a < b);
}

PetscErrorCode LamFamilyCreate(PetscInt n, const LamDatabase databases[], LamFamily *family)
{
  LamFamilyAxis axis = LAM_FAMILY_WALL_THICKNESS;
  LamFamily f;

  PetscFunctionBeginUser;
  PetscCheck(n >= 2, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "a family needs at least two databases");
  PetscCall(FindAxis(n, databases, &axis));
  PetscCall(PetscNew(&f));
  *family = f;
  f->axis = axis;
  f->n = n;
  PetscCall(PetscMalloc1(n, &f->knots));
  for (PetscInt i = 0; i < n; i++) {
    LamMicrostructure micro;

    PetscCall(LamDatabaseGetMicrostructure(databases[i], &micro, NULL, NULL));
    f->knots[i] = (Knot){databases[i], AxisValue(&micro, axis)};
  }
  qsort(f->knots, (size_t)n, sizeof(Knot), CompareKnots);
  for (PetscInt i = 1; i < n; i++)
    PetscCheck(!Same(f->knots[i - 1].value, f->knots[i].value), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "two of the databases have %s = %g", LamFamilyAxisNames[axis], (double)f->knots[i].value);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFamilyDestroy(LamFamily *family)
{
  PetscFunctionBeginUser;
  if (!*family) PetscFunctionReturn(0);
  PetscCall(PetscFree((*family)->knots));
  PetscCall(PetscFree(*family));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFamilyGetAxis(LamFamily family, LamFamilyAxis *axis, PetscReal *least, PetscReal *most)
{
  PetscFunctionBeginUser;
  *axis = family->axis;
  *least = family->knots[0].value;
  *most = family->knots[family->n - 1].value;
  PetscFunctionReturn(0);
}

/* ---- weights ---- */

/* Of the polynomial in ln v through n knots; knots of value 0 (no fibres, no C2) are on a linear axis. */
static PetscReal Position(PetscReal value, PetscBool is_log)
{
  return is_log ? log(value) : value;
}

static void Weights(const Knot knots[], PetscInt n, PetscReal value, PetscInt without, PetscReal w[])
{
  const PetscBool is_log = (PetscBool)(knots[0].value > 0);
  const PetscReal x = Position(value, is_log);

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal at = Position(knots[i].value, is_log);

    w[i] = i != without;
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal other = Position(knots[k].value, is_log);

      if (k != i && k != without) w[i] *= (x - other) / (at - other);
    }
  }
}

/* The knots around a value: *first of them, and how many. */
static void Nearest(LamFamily f, PetscReal value, PetscInt *first, PetscInt *count)
{
  PetscInt above = 1;

  while (above < f->n - 1 && f->knots[above].value < value) above++;
  *count = PetscMin(f->n, MOST_KNOTS);
  *first = PetscMin(PetscMax(above - *count / 2, 0), f->n - *count);
}

/* ---- answers ---- */

/* All numbers that are linear in the potential; 33 ones are interpolated likewise. */
static void AddPotential(PetscReal w, const LamResponse *r, LamResponse *sum)
{
  sum->energy += w * r->energy;
  sum->energy_turgor += w * r->energy_turgor;
  sum->energy_turgor2 += w * r->energy_turgor2;
  sum->energy_cohesion += w * r->energy_cohesion;
  sum->energy_cohesion2 += w * r->energy_cohesion2;
  sum->energy_turgor_cohesion += w * r->energy_turgor_cohesion;
  for (int i = 0; i < 9; i++) {
    sum->P[i] += w * r->P[i];
    sum->P_turgor[i] += w * r->P_turgor[i];
    sum->P_cohesion[i] += w * r->P_cohesion[i];
  }
  for (int i = 0; i < 81; i++) sum->tangent[i] += w * r->tangent[i];
}

/* Starts from zero where AddPotential adds. */
static void ClearPotential(LamResponse *r)
{
  r->energy = r->energy_turgor = r->energy_turgor2 = 0;
  r->energy_cohesion = r->energy_cohesion2 = r->energy_turgor_cohesion = 0;
  for (int i = 0; i < 9; i++) r->P[i] = r->P_turgor[i] = r->P_cohesion[i] = 0;
  for (int i = 0; i < 81; i++) r->tangent[i] = 0;
}

/* Indicators between two answers, t of the way from the first; counts where both agree. */
static void MixIndicators(const LamResponse *a, const LamResponse *b, PetscReal t, LamResponse *r)
{
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const PetscReal *from = (const PetscReal *)((const char *)a + m->offset);
    const PetscReal *to = (const PetscReal *)((const char *)b + m->offset);
    PetscReal *mixed = (PetscReal *)((char *)r + m->offset);

    if (m->type != LAM_MEMBER_REAL || m->offset < offsetof(LamResponse, lumen_fraction) ||
        m->offset > offsetof(LamResponse, mean_wall_tension))
      continue;
    for (PetscInt i = 0; i < m->count; i++) mixed[i] = (1 - t) * from[i] + t * to[i];
  }
  if (a->floating_cells == b->floating_cells) r->floating_cells = a->floating_cells;
  if (a->zero_modes == b->zero_modes) r->zero_modes = a->zero_modes;
  if (a->cell_clusters == b->cell_clusters) r->cell_clusters = a->cell_clusters;
  if (a->percolating_directions == b->percolating_directions) r->percolating_directions = a->percolating_directions;
  r->stable = PETSC_TRUE;
  r->indicators_trusted = (PetscBool)(a->indicators_trusted && b->indicators_trusted);
  /* volumes are derivatives of the potential where they are so at the knots */
  if (a->lumen_fraction == -a->energy_turgor) r->lumen_fraction = -r->energy_turgor;
  r->opening_fraction = PetscMax(r->energy_cohesion, 0);
}

/* P without the knot farthest away; between two knots, a quarter of the way from one to the other. */
static PetscReal AxisError(const Knot knots[], PetscInt n, PetscReal value, const LamResponse at[],
                           const LamResponse *r)
{
  const PetscReal low = fabs(log1p(value) - log1p(knots[0].value));
  const PetscReal high = fabs(log1p(value) - log1p(knots[n - 1].value));
  PetscReal w[MOST_KNOTS], P[9] = {0};

  if (n == 2) return 0.25 * LamStressError(at[0].P, at[1].P);
  Weights(knots, n, value, low > high ? 0 : n - 1, w);
  for (PetscInt i = 0; i < n; i++)
    for (int k = 0; k < 9; k++) P[k] += w[i] * at[i].P[k];
  return LamStressError(P, r->P);
}

static PetscErrorCode Combine(LamFamily f, PetscReal value, PetscInt first, PetscInt n, const LamResponse at[],
                              LamResponse *r)
{
  const Knot *knots = &f->knots[first];
  PetscReal w[MOST_KNOTS], estimate = 0;
  PetscInt above = 1;

  PetscFunctionBeginUser;
  Weights(knots, n, value, -1, w);
  ClearPotential(r);
  for (PetscInt i = 0; i < n; i++) {
    AddPotential(w[i], &at[i], r);
    estimate += fabs(w[i]) * at[i].error_estimate;
  }
  while (above < n - 1 && knots[above].value < value) above++;
  MixIndicators(&at[above - 1], &at[above],
                (value - knots[above - 1].value) / (knots[above].value - knots[above - 1].value), r);
  r->error_estimate = estimate + AxisError(knots, n, value, at, r);
  r->status = LAM_CONVERGED;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFamilyQuery(LamFamily f, PetscReal value, const LamLoad *load, PetscReal accuracy,
                              LamResponse *response)
{
  LamResponse at[MOST_KNOTS];
  PetscInt first, n;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  response->status = LAM_OUT_OF_REACH;
  if (!(value >= f->knots[0].value * (1 - SAME) && value <= f->knots[f->n - 1].value * (1 + SAME))) {
    snprintf(response->reason, sizeof(response->reason), "%s = %g is outside the databases, %g to %g",
             LamFamilyAxisNames[f->axis], (double)value, (double)f->knots[0].value, (double)f->knots[f->n - 1].value);
    PetscFunctionReturn(0);
  }
  Nearest(f, value, &first, &n);
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(LamDatabaseQuery(f->knots[first + i].database, load, accuracy, &at[i]));
    if (at[i].status == LAM_CONVERGED) continue;
    response->status = at[i].status;
    snprintf(response->reason, sizeof(response->reason), "at %s = %g: %.150s", LamFamilyAxisNames[f->axis],
             (double)f->knots[first + i].value, at[i].reason);
    PetscFunctionReturn(0);
  }
  PetscCall(Combine(f, value, first, n, at, response));
  if (response->error_estimate > accuracy) {
    response->status = LAM_OUT_OF_REACH;
    snprintf(response->reason, sizeof(response->reason),
             "the estimated error between the databases is %.2g %%, %.2g %% is asked; one more database between them "
             "helps",
             100 * response->error_estimate, 100 * accuracy);
  }
  PetscFunctionReturn(0);
}
