/*
  Equilibrium on a straight path of F, F = F_0 + s D, controlled by what the lamella dissipates.

  Method. Where F is prescribed, tissue that softens faster than what is around it unloads falls to another state. Here
  the share s of the path is an unknown, and an opening of the lamella is prescribed instead: c.y, with the weights

    c = dD/dy,       D: energy dissipated in the step,

  of the first guess, a step along b = -K^-1 dr/ds at fixed damage that dissipates the energy asked for. D only grows,
  so the path of states is followed through limits of F and snap-back.

  At fixed s and opening a state is a minimum of the energy, under a force -mu c on the lamella; s is sought for which
  mu = 0. With a = -K^-1 r and e = K^-1 c,

    dy = a - mu e,  mu = c.a / c.e        lowers the energy at fixed s, with c.dy = 0: shortened until it does,
    dy = a + ds b,  ds = -c.a / c.b       Newton's step of y and s, taken where the rest is small against mu c.

  K is convex on motions with c.dy = 0 if it has no negative eigenvalue and c.e > 0, or one and c.e < 0. Where it is
  not, or a step was short, the lamella's upper bound serves (cohesive.h). The state found is stable under the control
  if its K is so, with c of the state.

  Where less than the energy asked for is dissipated, s is prescribed: a step at most `most` farther.

  References. Gutierrez, Commun. Numer. Meth. Engng 20 (2004) 19; Verhoosel, Remmers & Gutierrez, Int. J. Numer. Meth.
  Engng 77 (2009) 1290.
*/
#include "dissipate.h"
#include "clock.h"

#define HALVINGS 6
#define HALF 0.5  /* share of tau that the first guess of a prescribed s dissipates: in the end it is more */
#define WORTH 0.1 /* energy dissipated at a cell, of the largest, that makes it one that breaks */
#define LAYERS 2  /* of cells around these that move in the window */
#define WINDOW 2  /* least ratio of all cells to those */
#define PART_TOLERANCE 1e-5
#define PART_ITERATIONS 30
#define ROUNDS 12 /* of the window, and then all unknowns once, ... */
#define SOME 8    /* iterations, where the window would be too large, until LAM_DISSIPATION_FINE */

/* The cells at which most is dissipated, and those where the residual is largest. */
static void FindSeeds(const LamDissipation *t, PetscReal residual[], PetscBool seed[])
{
  const LamMesh *mesh = &t->rve->mesh;
  const PetscInt nodes = mesh->node_count / mesh->cell_count;
  PetscReal most;

  for (PetscInt c = 0; c < mesh->cell_count; ++c) {
    residual[c] = 0.0;
    for (PetscInt node = c * nodes; node < (c + 1) * nodes && t->norm < PETSC_INFINITY; ++node)
      for (PetscInt d = 0; d < 2 && mesh->node_class[node] > 0; ++d)
        residual[c] = PetscMax(residual[c], PetscAbsReal(t->rve->residual[2 * mesh->node_class[node] + d]));
  }
  most = LamLargestEntry(mesh->cell_count, t->by_cell);
  for (PetscInt c = 0; c < mesh->cell_count; ++c) seed[c] = (PetscBool)(t->by_cell[c] > WORTH * most);
  most = LamLargestEntry(mesh->cell_count, residual);
  for (PetscInt c = 0; c < mesh->cell_count; ++c) seed[c] = (PetscBool)(seed[c] || residual[c] > WORTH * most);
}

/* Takes the stresses outside the window to those of its last step of s. */
static PetscErrorCode MoveOutside(LamDissipation *t, const LamPart *part, PetscReal ds)
{
  const LamRVE rve = t->rve;
  const LamLoad before = LamDissipationLoadAt(t, t->share - ds);
  LamPart outside = *part;
  PetscReal dF[9];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rve->mesh.cell_count, &outside.moves));
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) outside.moves[c] = (PetscBool)!part->moves[c];
  for (PetscInt i = 0; i < 9; ++i) dF[i] = ds * t->along[i];
  rve->step[0] = rve->step[1] = 0.0;
  for (PetscInt i = 0; i < rve->linear->positions; ++i) rve->step[i + 2] = ds * t->far[i];
  LamTrialPosition(rve, -1.0);
  rve->part = &outside;
  LamUpdateStresses(rve, &before, rve->trial, rve->step, dF, 1.0);
  rve->part = NULL;
  PetscCall(PetscFree(outside.moves));
  PetscFunctionReturn(0);
}

