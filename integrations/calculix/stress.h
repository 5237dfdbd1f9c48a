/*
  The same stress and tangent for each host, from P = first Piola-Kirchhoff stress and A_iJkL = dP_iJ/dF_kL.

  Components are in the order of both hosts, 11 22 33 12 13 23, of which each entry is one of the tensor (no factors of
  Voigt). F, P and A are row-major. NaN in A: unknown, of and by out-of-plane shears where F has none.
*/
#ifndef STRESS_H
#define STRESS_H

enum { SIX = 6 };

/* Second Piola-Kirchhoff stress S = F^-1 P and C = dS/dE, C_IJKL = F^-1_Ii F^-1_Kk (A_iJkL - delta_ik S_JL). */
void StressMaterial(const double F[9], const double P[9], const double A[81], double S[SIX], double C[SIX][SIX]);
/* Cauchy stress, and the Jaumann rate of the Kirchhoff stress over J by the rate of deformation: the tangent of Abaqus,
   F F F F C / J + (delta_ik s_jl + delta_il s_jk + delta_jk s_il + delta_jl s_ik) / 2. */
void StressSpatial(const double F[9], const double S[SIX], double C[SIX][SIX], double cauchy[SIX],
                   double jaumann[SIX][SIX]);

#endif
