#include "wall_memory.h"
#include "element_points.h"

LAM_CLONES static PetscReal ElementElastic(const LamElementGeometry *geometry, const LamWallLaw *law,
                                           const LamWall *wall, const PetscReal u[][2], PetscReal F33, PetscReal unit,
                                           LamMemoryPair *now)
{
  LamPoints H[4], F[4], dE[4], S[LAM_MEMORY_COMPONENTS], E[LAM_MEMORY_COMPONENTS], energy;
  PetscReal h[2][2];
  LamKernel1 fibre;
  LamKernel k;

  Gradient(geometry, u, H);
  law->matrix(wall, H, F33 - 1.0, PETSC_TRUE, &k);
  Fibres(geometry, law, wall, H, F33, &fibre);
  Deformation(H, F);
  StructureTensor(geometry, wall, h);
  FibreStrainGradient((const PetscReal(*)[2])h, F, dE);
  GreenStrain(H, F33 - 1.0, E);
  LAM_EACH_POINT(g)
  {
    const PetscReal over = 1.0 / (unit * (F[0][g] * F[3][g] - F[1][g] * F[2][g]));
    PetscReal P[4];

    for (PetscInt r = 0; r < 4; ++r) P[r] = k.P[r][g] + fibre.d[g] * dE[r][g];
    S[0][g] = over * (F[3][g] * P[0] - F[1][g] * P[2]); /* S = F^-1 P */
    S[1][g] = over * (F[3][g] * P[1] - F[1][g] * P[3]);
    S[2][g] = over * (F[0][g] * P[3] - F[2][g] * P[1]);
    S[3][g] = (k.P[4][g] / F33 + 2.0 * wall->dispersion * fibre.d[g]) / unit;
    energy[g] = geometry->weight[g] * (k.W[g] + fibre.W[g]);
  }
  for (PetscInt c = 0; c < LAM_MEMORY_COMPONENTS; ++c)
    for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
      now->S[c][g] = S[c][g];
      now->E[c][g] = E[c][g];
    }
  return Total(energy);
}

PetscReal LamElementElastic(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                            const PetscReal u[][2], PetscReal F33, PetscReal unit, LamMemoryPair *now)
{
  return ElementElastic(geometry, law, wall, u, F33, unit, now);
}

void LamMemoryHistory(const LamMemoryStep *step, const LamMemoryPair past[], PetscReal unit,
                      LamPoints history[LAM_MEMORY_COMPONENTS])
{
  for (PetscInt c = 0; c < LAM_MEMORY_COMPONENTS; ++c) {
    LAM_EACH_POINT(g) history[c][g] = 0.0;
    for (PetscInt i = 0; i < step->terms; ++i)
      for (PetscInt g = 0; g < LAM_GAUSS; ++g)
        history[c][g] +=
            unit * (step->decay[i] * past[1 + i].S[c][g] - step->share[i] * step->phi[i] * past[0].S[c][g]);
  }
}

void LamMemoryAdvance(const LamMemoryStep *step, const LamElementGeometry *geometry, const LamMemoryPair past[],
                      const LamMemoryPair *now, PetscReal unit, LamMemoryPair next[], LamMemoryWork *work)
{
  static const PetscReal count[LAM_MEMORY_COMPONENTS] = {1.0, 2.0, 1.0, 1.0}; /* of a component in S : E */

  *work = (LamMemoryWork){0};
  next[0] = *now;
  for (PetscInt i = 0; i < step->terms; ++i) {
    const PetscReal share = step->share[i], decay = step->decay[i], phi = step->phi[i], *loss = step->loss[i];

    for (PetscInt c = 0; c < LAM_MEMORY_COMPONENTS; ++c)
      for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
        const PetscReal w = unit * count[c] * geometry->weight[g];
        const PetscReal S = past[0].S[c][g], H = past[1 + i].S[c][g], E = past[1 + i].E[c][g];
        const PetscReal dS = share * (now->S[c][g] - S), dE = now->E[c][g] - past[0].E[c][g];

        next[1 + i].S[c][g] = decay * H + phi * dS;
        next[1 + i].E[c][g] = decay * E + phi * dE;
        work->retarded += w * (phi * H + step->psi[i] * dS - (share * S + 0.5 * dS)) * dE;
        work->dissipated += w * (loss[0] * H * E + loss[1] * (H * dE + dS * E) + loss[2] * dS * dE);
        work->history += w * (decay * H - phi * share * S) * now->E[c][g];
      }
  }
}
