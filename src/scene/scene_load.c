/*
  The `load` block of a scene.
*/
#include "scene_rows.h"

static const LamKey load_keys[] = {
    {LIST("load"), .example = "[{F: [[1, 0.1], [0, 1]]}]",
     .help = "States for `lamella rve`, numbered from 1, each starting from the one before."},
    {MAP("load[]"), .example = "{F: [[1, 0.1], [0, 1]]}", .help = "One state (`F`) or several (`ramp`)."},
    {TENSOR("load[].F"), FREE, FROM(-100), TO(100), .example = "[[1, 0.1], [0, 1]]",
     .help = "Deformation gradient, rows first. 2x2: plane strain; 3x3: with F33 > 0, out-of-plane shears 0. Its "
             "determinant is positive. `free` where `P` is given instead; F12 and F21 not both."},
    {STRESS_TENSOR("load[].P"), OPEN, .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help = "Mixed control: the components of the first Piola-Kirchhoff stress that are given, `x` where `F` is. 2x2: "
             "P33 is not."},
    {MAP("load[].ramp"), .example = "{to: [[1, 0.3], [0, 1]], steps: 10}",
     .help = "A straight path from the state before (undeformed at the start), one state per step."},
    {TENSOR("load[].ramp.to"), REQUIRED, FREE, FROM(-100), TO(100), .example = "[[1, 0.3], [0, 1]]",
     .help = "Deformation gradient at the end of the ramp, as `F`."},
    {STRESS_TENSOR("load[].ramp.P"), OPEN, .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help =
         "Stress at the end of the ramp, as `P`; it goes straight from the one prescribed before, from 0 where none "
         "was."},
    {INTEGER("load[].ramp.steps"), REQUIRED, FROM(1), TO(10000), .example = "10", .help = "Equal steps."},
    {STRESS("load[].turgor"), .default_words = "`rve.turgor.pressure`", .example = "0.05 MPa",
     .help = "Turgor of this entry's states."},
    {STRESS("load[].cohesion"), FROM(0), .default_words = "`rve.interface.cohesion`", .example = "0.001 MPa",
     .help = "Cohesion of this entry's states; only with law `contact`."},
};
LAM_KEY_TABLE(LamLoadKeys, load_keys);

/* More states than anyone waits for; keeps a slip in `steps` from filling the memory. */
enum { MAX_STATES = 1000000 };

static PetscReal Determinant2D(const PetscReal F[9])
{
  return F[0] * F[4] - F[1] * F[3];
}

static PetscBool IsInPlane(PetscInt i)
{
  return (PetscBool)(i < 2 || i == 3 || i == 4);
}

/* Plane strain, or generalised plane strain: out-of-plane shears would need three displacement components. */
PetscErrorCode LamSceneCheckF(const LamDocument *document, const LamNode *node)
{
  const PetscReal *F = node->value.number;
  const PetscBool *is_free = node->value.is_free;
  PetscBool complete = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (F[2] != 0.0 || F[5] != 0.0 || F[6] != 0.0 || F[7] != 0.0) {
    PetscCall(LamSceneFail(document, node,
                           "this version of Lamella does not have out-of-plane shear yet; write 0 for "
                           "F13, F23, F31 and F32"));
  }
  if (F[8] <= 0.0 && !is_free[8]) {
    PetscCall(LamSceneFail(document, node, "F33 = %g; it must be positive", (double)F[8]));
  }
  for (PetscInt i = 0; i < 9; i++) complete = (PetscBool)(complete && !(IsInPlane(i) && is_free[i]));
  if (complete && Determinant2D(F) <= 0.0) {
    PetscCall(LamSceneFail(document, node, "F11 F22 - F12 F21 = %g; a deformation gradient has a positive determinant",
                           (double)Determinant2D(F)));
  }
  PetscFunctionReturn(0);
}

/* Checks an entry and says how many states it holds. */
static PetscErrorCode CheckEntry(const LamDocument *document, const LamNode *entry, PetscInt *states)
{
  const LamNode *F_node, *P_node, *ramp_node;
  LamValue F, unused, steps;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "load[].F", &F_node, &F));
  PetscCall(LamSceneGet(entry, "load[].P", &P_node, &unused));
  PetscCall(LamSceneGet(entry, "load[].ramp", &ramp_node, &unused));
  if (F_node && ramp_node) {
    PetscCall(LamSceneFailName(document, ramp_node, "given together with F; an entry holds one of them"));
  }
  if (!F_node && !ramp_node) {
    PetscCall(LamSceneFailMissing(document, entry, "F", "missing; write F: %s, or a ramp: {to: %s, steps: 10%s}",
                                  P_node ? "[[free, 0.1], [0, free]] beside P" : "[[1, 0.1], [0, 1]]",
                                  P_node ? "[[free, 0.3], [0, free]]" : "[[1, 0.3], [0, 1]]",
                                  P_node ? ", P: [[0 MPa, x], [x, 0 MPa]]" : ""));
  }
  PetscCall(LamSceneGet(entry, "load[].ramp.steps", NULL, &steps));
  *states = F_node ? 1 : (PetscInt)steps.number[0];
  PetscFunctionReturn(0);
}

