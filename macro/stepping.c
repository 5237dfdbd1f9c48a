/*
  Equilibrium of the body along its load program.

  Method. Newton's method with the consistent tangent, full steps; load steps with cutback.

  Algorithm.
  1. Inflation: only rigid motions are prescribed and the full turgor acts, first from an initial guess (inflation.c).
     Without `inflate` the turgor acts while the prescribed sides stay in the reference state; this is part of step 1.
  2. The prescribed displacements are measured from there and grow in `steps` equal steps. Sealed lumens are sealed
     after inflation; without `inflate` at F = 1 under the full turgor, at the start.
  3. If Newton fails, a material point has no response, or an iterate changes too much, the increment is halved, at
     most MAX_HALVINGS times; it is doubled again after each success.

  Convergence: norm of the residual <= RELATIVE_TOLERANCE times the norm of the element forces before summation at the
  nodes (largest in this series of iterations), or <= ABSOLUTE_TOLERANCE (C1 + C2) times the box's first edge. The
  latter is the rounding error in the stresses of responders; it matters only for a nearly unstressed body. If lumens
  are sealed, the norm of their volume errors is also <= RELATIVE_TOLERANCE times that of the water. Nodes at
  obstacles satisfy the contact conditions to PENETRATION macro lengths.

  Reference: Wriggers, Nonlinear Finite Element Methods, ch. 5.
*/
#include <math.h>
#include "clock.h"
#include "transport_impl.h"

static const PetscReal RELATIVE_TOLERANCE = 1e-9, ABSOLUTE_TOLERANCE = 1e-10, PENETRATION = 1e-10;
static const PetscReal ROUNDING = 1e-8; /* smaller residuals are not used for the order of convergence */
/* Tolerance after PATIENCE iterations if responses are interpolated and the body is at an instant (instant.c) or has
   pressures. It allows for the jumps of interpolated responses at boundaries between cells of a table and between
   neighbouring records. */
static const PetscReal LENIENT_TOLERANCE = 1e-6;
/* Of the equations of the water that moves through the body, over the sum of the sizes of their terms, of which the
   flows are differences: a thousandth of the other tolerance. The rest is closed at the end. */
static const PetscReal FLOW_TOLERANCE = 1e-12;
/* MOST_RELEASES: further iterations where nodes leave obstacles one by one (rows.c), chosen: about three for each. */
enum { MAX_HALVINGS = 8, MAX_ITERATIONS = 15, MOST_RELEASES = 25, PATIENCE = 6 };

/* State of the load program: fractions of the turgor and of the prescribed displacements. */
typedef struct {
  PetscReal turgor, load;
} Stage;

static PetscErrorCode FormResidual(SNES snes, Vec u, Vec residual, void *ctx)
{
  LamMacro macro = (LamMacro)ctx;
  PetscReal scale;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LamMacroEvaluate(macro, u, &ok));
  if (!ok) {
    PetscCall(VecZeroEntries(residual));
    PetscCall(SNESSetFunctionDomainError(snes));
    PetscFunctionReturn(0);
  }
  PetscCall(LamMacroAssembleForce(macro, macro->force, &scale));
  macro->force_scale = PetscMax(macro->force_scale, scale);
  PetscCall(LamMacroFlowReduce(macro, macro->force, &ok));
  if (!ok) PetscCall(SNESSetFunctionDomainError(snes));
  PetscCall(LamMacroExternalForce(macro, u, macro->external));
  PetscCall(VecWAXPY(residual, -LamMacroTractionFactor(macro), macro->external, macro->force));
  PetscCall(LamMacroBorderEquations(macro, u, residual));
  PetscCall(LamMacroConstrainResidual(macro, u, residual));
  PetscFunctionReturn(0);
}

static PetscErrorCode FormTangent(SNES snes, Vec u, Mat J, Mat preconditioner, void *ctx)
{
  LamMacro macro = (LamMacro)ctx;

  PetscFunctionBeginUser;
  /* SNES has just evaluated the residual at u: the stored responses belong to it */
  PetscCall(LamMacroAssembleTangent(macro, preconditioner));
  PetscCall(LamMacroAddTractionTangent(macro, u, preconditioner));
  PetscCall(LamMacroBorderDerivatives(macro, preconditioner));
  PetscCall(LamMacroConstrainTangent(macro, preconditioner));
  if (LamMacroFlows(macro)) PetscCall(LamMacroConstrainColumns(macro, macro->flow->to_force));
  PetscFunctionReturn(0);
}

