/*
  Response records in HDF5, and queries of them.

  File: one extendible dataset of fixed-width records, a commit counter, the microstructures with their canonical
  description and hash, provenance. Layout: docs/reference/files.md. One serial writer at a time, guarded by a lock
  file. Each commit opens, appends, flushes, syncs and closes the file, so that a kill at any instant loses nothing
  that was committed. Failed samples are stored with their status. Readers scan the file once; queries use neither
  HDF5 nor PETSc's parallel parts, and need no MPI.
*/
#ifndef LAMELLA_DATABASE_H
#define LAMELLA_DATABASE_H

#include <petscsys.h>
#include <lamella/scene.h>
#include <lamella/response.h>
#include <lamella/reporter.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamDatabase_s *LamDatabase;
typedef struct LamRecordWriter_s *LamRecordWriter;

/*
  Keys of records in a database: nodes of its grid (LamKeyIsNode), and from LAM_CACHE_KEY on (LAM_CACHE_KEY,
  LAM_CACHE_KEY + 1, ...) states that a cache has solved directly. Small numbers: states of an rve file, and of
  databases older than the grid.
*/
#define LAM_CACHE_KEY ((PetscInt64)1 << 62)

/* ---- writing ---- */

typedef enum { LAM_WRITE_CREATE, LAM_WRITE_APPEND, LAM_WRITE_OVERWRITE } LamWriteMode;

/*
  Opens a file for writing and takes the lock PATH.lock. Symbolic links are followed. `kind`: "rve", "database",
  "fe2", "map". CREATE: a new file, which replaces a file of the same kind, or an empty one, atomically at the first
  commit; PETSC_ERR_USER_INPUT if it would replace anything else. OVERWRITE: it replaces any plain file. APPEND:
  continues a file of the same microstructure, PETSC_ERR_USER_INPUT if it differs; a missing file is created.
  PETSC_ERR_FILE_OPEN, with the holder, if another process has the lock.
*/
LAM_EXPORT PetscErrorCode LamRecordWriterOpen(const char path[], const char kind[], LamWriteMode mode,
                                              const LamScene *scene, LamRecordWriter *writer);
/*
  Begins a transaction: until the next LamRecordWriterCommit all is written to a copy, which then replaces the file.
  After a kill either all of it is visible, or nothing. HDF5 has no other safe way to extend a file.
*/
LAM_EXPORT PetscErrorCode LamRecordWriterBegin(LamRecordWriter writer);
/* Commits n records (0: only gives a new file its name). `keys`: the caller's number of each (sample index, state
   number). On return they are on disk. */
LAM_EXPORT PetscErrorCode LamRecordWriterCommit(LamRecordWriter writer, PetscInt n, const PetscInt64 keys[],
                                                const LamResponse responses[]);
/* Number of records committed, and their keys (borrowed until the next commit). */
LAM_EXPORT PetscErrorCode LamRecordWriterGetKeys(LamRecordWriter writer, PetscInt *n, const PetscInt64 *keys[]);
/* Releases the lock. A new file without a commit gets its name now if arrays or texts were written; otherwise it is
   removed. */
LAM_EXPORT PetscErrorCode LamRecordWriterClose(LamRecordWriter *writer);

/*
  Writes an array as dataset `name` ("/mesh/nodes"; groups are created), and replaces an existing one (in place,
  keeping its unit, if the shape is the same); dims[rank], rank <= 4. For geometry, fields and tables beside the
  records; on return it is on disk. `unit` is stored as attribute "unit" ("MPa", "apothem", "1"). LamRecordWriterText
  stores a UTF-8 string dataset.
*/
LAM_EXPORT PetscErrorCode LamRecordWriterReals(LamRecordWriter writer, const char name[], PetscInt rank,
                                               const PetscInt dims[], const PetscReal values[], const char unit[]);
LAM_EXPORT PetscErrorCode LamRecordWriterInts(LamRecordWriter writer, const char name[], PetscInt rank,
                                              const PetscInt dims[], const PetscInt values[]);
