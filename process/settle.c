/*
  Equilibrium at an instant: at the start, and after a jump.

  Newton's method for the free components of F and, unless prescribed, the turgor p. Equations

    P_i(F, p) = given stress,      and one of   v(F, p) = V,   sigma (pi(v) - pi_out) = p,

  with the derivatives of the response. If the conditions are far from the previous ones, they are approached in steps
  along the straight line between the two; a step is halved if its iteration fails.
*/
#include "process_impl.h"
#include <math.h>
#include <petscblaslapack.h>

enum { MAX_ITERATIONS = 12, MAX_HALVINGS = 20, MAX_TRIES = 60, MOST = 10 };
#define EXACT 1e-10  /* tolerance of the residual: stress in C1 + C2, volume in V0 */
#define FARTHEST 0.3 /* largest change of a component of F in one iteration */

/* Unknown components of F, which the turgor follows unless it is prescribed; and the conditions, those at the start of
   a segment. */
typedef struct {
  LamSettle kind;
  PetscInt n, component[9];
  LamSegment at;
} Problem;

static Problem MakeProblem(const LamSegment *segment, LamSettle kind)
{
  Problem problem = {.kind = kind, .at = *segment};

  for (PetscInt i = 0; i < 9; i++)
    if (segment->given[i]) problem.component[problem.n++] = i;
  return problem;
}

static PetscInt Count(const Problem *u)
{
  return u->n + (u->kind == LAM_SETTLE_TURGOR ? 0 : 1);
}

/* Residual r and its derivative K, column by column, at the tissue's F and turgor. */
static void Linearise(LamProcess process, const Problem *u, const LamProcessTissue *tissue, const LamEvaluation *e,
                      PetscReal r[], PetscReal K[])
{
  const LamResponse *response = &e->response;
  const PetscInt n = Count(u);

  for (PetscInt a = 0; a < u->n; a++) {
    const PetscInt i = u->component[a];

    r[a] = response->P[i] - u->at.P[i].from;
    for (PetscInt b = 0; b < u->n; b++) K[b * n + a] = LamProcessStiffness(process, e, i, u->component[b]);
    if (n > u->n) K[u->n * n + a] = response->P_turgor[i];
  }
  if (n == u->n) return;
  const PetscReal lumen = -response->energy_turgor;
  PetscReal slope = 1; /* derivative of the equation with respect to the lumen */
  LamFlow flow;

  K[u->n * n + u->n] = -response->energy_turgor2;
  r[u->n] = lumen - tissue->water;
  if (u->kind == LAM_SETTLE_OSMOSIS) {
    LamProcessFlow(process, &process->cells, e, lumen, tissue->turgor, &flow);
    r[u->n] = flow.drive;
    slope = flow.drive_water;
    K[u->n * n + u->n] = -slope * response->energy_turgor2 + flow.drive_turgor;
  }
  for (PetscInt b = 0; b < u->n; b++) K[b * n + u->n] = slope * LamProcessLumenSlope(process, e, u->component[b]);
}

static PetscReal Norm(PetscInt n, const PetscReal r[])
{
  PetscReal largest = 0;

  for (PetscInt a = 0; a < n; a++) largest = PetscMax(largest, PetscAbsReal(r[a]));
  return largest;
}

/* Solves K d = r in place; *ok: K is regular and d finite. */
static PetscErrorCode SolveDense(PetscInt n, PetscReal K[], PetscReal r[], PetscBool *ok)
{
  PetscBLASInt size = (PetscBLASInt)n, one = 1, pivots[MOST], info;

  PetscFunctionBeginUser;
  LAPACKgesv_(&size, &one, K, &size, pivots, r, &size, &info);
  *ok = (PetscBool)(info == 0 && isfinite(Norm(n, r)));
  PetscFunctionReturn(0);
}

/* A detached protoplast in equilibrium with the surroundings: pi (V - V_b) is constant. */
static void FillOsmometer(LamProcess process, const LamEvaluation *e, LamProcessTissue *tissue)
{
  const PetscReal dead = process->spec->water.non_osmotic * process->cells.water;
  LamFlow flow;

  LamProcessFlow(process, &process->cells, e, tissue->water, 0, &flow);
  if (flow.osmotic > 0) /* unbounded in pure water: limited to more than any lumen */
    tissue->water = dead + (tissue->water - dead) * flow.osmotic / PetscMax(e->outside, 1e-9 * flow.osmotic);
}