static PetscErrorCode TestConvergence(SNES snes, PetscInt it, PetscReal xnorm, PetscReal ynorm, PetscReal fnorm,
                                      SNESConvergedReason *reason, void *ctx)
{
  LamMacro macro = (LamMacro)ctx;
  const PetscBool lenient = (PetscBool)(macro->lenient && it >= PATIENCE);
  const PetscReal tolerance = lenient ? LENIENT_TOLERANCE : RELATIVE_TOLERANCE,
                  scale = PetscMax(macro->force_scale, lenient ? macro->force_floor : 0);
  PetscReal sealed, flow;

  PetscFunctionBeginUser;
  *reason = SNES_CONVERGED_ITERATING;
  if (macro->thorough && it == 0 && !PetscIsInfOrNanReal(fnorm)) PetscFunctionReturn(0);
  for (PetscInt b = 0; b < macro->border_count; b++) fnorm = PetscMax(fnorm, PetscAbsReal(macro->borders[b].equation));
  if (PetscIsInfOrNanReal(fnorm))
    *reason = SNES_DIVERGED_FNORM_NAN;
  else if (macro->violation > PENETRATION)
    PetscFunctionReturn(0);
  else if (fnorm <= ABSOLUTE_TOLERANCE)
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (fnorm <= tolerance * scale)
    *reason = SNES_CONVERGED_FNORM_RELATIVE;
  if (*reason <= 0) PetscFunctionReturn(0);
  if (macro->obstacle_count && (macro->any_pulled || macro->any_regrip)) {
    macro->released = macro->pulled;
    macro->regrips = (PetscBool)!macro->any_pulled;
    *reason = SNES_CONVERGED_ITERATING;
    PetscFunctionReturn(0);
  }
  PetscCall(LamMacroSealedResidual(macro, &sealed));
  if (sealed > tolerance) *reason = SNES_CONVERGED_ITERATING;
  PetscCall(LamMacroFlowResidual(macro, &flow));
  if (flow > FLOW_TOLERANCE) *reason = SNES_CONVERGED_ITERATING;
  PetscFunctionReturn(0);
}

