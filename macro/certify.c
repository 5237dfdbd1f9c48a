/*
  Reactions corrected by another responder, such as direct solves where the run interpolates.

  Method. The state of the run is corrected to first order (correction.c) and does not change. All states are, at all
  points; or at the end of the run its last state and that of the largest reaction, at a sample that costs a share of
  what the run has cost, counted in solves: the same run has the same sample.
*/
#include <math.h>
#include "macro_impl.h"

enum {
  LEAST_POINTS = 12, /* chosen: with fewer the quantile of Student's t is more than a fifth above that of the normal */
  LEAST_SOLVES = 24, /* chosen: two samples of so few points, 25 ms of bonded tissue, are allowed to any run */
  QUERIES = 1000     /* of the body cost what a solve does or more: 9 to 20 us against 1 to 10 ms */
};
static const PetscReal SHARE = 0.2; /* of the run's cost: what the certificate may cost */

/* ---- the state to certify ---- */

void LamMacroUncertified(LamMacroCertificate *certificate, const char why[])
{
  for (PetscInt s = 0; s < LAM_MAX_BOUNDARIES; s++)
    for (PetscInt i = 0; i < 2; i++) certificate->reaction[s][i] = certificate->margin[s][i] = NAN;
  (void)PetscStrncpy(certificate->why, why, sizeof(certificate->why));
}

/* The largest force at a side. */
static PetscReal Force(const LamMacroStep *step)
{
  PetscReal largest = 0;

  for (PetscInt s = 0; s < step->boundary_count; s++)
    largest = PetscMax(largest, hypot(step->reaction[s][0], step->reaction[s][1]));
  return largest;
}

