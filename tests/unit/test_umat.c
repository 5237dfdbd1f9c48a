/* Tissue as a material of CalculiX and Abaqus: their functions, called as they call them. */
#include "support/test.h"
#include <lamella/bind.h>
#include <lamella/response.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
           const int *npt, const int *layer, const int *kspt, const int *kstep, const int *kinc, int length);
void CALCULIX(const char *amat, const int *iel, const int *iint, const int *kode, const double *elconloc,
              const double *emec, const double *emec0, const double *beta, const double *xokl, const double *voj,
              const double *xkl, const double *vj, const int *ithermal, const double *t1l, const double *dtime,
              const double *time, const double *ttime, const int *icmd, const int *ielas, const int *mi,
              const int *nstate_, const double *xstateini, double *xstate, double *stre, double *stiff,
              const int *iorien, const double *pgauss, const double *orab, double *pnewdt, const int *ipkon, int size);

static const char Scene[] = "version: 1\n"
                            "rve:\n"
                            "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                            "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                            "  mesh: {along: %d, through: 1}\n"
                            "  interface: {law: %s}\n";
static const char Lamella[] = "lamella, strength: 0.05 MPa, fracture_energy: 0.5 J/m^2";
static const double Turgor = 0.02, Unit = 1e6; /* MPa, Pa */

static char Folder[] = "/tmp/lamella-umat-XXXXXX";

static const char *PathOf(const char name[])
{
  static char path[256];

  snprintf(path, sizeof(path), "%s/%s", Folder, name);
  return path;
}

static void WriteScene(const char name[], int along, const char law[])
{
  FILE *file = fopen(PathOf(name), "w");

  assert_non_null(file);
  fprintf(file, Scene, along, law);
  fclose(file);
}

/* ---- the hosts ---- */

enum { SIX = 6, MAX = 36 };

/* What a host holds of a material point. */
typedef struct {
  const char *name;
  int element, shears, constants;
  double F[9], F0[9], turgor, begin[2], end[2]; /* F row by row */
  double stress[SIX], stiffness[MAX];           /* those of the last call */
  double factor;                                /* of the next increment */
  int elastic, orientation, thermal, variables;
  double strain_error;
} Host;

static Host NewHost(const char name[])
{
  static int element;

  return (Host){.name = name,
                .element = ++element,
                .shears = 1,
                .constants = 1,
                .F = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                .F0 = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                .turgor = Turgor,
                .factor = -1,
                .thermal = 1,
                .variables = 2};
}

static void Name(const Host *h, char padded[80])
{
  memset(padded, ' ', 80);
  memcpy(padded, h->name, strlen(h->name));
}

static void Columns(const double F[9], double columns[9])
{
  for (int i = 0; i < 9; i++) columns[i] = F[3 * (i % 3) + i / 3];
}

static void Abaqus(Host *h)
{
  const double zero[SIX] = {0}, time[2] = {0, 0}, dtime = 1, none = 0, half = h->turgor / 2;
  const int ndi = 3, ntens = 3 + h->shears, point = 1, one = 1;
  double F[9], F0[9], unused;
  char name[80];

  Name(h, name);
  Columns(h->F, F);
  Columns(h->F0, F0);
  memcpy(h->end, h->begin, sizeof(h->begin)); /* Abaqus has one array */
  umat_(h->stress, h->end, h->stiffness, &unused, &unused, &unused, &unused, &unused, &unused, &unused, zero, zero,
        time, &dtime, &half, &half, &none, &none, name, &ndi, &h->shears, &ntens, &h->variables, (double[]){Unit, 0.01},
        &h->constants, zero, zero, &h->factor, &none, F0, F, &h->element, &point, &one, &one, &one, &one, 80);
}

