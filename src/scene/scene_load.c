/*
  The `load` block of a scene.
*/
#include "scene_rows.h"

const char *const LamAreaNames[] = {LAM_AREAS(LAM_NAME_ENTRY)};

static const LamKey load_keys[] = {
    {LIST("load"), .example = "[{F: [[1, 0.1], [0, 1]]}]",
     .help = "States for `lamella rve`, numbered from 1, each starting from the one before."},
    {MAP("load[]"), .example = "{F: [[1, 0.1], [0, 1]]}",
     .help = "One state (`F`) or several (`ramp`); the first entry may be `inflate`."},
    {BOOL("load[].inflate"), .example = "true",
     .help = "In the first entry: the tissue free of stress in the plane, under its turgor, with F12 = F21 = 0. F of "
             "the other entries counts from there."},
    {NAME("load[].reference", LamAreaNames), .default_words = "`rest`",
     .help = "Beside `inflate`: whether P, given and told, is per area of the tissue at rest or of the inflated one."},
    {TENSOR("load[].F"), FREE, FROM(-100), TO(100), .example = "[[1, 0.1], [0, 1]]",
     .help =
         "Deformation gradient, rows first, of cells that are prisms along X3. 2x2: plane strain. Its determinant is "
         "positive. `free` where `P` is given instead; F12 and F21 not both."},
    {STRESS_TENSOR("load[].P"), OPEN, .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help = "Mixed control: the components of the first Piola-Kirchhoff stress that are given, `x` where `F` is. 2x2: "
             "P33 is not."},
    {MAP("load[].ramp"), .example = "{to: [[1, 0.3], [0, 1]], steps: 10}",
     .help = "A straight path from the state before (undeformed at the start), one state per step."},
    {TENSOR("load[].ramp.to"), REQUIRED, FREE, FROM(-100), TO(100), .example = "[[1, 0.3], [0, 1]]",
     .help = "Deformation gradient at the end of the ramp, as `F`."},
    {STRESS_TENSOR("load[].ramp.P"), OPEN, .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help = "Stress at the end of the ramp, as `P`; it goes straight from the one prescribed before, from 0 where "
             "none was."},
    {INTEGER("load[].ramp.steps"), REQUIRED, FROM(1), TO(10000), .example = "10",
     .help = "Equal steps; with `dissipation`, the most of them."},
    {MAP("load[].ramp.dissipation"), .default_words = "none", .example = "{faces: 0.5}",
     .help = "In the last entry, with law `lamella` and all of `F` given: each state breaks about so much of the "
             "lamella, and "
             "F goes back along the ramp where that is needed, or is one step of `steps` farther where less breaks. At "
             "most "
             "`steps` states, fewer if the end is reached."},
    {REAL("load[].ramp.dissipation.faces"), REQUIRED, FROM(0.001), TO(1000), .example = "0.5",
     .help = "Energies of fracture, in tension, of a whole face."},
    {STRESS("load[].turgor"), INTO(LamLoad, turgor), .default_words = "`rve.turgor.pressure`", .example = "0.05 MPa",
     .help = "Turgor of this entry's states."},
    {STRESS("load[].cohesion"), INTO(LamLoad, cohesion), FROM(0),
     .default_words = "`rve.interface.cohesion`, or `residual_cohesion`", .example = "0.001 MPa",
     .help = "Cohesion of this entry's states; not with law `bonded`."},
    {TIME("load[].for"), FROM(0), .default_words = "none: required with `rve.wall.relaxation`", .example = "10 s",
     .help =
         "How long it takes from the state before, in a ramp all of its steps; 0 s: at once. Only with "
         "`rve.wall.relaxation`. In a step the elastic stress of the walls goes straight to its new value; the error "
         "is of second order in its length, and none where F is held or jumps."},
};
LAM_KEY_TABLE(LamLoadKeys, load_keys);

/* More states than anyone solves; prevents a mistake in `steps` from filling the memory. */
enum { MAX_STATES = 1000000 };

/* ---- mixed control: for each component either F or P is given ---- */

