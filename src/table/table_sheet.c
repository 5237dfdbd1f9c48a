/*
  Cells of a table with the axis z = ln F33.

  Method. At a corner the columns of the knots of z on both sides of the point give Phi, dPhi/dz, d2Phi/dz2 and so on as
  functions of tau; between them the value is the quintic of these, the gradient the cubic of gradients and their
  slopes, second derivatives a cubic of differences, as in a column along tau. dPhi/dz has along tau the cubic of its
  values and of d2Phi/dtau dz; its gradient and d2Phi/dz2 have slopes from differences. All that is C1 in both.
*/
#include "table_column.h"
#include <math.h>
#include <string.h>

/* Derivatives of a sheet: orders in tau and z. Bonded tissue has those without tau. */
enum { PHI, Z, ZZ, TAU, TAU2, TAU_Z, ORDERS, BONDED_ORDERS = 3 };
static const int order_tau[ORDERS] = {0, 0, 0, 1, 2, 1}, order_z[ORDERS] = {0, 1, 2, 0, 0, 1};

/* Of these alone gradients are used. */
static PetscBool IsFirst(int order)
{
  return (PetscBool)(order_tau[order] + order_z[order] == 1);
}

/* Derivatives along z of one column, each with two derivatives in tau. */
typedef struct {
  LamJet slope[3]; /* of Phi's jet */
  PetscReal second[3], turgor[3];
} Axial;

/* A node at a point, in the axes of the cell. */
typedef struct {
  LamJet phi[ORDERS], turgor1[ORDERS];
  PetscReal turgor2[ORDERS], bump[3], bump_z[3];
} Sheet;

/* One state's share of a column, with the factors V and D of LamTableInterval. */
static void AddAxial(const LamTableAxial *state, const int order[3], int corner, int line, PetscReal V, PetscReal D,
                     int d, Axial *x)
{
  LamJet *slope = &x->slope[d];

  slope->value += V * state->first + D * state->mixed;
  x->second[d] += V * (line ? state->second_minus : state->second) + D * state->second_tau[line];
  x->turgor[d] += V * state->turgor;
  for (int k = 0; k < 3; k++) {
    const int n = order[k];

    slope->gradient[k] += V * state->gradient[n] + D * state->gradient_tau[n];
    slope->hessian[k] += V * (corner >> k & 1 ? state->minus[n] : state->hessian[n]);
    slope->hessian[3 + k] += V * state->hessian[3 + n];
  }
}

static void AxialOf(LamTable table, const LamTableInterval *a, const int order[3], int corner, int line, Axial *x)
{
  memset(x, 0, sizeof(*x));
  for (int e = 0; e < 2; e++) {
    const LamTableAxial *state = a->end[e] ? &table->axial[a->end[e] - table->states] : NULL;

    if (!state) continue;
    if (!LamGridHasColumns(table->grid)) {
      AddAxial(state, order, corner, line, 1, 0, 0, x);
      return;
    }
    for (int d = 0; d < 3; d++) AddAxial(state, order, corner, line, a->V[e][d], a->D[e][d], d, x);
  }
}

static void FloatingAxial(LamTable table, int level, PetscInt plane, const LamTablePoint *point, Axial *x)
{
  PetscReal axial[3][3];

  memset(x, 0, sizeof(*x));
  if (level) return;
  LamFreeCellAxial(&table->grid->free, plane, point->s, axial);
  for (int d = 0; d < 3; d++) {
    x->slope[d].value = axial[0][d];
    x->second[d] = axial[1][d];
    x->turgor[d] = axial[2][d];
  }
}

/* As AddHigherOrder of a column. */
static PetscReal Bump(const LamTableInterval *z, const LamTableColumn c[2], const Axial x[2], int k)
{
  const PetscReal bend = z->h * (x[0].slope[0].gradient[k] + x[1].slope[0].gradient[k]) +
                         2 * (c[0].phi[0].gradient[k] - c[1].phi[0].gradient[k]);

  return 0.5 * z->t * (1 - z->t) * bend;
}

/* sum += V jet + D slope, of all their numbers. */
static void AddJets(PetscReal V, const LamJet *jet, PetscReal D, const LamJet *slope, LamJet *sum)
{
  sum->value += V * jet->value + D * slope->value;
  for (int k = 0; k < 3; k++) sum->gradient[k] += V * jet->gradient[k] + D * slope->gradient[k];
  for (int m = 0; m < 6; m++) sum->hessian[m] += V * jet->hessian[m] + D * slope->hessian[m];
  sum->third += V * jet->third;
}

