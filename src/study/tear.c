/*
  Method. The turgor is raised at P = 0 to the tissue free of stress. From there F follows the separation D: opening has
  F22 = F0_22 + D/h at the lateral stretch F0_11, which what is above and below, stiffer or unloading, holds; shear has
  F12 = F0_12 + D/h at P22 = 0, for the teeth of the crack slide over each other, and with F22 held would press for
  ever.

  How far a layer tears is not known before: a curve that has not come apart goes on in longer steps.

  Energies. Where the exact law of contact and the smooth one take turns, the energy lost in a jump and that between the
  laws cannot be separated. All states are therefore of one law: the smooth one, which has all of them, unless the scene
  asks for the exact one. Work, stored, dissipated and released energy are each computed by themselves; `imbalance` is
  what is left of their sum. The fluid of a cell that bursts is not stored, but lost: its potential is in `stored` as it
  was at the burst, so that the work is that of the traction alone.

  A step is taken in halves, each of which ends in a state of the curve, down to 1/64, where its parts (lamella_step.c)
  have done other work than what is drawn between its ends, or where its work is not what its energies have become: a
  jump lies between two states close to each other, and the kink of a stiff lamella is seen. Errors are relative to the
  work of their own step, so that the work of the curve has no larger relative error.

  Where the traction falls in a jump the curve has a fall at the separation where what is drawn does the work of the
  layer: up to there the traction of the state before, from there that of the state after. A line between the two would
  do up to 0.3 % more work on steps of 1/64.

  The same steps of bonded tissue, as far as the largest traction, give the elastic part of a separation. In a fall that
  part springs back along its own curve, and the crack opens by as much: the fall has points between its ends.
*/
#include "tear.h"
#include "clock.h"
#include "lamella_zone.h"
#include "plan.h"
#include "rounding.h"
#include "turgor_stretch.h"
#include <math.h>

const char *const LamTearModeNames[] = {LAM_TEAR_MODES(LAM_NAME_ENTRY)};
const char *const LamTearEndNames[] = {LAM_TEAR_ENDS(LAM_NAME_ENTRY)};

#define INFLATING 8     /* steps: history begins with turgor, and its work is summed to second order */
#define NOTHING 0.01    /* share of the peak: less counts as nothing, in two states on end */
#define LEAST_PEAK 1e-7 /* C1 + C2: less is rounding, and nothing holds */
#define MOST_PARTS 4    /* of a curve that goes on until nothing holds, each of as many steps */
#define LENGTHEN 3.0    /* of the separation from part to part */
#define MOST_HALVINGS 6 /* of a step, as of one that jumps (lamella_step.c) */
#define INEXACT 2e-3    /* error of the work of a step, over that work */
#define LEAST_WORK 0.06 /* that a step's work counts for at least, over the energy of a straight crack */
#define FALL 0.125      /* share of the peak from point to point of a fall */
                        /* between them have the energy to 0.1 % */

/* ---- a layer under a program ---- */

/* The layer of one tissue and turgor: its state, and where its program begins. */
typedef struct {
  LamRVE rve;
  LamRVEState start, state;
  PetscReal turgor, cohesion, height;
  LamTearMode mode;
  LamStressControl control;
  LamResponse zero, last; /* of the tissue free of stress, and of the last solved state */
} Layer;

static PetscReal Area(const Layer *layer)
{
  return layer->zero.load.F[0];
}

/* Row-major index of the component that is driven. */
static PetscInt Driven(LamTearMode mode)
{
  return mode == LAM_TEAR_SHEAR ? 1 : 4;
}

