/*
  Queries to a database: to its table, else to the records outside the grid.

  Out-of-plane shear is in no record. A load is turned into the frame of the section, where G = (F31, F32) is what is
  left of it. Cells in contact slide freely along their axis, so that Psi does not depend on G. In bonded tissue a small
  G changes the components in the plane in second order only, and adds P_3a = mu G_a with the shear modulus of a
  honeycomb at rest, mu = (C1 + C2) w / (2 - w),  w = J - V_lumen / V0 - V_gap / V0 the walls' share of the volume,
  Hashin and Shtrikman's upper bound for anti-plane shear, 0 to 2 % above that of hexagons (A3131 at rest, 2t/l 0.06 to
  0.35). Fibres that are stretched or compressed make it 0.16 to 4 times as large: an error of P of at most 3 mu |G|.
*/
#include "database_internal.h"
#include <math.h>
#include "clock.h"
#include "section_frame.h"
#include <stdio.h>

static PetscErrorCode QueryScattered(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                                     LamResponse *response)
{
  const PetscReal start = LamClock();

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  if (LamLoadValidateInPlane(load, response)) PetscCall(LamScatterQuery(database, load, radius, accuracy, response));
  response->seconds = LamClock() - start;
  PetscFunctionReturn(0);
}

static PetscErrorCode QueryInPlane(LamDatabase database, const LamLoad *load, PetscReal accuracy, LamResponse *response)
{
  LamResponse scattered;
  LamTable table;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetTable(database, &table));
  if (!table) {
    PetscCall(QueryScattered(database, load, LAM_TRUST_RADIUS, accuracy, response));
    PetscFunctionReturn(0);
  }
  PetscCall(LamTableQuery(table, load, accuracy, response));
  PetscCall(LamTableDestroy(&table));
  if (response->status != LAM_OUT_OF_REACH || !database->scatter.n) PetscFunctionReturn(0);
  /* with a table, scattered records are states that it did not cover: each is used for its own state only */
  PetscCall(QueryScattered(database, load, 0, accuracy, &scattered));
  if (LamResponseHasFields(&scattered)) *response = scattered; /* else keep the table's reason */
  PetscFunctionReturn(0);
}

/* Of F13, F23, F31, F32: what iterations of a host leave in a body without such shear, 2e-5, with some room; and small
   enough that the error of mu is some 1e-4 of P. */
#define SMALL_SHEAR 1e-4

/* Fills what depends on G in the frame of the section. */
static void AddShear(const LamLoad *section, PetscReal mu, LamResponse *r)
{
  const PetscReal *F = section->F, G = hypot(F[6], F[7]);
  PetscReal P = 0;

  for (int a = 0; a < 2; a++) r->P[6 + a] = mu * F[6 + a];
  for (int k = 0; k < 9; k++)
    for (int a = 6; a < 8; a++) r->tangent[9 * k + a] = r->tangent[9 * a + k] = k == a ? mu : 0;
  LamSectionComplete(F, r->P, r->tangent);
  LamSectionCompleteStress(F, r->P_turgor);
  LamSectionCompleteStress(F, r->P_cohesion);
  for (int k = 0; k < 9; k++) P = hypot(P, r->P[k]);
  if (mu > 0) r->error_estimate += 3 * mu * G / P;
}

static PetscErrorCode RefuseShear(const LamLoad *load, PetscReal G, LamResponse *response)
{
  const PetscReal *F = load->F;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  response->status = LAM_OUT_OF_REACH;
  snprintf(response->reason, sizeof(response->reason),
           "F13 = %.3g, F23 = %.3g, F31 = %.3g, F32 = %.3g: out-of-plane shear of %.3g; the database answers up to %g; "
           "solve the scene",
           (double)F[2], (double)F[5], (double)F[6], (double)F[7], (double)G, SMALL_SHEAR);
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseQuery(LamDatabase database, const LamLoad *load, PetscReal accuracy, LamResponse *response)
{
  const LamMicrostructure *micro = &database->header.micro;
  const PetscBool slides = (PetscBool)(micro->interface == LAM_INTERFACE_CONTACT), tilt = LamWallsTilt(micro);
  const PetscReal *F = load->F;
  const PetscReal most = micro->interface == LAM_INTERFACE_LAMELLA || tilt ? 0 : slides ? PETSC_INFINITY : SMALL_SHEAR;
  LamLoad section, plane;
  PetscReal G;

  PetscFunctionBeginUser;
  if ((F[2] == 0 && F[5] == 0 && F[6] == 0 && F[7] == 0) || !(F[8] > 0)) {
    PetscCall(QueryInPlane(database, load, accuracy, response));
    PetscFunctionReturn(0);
  }
  plane = section = LamSectionLoad(load);
  plane.F[6] = plane.F[7] = 0;
  G = hypot(section.F[6], section.F[7]);
  if (!(G <= PetscMax(most, LAM_ROUNDED_F))) {
    PetscCall(RefuseShear(load, G, response));
    PetscFunctionReturn(0);
  }
  PetscCall(QueryInPlane(database, &plane, accuracy, response));
  if (LamResponseHasFields(response) && most > 0) {
    const PetscReal J = (plane.F[0] * plane.F[4] - plane.F[1] * plane.F[3]) * plane.F[8];
    const PetscReal walls = J - response->lumen_fraction - response->opening_fraction;

    AddShear(&section, slides ? 0 : walls / (2 - walls), response);
  }
  LamSectionTurnBack(load, response);
  PetscFunctionReturn(0);
}
