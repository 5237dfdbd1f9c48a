/*
  A material of CalculiX, @LAMELLAUMAT_CALCULIX@NAME (docs/reference/calculix.md): the function that it calls for each
  material point in each iteration, with the arguments of umat_user.f of its sources.
*/
#include "stress.h"
#include "tissue.h"
#include <math.h>
#include <string.h>

enum { NAME = 80, ELASTIC_ITERATION = 1 };

/* Strains of CalculiX are those of F, by the same numbers, up to rounding; where they differ by more, it is linear (no
   NLGEOM) or subtracts strains. A gradient of u below the root of this number is not told from a linear one. */
static const double STRAIN_ROUNDING = 1e-10;

__attribute__((visibility("default"))) void CALCULIX(
    const char *amat, const int *iel, const int *iint, const int *kode, const double *elconloc, const double *emec,
    const double *emec0, const double *beta, const double *xokl, const double *voj, const double *xkl, const double *vj,
    const int *ithermal, const double *t1l, const double *dtime, const double *time, const double *ttime,
    const int *icmd, const int *ielas, const int *mi, const int *nstate_, const double *xstateini, double *xstate,
    double *stre, double *stiff, const int *iorien, const double *pgauss, const double *orab, double *pnewdt,
    const int *ipkon, int size);

/* What CalculiX passes that tissue has no use for, or needs. */
static void CheckArguments(const char *amat, int variables, int thermal, int orientation, const double beta[SIX])
{
  const int length = TissueTrim(amat, NAME);

  if (variables < TISSUE_VARIABLES)
    TissueFail("material %.*s: %d state variables; write *DEPVAR and %d below it", length, amat, variables,
               TISSUE_VARIABLES);
  if (!thermal)
    TissueFail("material %.*s: temperature is turgor: write *INITIAL CONDITIONS, TYPE=TEMPERATURE (0 for tissue at "
               "rest), and *TEMPERATURE in the steps",
               length, amat);
  if (orientation)
    TissueFail("material %.*s: *ORIENTATION: cells lie as their scene says, turn the body instead", length, amat);
  for (int a = 0; a < SIX; a++)
    if (beta[a] != 0) TissueFail("material %.*s: initial stress: tissue has that of its turgor alone", length, amat);
}

static void CheckStrain(const char *amat, const double F[9], const double strain[SIX])
{
  static const int first[SIX] = {0, 1, 2, 0, 0, 1}, second[SIX] = {0, 1, 2, 1, 2, 2};

  for (int a = 0; a < SIX; a++) {
    double E = first[a] == second[a] ? -0.5 : 0;

    for (int i = 0; i < 3; i++) E += F[3 * i + first[a]] * F[3 * i + second[a]] / 2;
    if (!(fabs(E - strain[a]) <= STRAIN_ROUNDING * (1 + fabs(E))))
      TissueFail(
          "material %.*s: the strain %d%d is %g, that of F is %g: write *STEP, NLGEOM, and neither *EXPANSION nor "
          "initial strains",
          TissueTrim(amat, NAME), amat, first[a] + 1, second[a] + 1, strain[a], E);
  }
}

static void Return(const double F[9], const TissueResponse *response, double stre[SIX], double stiff[])
{
  double C[SIX][SIX];

  StressMaterial(F, response->P, response->tangent, stre, C);
  for (int b = 0, k = 0; b < SIX; b++)
    for (int a = 0; a <= b; a++) stiff[k++] = C[a][b];
}

/*
  In an elastic iteration, the first of an increment, CalculiX moves its prescribed displacements alone and wants the
  tangent at the start of the increment, from which it makes the stress itself: so the response is that of the start, as
  it is where the end has none, so that what CalculiX holds until it cuts back are numbers.
*/
void CALCULIX(const char *amat, const int *iel, const int *iint, const int *kode, const double *elconloc,
              const double *emec, const double *emec0, const double *beta, const double *xokl, const double *voj,
              const double *xkl, const double *vj, const int *ithermal, const double *t1l, const double *dtime,
              const double *time, const double *ttime, const int *icmd, const int *ielas, const int *mi,
              const int *nstate_, const double *xstateini, double *xstate, double *stre, double *stiff,
              const int *iorien, const double *pgauss, const double *orab, double *pnewdt, const int *ipkon, int size)
{
  const size_t place = (size_t)*nstate_ * ((size_t)(*iint - 1) + (size_t)*mi * (size_t)(*iel - 1));
  const double *begin = &xstateini[place];
  double F[9], start[9];
  TissueResponse response;
  TissueLoad load = {.element = *iel, .point = *iint, .F0 = start, .F = F, .turgor = *t1l};
  Tissue tissue;

  CheckArguments(amat, *nstate_, *ithermal, *iorien, beta);
  tissue = TissueFind(amat, NAME, -*kode - 100, elconloc);
  TissueGradient(xokl, start);
  TissueRound(start);
  if (*ielas != ELASTIC_ITERATION) {
    TissueGradient(xkl, F);
    CheckStrain(amat, F, emec);
    TissueRound(F);
    if (TissueRespond(tissue, &load, begin, &xstate[place], &response)) {
      Return(F, &response, stre, stiff);
      return;
    }
    TissueReport(&load, *ttime + *time, response.reason);
    *pnewdt = 0.5;
  }
  memcpy(&xstate[place], begin, TISSUE_VARIABLES * sizeof(*begin));
  load.F = start;
  load.turgor = begin[TISSUE_TURGOR];
  if (!TissueRespond(tissue, &load, begin, NULL, &response))
    TissueFail("material %.*s, element %d, point %d: no response at the start of the increment, F = %.6g %.6g %.6g "
               "%.6g, turgor %.6g: %s",
               TissueTrim(amat, NAME), amat, *iel, *iint, start[0], start[1], start[3], start[4], load.turgor,
               response.reason);
  Return(start, &response, stre, stiff);
}