/* The tissue free of stress; F12 is free, too, where cells differ. */
static PetscErrorCode Inflate(const LamMicrostructure *micro, Layer *layer)
{
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .cohesion = layer->cohesion};
  LamStressControl free = {.given = {[0] = PETSC_TRUE, [4] = PETSC_TRUE}, .share = 1.0};

  PetscFunctionBeginUser;
  if (micro->cell) free.given[1] = PETSC_TRUE;
  for (PetscInt k = 1; k <= INFLATING; k++) {
    load.turgor = layer->turgor * (PetscReal)k / INFLATING;
    PetscCall(LamRVESolveMixed(layer->rve, &load, &free, layer->start, &layer->zero));
    if (layer->zero.status != LAM_CONVERGED) break;
    PetscCall(PetscArraycpy(load.F, layer->zero.load.F, 9));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode LayerCreate(LamRVE rve, const LamMicrostructure *micro, PetscReal turgor, PetscReal cohesion,
                                  PetscReal height, Layer *layer)
{
  PetscFunctionBeginUser;
  *layer = (Layer){.rve = rve, .turgor = turgor, .cohesion = cohesion, .height = height};
  PetscCall(LamRVEStateCreate(rve, &layer->start));
  PetscCall(LamRVEStateCreate(rve, &layer->state));
  PetscCall(Inflate(micro, layer));
  PetscFunctionReturn(0);
}

static PetscErrorCode LayerDestroy(Layer *layer)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&layer->start));
  PetscCall(LamRVEStateDestroy(&layer->state));
  PetscFunctionReturn(0);
}

/* Back to the tissue free of stress, for this mode. */
static PetscErrorCode Begin(Layer *layer, LamTearMode mode)
{
  PetscFunctionBeginUser;
  layer->mode = mode;
  layer->control = (LamStressControl){.share = 1.0};
  if (mode == LAM_TEAR_SHEAR) layer->control.given[4] = PETSC_TRUE;
  PetscCall(LamRVEStateCopy(layer->start, layer->state));
  layer->last = layer->zero;
  PetscFunctionReturn(0);
}

/* Goes on to a separation; *response is also that of a state that was not found. */
static PetscErrorCode Separate(Layer *layer, PetscReal separation, LamResponse *response)
{
  const PetscInt d = Driven(layer->mode);
  LamLoad load = layer->last.load;

  PetscFunctionBeginUser;
  load.F[d] = layer->zero.load.F[d] + separation / layer->height;
  PetscCall(LamRVESolveMixed(layer->rve, &load, &layer->control, layer->state, response));
  if (response->status == LAM_CONVERGED) layer->last = *response;
  PetscFunctionReturn(0);
}

static PetscReal Traction(const Layer *layer, const LamResponse *response)
{
  return response->P[Driven(layer->mode)] / Area(layer);
}

/* Of the traction at the start; in shear F22 follows. */
static PetscReal Stiffness(const Layer *layer)
{
  const PetscReal *A = layer->zero.tangent;
  const PetscReal slope =
      layer->mode == LAM_TEAR_SHEAR ? A[9 * 1 + 1] - A[9 * 1 + 4] * A[9 * 4 + 1] / A[9 * 4 + 4] : A[9 * 4 + 4];

  return slope / (layer->height * Area(layer));
}

/* ---- a curve ---- */

/* The point of the layer's state, which has the response r. */
static PetscErrorCode PointOf(const Layer *layer, const LamResponse *r, LamTearPoint *point)
{
  const LamResponse *zero = &layer->zero;
  const PetscReal energy = layer->height / Area(layer), *F = r->load.F, *F0 = zero->load.F;
  const PetscInt d = Driven(layer->mode);
  PetscReal spilt, spilt0;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateGetSpilt(layer->state, &spilt));
  PetscCall(LamRVEStateGetSpilt(layer->start, &spilt0));
  spilt -= spilt0;
  *point = (LamTearPoint){.is_state = PETSC_TRUE,
                          .separation = layer->height * (F[d] - F0[d]),
                          .traction = Traction(layer, r),
                          .crack = NAN,
                          .dilation = layer->mode == LAM_TEAR_SHEAR ? layer->height * (F[4] - F0[4]) : 0.0,
                          .work = energy * (r->work - zero->work - spilt),
                          .stored = energy * (r->stored - zero->stored - spilt),
                          .dissipated = energy * (r->dissipated - zero->dissipated),
                          .released = energy * (r->released - zero->released),
                          .broken = r->broken_fraction,
                          .walls = energy * (r->dissipated_walls - zero->dissipated_walls),
                          .burst = r->burst_fraction,
                          .jumped = r->jumped,
                          .F = {{F[0], F[1]}, {F[3], F[4]}}};
  PetscFunctionReturn(0);
}

