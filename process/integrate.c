/*
  One segment of time, integrated by IDA (SUNDIALS): variable order and step BDF for differential-algebraic equations.

  Unknowns y: states of the kinetic laws; if water is followed, V and p; the free components of F. Equations

    x' = f(x, T),      V' = Lp A drive(V, p, x),      V = v(F, p) or, if the membranes are detached, p = 0,
    P_i(F, p, x) = given stress,

  of index 1 as long as the tissue with its water is stiff in the free components. The Jacobian dG/dy + c dG/dy' uses
  the derivatives of the response; the derivative with respect to the factor s of the walls follows from P = s P(F,
  p/s, g/s). If moduli do not change by a common factor, only the common factor is included, which costs an iteration.

  Reference: Hindmarsh et al., ACM TOMS 31 (2005) 363-396; Brenan, Campbell & Petzold, Numerical Solution of
  Initial-Value Problems in Differential-Algebraic Equations.
*/
#include "integrator.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_types.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { MAX_STEPS = 1000000 };

/* Positions of the unknowns besides kinetic states in y; -1: not an unknown. idle: a constant 0, if there are no other
 * unknowns. */
typedef struct {
  PetscInt water, turgor, F[9], idle;
} Layout;

typedef struct {
  LamIntegrator base;
  LamProcess process;
  Layout layout;
  N_Vector tolerance;
  SUNMatrix K;
  SUNLinearSolver solver;
} Integration;

/* ---- unknowns ---- */

static void LayOut(Integration *in)
{
  PetscInt *n = &in->base.n;
  Layout *l = &in->layout;

  *l = (Layout){.water = -1, .turgor = -1, .idle = -1};
  if (in->process->spec->has_water) {
    l->water = (*n)++;
    l->turgor = (*n)++;
  }
  for (PetscInt i = 0; i < 9; i++) l->F[i] = in->process->segment.given[i] ? (*n)++ : -1;
  if (!*n) l->idle = (*n)++;
}

/* The tissue for y at a time; prescribed quantities follow the segment. */
static LamProcessTissue Unpack(const Integration *in, PetscReal time, N_Vector y_vector)
{
  const LamSegment *segment = &in->process->segment;
  const PetscReal elapsed = time - segment->start, *y = N_VGetArrayPointer(y_vector);
  const PetscInt *state = in->base.state;
  const Layout *l = &in->layout;
  LamProcessTissue tissue = {.time = time,
                             .temperature = LamRampAt(&segment->temperature, elapsed),
                             .outside = LamRampAt(&segment->outside, elapsed)};

  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++) tissue.x[k] = state[k] < 0 ? 0 : y[state[k]];
  for (PetscInt i = 0; i < 9; i++) tissue.F[i] = l->F[i] < 0 ? LamRampAt(&segment->F[i], elapsed) : y[l->F[i]];
  tissue.turgor = l->turgor < 0 ? LamRampAt(&segment->turgor, elapsed) : y[l->turgor];
  tissue.water = l->water < 0 ? 0 : y[l->water];
  return tissue;
}

static void Pack(const Integration *in, const LamProcessTissue *tissue, PetscReal y[])
{
  const Layout *l = &in->layout;

  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++)
    if (in->base.state[k] >= 0) y[in->base.state[k]] = tissue->x[k];
  for (PetscInt i = 0; i < 9; i++)
    if (l->F[i] >= 0) y[l->F[i]] = tissue->F[i];
  if (l->turgor >= 0) y[l->turgor] = tissue->turgor;
  if (l->water >= 0) y[l->water] = tissue->water;
  if (l->idle >= 0) y[l->idle] = 0;
}

/* ---- the response at y ---- */

