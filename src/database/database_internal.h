/*
  Private to the database: what is in memory of the records, and what answers are made from.
*/
#ifndef LAM_DATABASE_INTERNAL_H
#define LAM_DATABASE_INTERNAL_H

#include "expansion.h"
#include "table.h"
#include "record_internal.h"

#define LAM_MAX_IMAGES 6

/* The rotations and mirrors that map the lattice to itself, acting on (c1, c2); image 0 is the identity. */
typedef struct {
  PetscInt count;
  PetscReal map[LAM_MAX_IMAGES][2][2];
  PetscInt face[LAM_MAX_IMAGES][3]; /* face family k of the question is family face[k] of the record */
} LamImages;

/* What a record may say of the states around it. */
typedef enum {
  LAM_SCATTER_BLENDS,  /* converged, stable, branch 0, all cells held */
  LAM_SCATTER_ALONE,   /* another branch, or cells that touch no one: its own state only */
  LAM_SCATTER_REFUSES, /* failed, unstable or without a tangent: nothing, but that something changes here */
} LamScatterUse;

typedef struct {
  LamScatterUse use;
  PetscInt images;    /* bit i: image i is there; those that fall on an earlier one are left out */
  LamExpansion model; /* x alone where `use` is LAM_SCATTER_REFUSES */
} LamScattered;

/* What all images of a state have in common: a scan over these is all that most states cost a query. */
typedef struct {
  PetscReal mean, deviator, turgor, cohesion; /* c0, |c1 + i c2|, p, g; mean infinite: not of plane strain */
} LamScatterPlace;

/* Records that are no nodes of a grid, in their order. */
typedef struct {
  PetscInt n, capacity;
  LamResponse *records;    /* [n] owned */
  LamScattered *states;    /* [n] owned */
  LamScatterPlace *places; /* [n] owned */
} LamScatter;

/*
  Records 0 .. n-1 are those of the file and, behind them, those added in memory. Of nodes of the grid the database
  keeps what the table needs, of all others the whole response; the whole responses of nodes in the file are loaded when
  LamDatabaseGetRecords first asks for them.
*/
struct LamDatabase_s {
  LamHeader header; /* owned; its `committed` is that of the file, not n */
  char *path;       /* owned; NULL: there is no file */
  LamImages images;
  PetscInt n, capacity;
  PetscInt64 *keys; /* [n] owned */

  LamNodeSet nodes;   /* records with the key of a node, in their order */
  LamScatter scatter; /* all other records */

  PetscInt records_first; /* the number of records in the file, until LamDatabaseGetRecords loads them; then 0 */
  PetscInt records_capacity;
  LamResponse *records; /* [n - records_first] owned: number records_first and on */
  char *info;           /* owned */

  LamGrid grid;   /* owned; NULL: records of no grid only */
  LamTable table; /* the newest, of table_count records; NULL: none yet */
  PetscInt table_count;
};

/* ---- images.c ---- */
void LamImagesMake(const LamMicrostructure *micro, LamImages *images);
/* y = M x: the question in the frame of the records. */
void LamImagesForward(const LamImages *images, PetscInt image, const PetscReal x[LAM_VARIABLES],
                      PetscReal y[LAM_VARIABLES]);
/* g <- M^T g, H <- M^T H M: derivatives in the records' frame, in the question's. */
void LamImagesBack(const LamImages *images, PetscInt image, PetscReal g[LAM_VARIABLES]);
void LamImagesBackHessian(const LamImages *images, PetscInt image, PetscReal H[LAM_VARIABLES][LAM_VARIABLES]);

/* ---- scatter.c ---- */
PetscErrorCode LamScatterAdd(LamScatter *scatter, const LamImages *images, PetscBool bonded, const LamResponse *record);
PetscErrorCode LamScatterDestroy(LamScatter *scatter);

/* ---- query_scatter.c ---- */
#define LAM_TRUST_RADIUS 0.04 /* strain: how far from the nearest record a blend is trusted */
#define LAM_OWN_STATE 1e-6    /* strain: a question so near to a record asks for the record's own state */
/*
  The answer to a good question from the scattered records, within `radius` (strain) of the nearest, into a response
  that LamResponseInit has cleared. Safe from several threads while nobody adds.
*/
PetscErrorCode LamScatterQuery(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                               LamResponse *response);

/* ---- query_indicators.c ---- */
/* `face`: the record's name of each face family of the question; `own`: the question is the record's own state. */
void LamIndicatorsCopy(const LamResponse *record, const PetscInt face[3], PetscBool own, LamInterfaceLawType interface,
                       LamResponse *r);

#endif
