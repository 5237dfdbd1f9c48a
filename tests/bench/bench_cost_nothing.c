/*
  What features cost that a scene leaves off: states of tissue without them against the same problem in which they do
  not exist, a Newton iteration on wall elements alone, and against tissue that has them. Prints figures.

  The two of a comparison take turns in one process; processor time, medians, and the quartiles of the ratios of pairs.
  Bytes are those that malloc has given for an RVE with its matrix, factor and state.
*/
#include <malloc.h>
#include <stdio.h>
#include <string.h>
#include "support/bare_tissue.h"
#include "support/contact_tissue.h"
#include "measure.h"

#define PAIRS 60
#define LEAST_SECONDS 0.02 /* of a sample: as many states as take so long */

/* One of the two problems of a comparison. */
typedef struct {
  const char *name;
  LamMicrostructure micro;
  LamLoad load;
  LamWanted wanted;
  PetscBool bare, sealable, out_of_plane;
} Problem;

typedef struct {
  Problem problem;
  LamRVE rve;
  LamRVEState state;
  LamResponse response;
  long long bytes;
  double seconds[PAIRS]; /* of a state */
} Runner;

static long long BytesInUse(void)
{
  const struct mallinfo2 info = mallinfo2();

  return (long long)(info.uordblks + info.hblkhd);
}

static PetscErrorCode Solve(Runner *r)
{
  PetscFunctionBeginUser;
  if (r->problem.bare) {
    PetscCall(BareSolve(r->rve, &r->problem.load, &r->response));
  } else {
    PetscCall(LamRVEStateReset(r->rve, r->state));
    PetscCall(LamRVESolve(r->rve, &r->problem.load, r->state, &r->response));
  }
  PetscCheck(r->response.status == LAM_CONVERGED, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "%s: %s", r->problem.name,
             r->response.reason);
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(Runner *r)
{
  const Problem *p = &r->problem;

  PetscFunctionBeginUser;
  r->state = NULL;
  if (p->bare) {
    PetscCall(BareCreate(&p->micro, &r->rve));
  } else {
    PetscCall(LamRVECreate(PETSC_COMM_SELF, &r->rve));
    PetscCall(LamRVESetMicrostructure(r->rve, &p->micro));
    PetscCall(LamRVESetSealable(r->rve, p->sealable));
    PetscCall(LamRVESetOutOfPlane(r->rve, p->out_of_plane));
    PetscCall(LamRVESetWanted(r->rve, p->wanted));
    PetscCall(LamRVESetUp(r->rve));
    PetscCall(LamRVEStateCreate(r->rve, &r->state));
  }
  PetscCall(Solve(r));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Runner *r)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&r->state));
  if (r->problem.bare)
    PetscCall(BareDestroy(&r->rve));
  else
    PetscCall(LamRVEDestroy(&r->rve));
  PetscFunctionReturn(0);
}

/* The first RVE of a process leaves what libraries keep: a second one is counted. */
static PetscErrorCode CountBytes(Runner *r)
{
  long long before;

  PetscFunctionBeginUser;
  PetscCall(Create(r));
  PetscCall(Destroy(r));
  before = BytesInUse();
  PetscCall(Create(r));
  r->bytes = BytesInUse() - before;
  PetscCall(Destroy(r));
  PetscFunctionReturn(0);
}

static PetscErrorCode Sample(Runner *r, PetscInt states, double *seconds)
{
  const double begin = ProcessorSeconds();

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < states; k++) PetscCall(Solve(r));
  *seconds = (ProcessorSeconds() - begin) / (double)states;
  PetscFunctionReturn(0);
}

static void PrintProblem(const Runner *r)
{
  printf("  %-42s %8d %9d %10lld %5d %5d", r->problem.name, (int)r->rve->linear->n, (int)r->rve->linear->nonzeros,
         r->bytes, (int)r->response.newton_iterations, (int)r->response.factorisations);
}

/* a: without the feature, or with it left off; b: what it is held against. */
static PetscErrorCode Compare(const char feature[], const Problem *a, const Problem *b)
{
  Runner r[2] = {{.problem = *a}, {.problem = *b}};
  double ratio[PAIRS], once = 1;
  PetscInt states;

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(CountBytes(&r[k]));
  for (int k = 0; k < 2; k++) PetscCall(Create(&r[k]));
  PetscCall(Sample(&r[1], 3, &once));
  states = (PetscInt)(LEAST_SECONDS / once) + 1;
  for (int n = 0; n < PAIRS; n++) {
    for (int k = 0; k < 2; k++) {
      const int which = (n + k) % 2; /* who comes first changes */

      PetscCall(Sample(&r[which], states, &r[which].seconds[n]));
    }
    ratio[n] = r[0].seconds[n] / r[1].seconds[n];
  }
  printf("%s\n", feature);
  for (int k = 0; k < 2; k++) {
    PrintProblem(&r[k]);
    printf(" %8.3f", 1e3 * Quantile(r[k].seconds, PAIRS, 0.5));
    if (k == 0)
      printf(" %9.3f  %.3f to %.3f", Quantile(ratio, PAIRS, 0.5), Quantile(ratio, PAIRS, 0.25),
             Quantile(ratio, PAIRS, 0.75));
    putchar('\n');
  }
  for (int k = 0; k < 2; k++) PetscCall(Destroy(&r[k]));
  PetscFunctionReturn(0);
}