/* Newton's method under the conditions from the tissue's state, which is replaced on success. */
static PetscErrorCode Iterate(LamProcess process, const Problem *u, PetscBool *ok)
{
  const PetscInt n = Count(u);
  LamProcessTissue tissue = process->tissue;
  PetscReal r[MOST], K[MOST * MOST], before = PETSC_INFINITY;
  LamEvaluation e;

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  for (PetscInt i = 0; i < 9; i++)
    if (!u->at.given[i]) tissue.F[i] = u->at.F[i].from;
  if (u->kind == LAM_SETTLE_TURGOR) tissue.turgor = u->at.turgor.from;
  for (PetscInt it = 0; it < MAX_ITERATIONS; it++) {
    PetscCall(LamProcessEvaluate(process, tissue.time, tissue.x, tissue.F, tissue.turgor, &e));
    if (!e.ok) PetscFunctionReturn(0);
    e.temperature = u->at.temperature.from;
    e.outside = u->at.outside.from;
    Linearise(process, u, &tissue, &e, r, K);
    const PetscReal norm = Norm(n, r);
    if (norm <= EXACT || (norm <= 1e3 * EXACT && norm >= 0.5 * before)) {
      *ok = PETSC_TRUE;
      break;
    }
    before = norm;
    if (!n) break;
    PetscCall(SolveDense(n, K, r, ok));
    if (!*ok || Norm(u->n, r) > FARTHEST) {
      *ok = PETSC_FALSE;
      PetscCall(PetscStrncpy(process->trouble, "the stiffness against what is free is singular, or nearly so",
                             sizeof(process->trouble)));
      PetscFunctionReturn(0);
    }
    *ok = PETSC_FALSE;
    for (PetscInt a = 0; a < u->n; a++) tissue.F[u->component[a]] -= r[a];
    if (n > u->n) tissue.turgor -= r[u->n];
  }
  if (!*ok) {
    PetscCall(PetscStrncpy(process->trouble, "Newton's method finds no equilibrium", sizeof(process->trouble)));
    PetscFunctionReturn(0);
  }
  if (u->kind != LAM_SETTLE_WATER && !process->plasmolysed) tissue.water = -e.response.energy_turgor;
  if (process->plasmolysed && !isfinite(process->spec->water.permeability)) FillOsmometer(process, &e, &tissue);
  tissue.temperature = u->at.temperature.from;
  tissue.outside = u->at.outside.from;
  process->tissue = tissue;
  PetscFunctionReturn(0);
}

static PetscReal Between(const LamRamp *from, const LamRamp *to, PetscReal s)
{
  return (1 - s) * from->from + s * to->from;
}

/* Sets the conditions at a fraction s of the straight line between two. */
static void SetConditions(const LamSegment *from, const LamSegment *to, PetscReal s, LamSegment *at)
{
  at->turgor.from = Between(&from->turgor, &to->turgor, s);
  at->temperature.from = Between(&from->temperature, &to->temperature, s);
  at->outside.from = Between(&from->outside, &to->outside, s);
  for (int i = 0; i < 9; i++) {
    at->F[i].from = Between(&from->F[i], &to->F[i], s);
    at->P[i].from = Between(&from->P[i], &to->P[i], s);
  }
}

PetscErrorCode LamProcessSettle(LamProcess process, LamSettle kind, const LamSegment *from, PetscBool *ok)
{
  const LamSegment *to = &process->segment;
  const LamProcessTissue start = process->tissue;
  Problem problem = MakeProblem(to, kind);
  PetscReal done = 0, step = 1;
  PetscInt tries = 0;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  while (done < 1) {
    const PetscReal next = PetscMin(1, done + step);

    SetConditions(from ? from : to, to, next, &problem.at);
    PetscCall(Iterate(process, &problem, ok));
    if (process->stop && process->stop()) process->stopped = PETSC_TRUE;
    if (*ok) {
      if (kind != LAM_SETTLE_TURGOR && process->tissue.turgor < -LamPlasmolysisTolerance(process) * process->pressure)
        break; /* the membranes detach */
      done = next;
      step *= 2;
      continue;
    }
    step = 0.5 * (next - done);
    if (process->stopped || step < PetscPowRealInt(0.5, MAX_HALVINGS) || ++tries > MAX_TRIES) break;
  }
  if (!*ok) process->tissue = start;
  if (*ok && process->has_history) PetscCall(LamProcessAccept(process));
  PetscFunctionReturn(0);
}