/* Returns 0; 1 if y has no response (a shorter step may have one); -1 on a library error, stored in process->error. */
static int EvaluateAt(Integration *in, PetscReal t, N_Vector y, LamProcessTissue *tissue, LamEvaluation *e)
{
  LamProcess process = in->process;

  *tissue = Unpack(in, t, y);
  process->error = LamProcessEvaluate(process, t, tissue->x, tissue->F, tissue->turgor, e);
  if (process->error) return -1;
  if (process->stop && process->stop()) process->stopped = PETSC_TRUE;
  if (process->stopped) return -1;
  return e->ok ? 0 : 1;
}

/* ---- residual ---- */

static void KineticResidual(const Integration *in, const LamEvaluation *e, const PetscReal x[], const PetscReal yp[],
                            PetscReal r[])
{
  PetscReal rate[LAM_PROCESS_KINETIC], J[LAM_CHANGING_COUNT][LAM_KINETIC_STATES][LAM_KINETIC_STATES];
  const PetscInt *state = in->base.state;

  LamProcessRates(in->process, e->temperature, x, rate, J);
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++)
    if (state[k] >= 0) r[state[k]] = yp[state[k]] - rate[k];
}

static void WaterResidual(const Integration *in, const LamEvaluation *e, const LamProcessTissue *tissue,
                          const PetscReal yp[], PetscReal r[])
{
  const Layout *l = &in->layout;
  LamFlow flow;

  LamProcessFlow(in->process, &in->process->cells, e, tissue->water, tissue->turgor, &flow);
  r[l->water] = isfinite(flow.conductance) ? yp[l->water] - flow.conductance * flow.drive
                : in->process->plasmolysed ? flow.osmotic - e->outside
                                           : flow.drive;
  r[l->turgor] = in->process->plasmolysed ? tissue->turgor : tissue->water + e->response.energy_turgor;
}

/* IDAResFn */
static int Residual(PetscReal t, N_Vector y, N_Vector yp_vector, N_Vector r_vector, void *ctx)
{
  Integration *in = (Integration *)ctx;
  const PetscReal *yp = N_VGetArrayPointer(yp_vector);
  const LamSegment *segment = &in->process->segment;
  PetscReal *r = N_VGetArrayPointer(r_vector);
  LamProcessTissue tissue;
  LamEvaluation e;
  const int flag = EvaluateAt(in, t, y, &tissue, &e);

  if (flag) return flag;
  in->process->counts.residuals++;
  KineticResidual(in, &e, tissue.x, yp, r);
  if (in->layout.water >= 0) WaterResidual(in, &e, &tissue, yp, r);
  if (in->layout.idle >= 0) r[in->layout.idle] = yp[in->layout.idle];
  for (PetscInt i = 0; i < 9; i++)
    if (in->layout.F[i] >= 0) r[in->layout.F[i]] = e.response.P[i] - LamRampAt(&segment->P[i], t - segment->start);
  return 0;
}

/* ---- Jacobian ---- */

static void KineticJacobian(const Integration *in, const LamEvaluation *e, const PetscReal x[], PetscReal c,
                            SUNMatrix K)
{
  PetscReal rate[LAM_PROCESS_KINETIC], J[LAM_CHANGING_COUNT][LAM_KINETIC_STATES][LAM_KINETIC_STATES];

  LamProcessRates(in->process, e->temperature, x, rate, J);
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    const PetscInt *at = &in->base.state[LAM_KINETIC_STATES * k];

    for (PetscInt i = 0; i < LAM_KINETIC_STATES && at[i] >= 0; i++)
      for (PetscInt j = 0; j < LAM_KINETIC_STATES && at[j] >= 0; j++)
        SM_ELEMENT_D(K, at[i], at[j]) = (i == j ? c : 0) - J[k][i][j];
  }
}

/* Adds derivative * dX/dx of a changing property to a row. */
static void AddFactor(const Integration *in, const LamEvaluation *e, LamChanging which, PetscInt row,
                      PetscReal derivative, SUNMatrix K)
{
  const PetscInt *at = &in->base.state[LAM_KINETIC_STATES * which];

  for (PetscInt i = 0; i < LAM_KINETIC_STATES; i++)
    if (at[i] >= 0) SM_ELEMENT_D(K, row, at[i]) += derivative * e->factor[which].slope[i];
}

