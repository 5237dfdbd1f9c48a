/* Tissue whose cells differ, for tests: four cells with walls, thickness, turgor and cohesion of their own. */
#ifndef LAM_SUPPORT_UNEVEN_CELLS_H
#define LAM_SUPPORT_UNEVEN_CELLS_H

#include "cell_patch.h"

#define UNEVEN_CELLS 4
/* The cell that is like all of the tissue. */
LamCell PlainCell(const LamMicrostructure *micro);
/* 2 x 2 cells, in a period or between grips; borrows `cells`. */
LamMicrostructure UnevenTissue(PetscBool is_patch, LamInterfaceLawType interface, LamCell cells[UNEVEN_CELLS]);

/* ---- derivatives ---- */

#define UNEVEN_STATES 4
/* Partly open, where it may open. */
LamLoad UnevenLoad(const LamMicrostructure *micro);
/* Periodic and between grips, bonded (even numbers) and in contact; borrows `cells`. */
void ListUnevenStates(LamCell cells[UNEVEN_CELLS], ContactState list[UNEVEN_STATES]);

#endif