/* The turgor and cohesion of an entry: its own or the scene's. */
static PetscErrorCode BuildPressures(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                     LamLoad *load)
{
  const LamNode *turgor_node, *cohesion_node;
  LamValue turgor, cohesion;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "load[].turgor", &turgor_node, &turgor));
  PetscCall(LamSceneGet(entry, "load[].cohesion", &cohesion_node, &cohesion));
  load->turgor = scene->turgor;
  load->cohesion = scene->cohesion;
  if (turgor_node && scene->sealed) {
    PetscCall(LamSceneFailName(document, turgor_node,
                               "contradicts turgor mode: sealed, whose cells find their pressure themselves; leave it "
                               "out, or write mode: prescribed"));
  }
  if (turgor_node) {
    PetscCall(LamSceneCheckTurgor(document, turgor_node, turgor.number[0]));
    PetscCall(LamSceneScale(document, turgor_node, turgor.number[0], scene->scales.stress, &load->turgor));
  }
  if (cohesion_node) {
    if (scene->micro.interface == LAM_INTERFACE_BONDED && cohesion.number[0] > 0.0) {
      PetscCall(LamSceneFail(document, cohesion_node, "contradicts law: bonded, whose cells never part; leave it out"));
    }
    PetscCall(LamSceneScale(document, cohesion_node, cohesion.number[0], scene->scales.stress, &load->cohesion));
  }
  PetscFunctionReturn(0);
}

/* What an entry prescribes: F and P, or those at the end of its ramp. */
static PetscErrorCode GetTarget(const LamDocument *document, const LamNode *entry, const LamNode **F_node,
                                const LamNode **P_node)
{
  const LamNode *outer_node;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "load[].F", F_node, &unused));
  PetscCall(LamSceneGet(entry, "load[].P", P_node, &unused));
  if (*F_node) PetscFunctionReturn(0);
  outer_node = *P_node;
  PetscCall(LamSceneGet(entry, "load[].ramp.to", F_node, &unused));
  PetscCall(LamSceneGet(entry, "load[].ramp.P", P_node, &unused));
  if (outer_node) {
    PetscCall(LamSceneFailName(document, outer_node, "stands beside a ramp; write it into the ramp, beside `to`"));
  }
  PetscFunctionReturn(0);
}

/* F of one step of a straight path; *known is PETSC_FALSE where a component in the plane is not known yet. */
static void StepF(const PetscReal start[9], const LamNode *F_node, const LamStressControl *control, PetscReal s,
                  PetscReal F[9], PetscBool *known)
{
  *known = PETSC_TRUE;
  for (PetscInt i = 0; i < 9; i++) {
    const PetscReal to = F_node->value.number[i];

    F[i] = control->given[i] ? start[i] : s == 1.0 || control->follows[i] ? to : (1.0 - s) * start[i] + s * to;
    if (IsInPlane(i) && (control->given[i] || control->follows[i])) *known = PETSC_FALSE;
  }
}

/* Appends the states of an entry after scene->load_count. */
static PetscErrorCode BuildEntry(const LamDocument *document, const LamNode *entry, PetscInt states, LamScene *scene)
{
  const LamNode *F_node, *P_node;
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  LamStressControl before = {0}, target, control;
  PetscReal start[9];

  PetscFunctionBeginUser;
  PetscCall(GetTarget(document, entry, &F_node, &P_node));
  PetscCall(LamSceneReadControl(document, F_node, P_node, scene->scales.stress, &target));
  PetscCall(LamSceneCheckF(document, F_node));
  if (scene->load_count) load = scene->loads[scene->load_count - 1];
  if (scene->load_count && scene->controls) before = scene->controls[scene->load_count - 1];
  PetscCall(PetscArraycpy(start, load.F, 9));
  PetscCall(BuildPressures(document, entry, scene, &load));
  for (PetscInt k = 1; k <= states; k++) {
    PetscBool known;

    LamSceneRampControl(&before, &target, k, states, &control);
    StepF(start, F_node, &control, (PetscReal)k / (PetscReal)states, load.F, &known);
    if (known && Determinant2D(load.F) <= 0.0) {
      PetscCall(LamSceneFail(document, F_node,
                             "the straight path turns the tissue inside out at step %d (determinant "
                             "%g); go there by way of a state in between",
                             (int)k, (double)Determinant2D(load.F)));
    }
    if (scene->controls) scene->controls[scene->load_count] = control;
    scene->loads[scene->load_count++] = load;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildLoad(const LamDocument *document, LamScene *scene)
{
  const LamNode *list;
  PetscInt total = 0, states;
  PetscBool mixed = PETSC_FALSE;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "load", &list, &unused));
  if (!list) PetscFunctionReturn(0);
  for (const LamNode *entry = list->first; entry; entry = entry->next) {
    const LamNode *F_node, *P_node;

    PetscCall(CheckEntry(document, entry, &states));
    PetscCall(GetTarget(document, entry, &F_node, &P_node));
    if (P_node) mixed = PETSC_TRUE;
    total += states;
    if (total > MAX_STATES) {
      PetscCall(LamSceneFail(document, entry, "more than %d states in all; use fewer steps", (int)MAX_STATES));
    }
  }
  PetscCall(PetscCalloc1(total, &scene->loads));
  if (mixed) PetscCall(PetscCalloc1(total, &scene->controls));
  for (const LamNode *entry = list->first; entry; entry = entry->next) {
    PetscCall(CheckEntry(document, entry, &states));
    PetscCall(BuildEntry(document, entry, states, scene));
  }
  PetscFunctionReturn(0);
}
