/*
  Answers without a solve, by three schemes: error of P against number of solves, and time per query. Prints figures,
  asserts nothing.

    bench_query [--full]      without it a coarse picture in a minute

  linear   P_i + A_i : (F - F_i) of the nearest record, as in situ adaptive tabulation does; no energy's gradient
  blend    the partition of unity of second-order models (query_scatter.h), here from records however far
  table    the potential on a grid (table.h), built by rounds to an accuracy

  Default tissue with C4/C1 = 10 and 100, bonded (turgor 0 to 0.05 MPa) and in contact (suction 0.005 to 0.06 MPa,
  cohesion 0.001 MPa), principal logarithmic strains -0.02 to 0.25. Records of linear and blend are the first of a
  low-discrepancy sequence, the held-out states come much later in it, the states for which the table is built later
  still. Linear and blend know the symmetry of the cell, as the table does. States that have buckled (branch > 0), or
  are not stable, are left out of the errors.

  Columns: solves; states with an answer; error of P (LamStressError) in %, of those: median, 95 %, 99 %, largest; time
  of a query; and, where the scheme estimates its error, at 1 %: share of states that are answered, share of the answers
  that are further off than that.

  Reference: Pope, Combustion Theory and Modelling 1 (1997) 41.
*/
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <petsctime.h>
#include <lamella/lamella.h>
#include "build.h"
#include "database_internal.h"
#include "options.h"
#include "measure.h"
#include "support/tissue.h"

#define ACCURACY 0.01
#define HELD_OUT 100000  /* where the held-out states begin in the sequence */
#define QUESTIONS 200000 /* and those for which the table is built */
#define REPEATS 3        /* of the timing; the least counts */

typedef struct {
  PetscReal ratio; /* C4/C1 */
  PetscBool contact;
} Tissue;

typedef struct {
  PetscInt states, questions;
  const PetscInt *counts;      /* of records, ascending, ends with 0 */
  const PetscReal *accuracies; /* for which the table is built, descending, ends with 0 */
  PetscInt most;               /* solves of a table */
} Extent;

/* What all schemes of a tissue share. */
typedef struct {
  const LamScene *scene;
  LamResponder solver;
  const Extent *extent;
  PetscInt n;
  LamResponse *truth; /* [n] held out */
} Bench;

/* One scheme. `accuracy`: PETSC_INFINITY where any answer will do. */
typedef struct Scheme_s {
  const char *name;
  PetscErrorCode (*answer)(const struct Scheme_s *scheme, const LamLoad *load, PetscReal accuracy, LamResponse *r);
  LamDatabase database;
  LamTable table;
  PetscInt solves;
  PetscBool estimates; /* the error of its answers */
} Scheme;

static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: %g MPa}\n"
                                 "  interface: {%s}\n"
                                 "  turgor: {mode: prescribed, pressure: 0.02 MPa}\n"
                                 "  mesh: {along: 6, through: 2}\n"
                                 "sample:\n"
                                 "  stretch: {min: -0.02, max: 0.25}\n"
                                 "  turgor: {min: %g MPa, max: %g MPa}\n";

/* ---- linear ---- */

/* Q A Q^T in the plane. */
static void Turn(PetscReal Q[2][2], const PetscReal A[4], PetscReal out[4])
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      out[2 * i + j] = 0;
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) out[2 * i + j] += Q[i][k] * A[2 * k + l] * Q[j][l];
    }
}

static void Transpose(PetscReal Q[2][2])
{
  const PetscReal swap = Q[0][1];

  Q[0][1] = Q[1][0];
  Q[1][0] = swap;
}

/* One of the six images of the lattice (its first direction is X1) that differ on symmetric tensors. */
static void Image(int image, PetscReal Q[2][2])
{
  const PetscReal angle = PETSC_PI / 3 * (image % 3), mirror = image < 3 ? 1 : -1;

  Q[0][0] = cos(angle);
  Q[0][1] = -mirror * sin(angle);
  Q[1][0] = sin(angle);
  Q[1][1] = mirror * cos(angle);
}

/* F = R U: the rotation and the stretch, in the plane. */
static void Polar(const PetscReal F[9], PetscReal R[2][2], PetscReal U[4])
{
  const PetscReal angle = atan2(F[3] - F[1], F[0] + F[4]), c = cos(angle), s = sin(angle);

  R[0][0] = R[1][1] = c;
  R[1][0] = s;
  R[0][1] = -s;
  U[0] = c * F[0] + s * F[3];
  U[1] = c * F[1] + s * F[4];
  U[2] = -s * F[0] + c * F[3];
  U[3] = -s * F[1] + c * F[4];
}

