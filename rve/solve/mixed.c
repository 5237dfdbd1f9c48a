/*
  States with some components of P prescribed and the same components of F free.

  Method. Fast tier: the free components of F are unknowns of the Newton iteration (border.h), which adds right-hand
  sides but no factorisations. If it fails or its solution is not stable under the prescribed stress, the safe tier
  follows: continuation from the previous state, then descent on Psi(F) - P.F over the free components. A state is
  stable under the control if it is stable at its F and dP/dF of the free components is positive definite. An
  equilibrium that is not is returned as unstable if no stable state is found.
*/
#include "mixed.h"
#include "clock.h"
#include "section_frame.h"

static const char *const component_names[9] = {"11", "12", "13", "21", "22", "23", "31", "32", "33"};

PetscErrorCode LamMixedLook(const LamStressControl *control, const LamResponse *response, LamMixedView *view)
{
  PetscFunctionBeginUser;
  *view = (LamMixedView){.potential = response->energy};
  for (PetscInt c = 0; c < 9; ++c) {
    if (!control->given[c]) continue;
    view->excess[view->count] = response->P[c] - control->P[c];
    view->largest = PetscMax(view->largest, PetscAbsReal(view->excess[view->count]));
    view->potential -= control->P[c] * response->load.F[c];
    view->component[view->count++] = c;
  }
  for (PetscInt k = 0; k < view->count; ++k)
    for (PetscInt l = 0; l < view->count; ++l)
      view->A[k][l] = response->tangent[9 * view->component[k] + view->component[l]];
  PetscCall(LamSmallEigenvectors(view->count, (const PetscReal(*)[LAM_SMALL])view->A, view->w, view->V));
  PetscFunctionReturn(0);
}

/* Checks a control; an invalid one is refused. */
static PetscErrorCode CheckControl(LamRVE rve, const LamStressControl *control, LamResponse *response)
{
  static const PetscBool in_plane[9] = {1, 1, 0, 1, 1, 0, 0, 0, 1};
  static const PetscInt pairs[3][2] = {{1, 3}, {2, 6}, {5, 7}};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 9; ++i) {
    if (!control->given[i]) continue;
    if (!in_plane[i] && !rve->antiplane)
      PetscCall(LamRefuse(response, LAM_INVALID_F, "P%s is prescribed; plane strain has no F%s to follow it",
                          component_names[i], component_names[i]));
    else if (PetscIsInfOrNanReal(control->P[i]))
      PetscCall(LamRefuse(response, LAM_INVALID_F, "the prescribed P%s is not finite", component_names[i]));
  }
  for (PetscInt k = 0; k < 3; ++k)
    if (control->given[pairs[k][0]] && control->given[pairs[k][1]])
      PetscCall(LamRefuse(response, LAM_INVALID_F,
                          "F%s and F%s are both free: the tissue can rotate; prescribe one of them",
                          component_names[pairs[k][0]], component_names[pairs[k][1]]));
  PetscFunctionReturn(0);
}

PetscBool LamMixedIsOutOfPlane(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state)
{
  const LamLoad section = LamSectionLoad(load);
  const PetscBool *given = control->given;

  return (PetscBool)(rve->antiplane && (given[2] || given[5] || given[6] || given[7] || load->F[2] != 0.0 ||
                                        load->F[5] != 0.0 || LamIsOutOfPlane(rve, &section, state)));
}

/* remedy: the free component whose prescription would make the state stable; -1: no single one does. */
static PetscErrorCode FindRemedy(const LamMixedView *view, PetscInt *remedy)
{
  PetscReal highest = LAM_MIXED_SOFTEST;

  PetscFunctionBeginUser;
  *remedy = -1;
  if (view->count == 1) *remedy = view->component[0];
  for (PetscInt left_out = 0; left_out < view->count && view->count > 1; ++left_out) {
    PetscReal A[LAM_SMALL][LAM_SMALL] = {{0}}, w[LAM_SMALL], V[LAM_SMALL][LAM_SMALL];

    for (PetscInt k = 0; k < view->count - 1; ++k)
      for (PetscInt l = 0; l < view->count - 1; ++l) A[k][l] = view->A[k + (k >= left_out)][l + (l >= left_out)];
    PetscCall(LamSmallEigenvectors(view->count - 1, (const PetscReal(*)[LAM_SMALL])A, w, V));
    if (!(w[0] > highest)) continue;
    highest = w[0];
    *remedy = view->component[left_out];
  }
  PetscFunctionReturn(0);
}

