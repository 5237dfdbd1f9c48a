/*
  The tissues of a macroscale run: what a scene's regions and fields make of its material points.
*/
#ifndef LAM_FE2_TISSUE_H
#define LAM_FE2_TISSUE_H

#include "study.h"
#include "known_records.h"
#include "node_solver.h"

/* One tissue, and what answers for it. */
typedef struct {
  char name[LAM_NAME_LENGTH + 16]; /* "": the scene's own; "skin", "t2", "skin.t2" */
  LamScene scene;                  /* of this tissue alone; borrows what it points to from the run's */
  PetscReal stress;                /* its C1 + C2 over that of the run's scene */
  char database_path[PETSC_MAX_PATH_LEN];
  PetscInt points;        /* that have it, on this rank */
  PetscInt64 body_points; /* on all ranks */

  LamRVE rve;
  LamDatabase database;
  LamKnownRecords
      known;          /* records of the database's file that a run which goes on finds again, and does not know yet */
  LamNodeChain chain; /* of the cache's nodes */
  LamNodeSolver solved, nodes;        /* by the chain; by what is known, too */
  LamResponder direct, solver, cache; /* direct behind the signals' `solver`; destroy NULL: not in use */

  /* rank 0 only */
  LamRecordWriter records; /* appends what the cache solves to the database's file */
  PetscInt recorded;       /* records of the database that are in its file */
  PetscInt64 next_key;     /* of a state that belongs to no grid */
  PetscInt row_count, row_capacity;
  PetscInt *rows;  /* in the file, of the database's records behind the first `known.first`; owned */
  char *grid_text; /* to be written; NULL: the file has it */
} LamFE2Tissue;

typedef struct {
  PetscInt count;
  LamFE2Tissue *tissues;
  PetscInt points;              /* material points of this rank */
  LamHeterogeneousPoint *point; /* [points]; NULL, as the next two, where nothing differs from the scene */
  PetscReal *turgor, *cohesion; /* [points] in the C1 + C2 of the run's scene */
  PetscBool plain;              /* one tissue as the scene has it, everywhere: no need of a mosaic */
} LamFE2Tissues;

/*
  Collective. `database_path`: of -d, or NULL; tissue NAME has the file DB.NAME.h5 beside it. Regions that differ in
  nothing but turgor, cohesion and orientation share a tissue. PETSC_ERR_USER_INPUT where a region or field does not fit
  the body.
*/
PetscErrorCode LamFE2TissuesCreate(MPI_Comm comm, LamMacro macro, const LamScene *scene, const char database_path[],
                                   LamFE2Tissues *tissues);
PetscErrorCode LamFE2TissuesDestroy(LamFE2Tissues *tissues);

#endif
