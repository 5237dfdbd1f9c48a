/*
  Strong ellipticity of a tangent, and the critical band orientation (docs/theory/macro.md, Localisation).
*/
#ifndef LAMELLA_ELLIPTICITY_H
#define LAMELLA_ELLIPTICITY_H

#include <petscsys.h>
#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

/*
  In the plane: the minimum of m_i N_j A_ijkl m_k N_l over unit vectors N, the reference normal of a band, and m, the
  direction of the relative motion of its sides. Strongly elliptic: above 0. If several directions tie, as with
  symmetry, the first counter-clockwise from X1. Angles of N and m are in [0, 180) degrees.
*/
typedef struct {
  PetscReal value, normal[2], mode[2];
} LamBand;

/* A [2][2][2][2]: dP_ij/dF_kl with major symmetry. The result is NaN if an entry of A is. */
LAM_EXPORT void LamBandFind(const PetscReal A[16], LamBand *band);

/* Computes ellipticity, localisation_normal and localisation_mode from the tangent of the response. */
LAM_EXPORT void LamResponseFindBand(LamResponse *response);

/* True if ellipticity is lost beyond rounding: cells that float or spin freely have exactly 0. */
#define LAM_ELLIPTICITY_ROUNDING 1e-7 /* C1 + C2 */
static inline PetscBool LamEllipticityIsLost(PetscReal ellipticity)
{
  return (PetscBool)(ellipticity < -LAM_ELLIPTICITY_ROUNDING);
}

/* Angle of a direction in the plane from X1, degrees. */
LAM_EXPORT PetscReal LamBandAngle(const PetscReal direction[]);

LAM_C_END

#endif