/* A better guess: the same in a window of cells around what opens, the others going along b. With s prescribed they
   stay where they are. */
static PetscErrorCode InWindow(LamDissipation *t, const LamPart *part, PetscReal tau, PetscBool is_held,
                               PetscBool advances)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n, *unknown;
  const PetscReal share = t->share;
  PetscBool converged;
  PetscInt count;

  PetscFunctionBeginUser;
  PetscCall(LamPartSystemCreate(rve, part, &t->window));
  count = LamPartSystemUnknowns(t->window, &unknown);
  PetscCall(PetscMalloc1(n, &t->far));
  PetscCall(PetscArraycpy(t->far, t->solution + n, n));
  for (PetscInt k = 0; k < count; ++k) t->far[unknown[k]] = 0.0;
  PetscCall(PetscArrayzero(t->solution, 3 * n));
  PetscCall(PetscArraycpy(t->solution + n, t->far, n));
  LamPartUse(rve, part);
  if (advances) PetscCall(LamDissipationAdvance(t, tau));
  PetscCall(
      LamDissipationIterate(t, tau, PetscMax(PART_TOLERANCE, 1e-3 * t->norm), is_held, PART_ITERATIONS, &converged));
  LamPartUse(rve, NULL);
  PetscCall(MoveOutside(t, part, t->share - share));
  PetscCall(PetscFree(t->far));
  PetscCall(LamPartSystemDestroy(&t->window));
  (void)LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &t->slope, t->by_cell);
  if (!is_held) LamDissipationSetOpening(t);
  PetscFunctionReturn(0);
}

static PetscErrorCode Approach(LamDissipation *t, PetscReal tau, PetscBool is_held, PetscBool advances,
                               PetscBool *serves)
{
  const LamRVE rve = t->rve;
  const PetscInt cells = rve->mesh.cell_count;
  PetscBool *seed;
  PetscReal *residual;
  LamPart *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(cells, &seed, cells, &residual));
  FindSeeds(t, residual, seed);
  PetscCall(LamPartCreate(rve, seed, LAYERS, &part));
  *serves = (PetscBool)(WINDOW * part->moving < cells && !rve->linear->lumens && t->path->to.cohesion == 0.0);
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  window of %d of %d cells%s\n", (int)part->moving,
                           (int)cells, *serves ? "" : ": too large"));
  if (*serves)
    PetscCall(InWindow(t, part, tau, is_held, advances));
  else if (advances)
    PetscCall(LamDissipationAdvance(t, tau));
  PetscCall(LamPartDestroy(&part));
  PetscCall(PetscFree2(seed, residual));
  PetscFunctionReturn(0);
}

/* Whether the state found is stable under its control; its consistent tangent is then factored. */
static PetscErrorCode CheckStability(LamDissipation *t, PetscBool is_held, PetscBool *stable, PetscInt *negative)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;
  PetscReal slope;

  PetscFunctionBeginUser;
  PetscCall(LamFactorConsistent(rve, &t->border->load, negative, stable));
  if (!*stable) PetscFunctionReturn(0);
  *stable = (PetscBool)(*negative == 0);
  if (is_held || *stable || *negative > 1) PetscFunctionReturn(0);
  (void)LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &slope, t->by_cell);
  PetscCall(PetscArraycpy(t->rhs, t->gradient + 2, n));
  PetscCall(LamLinearSolve(rve->linear, 1, t->rhs, t->solution));
  *stable = (PetscBool)(LamInnerProduct(n, t->rhs, t->solution) < 0.0);
  PetscFunctionReturn(0);
}

