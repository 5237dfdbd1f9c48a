/*
  Private to the database: the records in memory and the data that queries use.
*/
#ifndef LAM_DATABASE_INTERNAL_H
#define LAM_DATABASE_INTERNAL_H

#include "expansion.h"
#include "table.h"
#include "record_internal.h"

#define LAM_MAX_IMAGES 6

/* The rotations and mirrors that map the tissue to itself, acting on (c1, c2); image 0 is the identity. */
typedef struct {
  PetscInt count;
  PetscReal map[LAM_MAX_IMAGES][2][2];
  PetscInt face[LAM_MAX_IMAGES][3]; /* face family k of the query is family face[k] of the record */
} LamImages;

/* How a record is used for nearby queries. */
typedef enum {
  LAM_SCATTER_BLENDS,  /* converged, stable, branch 0, no floating cells */
  LAM_SCATTER_ALONE,   /* another branch, or floating cells: its own state only */
  LAM_SCATTER_REFUSES, /* failed, unstable or without a tangent: only blocks blends nearby */
  /* In contact, with a tangent that is not elliptic: walls meet at points of the mesh, and between two of their
     meetings, over strains of 1e-4, the tangent may be anything. Its own state only, without regard to others */
  LAM_SCATTER_KINK,
} LamScatterUse;

typedef struct {
  LamScatterUse use;
  PetscInt images; /* bit i: image i is distinct; images that coincide with an earlier one are left out */
  PetscReal F33;
  LamExpansion model; /* only x where `use` is LAM_SCATTER_REFUSES */
} LamScattered;

/* Quantities common to all images of a state. A query scans these and evaluates the images of few states. */
typedef struct {
  PetscReal mean, deviator, turgor, cohesion, F33; /* c0, |c1 + i c2|, p, g; mean infinite: sheared out of the plane */
} LamScatterPlace;

/* Records outside the grid, in their order. */
typedef struct {
  PetscInt n, capacity[3]; /* of the three arrays */
  LamResponse *records;    /* [n] owned */
  LamScattered *states;    /* [n] owned */
  LamScatterPlace *places; /* [n] owned */
} LamScatter;

/*
  Distances of scattered records from a query, dC/2 being the Green strain, so that the distance is a strain:
    d^2 = |dc|^2 / 4 + (w dp)^2, in contact tissue + (LAM_SUCTION_WEIGHT (dp + dg))^2, + dF33^2
  w is LAM_TURGOR_WEIGHT where the fluid fills what the walls leave, else LAM_UNFILLED_WEIGHT, with contact of dg as
  well. The members are the coefficients of |dc|^2, dp^2, 2 dp dg, dg^2.
*/
typedef struct {
  PetscReal strain, pp, pg, gg;
} LamScatterMetric;

/*
  Records 0 .. n-1: those of the file, then those added in memory. For nodes of the grid the database keeps the data
  that the table needs, for other records the full response. The full responses of nodes in the file are loaded on the
  first LamDatabaseGetRecords.
*/
struct LamDatabase_s {
  LamHeader header; /* owned; `committed` counts the file's records, not n */
  char *path;       /* owned; NULL: no file */
  LamImages images;
  LamScatterMetric metric;
  PetscInt n, capacity;
  PetscInt64 *keys; /* [n] owned */

  LamNodeSet nodes;   /* records with the key of a node, in their order */
  LamScatter scatter; /* all other records */

  PetscInt records_first; /* number of records in the file until LamDatabaseGetRecords loads them, then 0 */
  PetscInt records_capacity;
  LamResponse *records; /* [n - records_first] owned: records from records_first on */
  char *info;           /* owned */

  LamGrid grid;   /* owned; NULL: no grid */
  LamTable table; /* the newest, of table_count nodes; NULL: none yet */
  PetscInt table_count;
};

/* ---- database.c ---- */
/* Ensures a capacity of count + n items; `items` points to the array. */
static inline PetscErrorCode LamGrow(PetscInt count, PetscInt n, size_t size, PetscInt *capacity, void *items)
{
  PetscFunctionBeginUser;
  if (count + n <= *capacity) PetscFunctionReturn(0);
  *capacity = PetscMax(2 * *capacity, count + n);
  PetscCall(PetscRealloc((size_t)*capacity * size, (void **)items));
  PetscFunctionReturn(0);
}

/* ---- images.c ---- */
PetscErrorCode LamImagesMake(const LamMicrostructure *micro, LamImages *images);
/* y = M x: the query in the records' frame. */
void LamImagesForward(const LamImages *images, PetscInt image, const PetscReal x[LAM_VARIABLES],
                      PetscReal y[LAM_VARIABLES]);
/* g <- M^T g, H <- M^T H M: derivatives from the records' frame to the query's. */
void LamImagesBack(const LamImages *images, PetscInt image, PetscReal g[LAM_VARIABLES]);
void LamImagesBackHessian(const LamImages *images, PetscInt image, PetscReal H[LAM_VARIABLES][LAM_VARIABLES]);

/* ---- scatter.c ---- */
PetscErrorCode LamScatterAdd(LamDatabase database, const LamResponse *record);
PetscErrorCode LamScatterMetricMake(const LamMicrostructure *micro, LamScatterMetric *metric);

typedef PetscReal LamScatterVector[LAM_VARIABLES];
typedef PetscReal LamScatterMatrix[LAM_VARIABLES][LAM_VARIABLES];

typedef struct {
  PetscInt state, image; /* state -1: none */
  PetscReal distance2;
} LamScatterNearest;

typedef struct {
  LamDatabase db;
  LamScatterVector x; /* of the query */
  LamScatterPlace place;
  LamScatterVector turned[LAM_MAX_IMAGES];         /* x in the frame of each image */
  LamScatterNearest blends, alone, refuses, kinks; /* the nearest of each use */
} LamScatterSearch;

/* Initialises the search at a load, without looking at records. */
void LamScatterBegin(LamDatabase database, const LamLoad *load, LamScatterSearch *search);
/* Finds the nearest records of each use; same_F33: of those that respond, only records of the load's F33. */
void LamScatterFind(LamDatabase database, const LamLoad *load, PetscBool same_F33, LamScatterSearch *search);
/* Whether record number k has the load's F33, up to rounding. */
PetscBool LamScatterSameF33(const LamScatterSearch *search, PetscInt k);
/* v = M delta; returns delta . M delta. */
PetscReal LamScatterApply(const LamScatterMetric *metric, const LamScatterVector delta, LamScatterVector v);
PetscReal LamScatterDistance2(const LamScatterSearch *search, const LamScattered *state, PetscInt image);
/* Lower bound of the squared distance of all images of a state at `place`. */
PetscReal LamScatterLowerBound(const LamScatterSearch *search, const LamScatterPlace *place);

/* ---- query_scatter.c ---- */
#define LAM_TRUST_RADIUS 0.04 /* strain: largest distance from the nearest record at which a blend is trusted */
#define LAM_OWN_STATE 1e-6    /* strain: within this distance a query is a record's own state */
/*
  Response from the scattered records within `radius` (strain) of the nearest. The load must be valid
  (LamLoadValidateInPlane), the response initialised by LamResponseInit. Thread-safe while no records are added.
*/
PetscErrorCode LamScatterQuery(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                               LamResponse *response);

/* ---- query_indicators.c ---- */
/* face[k]: the record's face family for family k of the query; `own`: the query is the record's own state. */
void LamIndicatorsCopy(const LamResponse *record, const PetscInt face[3], PetscBool own, LamInterfaceLawType interface,
                       LamResponse *r);

#endif
