/*
  One segment of time of a body, integrated by IDA (SUNDIALS).

  Unknowns: states of the kinetic laws x, common to all tissue; the water V of each material point; turgor and
  displacement of the body, (q, u); where water moves through it potentials psi and what has flowed in, Q. Equations

    x' = f(x, T),      V' = Lp A (sigma (pi - pi_out) - p),      equilibrium and lumens of the body for (u, q; V, x, t)

  with -sigma pi_out replaced by the potentials there, and Q' the flow at the surface (transport.c).

  In an implicit step y' = s + c (y - a), with IDA's s, a, c, the kinetics are solved separately, and V is a function
  of p at each point (body_water.c). The remaining problem is equilibrium of a body whose lumens have volume V(p).
  IDA's nonlinear solver is therefore Newton's method of the macroscale solver with its condensed tangent. IDA
  controls predictions, errors, steps, orders and roots.

  Errors of x and V are controlled, of V in the mean over the body's volume. Turgor and displacement follow: equilibrium
  is solved again for every report and event search, so neither interpolation in time nor of responses limits the steps.

  Walls with memory see steps in which their elastic stress goes straight (relaxation.h), each from the state accepted
  before: orders are at most 2, steps end at reports, and errors of the displacement are controlled, too.

  Reference: Hindmarsh et al., ACM TOMS 31 (2005) 363-396.
*/
#include "body_impl.h"
#include "integrator.h"
#include <math.h>
#include <nvector/nvector_parallel.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_types.h>

enum { MAX_STEPS = 100000, MAX_FAILURES = 25, MAX_RESTARTS = 3, MAX_HALVINGS = 6 };
#define SMALL 1e-3         /* displacement in macro lengths: errors of smaller ones are relative to this */
#define LEAST_ADVANCE 1e-9 /* fraction of the duration; a restart that advances less counts towards MAX_RESTARTS */

/* Positions of the unknowns behind the kinetic states in this rank's y; -1: not an unknown. */
typedef struct {
  PetscInt idle, inflow, water, pressures, potentials, u;
} Layout;

typedef struct {
  LamIntegrator base;
  LamBody body;
  Layout layout;
  PetscInt total, displacements;    /* unknowns of all ranks, and of these displacements */
  PetscReal x[LAM_PROCESS_KINETIC]; /* of the last step's solution, on all ranks */
  PetscBool pending;                /* a solution has not been accepted yet */
  PetscReal c;                      /* leading coefficient of the last step */
  PetscErrorCode error;             /* of the library, raised inside IDA */
  SUNNonlinearSolver solver;
} Integration;

/* ---- unknowns ---- */

static void LayOut(Integration *in)
{
  const LamProcessSpec *spec = in->body->process->spec;
  const LamMacroSizes *sizes = &in->body->sizes;
  PetscInt *n = &in->base.n;
  Layout *l = &in->layout;

  *l = (Layout){.idle = -1, .inflow = -1, .water = -1};
  if (in->body->rank == 0) l->idle = (*n)++; /* IDA needs one unknown with a rate */
  if (in->body->rank == 0 && in->body->transport.count) l->inflow = (*n)++;
  if (spec->has_water && isfinite(spec->water.permeability)) {
    l->water = *n;
    *n += sizes->points;
  }
  l->pressures = *n;
  *n += sizes->elements * sizes->modes;
  l->potentials = *n;
  *n += sizes->potentials;
  l->u = *n;
  *n += sizes->displacements;
}

static PetscErrorCode Pack(const Integration *in, PetscReal y[])
{
  const LamBody body = in->body;
  const LamMacroSizes *sizes = &body->sizes;
  const Layout *l = &in->layout;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++)
    if (in->base.state[k] >= 0) y[in->base.state[k]] = body->process->tissue.x[k];
  if (l->idle >= 0) y[l->idle] = 0;
  if (l->inflow >= 0) y[l->inflow] = body->inflow;
  if (l->water >= 0) PetscCall(PetscArraycpy(&y[l->water], body->water, sizes->points));
  PetscCall(PetscArraycpy(&y[l->pressures], body->pressures, sizes->elements * sizes->modes));
  PetscCall(PetscArraycpy(&y[l->potentials], body->potentials, sizes->potentials));
  PetscCall(PetscArraycpy(&y[l->u], body->u, sizes->displacements));
  PetscFunctionReturn(0);
}

