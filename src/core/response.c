/*
  Responses: names, table of members, error norm.
*/
#include <lamella/response.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

const char *const LamStatusNames[] = {LAM_STATUSES(LAM_NAME_ENTRY) NULL};
const char *const LamSourceNames[] = {LAM_SOURCES(LAM_NAME_ENTRY) NULL};

#define AT(member) offsetof(LamResponse, member)
#define REAL(name, count, power, help) #name, LAM_MEMBER_REAL, count, AT(name), power, NULL, help, NULL, NULL
#define LOAD(name, count, power, help) #name, LAM_MEMBER_REAL, count, AT(load.name), power, NULL, help, NULL, NULL
#define IN(unit, name, help) #name, LAM_MEMBER_REAL, 1, AT(name), 0, NULL, help, unit, NULL
#define THREE(name, axes, power, unit, help) #name, LAM_MEMBER_REAL, 3, AT(name), power, NULL, help, unit, axes
#define INT(name, help) #name, LAM_MEMBER_INT, 1, AT(name), 0, NULL, help, NULL, NULL
#define FAMILY "face family"
#define PLACE "cell, face, share of the face"
#define SYMMETRIC "11 22 12"

const LamMember LamResponseMembers[] = {
    {LOAD(F, 9, 0, "deformation gradient")},
    {LOAD(turgor, 1, 1, "lumen pressure p")},
    {LOAD(cohesion, 1, 1, "suction g on separated outer walls")},
    {"status", LAM_MEMBER_ENUM, 1, AT(status), 0, LamStatusNames, "how the solve ended", NULL, NULL},
    {"source", LAM_MEMBER_ENUM, 1, AT(source), 0, LamSourceNames, "solve or database", NULL, NULL},
    {REAL(energy, 1, 1, "potential Psi per reference volume, turgor and cohesion included")},
    {REAL(P, 9, 1, "effective first Piola-Kirchhoff stress dPsi/dF")},
    {REAL(tangent, 81, 1, "effective tangent dP_ij/dF_kl, row ij, column kl")},
    {REAL(P_turgor, 9, 0, "dP/dp")},
    {REAL(energy_turgor, 1, 0, "dPsi/dp")},
    {REAL(energy_turgor2, 1, -1, "d2Psi/dp2")},
    {REAL(P_cohesion, 9, 0, "dP/dg")},
    {REAL(energy_cohesion, 1, 0, "dPsi/dg")},
    {REAL(energy_cohesion2, 1, -1, "d2Psi/dg2")},
    {REAL(energy_turgor_cohesion, 1, -1, "d2Psi/dpdg")},
    {REAL(turgor_mean, 1, 1, "pressure in the lumens, mean over the cells; of sealed cells that reached")},
    {REAL(turgor_spread, 1, 1, "its largest over the cells minus its smallest")},
    {IN("apothem", contact_width, "width of the smooth law of contact; 0: the exact law")},
    {REAL(contact_error, 1, 0, "relative change of P from that width to none, to first order")},
    {REAL(third_fraction, 1, 0, "share of the contact force between walls that do not face each other at rest")},
    {REAL(lumen_contact, 1, 0, "share of the contact force within lumens")},
    {REAL(lumen_fraction, 1, 0, "lumen volume over V0")},
    {REAL(opening_fraction, 1, 0, "gap volume over V0")},
    {THREE(opening_by_face, FAMILY, 0, NULL,
           "area between facing walls over V0, per face family, without junction voids")},
    {REAL(debonded_fraction, 1, 0, "share of the interface length without contact and lamella")},
    {THREE(debonded_by_face, FAMILY, 0, NULL, "the same per face family")},
    {REAL(open_fraction, 1, 0, "share of the interface length with a gap above 1e-3 apothems")},
    {THREE(open_by_face, FAMILY, 0, NULL, "the same per face family")},
    {REAL(debonded_spread, 1, 0, "change of debonded_fraction on a second mesh")},
    {REAL(open_spread, 1, 0, "change of open_fraction on a second mesh")},
    {IN("apothem", max_gap, "largest gap")},
    {THREE(gap_place, PLACE, 0, NULL, "where it is: cell, face, place along the face in [0, 1]")},
    {IN("apothem", min_gap, "smallest gap where no walls touch, else 0")},
    {IN("apothem", mean_gap, "mean gap over the interface length")},
    {IN("apothem", max_penetration, "largest pointwise penetration; falls with the mesh")},
    {THREE(fabric, SYMMETRIC, 0, NULL, "fabric tensor of the closed faces: 11, 22, 12")},
    {THREE(opening_moment, SYMMETRIC, 0, "apothem^2", "second moment of the jumps across open interfaces: 11, 22, 12")},
    {REAL(max_traction, 1, 1, "largest normal Cauchy traction averaged over one wall thickness")},
    {THREE(normal_place, PLACE, 0, NULL, "where: cell, face, place along the face in [0, 1]")},
    {REAL(max_lamella_shear, 1, 1, "largest shear traction averaged over one wall thickness, without sign")},
    {THREE(shear_place, PLACE, 0, NULL, "where, likewise")},
    {THREE(mean_face_traction, FAMILY, 1, NULL, "mean normal Cauchy traction per face family")},
    {REAL(max_fibre_stretch, 1, 0, "largest fibre stretch averaged over thickness and as long a stretch of a wall")},
    {REAL(max_wall_energy, 1, 1, "largest energy density of a wall without its volumetric part, likewise averaged")},
    {REAL(max_wall_tension, 1, 1, "largest stress along a wall plus the turgor of its cell, likewise averaged")},
    {THREE(wall_place, PLACE, 0, NULL, "where: cell, face 0 to 5, place along the face in [0, 1]")},
    {THREE(mean_wall_tension, FAMILY, 1, NULL,
           "mean stress along the walls plus the turgor of their cell, per face family")},
    {REAL(wall_ellipticity, 1, 1, "smallest stiffness of the wall material against shear bands, likewise averaged")},
    {REAL(kinked_fraction, 1, 0, "share of the walls' volume where that stiffness is negative at the point")},
    {REAL(lowest_eigenvalue, 1, 1, "softest mode, where it was computed")},
    {THREE(kink_place, PLACE, 0, NULL, "of wall_ellipticity: cell, face 0 to 5, place along the face in [0, 1]")},
    {REAL(ellipticity, 1, 1, "smallest stiffness of the tangent against a band; negative: the tissue localises")},
    {THREE(localisation_normal, "i", 0, NULL, "reference normal of that band, a unit vector")},
    {THREE(localisation_mode, "i", 0, NULL, "direction in which its sides move, a unit vector")},
    {INT(floating_cells, "cells without any contact or lamella")},
    {INT(zero_modes, "motions of cells that change no energy")},
    {INT(cell_clusters, "groups of cells that contact joins")},
    {INT(percolating_directions, "independent period directions that a group spans")},
    {INT(negative_eigenvalues, "of the consistent tangent")},
    {"stable", LAM_MEMBER_BOOL, 1, AT(stable), 0, NULL, "whether the state is stable", NULL, NULL},
    {"jumped", LAM_MEMBER_BOOL, 1, AT(jumped), 0, NULL, "whether the branch of the state before has ended", NULL, NULL},
    {REAL(energy_released, 1, 1, "energy Psi that a jump has lost")},
    {REAL(stored, 1, 1, "with a lamella: energy without what was dissipated")},
    {REAL(dissipated, 1, 1, "energy dissipated in the lamella and in walls so far, per V0")},
    {REAL(dissipated_walls, 1, 1, "in walls alone")},
    {REAL(released, 1, 1, "energy lost in jumps so far, per V0")},
    {REAL(work, 1, 1, "work of stress, turgor and suction so far, per V0: stored + dissipated + released")},
    {REAL(broken_fraction, 1, 0, "share of the lamella's fracture energy that is spent")},
    {THREE(broken_by_face, FAMILY, 0, NULL, "the same per face family")},
    {REAL(burst_fraction, 1, 0, "share of the cells that have burst")},
    {REAL(juice, 1, 0, "volume of their lumens over V0, when they burst")},
    {INT(crack_faces,
         "faces of the crack that runs from the notch of a patch, more than half of whose energy is spent")},
    {IN("apothem", crack_length, "how far it runs beyond the notch along X1")},
    {"indicators_trusted", LAM_MEMBER_BOOL, 1, AT(indicators_trusted), 0, NULL,
     "whether indicators of an interpolated response change little between the states around", NULL, NULL},
    {INT(branch, "number of branch switches on the way")},
    {INT(newton_iterations, "all Newton iterations of the state")},
    {INT(factorisations, "all factorisations of the state")},
    {INT(unknowns, "unknowns of the solve")},
    {IN("s", seconds, "time of the solve, s")},
    {REAL(error_estimate, 1, 0, "estimated relative error of P")},
    {REAL(tangent_error_estimate, 1, 0,
          "of an interpolated response: estimated relative error of its tangent in the plane")},
    {REAL(distance, 1, 0, "distance in strain to the record that responded")},
    {"reason", LAM_MEMBER_TEXT, sizeof(((LamResponse *)0)->reason), AT(reason), 0, NULL,
     "why the status is not converged", NULL, NULL},
    {NULL, LAM_MEMBER_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

PetscErrorCode LamResponseInit(const LamLoad *load, LamResponse *response)
{
  const LamLoad copy = *load; /* `load` may point into the response */

  PetscFunctionBeginUser;
  memset(response, 0, sizeof(*response));
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    PetscReal *value = (PetscReal *)((char *)response + m->offset);

    if (m->type != LAM_MEMBER_REAL) continue;
    for (PetscInt i = 0; i < m->count; i++) value[i] = NAN;
  }
  response->load = copy;
  response->status = LAM_NOT_CONVERGED;
  response->indicators_trusted = PETSC_TRUE;
  response->floating_cells = response->zero_modes = response->crack_faces = LAM_UNKNOWN_COUNT;
  response->cell_clusters = response->percolating_directions = LAM_UNKNOWN_COUNT;
  PetscFunctionReturn(0);
}

PetscBool LamResponseHasFields(const LamResponse *response)
{
  return (PetscBool)(response->status == LAM_CONVERGED || response->status == LAM_UNSTABLE);
}

void LamResponseScale(PetscReal stress, LamResponse *response)
{
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const PetscReal factor = m->stress_power == 1 ? stress : m->stress_power == -1 ? 1 / stress : 1;
    PetscReal *value = (PetscReal *)((char *)response + m->offset);

    if (m->type != LAM_MEMBER_REAL || factor == 1) continue;
    for (PetscInt i = 0; i < m->count; i++) value[i] *= factor;
  }
}

