/*
  Failure along a program of loads.

  Method. The states are evaluated in order. A criterion that is reached at a new state, but not at the previous one, is
  bracketed on the load path between them (linear in F, turgor and cohesion) to RESOLUTION of its length. Each trial
  load is solved from the lower end of the bracket, where the criterion is not reached: contact and stable branches are
  lost more easily than they are recovered. Trial points come from the secant of the excess, shifted slightly into the
  wider part of the bracket, and every third from bisection. Criteria without a continuous excess use bisection only.
  The end of a stable branch is solved once more from the lower end of the bracket, because a long step may leave a
  branch that continues.

  A state without a solution ends the evaluation. Before that, the path to it is bisected APPROACHES times, so that
  criteria reached on its solvable part are found.
*/
#include "failure_criteria.h"

const char *const LamFailureModeNames[] = {LAM_FAILURE_MODES(LAM_NAME_ENTRY)};
const char *const LamCriterionNames[] = {LAM_CRITERIA(LAM_NAME_ENTRY)};

#define RESOLUTION 1e-3 /* fraction of the load path between two states */
#define APPROACHES 3
#define ATTEMPTS 3 /* at an instability */

static const LamStrength not_given = {NAN, NAN, NAN};

/* A solved point on the load path between two states. */
typedef struct {
  PetscReal share; /* fraction of the load path */
  LamResponse responses[2];
  LamRVEState states[2]; /* owned */
} Point;

/* The load path from one state to the next. */
typedef struct {
  LamMeshes *meshes;
  PetscReal from;  /* load factor at share 0 */
  PetscReal reach; /* load factor at share 1 minus `from` */
  LamLoad ends[2];
  LamStressControl control; /* at share 1; components of F that follow are already in the loads */
  PetscReal P[9];           /* at share 0 */
} Way;

LamFailureMode LamFailureModeOf(LamCriterion criterion)
{
  static const LamFailureMode modes[] = {[LAM_CRITERION_LAMELLA_NORMAL] = LAM_FAILURE_SEPARATION,
                                         [LAM_CRITERION_LAMELLA_SHEAR] = LAM_FAILURE_SEPARATION,
                                         [LAM_CRITERION_CONTACT] = LAM_FAILURE_SEPARATION,
                                         [LAM_CRITERION_WALL] = LAM_FAILURE_RUPTURE,
                                         [LAM_CRITERION_STABILITY] = LAM_FAILURE_BUCKLING,
                                         [LAM_CRITERION_TURGOR] = LAM_FAILURE_TURGOR_LOSS,
                                         [LAM_CRITERION_COUNT] = LAM_FAILURE_NONE};

  return modes[criterion];
}

/* ---- points ---- */

static PetscErrorCode PointCreate(const LamMeshes *meshes, Point *point)
{
  PetscFunctionBeginUser;
  *point = (Point){0};
  for (PetscInt m = 0; m < meshes->count; m++) PetscCall(LamRVEStateCreate(meshes->rve[m], &point->states[m]));
  PetscFunctionReturn(0);
}

static PetscErrorCode PointDestroy(Point *point)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateDestroy(&point->states[m]));
  PetscFunctionReturn(0);
}

static PetscErrorCode CopyStates(const LamMeshes *meshes, const LamRVEState from[2], const LamRVEState to[2])
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < meshes->count; m++) PetscCall(LamRVEStateCopy(from[m], to[m]));
  PetscFunctionReturn(0);
}

static PetscErrorCode PointCopy(const LamMeshes *meshes, const Point *from, Point *to)
{
  PetscFunctionBeginUser;
  to->share = from->share;
  for (PetscInt m = 0; m < 2; m++) to->responses[m] = from->responses[m];
  PetscCall(CopyStates(meshes, from->states, to->states));
  PetscFunctionReturn(0);
}

static LamLoad LoadAt(const Way *way, PetscReal share)
{
  const LamLoad *a = &way->ends[0], *b = &way->ends[1];
  LamLoad load;

  for (int i = 0; i < 9; i++) load.F[i] = (1 - share) * a->F[i] + share * b->F[i];
  load.turgor = (1 - share) * a->turgor + share * b->turgor;
  load.cohesion = (1 - share) * a->cohesion + share * b->cohesion;
  return load;
}

