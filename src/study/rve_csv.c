/*
  The table of a run of the RVE for spreadsheets: OUT.csv beside OUT.h5, one line per state, units in the head.
*/
#include "rve_run.h"
#include <math.h>

/* Columns of every state r at F and P; with a curve those of its point p follow. */
#define COLUMNS(X)                                                                                                     \
  X("F11", F[0])                                                                                                       \
  X("F12", F[1])                                                                                                       \
  X("F21", F[3])                                                                                                       \
  X("F22", F[4])                                                                                                       \
  X("F33", F[8])                                                                                                       \
  X("turgor (MPa)", (r->load.turgor) * MPa)                                                                            \
  X("cohesion (MPa)", (r->load.cohesion) * MPa)                                                                        \
  X("P11 (MPa)", P[0] * MPa)                                                                                           \
  X("P12 (MPa)", P[1] * MPa)                                                                                           \
  X("P21 (MPa)", P[3] * MPa)                                                                                           \
  X("P22 (MPa)", P[4] * MPa)                                                                                           \
  X("P33 (MPa)", P[8] * MPa)                                                                                           \
  X("turgor_mean (MPa)", (r->turgor_mean) * MPa)                                                                       \
  X("lumen_fraction", r->lumen_fraction)                                                                               \
  X("opening_fraction", r->opening_fraction)                                                                           \
  X("debonded_fraction", r->debonded_fraction)                                                                         \
  X("open_fraction", r->open_fraction)                                                                                 \
  X("max_gap (apothem)", r->max_gap)                                                                                   \
  X("max_traction (MPa)", (r->max_traction) * MPa)                                                                     \
  X("error_estimate", r->error_estimate)
/* Those of law `lamella`. */
#define LAMELLA_COLUMNS(X)                                                                                             \
  X("broken_fraction", r->broken_fraction)                                                                             \
  X("burst_fraction", r->burst_fraction)                                                                               \
  X("juice", r->juice)                                                                                                 \
  X("stored (kJ/m^3)", (r->stored) * MPa * 1e3)                                                                        \
  X("dissipated (kJ/m^3)", (r->dissipated) * MPa * 1e3)                                                                \
  X("dissipated_walls (kJ/m^3)", (r->dissipated_walls) * MPa * 1e3)                                                    \
  X("released (kJ/m^3)", (r->released) * MPa * 1e3)
/* Those of walls with memory. */
#define MEMORY_COLUMNS(X)                                                                                              \
  X("time (s)", run->time)                                                                                             \
  X("work (kJ/m^3)", (r->work) * MPa * 1e3)                                                                            \
  X("stored (kJ/m^3)", (r->stored) * MPa * 1e3)                                                                        \
  X("dissipated (kJ/m^3)", (r->dissipated) * MPa * 1e3)
/* Those of a patch with a notch. */
#define CRACK_COLUMNS(X)                                                                                               \
  X("crack_faces", (PetscReal)r->crack_faces)                                                                          \
  X("crack_length (um)", (r->crack_length) * run->scene->scales.length * 1e6)
#define CURVE_COLUMNS(X)                                                                                               \
  X("strain", p->strain)                                                                                               \
  X("stress (MPa)", (p->stress) * MPa)                                                                                 \
  X("modulus (MPa)", (p->modulus) * MPa)                                                                               \
  X("poisson", p->poisson)                                                                                             \
  X("energy (kJ/m^3)", (p->energy) * MPa * 1e3)

#define PRINT_NAME(name, value) fputs("," name, out);
#define COMMA_NAME(name, value) "," name
#define NAME(name, value) name,
#define PRINT_VALUE(name, value) LamBesideNumber(out, value);

static const char *const MoreColumns[] = {LAMELLA_COLUMNS(NAME) MEMORY_COLUMNS(NAME) CRACK_COLUMNS(NAME)
                                              CURVE_COLUMNS(NAME) NULL};
const LamTextKind LamRVETable = {.what = "a table of lamella rve",
                                 .ending = ".csv",
                                 .begins = "state,status" COLUMNS(COMMA_NAME),
                                 .columns = MoreColumns};

static PetscBool HasLamella(const LamRVERun *run)
{
  return (PetscBool)(run->scene->micro.interface == LAM_INTERFACE_LAMELLA);
}

PetscErrorCode LamRVECSVOpen(LamRVERun *run)
{
  FILE *out;

  PetscFunctionBeginUser;
  PetscCall(LamBesideOpen(run->out_path, &LamRVETable, &run->csv));
  out = run->csv.out;
  fputs(LamRVETable.begins, out);
  if (HasLamella(run)) {
    LAMELLA_COLUMNS(PRINT_NAME)
  }
  if (LamWallsRelax(&run->scene->micro)) {
    MEMORY_COLUMNS(PRINT_NAME)
  }
  if (run->scene->micro.notch_columns) {
    CRACK_COLUMNS(PRINT_NAME)
  }
  if (run->readings) {
    CURVE_COLUMNS(PRINT_NAME)
  }
  fputc('\n', out);
  PetscFunctionReturn(0);
}

void LamRVECSVAdd(LamRVERun *run, const LamResponse *r)
{
  const LamTestPoint none = {0, NAN, NAN, NAN, NAN, NAN, NAN, PETSC_FALSE};
  const LamTestPoint *last = run->test.count ? &run->test.points[run->test.count - 1] : &none;
  const LamTestPoint *p = last->state == run->solved ? last : &none;
  const PetscReal MPa = run->scene->scales.stress * 1e-6;
  FILE *out = run->csv.out;
  PetscReal F[9], P[9];

  LamTestMeasures(&run->test, r, F, P);
  fprintf(out, "%d,%s", (int)run->solved, LamStatusNames[r->status]);
  COLUMNS(PRINT_VALUE)
  if (HasLamella(run)) {
    LAMELLA_COLUMNS(PRINT_VALUE)
  }
  if (LamWallsRelax(&run->scene->micro)) {
    MEMORY_COLUMNS(PRINT_VALUE)
  }
  if (run->scene->micro.notch_columns) {
    CRACK_COLUMNS(PRINT_VALUE)
  }
  if (run->readings) {
    CURVE_COLUMNS(PRINT_VALUE)
  }
  fputc('\n', out);
}