static PetscReal SizeInPlane(const PetscReal P[9])
{
  return sqrt(P[0] * P[0] + P[1] * P[1] + P[3] * P[3] + P[4] * P[4]);
}

PetscReal LamStressErrorOfSize(LamStressScale scale, PetscReal size, const PetscReal P_ref[9])
{
  return size / PetscMax(SizeInPlane(P_ref), scale.plane);
}

PetscReal LamStressError(LamStressScale scale, const PetscReal P[9], const PetscReal P_ref[9])
{
  PetscReal difference[9];

  for (PetscInt i = 0; i < 9; i++) difference[i] = P[i] - P_ref[i];
  return LamStressErrorOfSize(scale, SizeInPlane(difference), P_ref);
}

static PetscReal TangentSizeInPlane(const PetscReal A[81])
{
  PetscReal sum = 0;

  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) sum += PetscSqr(A[27 * i + 9 * j + 3 * k + l]);
  return sqrt(sum);
}

PetscReal LamTangentErrorOfSize(LamStressScale scale, PetscReal size, const PetscReal A_ref[81])
{
  return size / (TangentSizeInPlane(A_ref) + scale.plane);
}

PetscReal LamTangentError(LamStressScale scale, const PetscReal A[81], const PetscReal A_ref[81])
{
  PetscReal difference[81];

  for (PetscInt i = 0; i < 81; i++) difference[i] = A[i] - A_ref[i];
  return LamTangentErrorOfSize(scale, TangentSizeInPlane(difference), A_ref);
}

PetscReal LamAxialError(LamStressScale scale, const PetscReal P[9], const PetscReal P_ref[9])
{
  return fabs(P[8] - P_ref[8]) / PetscMax(fabs(P_ref[8]), scale.axial);
}

PetscReal LamWholeError(LamStressScale scale, const PetscReal P[9], const PetscReal P_ref[9])
{
  return PetscMax(LamStressError(scale, P, P_ref), LamAxialError(scale, P, P_ref));
}

size_t LamResponseMemberIndex(size_t offset)
{
  size_t k = 0;

  while (LamResponseMembers[k].offset != offset) k++;
  return k;
}