static LamStressControl ControlAt(const Way *way, PetscReal share)
{
  LamStressControl control = way->control;

  for (int i = 0; i < 9 && share < 1; i++) control.P[i] = (1 - share) * way->P[i] + share * way->control.P[i];
  return control;
}

/* The load path to a load, from a state with load `before` and stress P. `control` may be NULL. */
static Way MakeWay(LamMeshes *meshes, PetscReal from, PetscReal reach, const LamLoad *before, const PetscReal P[9],
                   const LamLoad *load, const LamStressControl *control)
{
  Way way = {.meshes = meshes, .from = from, .reach = reach, .ends = {*before, LamLoadAfter(load, control, before->F)}};

  if (control) way.control = *control;
  for (int i = 0; i < 9; i++) {
    way.P[i] = P[i];
    way.control.follows[i] = PETSC_FALSE;
  }
  return way;
}

/* With one mesh, its response is used for both. */
static void Complete(const LamMeshes *meshes, LamResponse responses[2])
{
  if (meshes->count < 2) responses[1] = responses[0];
}

/* Solves at a fraction of the load path, starting from the states of `start`. *known: a solution was found. */
static PetscErrorCode SolveAt(const Way *way, const Point *start, PetscReal share, Point *point, PetscBool *known)
{
  LamMeshes *meshes = way->meshes;
  const LamLoad load = LoadAt(way, share);
  const LamStressControl control = ControlAt(way, share);

  PetscFunctionBeginUser;
  PetscCall(CopyStates(meshes, start->states, meshes->state));
  PetscCall(PetscArraycpy(meshes->F, start->responses[0].load.F, 9));
  PetscCall(LamMeshesSolve(meshes, &load, &control, point->responses));
  Complete(meshes, point->responses);
  PetscCall(CopyStates(meshes, meshes->state, point->states));
  point->share = share;
  *known = LamHaveFields(point->responses);
  PetscFunctionReturn(0);
}

/* ---- one criterion between two states ---- */

/* Bracket of one criterion. */
typedef struct {
  LamCriterion criterion;
  Point *low;  /* not reached */
  Point *high; /* reached */
  PetscReal excess[2];
  PetscInt tries;
} Search;

static PetscReal ExcessOf(const LamFailure *failure, const Search *search, const Point *point)
{
  return LamCriterionExcess(search->criterion, failure, search->low->responses, point->responses);
}

/* Next trial point. The secant converges from one side; a point half a resolution beyond it closes the bracket. */
static PetscReal NextShare(const Search *search)
{
  const PetscReal low = search->low->share, high = search->high->share, middle = 0.5 * (low + high);
  const PetscReal secant = low + (high - low) * search->excess[0] / (search->excess[0] - search->excess[1]);
  const PetscReal beyond = 0.45 * RESOLUTION * (secant - low < high - secant ? 1 : -1);

  if (search->tries % 3 == 2 || search->criterion == LAM_CRITERION_CONTACT ||
      search->criterion == LAM_CRITERION_STABILITY)
    return middle;
  return PetscMin(PetscMax(secant + beyond, low + 0.1 * RESOLUTION), high - 0.1 * RESOLUTION);
}

/* Narrows the bracket to RESOLUTION; *known is PETSC_FALSE if a load in it has no solution. */
static PetscErrorCode Narrow(LamFailure *failure, const Way *way, Search *search, Point *point, PetscBool *known)
{
  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  while (search->high->share - search->low->share > RESOLUTION) {
    PetscReal excess;

    PetscCall(SolveAt(way, search->low, NextShare(search), point, known));
    if (!*known) break;
    excess = ExcessOf(failure, search, point);
    search->excess[excess >= 0] = excess;
    PetscCall(PointCopy(way->meshes, point, excess >= 0 ? search->high : search->low));
    search->tries++;
  }
  PetscFunctionReturn(0);
}

/* The place [3] at which a criterion is reached; NULL: it has none. */
static const PetscReal *PlaceOf(const LamResponse *r, LamCriterion criterion)
{
  switch (criterion) {
  case LAM_CRITERION_LAMELLA_NORMAL:
    return r->normal_place;
  case LAM_CRITERION_LAMELLA_SHEAR:
    return r->shear_place;
  case LAM_CRITERION_CONTACT: /* a face may be free of traction without any gap */
    return LamGapIsVisible(r) ? r->gap_place : r->normal_place;
  case LAM_CRITERION_WALL:
    return r->wall_place;
  default:
    return NULL;
  }
}