/* Adds the derivatives with respect to cohesion and to the common factor of the walls to a row. */
static void AddProperties(const Integration *in, const LamEvaluation *e, PetscInt row, PetscReal by_cohesion,
                          PetscReal by_walls, SUNMatrix K)
{
  const LamWall *wall = &in->process->scene->micro.wall; /* C1 + C2 is the common factor */
  const PetscReal common = e->factor[LAM_CHANGING_WALLS].value;

  if (in->process->breaks) by_walls = 0; /* not known: walls change, and the lamella does not change with them */
  AddFactor(in, e, LAM_CHANGING_LAMELLA, row, by_cohesion * in->process->scene->cohesion, K);
  AddFactor(in, e, LAM_CHANGING_WALLS, row, by_walls * e->walls / common, K);
  AddFactor(in, e, LAM_CHANGING_C1, row, by_walls * common * wall->C1, K);
  AddFactor(in, e, LAM_CHANGING_C2, row, by_walls * common * wall->C2, K);
}

static void WaterJacobian(const Integration *in, const LamEvaluation *e, const LamProcessTissue *tissue, PetscReal c,
                          SUNMatrix K)
{
  const Layout *l = &in->layout;
  const LamResponse *r = &e->response;
  LamFlow flow;

  LamProcessFlow(in->process, &in->process->cells, e, tissue->water, tissue->turgor, &flow);
  const PetscBool flows = (PetscBool)isfinite(flow.conductance);
  const PetscReal scale = flows ? -flow.conductance : 1;

  if (!flows && in->process->plasmolysed) {
    SM_ELEMENT_D(K, l->water, l->water) = flow.osmotic_water;
    SM_ELEMENT_D(K, l->turgor, l->turgor) = 1;
    AddFactor(in, e, LAM_CHANGING_SOLUTES, l->water, flow.osmotic_solutes, K);
    return;
  }
  SM_ELEMENT_D(K, l->water, l->water) = (flows ? c : 0) + scale * flow.drive_water;
  SM_ELEMENT_D(K, l->water, l->turgor) = scale * flow.drive_turgor;
  AddFactor(in, e, LAM_CHANGING_SOLUTES, l->water, scale * flow.drive_solutes, K);
  AddFactor(in, e, LAM_CHANGING_REFLECTION, l->water, scale * flow.drive_reflection, K);
  if (flows && e->factor[LAM_CHANGING_PERMEABILITY].value > 0)
    AddFactor(in, e, LAM_CHANGING_PERMEABILITY, l->water,
              -flow.conductance * flow.drive / e->factor[LAM_CHANGING_PERMEABILITY].value, K);
  if (in->process->plasmolysed) {
    SM_ELEMENT_D(K, l->turgor, l->turgor) = 1;
    return;
  }
  SM_ELEMENT_D(K, l->turgor, l->water) = 1;
  SM_ELEMENT_D(K, l->turgor, l->turgor) = r->energy_turgor2;
  for (PetscInt k = 0; k < 9; k++)
    if (l->F[k] >= 0) SM_ELEMENT_D(K, l->turgor, l->F[k]) = -LamProcessLumenSlope(in->process, e, k);
  AddProperties(in, e, l->turgor, r->energy_turgor_cohesion,
                -(tissue->turgor * r->energy_turgor2 + e->cohesion * r->energy_turgor_cohesion) / e->walls, K);
}

