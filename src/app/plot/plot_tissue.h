/*
  Cells in a picture: the deformed tissue of one state of an RVE, with its periodic images.
*/
#ifndef LAM_PLOT_TISSUE_H
#define LAM_PLOT_TISSUE_H

#include "plot.h"

typedef struct {
  const char *name, *label, *unit; /* name: of the dataset and of --field */
} LamWallField;
/* The field of this name; NULL: the first. PETSC_ERR_USER_INPUT if there is none. */
PetscErrorCode LamWallFieldFind(const char name[], const LamWallField **field);

typedef struct {
  PetscReal F[9];
  PetscInt node_count, element_count;
  PetscReal *nodes, *x, *values; /* [node][2], [node][2], [node]; owned */
  PetscInt *elements, *cell_of;  /* owned */
  PetscReal *period;             /* [2][2], rows, reference; owned */
  LamOutline outline;            /* loops per cell: walls outside, lumens inside */
  PetscBool has_interface;       /* contact tissue */
  LamInterface interface;
} LamTissue;

/* Reads the mesh in the group `mesh` ("/mesh") of the file and a state's fields in the group `fields` ("/fields/3").
   PETSC_ERR_USER_INPUT if the file lacks them. */
PetscErrorCode LamTissueRead(const char path[], const char mesh[], const char fields[], const LamWallField *field,
                             PetscBool has_interface, const PetscReal F[9], LamTissue *tissue);
PetscErrorCode LamTissueDestroy(LamTissue *tissue);
/* A patch has no period. */
PetscBool LamTissueIsPeriodic(const LamTissue *tissue);
/* Computes the shift of the reference for which both centroids coincide: a translation has no meaning in a periodic
   tissue. */
void LamTissueCentreReference(const LamTissue *tissue, PetscReal shift[2]);
/* Apothems around cells in a picture: the nearest neighbours are visible; of contact tissue a smaller part of them, to
   show the gaps larger. */
#define LAM_MARGIN 1.1
#define LAM_CONTACT_MARGIN 0.5
/* Draws lumens, walls with their field, outlines, all inside the frame of the view. `reference`: shift of the
   undeformed outline; NULL: it is not drawn. */
PetscErrorCode LamTissueDraw(LamCanvas canvas, const LamView *view, const LamTissue *tissue,
                             const LamColourRange *range, const PetscReal reference[2]);
/* ---- plot_cells.c: states of a file whose cells it holds ---- */
typedef struct {
  const char *path;         /* borrowed, as the next */
  const LamPlotRecords *of; /* all states of the file */
  const LamWallField *field;
  PetscInt count, *states; /* indices in `of`; owned */
  LamFrame frame;
  PetscReal pressure; /* the largest contact pressure */
  PetscBool has_lamella;
  PetscBool is_periodic; /* the tissue */
} LamCells;
/* Finds the states; `state`: the number of the only one, LAM_PLOT_LAST, or LAM_PLOT_PEAK for all. */
PetscErrorCode LamCellsFind(const char path[], const LamPlotRecords *of, const char field[], PetscInt state,
                            LamCells *cells);
/* Keeps as many as a strip has panels. peak: index in `of`. */
void LamCellsChoose(LamCells *cells, PetscInt peak);
/* Sets window and colours common to the states; reads number k of them. */
PetscErrorCode LamCellsShare(LamCells *cells);
PetscErrorCode LamCellsRead(const LamCells *cells, PetscInt k, LamTissue *tissue);
/* Draws number k; scale bar and legend below it. */
PetscErrorCode LamCellsDraw(LamCanvas canvas, const LamView *view, const LamCells *cells, PetscInt k);
void LamCellsKey(LamCanvas canvas, const LamView *view, const LamCells *cells);
PetscErrorCode LamCellsDestroy(LamCells *cells);

/* Strokes the current path with the dashes used for undeformed outlines; the legend of these, at the right
   between `left` and `right`. */
void LamStrokeUndeformed(LamCanvas canvas);
void LamUndeformedKey(LamCanvas canvas, double left, double right, double y, const char label[]);

#endif