static void Join(LamTable table, const LamTableInterval *z, const LamTableColumn c[2], const Axial x[2], Sheet *sheet)
{
  memset(sheet, 0, sizeof(*sheet));
  for (int o = 0; o < (LamGridHasColumns(table->grid) ? ORDERS : BONDED_ORDERS); o++) {
    const int a = order_tau[o], b = order_z[o];
    const PetscReal value[2] = {c[0].phi[a].value, c[1].phi[a].value};
    const PetscReal slope[2] = {x[0].slope[a].value, x[1].slope[a].value}, curve[2] = {x[0].second[a], x[1].second[a]};
    LamJet *turgor1 = &sheet->turgor1[o];
    PetscReal d[2];

    LamTableDefects(z, value, slope, curve, d);
    for (int e = 0; e < 2; e++) {
      const PetscReal V = z->V[e][b], D = z->D[e][b];

      AddJets(V, &c[e].phi[a], D, &x[e].slope[a], &sheet->phi[o]);
      sheet->phi[o].value += z->q[e][b] * d[e];
      turgor1->value += V * c[e].turgor1[a].value + D * x[e].turgor[a];
      for (int k = 0; k < 3; k++) turgor1->gradient[k] += V * c[e].turgor1[a].gradient[k];
      sheet->turgor2[o] += V * c[e].turgor2[a];
    }
  }
  for (int k = 0; k < 3; k++) {
    sheet->bump[k] = z->V[0][0] * c[0].bump[k] + z->V[1][0] * c[1].bump[k];
    sheet->bump_z[k] = Bump(z, c, x, k);
  }
}

static void MakeSheet(LamTable table, const LamTableCell *cell, int corner, const LamTablePoint *point,
                      const LamTableInterval *z, Sheet *sheet)
{
  const PetscInt n = cell->node[corner];
  LamTableColumn column[2];
  LamTableInterval a;
  Axial axial[2];

  if (n == LAM_NODE_MISSING || (n >= 0 && table->nodes[n].level != cell->level)) {
    memset(sheet, 0, sizeof(*sheet));
    return;
  }
  for (int line = 0; line < 2; line++) {
    LamTableMakeColumn(table, cell, corner, point, line, &a, &column[line]);
    if (n == LAM_NODE_FLOATING)
      FloatingAxial(table, cell->level, LamTablePlane(point, line), point, &axial[line]);
    else
      AxialOf(table, &a, LamAxisOrder[cell->order[corner]], corner, line, &axial[line]);
  }
  Join(table, z, column, axial, sheet);
}

static LamTableInterval IntervalAlongZ(LamTable table, const LamTablePoint *point)
{
  LamTableInterval z = {.t = point->w - (point->z - 1), .h = table->grid->z_step};

  LamTableHermite(&z);
  return z;
}

/* Adds the derivatives along tau and z of a part of Phi. */
static void AddDerivatives(LamTable table, const LamJet part[ORDERS], LamTableSum *sum)
{
  sum->z1 += part[Z].value;
  sum->z2 += part[ZZ].value;
  for (int k = 0; k < 3; k++) sum->gradient_z[k] += part[Z].gradient[k];
  if (!LamGridHasColumns(table->grid)) return;
  sum->tau1 += part[TAU].value;
  sum->tau2 += part[TAU2].value;
  sum->tau_z += part[TAU_Z].value;
  for (int k = 0; k < 3; k++) sum->gradient_tau[k] += part[TAU].gradient[k];
}

