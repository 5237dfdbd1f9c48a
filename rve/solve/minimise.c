/*
  Minimisation of the energy: the loop that finds states with the smooth law of contact, and bonded ones where the other
  tiers fail.

  Method. Newton's method with independent wall stresses (element.h). If the matrix is not positive definite, it is
  shifted (inertia correction): a shift that fails is multiplied by GROWTH, one that serves is divided by DECAY for the
  next iteration. Steps are limited in length, and must lower the energy (Armijo). A full step may fail only because it
  violates the stiff constraints of the walls: it is then corrected with the same factor, and shortened if that does not
  help. The energy never rises, so the iteration goes down to a minimum. Near a saddle the softest mode is added,
  downhill. Once the energy no longer resolves the steps, the residual decides.

  A lamella that loads on and unloads at kinks is met by steps of an upper bound of its energy (cohesive.h) in turn with
  Newton's, where these are short.

  Cells whose walls tear on the way lose their pressure, and the iteration goes on from there (lamella.h).

  With free components of F (border.h) the energy is L - V0 P.F, and the border's steps descend.

  Reference. Nocedal & Wright, Numerical Optimization, 3.4.
*/
#include "solve.h"

#define ITERATIONS 400
#define GROWTH 6.0
#define DECAY 5.0
#define LEAST_SHIFT 1e-7 /* of the largest diagonal entry */
#define STEP_LIMIT 0.15  /* apothems; less than the depth to which walls know each other (touching.c) */
#define LEAST_STEP 1e-6  /* least share of a step */
#define ARMIJO 1e-4
#define SHORT 0.3 /* share of a step below which a lamella's tangent is replaced by its upper bound */
#define CORRECTIONS 2
#define WORTH_CORRECTING 0.2 /* least share of a step that is corrected */
#define IDLE 8               /* iterations without progress after which the last digits are reached */
#define PROGRESS 0.5
#define FULL_STEPS 12   /* from which on the least shift falls, ... */
#define EASE 0.3        /* ... by this factor each, ... */
#define LEAST_EASE 1e-4 /* ... to this one: there the proximal shift is near */
#define FIRM 1e-3       /* largest residual of a state that is accepted after a shifted step */

typedef struct {
  LamRVE rve;
  LamBorder *border;
  const LamLoad *load;      /* that of the border if there is one */
  PetscReal *y, *step;      /* [length] before the step, and the step */
  LamElementStress *stress; /* [element] before the step */
  PetscReal *mode, *image;  /* [n] */
  LamLoad before;
  PetscReal energy, rounding, slope; /* energy at the iterate, its rounding, slope along the step */
  PetscReal shift, last;             /* of this factor; the last one that was not zero */
  PetscReal largest, previous;       /* steps */
  PetscReal ease;                    /* factor of the least shift */
  PetscInt full;                     /* shifted steps since the last one that was shortened */
} Descent;

static PetscReal BorderWork(const LamBorder *border, PetscReal V0, const LamLoad *load)
{
  PetscReal work = 0.0;

  for (PetscInt k = 0; border && k < border->count; ++k)
    work += V0 * border->P[k] * load->F[LamFComponent[border->q[k]]];
  return work;
}

static PetscErrorCode EnergyAt(Descent *d, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                               PetscBool *valid)
{
  PetscFunctionBeginUser;
  PetscCall(LamAssembleEnergy(d->rve, load, y, energy, valid));
  *energy -= BorderWork(d->border, d->rve->mesh.V0, load);
  PetscFunctionReturn(0);
}

static PetscErrorCode FactorConvex(Descent *d, PetscBool *ok)
{
  const LamRVE rve = d->rve;
  const PetscReal diagonal = LamLargestDiagonal(rve->linear);
  const PetscReal none = rve->contact ? LAM_PROXIMAL : 0.0;
  /* more than none also where walls are so thin that their stiffness in bending is less */
  const PetscReal least = PetscMax(d->ease * PetscMin(LEAST_SHIFT * diagonal, LamBendingStiffness(rve)), GROWTH * none);

  PetscFunctionBeginUser;
  d->shift = d->shift / DECAY < least ? none : d->shift / DECAY;
  for (;;) {
    PetscCall(LamRVEFactorExpected(rve, d->shift, ok));
    if (*ok || d->shift > diagonal || rve->work.stopped) break;
    d->shift = d->shift > none ? GROWTH * d->shift : PetscMax(least, d->last / (DECAY * DECAY));
  }
  if (d->shift > none) d->last = d->shift;
  PetscFunctionReturn(0);
}

