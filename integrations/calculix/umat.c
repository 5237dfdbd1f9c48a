/*
  The user subroutine UMAT of Abaqus/Standard (docs/reference/calculix.md): Cauchy stress, and the Jaumann rate of the
  Kirchhoff stress over J. Arguments are those of its interface, in the calling convention of Fortran.
*/
#include "stress.h"
#include "tissue.h"
#include <math.h>

__attribute__((visibility("default"))) void umat_(
    double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl, double *ddsddt,
    double *drplde, double *drpldt, const double *stran, const double *dstran, const double *time, const double *dtime,
    const double *temp, const double *dtemp, const double *predef, const double *dpred, const char *cmname,
    const int *ndi, const int *nshr, const int *ntens, const int *nstatv, const double *props, const int *nprops,
    const double *coords, const double *drot, double *pnewdt, const double *celent, const double *dfgrd0,
    const double *dfgrd1, const int *noel, const int *npt, const int *layer, const int *kspt, const int *kstep,
    const int *kinc, int length);

static void CheckArguments(const char *cmname, int length, int ndi, int nshr, int nstatv)
{
  length = TissueTrim(cmname, length);
  if (cmname[0] == '@')
    TissueFail("material %.*s: CalculiX takes stress in another frame from a UMAT; write @LAMELLAUMAT_CALCULIX@NAME",
               length, cmname);
  if (ndi != 3 || (nshr != 1 && nshr != 3))
    TissueFail("material %.*s: %d normal and %d shear components; take elements of plane strain, or solids", length,
               cmname, ndi, nshr);
  if (nstatv < TISSUE_VARIABLES)
    TissueFail("material %.*s: %d state variables; write *DEPVAR and %d below it", length, cmname, nstatv,
               TISSUE_VARIABLES);
}

/* In a step without NLGEOM Abaqus passes strains, but F = 1. */
static void CheckStrain(const char *cmname, int length, int ntens, const double F[9], const double stran[],
                        const double dstran[])
{
  double strain = 0, gradient = 0;

  for (int a = 0; a < ntens; a++) strain = fmax(strain, fabs(stran[a] + dstran[a]));
  for (int i = 0; i < 9; i++) gradient = fmax(gradient, fabs(F[i] - (i % 4 == 0)));
  if (strain > 0 && gradient == 0)
    TissueFail("material %.*s: strains of up to %g, but F = 1: write *STEP, NLGEOM=YES", TissueTrim(cmname, length),
               cmname, strain);
}

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
           const int *npt, const int *layer, const int *kspt, const int *kstep, const int *kinc, int length)
{
  double F0[9], F[9], S[SIX], C[SIX][SIX], cauchy[SIX], jaumann[SIX][SIX];
  const TissueLoad load = {.element = *noel, .point = *npt, .F0 = F0, .F = F, .turgor = *temp + *dtemp};
  TissueResponse response;
  Tissue tissue;

  CheckArguments(cmname, length, *ndi, *nshr, *nstatv);
  TissueGradient(dfgrd0, F0);
  TissueGradient(dfgrd1, F);
  CheckStrain(cmname, length, *ntens, F, stran, dstran);
  TissueRound(F0);
  TissueRound(F);
  tissue = TissueFind(cmname, length, *nprops, props);
  if (!TissueRespond(tissue, &load, statev, statev, &response)) {
    TissueReport(&load, time[1] + *dtime, response.reason);
    *pnewdt = 0.5;
    return;
  }
  StressMaterial(F, response.P, response.tangent, S, C);
  StressSpatial(F, S, C, cauchy, jaumann);
  for (int a = 0; a < *ntens; a++) {
    stress[a] = cauchy[a];
    for (int b = 0; b < *ntens; b++) ddsdde[a + *ntens * b] = jaumann[a][b];
  }
}