LAM_EXPORT PetscErrorCode LamRecordWriterText(LamRecordWriter writer, const char name[], const char text[]);

/* ---- reading ---- */

/*
  Checks the committed records, and loads the data for queries. PETSC_ERR_USER_INPUT if the file is damaged, or of
  another kind or format version.
*/
LAM_EXPORT PetscErrorCode LamDatabaseOpen(const char path[], LamDatabase *database);
/*
  As LamDatabaseOpen, with only the first `first` records of the file. The other *n are returned with their keys; the
  caller frees them with PetscFree. PETSC_ERR_USER_INPUT if the file has fewer.
*/
LAM_EXPORT PetscErrorCode LamDatabaseOpenFirst(const char path[], PetscInt first, LamDatabase *database, PetscInt *n,
                                               PetscInt64 *keys[], LamResponse *records[]);
/* An empty database in memory, with the microstructure, scales and accuracy of the scene. */
LAM_EXPORT PetscErrorCode LamDatabaseCreateEmpty(const LamScene *scene, LamDatabase *database);
LAM_EXPORT PetscErrorCode LamDatabaseClose(LamDatabase *database);
/*
  All records, in the order of the file, followed by those added in memory; borrowed until the next LamDatabaseAdd.
  The first call with `records` not NULL reads the file again, 1.9 kB per record: from one thread at a time, and not
  during an addition. PETSC_ERR_USER_INPUT if the file has been replaced since.
*/
LAM_EXPORT PetscErrorCode LamDatabaseGetRecords(LamDatabase database, PetscInt *n, const LamResponse *records[],
                                                const PetscInt64 *keys[]);
/* Records from number `from` on, all of which must have been added in memory; borrowed likewise. Reads no file. */
LAM_EXPORT PetscErrorCode LamDatabaseGetAdded(LamDatabase database, PetscInt from, PetscInt *n,
                                              const LamResponse *records[]);
/* The cells of *micro are borrowed from the database. */
LAM_EXPORT PetscErrorCode LamDatabaseGetMicrostructure(LamDatabase database, LamMicrostructure *micro,
                                                       LamScales *scales, const char *hash[]);
/* Provenance for `info`: JSON text, owned by the database. */
LAM_EXPORT PetscErrorCode LamDatabaseGetInfo(LamDatabase database, const char *json[]);
/* Read datasets written by the three functions above; the caller frees values with PetscFree. *found: whether `name`
   exists. */
LAM_EXPORT PetscErrorCode LamFileReadReals(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                           PetscInt dims[4], PetscReal **values);
LAM_EXPORT PetscErrorCode LamFileReadInts(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                          PetscInt dims[4], PetscInt **values);
LAM_EXPORT PetscErrorCode LamFileReadText(const char path[], const char name[], PetscBool *found, char **text);
/*
  Checks all of a file, continuing past damage. `reporter`, or NULL, gets the progress in records. `json`, freed by the
  caller: file, sound, records (committed; null if the counter is damaged), sound_records (null if none can be
  examined), damaged (a list: record, key and reason, or part and reason), unchecked (parts without a checksum), writer
  (host, process, since; or null). Returns an error only if the file does not exist or is not readable.
*/
LAM_EXPORT PetscErrorCode LamFileCheck(const char path[], const LamReporter *reporter, PetscBool *sound, char **json);
/* The file's kind: "rve", "database", "fe2" or "map". */
LAM_EXPORT PetscErrorCode LamFileReadKind(const char path[], char kind[LAM_NAME_LENGTH]);

/* ---- merging ---- */

typedef struct {
  PetscBool salvage;       /* use the records with a correct checksum from damaged files */
  PetscBool (*stop)(void); /* called periodically; PETSC_TRUE cancels the merge; NULL: never */
  LamReporter reporter;    /* one sentence per message; progress in records */
} LamMergeOptions;

