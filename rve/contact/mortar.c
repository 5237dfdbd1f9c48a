/*
  Weighted gaps of one pair of chains and their variations.

  Method. G_A is a sum over segments whose ends may move. With fixed s, N = n.R (R = dX - dy), T = tau.R,
  N0 = n.dy_eta are rows of derivatives of the local dofs:
    first variation    int phi_A N ds + sum over moving break points of phi_A [gamma] ds_v, ends included,
    second variation   int lambda d2gamma ds + break points (AddBreak),
    d2gamma = -(sym(N0, T) + gamma N0(x)N0 + (b/m) T(x)T)/H,   m = tau.tau, b = y_etaeta.n, H = m - gamma b
  All terms are kept: the Newton iteration and the effective tangent need them.

  References. Puso & Laursen, Comput. Methods Appl. Mech. Engrg 193 (2004) 601 (segment mortar); Popp, Gee & Wall, Int.
  J. Numer. Meth. Engng 79 (2009) 1354 (linearisation); docs/theory/mortar.md, First and second variation.
*/
#include "mortar_impl.h"

#define EDGE_DOFS 6
#define POINT_DOFS 12 /* one slave and one master edge */
#define BREAK_DOFS 16 /* one slave edge and two neighbouring master edges */

PetscErrorCode LamMortarResultCreate(PetscInt n, PetscInt m, LamMortarResult *result)
{
  const PetscInt hats = 2 * n + 1, dofs = LamMortarDofs(n, m);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(hats, &result->weight, hats, &result->gap, hats * dofs, &result->dgap, dofs * dofs,
                         &result->hessian));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMortarResultDestroy(LamMortarResult *result)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(result->weight, result->gap, result->dgap, result->hessian));
  PetscFunctionReturn(0);
}

/* A point of the slave and its projection on one master edge. Rows hold the dofs of the slave edge, then the master's.
 */
typedef struct {
  PetscInt edge, master;
  PetscReal N[3], dN[3]; /* of the slave edge */
  PetscReal M[3], dM[3]; /* of the master edge */
  PetscReal Xs[2], normal[2], tau[2];
  PetscReal g, H, b_over_m; /* gap; H, b/m of the header comment */
} Point;

/* Closest-point projection: eta on a master edge, which is extended a little past its ends. */
static PetscReal Project(const PetscReal y[][2], const PetscReal X[2])
{
  PetscReal eta = 0.0, curvature[2];

  LamEdgeCurvature(y, curvature);
  for (PetscInt it = 0; it < 50; ++it) {
    PetscReal M[3], dM[3], at[2], tau[2], z[2], H, m, step;
    PetscBool newton;

    LamEdgeShape(eta, M, dM);
    LamEdgeSum(y, M, at);
    LamEdgeSum(y, dM, tau);
    z[0] = X[0] - at[0];
    z[1] = X[1] - at[1];
    m = LamDot(tau, tau);
    H = m - LamDot(z, curvature);
    newton = (PetscBool)(H >= 0.2 * m);
    if (!newton) H = m;
    step = PetscMax(-0.5, PetscMin(0.5, LamDot(z, tau) / H));
    step = PetscMax(-1.5, PetscMin(1.5, eta + step)) - eta;
    eta += step;
    /* Newton's method leaves an error of about the square of its step */
    if (PetscAbsReal(step) < (newton ? PetscSqrtReal(0.5 * PETSC_MACHINE_EPSILON) : 1e-15)) break;
  }
  return eta;
}

/* Slave part of a point. */
static void SetSlave(const LamMortarChains *chains, PetscInt edge, PetscReal s, Point *p, PetscReal X[2])
{
  const PetscReal(*x)[2] = &chains->x[2 * edge];

  p->edge = edge;
  LamEdgeShape(2.0 * (s - (PetscReal)edge) - 1.0, p->N, p->dN);
  LamEdgeSum(x, p->N, X);
  LamEdgeSum(x, p->dN, p->Xs);
  for (PetscInt d = 0; d < 2; ++d) p->Xs[d] *= 2.0;
}