/* The square of the distance in stretch, and in pressures as a blend weighs them. */
static PetscReal Distance2(const LamResponse *record, const PetscReal U[4], const LamLoad *load, PetscBool contact)
{
  const PetscReal *F = record->load.F, dp = load->turgor - record->load.turgor;
  const PetscReal ds = contact ? dp + load->cohesion - record->load.cohesion : 0;

  return PetscSqr(U[0] - F[0]) + PetscSqr(U[1] - F[1]) + PetscSqr(U[2] - F[3]) + PetscSqr(U[3] - F[4]) +
         PetscSqr(0.011 * dp) + PetscSqr(0.5 * ds);
}

/* Components 11 12 21 22 and 33 of P_i + A_i : (U - U_i) + dP/dp dp. */
static void Extrapolate(const LamResponse *record, const PetscReal U[4], const LamLoad *load, PetscReal P[5])
{
  static const int at[5] = {0, 1, 3, 4, 8};

  for (int i = 0; i < 5; i++) {
    P[i] = record->P[at[i]] + record->P_turgor[at[i]] * (load->turgor - record->load.turgor);
    for (int j = 0; j < 4; j++) P[i] += record->tangent[9 * at[i] + at[j]] * (U[j] - record->load.F[at[j]]);
  }
}

static PetscErrorCode AnswerLinear(const Scheme *scheme, const LamLoad *load, PetscReal accuracy, LamResponse *r)
{
  const PetscBool contact = (PetscBool)(scheme->database->header.micro.interface == LAM_INTERFACE_CONTACT);
  PetscReal R[2][2], U[4], best = INFINITY, nearest[4] = {0}, Q[2][2], P[5], plane[4];
  const LamResponse *records;
  PetscInt n, record = 0;
  int image = 0;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, r));
  PetscCall(LamDatabaseGetRecords(scheme->database, &n, &records, NULL));
  Polar(load->F, R, U);
  for (int k = 0; k < 6; k++) {
    PetscReal turned[4];

    Image(k, Q);
    Turn(Q, U, turned);
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal d2 = Distance2(&records[i], turned, load, contact);

      if (!(d2 < best) || records[i].status != LAM_CONVERGED || records[i].branch) continue;
      best = d2;
      record = i;
      image = k;
      memcpy(nearest, turned, sizeof(nearest));
    }
  }
  if (!isfinite(best)) PetscFunctionReturn(0);
  Extrapolate(&records[record], nearest, load, P);
  Image(image, Q);
  Transpose(Q);
  Turn(Q, P, plane);
  for (int i = 0; i < 9; i++) r->P[i] = 0;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) r->P[3 * i + j] = R[i][0] * plane[j] + R[i][1] * plane[2 + j];
  r->P[8] = P[4];
  r->status = LAM_CONVERGED;
  PetscFunctionReturn(0);
}

/* ---- blend and table ---- */

static PetscErrorCode RespondFromBlend(const Scheme *scheme, const LamLoad *load, PetscReal accuracy, LamResponse *r)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, r));
  PetscCall(
      LamScatterQuery(scheme->database, load, accuracy < PETSC_INFINITY ? LAM_TRUST_RADIUS : INFINITY, accuracy, r));
  PetscFunctionReturn(0);
}

static PetscErrorCode AnswerTable(const Scheme *scheme, const LamLoad *load, PetscReal accuracy, LamResponse *r)
{
  PetscFunctionBeginUser;
  PetscCall(LamTableQuery(scheme->table, load, accuracy, r));
  PetscFunctionReturn(0);
}

/* ---- one row ---- */

static PetscErrorCode TimeOfAQuery(const Bench *bench, const Scheme *scheme, PetscReal accuracy, PetscReal *time)
{
  PetscFunctionBeginUser;
  *time = INFINITY;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    PetscLogDouble start, end;
    LamResponse r;

    PetscCall(PetscTime(&start));
    for (PetscInt i = 0; i < bench->n; i++) PetscCall(scheme->answer(scheme, &bench->truth[i].load, accuracy, &r));
    PetscCall(PetscTime(&end));
    *time = PetscMin(*time, (end - start) / bench->n);
  }
  PetscFunctionReturn(0);
}

