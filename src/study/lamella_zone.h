/*
  Whether the mesh resolves how a lamella breaks: with elements longer than its process zone tissue is stronger and
  breaks in jumps from node to node.
*/
#ifndef LAM_LAMELLA_ZONE_H
#define LAM_LAMELLA_ZONE_H

#include "study.h"

/* Least number of elements along a face that resolve it, a third of the zone each; 1 with other laws. */
PetscInt LamZoneAlong(const LamMicrostructure *micro, PetscReal grading);
#define LAM_ZONE_TEXT 320
/* One sentence if elements along a face are longer than a third of the zone (LamLamellaZone), with the number that is
   enough; else, and with other laws, empty. `micro` has its mesh. */
void LamZoneWarning(const LamMicrostructure *micro, const LamScales *scales, char text[LAM_ZONE_TEXT]);
/* Reports it as a warning on rank 0. */
void LamWarnOfZone(MPI_Comm comm, const LamReporter *reporter, const LamMicrostructure *micro, const LamScales *scales);

#endif
