/*
  Queries to a table.

  Algorithm
    Map F and suction to a point of the grid; sum the levels. The finest complete cell gives the error estimate, which
    decides whether the response is accepted. Then map back from (y, tau) to (x, s), and to stress and tangent:
      Psi(F, p, g) = Phi(x, s) + d Phi_p(x, s) + d^2 Phi_pp / 2 + c J,   d = p - p0,   J = det F
      bonded   p0 the grid's turgor, c = -p;    contact   p0 = s - g0, g0 the grid's cohesion, c = g.
    With the axis z = ln F33 Phi depends on it, too, and P33 = dPsi/dF33.
*/
#include "table_place.h"
#include "rounded_load.h"
#include <math.h>
#include <stdarg.h>
#include "clock.h"
#include <stdio.h>
#include <string.h>

/* Finest level of cells crossed by a change of branch; the states that remain are solved directly. */
enum { KINK_LEVEL = 2 };

/*
  Finest level and interval of suction in contact tissue. Contact switches between any two states, and a mesh has
  several solutions some tenths of a percent apart, so refinement would not end. States that remain are solved directly.
*/
enum { CONTACT_LEVEL = 3, CONTACT_INTERVAL = LAM_ROOT / 8, BONDED_INTERVAL = LAM_ROOT / 32 };

/*
  Weights of the error estimates of P and of the tangent, from held-out states of eleven tissues
  (tests/bench/bench_unfilled.sh): 97 % of the errors of P and, but for cells of turgor 0 and 1 (91 %), 95 % of those of
  the tangent are below three times the estimate. With contact Phi has kinks at the scale of the cells, so that the bubbles are no better than they
  are large, also next to a node.
*/
#define SPREAD 0.25
#define BUMP 0.3
#define MISSING_FLOOR 0.25
#define CONTACT_BEND 0.25
#define CONTACT_BUMP 0.5
#define TANGENT 1.5

/* ---- position ---- */

/* As printf, into the reason. */
PETSC_ATTRIBUTE_FORMAT(2, 3) static PetscBool Refuse(LamResponse *r, const char format[], ...)
{
  va_list arguments;

  r->status = LAM_OUT_OF_REACH;
  va_start(arguments, format);
  vsnprintf(r->reason, sizeof(r->reason), format, arguments);
  va_end(arguments);
  return PETSC_FALSE;
}

/*
  Moves a strain that lies on a face of cells up to rounding onto the face: the edge of a box belongs to it, in any
  rotation. Likewise a suction to that of a node, with the rounding of loads (rounded_load.h): tissue of a single turgor
  then needs one node along suction.
*/
static const PetscReal ROUNDED_STRAIN = 1e-11, ROUNDED_SUCTION = 1e-6;
static PetscReal OnFace(PetscReal u, PetscReal rounding)
{
  const PetscReal nearest = rint(u);

  return fabs(u - nearest) < rounding ? nearest : u;
}

static PetscBool PlaceSuction(LamTable table, const LamLoad *load, LamTablePlace *place, LamResponse *r)
{
  const struct LamGrid_s *grid = table->grid;
  LamTablePoint *point = &place->point;

  point->step = LamGridTurgorStep(grid, load->turgor, load->cohesion);
  if (!(fabs(point->step) <= grid->turgor_reach) && !grid->filled && !grid->contact)
    return Refuse(r,
                  "turgor is %.4g, that of the database's nodes %.4g (C1+C2): with air, or cells of unequal turgor, a "
                  "database of version 0.1 has no other; build it anew",
                  (double)load->turgor, (double)grid->turgor);
  if (!(fabs(point->step) <= grid->turgor_reach))
    return Refuse(
        r,
        "turgor is %.4g, that of the database's nodes around %.4g (C1+C2): so different it changes the volume of the "
        "walls; at most %.4g apart",
        (double)load->turgor, (double)(grid->contact ? load->turgor + load->cohesion - grid->cohesion : grid->turgor),
        (double)grid->turgor_reach);
  if (!LamGridHasColumns(grid)) return PETSC_TRUE;
  point->s = LamGridSuctionOf(grid, load->turgor, load->cohesion);
  point->tau = LamGridTau(grid, point->s);
  point->v = LAM_ROOT * (point->tau - grid->tau_min) / grid->tau_step;
  if (!(point->v >= -1e-6) || point->v > LAM_ROOT * grid->tau_cells + 1e-6)
    return Refuse(r, "turgor%s is %.4g (C1+C2), the database covers %.4g to %.4g", grid->contact ? " + cohesion" : "",
                  (double)point->s, (double)LamGridSuction(grid, 0),
                  (double)LamGridSuction(grid, LAM_ROOT * grid->tau_cells));
  point->v = OnFace(PetscMin(PetscMax(point->v, 0), LAM_ROOT * grid->tau_cells), ROUNDED_SUCTION);
  point->root = PetscMin((int)point->v / LAM_ROOT, (int)grid->tau_cells - 1) * LAM_ROOT;
  LamGridFreeStrain(grid, point->s, point->w, place->free_strain);
  return PETSC_TRUE;
}