static const char *const component_names[9] = {"11", "12", "13", "21", "22", "23", "31", "32", "33"};

/* The node of a component; the tensor's node if the tensor is 2x2 and does not contain it. */
static const LamNode *Item(const LamNode *tensor, PetscInt i)
{
  const LamNode *row = tensor->first, *item;

  if (i / 3 >= tensor->count || i % 3 >= tensor->count) return tensor;
  for (PetscInt k = 0; k < i / 3; k++) row = row->next;
  item = row->first;
  for (PetscInt k = 0; k < i % 3; k++) item = item->next;
  return item;
}

static PetscErrorCode CheckComponent(const LamNode *F_node, const LamNode *P_node, PetscInt i, PetscBool F_given,
                                     PetscBool P_given)
{
  const PetscBool shear33 = (PetscBool)(i == 2 || i == 5 || i == 6 || i == 7);

  PetscFunctionBeginUser;
  LamSceneCheck(!shear33 || (F_given && !P_given), Item(F_given ? P_node : F_node, i),
                "out-of-plane shear is given as F; write a number for F%s, such as 0, and x for P%s",
                component_names[i], component_names[i]);
  LamSceneCheck(!F_given || !P_given, Item(P_node, i), "F%s is given, too; write x here, or free there",
                component_names[i]);
  LamSceneCheck(F_given || P_given, Item(F_node, i), "P%s is not given%s; write it into P, such as P: %s",
                component_names[i], P_node ? " either" : "",
                i == 8 ? "[[x, x, x], [x, x, x], [x, x, 0 MPa]]" : "[[0 MPa, x], [x, 0 MPa]]");
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadControl(const LamNode *F_node, const LamNode *P_node, PetscReal scale,
                                   LamStressControl *control)
{
  PetscFunctionBeginUser;
  *control = (LamStressControl){.share = 1.0};
  for (PetscInt i = 0; i < 9; i++) {
    control->given[i] = (PetscBool)(P_node && !P_node->value.is_free[i]);
    PetscCall(CheckComponent(F_node, P_node, i, (PetscBool)!F_node->value.is_free[i], control->given[i]));
    if (control->given[i]) PetscCall(LamSceneScale(Item(P_node, i), P_node->value.number[i], scale, &control->P[i]));
  }
  LamSceneCheck(!control->given[1] || !control->given[3], Item(F_node, 3),
                "F12 is free, too: the tissue can rotate; write a number for one of them, such as 0");
  PetscFunctionReturn(0);
}

void LamSceneRampControl(const LamStressControl *from, const LamStressControl *to, PetscInt step, PetscInt steps,
                         LamStressControl *control)
{
  const PetscReal s = (PetscReal)step / (PetscReal)steps;

  *control = *to;
  control->share = 1.0 / (PetscReal)(steps - step + 1);
  for (PetscInt i = 0; i < 9; i++) {
    if (to->given[i] && step < steps) control->P[i] = s * to->P[i] + (from->given[i] ? (1.0 - s) * from->P[i] : 0.0);
    control->follows[i] = (PetscBool)(from->given[i] && !to->given[i] && step < steps);
  }
}

LamLoad LamLoadAfter(const LamLoad *load, const LamStressControl *control, const PetscReal before[9])
{
  LamLoad after = *load;

  for (PetscInt i = 0; i < 9 && control; i++) {
    if (control->given[i]) after.F[i] = before[i];
    if (control->follows[i]) after.F[i] = (1.0 - control->share) * before[i] + control->share * load->F[i];
  }
  return after;
}

/* ---- entries ---- */

/* The F and P of an entry, or those at the end of its ramp. */
typedef struct {
  const LamNode *F, *P;
  const LamNode *dissipation; /* NULL: not prescribed */
  PetscInt states;
} Target;

static PetscReal Determinant2D(const PetscReal F[9])
{
  return F[0] * F[4] - F[1] * F[3];
}

static PetscBool IsInPlane(PetscInt i)
{
  return (PetscBool)(i < 2 || i == 3 || i == 4);
}

static PetscReal Determinant(const PetscReal F[9])
{
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}

static PetscBool HasShear33(const PetscReal F[9])
{
  return (PetscBool)(F[2] != 0.0 || F[5] != 0.0 || F[6] != 0.0 || F[7] != 0.0);
}

PetscErrorCode LamSceneCheckF(const LamNode *node, PetscBool any)
{
  const PetscReal *F = node->value.number;
  const PetscBool *is_free = node->value.is_free;
  PetscBool complete = PETSC_TRUE;

  PetscFunctionBeginUser;
  LamSceneCheck(any || !HasShear33(F), node,
                "out-of-plane shear is for `lamella rve`; write 0 for F13, F23, F31 and F32");
  LamSceneCheck(F[8] > 0.0 || is_free[8], node, "F33 = %g; it must be positive", (double)F[8]);
  for (PetscInt i = 0; i < 9; i++) complete = (PetscBool)(complete && !(IsInPlane(i) && is_free[i]));
  for (PetscInt i = 0; i < 9 && HasShear33(F); i++) {
    LamSceneCheck(!is_free[i], node, "F%s is free beside an out-of-plane shear; give all of F", component_names[i]);
    LamSceneCheck(Determinant(F) > 0.0, node, "det F = %g; a deformation gradient has a positive determinant",
                  (double)Determinant(F));
  }
  LamSceneCheck(!complete || HasShear33(F) || Determinant2D(F) > 0.0, node,
                "F11 F22 - F12 F21 = %g; a deformation gradient has a positive determinant", (double)Determinant2D(F));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadTarget(const LamNode *entry, Target *target)
{
  const LamNode *F = LamNodeFind(entry, "F"), *P = LamNodeFind(entry, "P");
  const LamNode *ramp = LamNodeFind(entry, "ramp"), *inflate = LamNodeFind(entry, "inflate");
  const LamNode *reference = LamNodeFind(entry, "reference");

  PetscFunctionBeginUser;
  *target = (Target){.F = F, .P = P, .states = 1};
  LamSceneCheckName(inflate || !reference, reference, "says what stresses count from beside inflate: true; write that");
  if (inflate) {
    LamSceneCheck(inflate->value.number[0] != 0.0, inflate, "is what an entry without it is; leave it out");
    LamSceneCheckName(entry->index == 1, inflate, "is for the first entry: what follows counts from there");
    LamSceneCheckName(!F && !P && !ramp,
                      F   ? F
                      : P ? P
                          : ramp,
                      "stands beside inflate, which is a state of its own; write it into an entry after it");
    PetscFunctionReturn(0);
  }
  LamSceneCheckName(!F || !ramp, ramp, "given together with F; an entry holds one of them");
  LamSceneRequire(F || ramp, entry, "F", "missing; write F: %s, or a ramp: {to: %s, steps: 10%s}",
                  P ? "[[free, 0.1], [0, free]] beside P" : "[[1, 0.1], [0, 1]]",
                  P ? "[[free, 0.3], [0, free]]" : "[[1, 0.3], [0, 1]]", P ? ", P: [[0 MPa, x], [x, 0 MPa]]" : "");
  if (F) PetscFunctionReturn(0);
  LamSceneCheckName(!P, P, "stands beside a ramp; write it into the ramp, beside `to`");
  target->F = LamNodeFind(ramp, "to");
  target->P = LamNodeFind(ramp, "P");
  target->states = (PetscInt)LamNodeFind(ramp, "steps")->value.number[0];
  target->dissipation = LamNodeFind(ramp, "dissipation");
  PetscFunctionReturn(0);
}

/* Turgor and cohesion of an entry: its own or the scene's. */
static PetscErrorCode BuildPressures(const LamNode *entry, const LamScene *scene, LamLoad *load)
{
  const LamNode *turgor = LamNodeFind(entry, "turgor"), *cohesion = LamNodeFind(entry, "cohesion");

  PetscFunctionBeginUser;
  load->turgor = scene->turgor;
  load->cohesion = scene->cohesion;
  LamSceneCheckName(!turgor || !scene->sealed, turgor,
                    "contradicts turgor mode: sealed, whose cells find their pressure themselves; leave it out, or "
                    "write mode: prescribed");
  if (turgor) PetscCall(LamSceneCheckTurgor(turgor, turgor->value.number[0]));
  LamSceneCheck(!cohesion || scene->micro.interface != LAM_INTERFACE_BONDED || !(cohesion->value.number[0] > 0.0),
                cohesion, LAM_BONDED_PARTS);
  PetscCall(LamSceneFill(entry, &scene->scales, LamLoad, load));
  PetscFunctionReturn(0);
}

/* The time of each of an entry's states, which walls with memory need. */
static PetscErrorCode BuildDuration(const LamNode *entry, const LamScene *scene, PetscInt states, LamLoad *load)
{
  const LamNode *duration = LamNodeFind(entry, "for");

  PetscFunctionBeginUser;
  LamSceneCheckName(!duration || LamWallsRelax(&scene->micro), duration,
                    "says nothing of walls without memory; leave it out, or write rve.wall.relaxation");
  LamSceneRequire(duration || !LamWallsRelax(&scene->micro), entry, "for",
                  "missing: walls with rve.wall.relaxation need a time; write how long it takes, such as 10 s, or 0 s: "
                  "at once");
  load->duration = duration ? duration->value.number[0] / (PetscReal)states : 0.0;
  PetscFunctionReturn(0);
}

/* F of one step of a linear path; *known is PETSC_FALSE if an in-plane component is not known yet. */
static void StepF(const PetscReal start[9], const PetscReal end[9], const LamStressControl *control, PetscReal s,
                  PetscReal F[9], PetscBool *known)
{
  *known = PETSC_TRUE;
  for (PetscInt i = 0; i < 9; i++) {
    F[i] = control->given[i] ? start[i] : s == 1.0 || control->follows[i] ? end[i] : (1.0 - s) * start[i] + s * end[i];
    if (IsInPlane(i) && (control->given[i] || control->follows[i])) *known = PETSC_FALSE;
  }
}

/* The first entry, where it is that of the inflated tissue: F = I is the guess. */
static PetscErrorCode BuildInflated(const LamNode *entry, LamScene *scene)
{
  const LamNode *reference = LamNodeFind(entry, "reference");

  PetscFunctionBeginUser;
  LamSceneRequire(scene->turgor != 0.0 || LamNodeFind(entry, "turgor"), entry, "turgor",
                  "missing, and rve.turgor is, too: nothing inflates the tissue; write turgor: 0.1 MPa");
  scene->loads[0] = (LamLoad){.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  PetscCall(BuildPressures(entry, scene, &scene->loads[0]));
  PetscCall(BuildDuration(entry, scene, 1, &scene->loads[0]));
  LamSceneCheckName(scene->micro.interface != LAM_INTERFACE_CONTACT || scene->loads[0].cohesion > 0.0,
                    LamNodeFind(entry, "inflate"),
                    "free tissue of law: contact is held together by the lamella alone, and there is no cohesion; give "
                    "interface.cohesion > 0, or leave inflate out");
  scene->controls[0] = (LamStressControl){.given = {[0] = PETSC_TRUE, [4] = PETSC_TRUE}, .share = 1.0};
  scene->inflate = PETSC_TRUE;
  if (reference) scene->area = (LamArea)reference->value.number[0];
  scene->load_count = 1;
  PetscFunctionReturn(0);
}

/* A ramp whose states are those of a dissipated energy. */
static PetscErrorCode BuildDissipation(const LamNode *entry, const Target *target, LamScene *scene)
{
  const LamNode *node = target->dissipation;

  PetscFunctionBeginUser;
  if (!node) PetscFunctionReturn(0);
  LamSceneCheckName(scene->micro.interface == LAM_INTERFACE_LAMELLA, node,
                    "needs law: lamella, whose energy of fracture is dissipated; leave it out, or write that law");
  LamSceneCheckName(!LamWallsTear(&scene->micro), node,
                    "does not go with strength.wall_fracture_energy: cells burst in jumps; leave one of them out");
  LamSceneCheckName(!HasShear33(target->F->value.number) && !LamWallsTilt(&scene->micro), node,
                    "does not go with out-of-plane shear or rve.wall.fibre_angle; leave one of them out");
  LamSceneCheckName(!LamWallsRelax(&scene->micro), node,
                    "does not go with rve.wall.relaxation: when its states are reached is not known before; leave one "
                    "of them out");
  LamSceneCheckName(!target->P, node, "stands beside a prescribed stress; give all of F, or leave it out");
  LamSceneCheckName(!entry->next, node, "is for the last entry: where its ramp ends is not known before");
  LamSceneCheckName(scene->load_count > 0, node,
                    "needs a state to start from; write an entry before this one, such as {F: [[1, 0], [0, 1]]}");
  scene->dissipating = target->states;
  scene->dissipated_faces = LamNodeFind(node, "faces")->value.number[0];
  PetscFunctionReturn(0);
}

/* Appends the states of an entry after scene->load_count. */
static PetscErrorCode BuildEntry(const LamNode *entry, LamScene *scene)
{
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  LamStressControl before = {0}, end, control;
  PetscReal start[9];
  Target target;

  PetscFunctionBeginUser;
  if (LamNodeFind(entry, "inflate")) {
    PetscCall(BuildInflated(entry, scene));
    PetscFunctionReturn(0);
  }
  PetscCall(ReadTarget(entry, &target));
  PetscCall(LamSceneReadControl(target.F, target.P, scene->scales.stress, &end));
  PetscCall(LamSceneCheckF(target.F, PETSC_TRUE));
  PetscCall(BuildDissipation(entry, &target, scene));
  if (scene->load_count) load = scene->loads[scene->load_count - 1];
  /* from the inflated tissue F = I is known, and no stress is prescribed */
  if (scene->load_count > (scene->inflate ? 1 : 0) && scene->controls) before = scene->controls[scene->load_count - 1];
  PetscCall(PetscArraycpy(start, load.F, 9));
  PetscCall(BuildPressures(entry, scene, &load));
  PetscCall(BuildDuration(entry, scene, target.states, &load));
  for (PetscInt k = 1; k <= target.states; k++) {
    PetscBool known;

    LamSceneRampControl(&before, &end, k, target.states, &control);
    StepF(start, target.F->value.number, &control, (PetscReal)k / (PetscReal)target.states, load.F, &known);
    if (HasShear33(load.F)) scene->out_of_plane = PETSC_TRUE;
    LamSceneCheck(!known || (HasShear33(load.F) ? Determinant(load.F) : Determinant2D(load.F)) > 0.0, target.F,
                  "the straight path turns the tissue inside out at step %d (determinant %g); go there by way of a "
                  "state in between",
                  (int)k, (double)(HasShear33(load.F) ? Determinant(load.F) : Determinant2D(load.F)));
    if (scene->controls) scene->controls[scene->load_count] = control;
    scene->loads[scene->load_count++] = load;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildLoad(const LamNode *root, LamScene *scene)
{
  const LamNode *list = LamNodeFind(root, "load");
  PetscBool mixed = PETSC_FALSE;
  PetscInt total = 0;

  PetscFunctionBeginUser;
  if (!list) PetscFunctionReturn(0);
  for (const LamNode *entry = list->first; entry; entry = entry->next) {
    Target target;

    PetscCall(ReadTarget(entry, &target));
    if (target.P || !target.F) mixed = PETSC_TRUE;
    total += target.states;
    LamSceneCheck(total <= MAX_STATES, entry, "more than %d states in all; use fewer steps", (int)MAX_STATES);
  }
  PetscCall(PetscCalloc1(total, &scene->loads));
  if (mixed) PetscCall(PetscCalloc1(total, &scene->controls));
  for (const LamNode *entry = list->first; entry; entry = entry->next) PetscCall(BuildEntry(entry, scene));
  PetscFunctionReturn(0);
}