/* Whether an energy after a step of `alpha` is low enough. */
static PetscBool IsLower(const Descent *d, PetscReal energy, PetscReal alpha)
{
  return (PetscBool)(energy <= d->energy + ARMIJO * alpha * d->slope + d->rounding);
}

static PetscErrorCode Save(Descent *d)
{
  const LamRVE rve = d->rve;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(d->y, rve->y, rve->length));
  PetscCall(PetscArraycpy(d->step, rve->step, rve->length));
  PetscCall(PetscArraycpy(d->stress, rve->stress, rve->mesh.element_count));
  d->before = *d->load;
  PetscFunctionReturn(0);
}

static PetscErrorCode Restore(Descent *d)
{
  const LamRVE rve = d->rve;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(rve->y, d->y, rve->length));
  PetscCall(PetscArraycpy(rve->step, d->step, rve->length));
  PetscCall(PetscArraycpy(rve->stress, d->stress, rve->mesh.element_count));
  if (d->border) d->border->load = d->before;
  PetscFunctionReturn(0);
}

/* Takes a step of `alpha` that did not lower the energy, and corrects it with the same factor. *moved: the energy is
   then low enough. */
static PetscErrorCode Correct(Descent *d, PetscReal alpha, PetscBool *moved)
{
  const LamRVE rve = d->rve;
  const PetscInt couplings = rve->smooth ? rve->smooth->count : 0;

  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  LamTakeStep(rve, d->load, d->border, alpha);
  for (PetscInt k = 0; k < CORRECTIONS && !*moved; ++k) {
    PetscReal energy, norm = 0.0;
    PetscBool valid;

    PetscCall(LamAssemble(rve, d->load, rve->y, &energy, rve->residual, &valid));
    if (!valid || (rve->smooth && rve->smooth->count != couplings))
      break; /* the matrix has grown: there is no factor */
    PetscCall(LamBorderAssemble(rve, d->border, &norm));
    PetscCall(LamSolveStep(rve, d->border));
    if (LamBorderReach(rve, d->border, rve->step + 2) > STEP_LIMIT) break;
    if (LamValidStep(rve, d->load, d->border, 1.0, 0.5) == 0.0) break;
    LamTakeStep(rve, d->load, d->border, 1.0);
    PetscCall(EnergyAt(d, d->load, rve->y, &energy, &valid));
    *moved = (PetscBool)(valid && IsLower(d, energy, alpha));
  }
  if (!*moved) PetscCall(Restore(d));
  PetscFunctionReturn(0);
}

/* The first of shorter and shorter steps that lowers the energy. */
static PetscErrorCode Search(Descent *d, PetscReal *taken)
{
  const LamRVE rve = d->rve;
  PetscBool corrected = PETSC_FALSE;
  PetscReal alpha = PetscMin(1.0, STEP_LIMIT / PetscMax(d->largest, 1e-300));

  PetscFunctionBeginUser;
  *taken = 0.0;
  PetscCall(Save(d));
  for (; alpha > LEAST_STEP; alpha *= 0.5) {
    const LamLoad moved = LamBorderMoved(d->border, d->load, alpha);
    PetscReal energy;
    PetscBool valid, lower;

    LamTrialPosition(rve, alpha);
    PetscCall(EnergyAt(d, &moved, rve->trial, &energy, &valid));
    if (!valid) continue;
    lower = IsLower(d, energy, alpha);
    if (lower) LamTakeStep(rve, d->load, d->border, alpha);
    if (!lower && !corrected && alpha >= WORTH_CORRECTING) {
      corrected = PETSC_TRUE;
      PetscCall(Correct(d, alpha, &lower));
    }
    if (!lower) continue;
    *taken = alpha;
    break;
  }
  PetscFunctionReturn(0);
}

/* Solves for the step; adds the softest mode where the iteration is near a saddle. */
static PetscErrorCode FindStep(Descent *d, PetscReal norm)
{
  const LamRVE rve = d->rve;

  PetscFunctionBeginUser;
  PetscCall(LamSolveStep(rve, d->border));
  d->largest = LamBorderReach(rve, d->border, rve->step + 2);
  if (d->shift > LAM_PROXIMAL && d->largest < 0.5 * LAM_ESCAPE_STEP &&
      (norm < LAM_SADDLE_RESIDUAL || d->largest > LAM_CREEPING * d->previous)) {
    PetscCall(LamAddNegativeCurvature(rve, 6, rve->residual, d->mode, d->image));
    d->largest = LamBorderReach(rve, d->border, rve->step + 2);
  }
  d->previous = d->largest;
  d->slope = LamInnerProduct(rve->ndof - 2, rve->residual + 2, rve->step + 2);
  for (PetscInt k = 0; d->border && k < d->border->count; ++k)
    d->slope += d->border->rest[k] * d->border->dF[LamFComponent[d->border->q[k]]];
  d->slope = PetscMin(0.0, d->slope);
  PetscFunctionReturn(0);
}