/* A load that a table may have: in the plane, and with F33 = 1 where it has no axis. */
static PetscBool PlaceF33(LamTable table, const LamLoad *load, LamTablePlace *place, LamResponse *r)
{
  const struct LamGrid_s *grid = table->grid;
  LamTablePoint *point = &place->point;
  const PetscReal F33 = load->F[8], most = grid->z_min + grid->z_step * (PetscReal)grid->z_cells;

  place->F33 = 1;
  if (!LamLoadValidateInPlane(load, r)) return PETSC_FALSE;
  if (!grid->z_cells && LamPlaneStrain(load->F)) return PETSC_TRUE;
  if (!grid->z_cells)
    return Refuse(r, "F33 is %.6g, the database covers 1 alone (plane strain): build one of a scene with sample.F33",
                  (double)F33);
  point->w = OnFace((log(F33) - grid->z_min) / grid->z_step, ROUNDED_STRAIN);
  if (!(point->w >= 0 && point->w <= (PetscReal)grid->z_cells))
    return Refuse(r, "F33 is %.6g, the database covers %.4g to %.4g: build one of a scene with a wider sample.F33",
                  (double)F33, (double)exp(grid->z_min), (double)exp(most));
  point->z = 1 + PetscMin((int)point->w, (int)grid->z_cells - 1);
  place->F33 = F33;
  return PETSC_TRUE;
}

static void PlaceStrains(LamTable table, LamTablePlace *place)
{
  const struct LamGrid_s *grid = table->grid;
  PetscReal u[3];

  place->floating = (PetscBool)(grid->free.n > 0);
  for (int k = 0; k < 3; k++) {
    u[k] = OnFace((place->lattice.x[k] - grid->origin - place->free_strain[0]) / grid->step * LAM_ROOT, ROUNDED_STRAIN);
    place->floating = (PetscBool)(place->floating && u[k] >= 0);
  }
  for (int k = 0; k < 3; k++) {
    int rank = grid->symmetric ? 0 : k;

    for (int l = 0; l < 3 && grid->symmetric; l++) rank += u[l] < u[k] || (u[l] == u[k] && l < k);
    place->point.u[rank] = u[k];
    place->point.axis[rank] = k;
  }
}

static void SumLevels(LamTable table, LamTablePlace *place)
{
  for (int level = 0; level < table->levels; level++) {
    const LamTableCell *cell = LamTableFindCell(table, &place->point, level, &place->cells[level]);
    PetscBool good, complete = PETSC_FALSE;

    if (!cell && !level) return;
    if (!cell) continue;
    if (level == 0 || place->leaf) complete = LamTableCellIsComplete(table, cell, &place->point, &good);
    if (complete && (!place->leaf || place->leaf->level == level - 1)) {
      place->leaf = cell;
      place->good = good;
      place->child = NULL;
    }
    if (!place->leaf) return;
    if (level == place->leaf->level + 1) place->child = cell;
    LamTableAddCell(table, cell, &place->point, (PetscBool)(place->leaf == cell), &place->sum);
    if (place->leaf == cell) memcpy(place->leaf_gradient, place->sum.phi.gradient, sizeof(place->leaf_gradient));
  }
}

