/*
  From a known state to contact equilibrium at a new load.

  Method. Starts are tried in this order until one ends in a stable equilibrium:
    (i)   a near state: the contact state before, turned and moved affinely, with its multipliers;
    (ii)  the strategy's start: two_step solves the bonded tissue at the load and releases it, with the tractions that
          bonding carried as first multipliers; one_step starts from the affine state;
    (iii) coming down: contact that a larger cohesion holds tight is easy to reach; from there the cohesion is lowered
          to the asked one, each solution starting the next;
    (iv)  substeps in load from the contact state before.
  A converged state with a negative eigenvalue on its active set is a saddle and is left along its unstable mode.

  Mihai, Safar & Wyatt, J. Eng. Math. (successive deformation decomposition) for (ii); docs/theory.md, turgor and
  cohesion act through their sum, for (iii).
*/
#include "rve_impl.h"

#define NEAR 0.04           /* largest change of F (and of turgor and cohesion) that counts as near */
#define TIGHT 0.5          /* cohesion that is added first, C1 + C2 */
#define LOOSE 1e-3         /* of it: from here the rest is taken away at once */
#define LEAST_EASE 0.85    /* nearer to 1 it is given up */
#define EASE 0.25          /* first factor by which it is lowered */
#define REACH 0.5          /* apothems: a larger step from a near start leads nowhere */
#define RELEASE_REACH 0.1  /* the same for the first step of a release */
#define LEAST_RELEASE 0.06 /* smaller shares: descent takes over */
#define MIN_SUBSTEP (1.0 / 64.0)
#define MAX_BRANCH_SWITCHES 4
#define SHALLOW 0.03       /* apothems: penetration that the mesh explains ... */
#define SHALLOW_SHARE 0.25 /* ... and in wall thicknesses */
#define KICK 0.01          /* apothems: start along an unstable mode */

/* A solution to start from. */
typedef struct {
  LamLoad load;
  PetscReal *y, *lambda;
} Solution;

static PetscErrorCode SolutionCreate(LamRVE rve, Solution *solution)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(rve->ndof, &solution->y, rve->contact->count, &solution->lambda));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolutionDestroy(Solution *solution)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(solution->y, solution->lambda));
  PetscFunctionReturn(0);
}

static PetscErrorCode Save(LamRVE rve, const LamLoad *load, Solution *solution)
{
  PetscFunctionBeginUser;
  solution->load = *load;
  PetscCall(PetscArraycpy(solution->y, rve->y, rve->ndof));
  PetscCall(PetscArraycpy(solution->lambda, rve->contact->lambda, rve->contact->count));
  PetscFunctionReturn(0);
}

/* What a try ended in. */
typedef struct {
  PetscBool converged;
  PetscInt negative, branch;
  PetscReal overlap; /* depth of a wall inside another cell, where it is too deep to be an answer */
  PetscInt pair[2];  /* these cells */
} Outcome;

/* Leaves saddles along their unstable mode. Ends with the consistent tangent factored. */
static PetscErrorCode LeaveSaddle(LamRVE rve, const LamLoad *load, Outcome *out)
{
  const PetscInt positions = rve->linear.positions;
  PetscReal *mode;

  PetscFunctionBeginUser;
  PetscCall(LamFactorConsistent(rve, load, &out->negative, &out->converged));
  PetscCall(PetscMalloc1(rve->linear.n, &mode));
  for (PetscInt k = 0; k < MAX_BRANCH_SWITCHES && out->converged && out->negative > 0; ++k) {
    LamNewtonOutcome outcome;
    PetscReal largest = 0.0;

    PetscCall(LamSoftestMode(rve, &rve->lowest_eigenvalue, mode));
    for (PetscInt i = 0; i < positions; ++i) largest = PetscMax(largest, PetscAbsReal(mode[i]));
    if (rve->monitor)
      PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                             "  saddle: %d negative eigenvalues, lowest %.3e; leaving it\n", (int)out->negative,
                             (double)rve->lowest_eigenvalue));
    for (PetscInt i = 0; i < positions; ++i) rve->y[2 + i] += KICK * mode[i] / largest;
    PetscCall(LamContactNewton(rve, load, REACH, &outcome));
    out->converged = (PetscBool)(outcome == LAM_NEWTON_CONVERGED);
    if (out->converged) {
      ++out->branch;
      PetscCall(LamFactorConsistent(rve, load, &out->negative, &out->converged));
    }
  }
  PetscCall(PetscFree(mode));
  PetscFunctionReturn(0);
}