static void SetPoint(const LamMortarChains *chains, PetscInt edge, PetscReal s, PetscInt master, Point *p)
{
  const PetscReal(*y)[2] = &chains->y[2 * master];
  PetscReal X[2], at[2], curvature[2], length, m, b;

  SetSlave(chains, edge, s, p, X);
  p->master = master;
  LamEdgeShape(Project(y, X), p->M, p->dM);
  LamEdgeSum(y, p->M, at);
  LamEdgeSum(y, p->dM, p->tau);
  LamEdgeCurvature(y, curvature);
  m = LamDot(p->tau, p->tau);
  length = PetscSqrtReal(m);
  p->normal[0] = p->tau[1] / length;
  p->normal[1] = -p->tau[0] / length;
  p->g = (X[0] - at[0]) * p->normal[0] + (X[1] - at[1]) * p->normal[1];
  b = LamDot(curvature, p->normal);
  p->H = m - p->g * b;
  if (p->H < 0.2 * m) p->H = 0.2 * m; /* beyond the centre of curvature: only in wide open gaps */
  p->b_over_m = b / m;
}

/* Row z.R of a point: slave N_a z, master -M_a z. */
static void RelativeRow(const Point *p, const PetscReal z[2], PetscReal row[POINT_DOFS])
{
  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt d = 0; d < 2; ++d) {
      row[2 * a + d] = p->N[a] * z[d];
      row[EDGE_DOFS + 2 * a + d] = -p->M[a] * z[d];
    }
}

/* Global dofs of a slave edge, then of `nodes` master nodes from the start of edge `master`. */
static void LocalDofs(const LamMortarChains *chains, PetscInt edge, PetscInt master, PetscInt nodes, PetscInt dof[])
{
  const PetscInt first = 2 * (2 * chains->n + 1);

  for (PetscInt i = 0; i < EDGE_DOFS; ++i) dof[i] = 4 * edge + i;
  for (PetscInt i = 0; i < 2 * nodes; ++i) dof[EDGE_DOFS + i] = first + 4 * master + i;
}

/* M += c (a(x)b + b(x)a), upper triangle, local. */
static void AddSymmetric(PetscInt n, PetscReal c, const PetscReal a[], const PetscReal b[], PetscReal M[][BREAK_DOFS])
{
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = i; j < n; ++j) M[i][j] += c * (a[i] * b[j] + b[i] * a[j]);
}

static void ScatterHessian(PetscInt n, const PetscInt dof[], const PetscReal M[][BREAK_DOFS], PetscInt dofs,
                           PetscReal hessian[])
{
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = i; j < n; ++j) {
      hessian[dof[i] * dofs + dof[j]] += M[i][j];
      if (i != j) hessian[dof[j] * dofs + dof[i]] += M[i][j];
    }
}

/* The two hats on the half-edge `piece` and the interpolated multiplier with its slope. */
typedef struct {
  PetscInt piece;
  PetscReal phi[2], lambda, slope;
} Hats;

static Hats HatsAt(PetscInt piece, PetscReal s, const PetscReal lambda[])
{
  const PetscReal u = 2.0 * s - (PetscReal)piece;
  const Hats hats = {piece,
                     {1.0 - u, u},
                     (1.0 - u) * lambda[piece] + u * lambda[piece + 1],
                     2.0 * (lambda[piece + 1] - lambda[piece])};

  return hats;
}

/* Adds weight * phi_A * row to dG_A of both hats. */
static void AddGapRows(const Hats *hats, PetscReal weight, PetscInt n, const PetscInt dof[], const PetscReal row[],
                       PetscInt dofs, LamMortarResult *result)
{
  for (PetscInt k = 0; k < 2; ++k) {
    PetscReal *dgap = &result->dgap[(hats->piece + k) * dofs];

    for (PetscInt i = 0; i < n; ++i) dgap[dof[i]] += weight * hats->phi[k] * row[i];
  }
}