static void KeepOnset(LamFailure *failure, const Way *way, const Search *search)
{
  LamCriterionOnset *onset = &failure->onset[search->criterion];
  const PetscReal *place = PlaceOf(&search->high->responses[0], search->criterion);

  onset->bracket[0] = way->from + way->reach * search->low->share;
  onset->bracket[1] = onset->factor = way->from + way->reach * search->high->share;
  onset->response = search->high->responses[0];
  for (PetscInt i = 0; i < 3; i++) onset->place[i] = place ? place[i] : NAN;
}

/* Finds the onset of the criterion between two points. It is discarded if only a long step reaches the criterion. */
static PetscErrorCode Seek(LamFailure *failure, const Way *way, LamCriterion criterion, const Point *from,
                           const Point *to)
{
  Point low, high, point;
  Search search = {.criterion = criterion, .low = &low, .high = &high};
  PetscBool known, confirmed = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PointCreate(way->meshes, &low));
  PetscCall(PointCreate(way->meshes, &high));
  PetscCall(PointCreate(way->meshes, &point));
  PetscCall(PointCopy(way->meshes, from, &low));
  PetscCall(PointCopy(way->meshes, to, &high));
  search.excess[0] = ExcessOf(failure, &search, &low);
  search.excess[1] = ExcessOf(failure, &search, &high);
  for (PetscInt k = 0; k < ATTEMPTS; k++) {
    PetscCall(Narrow(failure, way, &search, &point, &known));
    if (!known || criterion != LAM_CRITERION_STABILITY) break;
    PetscCall(SolveAt(way, &low, high.share, &point, &known));
    confirmed = (PetscBool)(!known || ExcessOf(failure, &search, &point) >= 0);
    if (confirmed) break;
    PetscCall(PointCopy(way->meshes, &point, &low)); /* still on the stable branch: its end lies further along */
    PetscCall(PointCopy(way->meshes, to, &high));
  }
  if (confirmed) KeepOnset(failure, way, &search);
  PetscCall(PointDestroy(&low));
  PetscCall(PointDestroy(&high));
  PetscCall(PointDestroy(&point));
  PetscFunctionReturn(0);
}

/* ---- from state to state ---- */

/* Finds the onsets of all criteria that are reached at `to` and were not reached before. */
static PetscErrorCode Judge(LamFailure *failure, const Way *way, const Point *from, const Point *to)
{
  PetscFunctionBeginUser;
  for (int c = 0; c < LAM_CRITERION_COUNT; c++) {
    const LamCriterion criterion = (LamCriterion)c;

    if (!failure->onset[c].judged || !isnan(failure->onset[c].factor)) continue;
    if (!(LamCriterionExcess(criterion, failure, from->responses, to->responses) >= 0)) continue; /* NaN: not reached */
    PetscCall(Seek(failure, way, criterion, from, to));
  }
  PetscFunctionReturn(0);
}

/* Makes `point` the last solved one. */
static PetscErrorCode Accept(LamFailure *failure, const Way *way, const Point *point)
{
  PetscFunctionBeginUser;
  failure->followed = way->from + way->reach * point->share;
  for (PetscInt m = 0; m < 2; m++) failure->last[m] = point->responses[m];
  if (LamIsTurgid(&point->responses[0])) failure->turgid = PETSC_TRUE;
  if (LamIsTaut(&point->responses[0])) failure->taut = PETSC_TRUE;
  PetscCall(CopyStates(way->meshes, point->states, failure->before));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepReason(LamFailure *failure, PetscReal factor, const LamResponse responses[2])
{
  const PetscInt m = LamResponseHasFields(&responses[0]) ? 1 : 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(failure->reason, sizeof(failure->reason), "load factor %.4g has no answer%s: %s",
                          (double)factor, m ? " on the second mesh" : "", responses[m].reason));
  PetscFunctionReturn(0);
}

