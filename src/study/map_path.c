/*
  One path of a map: follows the load at one value of the quantity that is not a load quantity.

  Method

  The states of the path are F = I at the turgor and cohesion of the load's first state, the load's own states, and the
  cuts between them. Where stress is prescribed, turgor alone can break the tissue and is raised first, in INFLATION
  steps; at prescribed F = I it only presses the cells together. The states are solved in order until the tissue fails
  (failure.h) or a state does not converge. Walls and interface have no damage, so states after a failure are not
  computed.
*/
#include "map.h"
#include "mesh_choice.h"
#include <math.h>
#include <string.h>

enum { INFLATION = 4 };

typedef struct {
  PetscInt count;
  LamLoad *loads;             /* [count]; owned */
  LamStressControl *controls; /* [count]; owned; NULL if all loads prescribe F */
  PetscReal *place;           /* [count] position along the scene's load: state number with fraction; owned */
  PetscInt *cut;              /* [cuts] index of the state of the path; owned */
} Path;

/* The axis that is a load quantity, or NULL. */
static const LamMapAxis *LoadAxis(const LamScene *scene)
{
  for (int a = 0; a < LAM_MAP_AXIS_COUNT; a++)
    if (LamMapQuantityIsLoad(scene->map[a].quantity)) return &scene->map[a];
  return NULL;
}

PetscInt LamMapPointCount(const LamScene *scene)
{
  return scene->map[LAM_MAP_X].points * scene->map[LAM_MAP_Y].points;
}

PetscInt LamMapCutCount(const LamScene *scene)
{
  const LamMapAxis *axis = LoadAxis(scene);

  return axis ? axis->points : 1;
}

PetscInt LamMapPathCount(const LamScene *scene)
{
  return LamMapPointCount(scene) / LamMapCutCount(scene);
}

/* x and y of a cut. */
static void PointOf(const LamScene *scene, PetscInt path, PetscInt cut, PetscInt at[LAM_MAP_AXIS_COUNT])
{
  const LamMapAxis *axis = LoadAxis(scene);
  const PetscInt nx = scene->map[LAM_MAP_X].points;

  if (!axis) {
    at[LAM_MAP_X] = path % nx;
    at[LAM_MAP_Y] = path / nx;
  } else {
    const LamMapDirection along = axis == &scene->map[LAM_MAP_X] ? LAM_MAP_X : LAM_MAP_Y;

    at[along] = cut;
    at[1 - along] = path;
  }
}

PetscInt64 LamMapPointNumber(const LamScene *scene, PetscInt path, PetscInt cut)
{
  PetscInt at[LAM_MAP_AXIS_COUNT];

  PointOf(scene, path, cut, at);
  return (PetscInt64)at[LAM_MAP_Y] * scene->map[LAM_MAP_X].points + at[LAM_MAP_X];
}

/* ---- the scene of one path ---- */

static void SetQuantity(LamScene *scene, LamMapQuantity quantity, PetscReal value)
{
  switch (quantity) {
  case LAM_MAP_TURGOR:
    for (PetscInt i = 0; i < scene->load_count; i++) scene->loads[i].turgor = value;
    break;
  case LAM_MAP_COHESION:
    for (PetscInt i = 0; i < scene->load_count; i++) scene->loads[i].cohesion = value;
    break;
  case LAM_MAP_WALL_STRENGTH:
    scene->strength.wall = value;
    break;
  case LAM_MAP_LAMELLA_NORMAL:
    scene->strength.lamella_normal = value;
    break;
  case LAM_MAP_LAMELLA_SHEAR:
    scene->strength.lamella_shear = value;
    break;
  case LAM_MAP_WALL_THICKNESS:
    scene->micro.wall_thickness = value;
    break;
  default: /* load quantities: cuts */
    if (LamMapQuantityParameter(quantity) >= 0)
      *LamWallAt(&scene->micro.wall, LamMapQuantityParameter(quantity)) = value;
    break;
  }
}