static PetscErrorCode Try(LamRVE rve, const LamLoad *load, PetscReal reach, Outcome *out)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  *out = (Outcome){0};
  PetscCall(LamContactNewton(rve, load, reach, &outcome));
  out->converged = (PetscBool)(outcome == LAM_NEWTON_CONVERGED);
  if (out->converged) PetscCall(LeaveSaddle(rve, load, out));
  PetscFunctionReturn(0);
}

/* A state in which cells lie in each other is none. */
static PetscErrorCode RefuseOverlap(LamRVE rve, const LamLoad *load, Outcome *out)
{
  PetscReal depth;

  PetscFunctionBeginUser;
  if (!out->converged) PetscFunctionReturn(0);
  PetscCall(LamFindOverlap(rve, load->F, rve->y, &depth, out->pair));
  if (depth <= PetscMax(SHALLOW, SHALLOW_SHARE * rve->micro.wall_thickness)) PetscFunctionReturn(0);
  out->converged = PETSC_FALSE;
  out->overlap = depth;
  PetscFunctionReturn(0);
}

/* The same by descent. */
static PetscErrorCode Descend(LamRVE rve, const LamLoad *load, Outcome *out)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(LamContactNewtonSafe(rve, load, &outcome));
  *out = (Outcome){.converged = (PetscBool)(outcome == LAM_NEWTON_CONVERGED)};
  if (out->converged) PetscCall(LeaveSaddle(rve, load, out));
  PetscFunctionReturn(0);
}

static PetscBool IsStable(const Outcome *out)
{
  return (PetscBool)(out->converged && out->negative <= 0);
}

/* Positions of the bonded solution, and its wall stresses. */
static void TakeBondedPositions(LamRVE rve, const LamLoad *load)
{
  const LamMesh *mesh = &rve->mesh, *bonded = &rve->bonded->mesh;

  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    const PetscReal *S = &bonded->shift[2 * i], *position = &rve->bonded->y[2 * bonded->node_class[i]];

    for (PetscInt d = 0; d < 2; ++d)
      rve->y[2 * mesh->node_class[i] + d] = position[d] + load->F[3 * d] * S[0] + load->F[3 * d + 1] * S[1];
  }
  (void)LamSetConsistentStresses(rve, load, rve->y);
}

/*
  Multipliers that fit the forces r that bonding carried, B^T lambda = r, in least squares: the solution of
  [1 -B^T; -B 0] [v; lambda] = [-r; 0]. Those in tension become zero.
*/
static PetscErrorCode FitMultipliers(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  LamContact *contact = rve->contact;
  const PetscInt positions = rve->linear.positions;
  PetscReal energy, *rhs, *solution;
  PetscInt negative;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(contact->lambda, contact->count));
  PetscCall(LamContactEvaluate(rve, load, rve->y, PETSC_TRUE));
  PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
  for (PetscInt h = 0; h < contact->count; ++h) contact->active[h] = (PetscBool)(contact->weight[h] > 0.0);
  PetscCall(PetscArrayzero(rve->linear.values, rve->linear.nonzeros));
  LamContactSetRows(rve, 0.0);
  PetscCall(LamLinearFactor(&rve->linear, 1.0, &negative, ok));
  ++rve->work.factorisations;
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(rve->linear.n, &rhs, rve->linear.n, &solution));
  for (PetscInt i = 0; i < positions; ++i) rhs[i] = -rve->residual[i + 2];
  PetscCall(LamLinearSolve(&rve->linear, 1, rhs, solution));
  for (PetscInt h = 0; h < contact->count; ++h)
    contact->lambda[h] = contact->active[h] ? PetscMax(0.0, solution[positions + h]) : 0.0;
  PetscCall(PetscFree2(rhs, solution));
  PetscFunctionReturn(0);
}

/* Step one of two: the bonded tissue at `load`; *ok where it has an equilibrium. Once per state. */
static PetscErrorCode SolveBonded(LamRVE rve, const LamLoad *load, LamRVEState bonded, PetscBool *ok)
{
  LamResponse response;

  PetscFunctionBeginUser;
  PetscCall(LamRVESetMonitor(rve->bonded, rve->monitor));
  PetscCall(LamRVESolve(rve->bonded, load, bonded, &response));
  rve->work.iterations += response.newton_iterations;
  rve->work.factorisations += response.factorisations;
  *ok = LamResponseHasFields(&response);
  PetscFunctionReturn(0);
}

/* From a solution, moved affinely to the new load. */
static PetscErrorCode StartNear(LamRVE rve, const Solution *from, const LamLoad *load)
{
  PetscFunctionBeginUser;
  LamMoveAffinely(rve, from->y, &from->load, load);
  PetscCall(PetscArraycpy(rve->contact->lambda, from->lambda, rve->contact->count));
  PetscFunctionReturn(0);
}