/* `to` has no solution: bisects the path from `from` to it and evaluates the criteria at the solved points. */
static PetscErrorCode Approach(LamFailure *failure, const Way *way, Point *from, Point *to)
{
  PetscReal unknown = 1;
  Point point;

  PetscFunctionBeginUser;
  PetscCall(KeepReason(failure, way->from + way->reach, to->responses));
  PetscCall(PointCreate(way->meshes, &point));
  for (PetscInt k = 0; k < APPROACHES; k++) {
    PetscBool known;

    PetscCall(SolveAt(way, from, 0.5 * (from->share + unknown), &point, &known));
    if (way->meshes->stopped) break;
    if (!known) {
      unknown = point.share;
      PetscCall(KeepReason(failure, way->from + way->reach * unknown, point.responses));
      continue;
    }
    PetscCall(Judge(failure, way, from, &point));
    PetscCall(Accept(failure, way, &point));
    PetscCall(PointCopy(way->meshes, &point, from));
  }
  PetscCall(PointDestroy(&point));
  PetscFunctionReturn(0);
}

static PetscBool IsReached(const LamFailure *failure)
{
  for (int c = 0; c < LAM_CRITERION_COUNT; c++)
    if (!isnan(failure->onset[c].factor)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Evaluates the first solved load, at `way->from`, by itself: criteria reached there have their onset there or before.
 */
static PetscErrorCode JudgeFirst(LamFailure *failure, const Way *way, const Point *point)
{
  Point start;

  PetscFunctionBeginUser;
  PetscCall(PointCreate(way->meshes, &start)); /* the stress-free reference */
  for (PetscInt m = 0; m < 2; m++) start.responses[m] = point->responses[m];
  start.responses[0].branch = 0;
  PetscCall(Judge(failure, way, &start, point));
  PetscCall(Accept(failure, way, point));
  PetscCall(PointDestroy(&start));
  PetscFunctionReturn(0);
}

/* Evaluates a new state and the load path to it. */
static PetscErrorCode Take(LamFailure *failure, LamMeshes *meshes, PetscInt number, Point *to)
{
  const PetscBool known = LamHaveFields(to->responses), first = (PetscBool)isnan(failure->followed);
  const LamFailureProgram *program = &failure->program;
  Way way = MakeWay(meshes, (PetscReal)(number - 1), 1, &failure->last[0].load, failure->last[0].P,
                    &program->loads[number - 1], program->controls ? &program->controls[number - 1] : NULL);
  Point from;

  PetscFunctionBeginUser;
  PetscCall(PointCreate(meshes, &from));
  PetscCall(CopyStates(meshes, failure->before, from.states));
  for (PetscInt m = 0; m < 2; m++) from.responses[m] = failure->last[m];
  if (first && known) {
    way =
        MakeWay(meshes, (PetscReal)number, 0, &to->responses[0].load, to->responses[0].P, &to->responses[0].load, NULL);
    to->share = 0;
    PetscCall(JudgeFirst(failure, &way, to));
  } else if (first) {
    PetscCall(KeepReason(failure, (PetscReal)number, to->responses));
  } else if (known) {
    to->share = 1;
    PetscCall(Judge(failure, &way, &from, to));
    PetscCall(Accept(failure, &way, to));
  } else {
    PetscCall(Approach(failure, &way, &from, to));
  }
  PetscCall(PointDestroy(&from));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureWatch(LamFailure *failure, LamMeshes *meshes, PetscInt number, const LamResponse responses[2])
{
  Point point;

  PetscFunctionBeginUser;
  if (failure->reason[0] || (failure->program.stop_at_first && IsReached(failure))) PetscFunctionReturn(0);
  PetscCall(PointCreate(meshes, &point));
  PetscCall(CopyStates(meshes, meshes->state, point.states));
  for (PetscInt m = 0; m < meshes->count; m++) point.responses[m] = responses[m];
  Complete(meshes, point.responses);
  PetscCall(Take(failure, meshes, number, &point));
  PetscCall(CopyStates(meshes, point.states, meshes->state));
  if (LamResponseHasFields(&point.responses[0])) PetscCall(PetscArraycpy(meshes->F, point.responses[0].load.F, 9));
  PetscCall(PointDestroy(&point));
  PetscFunctionReturn(0);
}

/* ---- begin and end ---- */

/* Solves and evaluates state 0; if it has no solution, the program begins with state 1. */
static PetscErrorCode Begin(LamFailure *failure, LamMeshes *meshes)
{
  const LamFailureProgram *program = &failure->program;
  const PetscReal none[9] = {0};
  LamLoad load = program->loads[0];
  PetscBool known;
  Point reference, zero;
  Way way;

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++) load.F[i] = i % 4 ? 0 : 1;
  way = MakeWay(meshes, 0, 0, &load, none, &load, program->controls);
  PetscCall(LamResponseInit(&load, &failure->last[0]));
  PetscCall(PointCreate(meshes, &reference));
  reference.responses[0].load = load;
  PetscCall(PointCreate(meshes, &zero));
  PetscCall(SolveAt(&way, &reference, 0, &zero, &known));
  if (known) PetscCall(JudgeFirst(failure, &way, &zero));
  PetscCall(PointDestroy(&reference));
  PetscCall(PointDestroy(&zero));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureCreate(LamMeshes *meshes, const LamFailureProgram *program, LamFailure *failure)
{
  Point present;

  PetscFunctionBeginUser;
  *failure = (LamFailure){.factor = NAN, .followed = NAN, .criterion = LAM_CRITERION_COUNT, .program = *program};
  if (!program->strength) failure->program.strength = &not_given;
  for (int c = 0; c < LAM_CRITERION_COUNT; c++) {
    LamCriterionOnset *onset = &failure->onset[c];

    *onset = (LamCriterionOnset){.factor = NAN, .bracket = {NAN, NAN}, .place = {NAN, NAN, NAN}};
    onset->judged = LamCriterionIsJudged((LamCriterion)c, program->interface, failure->program.strength);
  }
  for (PetscInt m = 0; m < meshes->count; m++) PetscCall(LamRVEStateCreate(meshes->rve[m], &failure->before[m]));
  PetscCall(PointCreate(meshes, &present));
  PetscCall(CopyStates(meshes, meshes->state, present.states));
  PetscCall(Begin(failure, meshes));
  PetscCall(CopyStates(meshes, present.states, meshes->state));
  PetscCall(PointDestroy(&present));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureConclude(LamFailure *failure)
{
  const PetscBool to_the_end = (PetscBool)(failure->followed >= (PetscReal)failure->program.count);

  PetscFunctionBeginUser;
  if (!to_the_end && !failure->reason[0] && !(failure->program.stop_at_first && IsReached(failure)))
    PetscCall(PetscSNPrintf(failure->reason, sizeof(failure->reason), "stopped by a signal behind load factor %.4g",
                            (double)(isnan(failure->followed) ? 0 : failure->followed)));
  for (int c = 0; c < LAM_CRITERION_COUNT; c++) {
    const PetscReal factor = failure->onset[c].factor;

    if (!isnan(factor) && !(factor >= failure->factor)) { /* also if failure->factor is NaN */
      failure->factor = factor;
      failure->criterion = (LamCriterion)c;
    }
  }
  failure->mode = LamFailureModeOf(failure->criterion);
  if (failure->criterion == LAM_CRITERION_COUNT && failure->reason[0]) failure->mode = LAM_FAILURE_UNKNOWN;
  failure->response =
      failure->criterion == LAM_CRITERION_COUNT ? failure->last[0] : failure->onset[failure->criterion].response;
  failure->load = failure->response.load;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureDestroy(LamFailure *failure)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateDestroy(&failure->before[m]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureFind(LamMeshes *meshes, const LamFailureProgram *program, LamFailure *failure)
{
  PetscFunctionBeginUser;
  PetscCall(LamFailureCreate(meshes, program, failure));
  for (PetscInt m = 0; m < meshes->count; m++) PetscCall(LamRVEStateReset(meshes->rve[m], meshes->state[m]));
  for (PetscInt k = 0; k < program->count && !failure->reason[0]; k++) {
    LamResponse responses[2];

    if (program->stop_at_first && IsReached(failure)) break;
    PetscCall(LamMeshesSolve(meshes, &program->loads[k], program->controls ? &program->controls[k] : NULL, responses));
    if (meshes->stopped) break;
    PetscCall(LamFailureWatch(failure, meshes, k + 1, responses));
  }
  PetscCall(LamFailureConclude(failure));
  PetscCall(LamFailureDestroy(failure));
  PetscFunctionReturn(0);
}
