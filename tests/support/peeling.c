#include "peeling.h"

#define PEEL_ENERGY 2e-6 /* G */
#define PEEL_BULK 10.0   /* of the walls: not so large that rounding of positions enters the forces */
#define PEEL_GROWTH 1.8  /* of rows away from the lamella */
#define PEEL_CONTACT 1e3 /* stiffness of pressed faces, E' over the height */
#define PEEL_ROOT 0.7  /* by which beams are longer than the crack because their roots turn, heights: for steps only */
#define PEEL_START 0.5 /* of the beams: the first step */
#define PEEL_COARSE 0.02 /* of it, until PEEL_SMALL of the energy of a zone is spent: steps */
#define PEEL_SMALL 0.1
#define PEEL_BEFORE 1.5 /* zones that the crack runs before it is measured */
#define PEEL_AHEAD 2.0  /* longest of zone and height, that many times stay joined */
#define PEEL_INERTIA (1.0 / 12.0)
#define PEEL_ROWS_MAX 12

int PeelPrints;

typedef struct {
  const PeelSetup *setup;
  PetscReal modulus, length; /* E'; of an element */
  PetscInt free, columns, rows;
  PetscReal height[2 * PEEL_ROWS_MAX + 1]; /* [2 rows + 1] of the upper strip's nodes */
  PetscReal below;                         /* -1 for the lower strip, 1 */
  PetscInt first[2];                       /* nodes of the lower strip and of the upper one */
  PetscReal expected;                      /* load by the beams' formula */
  Blocks blocks;
  Torn torn;
} Peeling;

PeelSetup PeelDefault(PeelLoading loading)
{
  return (PeelSetup){.loading = loading,
                     .zone = 1.0,
                     .element = 1.0 / 3.0,
                     .onset = 0.05,
                     .arm = 2.0,
                     .points = LAM_EDGE_POINTS,
                     .steps = 10,
                     .advance = 4.0};
}

static void PeelSize(const PeelSetup *setup, Peeling *p)
{
  const PetscReal longest = PetscMax(setup->zone, 1.0);
  PetscReal row = p->length = setup->zone * setup->element, at = 0.0;
  const PetscReal running = PEEL_BEFORE * setup->zone + PetscMax(setup->advance * p->length, setup->zone);

  p->free = (PetscInt)PetscCeilReal(setup->arm * longest / p->length - 1e-9);
  p->columns = p->free + (PetscInt)PetscCeilReal((running + PEEL_AHEAD * longest) / p->length);
  for (p->rows = 0; p->rows < PEEL_ROWS_MAX && (p->rows < 2 || at < 1.0); ++p->rows, row *= PEEL_GROWTH) {
    p->height[2 * p->rows + 1] = at + 0.5 * row;
    at = p->height[2 * p->rows + 2] = at + row;
  }
  for (PetscInt j = 0; j <= 2 * p->rows; ++j) p->height[j] /= at;
}

static void PeelPlace(void *ctx, PetscInt i, PetscInt j, PetscReal X[2])
{
  const Peeling *p = (const Peeling *)ctx;

  X[0] = 0.5 * i * p->length;
  X[1] = p->below < 0.0 ? -p->height[2 * p->rows - j] : p->height[j];
}

static PetscInt PeelNode(const Peeling *p, PetscInt strip, PetscInt i, PetscInt j)
{
  return p->first[strip] + j * (2 * p->columns + 1) + i;
}

/* The loads at the left ends: tractions that are linear over the height, by Simpson's rule, or forces. */
static void PeelLoad(Peeling *p)
{
  for (PetscInt strip = 0; strip < 2; ++strip) {
    const PetscReal side = strip == 0 && p->setup->loading != PEEL_SLIDING ? -1.0 : 1.0;

    if (p->setup->loading == PEEL_CANTILEVER) {
      p->torn.load[PeelNode(p, strip, 0, p->rows)][1] = side;
      continue;
    }
    for (PetscInt r = 0; r < p->rows; ++r)
      for (PetscInt k = 0; k < 3; ++k) {
        const PetscInt node = PeelNode(p, strip, 0, 2 * r + k), end = PeelNode(p, strip, 0, 2 * r);
        const PetscReal row = p->blocks.X[end + 2 * (2 * p->columns + 1)][1] - p->blocks.X[end][1];
        const PetscReal lever = p->blocks.X[node][1] - (strip == 0 ? -0.5 : 0.5);

        p->torn.load[node][0] += side * row * (k == 1 ? 4.0 : 1.0) / 6.0 * lever / PEEL_INERTIA;
      }
  }
}

