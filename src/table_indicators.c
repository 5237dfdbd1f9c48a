/*
  What the potential does not give: the stress across the plane, and indicators.

  P33 + p J (contact: P33 - g J) is interpolated from its value and gradient at the corners of the finest complete cell.
  Indicators are means of the corners, with the weights of linear interpolation, so that they keep their bounds: a share
  stays between 0 and 1. Faces are renamed as the corner's axes lie. Counts are given where all corners agree.
*/
#include "table.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

/* A state around the point and its part in the answer. */
typedef struct {
  const LamNodeData *data;
  const int *order;       /* axis k of the point is axis order[k] of the node */
  PetscReal weight, side; /* side: factor of `weight` along suction */
  int corner, end;
} Around;

typedef struct {
  Around at[16];
  int n;
  PetscReal tau_step[8]; /* of the corner's interval */
} Surroundings;

static void AddAround(Surroundings *around, const LamNodeData *data, const int *order, PetscReal weight, PetscReal side,
                      int corner, int end)
{
  around->at[around->n++] = (Around){data, order, weight * side, side, corner, end};
}

/* The two knots of the free cell around the point; PETSC_FALSE where the file lacks one of them. */
static PetscBool AddFree(LamTable table, const LamTablePoint *point, PetscReal weight, int corner, Surroundings *around)
{
  const struct LamGrid_s *grid = table->grid;
  const PetscReal share = point->v / (LAM_ROOT * grid->tau_cells) * (PetscReal)(grid->free.n - 1);
  const PetscInt m = PetscMin((PetscInt)share, grid->free.n - 2);

  around->tau_step[corner] = grid->tau_step * (PetscReal)grid->tau_cells / (PetscReal)(grid->free.n - 1);
  for (PetscInt e = 0; e < 2; e++) {
    const PetscInt d = table->free_data[m + e];
    const PetscReal t = share - (PetscReal)m;

    if (d < 0) return PETSC_FALSE;
    AddAround(around, &table->database->nodes[d], LamAxisOrder[0], weight, e ? t : 1 - t, corner, (int)e);
  }
  return PETSC_TRUE;
}

static void AddNode(LamTable table, const LamTableCell *cell, int corner, const LamTablePoint *point, PetscReal weight,
                    Surroundings *around)
{
  const LamTableNode *node = &table->nodes[cell->node[corner]];
  const int *order = LamAxisOrder[cell->order[corner]];
  const LamTableState *ends[2];
  PetscReal t;

  LamTableBracket(table, node, point, ends);
  if (!table->grid->contact) {
    AddAround(around, &table->database->nodes[ends[0]->data], order, weight, 1, corner, 0);
    return;
  }
  t = (point->v - ends[0]->j) / (ends[1]->j - ends[0]->j);
  around->tau_step[corner] = table->grid->tau_step * (ends[1]->j - ends[0]->j) / LAM_ROOT;
  for (int e = 0; e < 2; e++)
    AddAround(around, &table->database->nodes[ends[e]->data], order, weight, e ? t : 1 - t, corner, e);
}

/* The corners of the cell; without one, cells that touch no one. */
static PetscBool Surround(LamTable table, const LamTableCell *cell, const LamTablePoint *point, Surroundings *around)
{
  around->n = 0;
  if (!cell) return AddFree(table, point, 1, 0, around);
  for (int c = 0; c < 8; c++) {
    PetscReal weight = 1;

    for (int k = 0; k < 3; k++) {
      const PetscReal t = (point->u[k] - cell->i[k]) / (LAM_ROOT >> cell->level);

      weight *= c >> k & 1 ? t : 1 - t;
    }
    if (cell->node[c] == LAM_NODE_FLOATING) {
      if (!AddFree(table, point, weight, c, around)) return PETSC_FALSE;
    } else
      AddNode(table, cell, c, point, weight, around);
  }
  return PETSC_TRUE;
}

/* ---- across the plane ---- */

/* P33 of the walls, its gradient in x and its slope along the states of the grid at fixed grid coordinates. */
static PetscReal WallThickness(LamTable table, const LamNodeData *r, const PetscReal a[3], PetscReal gradient[3],
                               PetscReal *slope)
{
  const struct LamGrid_s *grid = table->grid;
  const PetscReal factor = grid->contact ? -r->cohesion : r->turgor;
  const LamLatticeState state = LamLatticeStateOf(&grid->axes, r->F);
  PetscReal J, J_x[3], J_xx[6], dF[3][4];

  J = LamLatticeVolume(&grid->axes, &state, J_x, J_xx);
  LamLatticeVariations(&grid->axes, &state, r->F, dF);
  *slope = r->P33_turgor;
  for (int k = 0; k < 3; k++) {
    gradient[k] = factor * J_x[k];
    for (int i = 0; i < 4; i++) gradient[k] += r->P33_F[i] * dF[k][i];
    *slope += a[1] * gradient[k];
  }
  return r->P33 + factor * J;
}