static PetscErrorCode AddPoint(const LamTearPoint *point, LamTearCurve *curve)
{
  PetscFunctionBeginUser;
  PetscCall(LamListGrow(curve->count, sizeof(*curve->points), &curve->capacity, &curve->points));
  curve->points[curve->count++] = *point;
  PetscFunctionReturn(0);
}

static PetscReal Peak(const LamTearCurve *curve)
{
  PetscReal peak = 0.0;

  for (PetscInt k = 0; k < curve->count; k++) peak = PetscMax(peak, curve->points[k].traction);
  return peak;
}

static void EndAt(LamTearCurve *curve, const LamResponse *response)
{
  curve->end = LamStopRequested() || response->status == LAM_OUT_OF_REACH ? LAM_TEAR_STOPPED : LAM_TEAR_UNSOLVED;
  snprintf(curve->reason, sizeof(curve->reason), "%s: %s", LamStatusNames[response->status], response->reason);
}

/* Separation between two states at which a fall between their tractions does the layer's work. */
static PetscReal FallAt(const LamTearPoint *a, const LamTearPoint *b)
{
  const PetscReal D = b->separation - a->separation, fall = a->traction - b->traction;

  return a->separation + PetscClipInterval((b->work - a->work - b->traction * D) / fall, 0.0, D);
}

static PetscBool Falls(const LamTearPoint *a, const LamTearPoint *b)
{
  return (PetscBool)(b->jumped && a->traction > b->traction);
}

/* Work of the curve as it is drawn between two states: a line, or a fall. */
static PetscReal DrawnWork(const LamTearPoint *a, const LamTearPoint *b)
{
  const PetscReal at = Falls(a, b) ? FallAt(a, b) : 0.5 * (a->separation + b->separation);

  return a->traction * (at - a->separation) + b->traction * (b->separation - at);
}

/* Error of the work between two states: of what is drawn less that of the layer, or of that less what it has become. */
static PetscReal WorkError(const LamTearPoint *a, const LamTearPoint *b)
{
  const PetscReal work = b->work - a->work;
  const PetscReal energy = b->stored - a->stored + b->dissipated - a->dissipated + b->released - a->released;

  return PetscMax(fabs(DrawnWork(a, b) - work), fabs(work - energy));
}

/* Goes on to a separation, in halves where the line to there is not the layer's work. */
static PetscErrorCode Advance(Layer *layer, PetscReal separation, PetscInt halvings, LamTearCurve *curve,
                              LamResponse *response)
{
  const LamTearPoint before = curve->points[curve->count - 1];
  const LamResponse last = layer->last;
  LamTearPoint point;
  LamRVEState from;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(layer->rve, &from));
  PetscCall(LamRVEStateCopy(layer->state, from));
  PetscCall(Separate(layer, separation, response));
  if (response->status == LAM_CONVERGED) {
    PetscReal work;

    PetscCall(PointOf(layer, response, &point));
    work = PetscMax(fabs(point.work - before.work), LEAST_WORK * curve->straight);
    if (halvings > 0 && WorkError(&before, &point) > INEXACT * work) {
      PetscCall(LamRVEStateCopy(from, layer->state));
      layer->last = last;
      PetscCall(Advance(layer, 0.5 * (before.separation + separation), halvings - 1, curve, response));
      if (response->status == LAM_CONVERGED) PetscCall(Advance(layer, separation, halvings - 1, curve, response));
    } else {
      PetscCall(AddPoint(&point, curve));
    }
  }
  PetscCall(LamRVEStateDestroy(&from));
  PetscFunctionReturn(0);
}

/* A first guess of the separation: that of the lamella at failure on all faces, and the elastic one at its strength. */
static PetscReal FirstGuess(const LamTear *tear, PetscReal stiffness)
{
  const LamLamella *lamella = &tear->scene->micro.lamella;

  return 4.0 * lamella->energy / lamella->strength + lamella->strength / PetscMax(stiffness, lamella->strength);
}

