/*
  Reference
    Turon, Davila, Camanho & Costa, Eng. Fracture Mech. 74 (2007) 1665: three elements in the zone.
*/
#include "lamella_zone.h"
#include <math.h>

#define IN_ZONE 3      /* elements */
#define MOST_ALONG 200 /* that a scene may have */

/* A face over the number of its elements, in its middle if they are graded. */
static PetscReal LongestEdge(PetscInt along, PetscReal grading)
{
  return 2.0 / sqrt(3.0) * (1.0 + PetscMax(0.0, grading)) / (PetscReal)along;
}

PetscInt LamZoneAlong(const LamMicrostructure *micro, PetscReal grading)
{
  if (micro->interface != LAM_INTERFACE_LAMELLA) return 1;
  return (PetscInt)PetscMin(MOST_ALONG + 1.0, ceil(IN_ZONE * LongestEdge(1, grading) / LamLamellaZone(micro)));
}

void LamZoneWarning(const LamMicrostructure *micro, const LamScales *scales, char text[LAM_ZONE_TEXT])
{
  const PetscInt least = LamZoneAlong(micro, micro->grading);
  const PetscReal um = 1e6 * scales->length;
  char remedy[80];

  text[0] = '\0';
  if (micro->along >= least) return;
  if (least <= MOST_ALONG)
    snprintf(remedy, sizeof(remedy), "write rve.mesh.along: %d or more", (int)least);
  else
    snprintf(remedy, sizeof(remedy), "no mesh resolves it; a smaller strength or a larger fracture_energy is needed");
  snprintf(text, LAM_ZONE_TEXT,
           "elements of up to %.3g um along a face do not resolve how the lamella breaks, over about %.3g um: tissue "
           "will seem too strong; %s",
           (double)(LongestEdge(micro->along, micro->grading) * um), (double)(LamLamellaZone(micro) * um), remedy);
}

void LamWarnOfZone(MPI_Comm comm, const LamReporter *reporter, const LamMicrostructure *micro, const LamScales *scales)
{
  char text[LAM_ZONE_TEXT];

  LamZoneWarning(micro, scales, text);
  if (text[0] && LamIsFirst(comm)) LamReportWarning(reporter, "%s", text);
}