/* One step from a state, with s prescribed or not; *found: a stable state is in rve->y. */
static PetscErrorCode Step(LamDissipation *t, LamRVEState at, PetscReal share, PetscReal tau, PetscReal most,
                           PetscBool is_held, PetscBool *found, PetscInt *negative)
{
  const PetscReal limit = t->path->faces * t->face; /* of a step of prescribed s */

  PetscFunctionBeginUser;
  LamDissipationBegin(t, at, share);
  PetscCall(LamDissipationGuess(t, (is_held ? HALF : LAM_DISSIPATION_FIRST) * tau, most, is_held, found));
  t->stuck = (PetscBool) !*found;
  t->is_held = is_held;
  *found = t->free = PETSC_FALSE;
  t->norm = PETSC_INFINITY;
  for (PetscInt k = 0; k < ROUNDS && !*found && !t->stuck; ++k) {
    PetscBool serves = PETSC_FALSE;

    if (!(is_held && k == 0) && t->norm > LAM_DISSIPATION_FINE)
      PetscCall(Approach(t, is_held ? limit : tau, is_held, (PetscBool)(!is_held && k == 0), &serves));
    PetscCall(LamDissipationIterate(t, is_held ? limit : tau, LamNewtonTolerance(t->rve), is_held,
                                    serves || (is_held && k == 0) ? 1
                                    : k + 1 < ROUNDS              ? SOME
                                                                  : LAM_DISSIPATION_ITERATIONS,
                                    found));
  }
  if (*found && !is_held && t->share > share + LAM_DISSIPATION_EXCESS * most)
    *found = PETSC_FALSE; /* the load ends the step */
  t->is_held = PETSC_FALSE;
  if (*found) PetscCall(CheckStability(t, is_held, found, negative));
  PetscFunctionReturn(0);
}

static PetscErrorCode Find(LamDissipation *t, LamRVEState at, LamDissipationPoint *point, LamResponse *response)
{
  const LamRVE rve = t->rve;
  const PetscReal most = PetscMin(t->path->most, 1.0 - point->share);
  PetscReal tau[2] = {t->path->faces * t->face, t->path->faces * t->face}; /* of both kinds of steps */
  PetscBool found = PETSC_FALSE, is_held = (PetscBool)!point->dissipates;
  PetscInt negative = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k <= 2 * HALVINGS && !found && !rve->work.stopped; ++k) {
    if (k > 0) is_held = (PetscBool)!is_held;
    PetscCall(Step(t, at, point->share, tau[is_held], most, is_held, &found, &negative));
    tau[is_held] *= 0.5;
  }
  if (found) {
    point->share = t->share;
    point->dissipates = (PetscBool)!is_held;
    response->load = t->border->load;
    response->status = LAM_CONVERGED;
    response->negative_eigenvalues = negative;
    PetscFunctionReturn(0);
  }
  PetscCall(LamRefuse(response, LAM_NOT_CONVERGED,
                      "no state found that dissipates down to %.3g of a face, after %d iterations: try other `faces`",
                      (double)(tau[0] / t->face), (int)rve->work.iterations));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESolveDissipating(LamRVE rve, const LamDissipationPath *path, LamDissipationPoint *point,
                                      LamRVEState state, LamResponse *response)
{
  const PetscReal begin = LamClock(), asked = rve->micro.contact_width;
  LamRVEState before;
  LamDissipation t;

  PetscFunctionBeginUser;
  PetscCheck(rve->layer, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "only tissue with a lamella dissipates");
  PetscCheck(!rve->mesh.cuts, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "cells whose walls tear burst between states: their turgor is not under control of what is dissipated");
  PetscCheck(path->most > 0.0 && path->most <= 1.0 && path->faces > 0.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a step of %g of the path and %g faces; both must be positive, the first at most 1", (double)path->most,
             (double)path->faces);
  PetscCheck(state->solved, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "the state is no solution");
  PetscCheck(!LamIsOutOfPlane(rve, &path->to, state) && path->to.F[2] == 0.0 && path->to.F[5] == 0.0, PETSC_COMM_SELF,
             PETSC_ERR_SUP, "displacements along the cells are not under control of what is dissipated");
  PetscCall(LamRVEStateCreate(rve, &before));
  PetscCall(LamRVEStateCopy(state, before));
  PetscCall(LamBeginResponse(rve, &path->to, state, response));
  PetscCall(LamUseSmoothLaw(rve, asked > 0.0 ? asked : LAM_USUAL_WIDTH));
  PetscCall(LamDissipationCreate(rve, path, &t));
  PetscCall(Find(&t, before, point, response));
  PetscCall(LamEndResponse(rve, &t.border->load, state, response));
  if (response->status == LAM_CONVERGED)
    response->work = state->work = before->work + LamStepWorkOf(before, state).work;
  PetscCall(LamDissipationDestroy(&t));
  PetscCall(LamRVEStateDestroy(&before));
  response->seconds = LamClock() - begin;
  PetscFunctionReturn(0);
}