static Problem NewProblem(const char name[], const LamMicrostructure *micro, const LamLoad *load)
{
  return (Problem){.name = name, .micro = *micro, .load = *load, .wanted = LAM_WANT_ALL};
}

#define SHEAR 0.1
#define NEXT_TO_NOTHING 1e-200 /* a feature that is there and changes no digit */

static PetscErrorCode CompareBonded(PetscInt along, PetscInt through)
{
  LamMicrostructure micro = ContactTissue(along, through);
  LamCell cell;
  LamLoad dry = PlaneLoad(1, SHEAR, 0, 1, 0), turgid = PlaneLoad(1, SHEAR, 0, 1, 0.02 / TISSUE_STRESS);
  Problem off, other;

  PetscFunctionBeginUser;
  micro.interface = LAM_INTERFACE_BONDED;
  cell = (LamCell){.wall_thickness = micro.wall_thickness, .wall = micro.wall, .turgor = 1, .cohesion = 1};
  printf("\none bonded cell, %d x %d elements in a wall\n", (int)along, (int)through);

  off = NewProblem("stress alone asked", &micro, &dry);
  off.wanted = LAM_WANT_STRESS;
  other = NewProblem("walls alone", &micro, &dry);
  other.bare = PETSC_TRUE;
  PetscCall(Compare("all features", &off, &other));

  off = NewProblem("not asked", &micro, &dry);
  off.wanted = LAM_WANT_ALL & ~LAM_WANT_DERIVATIVES;
  other = NewProblem("asked", &micro, &dry);
  PetscCall(Compare("tangent and couplings", &off, &other));

  off = NewProblem("not asked", &micro, &dry);
  off.wanted = LAM_WANT_ALL & ~LAM_WANT_INDICATORS;
  PetscCall(Compare("indicators", &off, &other));

  off = NewProblem("not asked", &micro, &dry);
  off.wanted = LAM_WANT_ALL & ~LAM_WANT_WALLS;
  PetscCall(Compare("strengths: measures of the walls", &off, &other));

  off = NewProblem("turgor 0", &micro, &dry);
  other = NewProblem("turgor 1e-200", &micro, &dry);
  other.load.turgor = NEXT_TO_NOTHING;
  PetscCall(Compare("turgor", &off, &other));

  off = NewProblem("no memory", &micro, &dry);
  other = NewProblem("with memory, at once", &micro, &dry);
  other.micro.relaxation = (LamRelaxation){.terms = 1, .share = {0.5}, .time = {1}};
  PetscCall(Compare("memory of the walls", &off, &other));

  off = NewProblem("tangent in the plane", &micro, &dry);
  other = NewProblem("whole tangent", &micro, &dry);
  other.out_of_plane = PETSC_TRUE;
  PetscCall(Compare("tangent out of the plane", &off, &other));

  off = NewProblem("pressures prescribed", &micro, &turgid);
  other = NewProblem("room for pressures that are unknown", &micro, &turgid);
  other.sealable = PETSC_TRUE;
  PetscCall(Compare("sealed cells", &off, &other));

  off = NewProblem("no list of cells", &micro, &turgid);
  other = NewProblem("a list of equal cells", &micro, &turgid);
  other.micro.cell = &cell;
  PetscCall(Compare("differing cells", &off, &other));

  off = NewProblem("one", &micro, &turgid);
  other = NewProblem("2 x 1 cells", &micro, &turgid);
  other.micro.cells[0] = 2;
  PetscCall(Compare("many cells", &off, &other));

  off = NewProblem("bonded", &micro, &turgid);
  other = NewProblem("contact, pressed together", &micro, &turgid);
  other.micro.interface = LAM_INTERFACE_CONTACT;
  PetscCall(Compare("contact", &off, &other));
  PetscFunctionReturn(0);
}

static PetscErrorCode CompareContact(PetscInt along, PetscInt through)
{
  const LamMicrostructure micro = ContactTissue(along, through);
  const LamLoad load = ContactLoad(1, SHEAR, 0, 1, 0.02, 0);
  Problem off = NewProblem("cohesion 0", &micro, &load), other = NewProblem("cohesion 1e-200", &micro, &load);

  PetscFunctionBeginUser;
  printf("\none cell in contact, %d x %d elements in a wall\n", (int)along, (int)through);
  other.load.cohesion = NEXT_TO_NOTHING;
  PetscCall(Compare("cohesion", &off, &other));

  off.name = "stress alone asked";
  off.wanted = LAM_WANT_STRESS;
  other = NewProblem("all asked", &micro, &load);
  PetscCall(Compare("tangent and couplings, indicators, strengths", &off, &other));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  printf("simple shear %g from F = I; medians of %d, processor time; ratio: first to second, quartiles of the pairs\n",
         SHEAR, PAIRS);
  printf("  %-42s %8s %9s %10s %5s %5s %8s %9s\n", "", "unknowns", "nonzeros", "bytes", "iter.", "fact.", "ms",
         "ratio");
  for (PetscInt k = 1; k <= 2; k++)
    if (CompareBonded(6 * k, 2 * k)) return 1;
  if (CompareContact(6, 2)) return 1;
  return PetscFinalize() ? 1 : 0;
}
