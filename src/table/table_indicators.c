/*
  Quantities that do not follow from the potential: indicators, and without the axis F33 the out-of-plane stress.

  P33 + p J (contact: P33 - g J) is interpolated from its value and gradient at the corners of the finest complete cell.
  Indicators are interpolated linearly between the corners, so that they keep their bounds: a share stays between 0 and
  1. Stresses among them are interpolated relative to the walls' stress, which follows from the potential. Faces are
  permuted as the corner's axes. Counts are set where all corners agree.
*/
#include "table.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

/* A state around the point and its weight in the response. */
typedef struct {
  const LamNodeData *data;
  const int *order;       /* axis k of the point is axis order[k] of the node */
  PetscReal weight, side; /* side: factor of `weight` along suction */
  int corner, end;
  PetscReal F33;
} Around;

enum { MOST_AROUND = 32 }; /* corners, two ends of suction, two of F33 */

typedef struct {
  Around at[MOST_AROUND];
  int n;
  PetscReal tau_step[8]; /* of the corner's interval */
} Surroundings;

static void AddAround(Surroundings *around, const LamNodeData *data, const int *order, PetscReal weight, PetscReal side,
                      int corner, int end, PetscReal F33)
{
  around->at[around->n++] = (Around){data, order, weight * side, side, corner, end, F33};
}

/* A line of the corner's states: its F33 and its weight, linear along ln F33. */
typedef struct {
  int number;
  PetscReal F33, weight;
} Line;

static Line LineOf(LamTable table, const LamTablePoint *point, int number)
{
  const PetscReal t = point->w - (point->z - 1);

  if (!table->grid->z_cells) return (Line){0, 1, 1};
  return (Line){number, LamGridF33(table->grid, point->z + number), number ? t : 1 - t};
}

/* Adds the two knots of the free cell around the point; PETSC_FALSE if the file lacks one of them. */
static PetscBool AddFree(LamTable table, const LamTablePoint *point, Line line, PetscReal weight, int corner,
                         Surroundings *around)
{
  const struct LamGrid_s *grid = table->grid;
  const PetscInt first = LamTablePlane(point, line.number) * grid->free.n;
  const PetscReal share = point->v / (LAM_ROOT * grid->tau_cells) * (PetscReal)(grid->free.n - 1);
  const PetscInt m = PetscMin((PetscInt)share, grid->free.n - 2);

  around->tau_step[corner] = grid->tau_step * (PetscReal)grid->tau_cells / (PetscReal)(grid->free.n - 1);
  for (PetscInt e = 0; e < 2; e++) {
    const PetscInt d = table->free_data[first + m + e];
    const PetscReal t = share - (PetscReal)m;

    if (d < 0) return PETSC_FALSE;
    AddAround(around, &table->source->data[d], LamAxisOrder[0], line.weight * weight, e ? t : 1 - t, corner, (int)e,
              line.F33);
  }
  return PETSC_TRUE;
}

static void AddNode(LamTable table, const LamTableCell *cell, int corner, const LamTablePoint *point, Line line,
                    PetscReal weight, Surroundings *around)
{
  const LamTableNode *node = &table->nodes[cell->node[corner]];
  const int *order = LamAxisOrder[cell->order[corner]];
  const LamTableState *ends[2];
  PetscReal t;

  LamTableBracket(table, node, point, line.number, ends);
  weight *= line.weight;
  if (!LamGridHasColumns(table->grid)) {
    AddAround(around, &table->source->data[ends[0]->data], order, weight, 1, corner, 0, line.F33);
    return;
  }
  t = ends[0] && ends[1] ? (point->v - ends[0]->j) / (ends[1]->j - ends[0]->j) : !ends[0];
  around->tau_step[corner] = ends[0] && ends[1] ? table->grid->tau_step * (ends[1]->j - ends[0]->j) / LAM_ROOT : 0;
  for (int e = 0; e < 2; e++)
    if (ends[e])
      AddAround(around, &table->source->data[ends[e]->data], order, weight, e ? t : 1 - t, corner, e, line.F33);
}