/* Broadcasts the kinetic states in y, which rank 0 has. */
static PetscErrorCode ShareStates(const Integration *in, const PetscReal y[], PetscReal x[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++) x[k] = in->base.state[k] < 0 ? 0 : y[in->base.state[k]];
  PetscCallMPI(MPI_Bcast(x, LAM_PROCESS_KINETIC, MPIU_REAL, 0, in->body->comm));
  PetscFunctionReturn(0);
}

/* Makes y at a time the present state of the body. */
static PetscErrorCode Unpack(Integration *in, PetscReal time, const PetscReal y[])
{
  LamBody body = in->body;
  LamProcessTissue *tissue = &body->process->tissue;
  const LamSegment *segment = &body->process->segment;
  const Layout *l = &in->layout;
  const PetscReal elapsed = time - segment->start;

  PetscFunctionBeginUser;
  PetscCall(ShareStates(in, y, tissue->x));
  tissue->time = time;
  tissue->temperature = LamRampAt(&segment->temperature, elapsed);
  tissue->outside = LamRampAt(&segment->outside, elapsed);
  tissue->load = LamRampAt(&segment->load, elapsed);
  body->turgor_share = LamBodyInstant(body, time).turgor;
  if (l->inflow >= 0) body->inflow = y[l->inflow];
  if (l->water >= 0) PetscCall(PetscArraycpy(body->water, &y[l->water], body->sizes.points));
  PetscCall(PetscArraycpy(body->pressures, &y[l->pressures], body->sizes.elements * body->sizes.modes));
  PetscCall(PetscArraycpy(body->potentials, &y[l->potentials], body->sizes.potentials));
  PetscCall(PetscArraycpy(body->u, &y[l->u], body->sizes.displacements));
  PetscFunctionReturn(0);
}

/* ---- an implicit step ---- */

static PetscErrorCode SolveKinetics(Integration *in, PetscReal time, PetscReal c, const PetscReal predicted[],
                                    const PetscReal rates[], PetscBool *ok)
{
  const LamProcess process = in->body->process;
  const PetscReal temperature = LamRampAt(&process->segment.temperature, time - process->segment.start);

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    const PetscInt first = LAM_KINETIC_STATES * k, at = in->base.state[first];

    if (at < 0) continue; /* states of a law are contiguous */
    if (!LamKineticsStep(&process->spec->kinetics[k], temperature, c, &predicted[at], &rates[at], &in->x[first]))
      *ok = PETSC_FALSE;
  }
  PetscCallMPI(MPI_Bcast(ok, 1, MPIU_BOOL, 0, in->body->comm));
  PetscCallMPI(MPI_Bcast(in->x, LAM_PROCESS_KINETIC, MPIU_REAL, 0, in->body->comm));
  PetscFunctionReturn(0);
}

/* Correction: the solution of the step minus the prediction. */
static PetscErrorCode FillCorrection(Integration *in, const PetscReal predicted[], const PetscReal rates[],
                                     PetscReal correction[])
{
  LamBody body = in->body;
  const Layout *l = &in->layout;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++)
    if (in->base.state[k] >= 0) correction[in->base.state[k]] = in->x[k] - predicted[in->base.state[k]];
  if (l->idle >= 0) correction[l->idle] = 0;
  if (l->inflow >= 0) {
    PetscCall(LamBodyInflowRate(body, &correction[l->inflow]));
    correction[l->inflow] = (correction[l->inflow] - rates[l->inflow]) / in->c;
  }
  PetscCall(LamMacroGetState(body->macro, &correction[l->u], &correction[l->pressures], &correction[l->potentials]));
  for (PetscInt k = l->pressures; k < in->base.n; k++) correction[k] -= predicted[k];
  for (PetscInt p = 0; p < body->sizes.points && l->water >= 0; p++) {
    LamMacroPoint point;
    PetscReal slope;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    correction[l->water + p] =
        LamBodyProtoplast(body, p, PetscMax(point.load->turgor, 0), point.potential, &slope) - predicted[l->water + p];
  }
  PetscFunctionReturn(0);
}