typedef struct {
  PetscInt records;      /* of the result */
  PetscInt64 duplicates; /* records of a state that another record has */
  PetscInt64 differing;  /* of these: with different numbers, apart from times */
  PetscReal difference;  /* largest LamStressError between two records of a state */
  PetscInt64 left_out;   /* committed records that are damaged (salvage) */
  PetscBool stopped;     /* cancelled: nothing was written */
} LamMergeReport;

/*
  Merges databases of one microstructure and one grid (text of LAM_GRID_NAME) into `out`, in the order of the files.
  Each state, the same node or the same load, is stored once: of two records the converged one, otherwise the first.
  Cache keys (LAM_CACHE_KEY) are renumbered. Scales and scene are those of the first file, the accuracy is the
  smallest. Records of earlier types are converted. Files are read block by block: memory is 100 bytes per record.
  Takes the lock of `out`, which gets its name when it is complete and on disk; it must not exist, or must be one of
  the files. PETSC_ERR_USER_INPUT: incompatible or damaged files; PETSC_ERR_FILE_*.
*/
LAM_EXPORT PetscErrorCode LamDatabaseMerge(const char out[], PetscInt n, const char *const files[],
                                           const LamMergeOptions *options, LamMergeReport *report);

/*
  ---- the table: the potential interpolated on a grid of states ----

  The grid points (nodes) are lattice strains, the logarithms of the stretches of the three lattice directions, for
  contact tissue suction s = turgor + cohesion, and F33 if the sample box has a range of it; docs/theory/database.md,
  The tabulated potential. LamKeyIsNode: whether a record is a node, from its key. The grid is coarse initially and
  refined where it is queried; the nodes present determine range and accuracy of the table.
*/
typedef struct LamGrid_s *LamGrid;
typedef struct LamTable_s *LamTable;

/*
  Creates the grid for a scene: the box of `sample`, otherwise the loads given by its turgor and cohesion. Contact
  tissue needs `solver` for the states of free cells. Not collective: create it on one rank and share its text.
*/
LAM_EXPORT PetscErrorCode LamGridCreate(const LamScene *scene, LamResponder solver, LamGrid *grid);
LAM_EXPORT PetscErrorCode LamGridFromText(const char path[], const LamMicrostructure *micro, const char text[],
                                          LamGrid *grid);
LAM_EXPORT PetscErrorCode LamGridGetText(LamGrid grid, char **text); /* JSON; the caller frees it */
LAM_EXPORT PetscErrorCode LamGridDestroy(LamGrid *grid);
/* Free-cell states solved by LamGridCreate: store them with their keys as the first records; borrowed. Empty for a
   grid that was read. */
LAM_EXPORT PetscErrorCode LamGridGetRecords(LamGrid grid, PetscInt *n, const PetscInt64 *keys[],
                                            const LamResponse *records[]);
/* LamGridGetFreeKeys: keys of those records, also for a grid that was read. LamGridSolveRecords solves the records
   again for such a grid. */
LAM_EXPORT PetscErrorCode LamGridGetFreeKeys(LamGrid grid, PetscInt *n, const PetscInt64 *keys[]);
LAM_EXPORT PetscErrorCode LamGridSolveRecords(LamGrid grid, const LamMicrostructure *micro, LamResponder solver);
#define LAM_SCENE_FILES "/scene_files" /* as LamSceneDescribeFiles gives them, where the scene names files */
#define LAM_GRID_NAME "/table/grid"    /* written by LamRecordWriterText, before the first node */