/* Adds those of a line at the corners of the cell; cell NULL: floating cells. */
static PetscBool AddLine(LamTable table, const LamTableCell *cell, const LamTablePoint *point, Line line,
                         Surroundings *around)
{
  if (!cell) return AddFree(table, point, line, 1, 0, around);
  for (int c = 0; c < 8; c++) {
    PetscReal weight = 1;

    for (int k = 0; k < 3; k++) {
      const PetscReal t = (point->u[k] - cell->i[k]) / (LAM_ROOT >> cell->level);

      weight *= c >> k & 1 ? t : 1 - t;
    }
    if (cell->node[c] == LAM_NODE_FLOATING) {
      if (!AddFree(table, point, line, weight, c, around)) return PETSC_FALSE;
    } else
      AddNode(table, cell, c, point, line, weight, around);
  }
  return PETSC_TRUE;
}

static PetscBool Surround(LamTable table, const LamTableCell *cell, const LamTablePoint *point, Surroundings *around)
{
  around->n = 0;
  for (int number = 0; number < LamTableLines(table); number++)
    if (!AddLine(table, cell, point, LineOf(table, point, number), around)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* ---- out-of-plane stress ---- */

/* P33 of the walls, its gradient in x, and its slope in suction at fixed grid coordinates. */
static PetscReal WallThickness(LamTable table, const LamNodeData *r, const PetscReal a[3], PetscReal gradient[3],
                               PetscReal *slope)
{
  const struct LamGrid_s *grid = table->grid;
  const PetscReal factor = grid->contact ? -r->cohesion : r->turgor;
  const LamLatticeState state = LamLatticeSquaresOf(&grid->axes, r->F);
  PetscReal J, J_x[3], J_xx[6], dF[3][4];

  J = LamLatticeVolume(&grid->axes, &state, J_x, J_xx);
  LamLatticeVariations(&grid->axes, &state, r->F, dF);
  *slope = r->P33_turgor + (grid->contact ? 0 : J);
  for (int k = 0; k < 3; k++) {
    gradient[k] = factor * J_x[k];
    for (int i = 0; i < 4; i++) gradient[k] += r->P33_F[i] * dF[k][i];
    *slope += a[1] * gradient[k];
  }
  return r->P33 + factor * J;
}

/* Cache of a(s): most states around a point share a few suctions. */
typedef struct {
  PetscReal suction[2], strain[2][3];
  int next;
} FreeStrain;

static const PetscReal *RecallFreeStrain(const struct LamGrid_s *grid, const LamNodeData *r, FreeStrain *memory)
{
  const PetscReal s = r->turgor + r->cohesion;
  const int at = memory->next;

  if (!grid->contact || !grid->free.n) return memory->strain[0]; /* zeros */
  for (int i = 0; i < 2; i++)
    if (memory->suction[i] == s) return memory->strain[i];
  memory->suction[at] = s;
  memory->next = 1 - at;
  LamFreeCellStrain(&grid->free, s, memory->strain[at]);
  return memory->strain[at];
}

/* Interpolates a corner to the point's suction: the value cubic in tau, the gradient linear. */
static void AddThickness(LamTable table, const Around *around, PetscReal tau_step, PetscBool is_free,
                         FreeStrain *memory, LamJet *jet)
{
  static const PetscReal still[3] = {0, 0, 0};
  const struct LamGrid_s *grid = table->grid;
  const PetscReal r = around->side, t = 1 - r;
  PetscReal gradient[3], slope, value;

  value = WallThickness(table, around->data, is_free ? still : RecallFreeStrain(grid, around->data, memory), gradient,
                        &slope);
  if (!LamGridHasColumns(grid)) {
    jet->value = value;
  } else {
    slope *= LamGridSuctionRate(grid, LamGridSuctionOf(grid, around->data->turgor, around->data->cohesion));
    jet->value += r * r * (1 + 2 * t) * value + (around->end ? -1 : 1) * tau_step * r * r * t * slope;
  }
  for (int k = 0; k < 3 && !is_free; k++) jet->gradient[k] += r * gradient[around->order[k]];
}

/* Adds factor times the gradient in t of the trilinear function of the corners' values. */
static void AddLinearGradient(const PetscReal value[8], PetscReal factor, const PetscReal t[3], PetscReal gradient[3])
{
  for (int c = 0; c < 8; c++) {
    const PetscReal w[3] = {c & 1 ? t[0] : 1 - t[0], c & 2 ? t[1] : 1 - t[1], c & 4 ? t[2] : 1 - t[2]};

    for (int k = 0; k < 3; k++)
      gradient[k] += factor * (c >> k & 1 ? 1 : -1) * w[(k + 1) % 3] * w[(k + 2) % 3] * value[c];
  }
}

void LamTableThickness(LamTable table, const LamTablePoint *point, const LamTableCell *cell,
                       const LamLatticeState *lattice, LamResponse *r)
{
  const struct LamGrid_s *grid = table->grid;
  const PetscReal d = LamGridTurgorStep(grid, r->load.turgor, r->load.cohesion);
  const PetscReal factor = grid->contact ? r->load.cohesion : -r->load.turgor;
  PetscReal t[3], value, gradient[3] = {0}, g[3], J, J_x[3], J_xx[6], row[4], rate[8] = {0};
  PetscReal turgor = 0, cohesion = 0, stiffness = 0;
  FreeStrain memory = {.suction = {-1, -1}};
  LamJet corner[8] = {0};
  Surroundings around;

  if (!Surround(table, cell, point, &around)) return;
  J = LamLatticeVolume(&grid->axes, lattice, J_x, J_xx);
  for (int n = 0; n < around.n; n++) {
    const Around *a = &around.at[n];
    const PetscReal J_node = a->data->F[0] * a->data->F[3] - a->data->F[1] * a->data->F[2];
    const PetscReal along_p = a->data->P33_turgor + (grid->contact ? 0 : J_node);
    const PetscReal along_g = grid->contact ? a->data->P33_cohesion - J_node : 0;

    AddThickness(table, a, around.tau_step[a->corner], (PetscBool)(!cell || cell->node[a->corner] == LAM_NODE_FLOATING),
                 &memory, &corner[a->corner]);
    turgor += a->weight * along_p;
    cohesion += a->weight * along_g;
    rate[a->corner] += a->side * (along_p - along_g);
    stiffness += a->weight * a->data->P33_F33;
  }
  value = corner[0].value;
  if (cell) {
    for (int k = 0; k < 3; k++) t[k] = (point->u[k] - cell->i[k]) / (LAM_ROOT >> cell->level);
    LamHermiteEdges(corner, grid->step / (1 << cell->level), t, &value, gradient);
    AddLinearGradient(rate, d / (grid->step / (1 << cell->level)), t, gradient);
  }
  /* contact: at fixed s, P33' depends on g through dP33'/dp - dP33'/dg, as the potential does */
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

/*
  Interpolation from the corners' values v: sum of weight (v - base) / size over the corners, times the point's size,
  plus the point's base.
    MEAN          size 1, base 0
    TENSION       size: norm of the walls' stress P + p J F^-T in the plane, plus a floor; base 0
    TRACTION      size as TENSION; base: normal traction of the walls' stress on the face family, minus turgor
    MAX_TRACTION  size as TENSION; base: the largest of the three tractions.
                  Contact: base: cohesion, the traction of open places and the upper bound; size: the distance of the
                  largest of the three below it
  So turgor at fixed walls leaves a tension unchanged and lowers a traction by p (with contact: where cohesion decreases
  by as much): the effective-stress principle.
*/
#define COMPONENTS(rule, n) (LAM_RULE_##rule == LAM_RULE_FRAME ? 0 : n)
#define ROW(name, rule, n)                                                                                             \
  {offsetof(LamResponse, name), offsetof(LamNodeData, name), COMPONENTS(rule, n), LAM_RULE_##rule},
#define ONE(name, rule) ROW(name, rule, 1)
#define THREE(name, rule) ROW(name, rule, 3)
static const struct {
  size_t response, node;
  int count; /* 3: per face family; 0: not interpolated */
  LamNodeRule rule;
} means[] = {LAM_NODE_INDICATORS(ONE, THREE)};

/* Of a state: norm of the walls' stress; bases of tractions per lattice direction; base and size of MAX_TRACTION. */
typedef struct {
  PetscReal size, traction[3], most, room;
} WallStress;

/* F, P: in the plane; cohesion: NULL for bonded tissue; scale: of stresses. Face k has the normal F^-T n_k and the
   traction P n_k over the face's stretch. */
static WallStress WallStressOf(const LamLatticeAxes *axes, const PetscReal F[4], PetscReal F33, const PetscReal P[4],
                               PetscReal turgor, const PetscReal *cohesion, PetscReal scale)
{
  const PetscReal cofactor[4] = {F33 * F[3], -F33 * F[2], -F33 * F[1], F33 * F[0]};
  WallStress w = {.most = -PETSC_INFINITY};
  PetscReal S[4], square = 0;

  for (int i = 0; i < 4; i++) {
    S[i] = P[i] + turgor * cofactor[i];
    square += S[i] * S[i];
  }
  w.size = sqrt(square) + scale;
  for (int k = 0; k < 3; k++) {
    const PetscReal *n = axes->n[k];
    const PetscReal m0 = cofactor[0] * n[0] + cofactor[1] * n[1], m1 = cofactor[2] * n[0] + cofactor[3] * n[1];
    const PetscReal t0 = S[0] * n[0] + S[1] * n[1], t1 = S[2] * n[0] + S[3] * n[1];

    w.traction[k] = (m0 * t0 + m1 * t1) / (m0 * m0 + m1 * m1) - turgor;
    w.most = PetscMax(w.most, w.traction[k]);
  }
  w.room = w.size;
  if (cohesion) {
    w.room = PetscMax(*cohesion - w.most, 0) + scale;
    w.most = *cohesion;
  }
  return w;
}

static PetscReal SizeFor(const WallStress *stress, LamNodeRule rule)
{
  return rule == LAM_RULE_MEAN ? 1 : rule == LAM_RULE_MAX_TRACTION ? stress->room : stress->size;
}

/* k: lattice direction of the state. */
static PetscReal BaseFor(const WallStress *stress, LamNodeRule rule, int k)
{
  return rule == LAM_RULE_TRACTION ? stress->traction[k] : rule == LAM_RULE_MAX_TRACTION ? stress->most : 0;
}

/* The surrounding states and their wall stresses. */
typedef struct {
  Surroundings around;
  WallStress stress[MOST_AROUND], here;
} Neighbours;

/* (value - base) / size of indicator i of the n-th state; k: component in the point's axes. */
static PetscReal Number(const Neighbours *near, int n, size_t i, int k)
{
  const Around *at = &near->around.at[n];
  const float *number = (const float *)((const char *)at->data + means[i].node);
  const WallStress *stress = &near->stress[n];

  return (number[means[i].count == 3 ? at->order[k] : 0] - BaseFor(stress, means[i].rule, at->order[k])) /
         SizeFor(stress, means[i].rule);
}

static PetscReal Mean(const Neighbours *near, size_t i, int k)
{
  PetscReal sum = 0;

  for (int n = 0; n < near->around.n; n++)
    if (near->around.at[n].weight) sum += near->around.at[n].weight * Number(near, n, i, k);
  return sum;
}

/* Weighted standard deviation over the corners, in the indicator's units: 0 at a node. */
static PetscReal Spread(const Neighbours *near, size_t i)
{
  const PetscReal mean = Mean(near, i, 0);
  PetscReal sum = 0;

  for (int n = 0; n < near->around.n; n++)
    if (near->around.at[n].weight) sum += near->around.at[n].weight * PetscSqr(Number(near, n, i, 0) - mean);
  return sqrt(sum) * SizeFor(&near->here, means[i].rule);
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

#define TRUSTED_SHARE 0.1   /* largest spread of a share of the interface */
#define TRUSTED_STRESS 0.05 /* largest relative spread of a stress; 0.08: events of `process` 1.7 of 7 days early */

static PetscBool IsTrusted(const Neighbours *near, PetscReal scale, const LamResponse *r)
{
  for (size_t i = 0; i < sizeof(means) / sizeof(means[0]); i++) {
    const size_t of = means[i].response;
    const PetscBool is_share =
        (PetscBool)(of == offsetof(LamResponse, debonded_fraction) || of == offsetof(LamResponse, open_fraction));
    const PetscBool is_stress =
        (PetscBool)(of == offsetof(LamResponse, max_wall_tension) || of == offsetof(LamResponse, max_traction));
    const PetscReal value = *(const PetscReal *)((const char *)r + of);

    if (is_share && Spread(near, i) > TRUSTED_SHARE) return PETSC_FALSE;
    if (is_stress && Spread(near, i) > TRUSTED_STRESS * (fabs(value) + scale)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Volumes are derivatives of Psi where all cells have the same turgor and cohesion. */
static void FillVolumes(LamTable table, LamResponse *r)
{
  if (!table->uniform) return;
  r->turgor_mean = r->load.turgor;
  r->turgor_spread = 0;
  r->lumen_fraction = -r->energy_turgor;
  r->opening_fraction = PetscMax(r->energy_cohesion, 0);
}

static void FillMeans(const Neighbours *near, const int axis[3], LamResponse *r)
{
  for (size_t i = 0; i < sizeof(means) / sizeof(means[0]); i++) {
    PetscReal *to = (PetscReal *)((char *)r + means[i].response);

    for (int k = 0; k < means[i].count; k++)
      to[means[i].count == 3 ? axis[k] : 0] =
          Mean(near, i, k) * SizeFor(&near->here, means[i].rule) + BaseFor(&near->here, means[i].rule, axis[k]);
  }
}

void LamTableIndicators(LamTable table, const LamTablePoint *point, const LamTableCell *cell, LamResponse *r)
{
  const PetscReal F[4] = {r->load.F[0], r->load.F[1], r->load.F[3], r->load.F[4]},
                  P[4] = {r->P[0], r->P[1], r->P[3], r->P[4]};
  const LamLatticeAxes *axes = &table->grid->axes;
  const PetscBool contact = table->grid->contact;
  Neighbours near;

  if (!Surround(table, cell, point, &near.around)) {
    r->indicators_trusted = PETSC_FALSE;
    return;
  }
  near.here = WallStressOf(axes, F, table->grid->z_cells ? r->load.F[8] : 1, P, r->load.turgor,
                           contact ? &r->load.cohesion : NULL, table->scale.plane);
  for (int n = 0; n < near.around.n; n++) {
    const LamNodeData *data = near.around.at[n].data;

    near.stress[n] = WallStressOf(axes, data->F, near.around.at[n].F33, data->P, data->turgor,
                                  contact ? &data->cohesion : NULL, table->scale.plane);
  }
  FillMeans(&near, point->axis, r);
  r->floating_cells = Agreed(&near.around, offsetof(LamNodeData, floating_cells));
  r->zero_modes = Agreed(&near.around, offsetof(LamNodeData, zero_modes));
  r->cell_clusters = Agreed(&near.around, offsetof(LamNodeData, cell_clusters));
  r->percolating_directions = Agreed(&near.around, offsetof(LamNodeData, percolating_directions));
  r->stable = PETSC_TRUE;
  r->indicators_trusted = IsTrusted(&near, table->scale.plane, r);
  FillVolumes(table, r);
}