PetscErrorCode LamMacroPeakCreate(LamMacro macro)
{
  PetscFunctionBeginUser;
  if (macro->peak.u) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(macro->u, &macro->peak.u));
  PetscCall(PetscMalloc1(macro->point_count, &macro->peak.points));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroPeakDestroy(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&macro->peak.u));
  PetscCall(PetscFree(macro->peak.points));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepPeak(LamMacro macro, const LamMacroStep *step)
{
  LamMacroPeak *peak = &macro->peak;

  PetscFunctionBeginUser;
  if (peak->known && Force(step) <= Force(&peak->step)) PetscFunctionReturn(0);
  PetscCall(LamMacroPeakCreate(macro));
  PetscCall(VecCopy(macro->u, peak->u));
  PetscCall(PetscArraycpy(peak->points, macro->now, macro->point_count));
  peak->step = *step;
  peak->known = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Exchanges the present state and that of the peak; which nodes touch obstacles follows from it. */
static PetscErrorCode Exchange(LamMacro macro, PetscReal load)
{
  LamMaterialPoint *now = macro->now;

  PetscFunctionBeginUser;
  PetscCall(VecSwap(macro->u, macro->peak.u));
  macro->now = macro->peak.points;
  macro->peak.points = now;
  PetscCall(LamMacroSetLoadFactor(macro, load));
  PetscFunctionReturn(0);
}

/* ---- certificates ---- */

/* A side whose own force depends on the displacement: that of a follower is not corrected. */
static void LeaveFollowers(LamMacro macro, LamMacroCertificate *certificate)
{
  const LamMacroSpec *spec = &macro->scene->macro;

  for (PetscInt b = 0; b < spec->boundary_count && macro->loaded; b++) {
    const PetscInt side = LamMacroSideNumber(&macro->step, &spec->boundary[b]);
    for (PetscInt i = 0; i < 2 && spec->boundary[b].follower; i++)
      certificate->reaction[side][i] = certificate->margin[side][i] = NAN;
  }
}

/* Of the present state, whose report is `step`. */
static PetscErrorCode Certify(LamMacro macro, const LamMacroStep *step, PetscInt wanted,
                              LamMacroCertificate *certificate)
{
  LamObstacleNode *nodes;

  PetscFunctionBeginUser;
  *certificate = (LamMacroCertificate){.step = step->step, .load_factor = step->load_factor, .made = PETSC_TRUE};
  PetscCall(PetscArraycpy(&certificate->reaction[0][0], &step->reaction[0][0], 2 * LAM_MAX_BOUNDARIES));
  if (macro->loaded && macro->scene->macro.inflate && !macro->inflated.points) {
    LamMacroUncertified(certificate, "the run before --resume had not kept the inflated body");
    PetscFunctionReturn(0);
  }
  if (wanted < LEAST_POINTS) {
    LamMacroUncertified(certificate, "a fifth of the run does not pay for it; --certify solves all points");
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(macro->obstacle_node_count, &nodes));
  PetscCall(PetscArraycpy(nodes, macro->obstacle_nodes, macro->obstacle_node_count));
  PetscCall(LamMacroCorrect(macro, wanted, step->step + macro->seed, certificate));
  PetscCall(PetscArraycpy(macro->obstacle_nodes, nodes, macro->obstacle_node_count));
  PetscCall(PetscFree(nodes));
  LeaveFollowers(macro, certificate);
  PetscFunctionReturn(0);
}

/* Points that so many solves pay for; those of an inflated body that is not uniform cost one more. */
static PetscInt PointsFor(LamMacro macro, PetscReal solves, PetscInt step)
{
  const PetscBool inflated = (PetscBool)(macro->inflated.points && !macro->inflated.uniform);

  return (PetscInt)(solves / (PetscReal)(1 + inflated + LamMacroCountWaypoints(macro, step)));
}

/* The run's last state and that of the largest force share the cost. */
static PetscErrorCode CertifyEnd(LamMacro macro, LamMacroStep *step)
{
  const PetscReal work = (PetscReal)macro->cost.solves + (PetscReal)macro->cost.queries / QUERIES;
  const PetscBool rises = (PetscBool)(!macro->peak.known || Force(step) >= Force(&macro->peak.step));
  const PetscReal solves = PetscMax(LEAST_SOLVES, SHARE * work) / (rises ? 1 : 2);

  PetscFunctionBeginUser;
  PetscCall(Certify(macro, step, PointsFor(macro, solves, step->step), &step->certificate));
  if (rises || step->certificate.why[0]) PetscFunctionReturn(0);
  PetscCall(Exchange(macro, macro->peak.step.load_factor));
  PetscCall(Certify(macro, &macro->peak.step, PointsFor(macro, solves, macro->peak.step.step), &step->peak));
  PetscCall(Exchange(macro, step->load_factor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroCertify(LamMacro macro, LamMacroStep *step)
{
  const PetscBool ends = (PetscBool)(!step->complete || step->step == macro->scene->macro.steps);

  PetscFunctionBeginUser;
  step->certificate = step->peak = (LamMacroCertificate){0};
  macro->cost.solves += step->solves;
  macro->cost.queries += step->queries;
  if (macro->certify == LAM_CERTIFY_NONE) PetscFunctionReturn(0);
  if (macro->uncertified[0] || macro->stopped) {
    step->certificate.made = (PetscBool)(macro->certify == LAM_CERTIFY_ALL || ends);
    if (step->certificate.made)
      LamMacroUncertified(&step->certificate, macro->stopped ? "the run was stopped" : macro->uncertified);
    PetscFunctionReturn(0);
  }
  if (!macro->loaded && step->complete) PetscCall(LamMacroKeepInflated(macro));
  if (macro->certify == LAM_CERTIFY_ALL)
    PetscCall(Certify(macro, step, PETSC_MAX_INT, &step->certificate));
  else if (ends)
    PetscCall(CertifyEnd(macro, step));
  else if (macro->loaded) {
    PetscCall(KeepPeak(macro, step));
    PetscCall(LamMacroAddWaypoint(macro, step->step));
  }
  PetscFunctionReturn(0);
}

/* Its forces depend on the path that the body has gone. */
static PetscBool HasFriction(const LamMacroSpec *spec)
{
  PetscBool has = PETSC_FALSE;

  for (PetscInt b = 0; b < spec->boundary_count; b++) has = (PetscBool)(has || spec->boundary[b].friction > 0);
  return has;
}

PetscErrorCode LamMacroSetReference(LamMacro macro, LamResponder reference, LamCertify which, PetscBool branches)
{
  const PetscBool impossible =
      (PetscBool)(macro->border_count || macro->scene->sealed || macro->water_law || HasFriction(&macro->scene->macro));

  PetscFunctionBeginUser;
  macro->reference = reference;
  macro->certify = which;
  macro->branches = branches;
  macro->follows = (PetscBool)(branches && which == LAM_CERTIFY_SHARE);
  macro->uncertified[0] = '\0';
  if (impossible)
    PetscCall(PetscStrncpy(macro->uncertified, "not of bodies with load control, free grips, sealed cells or friction",
                           sizeof(macro->uncertified)));
  PetscCheck(!impossible || which != LAM_CERTIFY_ALL, macro->comm, PETSC_ERR_USER_INPUT,
             "%s: reactions of bodies with load control, free grips, sealed cells or friction cannot be certified; "
             "leave that out",
             macro->scene->path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroRefuseCertificate(LamMacro macro, const char why[])
{
  PetscFunctionBeginUser;
  macro->certify = LAM_CERTIFY_SHARE;
  PetscCall(PetscStrncpy(macro->uncertified, why, sizeof(macro->uncertified)));
  PetscFunctionReturn(0);
}
