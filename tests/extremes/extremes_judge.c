#include "extremes_judge.h"
#include "solve.h"
#include <math.h>
#include <time.h>

#define SAME 1e-5        /* relative difference of P of one and the same discrete state */
#define FINER_LIMIT 1500 /* elements of a state that is solved on a finer mesh, too */
#define RAMP 7           /* states of the second path */
#define CONFIDENCE 3.0   /* estimates that the error may reach */
#define LEAST_ERROR 1e-3 /* below it a mesh is not held to its estimate */

const char *const ExtremesVerdictNames[] = {EXTREMES_VERDICTS(LAM_NAME_ENTRY)};

static double Now(void)
{
  struct timespec t;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static PetscBool PastDeadline(void *ctx)
{
  return (PetscBool)(Now() > *(double *)ctx);
}

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamRVEState state;
  double deadline;
} Solver;

static PetscErrorCode SolverCreate(const ExtremesCase *c, const ExtremesRoute *route, double seconds, Solver *s)
{
  char text[EXTREMES_TEXT];

  PetscFunctionBeginUser;
  ExtremesSceneWrite(c, route, sizeof(text), text);
  PetscCall(LamSceneReadText("extreme.yaml", text, &s->scene));
  s->scene->micro.grading = PetscMax(0.0, s->scene->micro.grading);
  s->deadline = Now() + seconds;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &s->rve));
  PetscCall(LamRVESetMicrostructure(s->rve, &s->scene->micro));
  PetscCall(LamRVESetStrategy(s->rve, s->scene->strategy));
  PetscCall(LamRVESetInterrupt(s->rve, PastDeadline, &s->deadline));
  PetscCall(LamRVESetUp(s->rve));
  PetscCall(LamRVEStateCreate(s->rve, &s->state));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolverDestroy(Solver *s)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&s->state));
  PetscCall(LamRVEDestroy(&s->rve));
  PetscCall(LamSceneDestroy(&s->scene));
  PetscFunctionReturn(0);
}

/* The last state of the scene. */
static PetscErrorCode SolveLoads(Solver *s, LamResponse *response)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->scene->load_count; k++)
    PetscCall(LamRVESolve(s->rve, &s->scene->loads[k], s->state, response));
  PetscFunctionReturn(0);
}

/* What a second route may take: it has to be worth its time. */
static double RouteSeconds(const ExtremesResult *result)
{
  return PetscMin(EXTREMES_ROUTE_SECONDS, 1.0 + 15.0 * result->seconds);
}

static PetscErrorCode SolveRoute(const ExtremesCase *c, const ExtremesRoute *route, double seconds,
                                 LamResponse *response)
{
  Solver s;

  PetscFunctionBeginUser;
  PetscCall(SolverCreate(c, route, seconds, &s));
  PetscCall(SolveLoads(&s, response));
  PetscCall(SolverDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscBool AllFinite(const LamResponse *r)
{
  PetscBool finite = (PetscBool)(isfinite(r->energy) && isfinite(r->lumen_fraction) && isfinite(r->opening_fraction));
  const PetscInt in_plane[4] = {0, 1, 3, 4};

  for (PetscInt i = 0; i < 4; i++) {
    finite = (PetscBool)(finite && isfinite(r->P[in_plane[i]]) && isfinite(r->P_turgor[in_plane[i]]));
    for (PetscInt j = 0; j < 4; j++)
      finite = (PetscBool)(finite && isfinite(r->tangent[9 * in_plane[i] + in_plane[j]]));
  }
  return finite;
}

static PetscReal Difference(LamStressScale scale, const LamResponse *a, const LamResponse *b)
{
  return a->status == LAM_CONVERGED && b->status == LAM_CONVERGED ? LamStressError(scale, a->P, b->P) : NAN;
}

static ExtremesVerdict Verdict(const ExtremesResult *r)
{
  const PetscReal estimate = r->state.error_estimate; /* NaN: nothing is claimed */
  const PetscBool too_small = (PetscBool)(r->mesh_error > PetscMax(LEAST_ERROR, CONFIDENCE * estimate));
  const PetscBool path = (PetscBool)(r->path_error <= SAME), other = (PetscBool)(r->other_error <= SAME);

  if (r->seconds > EXTREMES_SECONDS) return EXTREMES_SLOW;
  if (r->state.status == LAM_NOT_CONVERGED || r->state.status == LAM_OUT_OF_REACH) return EXTREMES_NUMERICAL;
  if (LamResponseHasFields(&r->state) && !AllFinite(&r->state)) return EXTREMES_NOT_FINITE;
  if (r->state.status != LAM_CONVERGED) return EXTREMES_REASON;
  if (!isnan(estimate) && too_small) return EXTREMES_WRONG;
  if (r->path_error > SAME || r->other_error > SAME) return EXTREMES_BRANCH;
  return path || other ? EXTREMES_CONFIRMED : EXTREMES_UNCONFIRMED;
}

PetscErrorCode ExtremesJudge(const ExtremesCase *c, PetscBool routes, ExtremesResult *result)
{
  const ExtremesRoute plain = {.finer = 1, .ramp = 1}, ramp = {.finer = 1, .ramp = RAMP};
  const ExtremesRoute one_step = {.finer = 1, .ramp = 1, .one_step = PETSC_TRUE}, finer = {.finer = 2, .ramp = 1};
  const double begin = Now();
  LamRVEEstimate estimate;
  LamStressScale scale;
  Solver s;

  PetscFunctionBeginUser;
  *result = (ExtremesResult){.path_error = NAN, .other_error = NAN, .mesh_error = NAN};
  PetscCall(SolverCreate(c, &plain, 2 * EXTREMES_SECONDS, &s));
  PetscCall(SolveLoads(&s, &result->state));
  result->seconds = Now() - begin;
  scale = LamStressScaleOf(&s.rve->micro);
  PetscCall(LamRVEEstimateCreate(s.rve, &estimate));
  PetscCall(LamRVEEstimateError(estimate, s.state, &result->state));
  PetscCall(LamRVEEstimateDestroy(&estimate));
  routes = (PetscBool)(routes && result->state.status == LAM_CONVERGED);
  if (routes) {
    PetscCall(SolveRoute(c, &ramp, RouteSeconds(result), &result->path));
    result->path_error = Difference(scale, &result->state, &result->path);
    if (c->contact) {
      PetscCall(SolveRoute(c, &one_step, RouteSeconds(result), &result->other));
      result->other_error = Difference(scale, &result->state, &result->other);
    }
    if (s.rve->mesh.element_count <= FINER_LIMIT) {
      PetscCall(SolveRoute(c, &finer, 2 * RouteSeconds(result), &result->finer));
      result->mesh_error = Difference(scale, &result->state, &result->finer);
    }
  }
  PetscCall(SolverDestroy(&s));
  result->verdict = Verdict(result);
  PetscFunctionReturn(0);
}