/* ---- error estimate ---- */

/* Root of the sum of the squares of |v_k dx_k/dF|: the components' signs are unknown. */
static PetscReal StressSize(const LamTablePlace *place, const PetscReal v[3])
{
  PetscReal square = 0;

  for (int k = 0; k < 3; k++) square += v[k] * v[k] / place->lattice.q[place->point.axis[k]];
  return sqrt(square);
}

/* Mean over the axes of 4 t (1 - t): 0 at nodes, 1 in the middle of the cell. */
static PetscReal Distance(const LamTablePoint *point, const LamTableCell *cell)
{
  PetscReal sum = 0;

  for (int k = 0; k < 3; k++) {
    const PetscReal t = (point->u[k] - cell->i[k]) / (LAM_ROOT >> cell->level);

    sum += 4 * t * (1 - t);
  }
  return sum / 3;
}

/*
  Errors of P from the cell and from the intervals of suction and of ln F33, which have the same weight. Sizes are those
  of the whole cell: pointwise values pass through zero where the error does not. B: bubbles, D: their spread, S: bump.
    bonded   Distance SPREAD D and BUMP S;   contact   CONTACT_BEND B and CONTACT_BUMP S
  The error is at least the change made by nodes of finer, incomplete cells: where one of them is of another kind, this
  is the jump to it. *tangent: TANGENT times the sizes (bonded: D and S, contact: B and S) over the edge of the cell.
*/
static void Estimates(LamTable table, const LamTablePlace *place, PetscReal *along_strain, PetscReal *along_suction,
                      PetscReal *along_z, PetscReal *tangent)
{
  const PetscBool contact = table->grid->contact;
  const PetscReal size_of_cell = StressSize(place, contact ? place->sum.bend : place->sum.spread);
  const PetscReal bump = StressSize(place, place->sum.bump), bump_z = StressSize(place, place->sum.bump_z);
  PetscReal finer[3], missing = 1;

  for (int k = 0; k < 3; k++) finer[k] = place->sum.phi.gradient[k] - place->leaf_gradient[k];
  if (place->child) missing = PetscMax(MISSING_FLOOR, LamTableMissingShare(table, place->child, &place->point));
  *along_strain = contact ? CONTACT_BEND * size_of_cell : SPREAD * Distance(&place->point, place->leaf) * size_of_cell;
  *along_strain = PetscMax(missing * *along_strain, StressSize(place, finer));
  *along_suction = (contact ? CONTACT_BUMP : BUMP) * bump;
  *along_z = contact ? CONTACT_BUMP * bump_z : 0; /* bonded: knots are close enough, and their distance is fixed */
  *tangent = TANGENT * hypot(size_of_cell, bump) * (1 << place->leaf->level) / table->grid->step;
}

/*
  Error estimate for floating cells. Under strong shear lattice directions deviate from the face normals, and neighbours
  that are close in two directions still touch: P had errors up to 2 % with the second strain within 0.008 of a(s) and
  the third 0.2 above (docs/results/verification.md).
*/
static PetscReal FloatingError(const struct LamGrid_s *grid, const LamTablePoint *point)
{
  const PetscReal unit = grid->step / LAM_ROOT, middle = point->u[1] * unit, most = point->u[2] * unit;

  return 0.03 * PetscMax(0, 1 - middle / 0.012) * PetscMin(1, most / 0.2);
}

/* ---- the response ---- */

static PetscBool Locate(LamTable table, const LamLoad *load, LamTablePlace *place, LamResponse *r)
{
  const PetscReal F[4] = {load->F[0], load->F[1], load->F[3], load->F[4]};

  memset(place, 0, sizeof(*place));
  if (!PlaceF33(table, load, place, r)) return PETSC_FALSE;
  place->lattice = LamLatticeStateOf(&table->grid->axes, F);
  if (!PlaceSuction(table, load, place, r)) return PETSC_FALSE;
  PlaceStrains(table, place);
  if (!place->floating) SumLevels(table, place);
  return PETSC_TRUE;
}