/* In shear beyond half a cell the crack's teeth slide down into the next ones. */
static PetscReal Farthest(const Layer *layer, LamTearMode mode)
{
  return mode == LAM_TEAR_SHEAR ? Area(layer) : PETSC_INFINITY;
}

/* In equal steps to a separation, on in longer ones unless it is given, until the ends of two steps bear nothing. */
static PetscErrorCode Follow(LamTear *tear, Layer *layer, LamTearCurve *curve)
{
  const PetscReal given = tear->separation / tear->scene->scales.length, farthest = Farthest(layer, curve->mode);
  PetscReal from = 0.0, to = given > 0.0 ? given : PetscMin(farthest, FirstGuess(tear, curve->stiffness));
  PetscInt bare = 0;
  LamTearPoint zero;
  LamResponse response;

  PetscFunctionBeginUser;
  PetscCall(Begin(layer, curve->mode));
  curve->count = 0;
  PetscCall(PointOf(layer, &layer->zero, &zero));
  PetscCall(AddPoint(&zero, curve));
  for (PetscInt part = 0; part < MOST_PARTS; part++) {
    for (PetscInt k = 1; k <= tear->steps && bare < 2; k++) {
      const PetscReal share = (PetscReal)k / (PetscReal)tear->steps;

      PetscCall(Advance(layer, from + (to - from) * share, MOST_HALVINGS, curve, &response));
      if (response.status != LAM_CONVERGED) {
        EndAt(curve, &response);
        PetscFunctionReturn(0);
      }
      bare = curve->points[curve->count - 1].traction < NOTHING * Peak(curve) ? bare + 1 : 0;
    }
    curve->end = bare == 2 ? LAM_TEAR_APART : LAM_TEAR_SEPARATION;
    if (bare == 2 || given > 0.0 || to >= farthest) break;
    from = to;
    to = PetscMin(farthest, LENGTHEN * to);
  }
  PetscFunctionReturn(0);
}

/* ---- the elastic part ---- */

/* Separation of the elastic curve (n points, rising) under a traction; NaN beyond it. */
static PetscReal ElasticAt(PetscInt n, const PetscReal separation[], const PetscReal traction[], PetscReal at)
{
  for (PetscInt k = 1; k < n; k++)
    if (at <= traction[k])
      return separation[k - 1] +
             (separation[k] - separation[k - 1]) * (at - traction[k - 1]) / (traction[k] - traction[k - 1]);
  return n ? NAN : 0.0;
}

/* Draws each fall: points at its separation, from the traction before to that after. */
static PetscErrorCode AddFalls(PetscReal peak, LamTearCurve *curve)
{
  LamTearCurve with = *curve;

  PetscFunctionBeginUser;
  with.points = NULL;
  with.count = with.capacity = 0;
  for (PetscInt k = 0; k < curve->count; k++) {
    const LamTearPoint *b = &curve->points[k], *a = k ? b - 1 : b;
    const PetscReal at = Falls(a, b) ? FallAt(a, b) : b->separation;
    const PetscReal of_way = Falls(a, b) ? (at - a->separation) / (b->separation - a->separation) : 1.0;
    const PetscInt parts = Falls(a, b) ? (PetscInt)ceil((a->traction - b->traction) / (FALL * peak)) : -1;

    for (PetscInt j = at > a->separation ? 0 : 1; j < parts + (at < b->separation); j++) {
      const PetscReal t = (PetscReal)j / (PetscReal)parts;
      const LamTearPoint fall = {.separation = at,
                                 .traction = a->traction + t * (b->traction - a->traction),
                                 .dilation = a->dilation + of_way * (b->dilation - a->dilation),
                                 .work = NAN,
                                 .stored = NAN,
                                 .dissipated = NAN,
                                 .released = NAN,
                                 .broken = NAN,
                                 .walls = NAN,
                                 .burst = NAN,
                                 .F = {{NAN, NAN}, {NAN, NAN}}};

      PetscCall(AddPoint(&fall, &with));
    }
    PetscCall(AddPoint(b, &with));
  }
  PetscCall(PetscFree(curve->points));
  *curve = with;
  PetscFunctionReturn(0);
}

