/*
  Rates of the jumps along the lamella with the load, of a state whose consistent tangent is factored.

  Method. The positions change by dy/dq = -K^-1 L_yq (homogenise.c). Jumps in the frames of their points are kinematics
  alone, so their rates are the difference quotients along these columns.
*/
#include "measure.h"

#define STEP                                                                                                           \
  1e-6 /* change of F and p: errors of rounding (1e-16/1e-6) are as large as those of the quotient, about              \
        */

#define LEVER                                                                                                          \
  2.0 /* apothems: distance of the centres of neighbours, by which tractions on their face add to the stress */

typedef struct {
  LamRVE rve;
  LamBondRate *bond;
  PetscInt rate; /* -1: the jumps themselves */
} Noting;

static void NoteBond(void *ctx, const LamBondPoint *point)
{
  const Noting *noting = (const Noting *)ctx;
  const PetscReal jump[2] = {point->jump.normal, point->jump.shear};
  LamBondRate *bond = &noting->bond[point->point];

  for (PetscInt d = 0; d < 2 && noting->rate >= 0; ++d) bond->rate[d][noting->rate] = (jump[d] - bond->jump[d]) / STEP;
  if (noting->rate >= 0) return;
  for (PetscInt d = 0; d < 2; ++d) bond->jump[d] = jump[d];
  bond->secant = 2.0 * point->step.d;
  bond->slope = 2.0 * point->step.d + 4.0 * point->step.dd * point->jump.q;
}

PetscErrorCode LamBondRatesFind(LamRVE rve, const LamLoad *load, const PetscReal *const columns[LAM_BOND_RATES])
{
  const PetscInt component[4] = {0, 1, 3, 4};
  Noting noting = {rve, rve->rates->bond, -1};
  PetscReal *y;

  PetscFunctionBeginUser;
  LamLayerVisitPoints(rve, load->F, rve->y, NoteBond, &noting);
  PetscCall(PetscMalloc1(rve->length, &y));
  for (noting.rate = 0; noting.rate < LAM_BOND_RATES; ++noting.rate) {
    LamLoad moved = *load;

    if (noting.rate < 4) moved.F[component[noting.rate]] += STEP;
    PetscCall(PetscArraycpy(y, rve->y, rve->length));
    for (PetscInt i = 0; i < rve->linear->positions; ++i) y[i + 2] -= STEP * columns[noting.rate][i];
    LamLayerVisitPoints(rve, moved.F, y, NoteBond, &noting);
  }
  PetscCall(PetscFree(y));
  rve->rates->load = *load;
  rve->rates->spent = rve->layer->spent;
  for (PetscInt p = 0; p < rve->layer->count; ++p) rve->rates->before[p] = rve->layer->bond[p].before;
  PetscFunctionReturn(0);
}

/* The point's jump after a change of load; returns delta before it. */
static PetscReal Move(const LamBondRate *rate, const PetscReal change[LAM_BOND_RATES], PetscReal beta, LamJump *jump)
{
  PetscReal to[2] = {rate->jump[0], rate->jump[1]};

  for (PetscInt q = 0; q < LAM_BOND_RATES; ++q)
    for (PetscInt d = 0; d < 2; ++d) to[d] += rate->rate[d][q] * change[q];
  *jump = (LamJump){.normal = to[0], .shear = to[1]};
  jump->q = PetscSqr(PetscMax(0.0, to[0])) + PetscSqr(beta * to[1]);
  return PetscSqrtReal(PetscSqr(PetscMax(0.0, rate->jump[0])) + PetscSqr(beta * rate->jump[1]));
}

void LamLayerPredict(LamRVE rve, const LamBondRate rates[], const PetscReal change[LAM_BOND_RATES],
                     const LamBondHistory before[], LamBondHistory after[], LamLayerPrediction *prediction)
{
  const LamLayer *layer = rve->layer;
  PetscBool breaks_through = PETSC_FALSE;

  *prediction = (LamLayerPrediction){0};
  for (PetscInt p = 0; p < layer->count; ++p) {
    LamBond bond = layer->bond[p];
    const PetscBool cut = (PetscBool)(p >= layer->between);
    LamBondPoint point = {.point = p, .face = cut ? -1 : p / (LAM_EDGE_POINTS * rve->mesh.along)};
    PetscReal start, delta, T;
    LamBondHistory kept;

    LamBondTake(&before[p], &bond);
    start = Move(&rates[p], change, bond.law.beta, &point.jump);
    LamCohesiveStepEvaluate(&bond.now, bond.kappa, point.jump.q, &point.step);
    LamDamageAdd(rve, &bond, &point, &prediction->damage);
    kept = LamBondKeep(&bond, &point.jump, &point.step);
    if (cut && kept.integrity <= 0.0 && before[p].integrity > 0.0) breaks_through = PETSC_TRUE;
    if (after) after[p] = kept;
    delta = PetscSqrtReal(point.jump.q);
    T = rates[p].secant * start + rates[p].slope * (delta - start);
    prediction->error += layer->weight[p] * PetscAbsReal(2.0 * point.step.d * delta - T);
  }
  prediction->error *= LEVER / rve->mesh.V0;
  if (breaks_through) prediction->error = PETSC_INFINITY; /* a cell may burst */
}
