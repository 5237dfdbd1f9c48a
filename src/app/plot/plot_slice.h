/*
  Private to the picture of a table: the data of a slice through it.
*/
#ifndef LAM_PLOT_SLICE_H
#define LAM_PLOT_SLICE_H

#include "plot.h"

/* Result of the query at a point of the slice. */
typedef enum {
  LAM_SLICE_RESPONDS,
  LAM_SLICE_FLOATING,   /* response: floating cells */
  LAM_SLICE_INACCURATE, /* no response to the accuracy, but one without accuracy limit */
  LAM_SLICE_KINK,       /* a change of branch, a loss of contact or a failed node nearby */
  LAM_SLICE_NOTHING,    /* no nodes around: outside the grid, or not queried yet */
  LAM_SLICE_VERDICT_COUNT
} LamSliceVerdict;

/* Quantities drawn, one panel each. */
typedef enum {
  LAM_SLICE_POTENTIAL, /* MPa */
  LAM_SLICE_STRESS,    /* MPa */
  LAM_SLICE_ERROR,     /* log10 of per cent */
  LAM_SLICE_INDICATOR, /* per cent: gaps of contact tissue, lumens of bonded tissue */
  LAM_SLICE_PANEL_COUNT
} LamSlicePanel;

typedef enum { LAM_SLICE_SOUND, LAM_SLICE_BUCKLED, LAM_SLICE_UNSOLVED, LAM_SLICE_NODE_KINDS } LamSliceNodeKind;
typedef struct {
  PetscReal at[2]; /* e1, e2 */
  PetscInt level;  /* of refinement, 0: coarsest */
  LamSliceNodeKind kind;
} LamSliceNode;

#define LAM_SLICE_SAMPLES 180 /* per axis */

/* Samples lie at the middles of equal cells of the square [low, high]^2, e1 fastest. */
typedef struct {
  PetscReal low, high;
  PetscReal box[2];              /* smallest and largest strain of the scene's sample; NaN: it has none */
  PetscReal orientation, angle;  /* of face normal 0 to X1, of the first principal axis to that normal; radian */
  LamInterfaceLawType interface; /* of the tissue */
  PetscReal turgor, cohesion;    /* MPa */
  PetscReal node_suction;        /* MPa, of the nodes drawn: nearest to that of the slice */
  PetscReal accuracy;            /* of the queries */
  LamSliceVerdict *verdict;      /* [sample]; owned */
  PetscReal *value[LAM_SLICE_PANEL_COUNT]; /* [sample], NaN without response; owned */
  PetscInt count[LAM_SLICE_VERDICT_COUNT]; /* samples of each verdict */
  PetscInt table_nodes;                    /* of the whole table */
  PetscInt node_count;
  LamSliceNode *nodes; /* within `reach` of the slice, images under the lattice's symmetry included; owned */
  PetscReal reach;     /* strain */
} LamSlice;

/* Principal logarithmic strains e1 >= e2 of the plane, and the angle of the first to X1 before the deformation. */
void LamPrincipalStrains(const PetscReal F[9], PetscReal strain[2], PetscReal *angle);

/* The norm of the known components. */
PetscReal LamStressNorm(const PetscReal P[9]);

/* ---- plot_slice.c: PETSC_ERR_USER_INPUT if the request does not fit the table ---- */
/* Rejects a request that chooses a slice if there is no table. */
PetscErrorCode LamSliceRefuse(const LamPlotRequest *request);
PetscErrorCode LamSliceRead(const LamPlotRequest *request, LamDatabase database, LamSlice *slice);
PetscErrorCode LamSliceDestroy(LamSlice *slice);
PetscReal LamSliceStrain(const LamSlice *slice, PetscInt i); /* of sample i of an axis */

/* ---- plot_table.c ---- */
PetscErrorCode LamPlotTable(const LamPlotRequest *request, LamDatabase database);

#endif