/* A corner at the point's suction: cubic along tau in the value, linear in the gradient. */
static void AddThickness(LamTable table, const Around *around, PetscReal tau_step, const LamTablePoint *point,
                         PetscBool is_free, LamJet *jet)
{
  const struct LamGrid_s *grid = table->grid;
  const PetscReal r = around->side, t = 1 - r;
  PetscReal gradient[3], slope, value, strain[3] = {0};

  if (grid->contact && grid->free.n && !is_free)
    LamFreeCellStrain(&grid->free, around->data->turgor + around->data->cohesion, strain);
  value = WallThickness(table, around->data, strain, gradient, &slope);
  if (!grid->contact) {
    jet->value = value;
  } else {
    slope *= around->data->turgor + around->data->cohesion + grid->suction_scale;
    jet->value += r * r * (1 + 2 * t) * value + (around->end ? -1 : 1) * tau_step * r * r * t * slope;
  }
  for (int k = 0; k < 3 && !is_free; k++) jet->gradient[k] += r * gradient[around->order[k]];
}

/* P33 and its row and column of the tangent, and its derivatives with respect to turgor and cohesion. */
void LamTableThickness(LamTable table, const LamTablePoint *point, const LamTableCell *cell,
                       const LamLatticeState *lattice, LamResponse *r)
{
  const struct LamGrid_s *grid = table->grid;
  const PetscReal d = grid->contact ? grid->cohesion - r->load.cohesion : r->load.turgor - grid->turgor;
  const PetscReal factor = grid->contact ? r->load.cohesion : -r->load.turgor;
  PetscReal t[3], value, gradient[3] = {0}, g[3], J, J_x[3], J_xx[6], row[4], turgor = 0, cohesion = 0, stiffness = 0;
  LamJet corner[8] = {0};
  Surroundings around;

  if (!Surround(table, cell, point, &around)) return;
  J = LamLatticeVolume(&grid->axes, lattice, J_x, J_xx);
  for (int n = 0; n < around.n; n++) {
    const Around *a = &around.at[n];
    const PetscReal J_node = a->data->F[0] * a->data->F[3] - a->data->F[1] * a->data->F[2];

    AddThickness(table, a, around.tau_step[a->corner], point,
                 (PetscBool)(!cell || cell->node[a->corner] == LAM_NODE_FLOATING), &corner[a->corner]);
    turgor += a->weight * (a->data->P33_turgor + (grid->contact ? 0 : J_node));
    if (grid->contact) cohesion += a->weight * (a->data->P33_cohesion - J_node);
    stiffness += a->weight * a->data->P33_F33;
  }
  value = corner[0].value;
  if (cell) {
    for (int k = 0; k < 3; k++) t[k] = (point->u[k] - cell->i[k]) / (LAM_ROOT >> cell->level);
    LamHermiteEdges(corner, grid->step / (1 << cell->level), t, &value, gradient);
  }
  /* contact: P33' depends on g at fixed s through dP33'/dp - dP33'/dg, as the potential does */
  r->P[8] = value + factor * J + d * (turgor - cohesion);
  r->P_turgor[8] = turgor - (grid->contact ? 0 : J);
  r->P_cohesion[8] = grid->contact ? cohesion + J : 0;
  for (int k = 0; k < 3; k++) g[point->axis[k]] = gradient[k];
  for (int k = 0; k < 3; k++) g[k] += factor * J_x[k];
  LamLatticeStress(&grid->axes, lattice, g, row);
  for (int i = 0; i < 4; i++) {
    const int at = 3 * (i / 2) + i % 2;

    r->tangent[72 + at] = r->tangent[9 * at + 8] = row[i];
  }
  r->tangent[80] = stiffness;
}

/* ---- indicators ---- */

