/*
  The gap k X2 - (3 k / 4) X2^(4/3) between two walls side by side, fibres along X2, as Section 3 of Mihai, Safar &
  Wyatt has it, against equilibrium and the contact conditions (docs/paper.md): the left wall in generalised shear with
  sigma12 = a X2, the right one in simple shear k, touching at X2 = 0. a is chosen so that both shears are k at X2 = 1.
*/
#ifndef LAM_FIGURES_GAP_H
#define LAM_FIGURES_GAP_H

#include "shear_exact.h"

#define GAP_PSI 1.57079632679489662

typedef struct {
  double ratio;  /* (C1 + C2) / (C4 k^2): 0 where the power 4/3 is the solution of the cubic */
  double gap;    /* at X2 = 1, over k; the paper's: 1/4 */
  double shear;  /* shear traction on both faces at X2 = 1, which has to be 0 */
  double spread; /* normal traction on the left face at X2 = 0 less that at X2 = 1, which has to be 0 */
  double scale;  /* sigma12 at X2 = 1 */
} Gap;

static inline Gap ComputeGap(const LamWall *wall, double k)
{
  const double a = ShearFlow(wall, GAP_PSI, k), f = ShearProfile(wall, GAP_PSI, a, 0.0, 1.0);
  const double p0 = ShearPressure(wall, GAP_PSI, 0.0, 0.0), p1 = ShearPressure(wall, GAP_PSI, k, -a * f);

  return (Gap){.ratio = (wall->C1 + wall->C2) / (wall->C4 * k * k),
               .gap = 1.0 - f / k,
               .shear = InterfaceShear(wall, GAP_PSI, k),
               .spread = InterfaceNormal(wall, GAP_PSI, 0.0, p0) - InterfaceNormal(wall, GAP_PSI, k, p1),
               .scale = a};
}

#endif