/* rve->y: the bonded solution; contact->held: what bonding carries and the fitted multipliers do not. */
static PetscErrorCode StartBonded(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  PetscReal energy;
  PetscBool valid;

  PetscFunctionBeginUser;
  TakeBondedPositions(rve, load);
  PetscCall(FitMultipliers(rve, load, ok));
  PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->contact->held, &valid));
  LamContactAddForce(rve, rve->contact->held);
  PetscFunctionReturn(0);
}

/* One release from `share` to rve->contact->share, the last one to a stable state at the load. */
static PetscErrorCode ReleaseTo(LamRVE rve, const LamLoad *load, PetscReal reach, Outcome *out, PetscBool *reached)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  if (rve->contact->share == 0.0) {
    PetscCall(Try(rve, load, reach, out));
    *reached = IsStable(out);
  } else {
    PetscCall(LamContactNewton(rve, load, reach, &outcome));
    *reached = (PetscBool)(outcome == LAM_NEWTON_CONVERGED);
  }
  PetscFunctionReturn(0);
}

/*
  Step two of two: releases the interface. The forces that bonding carried and contact does not are taken away at once
  where that moves little, else in shares, so that every Newton iteration starts near its solution and takes full steps.
  Where small shares fail, too, descent takes over.
*/
static PetscErrorCode Release(LamRVE rve, const LamLoad *load, Solution *at, Outcome *out)
{
  PetscReal share = 1.0, step = 1.0;
  PetscBool ok;

  PetscFunctionBeginUser;
  *out = (Outcome){0};
  PetscCall(StartBonded(rve, load, &ok));
  if (!ok) PetscFunctionReturn(0);
  PetscCall(Save(rve, load, at));
  while (share > 0.0 && rve->work.iterations < LAM_ITERATION_BUDGET) {
    const PetscInt iterations = rve->work.iterations;
    PetscBool reached = PETSC_FALSE;

    rve->contact->share = PetscMax(0.0, share - step);
    PetscCall(ReleaseTo(rve, load, RELEASE_REACH, out, &reached));
    if (reached) {
      share = rve->contact->share;
      PetscCall(Save(rve, load, at));
      step *= 2.0;
      continue;
    }
    /* the first linear step tells how much of it is near */
    step *= rve->work.iterations == iterations
                ? PetscMax(0.1, PetscMin(0.5, 0.6 * RELEASE_REACH / rve->contact->largest_step))
                : 0.5;
    PetscCall(StartNear(rve, at, load));
    if (step < LEAST_RELEASE) break;
  }
  rve->contact->share = 0.0;
  if (share > 0.0) PetscCall(Descend(rve, load, out));
  PetscFunctionReturn(0);
}

/* rve->y := F X, stress-free walls, multipliers that balance turgor and cohesion. */
static PetscErrorCode StartAffine(LamRVE rve, const LamLoad *load)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < rve->mesh.class_count; ++c) {
    const PetscReal *X = &rve->mesh.class_X[2 * c];

    for (PetscInt d = 0; d < 2; ++d) rve->y[2 * c + d] = load->F[3 * d] * X[0] + load->F[3 * d + 1] * X[1];
  }
  PetscCall(PetscArrayzero(rve->stress, rve->mesh.element_count));
  for (PetscInt h = 0; h < rve->contact->count; ++h)
    rve->contact->lambda[h] = PetscMax(0.0, load->turgor + load->cohesion);
  PetscFunctionReturn(0);
}

/* Continuation from a solution to `load`, in halved steps where it fails. */
static PetscErrorCode Substeps(LamRVE rve, Solution *at, const LamLoad *load, Outcome *out)
{
  const LamLoad start = at->load;
  PetscReal reached = 0.0, step = 0.25;

  PetscFunctionBeginUser;
  *out = (Outcome){0};
  while (reached < 1.0 && rve->work.iterations < LAM_ITERATION_BUDGET) {
    const PetscReal t = PetscMin(1.0, reached + step);
    const LamLoad next = t >= 1.0 ? *load : LamLoadBetween(&start, load, t);

    PetscCall(StartNear(rve, at, &next));
    PetscCall(Try(rve, &next, REACH, out));
    if (IsStable(out)) {
      PetscCall(Save(rve, &next, at));
      reached = t;
      step *= 2.0;
    } else {
      step *= 0.5;
      if (step < MIN_SUBSTEP) break;
    }
  }
  if (reached < 1.0) { /* a branch has ended: down to whatever comes next */
    PetscCall(StartNear(rve, at, load));
    PetscCall(Descend(rve, load, out));
    if (IsStable(out)) PetscFunctionReturn(0);
  }
  if (reached < 1.0) *out = (Outcome){0}; /* what there is belongs to another load */
  PetscFunctionReturn(0);
}