/* State variables of an element that is the second of two, with two points, of which this is the second. */
static void Calculix(Host *h)
{
  const double zero[SIX] = {0}, one = 1;
  const int second = 2, kode = -100 - h->constants, none = 0;
  double F[9], F0[9], strain[SIX] = {h->strain_error}, begin[4 * 2] = {0}, end[4 * 2] = {0};
  static const int first[SIX] = {0, 1, 2, 0, 0, 1}, other[SIX] = {0, 1, 2, 1, 2, 2};
  char name[80];

  Name(h, name);
  Columns(h->F, F);
  Columns(h->F0, F0);
  memcpy(&begin[3 * 2], h->begin, sizeof(h->begin));
  for (int a = 0; a < SIX; a++) {
    strain[a] -= first[a] == other[a] ? 0.5 : 0;
    for (int i = 0; i < 3; i++) strain[a] += h->F[3 * i + first[a]] * h->F[3 * i + other[a]] / 2;
  }
  CALCULIX(name, &second, &second, &kode, (double[]){Unit, 0.01}, strain, zero, zero, F0, &one, F, &one, &h->thermal,
           &h->turgor, &one, &one, &one, &none, &h->elastic, &second, &h->variables, begin, end, h->stress,
           h->stiffness, &h->orientation, zero, zero, &h->factor, &none, 80);
  memcpy(h->end, &end[3 * 2], sizeof(h->end));
}

/* The increment is accepted. */
static void Accept(Host *h)
{
  memcpy(h->begin, h->end, sizeof(h->end));
  memcpy(h->F0, h->F, sizeof(h->F));
}

/* ---- matrices ---- */

static void Multiply(const double A[9], const double B[9], double C[9])
{
  for (int i = 0; i < 9; i++) {
    C[i] = 0;
    for (int k = 0; k < 3; k++) C[i] += A[3 * (i / 3) + k] * B[3 * k + i % 3];
  }
}

