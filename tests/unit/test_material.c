/* The material law for other programs: SI units, states, threads, words of errors. */
#include "support/test.h"
#include <pthread.h>
#include <string.h>
#include <unistd.h>
#include <lamella/lamella.h>

static const char scene_path[] = LAMELLA_SOURCE_DIR "/tests/scenes/shear-contact.yaml";
static const double sheared[9] = {1, 0.05, 0, 0, 1, 0, 0, 0, 1};

TEST(stress_and_tangent_are_those_of_the_rve_in_pascal)
{
  double P[9], tangent[81], turgor, cohesion;
  LamMaterialInfo info;
  LamMaterial material;
  LamResponse wanted;
  LamRVEState at;
  LamScene *scene;
  LamLoad load;
  LamRVE rve;

  assert_int_equal(LamSceneRead(scene_path, &scene), 0);
  load = (LamLoad){.turgor = scene->turgor, .cohesion = scene->cohesion};
  memcpy(load.F, sheared, sizeof(sheared));
  assert_int_equal(LamRVECreate(PETSC_COMM_SELF, &rve), 0);
  assert_int_equal(LamRVESetMicrostructure(rve, &scene->micro), 0);
  assert_int_equal(LamRVESetStrategy(rve, scene->strategy), 0);
  assert_int_equal(LamRVESetTolerance(rve, scene->tolerance), 0);
  assert_int_equal(LamRVESetUp(rve), 0);
  assert_int_equal(LamRVEStateCreate(rve, &at), 0);
  assert_int_equal(LamRVESolve(rve, &load, at, &wanted), 0);

  assert_int_equal(LamMaterialCreateFromScene(scene_path, 0, &material), 0);
  assert_int_equal(LamMaterialGetLoads(material, &turgor, &cohesion), 0);
  assert_true(fabs(turgor - 0.05e6) < 1e-6 && fabs(cohesion - 1e3) < 1e-6);
  assert_int_equal(LamMaterialEvaluate(material, 1, NULL, sheared, NULL, NULL, P, tangent, &info), 0);
  assert_int_equal(info.status, LAM_CONVERGED);
  for (int i = 0; i < 9; i++) assert_true(P[i] == wanted.P[i] * scene->scales.stress);
  for (int i = 0; i < 81; i++) /* of out-of-plane shears it is not known */
    assert_true(
        tangent[i] == wanted.tangent[i] * scene->scales.stress ||
        (isnan(tangent[i]) && isnan(wanted.tangent[i]) && (i % 9 == 2 || i % 9 > 4 || i / 9 == 2 || i / 9 > 4)));
  assert_true(info.max_gap == wanted.max_gap * scene->scales.length);

  LamMaterialDestroy(&material);
  LamRVEStateDestroy(&at);
  LamRVEDestroy(&rve);
  LamSceneDestroy(&scene);
}

/* Shears out of the plane are those of the RVE itself. */
TEST(a_scene_has_any_F_and_its_whole_tangent_if_it_shall)
{
  const double F[9] = {1.02, 0.05, 0.03, 0, 1, -0.04, 0.02, 0.01, 1.05}, h = 1e-6;
  double P[9], side[2][9], tangent[81];
  LamMaterialInfo info;
  LamMaterial material;

  assert_int_equal(LamMaterialCreateFromScene(scene_path, 0, &material), 0);
  assert_int_equal(LamMaterialEvaluate(material, 1, NULL, F, NULL, NULL, P, NULL, &info), 0);
  assert_int_equal(info.status, LAM_INVALID_F);
  assert_int_equal(LamMaterialSetOutOfPlane(material, 1), 0);
  assert_int_equal(LamMaterialEvaluate(material, 1, NULL, F, NULL, NULL, P, tangent, &info), 0);
  assert_int_equal(info.status, LAM_CONVERGED);
  for (int j = 0; j < 9; j++) {
    for (int k = 0; k < 2; k++) {
      double moved[9];

      memcpy(moved, F, sizeof(F));
      moved[j] += k ? h : -h;
      assert_int_equal(LamMaterialEvaluate(material, 1, NULL, moved, NULL, NULL, side[k], NULL, NULL), 0);
    }
    for (int i = 0; i < 9; i++)
      assert_true(fabs(tangent[9 * i + j] - (side[1][i] - side[0][i]) / (2 * h)) < 1e-5 * fabs(tangent[80]));
  }
  LamMaterialDestroy(&material);
}