static void AddSegment(const LamMortarChains *chains, PetscReal from, PetscReal to, PetscInt master,
                       const PetscReal lambda[], PetscInt points, LamMortarResult *result)
{
  static const PetscReal x4[2] = {0.339981043584856265, 0.861136311594052575},
                         w4[2] = {0.652145154862546143, 0.347854845137453857};
  static const PetscReal x8[4] = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                  0.960289856497536232},
                         w8[4] = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                  0.101228536290376259};
  const PetscReal *x = points == 8 ? x8 : x4, *w = points == 8 ? w8 : w4;
  const PetscReal middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const PetscInt edge = (PetscInt)middle, piece = (PetscInt)(2.0 * middle), dofs = LamMortarDofs(chains->n, chains->m);
  PetscReal M[POINT_DOFS][BREAK_DOFS] = {{0}};
  PetscInt dof[POINT_DOFS];
  PetscBool loaded = (PetscBool)(lambda[piece] != 0.0 || lambda[piece + 1] != 0.0);

  LocalDofs(chains, edge, master, 3, dof);
  for (PetscInt q = 0; q < points; ++q) {
    const PetscReal s = middle + (q % 2 ? half : -half) * x[q / 2], weight = half * w[q / 2] * chains->J0[edge];
    const Hats hats = HatsAt(piece, s, lambda);
    PetscReal N[POINT_DOFS], T[POINT_DOFS], N0[POINT_DOFS] = {0};
    Point p;

    SetPoint(chains, edge, s, master, &p);
    RelativeRow(&p, p.normal, N);
    for (PetscInt k = 0; k < 2; ++k) {
      result->weight[piece + k] += weight * hats.phi[k];
      result->gap[piece + k] += weight * hats.phi[k] * p.g;
    }
    AddGapRows(&hats, weight, POINT_DOFS, dof, N, dofs, result);
    if (!loaded) continue;
    RelativeRow(&p, p.tau, T);
    for (PetscInt a = 0; a < 3; ++a)
      for (PetscInt d = 0; d < 2; ++d) N0[EDGE_DOFS + 2 * a + d] = p.dM[a] * p.normal[d];
    {
      const PetscReal c = -weight * hats.lambda / p.H;

      AddSymmetric(POINT_DOFS, c, N0, T, M);
      AddSymmetric(POINT_DOFS, 0.5 * c * p.g, N0, N0, M);
      AddSymmetric(POINT_DOFS, 0.5 * c * p.b_over_m, T, T, M);
    }
  }
  if (loaded) ScatterHessian(POINT_DOFS, dof, (const PetscReal(*)[BREAK_DOFS])M, dofs, result->hessian);
}

/* A moving break point: position on the slave, plane direction t, and rows of their variations; local dofs of
   BREAK_DOFS. */
typedef struct {
  PetscInt n; /* local dofs */
  PetscInt dof[BREAK_DOFS];
  PetscReal t[2], z[2], cs, Xss_t;
  PetscReal Xs[2], dN[3];                        /* of the slave edge */
  PetscReal R[2][BREAK_DOFS], dt[2][BREAK_DOFS]; /* d(X - y_v), dt_v */
  PetscReal zd2t[BREAK_DOFS][BREAK_DOFS];        /* z . second variation of t_v */
  PetscReal ds[BREAK_DOFS];
} Break;

/* Adds the unit tangent of one side, times `share`, to the plane direction of a vertex: t, dt and z.d2t. */
static void AddUnitTangent(const PetscReal y[][2], PetscReal eta, PetscReal share, PetscInt offset, Break *b)
{
  PetscReal N[3], dN[3], tau[2], unit[2], length, zu, rows[2][BREAK_DOFS] = {{0}}, ut[BREAK_DOFS], zt[BREAK_DOFS];

  LamEdgeShape(eta, N, dN);
  LamEdgeSum(y, dN, tau);
  length = PetscSqrtReal(LamDot(tau, tau));
  for (PetscInt d = 0; d < 2; ++d) unit[d] = tau[d] / length;
  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt d = 0; d < 2; ++d) rows[d][offset + 2 * a + d] = dN[a];
  zu = LamDot(b->z, unit);
  for (PetscInt i = 0; i < b->n; ++i) {
    ut[i] = unit[0] * rows[0][i] + unit[1] * rows[1][i];
    zt[i] = b->z[0] * rows[0][i] + b->z[1] * rows[1][i];
    for (PetscInt d = 0; d < 2; ++d) b->dt[d][i] += share * (rows[d][i] - unit[d] * ut[i]) / length;
  }
  for (PetscInt d = 0; d < 2; ++d) {
    b->t[d] += share * unit[d];
    AddSymmetric(b->n, -0.5 * share * zu / (length * length), rows[d], rows[d], b->zd2t);
  }
  AddSymmetric(b->n, -share / (length * length), ut, zt, b->zd2t);
  AddSymmetric(b->n, 1.5 * share * zu / (length * length), ut, ut, b->zd2t);
}

/* Cut of the plane of vertex v with the slave at s on `edge`. At the chain's ends the plane uses the unnormalised
   tangent. */
