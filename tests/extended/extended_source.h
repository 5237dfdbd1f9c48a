/* The body of extended_quad.c and extended_long.c, which say what a real number is. PETSc's headers come first, so that
   its own functions keep their types; none of those called takes or gives a real number. */
#include "extended.h"
#include <petscmat.h>
#include <petsctime.h>

#undef PetscAbsReal
#undef PetscSqrtReal
#undef PetscCbrtReal
#undef PetscLogReal
#undef PetscSinReal
#undef PetscCosReal
#undef PetscTanReal
#undef PetscAtan2Real
#undef PetscFloorReal
#undef PetscExpReal
#undef PETSC_PI
#undef PETSC_MACHINE_EPSILON
#define PetscReal EXTENDED_REAL
#define PetscAbsReal EXTENDED_FUNCTION(fabs)
#define PetscSqrtReal EXTENDED_FUNCTION(sqrt)
#define PetscCbrtReal EXTENDED_FUNCTION(cbrt)
#define PetscLogReal EXTENDED_FUNCTION(log)
#define PetscSinReal EXTENDED_FUNCTION(sin)
#define PetscCosReal EXTENDED_FUNCTION(cos)
#define PetscTanReal EXTENDED_FUNCTION(tan)
#define PetscAtan2Real EXTENDED_FUNCTION(atan2)
#define PetscFloorReal EXTENDED_FUNCTION(floor)
#define PetscExpReal EXTENDED_FUNCTION(exp)
#define cbrt EXTENDED_FUNCTION(cbrt)
#define expm1 EXTENDED_FUNCTION(expm1)
#define hypot EXTENDED_FUNCTION(hypot)
#define PETSC_PI EXTENDED_PI
#define PETSC_MACHINE_EPSILON EXTENDED_EPSILON
#define LAM_NO_CLONES
#include "extended_names.h"

/* it takes a response in double precision */
#include <lamella/ellipticity.h>
#define LamResponseFindBand(response) ((void)(response))

#include "../../src/core/lattice.c"
#include "../../src/core/tissue.c"
#include "../../rve/cells/outline.c"
#include "../../rve/cells/mesh.c"
#include "../../rve/wall/element.c"
#include "../../rve/wall/element_history.c"
#include "../../rve/wall/element_fields.c"
#include "../../rve/wall/wall_law.c"
#include "../../rve/wall/matrix_mooney_rivlin.c"
#include "../../rve/wall/fibre_quadratic.c"
#include "../../rve/wall/fibre_exponential.c"
#include "../../rve/assembly/turgor.c"
#include "../../rve/assembly/assembly.c"
#include "../../rve/contact/gap_area.c"
#include "../../rve/contact/mortar.c"
#include "../../rve/contact/mortar_segments.c"
#include "../../rve/assembly/contact.c"
#include "../../rve/contact/smooth.c"
#include "../../rve/contact/touching.c"
#include "../../rve/assembly/smooth_contact.c"
#include "../../rve/linear/linear.c"
#include "../../rve/measure/homogenise.c"

#define NEWTON_ITERATIONS 60
#define REFINEMENTS 60
#define PATIENCE 4
#define STAGNATION 0.5 /* a step that leaves more than this share of the residual has reached rounding */

/* The tissue under way, and its double-precision factor: one at a time. */
static struct LamRVE_s *tissue;
static const ExtendedStart *started;

PetscErrorCode LamFactorCreate(MPI_Comm comm, PetscInt n, PetscInt row[], PetscInt column[], PetscReal values[],
                               PetscInt positions, LamFactor *factor)
{
  *factor = NULL;
  return 0;
}
PetscErrorCode LamFactorNumeric(LamFactor factor, PetscInt *negative, PetscBool *ok)
{
  *negative = 0;
  *ok = PETSC_TRUE;
  return 0;
}
PetscErrorCode LamFactorDestroy(LamFactor *factor)
{
  *factor = NULL;
  return 0;
}

/* solution += factor (double-precision inverse) rhs, scaled so that small right-hand sides do not get lost. */
static PetscErrorCode AddRoughSolution(PetscInt n, const PetscReal rhs[], PetscReal solution[])
{
  const PetscReal scale = LamLargestEntry(n, rhs);
  double *b, *x;

  PetscFunctionBeginUser;
  if (!(scale > 0)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n, &b, n, &x));
  for (PetscInt i = 0; i < n; ++i) b[i] = (double)(rhs[i] / scale);
  PetscCall((PetscErrorCode)started->solve(started->ctx, b, x));
  for (PetscInt i = 0; i < n; ++i) solution[i] += scale * x[i];
  PetscCall(PetscFree2(b, x));
  PetscFunctionReturn(0);
}

