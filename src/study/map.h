/*
  Failure map: how tissue fails as a function of two of its quantities.

    map_path.c     follows the load at one point, or at a row of points
    map_table.c    failure modes as arrays of the result file
    map_run.c      distributes paths, commits

  Points are numbered y * points_x + x, from 0; the number is the key of their record. If an axis is a load quantity
  (shear, load_factor), one path along the load gives all points along that axis, as cuts of the path. Otherwise every
  point has its own path, with one cut at the end of the load.
*/
#ifndef LAM_MAP_H
#define LAM_MAP_H

#include "dispatch.h"
#include "failure.h"
#include "target.h"

/* Result at one point. Plain data, sent between ranks. */
typedef struct {
  PetscInt64 number;      /* of the point */
  LamFailureMode mode;    /* reached before or at the point */
  LamCriterion criterion; /* that determines the mode; LAM_CRITERION_COUNT: none */
  PetscReal load_factor;  /* fraction of the load's states at which it is reached, 0 to 1; NaN: none */
  PetscReal place[3];     /* cell, face 0..5, position along the face in [0, 1]; NaN if it has none */
  char reason[256];       /* why the mode is unknown; empty otherwise */
  LamResponse response;   /* where the tissue fails or a solve does not converge, else at the point itself */
} LamMapPoint;

/* ---- map_path.c ---- */

PetscInt LamMapPointCount(const LamScene *scene);
/* Whether paths differ in their walls. */
PetscBool LamMapVariesWalls(const LamScene *scene);
PetscInt LamMapPathCount(const LamScene *scene);
PetscInt LamMapCutCount(const LamScene *scene); /* points of one path */
/* Number of the point at cut `cut` of path `path`. */
PetscInt64 LamMapPointNumber(const LamScene *scene, PetscInt path, PetscInt cut);
/* Upper bound of the RVE solves of one path, without those that bracket the failure. */
PetscInt LamMapPathStates(const LamScene *scene);
/* Follows a path; points [cuts]. *complete is false if the interrupt (LamMeshesSetInterrupt) ended it. */
PetscErrorCode LamMapFollow(const LamScene *scene, PetscInt path, PetscBool (*interrupt)(void *ctx), void *ctx,
                            LamMapPoint points[], PetscBool *complete);

/* ---- map_table.c ---- */

/* Row by row, y outer; a mode of -1: not known yet. */
typedef struct {
  PetscInt points[LAM_MAP_AXIS_COUNT];
  PetscInt *mode, *criterion; /* owned */
  PetscReal *load_factor;     /* owned */
  PetscReal *place;           /* [point][3]; owned */
} LamMapTable;

/* Reads the points marked in `known` [point] from a file. path NULL: a new table. PETSC_ERR_USER_INPUT if the file
   lacks the arrays. */
PetscErrorCode LamMapTableCreate(const LamScene *scene, const char path[], const PetscBool known[], LamMapTable *table);
PetscErrorCode LamMapTableDestroy(LamMapTable *table);
void LamMapTableSet(LamMapTable *table, const LamMapPoint *point);
PetscErrorCode LamMapTableWrite(LamRecordWriter writer, const LamMapTable *table);
/* Writes the axes and the names of modes and criteria; once, before the table. */
PetscErrorCode LamMapAxesWrite(LamRecordWriter writer, const LamScene *scene);

/* ---- map_run.c; collective ---- */

typedef struct LamMap_s {
  const char *scene_path, *path;
  PetscBool overwrite; /* files that Lamella did not write, too */
  PetscBool resume;    /* continue an existing file */
  LamReporter reporter;
  /* Called for each point once it is in the file, on rank 0; ctx: the reporter's. May be NULL. */
  PetscErrorCode (*point)(void *ctx, const struct LamMap_s *map, const LamMapPoint *point);

  LamScene *scene;
  PetscInt paths, cuts;
  LamDispatch dispatch;
  PetscMPIInt rank, ranks;
  PetscInt *todo; /* paths that are not in the file; owned, all ranks */
  PetscInt todo_count;

  /* on rank 0 */
  LamRecordWriter writer;
  LamMapTable table;
  LamMapPoint *waiting; /* [paths cuts], of which `waiting_count` are not committed yet; owned */
  PetscInt waiting_count, solved, old;
  PetscReal start, last_commit;
} LamMap;

/* PETSC_ERR_USER_INPUT for a scene without a block `map`, or if the file belongs to another scene. */
PetscErrorCode LamMapRun(LamMap *map);
PetscInt LamMapCountMode(const LamMap *map, PetscInt mode); /* rank 0: number of points with that failure mode */
PetscErrorCode LamMapDestroy(LamMap *map);

#endif