/* The load step after the one that was saved ends in the same numbers. */
TEST(a_restored_state_goes_on_as_the_one_saved)
{
  const int points[1] = {0};
  const double further[9] = {1, 0.12, 0, 0, 1, 0, 0, 0, 1};
  double P[2][9];
  LamMaterial material;
  size_t size;
  char *bytes;

  for (int k = 0; k < 2; k++) {
    assert_int_equal(LamMaterialCreateFromScene(scene_path, 1, &material), 0);
    assert_int_equal(LamMaterialGetStateSize(material, &size), 0);
    if (!k) {
      assert_int_equal(LamMaterialEvaluate(material, 1, points, sheared, NULL, NULL, P[0], NULL, NULL), 0);
      assert_int_equal(LamMaterialAccept(material), 0);
      assert_int_equal(PetscMalloc(size, &bytes), 0);
      assert_int_equal(LamMaterialSaveState(material, 0, bytes), 0);
    } else {
      assert_int_equal(LamMaterialRestoreState(material, 0, bytes), 0);
    }
    assert_int_equal(LamMaterialEvaluate(material, 1, points, further, NULL, NULL, P[k], NULL, NULL), 0);
    LamMaterialDestroy(&material);
  }
  assert_memory_equal(P[0], P[1], sizeof(P[0]));
  PetscFree(bytes);
}

TEST(a_state_without_a_response_has_no_numbers_but_a_reason)
{
  const double inverted[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
  double P[9];
  LamMaterialInfo info;
  LamMaterial material;

  assert_int_equal(LamMaterialCreateFromScene(scene_path, 0, &material), 0);
  assert_int_equal(LamMaterialEvaluate(material, 1, NULL, inverted, NULL, NULL, P, NULL, &info), 0);
  assert_int_equal(info.status, LAM_INVALID_F);
  assert_non_null(strstr(info.reason, "det"));
  assert_true(isnan(P[0]));
  LamMaterialDestroy(&material);
}

TEST(errors_are_kept_in_words)
{
  LamMaterial material;

  assert_int_equal(LamMaterialCreateFromScene("no such scene.yaml", 0, &material), PETSC_ERR_USER_INPUT);
  assert_null(material);
  assert_int_equal(LamErrorCode(), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(LamErrorMessage(), "no such scene.yaml"));
  assert_null(strchr(LamErrorMessage(), '\n'));
}

/* ---- threads on a database ---- */

enum { THREADS = 4, STATES = 500 };
static LamMaterial shared;
static double F[STATES][9], alone[STATES][9];

static void *Evaluate(void *different)
{
  double P[STATES][9];

  *(int *)different =
      LamMaterialEvaluate(shared, STATES, NULL, F[0], NULL, NULL, P[0], NULL, NULL) || memcmp(P, alone, sizeof(P));
  return NULL;
}

TEST(threads_get_what_one_gets_alone)
{
  const LamBuildOptions options = {0};
  LamVerifyResult verified;
  LamBuildResult result;
  pthread_t thread[THREADS];
  int different[THREADS];
  char path[] = "/tmp/test_material_XXXXXX";
  const int file = mkstemp(path);

  assert_true(file >= 0);
  close(file);
  unlink(path);
  assert_int_equal(LamStudyBuild(LAMELLA_SOURCE_DIR "/tests/scenes/tissue-block.yaml", path, &options, &result), 0);
  assert_true(result.records > 0 && result.answered > 0.9);
  assert_int_equal(LamStudyVerify(path, &(LamVerifyOptions){.samples = 20, .seed = 1}, &verified), 0);
  assert_true(verified.responses == 20 && verified.compared == 20 && verified.error > 0 && verified.error < 0.05);
  assert_int_equal(LamMaterialCreateFromDatabase(path, &shared), 0);
  for (int i = 0; i < STATES; i++)
    memcpy(F[i], (double[9]){1 + 1e-4 * i, 1e-5 * i, 0, 0, 1.01, 0, 0, 0, 1}, sizeof(F[i]));
  assert_int_equal(LamMaterialEvaluate(shared, STATES, NULL, F[0], NULL, NULL, alone[0], NULL, NULL), 0);
  assert_false(isnan(alone[0][0]));
  for (int t = 0; t < THREADS; t++) pthread_create(&thread[t], NULL, Evaluate, &different[t]);
  for (int t = 0; t < THREADS; t++) {
    pthread_join(thread[t], NULL);
    assert_false(different[t]);
  }
  LamMaterialDestroy(&shared);
  unlink(path);
}

TEST(a_map_is_made_without_the_program)
{
  LamMapResult map;
  char path[] = "/tmp/test_map_XXXXXX";
  const int file = mkstemp(path);

  assert_true(file >= 0);
  close(file);
  unlink(path);
  assert_int_equal(
      LamStudyMap(LAMELLA_SOURCE_DIR "/tests/scenes/map-shear-turgor.yaml", path, &(LamMapOptions){0}, &map), 0);
  assert_true(map.points == 54 && map.solved == 54 && !map.unknown && !map.stopped);
  unlink(path);
}

static int KeepErrors(void **state)
{
  return LamErrorsKeep() ? 1 : 0;
}

TEST_GROUP(.petsc = 1, .setup = KeepErrors);