static PetscBool Accept(const LamTablePlace *place, PetscReal accuracy, LamResponse *r)
{
  if (!place->floating && !place->leaf) return Refuse(r, "the database has no nodes around this state");
  if (!place->floating && !place->good)
    return Refuse(r, "the states around are not all of one kind: cells buckle, lose contact or have no solution here");
  if (r->error_estimate <= accuracy) return PETSC_TRUE;
  return Refuse(r, "the estimated error is %.2g %%, the accuracy is %.2g %%", 100 * r->error_estimate, 100 * accuracy);
}

/* All of the response that follows from the potential, and P33. PETSC_FALSE: the table has no response. */
static PetscBool Fill(LamTable table, LamTablePlace *place, LamResponse *r)
{
  PetscReal along_strain = 0, along_suction = 0, along_z = 0, tangent = 0;

  if (place->floating) /* P = g J F^-T, exact except for the free cell's data */
    LamTableAddFloating(table, &place->point, &place->sum);
  else if (place->leaf && place->good)
    Estimates(table, place, &along_strain, &along_suction, &along_z, &tangent);
  else
    return PETSC_FALSE;
  LamTableFillPotential(table, place, r);
  if (!table->grid->z_cells)
    LamTableThickness(table, &place->point, place->leaf, &place->lattice, r);
  else
    along_suction = hypot(along_suction, along_z);
  r->error_estimate = place->floating ? FloatingError(table->grid, &place->point)
                                      : LamStressErrorOfSize(table->scale, hypot(along_strain, along_suction), r->P);
  r->tangent_error_estimate =
      place->floating ? r->error_estimate : LamTangentErrorOfSize(table->scale, tangent, r->tangent);
  return PETSC_TRUE;
}

static void Answer(LamTable table, LamTablePlace *place, PetscReal accuracy, LamResponse *r)
{
  (void)Fill(table, place, r);
  if (!Accept(place, accuracy, r)) return;
  LamTableIndicators(table, &place->point, place->leaf, r);
  r->status = LAM_CONVERGED;
}

PetscErrorCode LamTableQuery(LamTable table, const LamLoad *load, PetscReal accuracy, LamResponse *response)
{
  const PetscReal start = LamClock();
  LamTablePlace place;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  if (Locate(table, load, &place, response)) Answer(table, &place, accuracy, response);
  response->seconds = LamClock() - start;
  PetscFunctionReturn(0);
}

/* ---- missing nodes ---- */

typedef struct {
  LamTable table;
  PetscInt *n;
  PetscInt64 *keys;
  PetscBool hopeless; /* a needed node has no usable solution */
} Needs;

static void Need(Needs *needs, const int at[3], int j, int z)
{
  const struct LamGrid_s *grid = needs->table->grid;
  LamNodePlace place = {.j = j, .z = z};
  PetscInt node;
  PetscInt64 key;

  if (LamPlaceIsFloating(grid, at)) return;
  LamTableSortAxes(grid->symmetric, at, place.i);
  key = LamNodeKeyOf(&place);
  node = LamPlaceMapGet(&needs->table->node_map, LamPlaceMapKey(place.i));
  for (PetscInt s = 0; node >= 0 && s < needs->table->nodes[node].count; s++) {
    const LamTableState *state = &LamTableStates(needs->table, &needs->table->nodes[node])[s];

    if (state->j != j || state->z != z) continue;
    if (!state->has_data) needs->hopeless = PETSC_TRUE;
    return;
  }
  for (PetscInt m = 0; m < *needs->n; m++)
    if (needs->keys[m] == key) return;
  if (*needs->n < LAM_MAX_NEEDS) needs->keys[(*needs->n)++] = key;
}

/* Adds all corners of the point's cell of a level, at both ends of an interval of suction and of ln F33. */
static void NeedCell(Needs *needs, const LamTablePoint *point, int level, const int ends[2])
{
  const int size = LAM_ROOT >> level;

  for (int c = 0; c < 8; c++) {
    int at[3];

    for (int k = 0; k < 3; k++) at[k] = (int)floor(point->u[k] / size) * size + (c >> k & 1 ? size : 0);
    for (int line = 0; line < LamTableLines(needs->table); line++)
      for (int e = 0; e < (LamGridHasColumns(needs->table->grid) ? 2 : 1); e++)
        Need(needs, at, ends[e], point->z + line);
  }
}