/* rest := rhs - K x. */
static void FindRestOf(PetscInt n, const PetscReal rhs[], const PetscReal x[], PetscReal rest[])
{
  LamLinearMultiply(tissue->linear, x, rest);
  for (PetscInt i = 0; i < n; ++i) rest[i] = rhs[i] - rest[i];
}

/* Iterative refinement, x += (double-precision inverse) rest. Of soft modes that inverse knows few digits where walls
   are stiff, so that the rest may grow before it falls: it ends once PATIENCE refinements bring nothing. */
static PetscErrorCode SolveExtended(PetscInt n, const PetscReal rhs[], PetscReal x[])
{
  PetscReal *rest, *best, least = -1;
  PetscInt since = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &rest, n, &best));
  for (PetscInt it = 0; it < REFINEMENTS && since < PATIENCE; ++it) {
    PetscReal left;

    FindRestOf(n, rhs, x, rest);
    left = LamLargestEntry(n, rest);
    since = least < 0 || left < least ? 0 : since + 1;
    if (since == 0) {
      least = left;
      PetscCall(PetscArraycpy(best, x, n));
    }
    PetscCall(AddRoughSolution(n, rest, x));
  }
  PetscCall(PetscArraycpy(x, best, n));
  PetscCall(PetscFree2(rest, best));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorSolve(LamFactor factor, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  const PetscInt n = tissue->linear->n;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(solution, count * n));
  for (PetscInt k = 0; k < count; ++k) PetscCall(SolveExtended(n, rhs + k * n, solution + k * n));
  PetscFunctionReturn(0);
}

_Static_assert(LAM_WALL_PARAMETER_COUNT <= EXTENDED_PARAMETERS, "room for all parameters of a wall");
#define PARAMETER_OF_CASE(X, name, ...) .name = c->parameter[LAM_WALL_##name],

static LamMicrostructure Microstructure(const ExtendedCase *c)
{
  LamMicrostructure micro = {.wall_thickness = c->thickness,
                             .orientation = c->orientation,
                             .cells = {c->cells[0], c->cells[1]},
                             .interface = c->contact ? LAM_INTERFACE_CONTACT : LAM_INTERFACE_BONDED,
                             .clearance = c->clearance,
                             .along = c->along,
                             .through = c->through,
                             .grading = c->grading};

  micro.wall = (LamWall){.law = (LamWallLawType)c->law,
                         .fibres = (LamFibres)c->fibres,
                         LAM_WALL_PARAMETERS(PARAMETER_OF_CASE, ).bulk_modulus = c->bulk_modulus};
  return micro;
}

static PetscErrorCode Create(const ExtendedCase *c, LamRVE *out)
{
  LamRVE rve;
  LamCouplings couplings = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&rve));
  rve->linear = &rve->systems[0];
  rve->micro = Microstructure(c);
  rve->wanted = LAM_WANT_ALL;
  PetscCall(LamMeshCreate(&rve->micro, &rve->mesh));
  PetscCall(PetscMalloc1(rve->mesh.cell_count, &rve->law));
  for (PetscInt k = 0; k < rve->mesh.cell_count; ++k) PetscCall(LamWallLawGet(rve->micro.wall.law, &rve->law[k]));
  PetscCall(LamGeometryCreate(rve));
  if (c->contact) {
    PetscCall(LamContactCreate(&rve->micro, &rve->mesh, &rve->contact));
    rve->contact->exact = PETSC_TRUE;
    couplings = (LamCouplings){.count = rve->contact->face_count,
                               .size = rve->contact->chain,
                               .multipliers = rve->contact->hats,
                               .classes = rve->contact->classes};
  }
  PetscCall(LamLinearCreate(&rve->mesh, c->contact ? &couplings : NULL, 0, rve->linear));
  if (c->contact) {
    PetscCall(LamContactSetMatrix(rve->linear, rve->contact));
    LamGapAreaSetMatrix(rve->linear, &rve->contact->gaps);
  }
  rve->ndof = rve->length = 2 * rve->mesh.class_count;
  PetscCall(
      PetscCalloc4(rve->ndof, &rve->y, rve->linear->n, &rve->step, rve->ndof, &rve->trial, rve->ndof, &rve->residual));
  PetscCall(PetscMalloc2(rve->mesh.cell_count, &rve->seal.area, rve->mesh.cell_count, &rve->seal.factor));
  *out = rve;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(LamRVE rve)
{
  PetscFunctionBeginUser;
  PetscCall(LamContactDestroy(&rve->contact));
  PetscCall(LamLinearDestroy(rve->linear));
  PetscCall(LamMeshDestroy(&rve->mesh));
  PetscCall(PetscFree(rve->law));
  PetscCall(PetscFree(rve->geometry));
  PetscCall(PetscFree(rve->stress));
  PetscCall(PetscFree2(rve->seal.area, rve->seal.factor));
  PetscCall(PetscFree4(rve->y, rve->step, rve->trial, rve->residual));
  PetscCall(PetscFree(rve));
  PetscFunctionReturn(0);
}

