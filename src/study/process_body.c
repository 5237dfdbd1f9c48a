/*
  A body whose tissue changes in time. Responses, files and figures are those of an FE2 run (fe2_run.h), in which a
  reported state is a step.
*/
#include "process_run.h"
#include "clock.h"

/* ---- states ---- */

/* In units of the initial C1 + C2, as the quantities compared with it. */
static LamStrength StrengthNow(const LamScene *scene, const LamBodyState *state)
{
  LamStrength strength = scene->strength;

  strength.lamella_normal *= state->factor[LAM_CHANGING_LAMELLA];
  strength.lamella_shear *= state->factor[LAM_CHANGING_LAMELLA];
  strength.wall *= state->factor[LAM_CHANGING_WALL_STRENGTH];
  return strength;
}

/* `step` of LamFE2Run. */
static PetscErrorCode ReportState(void *ctx, const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  const LamBodyStudy *study = (const LamBodyStudy *)run; /* its first member */

  PetscFunctionBeginUser;
  if (study->state) PetscCall(study->state(ctx, study, &study->history.states[study->history.count - 1], peak_memory));
  PetscFunctionReturn(0);
}

/* LamBodyMonitor */
static PetscErrorCode StateDone(const LamBodyState *state, void *ctx)
{
  LamBodyStudy *study = (LamBodyStudy *)ctx;
  LamFE2Run *fe2 = &study->fe2;
  LamBodyHistory *h = &study->history;

  PetscFunctionBeginUser;
  if (LamIsFirst(fe2->comm)) {
    PetscCall(LamListGrow(h->count, sizeof(*h->states), &h->capacity, &h->states));
    h->states[h->count++] = *state;
  }
  fe2->summary.strength = StrengthNow(fe2->scene, state);
  fe2->walls = state->walls;
  PetscCall(LamFE2EndStep(fe2, &state->step, LamProcessProgress(fe2->scene, state->time), LAM_PROCESS_PARTS));
  PetscFunctionReturn(0);
}

/* ---- time evolution ---- */

/* Area of the membranes at each point; it differs in regions of other cells. Collective. */
static PetscErrorCode SetMembranes(LamBodyStudy *study)
{
  const LamFE2Tissues *tissues = &study->fe2.tissues;
  const LamScene *scene = study->fe2.scene;
  PetscReal *membrane;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(tissues->points, &membrane));
  for (PetscInt p = 0; p < tissues->points; p++) {
    if (!tissues->point) membrane[p] = LamMembraneArea(&scene->micro);
    for (PetscInt k = 0; tissues->point && k < tissues->point[p].count; k++) {
      const LamBlendTerm *term = &tissues->point[p].term[k];
      const LamScene *own = &tissues->tissues[term->knot].scene;

      membrane[p] += term->weight * LamMembraneArea(&own->micro) * scene->scales.length / own->scales.length;
    }
  }
  PetscCall(LamBodySetMembranes(study->body, membrane));
  PetscCall(PetscFree(membrane));
  PetscFunctionReturn(0);
}

/* Sets the moduli of all tissues; `set` of LamBodySetTissue. */
static PetscErrorCode ChangeTissue(void *ctx, const LamTissueFactors *factors)
{
  LamBodyStudy *study = (LamBodyStudy *)ctx;

  PetscFunctionBeginUser;
  study->fe2.walls_differ = PETSC_TRUE;
  study->fe2.factors = *factors;
  for (PetscInt t = 0; t < study->fe2.tissues.count; t++)
    PetscCall(LamFE2ChangeTissue(&study->fe2.tissues.tissues[t], factors));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyStudyPrepare(LamBodyStudy *study)
{
  LamFE2Run *fe2 = &study->fe2;

  PetscFunctionBeginUser;
  fe2->start = LamClock();
  fe2->step = ReportState;
  PetscCall(LamFE2CheckTargets(fe2, PETSC_FALSE));
  PetscCall(LamMacroCreate(fe2->comm, &fe2->macro));
  PetscCall(LamMacroSetScene(fe2->macro, fe2->scene));
  PetscCall(LamBodyCreate(fe2->scene, fe2->macro, &study->body));
  PetscCall(LamMacroSetUp(fe2->macro));
  PetscCall(LamFE2PrepareResponse(fe2));
  PetscCall(SetMembranes(study));
  PetscCall(LamBodySetMonitor(study->body, StateDone, study));
  if (fe2->response == LAM_FE2_DIRECT) PetscCall(LamBodySetTissue(study->body, ChangeTissue, study));
  PetscCall(LamSummaryCreate(fe2->scene, &fe2->summary));
  study->history.scene = fe2->scene;
  PetscFunctionReturn(0);
}

/* Boundaries move with the load parameter alone, which stays 0 unless a leg prescribes it. */
static void WarnOfNoLoad(const LamFE2Run *fe2)
{
  const LamProcessSpec *spec = &fe2->scene->process;
  const LamMacroSpec *macro = &fe2->scene->macro;
  PetscBool loads = PETSC_FALSE, moves = PETSC_FALSE;

  for (PetscInt k = 0; k < spec->leg_count; k++) loads = (PetscBool)(loads || spec->legs[k].load != 0);
  for (PetscInt b = 0; b < macro->boundary_count; b++) {
    const LamBoundary *boundary = &macro->boundary[b];

    moves = (PetscBool)(moves || boundary->displacement[0] != 0 || boundary->displacement[1] != 0 ||
                        boundary->traction[0] != 0 || boundary->traction[1] != 0);
  }
  if (LamIsFirst(fe2->comm) && moves && !loads)
    LamReportNote(&fe2->reporter,
                  "%s: the load parameter stays 0, so what macro.boundary moves or presses does nothing; "
                  "process.program says when it does: [{for: 10 s, load: 1}]",
                  fe2->scene_path);
}

/* LamFE2Follow */
static PetscErrorCode Follow(void *ctx, PetscBool *stopped, size_t size, char status[])
{
  LamBodyStudy *study = (LamBodyStudy *)ctx;

  PetscFunctionBeginUser;
  WarnOfNoLoad(&study->fe2);
  if (study->fe2.out) LamFE2FileSetBeside(study->fe2.out, LamBodyHistoryWrite, &study->history);
  LamActivitySet("time, %%");
  if (LamIsFirst(study->fe2.comm)) PetscCall(LamReportProgress(&study->fe2.reporter, 0, LAM_PROCESS_PARTS, 0));
  PetscCall(LamBodyRun(study->body, &study->reason, study->message));
  *stopped = (PetscBool)(study->reason == LAM_PROCESS_STOPPED);
  PetscCall(PetscStrncpy(status, study->reason == LAM_PROCESS_DONE ? "done" : study->message, size));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyStudySolve(LamBodyStudy *study)
{
  PetscFunctionBeginUser;
  study->reason = LAM_PROCESS_STOPPED;
  PetscCall(LamFE2FollowInFiles(&study->fe2, Follow, study));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyStudyDestroy(LamBodyStudy *study)
{
  PetscFunctionBeginUser;
  PetscCall(LamBodyDestroy(&study->body));
  PetscCall(PetscFree(study->history.states));
  PetscCall(LamFE2Destroy(&study->fe2));
  PetscFunctionReturn(0);
}