/* Needs the root cell around the point between these ends of suction. While a corner is known to have no solution at one
   of them, the half around the point instead. */
static void NeedRootCell(Needs *needs, const LamTablePoint *point, int least, int ends[2])
{
  for (;;) {
    const int middle = (ends[0] + ends[1]) / 2;

    *needs->n = 0;
    needs->hopeless = PETSC_FALSE;
    NeedCell(needs, point, 0, ends);
    if (!needs->hopeless || ends[1] - ends[0] <= least) return;
    ends[point->v < middle] = middle;
  }
}

/* The interval of suction around the point common to all columns of the cell. If the point lies on an end, both ends
   are set to it. */
static void CommonInterval(LamTable table, const LamTableCell *cell, const LamTablePoint *point, int ends[2])
{
  ends[0] = point->root;
  ends[1] = LamGridHasColumns(table->grid) ? point->root + LAM_ROOT : point->root;
  for (int c = 0; c < 8 && cell && LamGridHasColumns(table->grid); c++) {
    const LamTableState *at[2];

    for (int line = 0; line < LamTableLines(table) && cell->node[c] >= 0; line++) {
      LamTableBracket(table, &table->nodes[cell->node[c]], point, line, at);
      if (at[0]) ends[0] = PetscMax(ends[0], at[0]->j);
      if (at[1]) ends[1] = PetscMin(ends[1], at[1]->j);
    }
  }
  for (int e = 0; e < 2; e++)
    if (ends[e] == point->v) ends[1 - e] = ends[e];
}

/*
  The widest interval of suction around the point among the columns that its response rests on, of all levels; returns
  the level of its cell. A coarse column that stays as it is would leave its error to all finer ones.
*/
static int WidestInterval(LamTable table, const LamTablePlace *place, int ends[2])
{
  int widest = 0;

  ends[0] = ends[1] = place->point.root;
  for (int level = 0; LamGridHasColumns(table->grid) && level <= place->leaf->level; level++) {
    const LamTableCell *cell;
    LamTableCell around;

    cell = LamTableFindCell(table, &place->point, level, &around);
    for (int c = 0; cell && c < 8; c++) {
      const LamTableNode *node = cell->node[c] < 0 ? NULL : &table->nodes[cell->node[c]];

      for (int line = 0; node && node->level == level && line < LamTableLines(table); line++) {
        const LamTableState *at[2];

        LamTableBracket(table, node, &place->point, line, at);
        if (!at[0] || !at[1] || !LamTableRestsOn(at, 0, &place->point) || !LamTableRestsOn(at, 1, &place->point) ||
            at[1]->j - at[0]->j <= ends[1] - ends[0])
          continue;
        widest = level;
        for (int e = 0; e < 2; e++) ends[e] = at[e]->j;
      }
    }
  }
  return widest;
}