/* A short step has met kinks of the lamella: the next one is that of the upper bound, and those after it are Newton's
   again. */
static void SwitchTangent(LamLayer *layer, PetscReal alpha)
{
  layer->secant = (PetscBool)(!layer->secant && alpha < SHORT);
}

/* Where full steps are taken one after another the shift alone keeps them short: cells that nothing holds move far, at
   hardly any stiffness. */
static void AdaptShift(Descent *d, PetscReal alpha)
{
  d->full = d->shift > LAM_PROXIMAL && alpha == 1.0 ? d->full + 1 : 0;
  if (d->full > FULL_STEPS) d->ease = PetscMax(EASE * d->ease, LEAST_EASE);
  if (alpha < 0.5) d->ease = PetscMin(1.0, d->ease / EASE);
}

static PetscErrorCode Create(LamRVE rve, const LamLoad *load, LamBorder *border, Descent *d)
{
  PetscFunctionBeginUser;
  *d = (Descent){.rve = rve, .border = border, .load = load, .previous = PETSC_INFINITY, .ease = 1.0};
  d->rounding = 1e-14 * rve->stiffest * rve->mesh.V0;
  if (border) border->descend = PETSC_TRUE;
  PetscCall(PetscMalloc5(rve->length, &d->y, rve->length, &d->step, rve->mesh.element_count, &d->stress, rve->linear->n,
                         &d->mode, rve->linear->n, &d->image));
  LamStartMode(rve, d->mode);
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Descent *d)
{
  PetscFunctionBeginUser;
  if (d->border) d->border->descend = PETSC_FALSE;
  if (d->rve->layer) d->rve->layer->secant = PETSC_FALSE;
  PetscCall(PetscFree5(d->y, d->step, d->stress, d->mode, d->image));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMinimise(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal tolerance,
                           LamNewtonOutcome *outcome)
{
  PetscReal least = PETSC_INFINITY;
  PetscInt idle = 0;
  Descent d;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  LamForgetTangent(rve);
  PetscCall(Create(rve, load, border, &d));
  for (PetscInt it = 0; it < ITERATIONS && LamMayIterate(rve); ++it) {
    PetscReal norm, alpha;
    PetscBool valid, ok, burst;

    PetscCall(LamAssemble(rve, load, rve->y, &d.energy, rve->residual, &valid));
    if (!valid) break;
    d.energy -= BorderWork(border, rve->mesh.V0, load);
    norm = LamResidualNorm(rve, rve->residual);
    PetscCall(LamBorderAssemble(rve, border, &norm));
    idle = norm < PROGRESS * least ? 0 : idle + 1;
    least = PetscMin(least, norm);
    /* where the matrix was shifted a minimum is not near, and its soft modes are not at rest */
    if (norm <= (d.shift > LAM_PROXIMAL ? PetscMin(tolerance, FIRM) : tolerance) && (it > 0 || !rve->moved))
      *outcome = LAM_NEWTON_CONVERGED;
    if (*outcome == LAM_NEWTON_CONVERGED) break;
    PetscCall(FactorConvex(&d, &ok));
    if (!ok) break;
    PetscCall(FindStep(&d, norm));
    PetscCall(LamReportIteration(rve, "least", it, norm, d.largest, d.shift));
    /* the last digits: neither energy nor residual resolves the steps */
    if (LamAtRounding(rve, norm, tolerance, d.largest) ||
        (idle > IDLE && -d.slope <= d.rounding && norm <= LAM_ROUNDING_MARGIN * tolerance))
      *outcome = LAM_NEWTON_CONVERGED;
    if (*outcome == LAM_NEWTON_CONVERGED) break;
    PetscCall(Search(&d, &alpha));
    AdaptShift(&d, alpha);
    if (rve->layer) SwitchTangent(rve->layer, alpha);
    if (alpha == 0.0) {
      if (-d.slope <= d.rounding && norm <= LAM_ROUNDING_MARGIN * tolerance) *outcome = LAM_NEWTON_CONVERGED;
      break;
    }
    if (rve->seal.closed && alpha < 1.0) LamSealSetConsistent(rve, load, rve->y);
    if (rve->layer) PetscCall(LamLayerBurst(rve, d.load, &burst));
    if (rve->layer && burst) least = PETSC_INFINITY;
  }
  PetscCall(Destroy(&d));
  PetscFunctionReturn(0);
}
