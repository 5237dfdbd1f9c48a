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
#include "failure.h"

const char *const LamFailureModeNames[] = {LAM_FAILURE_MODES(LAM_NAME_ENTRY)};
const char *const LamCriterionNames[] = {LAM_CRITERIA(LAM_NAME_ENTRY)};

#define RESOLUTION 1e-3 /* fraction of the load path between two states */
#define APPROACHES 3
#define ATTEMPTS 3 /* at an instability */

static const LamStrength not_given = {NAN, NAN, NAN};

/* The load path from one state to the next. */
typedef struct {
  LamMeshes *meshes;
  PetscReal from;  /* load factor at share 0 */
  PetscReal reach; /* load factor at share 1 minus `from` */
  LamLoad ends[2];
  LamStressControl control; /* at share 1; components of F that follow are already in the loads */
  PetscReal P[9];           /* at share 0 */
} Path;

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

static PetscErrorCode PointCreate(const LamMeshes *meshes, LamPathPoint *point)
{
  PetscFunctionBeginUser;
  *point = (LamPathPoint){0};
  for (PetscInt m = 0; m < meshes->count; m++) PetscCall(LamRVEStateCreate(meshes->rve[m], &point->states[m]));
  PetscFunctionReturn(0);
}

static PetscErrorCode PointDestroy(LamPathPoint *point)
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

static PetscErrorCode PointCopy(const LamMeshes *meshes, const LamPathPoint *from, LamPathPoint *to)
{
  PetscFunctionBeginUser;
  to->share = from->share;
  for (PetscInt m = 0; m < 2; m++) to->responses[m] = from->responses[m];
  PetscCall(CopyStates(meshes, from->states, to->states));
  PetscFunctionReturn(0);
}

static LamStressControl ControlAt(const Path *path, PetscReal share)
{
  LamStressControl control = path->control;

  for (int i = 0; i < 9 && share < 1; i++) control.P[i] = (1 - share) * path->P[i] + share * path->control.P[i];
  return control;
}

/* The load path to a load, from a state with load `before` and stress P. `control` may be NULL. */
static Path MakePath(LamMeshes *meshes, PetscReal from, PetscReal reach, const LamLoad *before, const PetscReal P[9],
                     const LamLoad *load, const LamStressControl *control)
{
  Path path = {
      .meshes = meshes, .from = from, .reach = reach, .ends = {*before, LamLoadAfter(load, control, before->F)}};

  if (control) path.control = *control;
  for (int i = 0; i < 9; i++) {
    path.P[i] = P[i];
    path.control.follows[i] = PETSC_FALSE;
  }
  return path;
}

/* With one mesh, its response is used for both. */
static void Complete(const LamMeshes *meshes, LamResponse responses[2])
{
  if (meshes->count < 2) responses[1] = responses[0];
}

/* Solves at a fraction of the load path, starting from the states of `start`. *known: a solution was found. */
static PetscErrorCode SolveAt(const Path *path, const LamPathPoint *start, PetscReal share, LamPathPoint *point,
                              PetscBool *known)
{
  LamMeshes *meshes = path->meshes;
  const LamLoad load = LamLoadBetween(&path->ends[0], &path->ends[1], share);
  const LamStressControl control = ControlAt(path, share);

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
  LamPathPoint *low;  /* not reached */
  LamPathPoint *high; /* reached */
  PetscReal excess[2];
  PetscInt tries;
} Search;

