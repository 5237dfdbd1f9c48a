#include "uneven_cells.h"

LamCell PlainCell(const LamMicrostructure *micro)
{
  return (LamCell){.wall_thickness = micro->wall_thickness,
                   .wall = micro->wall,
                   .turgor = 1.0,
                   .cohesion = 1.0,
                   .lamella_strength = 1.0,
                   .lamella_energy = 1.0};
}

/* A thick and a thin one, one without fibres, one with stiffer fibres in tension only; all with other factors. */
static void UnevenCells(const LamMicrostructure *micro, LamCell cells[UNEVEN_CELLS])
{
  static const double thickness[UNEVEN_CELLS] = {0.15, 0.2, 0.12, 0.18}, turgor[UNEVEN_CELLS] = {1.0, 1.4, 0.7, 0.9},
                      cohesion[UNEVEN_CELLS] = {1.0, 0.5, 1.5, 0.8};

  for (int k = 0; k < UNEVEN_CELLS; k++) {
    cells[k] = PlainCell(micro);
    cells[k].wall_thickness = thickness[k];
    cells[k].turgor = turgor[k];
    cells[k].cohesion = cohesion[k];
  }
  cells[2].wall.law = LAM_WALL_MOONEY_RIVLIN;
  cells[2].wall.C1 *= 2.0;
  cells[3].wall.fibres = LAM_FIBRES_TENSION;
  cells[3].wall.C4 *= 1.5;
}

LamMicrostructure UnevenTissue(PetscBool is_patch, LamInterfaceLawType interface, LamCell cells[UNEVEN_CELLS])
{
  LamMicrostructure micro = PatchTissue(2, 2, 10, interface);

  micro.is_patch = is_patch;
  micro.along = 4;
  UnevenCells(&micro, cells);
  micro.cell = cells;
  return micro;
}

LamLoad UnevenLoad(const LamMicrostructure *micro)
{
  LamLoad load = ContactLoad(1.02, 0.08, -0.03, 1.01, 0.02, 0);

  if (micro->interface == LAM_INTERFACE_CONTACT) load.cohesion = 0.005 / TISSUE_STRESS;
  return load;
}

void ListUnevenStates(LamCell cells[UNEVEN_CELLS], ContactState list[UNEVEN_STATES])
{
  static const char *const names[UNEVEN_STATES] = {"period, bonded", "period, contact", "patch, bonded",
                                                   "patch, contact"};

  for (int s = 0; s < UNEVEN_STATES; s++) {
    list[s] = (ContactState){.name = names[s], .step = CONTACT_STEP_LARGE_RVE};
    list[s].micro = UnevenTissue((PetscBool)(s / 2), s % 2 ? LAM_INTERFACE_CONTACT : LAM_INTERFACE_BONDED, cells);
    list[s].load = UnevenLoad(&list[s].micro);
  }
}
