/*
  The tissues of a macroscale run: assigned to material points by the scene's regions and fields.
*/
#ifndef LAM_FE2_TISSUE_H
#define LAM_FE2_TISSUE_H

#include "study.h"
#include "known_records.h"
#include "node_solver.h"

/* One tissue and its responders. */
typedef struct {
  char name[LAM_NAME_LENGTH + 16]; /* "": the scene's own; "skin", "t2", "skin.t2" */
  LamScene scene;                  /* of this tissue alone; borrows pointers from the run's scene */
  PetscReal stress;                /* its C1 + C2 over that of the run's scene */
  char database_path[PETSC_MAX_PATH_LEN];
  PetscInt points;        /* number of points with this tissue on this rank */
  PetscInt64 body_points; /* on all ranks */

  LamRVE rve;
  LamDatabase database;
  LamKnownRecords known;       /* records of the database file that a resumed run finds there but has not used yet */
  LamNodeChain chain;          /* solves the cache's nodes */
  LamNodeSolver solved, nodes; /* by the chain; by `known`, else by the chain */
  LamResponder direct, cache;  /* NULL: not in use; with models of points `direct` holds them */
  LamResponder reference;      /* of certified reactions; NULL: not in use */
  LamRelaxation relaxation;    /* of walls, if `scene` has them elastic and responses convolve (relaxing.h) */
  LamResponder relaxing;       /* NULL: not in use */

  /* rank 0 only */
  LamRecordWriter records; /* appends the cache's records to the database file */
  PetscInt recorded;       /* number of records of the database that are in its file */
  PetscInt64 next_key;     /* key of the next record that is no grid node */
  PetscInt row_count, row_capacity;
  PetscInt *rows;  /* file rows of the database's records after the first `known.first`; owned */
  char *grid_text; /* grid to be written; NULL: the file has it */
} LamFE2Tissue;

typedef struct {
  PetscInt count;
  LamFE2Tissue *tissues;
  PetscInt points;              /* material points of this rank */
  LamHeterogeneousPoint *point; /* [points]; this and the next two are NULL if no point differs from the scene */
  PetscReal *turgor, *cohesion; /* [points] in units of C1 + C2 of the run's scene */
  PetscBool plain; /* one tissue everywhere, in the scene's units and orientation: needs no heterogeneous responder */
} LamFE2Tissues;

/*
  Collective. `database_path`: from option -d, or NULL; tissue NAME has the file DB.NAME.h5 beside it. Regions that
  differ only in turgor, cohesion and orientation share a tissue. PETSC_ERR_USER_INPUT if a region or field does not fit
  the body; a warning of each region that has no material point.
*/
PetscErrorCode LamFE2TissuesCreate(MPI_Comm comm, const LamReporter *reporter, LamMacro macro, const LamScene *scene,
                                   const char database_path[], LamFE2Tissues *tissues);
/* The scene's own tissue alone, for `points` points of this rank. */
PetscErrorCode LamFE2TissuesCreateOne(MPI_Comm comm, const LamScene *scene, const char database_path[], PetscInt points,
                                      LamFE2Tissues *tissues);
PetscErrorCode LamFE2TissuesDestroy(LamFE2Tissues *tissues);
/* Of errors of stress, in units of the body. */
LamStressScale LamFE2StressScale(const LamFE2Tissue *tissue);

#endif