static PetscErrorCode SetCrack(Layer *bonded, LamTearCurve *curve)
{
  const PetscReal peak = Peak(curve);
  PetscReal *separation, *traction;
  PetscInt n = 1;
  LamResponse response;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(curve->count + 1, &separation, curve->count + 1, &traction));
  PetscCall(Begin(bonded, curve->mode));
  while (n < curve->count && traction[n - 1] < peak && bonded->zero.status == LAM_CONVERGED) {
    separation[n] = curve->points[n].separation;
    PetscCall(Separate(bonded, separation[n], &response));
    if (response.status != LAM_CONVERGED) break;
    traction[n] = Traction(bonded, &response);
    if (!(traction[n] > traction[n - 1])) break;
    n++;
  }
  if (peak > LEAST_PEAK) PetscCall(AddFalls(peak, curve));
  for (PetscInt k = 0; k < curve->count; k++) {
    LamTearPoint *p = &curve->points[k];

    p->crack = p->separation - ElasticAt(n, separation, traction, p->traction);
  }
  PetscCall(PetscFree2(separation, traction));
  PetscFunctionReturn(0);
}

/* ---- all curves ---- */

static PetscErrorCode Tear(LamTear *tear, Layer *layer, Layer *bonded, LamTearMode mode)
{
  const LamResponse *zero = &layer->zero;
  LamTearCurve curve = {.mode = mode, .turgor = layer->turgor, .F0 = {NAN, NAN}, .stiffness = NAN, .straight = NAN};

  PetscFunctionBeginUser;
  if (zero->status == LAM_CONVERGED) {
    PetscCall(Begin(layer, mode));
    curve.F0[0] = zero->load.F[0];
    curve.F0[1] = zero->load.F[4];
    curve.stiffness = Stiffness(layer);
    curve.straight = tear->layer.energy / Area(layer);
    PetscCall(Follow(tear, layer, &curve));
    PetscCall(SetCrack(bonded, &curve));
    if (curve.count > 1 && curve.end != LAM_TEAR_STOPPED && !(Peak(&curve) > LEAST_PEAK)) curve.end = LAM_TEAR_TORN;
  } else {
    EndAt(&curve, zero);
    if (curve.end == LAM_TEAR_UNSOLVED) curve.end = LAM_TEAR_TORN;
  }
  tear->curves++;
  if (curve.end == LAM_TEAR_UNSOLVED) tear->unsolved++;
  if (tear->curve) PetscCall(tear->curve(tear->reporter.ctx, tear, &curve));
  PetscCall(PetscFree(curve.points));
  PetscFunctionReturn(0);
}