/*
  The first linear solution d of an increment is the tangent of the path at the last converged state. If the path
  reached that state in the same direction from a previous state, h load parameters before, then u_last - u_before =
  u' h - u'' h^2 / 2 gives its curvature, and the first iterate is u_last + d + u'' D^2 / 2, exact to the third order
  in the increment D:
    u'' D^2 / 2 = r d - r^2 (u_last - u_before),  r = D / h.
  No responder query is needed.
*/
static PetscErrorCode Predict(SNESLineSearch search, Vec x, Vec y, PetscBool *changed, void *ctx)
{
  LamMacro macro = (LamMacro)ctx;
  const PetscReal ratio = macro->prediction;

  PetscFunctionBeginUser;
  *changed = ratio > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*changed) PetscFunctionReturn(0);
  PetscCall(VecScale(y, 1 + ratio)); /* SNES subtracts y = -d */
  PetscCall(VecAXPBYPCZ(y, PetscSqr(ratio), -PetscSqr(ratio), 1, macro->u, macro->before));
  macro->prediction = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroNewtonCreate(LamMacro macro)
{
  SNESLineSearch search;
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(SNESCreate(macro->comm, &macro->snes));
  PetscCall(SNESSetOptionsPrefix(macro->snes, "macro_"));
  PetscCall(SNESSetType(macro->snes, SNESNEWTONLS));
  PetscCall(SNESSetFunction(macro->snes, macro->residual, FormResidual, macro));
  PetscCall(SNESSetJacobian(macro->snes, macro->tangent, macro->tangent, FormTangent, macro));
  PetscCall(SNESSetConvergenceTest(macro->snes, TestConvergence, macro, NULL));
  PetscCall(SNESSetConvergenceHistory(macro->snes, macro->history, NULL, PETSC_STATIC_ARRAY_LENGTH(macro->history),
                                      PETSC_TRUE));
  PetscCall(SNESGetLineSearch(macro->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  PetscCall(SNESLineSearchSetPreCheck(search, Predict, macro));
  PetscCall(SNESGetKSP(macro->snes, &ksp));
  PetscCall(LamMacroDirectSolver(macro, ksp));
  PetscCall(LamMacroBorderSolver(macro, ksp));
  PetscCall(SNESSetFromOptions(macro->snes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroAccept(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCall(VecCopy(macro->u, macro->before));
  PetscCall(LamMacroAddWork(macro));
  PetscCall(VecCopy(macro->trial, macro->u));
  PetscCall(VecCopy(macro->force, macro->force_accepted));
  PetscCall(LamMacroFlowAccept(macro));
  PetscCall(PetscArraycpy(macro->accepted, macro->now, macro->point_count));
  PetscCall(LamMacroAcceptPressures(macro));
  for (PetscInt b = 0; b < macro->border_count; b++) macro->borders[b].accepted = macro->borders[b].now;
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    macro->obstacle_nodes[k].accepted = macro->obstacle_nodes[k].active;
    macro->obstacle_nodes[k].accepted_slip = macro->obstacle_nodes[k].slip;
  }
  LamMacroObstaclesAccept(macro);
  PetscCall(LamResponderAccept(macro->responder));
  macro->accepted_time = macro->time;
  if (macro->relaxes) PetscCall(LamMacroForget(macro)); /* the same load is now one of another past */
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroReject(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(macro->now, macro->accepted, macro->point_count));
  PetscCall(LamMacroRejectPressures(macro));
  for (PetscInt b = 0; b < macro->border_count; b++) macro->borders[b].now = macro->borders[b].accepted;
  PetscCall(LamResponderReject(macro->responder));
  PetscFunctionReturn(0);
}

/* Residual norms of the last series of iterations, relative to its force scale, for the step's report. */
static PetscErrorCode KeepHistory(LamMacro macro)
{
  LamMacroStep *step = &macro->step;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(SNESGetConvergenceHistory(macro->snes, NULL, NULL, &n));
  step->residual_count = PetscMin(n, (PetscInt)PETSC_STATIC_ARRAY_LENGTH(step->residuals));
  for (PetscInt k = 0; k < step->residual_count; k++)
    step->residuals[k] = macro->force_scale > 0 ? macro->history[k] / macro->force_scale : macro->history[k];
  n = step->residual_count;
  while (n > 3 && step->residuals[n - 1] < ROUNDING) n--;
  const PetscReal *r = &step->residuals[PetscMax(n, 3) - 3];
  step->order = n < 3 || r[1] >= r[0] ? NAN : PetscLogReal(r[2] / r[1]) / PetscLogReal(r[1] / r[0]);
  PetscFunctionReturn(0);
}

/* Sets `lenient`: responses are interpolated, and the body is at an instant or has pressures, to which lumen errors
   add. */
static PetscErrorCode SetLeniency(LamMacro macro)
{
  const PetscBool interpolated = (PetscBool)(LamResponderGetCounters(macro->responder).interpolated > 0);

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&interpolated, &macro->lenient, 1, MPIU_BOOL, MPI_LOR, macro->comm));
  macro->lenient = (PetscBool)(macro->lenient && (macro->thorough || macro->seal));
  if (macro->lenient && macro->force_floor == 0) PetscCall(LamMacroForceFloor(macro, &macro->force_floor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroIterate(LamMacro macro, PetscBool *converged)
{
  const PetscInt most = MAX_ITERATIONS + (macro->seal && macro->obstacle_count ? MOST_RELEASES : 0);
  SNESConvergedReason reason;
  PetscInt iterations;

  PetscFunctionBeginUser;
  macro->force_scale = 0;
  macro->fresh = PETSC_TRUE;
  PetscCall(SetLeniency(macro));
  macro->trouble[0] = '\0';
  PetscCall(SNESSetTolerances(macro->snes, 0, 0, 0, most, PETSC_MAX_INT));
  PetscCall(SNESSolve(macro->snes, NULL, macro->trial));
  PetscCall(SNESGetConvergedReason(macro->snes, &reason));
  PetscCall(SNESGetIterationNumber(macro->snes, &iterations));
  macro->step.newton_iterations += iterations;
  PetscCall(KeepHistory(macro));
  *converged = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (*converged) PetscCall(LamMacroFlowClose(macro));
  if (reason == SNES_DIVERGED_LINEAR_SOLVE) {
    PetscCall(PetscStrncpy(macro->trouble, "the tangent of the body is singular", sizeof(macro->trouble)));
  } else if (reason < 0 && !macro->trouble[0]) {
    PetscReal last = macro->step.residual_count ? macro->step.residuals[macro->step.residual_count - 1] : 0;
    PetscCall(PetscSNPrintf(macro->trouble, sizeof(macro->trouble),
                            "%s after %" PetscInt_FMT " Newton iterations, relative residual %.1e",
                            SNESConvergedReasons[reason], iterations, (double)last));
  }
  PetscFunctionReturn(0);
}

/* One Newton solve at `stage`, from the last converged state or, if *guesses, from a guess; *guesses on return: whether
   a guess was found and used. */
static PetscErrorCode TryStage(LamMacro macro, Stage stage, PetscBool *guesses, PetscBool *converged)
{
  PetscFunctionBeginUser;
  macro->turgor = stage.turgor;
  PetscCall(LamMacroSetLoadFactor(macro, stage.load));
  PetscCall(VecCopy(macro->u, macro->trial));
  if (*guesses) PetscCall(LamMacroGuessInflated(macro, macro->trial, guesses));
  PetscCall(LamMacroIterate(macro, converged));
  PetscFunctionReturn(0);
}

/* TryStage with a guess of the inflated body or a prediction along the path; if that fails, without. */
static PetscErrorCode TryIncrement(LamMacro macro, Stage from, Stage to, PetscBool *converged)
{
  const PetscReal ratio = macro->passed != 0 ? (to.load - from.load) / macro->passed : 0;
  /* a node that comes into contact makes a kink in the path, where predictions save nothing */
  const PetscBool predicts =
      macro->extrapolates && !macro->obstacle_count && from.turgor == to.turgor && ratio > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscBool guesses = macro->scene->macro.inflate && from.turgor == 0 && to.turgor == 1 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  macro->prediction = predicts ? ratio : 0;
  PetscCall(TryStage(macro, to, &guesses, converged));
  if (!*converged && (predicts || guesses) && !macro->stopped) {
    PetscCall(LamMacroReject(macro));
    macro->prediction = 0;
    guesses = PETSC_FALSE;
    PetscCall(TryStage(macro, to, &guesses, converged));
  }
  if (*converged) macro->passed = from.turgor == to.turgor ? to.load - from.load : 0;
  PetscFunctionReturn(0);
}

/* Advances from one stage to another, in smaller increments if that fails. reached: the last converged stage. */
static PetscErrorCode Advance(LamMacro macro, Stage from, Stage to, Stage *reached, PetscBool *converged)
{
  const PetscReal smallest = PetscPowRealInt(0.5, MAX_HALVINGS);
  PetscReal done = 0, increment = 1;

  PetscFunctionBeginUser;
  *reached = from;
  *converged = PETSC_TRUE;
  while (done < 1) {
    PetscReal next = PetscMin(1, done + increment);
    Stage stage = {from.turgor + next * (to.turgor - from.turgor), from.load + next * (to.load - from.load)};
    PetscCall(TryIncrement(macro, *reached, stage, converged));
    if (*converged) {
      PetscCall(LamMacroAccept(macro));
      *reached = stage;
      done = next;
      increment *= 2;
    } else {
      PetscCall(LamMacroReject(macro));
      if (macro->stopped) break;
      macro->step.cutbacks++;
      if (macro->cutback) PetscCall(macro->cutback(macro, macro->trouble, macro->cutback_ctx));
      increment = 0.5 * (next - done);
      if (increment < smallest) break;
    }
  }
  PetscFunctionReturn(0);
}

/* Means over the body, and the largest gap. */
static PetscErrorCode MeanIndicators(LamMacro macro, LamMacroStep *step)
{
  PetscReal sum[3] = {0};

  PetscFunctionBeginUser;
  step->max_gap = -PETSC_INFINITY;
  for (PetscInt p = 0; p < macro->point_count; p++) {
    const LamMaterialPoint *point = &macro->accepted[p];
    sum[0] += macro->weight[p];
    sum[1] += macro->weight[p] * point->field[LAM_POINT_DEBONDED];
    sum[2] += macro->weight[p] * point->load.turgor;
    /* if one point does not know the gap, the maximum is unknown: infinite, which MPI_MAX keeps */
    const PetscReal gap = point->field[LAM_POINT_GAP];
    step->max_gap = PetscMax(step->max_gap, PetscIsInfOrNanReal(gap) ? INFINITY : gap);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, macro->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &step->max_gap, 1, MPIU_REAL, MPIU_MAX, macro->comm));
  step->debonded_fraction = sum[1] / sum[0];
  step->turgor_mean = sum[2] / sum[0];
  PetscFunctionReturn(0);
}

/* Energies and damage of the points with a lamella that breaks. */
static PetscErrorCode SumLamella(LamMacro macro, LamMacroStep *step)
{
  enum { VOLUME, BROKEN, STORED, DISSIPATED, RELEASED, WORK, SUMS };
  PetscReal sum[SUMS] = {0};
  PetscBool any;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < macro->point_count; p++) {
    const PetscReal *field = macro->accepted[p].field, weight = macro->weight[p];

    if (isnan(field[LAM_POINT_BROKEN])) continue;
    sum[VOLUME] += weight;
    sum[BROKEN] += weight * field[LAM_POINT_BROKEN];
    sum[STORED] += weight * field[LAM_POINT_STORED];
    sum[DISSIPATED] += weight * field[LAM_POINT_DISSIPATED];
    sum[RELEASED] += weight * field[LAM_POINT_RELEASED];
    sum[WORK] += weight * field[LAM_POINT_WORK];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, SUMS, MPIU_REAL, MPIU_SUM, macro->comm));
  any = (PetscBool)(sum[VOLUME] > 0);
  step->broken_fraction = any ? sum[BROKEN] / sum[VOLUME] : NAN;
  step->stored = any ? sum[STORED] : NAN;
  step->dissipated = any ? sum[DISSIPATED] : NAN;
  step->released = any ? sum[RELEASED] : NAN;
  step->tissue_work = any ? sum[WORK] : NAN;
  if (any && step->localised_points) step->mesh_dependent = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Counters of the step on all ranks, and mean times. */
static PetscErrorCode SumCounters(LamMacro macro, LamMacroStep *step)
{
  const LamResponderCounters now = LamResponderGetCounters(macro->responder), *before = &macro->counted;
  PetscInt64 counts[5] = {now.queries - before->queries, now.hits - before->hits, now.solves - before->solves,
                          now.failures - before->failures, now.interpolated - before->interpolated};
  PetscReal seconds[2] = {now.query_seconds - before->query_seconds, now.solve_seconds - before->solve_seconds};
  PetscMPIInt ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(macro->comm, &ranks));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, counts, 5, MPIU_INT64, MPI_SUM, macro->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 2, MPIU_REAL, MPIU_SUM, macro->comm));
  step->queries = counts[0];
  step->hits = counts[1];
  step->solves = counts[2];
  step->failures = counts[3];
  step->interpolated = counts[4];
  step->query_seconds = seconds[0] / ranks;
  step->solve_seconds = seconds[1] / ranks;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFinishStep(LamMacro macro, PetscInt number, PetscReal load_factor, PetscReal start)
{
  LamMacroStep *step = &macro->step;

  PetscFunctionBeginUser;
  step->step = number;
  step->load_factor = load_factor;
  PetscCall(LamMacroSetLoadFactor(macro, load_factor)); /* a failed increment has set another one */
  LamMacroDisplacements(macro, step);
  LamMacroObstaclesDescribe(macro, step);
  PetscCall(LamMacroReactions(macro, step));
  PetscCall(MeanIndicators(macro, step));
  PetscCall(LamMacroFindLocalisation(macro, step));
  PetscCall(SumLamella(macro, step));
  PetscCall(SumCounters(macro, step));
  PetscCall(LamMacroCertify(macro, step));
  step->seconds = LamClock() - start;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroStartStep(LamMacro macro, PetscReal *start)
{
  PetscFunctionBeginUser;
  macro->step.newton_iterations = macro->step.cutbacks = 0;
  macro->counted = LamResponderGetCounters(macro->responder);
  *start = LamClock();
  PetscFunctionReturn(0);
}

/* Passes a step to the monitor. A run can be restarted from a complete step. */
static PetscErrorCode Report(LamMacro macro, PetscInt number, PetscReal load_factor, PetscBool complete,
                             PetscReal start, PetscBool *stop)
{
  PetscFunctionBeginUser;
  macro->step.complete = complete;
  if (complete) macro->progress = (LamMacroProgress){PETSC_TRUE, number, load_factor};
  PetscCall(LamMacroFinishStep(macro, number, load_factor, start));
  if (macro->monitor) PetscCall(macro->monitor(macro, &macro->step, stop, macro->monitor_ctx));
  PetscFunctionReturn(0);
}

/* Ends the run within a step. Increments that converged since the last report are reported, since they were expensive.
 */
static PetscErrorCode EndWithinStep(LamMacro macro, PetscInt number, Stage reported, Stage reached, PetscReal start,
                                    char message[LAM_MESSAGE_LENGTH])
{
  const PetscInt first = macro->scene->macro.inflate ? 0 : 1;
  PetscBool ends = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (!macro->stopped && number == 0)
    PetscCall(PetscSNPrintf(message, LAM_MESSAGE_LENGTH, "turgor: reached %.4g of 1: %s", (double)reached.turgor,
                            macro->trouble));
  else if (!macro->stopped)
    PetscCall(PetscSNPrintf(message, LAM_MESSAGE_LENGTH, "step %" PetscInt_FMT ": reached load factor %.4g: %s", number,
                            (double)reached.load, macro->trouble));
  if (reached.load != reported.load || (reached.turgor > reported.turgor && macro->scene->turgor != 0))
    PetscCall(Report(macro, PetscMax(number, first), reached.load, PETSC_FALSE, start, &ends));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBringUpTurgor(LamMacro macro, PetscReal *reached, PetscBool *converged)
{
  const PetscBool inflate = macro->scene->macro.inflate;
  Stage stage = {0, 0}, to = {1, 0};

  PetscFunctionBeginUser;
  *converged = PETSC_TRUE;
  if (inflate)
    PetscCall(LamMacroHoldRigidMotions(macro));
  else
    PetscCall(LamMacroHoldBoundaries(macro));
  if (!inflate && macro->scene->sealed) {
    PetscCall(LamMacroSealLumens(macro, converged));
    if (*converged) stage.turgor = 1;
  }
  if (*converged) PetscCall(Advance(macro, stage, to, &stage, converged));
  if (*converged && (inflate || macro->water_law)) PetscCall(LamMacroSealLumens(macro, converged));
  if (*converged && inflate) PetscCall(VecCopy(macro->u, macro->origin));
  *reached = stage.turgor;
  PetscFunctionReturn(0);
}

/* Applies the turgor; with `inflate` this is a separate step, from which the displacements are measured. */
static PetscErrorCode Inflate(LamMacro macro, Stage *stage, PetscReal *start, PetscBool *converged, PetscBool *stop)
{
  PetscFunctionBeginUser;
  PetscCall(LamMacroBringUpTurgor(macro, &stage->turgor, converged));
  if (!*converged || !macro->scene->macro.inflate) PetscFunctionReturn(0);
  PetscCall(Report(macro, 0, 0, PETSC_TRUE, *start, stop));
  PetscCall(LamMacroHoldBoundaries(macro));
  macro->passed = 0;
  PetscCall(LamMacroStartStep(macro, start));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSolve(LamMacro macro, LamMacroReason *reason, char message[LAM_MESSAGE_LENGTH])
{
  const LamMacroSpec *spec = &macro->scene->macro;
  Stage stage = {macro->progress.begun ? 1 : 0, macro->progress.load}, reported, to = {1, 0};
  PetscBool converged = PETSC_TRUE, stop = PETSC_FALSE;
  PetscInt number = macro->progress.number;
  PetscReal start;

  PetscFunctionBeginUser;
  PetscCheck(macro->responder, macro->comm, PETSC_ERR_ORDER, "call LamMacroSetResponder() first");
  message[0] = '\0';
  PetscCall(LamMacroStartStep(macro, &start));
  if (!macro->progress.begun) PetscCall(Inflate(macro, &stage, &start, &converged, &stop));
  reported = macro->progress.begun ? stage : (Stage){0, 0};
  while (converged && !stop && number < spec->steps) {
    to.load = LamMacroParameter(spec, ++number);
    PetscCall(Advance(macro, stage, to, &stage, &converged));
    if (!converged) break;
    PetscCall(Report(macro, number, to.load, PETSC_TRUE, start, &stop));
    reported = stage;
    PetscCall(LamMacroStartStep(macro, &start));
  }
  if (!converged) PetscCall(EndWithinStep(macro, number, reported, stage, start, message));
  if (converged)
    *reason = stop && number < spec->steps ? LAM_MACRO_STOPPED : LAM_MACRO_DONE;
  else
    *reason = macro->stopped ? LAM_MACRO_STOPPED : LAM_MACRO_NOT_CONVERGED;
  PetscFunctionReturn(0);
}
