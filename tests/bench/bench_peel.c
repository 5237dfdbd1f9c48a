/*
  Peeling of two strips against beams (support/peeling.h): how the mesh, and the number of Gauss points on an edge,
  enter force and energy; prints figures, asserts nothing (docs/theory/lamella.md, Points).

    bench_peel [--loading opening|sliding|cantilever] [--softening bilinear|exponential] [--zone PERCENT] [--onset
  PERCENT]
               [--arm N]
               [--points N] [--coarsest N]
      --zone      process zone in hundredths of a strip's height; without it 50, 100 and 200
      --onset     opening at the strength in hundredths of that at which nothing holds; 5
      --arm       length of the free ends, longest of zone and height; 3
      --points    of an edge; without it 3, 5 and 8
      --coarsest  only the N coarsest meshes

  element: in process zones. ripple: largest deviation of the load from its mean. G: that of the mean load, by the
  formula of beams, over the law's. released: energy lost in jumps, over what was dissipated. by length: work less what
  is stored per length of crack, over G. Per cent, those over G less 100 %.
*/
#include <stdio.h>
#include <lamella/cohesive.h>
#include "measure.h"
#include "options.h"
#include "support/peeling.h"

#define STEPS 16  /* per element */
#define ADVANCE 6 /* elements, or a zone if that is more */
#define MESHES 7
static const double elements[MESHES] = {2.0, 1.0, 2.0 / 3.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 6.0};
static const int zones[] = {50, 100, 200}, points[] = {3, 5, 8};

static PetscErrorCode Mesh(PeelSetup setup)
{
  const double start = ProcessorSeconds();
  PeelResult r;

  PetscFunctionBeginUser;
  PetscCall(Peel(&setup, &r));
  printf("%5.2f %8.3f %6d %8.2f %8.2f %9.2f %9.2f %6d %9.1f %6.1f\n", setup.zone, setup.element, (int)setup.points,
         100.0 * r.ripple, 100.0 * (r.applied - 1.0), 100.0 * r.released, 100.0 * (r.by_length - 1.0), (int)r.elements,
         (double)r.iterations / r.steps, ProcessorSeconds() - start);
  fflush(stdout);
  PetscFunctionReturn(0);
}

static PetscErrorCode Table(PeelSetup setup, int meshes, int only_points)
{
  PetscFunctionBeginUser;
  for (int m = 0; m < meshes; m++)
    for (int k = 0; k < (only_points ? 1 : 3); k++) {
      setup.element = elements[m];
      setup.points = only_points ? only_points : points[k];
      PetscCall(Mesh(setup));
    }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  static const char *const loadings[] = {"opening", "sliding", "cantilever", "", NULL};
  PeelSetup setup;
  int loading, zone, only_points, meshes;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  loading = ChoiceOption("--loading", loadings, 3);
  setup = PeelDefault(loading == 3 ? PEEL_OPENING : (PeelLoading)loading);
  setup.softening =
      (LamSoftening)(ChoiceOption("--softening", LamSofteningNames, LAM_SOFTENING_COUNT) % LAM_SOFTENING_COUNT);
  setup.onset = 0.01 * NumberOption("--onset", 5, 1, 90);
  setup.arm = NumberOption("--arm", 3, 1, 100);
  setup.steps = STEPS;
  setup.advance = ADVANCE;
  zone = NumberOption("--zone", 0, 0, 1000);
  only_points = NumberOption("--points", 0, 0, TORN_POINTS);
  meshes = NumberOption("--coarsest", MESHES, 1, MESHES);
  printf(" zone  element points  ripple        G  released by length elements  iter.  time, s\n");
  for (int z = 0; z < (zone ? 1 : 3); z++) {
    setup.zone = 0.01 * (zone ? zone : zones[z]);
    if (Table(setup, meshes, only_points)) return 1;
  }
  return EndBench();
}
