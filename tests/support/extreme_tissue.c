#include "extreme_tissue.h"

void ListExtremes(Extreme list[EXTREMES])
{
  static const char *const names[3] = {"shear 1.0", "stretch 1.5", "compression 0.9 x 1.05"};

  for (int k = 0; k < EXTREMES; k++) {
    const double turgor = k % 2 == 0 ? 0.0 : 0.02 / TISSUE_STRESS;

    list[k].name = names[k / 2];
    list[k].load = k / 2 == 0 ? PlaneLoad(1, 1, 0, 1, turgor)
                              : (k / 2 == 1 ? PlaneLoad(1.5, 0, 0, 1, turgor) : PlaneLoad(0.9, 0, 0, 1.05, turgor));
  }
}