static void SetBreak(const LamMortarChains *chains, PetscInt v, PetscInt edge, PetscReal s, Break *b)
{
  const PetscBool end = (PetscBool)(v == 0 || v == chains->m);
  const PetscInt master = v == 0 ? 0 : v - 1; /* first of the local master nodes */
  const PetscInt vertex = v == 0 ? 0 : 2;     /* local master node of the vertex */
  PetscReal X[2], curvature[2];
  Point p;

  PetscMemzero(b, sizeof(*b));
  b->n = end ? POINT_DOFS : BREAK_DOFS;
  LocalDofs(chains, edge, master, end ? 3 : 5, b->dof);
  SetSlave(chains, edge, s, &p, X);
  for (PetscInt d = 0; d < 2; ++d) {
    b->z[d] = X[d] - chains->y[2 * v][d];
    for (PetscInt a = 0; a < 3; ++a) b->R[d][2 * a + d] = p.N[a];
    b->R[d][EDGE_DOFS + 2 * vertex + d] = -1.0;
  }
  if (end) {
    PetscReal N[3], dN[3];

    LamEdgeShape(v == 0 ? -1.0 : 1.0, N, dN);
    LamEdgeSum(&chains->y[2 * master], dN, b->t);
    for (PetscInt a = 0; a < 3; ++a)
      for (PetscInt d = 0; d < 2; ++d) b->dt[d][EDGE_DOFS + 2 * a + d] = dN[a];
  } else {
    AddUnitTangent(&chains->y[2 * (v - 1)], 1.0, 0.5, EDGE_DOFS, b);
    AddUnitTangent(&chains->y[2 * v], -1.0, 0.5, EDGE_DOFS + 4, b);
  }
  LamEdgeCurvature(&chains->x[2 * edge], curvature);
  for (PetscInt d = 0; d < 2; ++d) b->Xs[d] = p.Xs[d];
  for (PetscInt a = 0; a < 3; ++a) b->dN[a] = p.dN[a];
  b->cs = LamDot(p.Xs, b->t);
  b->Xss_t = 4.0 * LamDot(curvature, b->t);
  for (PetscInt i = 0; i < b->n; ++i) {
    b->ds[i] = 0.0;
    for (PetscInt d = 0; d < 2; ++d) b->ds[i] -= (b->t[d] * b->R[d][i] + b->z[d] * b->dt[d][i]) / b->cs;
  }
}

/* M += c d2s of a cut. */
static void AddSecondMotion(const Break *b, PetscReal c, PetscReal M[][BREAK_DOFS])
{
  PetscReal cq[BREAK_DOFS] = {0};
  const PetscReal f = -c / b->cs;

  for (PetscInt i = 0; i < b->n; ++i) cq[i] = b->Xs[0] * b->dt[0][i] + b->Xs[1] * b->dt[1][i];
  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt d = 0; d < 2; ++d) cq[2 * a + d] += 2.0 * b->dN[a] * b->t[d];
  AddSymmetric(b->n, 0.5 * f * b->Xss_t, b->ds, b->ds, M);
  AddSymmetric(b->n, f, cq, b->ds, M);
  for (PetscInt d = 0; d < 2; ++d) AddSymmetric(b->n, f, b->R[d], b->dt[d], M);
  for (PetscInt i = 0; i < b->n; ++i)
    for (PetscInt j = i; j < b->n; ++j) M[i][j] += f * b->zd2t[i][j];
}

/* Motion of a break point: the cut of a master vertex, composed with the ramp at an end of the overlap. */
typedef struct {
  PetscInt vertex, edge, piece;
  PetscReal s, cut;
  PetscReal slope, bend; /* ds/dcut, d2s/dcut2 */
  PetscInt sides;        /* master edges that meet there */
  PetscInt master[2];
  PetscReal sign[2]; /* of the integrals over them */
} Motion;

static Motion FindMotion(const LamMortarChains *chains, const LamMortarSegments *segments, PetscInt k)
{
  /* a point on the same half-edge, inside the overlap */
  const PetscReal inside = 0.5 * (segments->s[k] + segments->s[k + 1 < segments->count ? k + 1 : k - 1]);
  const PetscInt v = segments->vertex[k];
  Motion motion = {
      v,          (PetscInt)inside, (PetscInt)(2.0 * inside), segments->s[k], segments->cut[v], 1.0, 0.0, 2,
      {v - 1, v}, {-1.0, 1.0}};

  if (v == 0 || v == chains->m) {
    const PetscReal *ramp = segments->ramp[v == 0 ? 1 : 0];

    motion.slope = ramp[0];
    motion.bend = v == 0 ? -ramp[1] : ramp[1];
    motion.sides = 1;
    motion.master[0] = v == 0 ? 0 : chains->m - 1;
    motion.sign[0] = v == 0 ? 1.0 : -1.0;
  }
  return motion;
}

