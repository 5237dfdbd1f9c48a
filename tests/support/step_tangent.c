#include "step_tangent.h"
#include "rve_fixture.h"

static const int components[5] = {0, 1, 3, 4, 8};

void CheckStepTangent(Specimen *s, const LamLoad *load)
{
  const double h = 1e-5;
  OWNED(LamRVEState, LamRVEStateDestroy) end = NewState(s->rve);
  LamResponse r, q;
  double largest = 0.0;

  CHECK(LamRVEStateCopy(s->state, end));
  CHECK(LamRVESolve(s->rve, load, end, &r));
  assert_int_equal(r.status, LAM_CONVERGED);
  for (int k = 0; k < 5; k++) largest = fmax(largest, fabs(r.tangent[10 * components[k]]));
  for (int k = 0; k < 5; k++) {
    double difference[9] = {0};

    for (int m = -2; m <= 2; m++) {
      const double weight[5] = {1.0 / 12, -8.0 / 12, 0, 8.0 / 12, -1.0 / 12};
      LamLoad moved = *load;

      if (m == 0) continue;
      moved.F[components[k]] += m * h;
      CHECK(LamRVEStateCopy(s->state, end));
      CHECK(LamRVESolve(s->rve, &moved, end, &q));
      assert_int_equal(q.status, LAM_CONVERGED);
      for (int i = 0; i < 9; i++) difference[i] += weight[m + 2] * q.P[i] / h;
    }
    for (int l = 0; l < 5; l++) {
      const double entry = r.tangent[9 * components[l] + components[k]];

      assert_near(difference[components[l]], entry, 1e-6 * largest);
      assert_near(r.tangent[9 * components[k] + components[l]], entry, 1e-10 * largest);
    }
  }
}