static double Determinant(const double F[9])
{
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/* Stretched, sheared and turned: in plane strain, in space. */
static const double General[9] = {0.95, -0.35, 0, 0.4, 1.1, 0, 0, 0, 1};
static const double Spatial[9] = {0.95, -0.35, 0.1, 0.4, 1.1, -0.15, 0.05, 0.2, 1.08};

/* The library's own answer, in MPa, without the host. */
static void Direct(const double F[9], LamResponse *response)
{
  double load[11] = {0};
  LamBindScene scene;
  LamBindRVE rve;

  memcpy(load, F, 9 * sizeof(*F));
  load[9] = Turgor * Unit;
  CHECK(LamBindSceneRead(PathOf("bonded.yaml"), NULL, &scene));
  CHECK(LamBindRVECreate(scene, &rve));
  CHECK(LamBindRVESolve(rve, 1, load, NULL, 1, 0, response));
  assert_int_equal(response->status, LAM_CONVERGED);
  for (int i = 0; i < 9; i++) response->P[i] /= Unit;
  LamBindRVEDestroy(rve);
  LamBindSceneDestroy(scene);
}

static double Size(const Host *h)
{
  double size = 0;

  for (int a = 0; a < 3 + h->shears; a++) size = fmax(size, fabs(h->stress[a]));
  return size;
}

static const int First[SIX] = {0, 1, 2, 0, 0, 1}, Second[SIX] = {0, 1, 2, 1, 2, 2};

/* ---- stress ---- */

static void CauchyStress(const double F[9])
{
  Host h = NewHost("BONDED_YAML");
  LamResponse direct;

  h.shears = 3;
  memcpy(h.F, F, sizeof(h.F));
  Abaqus(&h);
  Direct(F, &direct);
  for (int a = 0; a < SIX; a++) {
    double sigma = 0;

    for (int K = 0; K < 3; K++) sigma += direct.P[3 * First[a] + K] * F[3 * Second[a] + K] / Determinant(F);
    assert_near(h.stress[a], sigma, 1e-9 * Size(&h));
  }
}

TEST_IS(abaqus_gets_the_cauchy_stress_in_the_plane, CauchyStress(General));
TEST_IS(abaqus_gets_the_cauchy_stress_in_space, CauchyStress(Spatial));

static void SecondStress(const double F[9])
{
  Host h = NewHost("@LAMELLAUMAT_CALCULIX@BONDED.YAML");
  LamResponse direct;
  double S[9], FS[9];

  memcpy(h.F, F, sizeof(h.F));
  Calculix(&h);
  Direct(F, &direct);
  for (int a = 0; a < SIX; a++) S[3 * First[a] + Second[a]] = S[3 * Second[a] + First[a]] = h.stress[a];
  Multiply(F, S, FS);
  for (int i = 0; i < 9; i++) assert_near(FS[i], direct.P[i], 1e-9 * Size(&h));
  assert_true(h.factor == -1);
}

TEST_IS(calculix_gets_the_second_piola_kirchhoff_stress_in_the_plane, SecondStress(General));
TEST_IS(calculix_gets_the_second_piola_kirchhoff_stress_in_space, SecondStress(Spatial));

TEST(cauchy_stress_turns_with_the_body)
{
  const double c = cos(0.7), s = sin(0.7), Q[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
  Host h = NewHost("BONDED_YAML"), turned = NewHost("BONDED_YAML");

  memcpy(h.F, General, sizeof(General));
  Multiply(Q, General, turned.F);
  Abaqus(&h);
  Abaqus(&turned);
  assert_near(turned.stress[0], c * c * h.stress[0] - 2 * c * s * h.stress[3] + s * s * h.stress[1], 1e-7 * Size(&h));
  assert_near(turned.stress[3], c * s * (h.stress[0] - h.stress[1]) + (c * c - s * s) * h.stress[3], 1e-7 * Size(&h));
}

/* ---- tangents, against central differences ---- */

static const double Step = 1e-5;

/* The motion continues with the rate of deformation of component b and no spin: the Jaumann rate is the plain one. */
static void JaumannTangent(const double F[9])
{
  Host h = NewHost("BONDED_YAML");

  h.shears = 3;
  memcpy(h.F, F, sizeof(h.F));
  Abaqus(&h);
  for (int b = 0; b < SIX; b++) {
    Host side[2] = {h, h};
    double D[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

    for (int k = 0; k < 2; k++) {
      const double rate = (k ? 1 : -1) * Step; /* shears of Abaqus are twice those of the tensor */

      D[3 * First[b] + Second[b]] = D[3 * Second[b] + First[b]] = b < 3 ? 1 + rate : rate / 2;
      Multiply(D, F, side[k].F);
      Abaqus(&side[k]);
    }
    for (int a = 0; a < SIX; a++) {
      const double up = side[1].stress[a] * Determinant(side[1].F), down = side[0].stress[a] * Determinant(side[0].F);

      assert_near(h.stiffness[a + SIX * b], (up - down) / (2 * Step) / Determinant(F), 1e-6);
    }
  }
}

TEST_IS(abaqus_gets_the_jaumann_tangent_in_the_plane, JaumannTangent(General));
TEST_IS(abaqus_gets_the_jaumann_tangent_in_space, JaumannTangent(Spatial));

static void GreenTangent(const double F[9])
{
  Host h = NewHost("@LAMELLAUMAT_CALCULIX@BONDED.YAML");
  double C[SIX][SIX];

  memcpy(h.F, F, sizeof(h.F));
  Calculix(&h);
  for (int b = 0, k = 0; b < SIX; b++)
    for (int a = 0; a <= b; a++, k++) C[a][b] = C[b][a] = h.stiffness[k];
  for (int component = 0; component < 9; component++) {
    Host side[2] = {h, h};
    double change[SIX] = {0};

    for (int k = 0; k < 2; k++) {
      side[k].F[component] += (k ? 1 : -1) * Step;
      Calculix(&side[k]);
      for (int a = 0; a < SIX; a++)
        for (int i = 0; i < 3; i++)
          change[a] += (k ? 1 : -1) * side[k].F[3 * i + First[a]] * side[k].F[3 * i + Second[a]] / (4 * Step);
    }
    for (int a = 0; a < SIX; a++) {
      double predicted = 0;

      for (int b = 0; b < SIX; b++) predicted += (b < 3 ? 1 : 2) * C[a][b] * change[b];
      assert_near(predicted, (side[1].stress[a] - side[0].stress[a]) / (2 * Step), 1e-6);
    }
  }
}

TEST_IS(calculix_gets_the_derivative_by_green_strain_in_the_plane, GreenTangent(General));
TEST_IS(calculix_gets_the_derivative_by_green_strain_in_space, GreenTangent(Spatial));

TEST(solids_of_abaqus_in_plane_strain_get_six_components)
{
  Host plane = NewHost("BONDED_YAML"), solid = NewHost("BONDED_YAML");

  solid.shears = 3;
  memcpy(plane.F, General, sizeof(General));
  memcpy(solid.F, General, sizeof(General));
  Abaqus(&plane);
  Abaqus(&solid);
  for (int a = 0; a < 4; a++) {
    assert_near(solid.stress[a], plane.stress[a], 1e-9 * Size(&plane));
    for (int b = 0; b < 4; b++) assert_near(solid.stiffness[a + 6 * b], plane.stiffness[a + 4 * b], 1e-8);
  }
  assert_true(solid.stress[4] == 0 && solid.stress[5] == 0);
}

/* ---- increments ---- */

static void Stretch(Host *h, double F22, void (*host)(Host *))
{
  h->F[4] = F22;
  host(h);
}

/* What a refused attempt has broken is whole again; what an accepted one has broken, for good. */
static void CutBack(const char name[], void (*host)(Host *))
{
  Host h = NewHost(name);
  double whole;

  h.turgor = 0;
  Stretch(&h, 1.01, host);
  Accept(&h);
  Stretch(&h, 1.03, host);
  whole = h.stress[1];
  Stretch(&h, 1.3, host);
  Stretch(&h, 1.03, host);
  assert_near(h.stress[1], whole, 1e-6 * whole);
  Stretch(&h, 1.3, host);
  Accept(&h);
  Stretch(&h, 1.03, host);
  assert_true(h.stress[1] < 0.9 * whole);
}

TEST_IS(abaqus_keeps_history_across_a_cut_back, CutBack("LAMELLA_YAML", Abaqus));
TEST_IS(calculix_keeps_history_across_a_cut_back, CutBack("@LAMELLAUMAT_CALCULIX@LAMELLA.YAML", Calculix));

/* What is told on standard output goes nowhere: returns where it went, for Speak. */
static int Hush(void)
{
  const int kept = dup(STDOUT_FILENO);

  fflush(stdout);
  assert_non_null(freopen("/dev/null", "w", stdout));
  return kept;
}

static void Speak(int kept)
{
  fflush(stdout);
  dup2(kept, STDOUT_FILENO);
  close(kept);
}

TEST(no_response_halves_the_increment_and_changes_no_state)
{
  Host h = NewHost("BONDED_YAML"), c = NewHost("@LAMELLAUMAT_CALCULIX@OTHER.YAML");
  int told;

  h.factor = 1;
  h.F[0] = c.F[0] = -1;
  h.stress[0] = 7;
  told = Hush();
  Abaqus(&h);
  Calculix(&c);
  Speak(told);
  assert_true(h.factor == 0.5 && h.stress[0] == 7 && h.end[0] == h.begin[0]);
  assert_true(c.factor == 0.5 && c.end[0] == c.begin[0]);
  for (int a = 0; a < 21; a++) assert_true(isfinite(c.stiffness[a]));
}

/* CalculiX moves prescribed displacements alone, and makes the stress from this tangent itself. */
TEST(an_elastic_iteration_gets_the_tangent_at_its_start)
{
  Host h = NewHost("@LAMELLAUMAT_CALCULIX@ELASTIC.YAML"), again;

  memcpy(h.F, General, sizeof(General));
  Calculix(&h);
  Accept(&h);
  again = h;
  again.F[0] = -1;
  again.turgor = 10;
  again.elastic = 1;
  Calculix(&again);
  for (int a = 0; a < 21; a++) assert_near(again.stiffness[a], h.stiffness[a], 1e-7);
  assert_true(again.factor == -1 && again.end[0] == h.begin[0] && again.end[1] == Turgor);
}

static void *SolveThere(void *host)
{
  for (int k = 0; k < 20; k++) Abaqus((Host *)host);
  return NULL;
}

TEST(threads_solve_one_at_a_time)
{
  Host hosts[4], alone = NewHost("BONDED_YAML");
  pthread_t threads[4];

  memcpy(alone.F, General, sizeof(General));
  Abaqus(&alone);
  for (int k = 0; k < 4; k++) {
    hosts[k] = NewHost("BONDED_YAML");
    memcpy(hosts[k].F, General, sizeof(General));
    assert_int_equal(pthread_create(&threads[k], NULL, SolveThere, &hosts[k]), 0);
  }
  for (int k = 0; k < 4; k++) {
    pthread_join(threads[k], NULL);
    for (int a = 0; a < 4; a++) assert_near(hosts[k].stress[a], alone.stress[a], 1e-9 * Size(&alone));
  }
}

/* ---- what ends the program, with which words ---- */

static void Ends(Host h, void (*host)(Host *), const char words[])
{
  char told[4096] = "";
  int ends[2], status;
  ssize_t length;
  pid_t child;

  assert_int_equal(pipe(ends), 0);
  fflush(NULL);
  child = fork();
  if (!child) {
    dup2(ends[1], STDOUT_FILENO);
    host(&h);
    _exit(0);
  }
  close(ends[1]);
  for (size_t at = 0; (length = read(ends[0], &told[at], sizeof(told) - 1 - at)) > 0;) at += (size_t)length;
  close(ends[0]);
  assert_int_equal(waitpid(child, &status, 0), child);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 201 || !strstr(told, words)) fail_msg("\"%s\" in: %s", words, told);
}

TEST(a_state_that_is_not_kept_is_refused)
{
  Host h = NewHost("LAMELLA_YAML");

  h.begin[0] = 12345; /* as after a restart */
  Ends(h, Abaqus, "begins with state 12345");
  h.begin[0] = 0; /* as after a restart of CalculiX 2.20, which forgets state variables */
  h.F0[0] = 1.01;
  Ends(h, Abaqus, "begins with state 0 at F = 1.01 0 0 1, which is not the last accepted one, 0");
}

TEST(files_are_found_irrespective_of_capitals_or_refused)
{
  Host h = NewHost("TWO_YAML");

  Ends(h, Abaqus, "both");
  h.name = "NONE_YAML";
  Ends(h, Abaqus, "there is no file NONE_YAML in the folder");
  h.name = "WRONG_YAML";
  Ends(h, Abaqus, "rve.interface.law");
  h.name = "SEALED_YAML";
  Ends(h, Abaqus, "rve.turgor.mode: sealed");
  h.name = "UNUSED_YAML";
  h.constants = 2;
  Ends(h, Abaqus, "2 constants");
}

TEST(arguments_that_have_no_meaning_are_refused)
{
  Host h = NewHost("@LAMELLAUMAT_CALCULIX@BONDED.YAML");

  Ends(h, Abaqus, "CalculiX takes stress in another frame");
  h.variables = 1;
  Ends(h, Calculix, "*DEPVAR");
  h.variables = 2;
  h.thermal = 0;
  Ends(h, Calculix, "temperature is turgor");
  h.thermal = 1;
  h.orientation = 1;
  Ends(h, Calculix, "*ORIENTATION");
  h.orientation = 0;
  h.strain_error = 1e-6;
  Ends(h, Calculix, "NLGEOM");
}

static int WriteFiles(void **state)
{
  (void)state;
  if (!mkdtemp(Folder) || setenv("LAMELLA_FOLDER", Folder, 1)) return 1;
  WriteScene("bonded.yaml", 2, "bonded");
  WriteScene("Other.yaml", 2, "bonded");
  WriteScene("elastic.yaml", 2, "bonded");
  WriteScene("lamella.yaml", 4, Lamella);
  WriteScene("two.yaml", 2, "bonded");
  WriteScene("Two.yaml", 2, "bonded");
  WriteScene("unused.yaml", 2, "bonded");
  WriteScene("wrong.yaml", 2, "glued");
  WriteScene("sealed.yaml", 2, "bonded}\n  turgor: {mode: sealed, pressure: 0.02 MPa");
  return LamBindStart();
}

static int RemoveFiles(void **state)
{
  char command[256];

  (void)state;
  snprintf(command, sizeof(command), "rm -r %s", Folder);
  return system(command);
}

TEST_GROUP(.petsc = 1, .setup = WriteFiles, .teardown = RemoveFiles);