/*
  The terms of a moving break point, with [q] = sum of sign * q over the master edges that meet there:
    dG_A   phi_A [gamma] ds,
    d2     lambda sym([N], ds) + (lambda [gamma_s] + lambda' [gamma]) ds(x)ds + lambda [gamma] d2s.
  Interior vertex v: edge v (sign +) minus edge v-1. Ends of the overlap: one edge, + at the upper end, - at the lower.
*/
static void AddBreak(const LamMortarChains *chains, const Motion *motion, const PetscReal lambda[],
                     LamMortarResult *result)
{
  const PetscInt dofs = LamMortarDofs(chains->n, chains->m);
  const PetscReal J0 = chains->J0[motion->edge];
  const Hats hats = HatsAt(motion->piece, motion->s, lambda);
  PetscReal M[BREAK_DOFS][BREAK_DOFS] = {{0}}, gamma = 0.0, gamma_s = 0.0, N[BREAK_DOFS] = {0}, ds[BREAK_DOFS];
  Break b;

  SetBreak(chains, motion->vertex, motion->edge, motion->cut, &b);
  for (PetscInt k = 0; k < motion->sides; ++k) {
    PetscReal row[POINT_DOFS];
    Point p;

    SetPoint(chains, motion->edge, motion->s, motion->master[k], &p);
    RelativeRow(&p, p.normal, row);
    gamma += motion->sign[k] * p.g;
    gamma_s += motion->sign[k] * LamDot(p.normal, p.Xs);
    for (PetscInt i = 0; i < EDGE_DOFS; ++i) {
      N[i] += motion->sign[k] * row[i];
      N[EDGE_DOFS + 4 * k + i] += motion->sign[k] * row[EDGE_DOFS + i];
    }
  }
  for (PetscInt i = 0; i < b.n; ++i) ds[i] = motion->slope * b.ds[i];
  AddGapRows(&hats, J0 * gamma, b.n, b.dof, ds, dofs, result);
  if (hats.lambda == 0.0 && hats.slope == 0.0) return;
  AddSymmetric(b.n, J0 * hats.lambda, N, ds, M);
  AddSymmetric(b.n, 0.5 * J0 * (hats.lambda * gamma_s + hats.slope * gamma), ds, ds, M);
  AddSecondMotion(&b, J0 * hats.lambda * gamma * motion->slope, M);
  AddSymmetric(b.n, 0.5 * J0 * hats.lambda * gamma * motion->bend, b.ds, b.ds, M);
  ScatterHessian(b.n, b.dof, (const PetscReal(*)[BREAK_DOFS])M, dofs, result->hessian);
}

void LamMortarEvaluate(const LamMortarChains *chains, const LamMortarSegments *segments, const PetscReal lambda[],
                       PetscInt points, LamMortarResult *result)
{
  const PetscInt hats = 2 * chains->n + 1, dofs = LamMortarDofs(chains->n, chains->m), count = segments->count;

  PetscArrayzero(result->weight, hats);
  PetscArrayzero(result->gap, hats);
  PetscArrayzero(result->dgap, hats * dofs);
  PetscArrayzero(result->hessian, dofs * dofs);
  for (PetscInt k = 0; k + 1 < count; ++k)
    if (segments->s[k + 1] - segments->s[k] > LAM_SHORT_SEGMENT)
      AddSegment(chains, segments->s[k], segments->s[k + 1], segments->master[k], lambda, points, result);
  for (PetscInt k = 0; k < count; ++k)
    if (segments->vertex[k] >= 0) {
      const Motion motion = FindMotion(chains, segments, k);

      AddBreak(chains, &motion, lambda, result);
    }
}

void LamMortarSlavePoint(const LamMortarChains *chains, PetscReal s, PetscReal X[2], PetscReal Xs[2])
{
  Point p;

  SetSlave(chains, PetscMin((PetscInt)s, chains->n - 1), s, &p, X);
  for (PetscInt d = 0; d < 2; ++d) Xs[d] = p.Xs[d];
}

PetscReal LamMortarGap(const LamMortarChains *chains, PetscReal s, PetscInt edge, PetscReal nearest[2])
{
  Point p;

  SetPoint(chains, PetscMin((PetscInt)s, chains->n - 1), s, edge, &p);
  LamEdgeSum(&chains->y[2 * edge], p.M, nearest);
  return p.g;
}

PetscReal LamMortarDistance(const LamMortarChains *chains, PetscReal s, PetscInt edge)
{
  const PetscReal(*y)[2] = &chains->y[2 * edge];
  PetscReal X[2], at[2], M[3], dM[3];
  Point p;

  SetSlave(chains, PetscMin((PetscInt)s, chains->n - 1), s, &p, X);
  LamEdgeShape(PetscMax(-1.0, PetscMin(1.0, Project(y, X))), M, dM);
  LamEdgeSum(y, M, at);
  return hypot(X[0] - at[0], X[1] - at[1]);
}