/* As AddTurgor of table_sum.c. */
static void AddTurgor(LamTable table, const Sheet sheets[8], PetscReal h, const PetscReal t[3], PetscReal d,
                      LamTableSum *sum)
{
  const int orders = LamGridHasColumns(table->grid) ? ORDERS : BONDED_ORDERS;
  LamJet corner[8], rate[ORDERS] = {0}, part[ORDERS] = {0};

  for (int o = 0; o < orders; o++) {
    if (o != PHI && !IsFirst(o)) continue;
    for (int c = 0; c < 8; c++) corner[c] = LamTableTurgorJet(&sheets[c].turgor1[o], sheets[c].turgor2[o], 1, d);
    LamHermiteCubic(corner, h, t, o == PHI ? &sum->turgor1 : &rate[o]);
  }
  sum->turgor1_z += rate[Z].value;
  sum->turgor1_tau += rate[TAU].value;
  if (d == 0) return;
  for (int o = 0; o < orders; o++) {
    for (int c = 0; c < 8; c++)
      corner[c] = LamTableTurgorJet(&sheets[c].turgor1[o], sheets[c].turgor2[o], d, 0.5 * d * d);
    LamHermiteCubic(corner, h, t, o == PHI ? &sum->phi : &part[o]);
  }
  AddDerivatives(table, part, sum);
}

void LamTableAddSheets(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool estimate,
                       LamTableSum *sum)
{
  const int size = LAM_ROOT >> cell->level, orders = LamGridHasColumns(table->grid) ? ORDERS : BONDED_ORDERS;
  const PetscReal h = table->grid->step / (1 << cell->level);
  const LamTableInterval z = IntervalAlongZ(table, point);
  LamJet corner[ORDERS][8], part[ORDERS] = {0};
  PetscReal t[3], bump[3] = {0}, bump_z[3] = {0};
  Sheet sheets[8];

  for (int k = 0; k < 3; k++) t[k] = (point->u[k] - cell->i[k]) / size;
  for (int c = 0; c < 8; c++) {
    PetscReal weight = 1;

    MakeSheet(table, cell, c, point, &z, &sheets[c]);
    for (int o = 0; o < orders; o++) corner[o][c] = sheets[c].phi[o];
    for (int k = 0; k < 3; k++) {
      weight *= c >> k & 1 ? t[k] * t[k] * (3 - 2 * t[k]) : (1 - t[k]) * (1 - t[k]) * (1 + 2 * t[k]);
      bump[k] += PetscSqr(sheets[c].bump[k]) / 8;
      bump_z[k] += PetscSqr(sheets[c].bump_z[k]) / 8;
    }
    sum->turgor2 += weight * sheets[c].turgor2[PHI];
  }
  if (estimate) LamHermiteSizes(corner[PHI], h, sum->bend, sum->spread);
  for (int k = 0; k < 3; k++) {
    sum->bump[k] = sqrt(PetscSqr(sum->bump[k]) + bump[k]);
    sum->bump_z[k] = sqrt(PetscSqr(sum->bump_z[k]) + bump_z[k]);
  }
  LamHermiteQuintic(corner[PHI], h, t, &sum->phi);
  for (int o = 1; o < orders; o++) {
    if (IsFirst(o))
      LamHermiteQuinticSlope(corner[o], h, t, &part[o]);
    else
      part[o].value = LamHermiteQuinticValue(corner[o], h, t);
  }
  AddDerivatives(table, part, sum);
  AddTurgor(table, sheets, h, t, point->step, sum);
}

void LamTableAddFloatingSheet(LamTable table, const LamTablePoint *point, LamTableSum *sum)
{
  const LamTableInterval z = IntervalAlongZ(table, point);
  const PetscReal d = point->step;
  LamTableColumn column[2] = {0};
  LamJet part[ORDERS] = {0};
  Axial axial[2];
  Sheet sheet;

  for (int line = 0; line < 2; line++) {
    LamTableFloatingColumn(table, 0, LamTablePlane(point, line), point, &column[line]);
    FloatingAxial(table, 0, LamTablePlane(point, line), point, &axial[line]);
  }
  Join(table, &z, column, axial, &sheet);
  for (int o = 0; o < ORDERS; o++)
    part[o].value = sheet.phi[o].value + LamTableTurgorJet(&sheet.turgor1[o], sheet.turgor2[o], d, 0.5 * d * d).value;
  sum->phi.value += part[PHI].value;
  AddDerivatives(table, part, sum);
  sum->turgor1.value += LamTableTurgorJet(&sheet.turgor1[PHI], sheet.turgor2[PHI], 1, d).value;
  sum->turgor1_tau += LamTableTurgorJet(&sheet.turgor1[TAU], sheet.turgor2[TAU], 1, d).value;
  sum->turgor1_z += LamTableTurgorJet(&sheet.turgor1[Z], sheet.turgor2[Z], 1, d).value;
  sum->turgor2 += sheet.turgor2[PHI];
}