static void StressJacobian(const Integration *in, const LamEvaluation *e, const LamProcessTissue *tissue, SUNMatrix K)
{
  const Layout *l = &in->layout;
  const LamResponse *r = &e->response;

  for (PetscInt i = 0; i < 9; i++) {
    if (l->F[i] < 0) continue;
    for (PetscInt k = 0; k < 9; k++)
      if (l->F[k] >= 0) SM_ELEMENT_D(K, l->F[i], l->F[k]) = LamProcessStiffness(in->process, e, i, k);
    if (l->turgor >= 0) SM_ELEMENT_D(K, l->F[i], l->turgor) = r->P_turgor[i];
    AddProperties(in, e, l->F[i], r->P_cohesion[i],
                  (r->P[i] - tissue->turgor * r->P_turgor[i] - e->cohesion * r->P_cohesion[i]) / e->walls, K);
  }
}

/* IDALsJacFn: dG/dy + c dG/dy' */
static int Jacobian(PetscReal t, PetscReal c, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix K, void *ctx,
                    N_Vector work1, N_Vector work2, N_Vector work3)
{
  Integration *in = (Integration *)ctx;
  LamProcessTissue tissue;
  LamEvaluation e;
  const int flag = EvaluateAt(in, t, y, &tissue, &e);

  if (flag) return flag;
  in->process->counts.jacobians++;
  KineticJacobian(in, &e, tissue.x, c, K);
  if (in->layout.water >= 0) WaterJacobian(in, &e, &tissue, c, K);
  if (in->layout.idle >= 0) SM_ELEMENT_D(K, in->layout.idle, in->layout.idle) = c;
  StressJacobian(in, &e, &tissue, K);
  return 0;
}

/* IDARootFn */
static int Roots(PetscReal t, N_Vector y, N_Vector yp, PetscReal excess[], void *ctx)
{
  Integration *in = (Integration *)ctx;
  LamProcessTissue tissue;
  LamEvaluation e;
  const int flag = EvaluateAt(in, t, y, &tissue, &e);

  if (flag) return -1; /* IDA cannot recover from a failure here */
  in->process->error = LamProcessQueryReference(in->process, &e);
  if (in->process->error) return -1;
  for (PetscInt k = 0; k < in->base.event_count; k++) {
    excess[k] = LamProcessExcess(in->process, in->base.events[k], &e, tissue.water, tissue.turgor);
    if (!isfinite(excess[k])) excess[k] = -1;
  }
  return 0;
}

/* ---- creation and destruction ---- */

/* Absolute tolerances: kinetic states and strains relative to 1, water relative to its initial volume, turgor relative
   to the scale of pressures. */
static void SetTolerances(Integration *in)
{
  LamProcess process = in->process;
  const Layout *l = &in->layout;
  PetscReal *a = N_VGetArrayPointer(in->tolerance), *id = N_VGetArrayPointer(in->base.id);
  const PetscReal relative = process->spec->tolerance;

  for (PetscInt k = 0; k < in->base.n; k++)
    a[k] = relative * (k == l->turgor ? process->pressure : k == l->water ? 1e-3 * process->cells.water : 0.1);
  N_VConst(0, in->base.id);
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++) {
    const PetscInt at = in->base.state[k];

    if (at < 0) continue;
    a[at] = 1e-3 * relative;
    id[at] = 1;
  }
  if (l->water >= 0 && isfinite(process->spec->water.permeability)) id[l->water] = 1;
  if (l->idle >= 0) id[l->idle] = 1;
}

