/* A solve that is interrupted, wherever that is, is given up and leaves nothing behind. */
#include "support/rve_fixture.h"
#include "support/mixed_control.h"
#include <string.h>

#define LIMIT 12      /* calls that are tried one by one; of more, every so many */
#define UNDISTURBED 6 /* after so many stopped solves one is not */

typedef struct {
  LamRVE rve;
  LamRVEState start, state;
  LamLoad load;
  LamStressControl control;
  PetscInt calls, stop_at; /* of the interrupt: asked so far, and which says to stop */
} Case;

static PetscBool CountAndStop(void *ctx)
{
  Case *c = (Case *)ctx;

  return (PetscBool)(++c->calls == c->stop_at);
}

static LamMicrostructure CoarseTissue(LamMicrostructure micro)
{
  micro.along = 2;
  micro.through = 1;
  return micro;
}

static Case NewCase(const LamMicrostructure *micro, LamLoad load)
{
  Case c = {.rve = NewRVE(micro), .load = load};

  assert_int_equal(LamRVEStateCreate(c.rve, &c.start), 0);
  assert_int_equal(LamRVEStateCreate(c.rve, &c.state), 0);
  return c;
}

static void Destroy(Case *c)
{
  assert_int_equal(LamRVEStateDestroy(&c->start), 0);
  assert_int_equal(LamRVEStateDestroy(&c->state), 0);
  assert_int_equal(LamRVEDestroy(&c->rve), 0);
}

/* From the case's start; stop_at 0: undisturbed. */
static LamResponse SolveCase(Case *c, PetscInt stop_at)
{
  LamResponse response;

  c->calls = 0;
  c->stop_at = stop_at;
  assert_int_equal(LamRVEStateCopy(c->start, c->state), 0);
  assert_int_equal(LamRVESetInterrupt(c->rve, CountAndStop, c), 0);
  assert_int_equal(LamRVESolveMixed(c->rve, &c->load, &c->control, c->state, &response), 0);
  return response;
}

static PetscBool SameStates(LamRVEState a, LamRVEState b)
{
  size_t size, other;
  char *x, *y;
  PetscBool same;

  assert_int_equal(LamRVEStateSize(a, &size), 0);
  assert_int_equal(LamRVEStateSize(b, &other), 0);
  assert_int_equal(size, other);
  x = test_malloc(size);
  y = test_malloc(size);
  assert_int_equal(LamRVEStatePack(a, x), 0);
  assert_int_equal(LamRVEStatePack(b, y), 0);
  same = (PetscBool)!memcmp(x, y, size);
  test_free(x);
  test_free(y);
  return same;
}

/* All but the time. Bytes, so that NaN equals itself. */
static void AssertSame(LamResponse a, LamResponse b)
{
  a.seconds = b.seconds;
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const size_t size = m->type == LAM_MEMBER_REAL ? sizeof(PetscReal) * (size_t)m->count : sizeof(PetscInt);

    if (m->type == LAM_MEMBER_REAL || m->type == LAM_MEMBER_INT)
      if (memcmp((const char *)&a + m->offset, (const char *)&b + m->offset, size)) fail_msg("%s differs", m->name);
  }
  assert_int_equal(a.status, b.status);
  assert_string_equal(a.reason, b.reason);
}

static void StopEverywhere(Case *c)
{
  LamResponse fresh = SolveCase(c, 0);
  const PetscInt calls = c->calls, stride = PetscMax(1, calls / LIMIT);

  assert_true(calls >= 3);
  assert_int_equal(calls, fresh.factorisations);
  for (PetscInt k = 1; k <= calls; k += stride) {
    const LamResponse stopped = SolveCase(c, k);

    if (stopped.status != LAM_OUT_OF_REACH) fail_msg("stopped at %d of %d: %s", (int)k, (int)calls, stopped.reason);
    assert_int_equal(c->calls, k); /* it is given up at once */
    assert_string_equal(stopped.reason, "stopped before it was solved");
    if (!SameStates(c->start, c->state)) fail_msg("stopped at %d of %d: the state has changed", (int)k, (int)calls);
    if (k / stride % UNDISTURBED == 0) AssertSame(SolveCase(c, 0), fresh);
  }
  AssertSame(SolveCase(c, 0), fresh);
}

TEST(StopsBonded)
{
  const LamMicrostructure micro = DefaultTissue();
  OWNED(Case, Destroy) c = NewCase(&micro, PlaneLoad(1.1, 0.3, 0, 1, 0.1));

  StopEverywhere(&c);
}

/* Biaxial compression leaves a saddle: safe tier, softest mode. */
TEST(StopsBuckling)
{
  const LamMicrostructure micro = CoarseTissue(DefaultTissue());
  OWNED(Case, Destroy) c = NewCase(&micro, PlaneLoad(0.9, 0, 0, 0.9, 0));

  assert_true(SolveCase(&c, 0).branch > 0);
  StopEverywhere(&c);
}

TEST(StopsContact)
{
  const LamMicrostructure micro = ContactTissue(6, 2);
  LamLoad load = PlaneLoad(1.05, 0.2, 0, 1, 0.02 / TISSUE_STRESS);
  OWNED(Case, Destroy) c;

  load.cohesion = 0.005 / TISSUE_STRESS;
  c = NewCase(&micro, load);
  StopEverywhere(&c);
  assert_int_equal(LamRVEStateCopy(c.state, c.start), 0);
  c.load.F[1] += 0.02; /* from a state nearby */
  StopEverywhere(&c);
}

/* Contact that compression makes buckle, and that is hard to find. */
TEST(StopsContactBuckling)
{
  const LamMicrostructure micro = CoarseTissue(ContactTissue(6, 2));
  OWNED(Case, Destroy) c = NewCase(&micro, PlaneLoad(0.9, 0, 0, 0.9, 0.02 / TISSUE_STRESS));

  StopEverywhere(&c);
}

static void StopMixed(const LamMicrostructure *micro, MixedCase mixed)
{
  static const double undeformed[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  OWNED(Case, Destroy) c = NewCase(micro, PlaneLoad(1, 0, 0, 1, 0));

  MixedLoad(&mixed, undeformed, &c.load, &c.control);
  StopEverywhere(&c);
}

TEST(StopsMixed)
{
  const LamMicrostructure bonded = DefaultTissue(), contact = ContactTissue(6, 2);

  StopMixed(&bonded, (MixedCase){.turgor = 0.02, .F = {FREE, 0.3, 0, FREE}, .F33 = 1});
  StopMixed(&contact, (MixedCase){.turgor = 0.02, .cohesion = 0.02, .F = {FREE, FREE, 0, 1.02}, .F33 = 1});
}

/* Beyond a limit load: continuation, then descent. */
TEST(StopsMixedSearch)
{
  const LamMicrostructure bonded = CoarseTissue(DefaultTissue()), contact = CoarseTissue(ContactTissue(6, 2));

  StopMixed(&bonded, (MixedCase){.F = {FREE, FREE, 0, FREE}, .F33 = 1, .P = {-0.02, 0, 0, -0.02}});
  StopMixed(&contact, (MixedCase){.turgor = 0.02, .F = {FREE, 0.1, 0, FREE}, .F33 = 1});
}
