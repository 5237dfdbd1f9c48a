/*
  Method. With T = C11 + C22 and D = C11 C22 - C12^2 of C = F^T F the invariants of a sheet of constant volume are
    I1 = T + 1/D,   I2 = D + T/D,
  and c = (C11, C22, C12) has the derivatives J = dc/dF; P = J^T W_c and A = J^T W_cc J + W_c d2c/dFdF.

  Fibres that bear tension only have an energy with a kink in its second derivative at E = 0. They are integrated over
  the arc where E > 0, in which it is smooth; W and W' vanish at its ends, which therefore add nothing to derivatives.
*/
#include "end_walls.h"
#include "wall_law.h"
#include <lamella/tissue.h>
#include <math.h>

enum { SHEET = 3 }; /* components of c */

#define MOST_PARTS 64 /* of a fan of fibres; enough for the steepest exponential ones that are allowed */
#define SAME 1e-12    /* relative change of the tangent by twice as many parts: rounding, or convergence */

typedef struct {
  PetscReal c[SHEET], T, D, Tc[SHEET], Dc[SHEET], Dcc[SHEET][SHEET];
} Sheet;

typedef struct {
  PetscReal W, g[SHEET], h[SHEET][SHEET];
} Potential;

static Sheet SheetOf(const PetscReal F[9])
{
  Sheet s = {.Tc = {1.0, 1.0, 0.0}};

  for (PetscInt i = 0; i < 3; ++i) {
    s.c[0] += F[3 * i] * F[3 * i];
    s.c[1] += F[3 * i + 1] * F[3 * i + 1];
    s.c[2] += F[3 * i] * F[3 * i + 1];
  }
  s.T = s.c[0] + s.c[1];
  s.D = s.c[0] * s.c[1] - s.c[2] * s.c[2];
  s.Dc[0] = s.c[1];
  s.Dc[1] = s.c[0];
  s.Dc[2] = -2.0 * s.c[2];
  s.Dcc[0][1] = s.Dcc[1][0] = 1.0;
  s.Dcc[2][2] = -2.0;
  return s;
}

/* Mooney-Rivlin, W = C1/2 (I1 - 3) + C2/2 (I2 - 3). */
static void AddMatrix(const LamWall *wall, const Sheet *s, Potential *out)
{
  const PetscReal C1 = 0.5 * wall->C1, C2 = 0.5 * wall->C2, i = 1.0 / s->D, i2 = i * i;
  const PetscReal WT = C1 + C2 * i, WD = C2 - (C1 + C2 * s->T) * i2, WTD = -C2 * i2,
                  WDD = 2.0 * (C1 + C2 * s->T) * i2 * i;

  out->W += C1 * (s->T + i - 3.0) + C2 * (s->D + s->T * i - 3.0);
  for (PetscInt k = 0; k < SHEET; ++k) {
    out->g[k] += WT * s->Tc[k] + WD * s->Dc[k];
    for (PetscInt l = 0; l < SHEET; ++l)
      out->h[k][l] += WTD * (s->Tc[k] * s->Dc[l] + s->Dc[k] * s->Tc[l]) + WDD * s->Dc[k] * s->Dc[l] + WD * s->Dcc[k][l];
  }
}

/* Gauss's rule of LAM_POINTS = 12 points on [-1, 1], their positive half (Abramowitz & Stegun, table 25.4). */
static const PetscReal GaussPoint[LAM_POINTS / 2] = {
    0.125233408511468915472441369464, 0.367831498998180193752691536644, 0.587317954286617447296702418941,
    0.769902674194304687036893833213, 0.904117256370474856678465866119, 0.981560634246719250690549090149};
static const PetscReal GaussWeight[LAM_POINTS / 2] = {
    0.249147045813402785000562436043, 0.233492536538354808760849898925, 0.203167426723065921749064455810,
    0.160078328543346226334652529543, 0.106939325995318430960254718194, 0.047175336386511827194615961485};

/* Strain of fibres at the angle theta, E = mean + swing cos(2 (theta - axis)), and what it is made of. */
typedef struct {
  PetscReal mean, swing, axis;
  PetscReal arc; /* half of the angle over which fibres bear, about the axis */
} Fan;

static Fan FanOf(const LamWall *wall, const Sheet *s)
{
  const PetscReal d = wall->dispersion, along = 1.0 - 3.0 * d, cross = 0.5 * (s->c[0] - s->c[1]);
  Fan fan = {.mean = d * (s->T + 1.0 / s->D - 3.0) + along * (0.5 * s->T - 1.0),
             .swing = along * hypot(cross, s->c[2]),
             .axis = 0.5 * atan2(s->c[2], cross),
             .arc = 0.5 * PETSC_PI};

  if (wall->fibres == LAM_FIBRES_TENSION && fan.mean < fan.swing)
    fan.arc = fan.mean > -fan.swing ? 0.5 * acos(-fan.mean / fan.swing) : 0.0;
  return fan;
}