static PetscReal ExcessOf(const LamFailure *failure, const Search *search, const LamPathPoint *point)
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
static PetscErrorCode Narrow(LamFailure *failure, const Path *path, Search *search, LamPathPoint *point,
                             PetscBool *known)
{
  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  while (search->high->share - search->low->share > RESOLUTION) {
    PetscReal excess;

    PetscCall(SolveAt(path, search->low, NextShare(search), point, known));
    if (!*known) break;
    excess = ExcessOf(failure, search, point);
    search->excess[excess >= 0] = excess;
    PetscCall(PointCopy(path->meshes, point, excess >= 0 ? search->high : search->low));
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

static void KeepOnset(LamFailure *failure, const Path *path, const Search *search)
{
  LamCriterionOnset *onset = &failure->onset[search->criterion];
  const PetscReal *place = PlaceOf(&search->high->responses[0], search->criterion);

  onset->bracket[0] = path->from + path->reach * search->low->share;
  onset->bracket[1] = onset->factor = path->from + path->reach * search->high->share;
  onset->response = search->high->responses[0];
  for (PetscInt i = 0; i < 3; i++) onset->place[i] = place ? place[i] : NAN;
}

/* Finds the onset of the criterion between two points. It is discarded if only a long step reaches the criterion. */
static PetscErrorCode Seek(LamFailure *failure, const Path *path, LamCriterion criterion, const LamPathPoint *from,
                           const LamPathPoint *to)
{
  LamPathPoint low, high, point;
  Search search = {.criterion = criterion, .low = &low, .high = &high};
  PetscBool known, confirmed = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PointCreate(path->meshes, &low));
  PetscCall(PointCreate(path->meshes, &high));
  PetscCall(PointCreate(path->meshes, &point));
  PetscCall(PointCopy(path->meshes, from, &low));
  PetscCall(PointCopy(path->meshes, to, &high));
  search.excess[0] = ExcessOf(failure, &search, &low);
  search.excess[1] = ExcessOf(failure, &search, &high);
  for (PetscInt k = 0; k < ATTEMPTS; k++) {
    PetscCall(Narrow(failure, path, &search, &point, &known));
    if (!known || criterion != LAM_CRITERION_STABILITY) break;
    PetscCall(SolveAt(path, &low, high.share, &point, &known));
    confirmed = (PetscBool)(!known || ExcessOf(failure, &search, &point) >= 0);
    if (confirmed) break;
    PetscCall(PointCopy(path->meshes, &point, &low)); /* still on the stable branch: its end lies further along */
    PetscCall(PointCopy(path->meshes, to, &high));
  }
  if (confirmed) KeepOnset(failure, path, &search);
  PetscCall(PointDestroy(&low));
  PetscCall(PointDestroy(&high));
  PetscCall(PointDestroy(&point));
  PetscFunctionReturn(0);
}

/* ---- from state to state ---- */

/* Finds the onsets of all criteria that are reached at `to` and were not reached before. */
static PetscErrorCode Judge(LamFailure *failure, const Path *path, const LamPathPoint *from, const LamPathPoint *to)
{
  PetscFunctionBeginUser;
  for (int c = 0; c < LAM_CRITERION_COUNT; c++) {
    const LamCriterion criterion = (LamCriterion)c;

    if (!failure->onset[c].judged || !isnan(failure->onset[c].factor)) continue;
    if (!(LamCriterionExcess(criterion, failure, from->responses, to->responses) >= 0)) continue; /* NaN: not reached */
    PetscCall(Seek(failure, path, criterion, from, to));
  }
  PetscFunctionReturn(0);
}

/* Makes `point` the last solved one. */
static PetscErrorCode Accept(LamFailure *failure, const Path *path, const LamPathPoint *point)
{
  PetscFunctionBeginUser;
  failure->followed = path->from + path->reach * point->share;
  if (LamIsTurgid(&point->responses[0])) failure->turgid = PETSC_TRUE;
  if (LamIsTaut(&point->responses[0])) failure->taut = PETSC_TRUE;
  PetscCall(PointCopy(path->meshes, point, &failure->last));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepReason(LamFailure *failure, PetscReal factor, const LamResponse responses[2])
{
  const PetscInt m = LamResponseHasFields(&responses[0]) ? 1 : 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(failure->reason, sizeof(failure->reason), "load factor %.4g has no response%s: %s",
                          (double)factor, m ? " on the second mesh" : "", responses[m].reason));
  PetscFunctionReturn(0);
}

/* `to` has no solution: bisects the path from the last point to it and evaluates the criteria at the solved points. */
static PetscErrorCode Approach(LamFailure *failure, const Path *path, const LamPathPoint *to)
{
  const LamPathPoint *from = &failure->last;
  PetscReal unknown = 1;
  LamPathPoint point;

  PetscFunctionBeginUser;
  PetscCall(KeepReason(failure, path->from + path->reach, to->responses));
  PetscCall(PointCreate(path->meshes, &point));
  for (PetscInt k = 0; k < APPROACHES; k++) {
    PetscBool known;

    PetscCall(SolveAt(path, from, 0.5 * (from->share + unknown), &point, &known));
    if (path->meshes->stopped) break;
    if (!known) {
      unknown = point.share;
      PetscCall(KeepReason(failure, path->from + path->reach * unknown, point.responses));
      continue;
    }
    PetscCall(Judge(failure, path, from, &point));
    PetscCall(Accept(failure, path, &point));
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

/* Evaluates the first solved load, at `path->from`, by itself: criteria reached there have their onset there or before.
 */
static PetscErrorCode JudgeFirst(LamFailure *failure, const Path *path, const LamPathPoint *point)
{
  LamPathPoint start;

  PetscFunctionBeginUser;
  PetscCall(PointCreate(path->meshes, &start)); /* the stress-free reference */
  for (PetscInt m = 0; m < 2; m++) start.responses[m] = point->responses[m];
  start.responses[0].branch = 0;
  PetscCall(Judge(failure, path, &start, point));
  PetscCall(Accept(failure, path, point));
  PetscCall(PointDestroy(&start));
  PetscFunctionReturn(0);
}

/* Evaluates a new state and the load path to it. */
static PetscErrorCode Take(LamFailure *failure, LamMeshes *meshes, PetscInt number, LamPathPoint *to)
{
  const PetscBool known = LamHaveFields(to->responses), first = (PetscBool)isnan(failure->followed);
  const LamFailureProgram *program = &failure->program;
  Path path =
      MakePath(meshes, (PetscReal)(number - 1), 1, &failure->last.responses[0].load, failure->last.responses[0].P,
               &program->loads[number - 1], program->controls ? &program->controls[number - 1] : NULL);

  PetscFunctionBeginUser;
  failure->last.share = 0;
  if (first && known) {
    path = MakePath(meshes, (PetscReal)number, 0, &to->responses[0].load, to->responses[0].P, &to->responses[0].load,
                    NULL);
    to->share = 0;
    PetscCall(JudgeFirst(failure, &path, to));
  } else if (first) {
    PetscCall(KeepReason(failure, (PetscReal)number, to->responses));
  } else if (known) {
    to->share = 1;
    PetscCall(Judge(failure, &path, &failure->last, to));
    PetscCall(Accept(failure, &path, to));
  } else {
    PetscCall(Approach(failure, &path, to));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureWatch(LamFailure *failure, LamMeshes *meshes, PetscInt number, const LamResponse responses[2])
{
  LamPathPoint point;

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
  LamPathPoint reference, zero;
  Path path;

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++) load.F[i] = i % 4 ? 0 : 1;
  path = MakePath(meshes, 0, 0, &load, none, &load, program->controls);
  PetscCall(LamResponseInit(&load, &failure->last.responses[0]));
  PetscCall(PointCreate(meshes, &reference));
  reference.responses[0].load = load;
  PetscCall(PointCreate(meshes, &zero));
  PetscCall(SolveAt(&path, &reference, 0, &zero, &known));
  if (known) PetscCall(JudgeFirst(failure, &path, &zero));
  PetscCall(PointDestroy(&reference));
  PetscCall(PointDestroy(&zero));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureCreate(LamMeshes *meshes, const LamFailureProgram *program, LamFailure *failure)
{
  LamPathPoint present;

  PetscFunctionBeginUser;
  *failure = (LamFailure){.factor = NAN, .followed = NAN, .criterion = LAM_CRITERION_COUNT, .program = *program};
  if (!program->strength) failure->program.strength = &not_given;
  for (int c = 0; c < LAM_CRITERION_COUNT; c++) {
    LamCriterionOnset *onset = &failure->onset[c];

    *onset = (LamCriterionOnset){.factor = NAN, .bracket = {NAN, NAN}, .place = {NAN, NAN, NAN}};
    onset->judged = LamCriterionIsJudged((LamCriterion)c, program->interface, failure->program.strength);
  }
  PetscCall(PointCreate(meshes, &failure->last));
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
  failure->response = failure->criterion == LAM_CRITERION_COUNT ? failure->last.responses[0]
                                                                : failure->onset[failure->criterion].response;
  failure->load = failure->response.load;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFailureDestroy(LamFailure *failure)
{
  PetscFunctionBeginUser;
  PetscCall(PointDestroy(&failure->last));
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