static void PeelJoin(Peeling *p)
{
  const PeelSetup *setup = p->setup;
  const PetscReal l = setup->zone, strength = PetscSqrtReal(p->modulus * PEEL_ENERGY / (l > 1.0 ? l * l * l * l : l));

  p->torn.law = (LamCohesive){.softening = setup->softening,
                              .stiffness = strength / (setup->onset * 2.0 * PEEL_ENERGY / strength),
                              .strength = strength,
                              .beta = 1.0,
                              .energy = {PEEL_ENERGY, PEEL_ENERGY},
                              .mixing = 1.0};
  p->torn.contact = PEEL_CONTACT * p->modulus;
  for (PetscInt e = 0; e < p->torn.edges; ++e) {
    p->torn.length[e] = p->length;
    for (PetscInt k = 0; k < 3; ++k) {
      p->torn.edge[e][k] = PeelNode(p, 1, 2 * (p->free + e) + k, 0);
      p->torn.edge[e][3 + k] = PeelNode(p, 0, 2 * (p->free + e) + k, 2 * p->rows);
    }
  }
}

static PetscErrorCode PeelCreate(const PeelSetup *setup, Peeling *p)
{
  TornRule rule;
  PetscInt nodes;

  PetscFunctionBeginUser;
  *p = (Peeling){.setup = setup};
  PeelSize(setup, p);
  nodes = (2 * p->columns + 1) * (2 * p->rows + 1);
  PetscCall(BlocksCreate(2 * nodes, 2 * p->columns * p->rows, 1, 1, &p->blocks));
  p->blocks.wall.bulk_modulus = PEEL_BULK;
  p->modulus = BlocksPlaneStrainModulus(&p->blocks.wall);
  for (PetscInt strip = 0; strip < 2; ++strip) {
    p->below = strip == 0 ? -1.0 : 1.0;
    PetscCall(BlocksAddGrid(&p->blocks, p->columns, p->rows, PeelPlace, p, &p->first[strip]));
  }
  for (PetscInt a = 0; a < 2 * nodes; ++a)
    p->blocks.held[a][0] = p->blocks.held[a][1] = (PetscBool)(a % (2 * p->columns + 1) == 2 * p->columns);
  TornGauss(setup->points, &rule);
  PetscCall(TornCreate(&p->blocks, p->columns - p->free, &rule, &p->torn));
  PeelLoad(p);
  PeelJoin(p);
  PetscFunctionReturn(0);
}

static PetscErrorCode PeelDestroy(Peeling *p)
{
  PetscFunctionBeginUser;
  PetscCall(TornDestroy(&p->torn));
  PetscCall(BlocksDestroy(&p->blocks));
  PetscFunctionReturn(0);
}

/* Energy release rate of the beams under a load, and target. */
static PetscReal PeelRate(const Peeling *p, PetscReal load, PetscReal target)
{
  const PetscReal EI = p->modulus * PEEL_INERTIA;

  if (p->setup->loading == PEEL_CANTILEVER) load *= PetscPowReal(1.5 * EI * target / load, 1.0 / 3.0);
  return (p->setup->loading == PEEL_SLIDING ? 0.75 : 1.0) * load * load / EI;
}

/* Load of the beams, and target, with a crack of length a; *along: derivative of the target with respect to a. */
static PetscReal PeelBeams(const Peeling *p, PetscReal a, PetscReal *target, PetscReal *along)
{
  const PetscReal EI = p->modulus * PEEL_INERTIA, M = PetscSqrtReal(PEEL_ENERGY * EI);
  const PetscReal whole = p->columns * p->length;

  switch (p->setup->loading) {
  case PEEL_OPENING:
    *along = 2.0 * M / EI;
    *target = *along * a;
    return M;
  case PEEL_SLIDING:
    *along = 0.75 * M / EI * PetscSqrtReal(4.0 / 3.0);
    *target = *along * a + 0.25 * M / EI * PetscSqrtReal(4.0 / 3.0) * whole;
    return M * PetscSqrtReal(4.0 / 3.0);
  default:
    *target = 2.0 * M * a * a / (3.0 * EI);
    *along = 4.0 * M * a / (3.0 * EI);
    return M / a;
  }
}