/* From a solution at a larger cohesion down to `load`. */
static PetscErrorCode ComeDown(LamRVE rve, const LamLoad *load, Solution *at, Outcome *out)
{
  PetscReal added = at->load.cohesion - load->cohesion, factor = EASE;
  LamLoad next = *load;

  PetscFunctionBeginUser;
  while (added > 0.0 && rve->work.iterations < LAM_ITERATION_BUDGET) {
    const PetscReal less = added * factor < LOOSE * TIGHT ? 0.0 : added * factor;

    next.cohesion = load->cohesion + less;
    PetscCall(StartNear(rve, at, &next));
    PetscCall(Try(rve, &next, REACH, out));
    if (IsStable(out)) {
      PetscCall(Save(rve, &next, at));
      added = less;
    } else {
      factor = PetscSqrtReal(factor);
      if (factor > LEAST_EASE) break;
    }
  }
  if (added > 0.0) {
    PetscCall(StartNear(rve, at, load));
    PetscCall(Descend(rve, load, out));
    if (IsStable(out)) PetscFunctionReturn(0);
  }
  if (added > 0.0) *out = (Outcome){0}; /* as in Substeps */
  PetscFunctionReturn(0);
}

/* Contact held tight by an added cohesion, at the asked F from the bonded or affine start, then let loose. */
static PetscErrorCode TightThenLoose(LamRVE rve, const LamLoad *load, PetscBool has_bonded, Solution *at, Outcome *out)
{
  LamLoad tight = *load;

  PetscFunctionBeginUser;
  tight.cohesion = load->cohesion + TIGHT;
  if (has_bonded) {
    PetscCall(Release(rve, &tight, at, out));
  } else {
    PetscCall(StartAffine(rve, &tight));
    PetscCall(Try(rve, &tight, LAM_FAR, out));
    PetscCall(Save(rve, &tight, at));
  }
  if (IsStable(out))
    PetscCall(ComeDown(rve, load, at, out));
  else
    *out = (Outcome){0};
  PetscFunctionReturn(0);
}

/* Tight contact from the undeformed (turned) tissue to the asked F in substeps, then let loose. */
static PetscErrorCode WalkThenLoose(LamRVE rve, const LamLoad *load, Solution *at, Outcome *out)
{
  const PetscReal angle = LamRotationAngle(load->F), c = PetscCosReal(angle), s = PetscSinReal(angle);
  LamLoad tight = *load, start;

  PetscFunctionBeginUser;
  tight.cohesion = load->cohesion + TIGHT;
  start = tight;
  start.F[0] = start.F[4] = c;
  start.F[1] = -s;
  start.F[3] = s;
  PetscCall(StartAffine(rve, &start));
  PetscCall(Try(rve, &start, LAM_FAR, out));
  if (IsStable(out)) {
    PetscCall(Save(rve, &start, at));
    PetscCall(Substeps(rve, at, &tight, out));
  }
  if (IsStable(out))
    PetscCall(ComeDown(rve, load, at, out));
  else
    *out = (Outcome){0};
  PetscFunctionReturn(0);
}

static PetscReal LoadDistance(const LamLoad *a, const LamLoad *b)
{
  PetscReal largest = PetscMax(PetscAbsReal(a->turgor - b->turgor), PetscAbsReal(a->cohesion - b->cohesion));

  for (PetscInt i = 0; i < 9; ++i) largest = PetscMax(largest, PetscAbsReal(a->F[i] - b->F[i]));
  return largest;
}

/* Remembers the first saddle found at the asked load: where nothing better comes, it is the answer. */
static PetscErrorCode KeepSaddle(LamRVE rve, const LamLoad *load, const Outcome *out, Outcome *kept, Solution *saddle)
{
  PetscFunctionBeginUser;
  if (kept->converged || !out->converged || out->negative <= 0) PetscFunctionReturn(0);
  PetscCall(Save(rve, load, saddle));
  *kept = *out;
  PetscFunctionReturn(0);
}