/* Sets y' of the differential unknowns: -(residual at y' = 0). */
static PetscErrorCode StartRates(Integration *in, PetscReal t)
{
  LamIntegrator *base = &in->base;
  const PetscReal *id = N_VGetArrayPointer(base->id);
  PetscReal *yp = N_VGetArrayPointer(base->yp);
  N_Vector r = N_VClone(base->y);

  PetscFunctionBeginUser;
  N_VConst(0, base->yp);
  const int flag = Residual(t, base->y, base->yp, r, in);
  for (PetscInt k = 0; k < base->n && !flag; k++)
    if (id[k] != 0) yp[k] = -N_VGetArrayPointer(r)[k];
  N_VDestroy(r);
  PetscCall(in->process->error);
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(LamProcess process, Integration *in)
{
  LamIntegrator *base = &in->base;

  PetscFunctionBeginUser;
  in->process = process;
  PetscCall(LamIntegratorCreate(process, MPI_COMM_NULL, base));
  base->event_count = LamProcessListEvents(process, base->events);
  LayOut(in);
  base->y = N_VNew_Serial(base->n, base->context);
  base->yp = N_VClone(base->y);
  base->id = N_VClone(base->y);
  in->tolerance = N_VClone(base->y);
  Pack(in, &process->tissue, N_VGetArrayPointer(base->y));
  SetTolerances(in);
  PetscCall(StartRates(in, process->tissue.time));
  PetscCall(LamIntegratorStart(base, Residual, Roots, in));
  LamCallSUN(IDASVtolerances(base->ida, process->spec->tolerance, in->tolerance));
  LamCallSUN(IDASetMaxNumSteps(base->ida, MAX_STEPS));
  /* the history of walls is of second order in the step, whose length follows from the error of this order */
  if (LamWallsRelax(&process->scene->micro)) LamCallSUN(IDASetMaxOrd(base->ida, 2));
  in->K = SUNDenseMatrix(base->n, base->n, base->context);
  in->solver = SUNLinSol_Dense(base->y, in->K, base->context);
  LamCallSUN(IDASetLinearSolver(base->ida, in->solver, in->K));
  LamCallSUN(IDASetJacFn(base->ida, Jacobian));
  PetscFunctionReturn(0);
}

static void Destroy(Integration *in)
{
  if (in->solver) SUNLinSolFree(in->solver);
  if (in->K) SUNMatDestroy(in->K);
  if (in->tolerance) N_VDestroy(in->tolerance);
  LamIntegratorDestroy(&in->base);
}

/* ---- time loop ---- */

/* Reports the outputs up to a time that the integrator has passed. */
static PetscErrorCode ReportUpTo(Integration *in, PetscReal time)
{
  LamProcess process = in->process;
  N_Vector y = N_VClone(in->base.y);
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  while (!ierr && process->next_output <= time && process->next_output <= process->spec->duration) {
    const LamProcessTissue tissue = IDAGetDky(in->base.ida, process->next_output, 0, y) == IDA_SUCCESS
                                        ? Unpack(in, process->next_output, y)
                                        : process->tissue;

    ierr = LamProcessReport(process, &tissue, LAM_EVENT_COUNT);
    LamProcessNextOutput(process);
  }
  N_VDestroy(y);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Follow(Integration *in, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok)
{
  LamProcess process = in->process;
  int flag = IDA_SUCCESS;
  PetscReal t = process->segment.start;

  PetscFunctionBeginUser;
  if (process->has_history) PetscCall(ReportUpTo(in, t));
  while ((flag == IDA_SUCCESS || flag == IDA_TSTOP_RETURN) && !process->stopped) {
    process->trouble[0] = '\0';
    if (process->has_history) /* a state in between would be of another history */
      LamCallSUN(IDASetStopTime(in->base.ida, PetscMin(process->next_output, process->segment.end)));
    flag = IDASolve(in->base.ida, process->segment.end, &t, in->base.y, in->base.yp, IDA_ONE_STEP);
    PetscCall(process->error);
    if (flag < 0) break;
    process->counts.steps++;
    process->tissue = Unpack(in, t, in->base.y);
    PetscCall(LamProcessAccept(process));
    PetscCall(ReportUpTo(in, t));
    if (t >= process->segment.end) break;
  }
  *ok = (PetscBool)(flag >= 0 && !process->stopped);
  PetscCall(LamIntegratorTake(&in->base, flag, happened));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessIntegrate(LamProcess process, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok)
{
  Integration in = {0};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  ierr = Create(process, &in);
  if (!ierr) ierr = Follow(&in, happened, ok);
  Destroy(&in);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
