/* The mortar kernel against the states of an independent prototype. */
#include <jansson.h>
#include "support/rve_fixture.h"
#include "support/mortar_fixture.h"

#define DATA LAMELLA_SOURCE_DIR "/tests/verification/data/mortar.json"
#define TOLERANCE 1e-10
#define UNKNOWNS (CHAIN_DOFS + 4)
#define STATES_MAX 16

typedef struct {
  double weight[HATS], gap[HATS], energy, gradient[UNKNOWNS], hessian[UNKNOWNS * UNKNOWNS];
} Values;

static Values expected[STATES_MAX], found[STATES_MAX];
static int count;

static double At(const json_t *array, int i)
{
  return json_number_value(json_array_get(array, (size_t)i));
}

static void ReadReals(const json_t *object, const char key[], int n, double values[])
{
  const json_t *array = json_object_get(object, key);

  assert_int_equal(json_array_size(array), n);
  for (int i = 0; i < n; i++) values[i] = At(array, i);
}

static void ReadNodes(const json_t *object, const char key[], int n, double x[][2])
{
  const json_t *array = json_object_get(object, key);

  assert_int_equal(json_array_size(array), n);
  for (int a = 0; a < n; a++)
    for (int d = 0; d < 2; d++) x[a][d] = At(json_array_get(array, (size_t)a), d);
}

static void ReadExpected(const json_t *state, Values *values)
{
  const json_t *object = json_object_get(state, "expected"), *rows = json_object_get(object, "hessian");

  ReadReals(object, "weights", HATS, values->weight);
  ReadReals(object, "weighted_gaps", HATS, values->gap);
  ReadReals(object, "gradient", UNKNOWNS, values->gradient);
  values->energy = json_number_value(json_object_get(object, "energy"));
  assert_int_equal(json_array_size(rows), UNKNOWNS);
  for (int i = 0; i < UNKNOWNS; i++)
    for (int j = 0; j < UNKNOWNS; j++) values->hessian[UNKNOWNS * i + j] = At(json_array_get(rows, (size_t)i), j);
}

/* The derivative of the dofs in an unknown: itself, or for F_ij the master nodes' shift by F L, dy_i = L_j. Calls with
   dof index d give the weight of unknown u. */
static double DofOfUnknown(int d, int u, const double L[2])
{
  if (u < CHAIN_DOFS) return d == u;
  return d >= 2 * HATS && d % 2 == (u - CHAIN_DOFS) / 2 ? L[(u - CHAIN_DOFS) % 2] : 0.0;
}

/* Values in the unknowns of the file: sums over the master nodes give the derivatives in F. */
static void Transform(const ChainValues *v, const double L[2], Values *out)
{
  memcpy(out->weight, v->weight, sizeof(out->weight));
  memcpy(out->gap, v->gap, sizeof(out->gap));
  out->energy = v->energy;
  for (int u = 0; u < UNKNOWNS; u++) {
    out->gradient[u] = 0.0;
    for (int d = 0; d < CHAIN_DOFS; d++) out->gradient[u] += v->gradient[d] * DofOfUnknown(d, u, L);
    for (int w = 0; w < UNKNOWNS; w++) {
      double sum = 0.0;

      for (int d = 0; d < CHAIN_DOFS; d++)
        for (int e = 0; e < CHAIN_DOFS; e++) sum += DofOfUnknown(d, u, L) * v->hessian[d][e] * DofOfUnknown(e, w, L);
      out->hessian[UNKNOWNS * u + w] = sum;
    }
  }
}

static void Compare(const json_t *state, Values *reference, Values *mine)
{
  Chains chains;
  ChainValues values = {0};
  double F[4], L[2];

  ReadExpected(state, reference);
  ReadNodes(state, "slave_nodes", HATS, chains.x);
  ReadNodes(state, "master_nodes", MASTER_NODES, chains.x + HATS);
  ReadReals(state, "slave_reference_lengths", SLAVE_EDGES, chains.J0);
  ReadReals(state, "multipliers", HATS, chains.lambda);
  ReadReals(state, "F", 4, F);
  ReadReals(state, "L", 2, L);
  for (int a = HATS; a < CHAIN_NODES; a++)
    for (int d = 0; d < 2; d++) chains.x[a][d] += F[2 * d] * L[0] + F[2 * d + 1] * L[1];
  assert_int_equal(EvaluateChains(&chains, 4, &values), 0);
  Transform(&values, L, mine);
}

static int ReadStates(void **state)
{
  json_t *root = json_load_file(DATA, 0, NULL), *states = json_object_get(root, "states"), *entry;
  size_t k;

  count = (int)json_array_size(states);
  assert_in_range(count, 1, STATES_MAX);
  json_array_foreach(states, k, entry) Compare(entry, &expected[k], &found[k]);
  json_decref(root);
  return 0;
}

/* Largest difference over the largest entry, in all states. */
static double RelativeError(size_t offset, int n)
{
  double error = 0.0;

  for (int k = 0; k < count; k++) {
    const double *a = (const double *)((const char *)&found[k] + offset);
    const double *b = (const double *)((const char *)&expected[k] + offset);
    double difference = 0.0, largest = 0.0;

    for (int i = 0; i < n; i++) {
      difference = fmax(difference, fabs(a[i] - b[i]));
      largest = fmax(largest, fabs(b[i]));
    }
    error = fmax(error, difference / largest);
  }
  return error;
}

TEST_IS(WeightsAgree, assert_near(RelativeError(offsetof(Values, weight), HATS), 0.0, TOLERANCE));
TEST_IS(WeightedGapsAgree, assert_near(RelativeError(offsetof(Values, gap), HATS), 0.0, TOLERANCE));
TEST_IS(EnergyAgrees, assert_near(RelativeError(offsetof(Values, energy), 1), 0.0, TOLERANCE));
TEST_IS(GradientAgrees, assert_near(RelativeError(offsetof(Values, gradient), UNKNOWNS), 0.0, TOLERANCE));
TEST_IS(HessianAgrees, assert_near(RelativeError(offsetof(Values, hessian), UNKNOWNS *UNKNOWNS), 0.0, TOLERANCE));

TEST_GROUP(.setup = ReadStates);