/* Sets the flow of water in the last step: V' = rates + c (V - start). */
static LamWaterMode SetStep(Integration *in, PetscReal start[], PetscReal rates[])
{
  LamBody body = in->body;
  const PetscInt water = in->layout.water;

  body->cj = in->c;
  body->start = water < 0 ? NULL : &start[water];
  body->slope = water < 0 ? NULL : &rates[water];
  body->inflow_start = in->layout.inflow < 0 ? 0 : start[in->layout.inflow];
  body->inflow_slope = in->layout.inflow < 0 ? 0 : rates[in->layout.inflow];
  return water < 0 ? LAM_WATER_OSMOSIS : LAM_WATER_PASSES;
}

/* Equilibrium of the body in the last step at a time with the kinetic states in->x, from the displacement and turgor in
   y; with `again`, if that fails, from those at the start of the step. The result is pending. */
static PetscErrorCode Balance(Integration *in, PetscReal time, PetscReal y[], PetscReal yp[], PetscBool again,
                              PetscBool *ok)
{
  LamBody body = in->body;
  LamProcess process = body->process;
  const Layout *l = &in->layout;

  PetscFunctionBeginUser;
  PetscCall(LamBodySetTime(body, time, in->x, ok));
  if (!*ok) PetscFunctionReturn(0);
  body->mode = SetStep(in, y, yp);
  const LamMacroInstant instant = LamBodyInstant(body, time);
  PetscCall(LamBodyAsk(body, &instant, &y[l->u], &y[l->pressures], &y[l->potentials], ok));
  PetscCall(LamMacroStopped(body->macro, &process->stopped));
  if (!*ok && again && !process->stopped) {
    PetscCall(LamMacroReject(body->macro));
    PetscCall(LamBodyAsk(body, &instant, body->u, body->pressures, body->potentials, ok));
    PetscCall(LamMacroStopped(body->macro, &process->stopped));
  }
  process->counts.questions++;
  in->pending = PETSC_TRUE;
  if (*ok)
    body->evaluated = time;
  else
    PetscCall(PetscStrncpy(process->trouble, LamMacroTrouble(body->macro), sizeof(process->trouble)));
  PetscFunctionReturn(0);
}

/* Solves an implicit step. *flag: 0, or positive if a shorter step may have a solution. */
static PetscErrorCode SolveStep(Integration *in, PetscReal time, PetscReal c, PetscReal predicted[], PetscReal rates[],
                                PetscReal correction[], int *flag)
{
  LamBody body = in->body;
  PetscBool ok;

  PetscFunctionBeginUser;
  *flag = SUN_NLS_CONV_RECVR;
  if (in->pending) PetscCall(LamMacroReject(body->macro));
  in->pending = PETSC_FALSE;
  body->evaluated = NAN;
  PetscCall(ShareStates(in, predicted, in->x));
  PetscCall(SolveKinetics(in, time, c, predicted, rates, &ok));
  if (!ok) PetscFunctionReturn(0);
  in->c = c;
  PetscCall(Balance(in, time, predicted, rates, PETSC_FALSE, &ok));
  if (ok) PetscCall(FillCorrection(in, predicted, rates, correction));
  *flag = body->process->stopped ? -1 : ok ? 0 : SUN_NLS_CONV_RECVR;
  PetscFunctionReturn(0);
}