/* Refuses an equilibrium that is unstable under the prescribed stress. */
static PetscErrorCode CheckStability(const LamStressControl *control, LamResponse *response)
{
  char remedy[32] = "all of F";
  PetscInt component;
  LamMixedView view;

  PetscFunctionBeginUser;
  PetscCall(LamMixedLook(control, response, &view));
  if (LamMixedIsStable(&view)) PetscFunctionReturn(0);
  PetscCall(FindRemedy(&view, &component));
  if (component >= 0) PetscCall(PetscSNPrintf(remedy, sizeof(remedy), "F%s", component_names[component]));
  response->stable = PETSC_FALSE;
  response->lowest_eigenvalue = view.w[0];
  PetscCall(LamRefuse(response, LAM_UNSTABLE,
                      "in equilibrium, but not stable under the prescribed stress: lowest stiffness %.3g (C1+C2); "
                      "stable where %s is prescribed instead",
                      (double)view.w[0], remedy));
  PetscFunctionReturn(0);
}

/* Fast tier, then safe tier; a solution replaces `state`. */
static PetscErrorCode SolveTiers(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state,
                                 LamResponse *response)
{
  LamRVEState fast, before = NULL;
  LamLoad guess = *load;
  LamResponse safe;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &fast));
  PetscCall(LamRVEStateCopy(state, fast));
  if ((rve->layer || rve->memory) && !rve->looks_back) {
    PetscCall(LamRVEStateCreate(rve, &before));
    PetscCall(LamRVEStateCopy(state, before));
  }
  if (!LamMixedIsOutOfPlane(rve, load, control, state)) PetscCall(LamMixedFast(rve, &guess, control, fast, response));
  if (LamResponseHasFields(response)) PetscCall(CheckStability(control, response));
  if (response->status != LAM_CONVERGED && !LamWasStopped(response) && !rve->near_only) {
    const PetscInt iterations = response->newton_iterations, factorisations = response->factorisations;

    PetscCall(LamMixedSafe(rve, &guess, control, state, &safe));
    if (safe.status == LAM_UNSTABLE) PetscCall(CheckStability(control, &safe));
    if (safe.status == LAM_CONVERGED || LamWasStopped(&safe) || !LamResponseHasFields(response)) {
      *response = safe;
      PetscCall(LamRVEStateCopy(state, fast));
    }
    response->newton_iterations = iterations + safe.newton_iterations;
    response->factorisations = factorisations + safe.factorisations;
  }
  if (LamResponseHasFields(response)) PetscCall(LamRVEStateCopy(fast, state));
  if (before) PetscCall(LamHistoryStep(rve, before, control, state, response));
  PetscCall(LamRVEStateDestroy(&before));
  PetscCall(LamRVEStateDestroy(&fast));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESolveMixed(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state,
                                LamResponse *response)
{
  const PetscReal begin = LamClock();
  const LamWanted wanted = rve->wanted;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 9; ++i) any = (PetscBool)(any || control->given[i]);
  if (!any) {
    PetscCall(LamRVESolve(rve, load, state, response));
    PetscFunctionReturn(0);
  }
  rve->wanted |= LAM_WANT_DERIVATIVES; /* needed to assess stability under the prescribed stress */
  PetscCall(LamBeginResponse(rve, load, state, response));
  PetscCall(LamCheckLoad(rve, load, response));
  if (response->status != LAM_INVALID_F) PetscCall(CheckControl(rve, control, response));
  if (response->status != LAM_INVALID_F) PetscCall(SolveTiers(rve, load, control, state, response));
  if (!LamResponseHasFields(response)) /* free components of F are unknown */
    for (PetscInt i = 0; i < 9; ++i)
      if (control->given[i]) response->load.F[i] = NAN;
  rve->wanted = wanted;
  response->seconds = LamClock() - begin;
  PetscFunctionReturn(0);
}