/* Where the opening is that at which nothing holds: from the left end, by interpolation between points. */
static PetscReal PeelFront(const Peeling *p, PetscReal *deepest, PetscReal *widest)
{
  const LamEnvelope envelope = LamEnvelopeOf(&p->torn.law, 0.0);
  PetscReal before = 0.0, at = 0.0, front = p->free * p->length;

  *deepest = *widest = 0.0;
  for (PetscInt e = 0; e < p->torn.edges; ++e)
    for (PetscInt q = 0; q < p->torn.rule.count; ++q) {
      const LamJump jump = TornJump(&p->torn, e, q);
      const PetscReal here = p->length * (p->free + e + p->torn.rule.place[q]), delta = PetscSqrtReal(jump.q);

      *deepest = PetscMax(*deepest, -jump.normal);
      *widest = PetscMax(*widest, delta);
      if (before >= envelope.range && delta < envelope.range)
        front = at + (here - at) * (before - envelope.range) / (before - delta);
      before = delta;
      at = here;
    }
  return front;
}

/* Sums while the crack is measured; loads in those of the beams. */
typedef struct {
  PetscInt steps;
  PetscReal least, most, load, rate, work, spent, stored[2], front[2];
} PeelSums;

static void PeelAdd(const Peeling *p, const TornStep *step, PeelSums *sums, PeelResult *result)
{
  const PetscReal rate = PeelRate(p, step->lambda, step->target) / PEEL_ENERGY, load = PetscSqrtReal(rate);
  const PetscInt first = sums->steps++ == 0;
  PetscReal deepest, widest;

  sums->front[1] = PeelFront(p, &deepest, &widest);
  sums->stored[1] = step->walls + step->stored;
  if (first) {
    *sums = (PeelSums){.steps = 1, .least = load, .most = load, .stored = {sums->stored[1]}, .front = {sums->front[1]}};
    return;
  }
  sums->least = PetscMin(sums->least, load);
  sums->most = PetscMax(sums->most, load);
  sums->load += load;
  sums->rate += rate;
  sums->work += step->work;
  sums->spent += step->spent;
  result->pressed = PetscMax(result->pressed, deepest / widest);
}

static void PeelConclude(const Peeling *p, const PeelSums *sums, PeelResult *result)
{
  const PetscReal mean = sums->load / (sums->steps - 1), given = sums->work - (sums->stored[1] - sums->stored[0]);

  result->ripple = PetscMax(sums->most - mean, mean - sums->least) / mean;
  result->applied = sums->rate / (sums->steps - 1);
  result->released = given / sums->spent - 1.0;
  result->by_length = given / ((sums->front[1] - sums->front[0]) * PEEL_ENERGY);
  result->elements = p->blocks.element_count;
}

/* The next target, when as much has been spent: of small steps once the lamella breaks. */
static PetscReal PeelNext(const Peeling *p, PetscReal spent, PetscReal target)
{
  const PetscReal a = p->free * p->length + spent / PEEL_ENERGY + PEEL_ROOT;
  PetscReal start, along;

  (void)PeelBeams(p, a, &start, &along);
  if (target == 0.0) return PEEL_START * start;
  if (spent < PEEL_SMALL * PEEL_ENERGY * p->setup->zone) return target + PEEL_COARSE * start;
  return target + along * p->length / p->setup->steps;
}

PetscErrorCode Peel(const PeelSetup *setup, PeelResult *result)
{
  PetscReal target = 0.0, spent = 0.0, begin, end;
  PeelSums sums = {0};
  Peeling p;

  PetscFunctionBeginUser;
  *result = (PeelResult){0};
  PetscCall(PeelCreate(setup, &p));
  begin = PEEL_ENERGY * PEEL_BEFORE * setup->zone;
  end = begin + PEEL_ENERGY * PetscMax(setup->advance * p.length, setup->zone);
  for (; spent < end; ++result->steps) {
    TornStep step;

    target = PeelNext(&p, spent, target);
    PetscCall(TornPull(&p.torn, target, &step));
    target = step.target;
    spent += step.spent;
    result->iterations += step.iterations;
    if (PeelPrints)
      printf("%4d %.8g load %.6f spent %.4f (%d)\n", (int)result->steps, target,
             PeelRate(&p, step.lambda, target) / PEEL_ENERGY, spent / (PEEL_ENERGY * p.length), (int)step.iterations);
    if (spent >= begin) PeelAdd(&p, &step, &sums, result);
  }
  PeelConclude(&p, &sums, result);
  PetscCall(PeelDestroy(&p));
  PetscFunctionReturn(0);
}