/* Solve function of the SUNNonlinearSolver. */
static int Solve(SUNNonlinearSolver solver, N_Vector y0, N_Vector correction, N_Vector w, PetscReal tolerance,
                 sunbooleantype setup, void *mem)
{
  Integration *in = (Integration *)solver->content;
  N_Vector predicted, rates, yn, ypn, residual;
  PetscReal time, c;
  void *data;
  int flag = -1;

  if (IDAGetNonlinearSystemData(in->base.ida, &time, &predicted, &rates, &yn, &ypn, &residual, &c, &data)) return -1;
  in->error = SolveStep(in, time, c, N_VGetArrayPointer(predicted), N_VGetArrayPointer(rates),
                        N_VGetArrayPointer(correction), &flag);
  return in->error ? -1 : flag;
}

static SUNNonlinearSolver_Type SolverType(SUNNonlinearSolver solver)
{
  return SUNNONLINEARSOLVER_ROOTFIND;
}

/* IDA passes its residual here; SolveStep does not need it. */
static int SetSystem(SUNNonlinearSolver solver, SUNNonlinSolSysFn residual)
{
  return SUN_SUCCESS;
}

static int FreeSolver(SUNNonlinearSolver solver)
{
  SUNNonlinSolFreeEmpty(solver);
  return SUN_SUCCESS;
}

/* IDAResFn; never called */
static int Residual(PetscReal t, N_Vector y, N_Vector yp, N_Vector r, void *ctx)
{
  return -1;
}

/* ---- errors ---- */

/* IDAEwtFn: weights of the norm sqrt(1/N sum (w e)^2) over x and V. */
static int Weights(N_Vector y_vector, N_Vector weight, void *ctx)
{
  const Integration *in = (Integration *)ctx;
  const LamBody body = in->body;
  const Layout *l = &in->layout;
  const PetscReal *y = N_VGetArrayPointer(y_vector), relative = body->process->spec->tolerance;
  const PetscReal all = (PetscReal)in->total;
  const PetscInt *state = in->base.state;
  PetscReal *w = N_VGetArrayPointer(weight);

  N_VConst(1, weight); /* next to nothing; and of algebraic unknowns errors are suppressed without a history */
  for (PetscInt k = l->u; k < in->base.n && body->process->has_history; k++)
    w[k] = sqrt(all / (PetscReal)in->displacements) / (relative * (PetscAbsReal(y[k]) + SMALL));
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++)
    if (state[k] >= 0) w[state[k]] = sqrt(all) / (relative * (PetscAbsReal(y[state[k]]) + 1e-3));
  for (PetscInt p = 0; p < body->sizes.points && l->water >= 0; p++)
    w[l->water + p] = sqrt(all * body->share[p]) / (relative * (PetscAbsReal(y[l->water + p]) + 1e-3));
  return 0;
}

/* ---- roots ---- */

/* Event functions at IDA's state: at an equilibrium, unless already evaluated at that time, which is not accepted. */
static PetscErrorCode FindExcess(Integration *in, PetscReal time, PetscReal y[], PetscReal yp[], PetscReal excess[],
                                 PetscBool *ok)
{
  LamBody body = in->body;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  if (body->evaluated != time) {
    body->evaluated = NAN;
    PetscCall(ShareStates(in, y, in->x));
    PetscCall(Balance(in, time, y, yp, PETSC_TRUE, ok));
    body->mode = LamBodyAtOnce(body); /* the vectors of IDA are no longer used */
  }
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamBodyExcess(body, in->base.event_count, in->base.events, excess));
  for (PetscInt k = 0; k < in->base.event_count; k++)
    if (!isfinite(excess[k])) excess[k] = -1;
  PetscFunctionReturn(0);
}

/* IDARootFn */
static int Roots(PetscReal t, N_Vector y, N_Vector yp, PetscReal excess[], void *ctx)
{
  Integration *in = (Integration *)ctx;
  PetscBool ok = PETSC_FALSE;

  in->error = FindExcess(in, t, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), excess, &ok);
  return in->error || !ok ? -1 : 0;
}