static PetscErrorCode GiveSaddle(LamRVE rve, const Solution *saddle, const Outcome *kept, Outcome *out)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(rve->y, saddle->y, rve->ndof));
  PetscCall(PetscArraycpy(rve->contact->lambda, saddle->lambda, rve->contact->count));
  PetscCall(LamContactEvaluate(rve, &saddle->load, rve->y, PETSC_TRUE));
  (void)LamContactFindActive(rve->contact, 0.0);
  *out = *kept;
  PetscCall(LamFactorConsistent(rve, &saddle->load, &out->negative, &out->converged));
  PetscFunctionReturn(0);
}

/* The strategy's start. */
static PetscErrorCode FirstTry(LamRVE rve, const LamLoad *load, LamRVEState state, PetscBool *has_bonded, Solution *at,
                               Outcome *out)
{
  PetscFunctionBeginUser;
  if (rve->strategy == LAM_TWO_STEP) PetscCall(SolveBonded(rve, load, state->bonded, has_bonded));
  if (*has_bonded) {
    PetscCall(Release(rve, load, at, out));
  } else {
    PetscCall(StartAffine(rve, load));
    PetscCall(Try(rve, load, LAM_FAR, out));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode TryAll(LamRVE rve, const LamLoad *load, LamRVEState state, Solution *before, Outcome *out)
{
  PetscBool has_bonded = PETSC_FALSE;
  Outcome kept = {0}, refused = {0};
  Solution at, saddle;

  PetscFunctionBeginUser;
  *out = (Outcome){0};
  if (state->solved && LoadDistance(&before->load, load) <= NEAR) {
    PetscCall(StartNear(rve, before, load));
    PetscCall(Try(rve, load, REACH, out));
    PetscCall(RefuseOverlap(rve, load, out));
    if (IsStable(out)) PetscFunctionReturn(0);
  }
  PetscCall(SolutionCreate(rve, &at));
  PetscCall(SolutionCreate(rve, &saddle));
  for (PetscInt k = 0; k < 4 && !IsStable(out); ++k) {
    PetscCall(KeepSaddle(rve, load, out, &kept, &saddle));
    *out = (Outcome){0};
    if (k == 0) PetscCall(FirstTry(rve, load, state, &has_bonded, &at, out));
    if (k == 1) PetscCall(TightThenLoose(rve, load, has_bonded, &at, out));
    if (k == 2) PetscCall(WalkThenLoose(rve, load, &at, out));
    if (k == 3 && state->solved) PetscCall(Substeps(rve, before, load, out));
    PetscCall(RefuseOverlap(rve, load, out));
    if (out->overlap > 0.0) refused = *out;
  }
  if (!IsStable(out)) *out = refused;
  if (!IsStable(out) && kept.converged) PetscCall(GiveSaddle(rve, &saddle, &kept, out));
  PetscCall(SolutionDestroy(&at));
  PetscCall(SolutionDestroy(&saddle));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  Solution before;
  Outcome out;

  PetscFunctionBeginUser;
  PetscCall(SolutionCreate(rve, &before));
  before.load = state->load;
  PetscCall(PetscArraycpy(before.y, state->y, rve->ndof));
  PetscCall(PetscArraycpy(before.lambda, state->lambda, rve->contact->count));
  LamRotatePositions(rve->ndof, before.y, before.load.F, LamRotationAngle(load->F) - LamRotationAngle(before.load.F));
  PetscCall(TryAll(rve, load, state, &before, &out));
  PetscCall(SolutionDestroy(&before));
  response->branch = state->branch + out.branch;
  response->negative_eigenvalues = PetscMax(0, out.negative);
  response->status = out.converged ? (out.negative > 0 ? LAM_UNSTABLE : LAM_CONVERGED) : LAM_NOT_CONVERGED;
  if (response->status == LAM_UNSTABLE)
    PetscCall(PetscSNPrintf(response->reason, sizeof(response->reason),
                            "only a saddle was found: %d negative eigenvalues, lowest %.3g (C1+C2)", (int)out.negative,
                            (double)rve->lowest_eigenvalue));
  if (response->status == LAM_NOT_CONVERGED && out.overlap > 0.0)
    PetscCall(
        PetscSNPrintf(response->reason, sizeof(response->reason),
                      "a wall of cell %d lies %.3g apothems inside cell %d: it meets a wall that it does not face, "
                      "which is not modelled, or the mesh along the faces is too coarse",
                      (int)out.pair[0], (double)out.overlap, (int)out.pair[1]));
  else if (response->status == LAM_NOT_CONVERGED)
    PetscCall(PetscSNPrintf(response->reason, sizeof(response->reason),
                            "no contact equilibrium found from any start, after %d iterations: give states in between",
                            (int)rve->work.iterations));
  PetscFunctionReturn(0);
}