/* Errors of the answers to an accuracy; errors[n] is the caller's. */
static PetscErrorCode Errors(const Bench *bench, const Scheme *scheme, PetscReal accuracy, PetscInt *n,
                             PetscReal errors[])
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt i = 0; i < bench->n; i++) {
    LamResponse r;

    PetscCall(scheme->answer(scheme, &bench->truth[i].load, accuracy, &r));
    if (r.status == LAM_CONVERGED) errors[(*n)++] = StressError(r.P, bench->truth[i].P);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Row(const Bench *bench, const Scheme *scheme)
{
  PetscReal *errors, time;
  PetscInt n, wrong = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(bench->n, &errors));
  PetscCall(Errors(bench, scheme, PETSC_INFINITY, &n, errors));
  PetscCall(TimeOfAQuery(bench, scheme, scheme->estimates ? ACCURACY : PETSC_INFINITY, &time));
  printf("%-7s %6d  %5.1f %%  %8.3f %8.3f %8.3f %8.3f  %8.2f us", scheme->name, (int)scheme->solves,
         100.0 * n / bench->n, 100 * Quantile(errors, n, 0.5), 100 * Quantile(errors, n, 0.95),
         100 * Quantile(errors, n, 0.99), 100 * Quantile(errors, n, 1), 1e6 * time);
  if (scheme->estimates) {
    PetscCall(Errors(bench, scheme, ACCURACY, &n, errors));
    for (PetscInt i = 0; i < n; i++) wrong += errors[i] > ACCURACY;
    printf("  %5.1f %% %5.1f %%", 100.0 * n / bench->n, n ? 100.0 * wrong / n : 0.0);
  }
  printf("\n");
  fflush(stdout);
  PetscCall(PetscFree(errors));
  PetscFunctionReturn(0);
}

/* ---- solves ---- */

static PetscErrorCode Solve(Bench *bench, PetscInt n, const LamLoad loads[], LamResponse responses[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt point = -1;

    PetscCall(LamResponderRespond(bench->solver, 1, &loads[i], &point, &responses[i]));
  }
  PetscFunctionReturn(0);
}

/* States from number `first` of the sequence on. */
static PetscErrorCode SolveSamples(Bench *bench, PetscInt64 first, PetscInt n, LamResponse responses[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    LamLoad load;

    LamSampleLoad(bench->scene, PETSC_PI / 6, first + i, &load);
    PetscCall(Solve(bench, 1, &load, &responses[i]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveHeldOut(Bench *bench)
{
  const PetscInt n = bench->extent->states;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &bench->truth));
  PetscCall(SolveSamples(bench, HELD_OUT, n, bench->truth));
  bench->n = 0;
  for (PetscInt i = 0; i < n; i++)
    if (bench->truth[i].status == LAM_CONVERGED && !bench->truth[i].branch) bench->truth[bench->n++] = bench->truth[i];
  PetscFunctionReturn(0);
}

/* ---- scattered records ---- */

static PetscErrorCode CompareScattered(Bench *bench)
{
  Scheme linear = {.name = "linear", .answer = AnswerLinear};
  Scheme blend = {.name = "blend", .answer = RespondFromBlend, .estimates = PETSC_TRUE};

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseCreateEmpty(bench->scene, &linear.database));
  blend.database = linear.database;
  for (const PetscInt *count = bench->extent->counts; *count; count++) {
    const PetscInt more = *count - linear.solves;
    LamResponse *records;

    PetscCall(PetscMalloc1(more, &records));
    PetscCall(SolveSamples(bench, linear.solves, more, records));
    PetscCall(LamDatabaseAdd(linear.database, more, NULL, records));
    PetscCall(PetscFree(records));
    linear.solves = blend.solves = *count;
    PetscCall(Row(bench, &linear));
    PetscCall(Row(bench, &blend));
  }
  PetscCall(LamDatabaseClose(&linear.database));
  PetscFunctionReturn(0);
}

/* ---- the table ---- */

static int CompareKeys(const void *a, const void *b)
{
  const PetscInt64 x = *(const PetscInt64 *)a, y = *(const PetscInt64 *)b;

  return (x > y) - (x < y);
}

/* The nodes that the table lacks for the questions, each once; the caller frees them. */
static PetscErrorCode Lacking(const Bench *bench, LamTable table, PetscReal accuracy, PetscInt *count,
                              PetscInt64 **keys)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(bench->extent->questions * LAM_MAX_NEEDS, keys));
  for (PetscInt i = 0; i < bench->extent->questions; i++) {
    LamLoad load;
    PetscInt more;

    LamSampleLoad(bench->scene, PETSC_PI / 6, QUESTIONS + i, &load);
    PetscCall(LamTableNeeds(table, &load, accuracy, NULL, &more, *keys + n));
    n += more;
  }
  qsort(*keys, (size_t)n, sizeof(**keys), CompareKeys);
  *count = 0;
  for (PetscInt i = 0; i < n; i++)
    if (!i || (*keys)[i] != (*keys)[i - 1]) (*keys)[(*count)++] = (*keys)[i];
  PetscFunctionReturn(0);
}

static PetscErrorCode AddNodes(Bench *bench, LamDatabase database, PetscInt n, const PetscInt64 keys[])
{
  LamResponse *nodes;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(database, &grid));
  PetscCall(PetscMalloc1(n, &nodes));
  for (PetscInt i = 0; i < n; i++) {
    LamLoad load;

    PetscCall(LamGridNodeLoad(grid, keys[i], &load));
    PetscCall(Solve(bench, 1, &load, &nodes[i]));
  }
  PetscCall(LamDatabaseAdd(database, n, keys, nodes));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(0);
}