/* ---- creation and destruction ---- */

/* Sets y' of the differential unknowns. */
static PetscErrorCode StartRates(Integration *in)
{
  LamBody body = in->body;
  const LamProcess process = body->process;
  PetscReal *yp = N_VGetArrayPointer(in->base.yp);
  PetscReal rate[LAM_PROCESS_KINETIC], J[LAM_CHANGING_COUNT][LAM_KINETIC_STATES][LAM_KINETIC_STATES];

  PetscFunctionBeginUser;
  N_VConst(0, in->base.yp);
  LamProcessRates(process, body->now.temperature, process->tissue.x, rate, J);
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++)
    if (in->base.state[k] >= 0) yp[in->base.state[k]] = rate[k];
  for (PetscInt p = 0; p < body->sizes.points && in->layout.water >= 0; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    yp[in->layout.water + p] = LamBodyFlow(body, p, body->water[p], &point);
  }
  if (in->layout.inflow >= 0) PetscCall(LamBodyInflowRate(body, &yp[in->layout.inflow]));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateSolver(Integration *in)
{
  PetscFunctionBeginUser;
  in->solver = SUNNonlinSolNewEmpty(in->base.context);
  PetscCheck(in->solver, PETSC_COMM_SELF, PETSC_ERR_MEM, "SUNDIALS: no memory for a nonlinear solver");
  in->solver->content = in;
  in->solver->ops->gettype = SolverType;
  in->solver->ops->solve = Solve;
  in->solver->ops->setsysfn = SetSystem;
  in->solver->ops->free = FreeSolver;
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(LamBody body, Integration *in)
{
  LamIntegrator *base = &in->base;

  PetscFunctionBeginUser;
  in->body = body;
  PetscCall(LamIntegratorCreate(body->process, body->comm, base));
  base->event_count = LamBodyListEvents(body, base->events);
  LayOut(in);
  in->total = base->n;
  in->displacements = base->n - in->layout.u;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &in->total, 1, MPIU_INT, MPI_SUM, body->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &in->displacements, 1, MPIU_INT, MPI_SUM, body->comm));
  base->y = N_VNew_Parallel(body->comm, base->n, in->total, base->context);
  PetscCheck(base->y, PETSC_COMM_SELF, PETSC_ERR_MEM, "SUNDIALS: no memory for a vector");
  base->yp = N_VClone(base->y);
  base->id = N_VClone(base->y);
  N_VConst(0, base->id);
  for (PetscInt k = 0; k < in->layout.pressures; k++) N_VGetArrayPointer(base->id)[k] = 1;
  PetscCall(Pack(in, N_VGetArrayPointer(base->y)));
  PetscCall(StartRates(in));
  PetscCall(LamIntegratorStart(base, Residual, Roots, in));
  LamCallSUN(IDAWFtolerances(base->ida, Weights));
  if (!in->body->process->has_history) LamCallSUN(IDASetSuppressAlg(base->ida, SUNTRUE));
  LamCallSUN(
      IDASetMaxStep(base->ida, LamProcessOutputInterval(body->process))); /* transient events must not be missed */
  LamCallSUN(IDASetMaxConvFails(base->ida, MAX_FAILURES));
  if (in->body->process->has_history) LamCallSUN(IDASetMaxOrd(base->ida, 2)); /* that of the history of walls */
  PetscCall(CreateSolver(in));
  LamCallSUN(IDASetNonlinearSolver(base->ida, in->solver));
  PetscFunctionReturn(0);
}

static void Destroy(Integration *in)
{
  if (in->solver) SUNNonlinSolFree(in->solver);
  LamIntegratorDestroy(&in->base);
}

/* ---- time loop ---- */