/* Outside the range of node places, or strains that are not finite. */
static PetscBool IsOutside(LamTable table, const LamTablePlace *place)
{
  for (int k = 0; k < 3; k++)
    if (!(fabs(place->point.u[k]) < LAM_GRID_REACH - 2 * LAM_ROOT)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode LamTableNeeds(LamTable table, const LamLoad *load, PetscReal accuracy, PetscReal *error, PetscInt *n,
                             PetscInt64 keys[LAM_MAX_NEEDS])
{
  Needs needs = {table, n, keys, PETSC_FALSE};
  PetscReal along_strain, along_suction, along_z, tangent;
  LamResponse response;
  LamTablePlace place;
  int ends[2], wide[2], widest, least;

  PetscFunctionBeginUser;
  *n = 0;
  if (error) *error = INFINITY; /* PETSC_INFINITY is finite */
  PetscCall(LamResponseInit(load, &response));
  if (!Locate(table, load, &place, &response)) PetscFunctionReturn(0);
  if (Fill(table, &place, &response)) {
    if (error) *error = response.error_estimate;
    if (response.error_estimate <= accuracy) PetscFunctionReturn(0);
  }
  if (IsOutside(table, &place)) PetscFunctionReturn(0);
  least = table->grid->contact ? CONTACT_INTERVAL : BONDED_INTERVAL;
  CommonInterval(table, place.leaf, &place.point, ends);
  if (!place.leaf)
    NeedRootCell(&needs, &place.point, least, ends);
  else if (!place.good) {
    if (place.leaf->level < KINK_LEVEL) NeedCell(&needs, &place.point, place.leaf->level + 1, ends);
  } else {
    Estimates(table, &place, &along_strain, &along_suction, &along_z, &tangent);
    widest = WidestInterval(table, &place, wide);
    if (along_suction > along_strain && wide[1] - wide[0] > least) {
      wide[0] = wide[1] = (wide[0] + wide[1]) / 2;
      NeedCell(&needs, &place.point, widest, wide);
    } else if (place.leaf->level < (table->grid->contact ? CONTACT_LEVEL : LAM_FINEST))
      NeedCell(&needs, &place.point, place.leaf->level + 1, ends);
  }
  if (needs.hopeless) *n = 0;
  PetscFunctionReturn(0);
}

/* ---- states outside the grid ---- */

/* Finds the good state at the corners of a cell that is nearest to the point, if nearer than *least. */
static void FindNearest(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscReal *least,
                        PetscInt64 *key)
{
  for (int c = 0; c < 8 && cell; c++) {
    const LamTableNode *node = cell->node[c] < 0 ? NULL : &table->nodes[cell->node[c]];
    PetscReal square = 0;

    for (int k = 0; k < 3; k++)
      square += PetscSqr(point->u[k] - cell->i[k] - (c >> k & 1 ? LAM_ROOT >> cell->level : 0));
    for (PetscInt s = 0; node && s < node->count; s++) {
      const LamTableState *state = &LamTableStates(table, node)[s];
      const PetscReal knots = table->grid->z_cells ? point->w - (state->z - 1) : 0;
      const PetscReal distance = square + PetscSqr(point->v - state->j) + PetscSqr(LAM_ROOT * knots);

      if (!state->good || distance >= *least) continue;
      *least = distance;
      *key = table->source->data[state->data].key;
    }
  }
}

/*
  The order of axes in which a state outside the grid is solved: by strain, but by axis where strains are nearly equal.
  A solve has the symmetry of its state only to the mesh's accuracy. If nearly equal strains swapped between two
  iterations, its stress would jump by that much.
*/
static const PetscReal ALIKE = 1e-3; /* chosen: some 40 times the strain differences of observed swaps */
static void OrderAxes(const LamTablePlace *place, int axis[3])
{
  for (int k = 0; k < 3; k++) axis[k] = place->point.axis[k];
  for (int pass = 0; pass < 3; pass++) {
    int *low = &axis[pass % 2], *high = low + 1;

    if (place->lattice.x[*high] - place->lattice.x[*low] < ALIKE && *high < *low) {
      const int swap = *low;

      *low = *high;
      *high = swap;
    }
  }
}

PetscErrorCode LamTableTurn(LamTable table, const LamLoad *load, LamLoad *turned, PetscInt64 *key)
{
  PetscReal x[3], U[4], least = PETSC_INFINITY;
  LamResponse response;
  LamTablePlace place;
  int axis[3];

  PetscFunctionBeginUser;
  *turned = *load;
  *key = -1;
  PetscCall(LamResponseInit(load, &response));
  if (!Locate(table, load, &place, &response)) PetscFunctionReturn(0);
  OrderAxes(&place, axis);
  for (int k = 0; k < 3; k++) x[k] = LamOnGrid(place.lattice.x[axis[k]]);
  if (!LamLatticeStretch(&table->grid->axes, x, U)) PetscFunctionReturn(0);
  for (int i = 0; i < 4; i++) turned->F[3 * (i / 2) + i % 2] = U[i];
  FindNearest(table, place.leaf, &place.point, &least, key);
  FindNearest(table, place.child, &place.point, &least, key);
  PetscFunctionReturn(0);
}