/* The mean over fibres in all directions of the sheet by Gauss's rule on `parts` equal parts of the fan. */
static void FanMean(const LamWall *wall, const LamWallLaw *law, const Sheet *s, const Fan *fan, PetscInt parts,
                    Potential *out)
{
  const PetscReal i = 1.0 / s->D, i2 = i * i, d = wall->dispersion, along = 1.0 - 3.0 * d;
  const PetscReal half = fan->arc / (PetscReal)parts; /* of a part */
  PetscReal N[LAM_POINTS][SHEET];
  LamPoints strain;
  LamKernel1 k;

  for (PetscInt part = 0; part < parts; ++part) {
    LAM_EACH_POINT(g)
    {
      const PetscReal at = g % 2 ? GaussPoint[g / 2] : -GaussPoint[g / 2];
      const PetscReal turn = -fan->arc + half * ((PetscReal)(2 * part + 1) + at), angle = fan->axis + turn;
      const PetscReal x = PetscCosReal(angle), y = PetscSinReal(angle);

      N[g][0] = x * x;
      N[g][1] = y * y;
      N[g][2] = 2.0 * x * y;
      strain[g] = fan->mean + fan->swing * PetscCosReal(2.0 * turn);
    }
    law->fibre(wall, strain, &k);
    LAM_EACH_POINT(g)
    {
      const PetscReal share = GaussWeight[g / 2] * half / PETSC_PI;
      PetscReal E[SHEET];

      out->W += share * k.W[g];
      for (PetscInt a = 0; a < SHEET; ++a) E[a] = d * (s->Tc[a] - i2 * s->Dc[a]) + along * N[g][a];
      for (PetscInt a = 0; a < SHEET; ++a) {
        out->g[a] += share * k.d[g] * E[a];
        for (PetscInt b = 0; b < SHEET; ++b)
          out->h[a][b] +=
              share * (k.dd[g] * E[a] * E[b] + k.d[g] * d * (2.0 * i2 * i * s->Dc[a] * s->Dc[b] - i2 * s->Dcc[a][b]));
      }
    }
  }
}

/* Adds the mean over fibres, of the strain E = d (I1 - 3) + (1 - 3 d) (I4 - 1): the parts are doubled until the mean
   stays, as that of an energy that is smooth over the fan does at the second look. */
static void AddFibres(const LamWall *wall, const LamWallLaw *law, const Sheet *s, Potential *out)
{
  const Fan fan = FanOf(wall, s);
  Potential last, mean = {0};
  PetscReal change;

  if (!(fan.arc > 0.0)) return;
  FanMean(wall, law, s, &fan, 1, &mean);
  for (PetscInt parts = 2; parts <= MOST_PARTS; parts *= 2) {
    last = mean;
    mean = (Potential){0};
    FanMean(wall, law, s, &fan, parts, &mean);
    change = PetscAbsReal(mean.h[0][0] - last.h[0][0]) + PetscAbsReal(mean.h[1][1] - last.h[1][1]);
    if (!(change > SAME * (PetscAbsReal(mean.h[0][0]) + PetscAbsReal(mean.h[1][1])))) break; /* or is not finite */
  }
  out->W += mean.W;
  for (PetscInt a = 0; a < SHEET; ++a) {
    out->g[a] += mean.g[a];
    for (PetscInt b = 0; b < SHEET; ++b) out->h[a][b] += mean.h[a][b];
  }
}

/* Adds `share` times a potential of c as one of F. */
static void AddOfF(const PetscReal F[9], const Potential *p, PetscReal share, LamEndWalls *out)
{
  PetscReal J[SHEET][9] = {{0.0}};

  for (PetscInt i = 0; i < 3; ++i) {
    const PetscInt a = 3 * i, b = 3 * i + 1;

    J[0][a] = 2.0 * F[a];
    J[1][b] = 2.0 * F[b];
    J[2][a] = F[b];
    J[2][b] = F[a];
    out->A[a][a] += share * 2.0 * p->g[0];
    out->A[b][b] += share * 2.0 * p->g[1];
    out->A[a][b] += share * p->g[2];
    out->A[b][a] += share * p->g[2];
  }
  out->W += share * p->W;
  for (PetscInt r = 0; r < 9; ++r)
    for (PetscInt k = 0; k < SHEET; ++k) {
      out->P[r] += share * p->g[k] * J[k][r];
      for (PetscInt l = 0; l < SHEET; ++l)
        for (PetscInt c = 0; c < 9; ++c) out->A[r][c] += share * J[k][r] * p->h[k][l] * J[l][c];
    }
}

PetscErrorCode LamEndWallsEvaluate(const LamMicrostructure *micro, const PetscReal F[9], LamEndWalls *out)
{
  const PetscInt cells = micro->cell || micro->tissue ? micro->cells[0] * micro->cells[1] : 1; /* else all are alike */
  const Sheet sheet = SheetOf(F);

  PetscFunctionBeginUser;
  *out = (LamEndWalls){0};
  for (PetscInt c = 0; c < cells && micro->length > 0.0; ++c) {
    const LamWall *wall = micro->cell ? &micro->cell[c].wall : &micro->wall;
    const PetscReal area = micro->tissue ? LamTissueCellArea(micro->tissue, c) / micro->tissue->area : 1.0 / cells;
    Potential p = {0};
    const LamWallLaw *law;

    PetscCall(LamWallLawGet(wall->law, &law));
    AddMatrix(wall, &sheet, &p);
    if (law->fibre) AddFibres(wall, law, &sheet, &p);
    AddOfF(F, &p, area * 2.0 * LamWallThickness(micro, c) / micro->length, out);
  }
  PetscFunctionReturn(0);
}