/* Rounds until nothing is lacking; *full: the number of solves has come to its end first. */
static PetscErrorCode Refine(Bench *bench, Scheme *scheme, PetscReal accuracy, PetscBool *full)
{
  PetscInt lacking = 1;

  PetscFunctionBeginUser;
  while (lacking && !*full) {
    PetscInt64 *keys;

    PetscCall(LamDatabaseGetTable(scheme->database, &scheme->table));
    PetscCall(Lacking(bench, scheme->table, accuracy, &lacking, &keys));
    PetscCall(LamTableDestroy(&scheme->table));
    *full = (PetscBool)(scheme->solves + lacking > bench->extent->most);
    if (!*full) {
      PetscCall(AddNodes(bench, scheme->database, lacking, keys));
      scheme->solves += lacking;
    }
    PetscCall(PetscFree(keys));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MeasureTable(Bench *bench)
{
  Scheme scheme = {.name = "table", .answer = AnswerTable, .estimates = PETSC_TRUE};
  PetscBool full = PETSC_FALSE;
  const LamResponse *records;
  const PetscInt64 *keys;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseCreateEmpty(bench->scene, &scheme.database));
  PetscCall(LamGridCreate(bench->scene, bench->solver, &grid));
  PetscCall(LamGridGetRecords(grid, &scheme.solves, &keys, &records));
  PetscCall(LamDatabaseAdd(scheme.database, scheme.solves, keys, records));
  PetscCall(LamDatabaseSetGrid(scheme.database, &grid));
  for (const PetscReal *accuracy = bench->extent->accuracies; *accuracy && !full; accuracy++) {
    PetscCall(Refine(bench, &scheme, *accuracy, &full));
    PetscCall(LamDatabaseGetTable(scheme.database, &scheme.table));
    PetscCall(Row(bench, &scheme));
    PetscCall(LamTableDestroy(&scheme.table));
  }
  PetscCall(LamDatabaseClose(&scheme.database));
  PetscFunctionReturn(0);
}

/* ---- one tissue ---- */

static PetscErrorCode Compare(const Tissue *tissue, const Extent *extent)
{
  const char *law = tissue->contact ? "law: contact, cohesion: 0.001 MPa" : "law: bonded";
  char text[sizeof(scene_text) + 100];
  Bench bench = {.extent = extent};
  LamScene *scene;
  LamRVE rve;

  PetscFunctionBeginUser;
  snprintf(text, sizeof(text), scene_text, 0.1 * tissue->ratio, law, tissue->contact ? 0.004 : 0.0,
           tissue->contact ? 0.059 : 0.05);
  PetscCall(LamSceneReadText("bench_query", text, &scene));
  PetscCall(NewTissue(&scene->micro, &rve, NULL));
  PetscCall(LamRVEResponderCreate(rve, 0, &bench.solver));
  bench.scene = scene;
  PetscCall(SolveHeldOut(&bench));
  printf("\n%s, C4/C1 = %g: %d held-out states, %d left out; %.0f ms a solve\n", tissue->contact ? "contact" : "bonded",
         (double)tissue->ratio, (int)bench.n, (int)(extent->states - bench.n),
         1e3 * LamResponderGetCounters(bench.solver).solve_seconds / extent->states);
  printf(
      "scheme  solves answers     P error %%: 50 %%, 95 %%, 99 %%, largest     a query     at 1 %%: answered, off\n");
  PetscCall(CompareScattered(&bench));
  PetscCall(MeasureTable(&bench));
  PetscCall(PetscFree(bench.truth));
  PetscCall(LamResponderDestroy(&bench.solver));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  static const Tissue tissues[] = {{10, PETSC_FALSE}, {100, PETSC_FALSE}, {10, PETSC_TRUE}, {100, PETSC_TRUE}};
  static const PetscInt few[] = {10, 30, 100, 0}, fewer[] = {10, 30, 0}, many[] = {10, 30, 100, 300, 1000, 0};
  static const PetscReal coarse[] = {0.03, 0.01, 0}, coarser[] = {0.1, 0}, fine[] = {0.1, 0.03, 0.01, 0.003, 0.001, 0};
  static const Extent quick[] = {{200, 200, few, coarse, 100}, {60, 100, fewer, coarser, 250}}; /* bonded, contact */
  static const Extent whole[] = {{2000, 2000, many, fine, 1000}, {200, 500, many, fine, 1000}};
  PetscBool full;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  full = HasOption("--full");
  for (size_t i = 0; i < sizeof(tissues) / sizeof(tissues[0]); i++)
    if (Compare(&tissues[i], &(full ? whole : quick)[tissues[i].contact])) return 1;
  return EndBench();
}
