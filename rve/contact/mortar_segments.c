/*
  Break points of the mortar integrals.

  Method. A plane through each master vertex, along the mean of the unit tangents that meet there (at the chain's ends
  the one-sided tangent), cuts the slave chain at the root of a quadratic. The planes of the end vertices bound the
  overlap. When such a cut passes the slave's own end, at distance u, the end of the overlap follows the ramp h(u)
  instead of max(u, 0): h = 0 for u <= 0, u^2 (2 w - u)/w^2 up to the width w, u beyond. The potential then has a
  continuous gradient there; with the kink of max(u, 0), Newton's method cycles between a moving and a fixed end.
*/
#include "mortar_impl.h"

#define RAMP 0.1 /* w, in edges; less than one half */

PetscErrorCode LamMortarSegmentsCreate(PetscInt n, PetscInt m, LamMortarSegments *segments)
{
  const PetscInt most = 2 * n + 1 + m + 1;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(m + 1, &segments->cut, m + 1, &segments->is_cut, most, &segments->s, most, &segments->vertex,
                         most, &segments->master));
  segments->count = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMortarSegmentsDestroy(LamMortarSegments *segments)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(segments->cut, segments->is_cut, segments->s, segments->vertex, segments->master));
  PetscFunctionReturn(0);
}

/* Direction of the plane through vertex v: the mean unit tangent. */
static void PlaneDirection(const LamMortarChains *chains, PetscInt v, PetscReal t[2])
{
  t[0] = t[1] = 0.0;
  for (PetscInt side = 0; side < 2; ++side) {
    const PetscInt edge = v - 1 + side;
    PetscReal tau[2], length;

    if (edge < 0 || edge >= chains->m) continue;
    LamEdgeTangent(&chains->y[2 * edge], side == 0 ? 1.0 : -1.0, tau);
    length = PetscSqrtReal(LamDot(tau, tau));
    for (PetscInt d = 0; d < 2; ++d) t[d] += tau[d] / length;
  }
}

/* Root in (-1, 1) of the quadratic with values c0 > 0 at -1, c at 0, c1 <= 0 at 1. */
static PetscReal FallingRoot(PetscReal c0, PetscReal c, PetscReal c1)
{
  const PetscReal A = 0.5 * (c0 + c1) - c, B = 0.5 * (c1 - c0);

  return -2.0 * c / (B - PetscSqrtReal(PetscMax(0.0, B * B - 4.0 * A * c)));
}

/* Finds the cut of the plane of vertex v with the slave. */
static void FindCut(const LamMortarChains *chains, PetscInt v, LamMortarSegments *segments)
{
  const PetscReal expected = (PetscReal)chains->n * (1.0 - (PetscReal)v / (PetscReal)chains->m);
  PetscReal t[2], side[3], best = PETSC_INFINITY;

  PlaneDirection(chains, v, t);
  segments->is_cut[v] = PETSC_FALSE;
  segments->cut[v] = 0.0;
  for (PetscInt e = 0; e < chains->n; ++e) {
    for (PetscInt a = 0; a < 3; ++a) {
      const PetscReal z[2] = {chains->x[2 * e + a][0] - chains->y[2 * v][0],
                              chains->x[2 * e + a][1] - chains->y[2 * v][1]};

      side[a] = LamDot(z, t);
    }
    if (e == chains->n - 1 && !segments->is_cut[v] && side[2] > 0.0) segments->cut[v] = (PetscReal)chains->n;
    if (side[0] > 0.0 && side[2] <= 0.0) {
      const PetscReal s = (PetscReal)e + 0.5 * (1.0 + FallingRoot(side[0], side[1], side[2]));

      if (PetscAbsReal(s - expected) < best) {
        best = PetscAbsReal(s - expected);
        segments->cut[v] = s;
        segments->is_cut[v] = PETSC_TRUE;
      }
    }
  }
}

static void Insert(LamMortarSegments *segments, PetscReal s, PetscInt vertex)
{
  PetscInt at = segments->count++;

  for (; at > 0 && segments->s[at - 1] > s; --at) {
    segments->s[at] = segments->s[at - 1];
    segments->vertex[at] = segments->vertex[at - 1];
  }
  segments->s[at] = s;
  segments->vertex[at] = vertex;
}

/* Distance of the overlap's end from the slave's end if the cut is at distance u; slope[2]: h', h''. */
static PetscReal Ramp(PetscReal u, PetscReal slope[2])
{
  slope[0] = 1.0;
  slope[1] = 0.0;
  if (u >= RAMP) return u;
  slope[0] = u <= 0.0 ? 0.0 : u * (4.0 * RAMP - 3.0 * u) / (RAMP * RAMP);
  slope[1] = u <= 0.0 ? 0.0 : (4.0 * RAMP - 6.0 * u) / (RAMP * RAMP);
  return u <= 0.0 ? 0.0 : u * u * (2.0 * RAMP - u) / (RAMP * RAMP);
}

void LamMortarFindSegments(const LamMortarChains *chains, LamMortarSegments *segments)
{
  const PetscInt n = chains->n, m = chains->m;
  PetscReal lo, hi;
  PetscBool lo_moves, hi_moves;

  for (PetscInt v = 0; v <= m; ++v) FindCut(chains, v, segments);
  for (PetscInt v = 1; v <= m; ++v)
    if (segments->cut[v] > segments->cut[v - 1]) { /* planes that cross before they reach a distant slave */
      segments->cut[v] = segments->cut[v - 1];
      segments->is_cut[v] = PETSC_FALSE;
    }
  lo = Ramp(segments->cut[m], segments->ramp[0]);
  lo_moves = (PetscBool)(segments->is_cut[m] && lo > 0.0);
  hi = (PetscReal)n - Ramp((PetscReal)n - segments->cut[0], segments->ramp[1]);
  hi_moves = (PetscBool)(segments->is_cut[0] && hi < (PetscReal)n);
  segments->count = 0;
  if (!(hi - lo > RAMP)) return;
  Insert(segments, lo, lo_moves ? m : -1);
  Insert(segments, hi, hi_moves ? 0 : -1);
  for (PetscInt j = 0; j <= 2 * n; ++j)
    if (0.5 * (PetscReal)j > lo + LAM_SHORT_SEGMENT && 0.5 * (PetscReal)j < hi - LAM_SHORT_SEGMENT)
      Insert(segments, 0.5 * (PetscReal)j, -1);
  for (PetscInt v = 1; v < m; ++v)
    if (segments->is_cut[v] && segments->cut[v] > lo + LAM_SHORT_SEGMENT && segments->cut[v] < hi - LAM_SHORT_SEGMENT)
      Insert(segments, segments->cut[v], v);
  for (PetscInt k = 0; k + 1 < segments->count; ++k) {
    const PetscReal middle = 0.5 * (segments->s[k] + segments->s[k + 1]);
    PetscInt edge = -1;

    for (PetscInt v = 0; v <= m; ++v) edge += segments->cut[v] >= middle;
    segments->master[k] = PetscMin(PetscMax(edge, 0), m - 1);
  }
}