PetscBool LamMapVariesWalls(const LamScene *scene)
{
  for (int a = 0; a < LAM_MAP_AXIS_COUNT; a++)
    if (scene->map[a].quantity == LAM_MAP_WALL_THICKNESS || LamMapQuantityParameter(scene->map[a].quantity) >= 0)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Copy with the quantities of the path and its own loads; everything else is borrowed. */
static PetscErrorCode CopyScene(const LamScene *scene, PetscInt path, LamScene *copy)
{
  PetscInt at[LAM_MAP_AXIS_COUNT];

  PetscFunctionBeginUser;
  *copy = *scene;
  PetscCall(PetscMalloc1(scene->load_count, &copy->loads));
  PetscCall(PetscArraycpy(copy->loads, scene->loads, scene->load_count));
  PointOf(scene, path, 0, at);
  for (int a = 0; a < LAM_MAP_AXIS_COUNT; a++)
    SetQuantity(copy, scene->map[a].quantity, LamMapAxisValue(&scene->map[a], at[a]));
  PetscCall(LamChooseMesh(copy, NULL)); /* other walls may need another mesh */
  PetscFunctionReturn(0);
}

/* ---- the states ---- */

/* Position of a cut along the scene's load: state number plus the fraction of the step to the next state. */
static PetscReal CutPlace(const LamScene *scene, PetscInt cut)
{
  const LamMapAxis *axis = LoadAxis(scene);
  const PetscReal value = axis ? LamMapAxisValue(axis, cut) : 1;
  PetscReal before = 0;
  PetscInt i = 0;

  if (!axis || axis->quantity == LAM_MAP_LOAD_FACTOR) return value * (PetscReal)scene->load_count;
  while (i < scene->load_count - 1 && scene->loads[i].F[1] < value) before = scene->loads[i++].F[1];
  return (PetscReal)i + (value - before) / (scene->loads[i].F[1] - before);
}

/* The scene's state at the end of the step that contains `place`, from 0. */
static PetscInt StepOf(PetscReal place)
{
  return PetscMax((PetscInt)ceil(place) - 1, 0);
}

/* State at `place` of the scene's load; state 0 is F = I at the turgor and cohesion of state 1. */
static LamLoad LoadAt(const LamScene *scene, PetscReal place)
{
  const PetscInt k = StepOf(place);
  const PetscReal share = place - (PetscReal)k;
  const LamLoad *to = &scene->loads[k];
  const LamLoad start = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = to->turgor, .cohesion = to->cohesion};

  return LamLoadBetween(k ? &scene->loads[k - 1] : &start, to, share);
}

/*
  Prescribed stress at `place`. P is interpolated linearly from that of the previous state, or from 0. The free
  components of F move by the fraction `control.share` from their value in the scene's previous state to that of the
  load; from `before`, which lies in the same step, by the remaining fraction.
*/
static LamStressControl ControlAt(const LamScene *scene, PetscReal before, PetscReal place)
{
  const PetscInt k = StepOf(place);
  const PetscReal share = place - (PetscReal)k, done = PetscMax(before - (PetscReal)k, 0);
  LamStressControl control = scene->controls[k], from = {0};

  if (k) from = scene->controls[k - 1];
  for (int i = 0; i < 9 && share < 1; i++)
    if (control.given[i]) control.P[i] = share * control.P[i] + (from.given[i] ? (1 - share) * from.P[i] : 0);
  control.share *= (share - done) / (1 - control.share * done);
  return control;
}

/* Adds the state whose place is set. */
static void AddState(const LamScene *scene, Path *path)
{
  const PetscInt n = path->count++;
  const PetscReal place = path->place[n];

  path->loads[n] = LoadAt(scene, place);
  if (!path->controls) return;
  path->controls[n] = ControlAt(scene, n ? path->place[n - 1] : 0, place);
  for (int i = 0; i < 9; i++)
    if (path->controls[n].follows[i]) path->loads[n].F[i] = scene->loads[StepOf(place)].F[i];
}