/* Node keys lie between sample keys and cache keys. */
#define LAM_NODE_KEY ((PetscInt64)1 << 60)
LAM_EXPORT PetscBool LamKeyIsNode(PetscInt64 key);
/* Nodes that are free-cell states (LamGridGetRecords): they have no position in the grid and need no further solve. */
LAM_EXPORT PetscBool LamKeyIsFreeCell(PetscInt64 key);
/* The state of a node. */
LAM_EXPORT PetscErrorCode LamGridNodeLoad(LamGrid grid, PetscInt64 key, LamLoad *load);
/* Refinement level of the node; 0: coarsest; -1: a free-cell state. */
LAM_EXPORT PetscInt LamGridNodeLevel(LamGrid grid, PetscInt64 key);
/* Position of the node for distances: three lattice strains and the logarithm of suction, in edges of root cells. */
LAM_EXPORT void LamGridNodePlace(LamGrid grid, PetscInt64 key, PetscReal place[4]);
/* The smallest and the largest F33 of the grid's states; both 1: plane strain. */
LAM_EXPORT void LamGridGetF33(LamGrid grid, PetscReal range[2]);
/* The node whose solution may start a solve of this one: the next one towards coarser nodes; -1: the reference. */
LAM_EXPORT PetscInt64 LamGridNodeParent(LamGrid grid, PetscInt64 key);

/* Adds records in memory, available to queries at once. keys: of nodes, or NULL: states off the grid. */
LAM_EXPORT PetscErrorCode LamDatabaseAdd(LamDatabase database, PetscInt n, const PetscInt64 keys[],
                                         const LamResponse records[]);
/* LamDatabaseSetGrid takes ownership of the grid; the database must have none. LamDatabaseGetGrid: borrowed; NULL if
   there is none. */
LAM_EXPORT PetscErrorCode LamDatabaseSetGrid(LamDatabase database, LamGrid *grid);
LAM_EXPORT PetscErrorCode LamDatabaseGetGrid(LamDatabase database, LamGrid *grid);

/*
  The table of all records so far. It is immutable: later additions are in another table. Each call adds a reference,
  which LamTableDestroy drops. The database must outlive it. NULL if the database has no grid.
*/
LAM_EXPORT PetscErrorCode LamDatabaseGetTable(LamDatabase database, LamTable *table);
LAM_EXPORT PetscErrorCode LamTableDestroy(LamTable *table);

/*
  Evaluates the table if the estimated error is at most `accuracy` (PETSC_INFINITY: any), otherwise status
  LAM_OUT_OF_REACH with a reason. Energy, in-plane stress and tangent and all derivatives with respect to turgor and
  cohesion come from one potential; so do P33 and its row of the tangent with a range of F33, otherwise they are
  interpolated separately. Indicators are
  interpolated between the surrounding nodes, within their bounds; response->indicators_trusted: whether the nodes
  agree. error_estimate is an estimate of LamStressError. Thread-safe.
*/
LAM_EXPORT PetscErrorCode LamTableQuery(LamTable table, const LamLoad *load, PetscReal accuracy, LamResponse *response);
/*
  *error (may be NULL): the error estimate of this query, infinite if the table has no response. keys: of the nodes that
  the table lacks to answer it to this accuracy, coarser ones first; *n = 0: none is missing, or no node helps (a change
  of branch, a failed node, the finest level, outside the grid), only a solve of the state itself.
*/
#define LAM_MAX_NEEDS 64
LAM_EXPORT PetscErrorCode LamTableNeeds(LamTable table, const LamLoad *load, PetscReal accuracy, PetscReal *error,
                                        PetscInt *n, PetscInt64 keys[LAM_MAX_NEEDS]);
/*
  The rotated or mirrored state that is equivalent to this load, with F symmetric and lattice strains ordered as those
  of nodes (rounded to 1e-10). *key: the nearest surrounding node whose solution can start its solve, -1: none.
*/
LAM_EXPORT PetscErrorCode LamTableTurn(LamTable table, const LamLoad *load, LamLoad *turned, PetscInt64 *key);

/*
  Evaluates the table, otherwise the records off the grid: a record of the queried state, or a blend of second-order
  models of the nearest records, trusted within a strain of 0.04 (query_scatter.c). Thread-safe as long as no records
  are added and the table of the last addition has been created, by LamDatabaseGetTable or a first query.
*/
LAM_EXPORT PetscErrorCode LamDatabaseQuery(LamDatabase database, const LamLoad *load, PetscReal accuracy,
                                           LamResponse *response);

LAM_C_END

#endif