static PetscErrorCode TearUnder(LamTear *tear, PetscReal turgor, PetscInt total)
{
  const LamScene *scene = tear->scene;
  LamMicrostructure bonded_micro = scene->micro;
  Layer layer, bonded;

  PetscFunctionBeginUser;
  bonded_micro.interface = LAM_INTERFACE_BONDED;
  PetscCall(LayerCreate(tear->rve, &scene->micro, turgor, scene->cohesion, tear->layer.height, &layer));
  PetscCall(LayerCreate(tear->bonded, &bonded_micro, turgor, 0.0, tear->layer.height, &bonded));
  for (int mode = 0; mode < LAM_TEAR_MODE_COUNT && !LamStopRequested(); mode++) {
    if (!tear->mode[mode]) continue;
    PetscCall(Tear(tear, &layer, &bonded, (LamTearMode)mode));
    PetscCall(LamReportProgress(&tear->reporter, tear->curves, total, tear->unsolved));
  }
  PetscCall(LayerDestroy(&bonded));
  PetscCall(LayerDestroy(&layer));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckScene(const LamScene *scene)
{
  const LamMicrostructure *micro = &scene->micro;

  PetscFunctionBeginUser;
  PetscCheck(micro->interface == LAM_INTERFACE_LAMELLA, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.interface.law: %s: has no energy of fracture, without which tissue does not tear; write law: "
             "lamella, with strength and fracture_energy",
             scene->path, LamInterfaceLawNames[micro->interface]);
  PetscCheck(!LamWallsRelax(micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.wall.relaxation: the law of a layer is one without time; leave it out", scene->path);
  PetscCheck(!LamWallsTilt(micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.wall.fibre_angle: the law of a layer is that of fibres in the section; leave it out",
             scene->path);
  PetscCheck(!micro->is_patch, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.patch: a block of cells between grips is no layer that goes on to both sides; write rve.cells",
             scene->path);
  PetscCheck(!scene->sealed, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.turgor.mode: sealed: the law of a layer is that under a given turgor; write mode: prescribed",
             scene->path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTearPrepare(LamTear *tear)
{
  LamScene *scene = tear->scene, bonded;
  MPI_Comm comm;
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(CheckScene(scene));
  PetscCall(LamTearLayerOf(scene->path, &scene->micro, &tear->layer));
  PetscCall(LamPlanMake(scene, &plan));
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &tear->reporter, &plan.micro, scene->accuracy));
  LamWarnOfMesh(PETSC_COMM_WORLD, &tear->reporter, scene, &plan.trial);
  LamWarnOfTurgor(&tear->reporter, scene);
  LamWarnOfZone(PETSC_COMM_WORLD, &tear->reporter, &plan.micro, &scene->scales);
  scene->micro = plan.micro;
  comm = plan.unknowns < LAM_PARALLEL_UNKNOWNS ? PETSC_COMM_SELF : PETSC_COMM_WORLD;
  PetscCall(LamSceneRVECreate(comm, scene, &tear->rve));
  bonded = *scene;
  bonded.micro.interface = LAM_INTERFACE_BONDED;
  PetscCall(LamSceneRVECreate(comm, &bonded, &tear->bonded));
  PetscCall(LamRVESetInterrupt(tear->rve, LamStopInterrupt, NULL));
  PetscCall(LamRVESetInterrupt(tear->bonded, LamStopInterrupt, NULL));
  PetscCall(LamRVESetWanted(tear->rve, LAM_WANT_STRESS | LAM_WANT_DERIVATIVES | LAM_WANT_INDICATORS | LAM_WANT_JUMPS));
  PetscCall(LamRVESetWanted(tear->bonded, LAM_WANT_STRESS | LAM_WANT_DERIVATIVES));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTearRun(LamTear *tear)
{
  const PetscInt turgors = PetscMax(1, tear->turgor_count);
  PetscInt modes = 0;

  PetscFunctionBeginUser;
  for (int mode = 0; mode < LAM_TEAR_MODE_COUNT; mode++) modes += tear->mode[mode];
  LamActivitySet("curves");
  PetscCall(LamReportProgress(&tear->reporter, 0, turgors * modes, 0));
  for (PetscInt k = 0; k < turgors && !LamStopRequested(); k++)
    PetscCall(TearUnder(tear, tear->turgor_count ? tear->turgor[k] / tear->scene->scales.stress : tear->scene->turgor,
                        turgors * modes));
  PetscFunctionReturn(0);
}

LamTearReadings LamTearRead(const LamTearCurve *curve)
{
  LamTearReadings r = {.at = NAN};

  if (!curve->count) return r;
  for (PetscInt k = 0; k < curve->count; k++) {
    const LamTearPoint *p = &curve->points[k];

    if (p->traction > r.strength) {
      r.strength = p->traction;
      r.at = p->separation;
    }
    r.states += p->is_state;
    if (k) r.law += 0.5 * (p->traction + p[-1].traction) * (p->crack - p[-1].crack);
  }
  const LamTearPoint *last = &curve->points[curve->count - 1];

  r.energy = last->dissipated + last->released;
  r.share = r.energy > 0.0 ? last->released / r.energy : NAN;
  r.imbalance = last->work - last->stored - r.energy;
  return r;
}

PetscErrorCode LamTearDestroy(LamTear *tear)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEDestroy(&tear->rve));
  PetscCall(LamRVEDestroy(&tear->bonded));
  PetscCall(LamSceneDestroy(&tear->scene));
  PetscFunctionReturn(0);
}