/* Zero without turgor, and for sealed cells, which start with their full turgor. */
static PetscInt InflationOf(const LamScene *scene)
{
  return scene->controls && scene->loads[0].turgor != 0 && !scene->sealed ? INFLATION : 0;
}

/* States at F = I, or at prescribed stress 0, with less turgor than the load's first state. */
static void AddInflation(const LamScene *scene, Path *path)
{
  const PetscInt steps = InflationOf(scene);

  for (PetscInt k = 0; k < steps; k++) {
    path->place[path->count] = 0;
    AddState(scene, path);
    path->loads[k].turgor *= (PetscReal)k / (PetscReal)steps;
  }
}

static PetscErrorCode PathCreate(const LamScene *scene, Path *path)
{
  const PetscInt cuts = LamMapCutCount(scene), most = INFLATION + scene->load_count + 1 + cuts;
  const PetscReal same = 1e-9; /* tolerance: a cut this close to a state coincides with it */
  PetscInt whole = 0;

  PetscFunctionBeginUser;
  *path = (Path){0};
  if (scene->controls) PetscCall(PetscMalloc1(most, &path->controls));
  PetscCall(PetscMalloc3(most, &path->loads, most, &path->place, cuts, &path->cut));
  AddInflation(scene, path);
  for (PetscInt cut = 0; cut < cuts;) {
    const PetscReal place = CutPlace(scene, cut);
    const PetscBool is_cut = (PetscBool)(place <= (PetscReal)whole + same);

    path->place[path->count] = is_cut && place < (PetscReal)whole - same ? place : (PetscReal)whole++;
    if (is_cut) path->cut[cut++] = path->count;
    AddState(scene, path);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PathDestroy(Path *path)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(path->loads, path->place, path->cut));
  PetscCall(PetscFree(path->controls));
  PetscFunctionReturn(0);
}

PetscInt LamMapPathStates(const LamScene *scene)
{
  const PetscReal last = CutPlace(scene, LamMapCutCount(scene) - 1);

  return (scene->controls ? INFLATION : 0) + 1 + (PetscInt)ceil(last) +
         (LoadAxis(scene) ? LamMapCutCount(scene) - 1 : 0);
}

/* ---- path following ---- */

/* The failure is decided: one is found, or a state did not converge. */
static PetscBool IsDecided(const LamFailure *failure)
{
  for (int c = 0; c < LAM_CRITERION_COUNT; c++)
    if (!isnan(failure->onset[c].factor)) return PETSC_TRUE;
  return (PetscBool)(failure->reason[0] != '\0');
}

/* Solves the states until the failure is decided; `responses` [solved] on the first mesh. */
static PetscErrorCode Solve(LamMeshes *meshes, const Path *path, LamFailure *failure, LamResponse responses[],
                            PetscInt *solved)
{
  PetscFunctionBeginUser;
  /* the first state is solved even if the failure search did not converge there: the record gives the reason */
  for (*solved = 0; *solved < path->count && !(*solved && IsDecided(failure)); (*solved)++) {
    const PetscInt k = *solved;
    LamResponse both[2];

    PetscCall(LamMeshesSolve(meshes, &path->loads[k], path->controls ? &path->controls[k] : NULL, both));
    if (meshes->stopped) break;
    responses[k] = both[0];
    PetscCall(LamFailureWatch(failure, meshes, k + 1, both));
    if (meshes->stopped) break;
  }
  PetscFunctionReturn(0);
}

/* Converts a load factor of the path to a fraction of the scene's load. */
static PetscReal ShareOfLoad(const LamScene *scene, const Path *path, PetscReal factor)
{
  const PetscInt k = factor >= 1 ? PetscMin((PetscInt)factor, path->count) : 0;
  PetscReal place;

  if (!k) return 0; /* at the first state, or before it (NaN) */
  place = path->place[k - 1];
  if (k < path->count) place += (factor - (PetscReal)k) * (path->place[k] - place);
  return place / (PetscReal)scene->load_count;
}