#define ONE(name) {offsetof(LamResponse, name), offsetof(LamNodeData, name), 1},
#define THREE(name) {offsetof(LamResponse, name), offsetof(LamNodeData, name), 3},
/* Those that are a mean of the corners; places, and tensors in the frame of the cell, are not. */
static const struct {
  size_t response, node;
  int count; /* 3: per face family */
} means[] = {ONE(lumen_fraction) ONE(opening_fraction) THREE(opening_by_face) ONE(debonded_fraction)
                 THREE(debonded_by_face) ONE(open_fraction) THREE(open_by_face) ONE(debonded_spread) ONE(open_spread)
                     ONE(max_gap) ONE(min_gap) ONE(mean_gap) ONE(max_penetration) ONE(max_traction)
                         ONE(max_lamella_shear) THREE(mean_face_traction) ONE(max_fibre_stretch) ONE(max_wall_energy)
                             ONE(max_wall_tension) THREE(mean_wall_tension)};
#undef ONE
#undef THREE

/* Number of a node, the k-th of three in the point's axes. */
static PetscReal Number(const Around *around, size_t offset, int count, int k)
{
  return ((const float *)((const char *)around->data + offset))[count == 3 ? around->order[k] : 0];
}

static PetscReal Mean(const Surroundings *around, size_t offset, int count, int k)
{
  PetscReal sum = 0;

  for (int n = 0; n < around->n; n++)
    if (around->at[n].weight) sum += around->at[n].weight * Number(&around->at[n], offset, count, k);
  return sum;
}

/* Weighted standard deviation of the corners: 0 at a node. */
static PetscReal Spread(const Surroundings *around, size_t offset)
{
  const PetscReal mean = Mean(around, offset, 1, 0);
  PetscReal sum = 0;

  for (int n = 0; n < around->n; n++)
    if (around->at[n].weight) sum += around->at[n].weight * PetscSqr(Number(&around->at[n], offset, 1, 0) - mean);
  return sqrt(sum);
}

static PetscInt Agreed(const Surroundings *around, size_t offset)
{
  PetscInt agreed = LAM_UNKNOWN_COUNT;

  for (int n = 0; n < around->n; n++) {
    const PetscInt count = *(const PetscInt *)((const char *)around->at[n].data + offset);

    if (!around->at[n].weight) continue;
    if (agreed != LAM_UNKNOWN_COUNT && count != agreed) return LAM_UNKNOWN_COUNT;
    agreed = count;
  }
  return agreed;
}

#define TRUSTED_SHARE 0.1  /* spread of a share of the interface */
#define TRUSTED_STRESS 0.1 /* spread of a stress, relative */
#define STRESS_FLOOR 0.0227

static PetscBool IsTrusted(const Surroundings *around)
{
  static const size_t shares[] = {offsetof(LamNodeData, debonded_fraction), offsetof(LamNodeData, open_fraction)};
  static const size_t stresses[] = {offsetof(LamNodeData, max_wall_tension), offsetof(LamNodeData, max_traction)};

  for (int i = 0; i < 2; i++) {
    const PetscReal stress = Mean(around, stresses[i], 1, 0);

    if (Spread(around, shares[i]) > TRUSTED_SHARE) return PETSC_FALSE;
    if (Spread(around, stresses[i]) > TRUSTED_STRESS * (fabs(stress) + STRESS_FLOOR)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Derivatives of Psi are volumes where all cells have the same turgor and cohesion. */
static void FillVolumes(LamTable table, LamResponse *r)
{
  if (table->database->header.micro.cell) return;
  r->lumen_fraction = -r->energy_turgor;
  r->opening_fraction = PetscMax(r->energy_cohesion, 0);
}

void LamTableIndicators(LamTable table, const LamTablePoint *point, const LamTableCell *cell, LamResponse *r)
{
  Surroundings around;

  if (!Surround(table, cell, point, &around)) {
    r->indicators_trusted = PETSC_FALSE;
    return;
  }
  for (size_t i = 0; i < sizeof(means) / sizeof(means[0]); i++) {
    PetscReal *to = (PetscReal *)((char *)r + means[i].response);

    for (int k = 0; k < means[i].count; k++)
      to[means[i].count == 3 ? point->axis[k] : 0] = Mean(&around, means[i].node, means[i].count, k);
  }
  r->floating_cells = Agreed(&around, offsetof(LamNodeData, floating_cells));
  r->zero_modes = Agreed(&around, offsetof(LamNodeData, zero_modes));
  r->cell_clusters = Agreed(&around, offsetof(LamNodeData, cell_clusters));
  r->percolating_directions = Agreed(&around, offsetof(LamNodeData, percolating_directions));
  r->stable = PETSC_TRUE;
  r->indicators_trusted = IsTrusted(&around);
  FillVolumes(table, r);
}