/* The class that is held stays where it is in exact arithmetic: 0 of class_X moved by F in double precision is not. */
static void SetStart(LamRVE rve, const ExtendedStart *start)
{
  for (PetscInt i = 0; i < rve->ndof; ++i) rve->y[i] = start->y[i];
  for (PetscInt h = 0; rve->contact && h < rve->contact->count; ++h) {
    rve->contact->lambda[h] = start->lambda[h];
    rve->contact->active[h] = (PetscBool)start->active[h];
  }
  for (PetscInt f = 0; rve->contact && f < rve->contact->face_count; ++f) {
    rve->contact->faces[f].first = start->hats[f][0];
    rve->contact->faces[f].last = start->hats[f][1];
  }
}

/* Gradient [n] of positions and active gaps, and the consistent tangent. */
static PetscErrorCode Linearise(LamRVE rve, const LamLoad *load, PetscReal gradient[], PetscReal *norm)
{
  PetscReal energy;
  PetscBool valid = LamSetConsistentStresses(rve, load, rve->y);

  PetscFunctionBeginUser;
  PetscCheck(valid, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the start is inside out");
  PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
  if (rve->contact) {
    PetscCall(LamContactEvaluate(rve, load, rve->y));
    LamContactAddCurvature(rve);
    LamContactSetRows(rve);
  }
  CopyResidual(rve, gradient);
  *norm = 0;
  for (PetscInt i = 0; i < rve->linear->n; ++i) *norm += gradient[i] * gradient[i];
  *norm = PetscSqrtReal(*norm);
  PetscFunctionReturn(0);
}

/* Hats that are merged into another carry its multiplier. */
static void MoveMultipliers(LamRVE rve)
{
  LamContact *contact = rve->contact;

  for (PetscInt h = 0; contact && h < contact->count; ++h)
    if (contact->active[h]) contact->lambda[h] -= rve->step[rve->linear->positions + h];
}

/* Newton's method with the double-precision factor, until the residual falls no further. */
static PetscErrorCode Solve(LamRVE rve, const LamLoad *load, ExtendedAnswer *answer)
{
  const double *y0 = started->y;
  PetscReal norm = 0, before = -1, *gradient;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rve->linear->n, &gradient));
  for (answer->iterations = 0; answer->iterations < NEWTON_ITERATIONS; ++answer->iterations) {
    PetscCall(Linearise(rve, load, gradient, &norm));
    if (answer->iterations == 0) answer->rounding = (double)norm;
    if (norm == 0 || (before >= 0 && !(norm < STAGNATION * before))) break;
    before = norm;
    PetscCall(PetscArrayzero(rve->step, rve->linear->n));
    PetscCall(AddRoughSolution(rve->linear->n, gradient, rve->step));
    for (PetscInt i = 0; i < rve->linear->positions; ++i) rve->y[i + 2] -= rve->step[i];
    MoveMultipliers(rve);
  }
  PetscCall(PetscFree(gradient));
  answer->residual = (double)norm;
  answer->moved = 0;
  for (PetscInt i = 0; i < rve->ndof; ++i)
    answer->moved = PetscMax(answer->moved, (double)PetscAbsReal(rve->y[i] - y0[i]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(LamRVE rve, const LamLoad *load, int tangent, ExtendedAnswer *answer)
{
  LamResponse *response;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&response));
  rve->wanted = tangent ? LAM_WANT_ALL : LAM_WANT_STRESS;
  PetscCall(LamHomogenise(rve, load, response));
  for (PetscInt i = 0; i < 9; ++i) answer->P[i] = (double)response->P[i];
  for (PetscInt i = 0; i < 81; ++i) answer->tangent[i] = (double)response->tangent[i];
  answer->energy = (double)response->energy;
  answer->lumen = (double)response->lumen_fraction;
  answer->opening = (double)response->opening_fraction;
  PetscCall(PetscFree(response));
  PetscFunctionReturn(0);
}

int EXTENDED_SOLVE(const ExtendedCase *c, const ExtendedStart *start, int tangent, ExtendedAnswer *answer)
{
  LamLoad load = {.turgor = c->turgor, .cohesion = c->cohesion};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 9; ++i) load.F[i] = c->F[i];
  PetscCall(Create(c, &tissue));
  started = start;
  SetStart(tissue, start);
  PetscCall(Solve(tissue, &load, answer));
  PetscCall(Measure(tissue, &load, tangent, answer));
  PetscCall(Destroy(tissue));
  PetscFunctionReturn(0);
}