/* The failure's reason, with its load factor converted from states of the path to fractions of the load. */
static PetscErrorCode SetReason(const LamScene *scene, const Path *path, const LamFailure *failure, LamMapPoint *point)
{
  const char *why = strstr(failure->reason, ": ");

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(point->reason, sizeof(point->reason), "no response behind load factor %.4g%s",
                          (double)ShareOfLoad(scene, path, failure->followed), why ? why : ""));
  PetscFunctionReturn(0);
}

/* Result at a point that is state `state` (from 1) of the path; `last`: the last state solved. */
static PetscErrorCode Judge(const LamScene *scene, const Path *path, const LamFailure *failure, PetscInt state,
                            const LamResponse *own, const LamResponse *last, LamMapPoint *point)
{
  const PetscReal reached = (PetscReal)state;

  PetscFunctionBeginUser;
  point->mode = LAM_FAILURE_NONE;
  point->criterion = LAM_CRITERION_COUNT;
  point->load_factor = NAN;
  for (int i = 0; i < 3; i++) point->place[i] = NAN;
  if (failure->criterion != LAM_CRITERION_COUNT && failure->factor <= reached) {
    point->mode = failure->mode;
    point->criterion = failure->criterion;
    point->load_factor = ShareOfLoad(scene, path, failure->factor);
    point->response = failure->response;
    PetscCall(PetscArraycpy(point->place, failure->onset[failure->criterion].place, 3));
  } else if (failure->mode == LAM_FAILURE_UNKNOWN && !(failure->followed >= reached)) {
    point->mode = LAM_FAILURE_UNKNOWN;
    point->response = *last;
    PetscCall(SetReason(scene, path, failure, point));
  } else {
    point->response = *own;
  }
  PetscFunctionReturn(0);
}

/* `own`: scene of the path, with its loads, mesh and strengths. */
static PetscErrorCode FollowOwn(const LamScene *own, PetscInt number, PetscBool (*interrupt)(void *ctx), void *ctx,
                                LamMapPoint points[], PetscBool *complete)
{
  LamFailureProgram program;
  LamResponse *responses;
  LamFailure failure;
  LamMeshes meshes;
  PetscInt solved;
  Path path;

  PetscFunctionBeginUser;
  PetscCall(PathCreate(own, &path));
  PetscCall(PetscMalloc1(path.count, &responses));
  program =
      (LamFailureProgram){own->micro.interface, &own->strength, path.count, path.loads, path.controls, PETSC_TRUE};
  PetscCall(LamMeshesCreate(PETSC_COMM_SELF, own, LamCellsPart(own->micro.interface) ? 2 : 1, &meshes));
  PetscCall(LamMeshesSetInterrupt(&meshes, interrupt, ctx));
  PetscCall(LamMeshesSeal(&meshes, own, &own->loads[0]));
  PetscCall(LamFailureCreate(&meshes, &program, &failure));
  PetscCall(Solve(&meshes, &path, &failure, responses, &solved));
  *complete = (PetscBool)!meshes.stopped;
  PetscCall(LamFailureConclude(&failure));
  for (PetscInt c = 0; c < LamMapCutCount(own) && *complete; c++) {
    points[c].number = LamMapPointNumber(own, number, c);
    PetscCall(
        Judge(own, &path, &failure, path.cut[c] + 1, &responses[path.cut[c]], &responses[solved - 1], &points[c]));
  }
  PetscCall(LamFailureDestroy(&failure));
  PetscCall(LamMeshesDestroy(&meshes));
  PetscCall(PetscFree(responses));
  PetscCall(PathDestroy(&path));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapFollow(const LamScene *scene, PetscInt path, PetscBool (*interrupt)(void *ctx), void *ctx,
                            LamMapPoint points[], PetscBool *complete)
{
  LamScene own;

  PetscFunctionBeginUser;
  PetscCall(CopyScene(scene, path, &own));
  PetscCall(FollowOwn(&own, path, interrupt, ctx, points, complete));
  PetscCall(PetscFree(own.loads));
  PetscFunctionReturn(0);
}