/* Steps of IDA end next to a stop time, up to rounding. */
static PetscBool IsEvaluated(LamBody body, PetscReal time)
{
  return (PetscBool)(PetscAbsReal(body->evaluated - time) <= LamTimeTolerance(body->process));
}

/* Equilibrium of the body at IDA's state at a time within the last step. keeps: turgor and displacement of the present
   state are the initial guess, else the interpolated ones. */
static PetscErrorCode SettleAt(Integration *in, PetscReal time, PetscBool keeps, PetscBool *ok)
{
  LamBody body = in->body;
  const LamMacroSizes *sizes = &body->sizes;
  const PetscInt n = sizes->displacements, m = sizes->elements * sizes->modes, l = sizes->potentials;
  N_Vector y = N_VClone(in->base.y), yp = N_VClone(in->base.y);
  PetscReal *u, *pressures, *potentials;
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &u, m, &pressures, l, &potentials));
  PetscCall(PetscArraycpy(u, body->u, n));
  PetscCall(PetscArraycpy(pressures, body->pressures, m));
  PetscCall(PetscArraycpy(potentials, body->potentials, l));
  *ok = (PetscBool)(IDAGetDky(in->base.ida, time, 0, y) == IDA_SUCCESS &&
                    IDAGetDky(in->base.ida, time, 1, yp) == IDA_SUCCESS);
  if (*ok) ierr = Unpack(in, time, N_VGetArrayPointer(y));
  if (*ok && keeps) {
    PetscCall(PetscArraycpy(body->u, u, n));
    PetscCall(PetscArraycpy(body->pressures, pressures, m));
    PetscCall(PetscArraycpy(body->potentials, potentials, l));
  }
  if (*ok && !ierr) ierr = LamBodySettle(body, SetStep(in, N_VGetArrayPointer(y), N_VGetArrayPointer(yp)), time, ok);
  PetscCall(PetscFree3(u, pressures, potentials));
  N_VDestroy(y);
  N_VDestroy(yp);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Equilibrium at an output before the end of the step, `end`: starting from the interpolated state or, if that fails,
   from the end of the step in smaller and smaller steps back. */
static PetscErrorCode SettleOutput(Integration *in, PetscReal end, PetscReal output, PetscBool *ok)
{
  LamBody body = in->body;
  PetscReal at = end, way = output - end;
  PetscInt halvings = 0;

  PetscFunctionBeginUser;
  PetscCall(SettleAt(in, output, PETSC_FALSE, ok));
  if (*ok || body->process->stopped) PetscFunctionReturn(0);
  PetscCall(Unpack(in, end, N_VGetArrayPointer(in->base.y)));
  while (at > output && halvings <= MAX_HALVINGS && !body->process->stopped) {
    const PetscReal next = PetscMax(output, at + way);

    PetscCall(SettleAt(in, next, PETSC_TRUE, ok));
    if (*ok) {
      at = next;
    } else {
      way *= 0.5;
      halvings++;
    }
  }
  PetscFunctionReturn(0);
}

/* Reports the outputs up to a time that the integrator has passed. */
static PetscErrorCode ReportUpTo(Integration *in, PetscReal time, PetscBool *ok)
{
  LamBody body = in->body;
  LamProcess process = body->process;

  PetscFunctionBeginUser;
  while (*ok && process->next_output <= time && process->next_output <= process->spec->duration) {
    const PetscReal at = process->next_output;

    if (IsEvaluated(body, at)) {
      PetscCall(Unpack(in, at, N_VGetArrayPointer(in->base.y))); /* end of the step */
      if (in->layout.water < 0) PetscCall(LamBodyFillWater(body));
    } else {
      PetscCall(SettleOutput(in, time, at, ok));
    }
    if (!*ok) break;
    PetscCall(LamBodyReport(body, NULL));
    LamProcessNextOutput(process);
  }
  PetscFunctionReturn(0);
}

/* Call after a step that IDA has accepted: accepts its solution for the body, unless the last evaluation was at another
   time, for events. */
static PetscErrorCode TakeStep(Integration *in, PetscReal time)
{
  PetscFunctionBeginUser;
  if (in->pending && IsEvaluated(in->body, time))
    PetscCall(LamMacroAccept(in->body->macro));
  else if (in->pending)
    PetscCall(LamMacroReject(in->body->macro));
  in->pending = PETSC_FALSE;
  in->body->mode = LamBodyAtOnce(in->body); /* the vectors of IDA are no longer used */
  PetscFunctionReturn(0);
}

static PetscErrorCode Follow(Integration *in, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok)
{
  LamBody body = in->body;
  LamProcess process = body->process;
  int flag = IDA_SUCCESS;
  PetscReal t = process->tissue.time;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  if (process->has_history) PetscCall(ReportUpTo(in, t, ok)); /* a restart there */
  while ((flag == IDA_SUCCESS || flag == IDA_TSTOP_RETURN) && *ok && t < process->segment.end) {
    if (++body->steps > MAX_STEPS) {
      PetscCall(PetscStrncpy(process->trouble, "its steps of time are too short to come on", sizeof(process->trouble)));
      *ok = PETSC_FALSE;
      PetscFunctionReturn(0);
    }
    process->trouble[0] = '\0';
    if (process->has_history) /* a state in between would be of another history */
      LamCallSUN(IDASetStopTime(in->base.ida, PetscMin(process->next_output, process->segment.end)));
    flag = IDASolve(in->base.ida, process->segment.end, &t, in->base.y, in->base.yp, IDA_ONE_STEP);
    PetscCall(in->error);
    if (flag < 0) break;
    process->counts.steps++;
    PetscCall(TakeStep(in, t));
    if (process->has_history && !IsEvaluated(body, t)) PetscCall(SettleAt(in, t, PETSC_FALSE, ok));
    if (*ok) PetscCall(ReportUpTo(in, t, ok));
    if (*ok) PetscCall(Unpack(in, t, N_VGetArrayPointer(in->base.y)));
    if (process->stopped) break;
  }
  if (flag < 0 && in->pending) PetscCall(LamMacroReject(body->macro));
  PetscCall(LamIntegratorTake(&in->base, flag, happened));
  if (flag < 0 || process->stopped) *ok = PETSC_FALSE;
  if (*ok && !IsEvaluated(body, t))
    PetscCall(SettleAt(in, t, PETSC_FALSE, ok));
  else if (*ok && in->layout.water < 0)
    PetscCall(LamBodyFillWater(body));
  PetscFunctionReturn(0);
}

/* One integration from the present state. */
static PetscErrorCode IntegrateOnce(LamBody body, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok)
{
  Integration in = {0};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = Create(body, &in);
  if (!ierr) ierr = Follow(&in, happened, ok);
  Destroy(&in);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* The responses of a cache change slightly when it is extended. The integration is then restarted from a new
   equilibrium. */
PetscErrorCode LamBodyIntegrate(LamBody body, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok)
{
  LamProcess process = body->process;
  char why[sizeof(process->trouble)];
  PetscInt tries = 0;

  PetscFunctionBeginUser;
  body->steps = 0;
  for (;;) {
    const PetscReal from = process->tissue.time;

    PetscCall(IntegrateOnce(body, happened, ok));
    if (*ok || process->stopped) break;
    tries = process->tissue.time > from + LEAST_ADVANCE * process->spec->duration ? 0 : tries + 1;
    if (tries == MAX_RESTARTS || body->steps > MAX_STEPS) break;
    PetscCall(PetscStrncpy(why, process->trouble, sizeof(why)));
    PetscCall(LamMacroForget(body->macro));
    PetscCall(LamBodySettle(body, LamBodyAtOnce(body), process->tissue.time, ok));
    PetscCall(PetscStrncpy(process->trouble, why, sizeof(why)));
    if (!*ok) break;
  }
  PetscFunctionReturn(0);
}
