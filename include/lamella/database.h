/*
  Response records in HDF5, and answers from them.

  File: one extendible dataset of fixed-width records, a commit counter, the microstructures with their canonical
  description and hash, provenance. docs/reference/files.md describes it for readers in other languages.
  One serial writer at a time, guarded by a lock file; it opens, appends, flushes, syncs and closes at each commit, so
  a kill at any instant loses nothing that was committed. Failed samples are kept with their status.
  Readers scan the file once; queries call neither PETSc's parallel parts nor HDF5, and need no MPI.
*/
#ifndef LAMELLA_DATABASE_H
#define LAMELLA_DATABASE_H

#include <petscsys.h>
#include <lamella/scene.h>
#include <lamella/response.h>
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

typedef enum { LAM_WRITE_CREATE, LAM_WRITE_APPEND } LamWriteMode;

/*
  Starts a file (CREATE: replaces a file of the same kind, or an empty one, atomically at the first commit and refuses
  to replace anything else, PETSC_ERR_USER_INPUT; APPEND: goes on with a file of the same microstructure,
  PETSC_ERR_USER_INPUT where it differs; a missing file is started). Symbolic links are followed. `kind`: "rve",
  "database", "fe2", "map". Takes the lock PATH.lock; PETSC_ERR_FILE_OPEN with the holder where another process has it.
*/
LAM_EXPORT PetscErrorCode LamRecordWriterOpen(const char path[], const char kind[], LamWriteMode mode,
                                              const LamScene *scene, LamRecordWriter *writer);
/*
  Until the next LamRecordWriterCommit all is written to a copy, which takes the file's name there: what belongs
  together appears at once, or, after a kill, not at all. HDF5 has no other way to extend a file that a kill cannot
  harm.
*/
LAM_EXPORT PetscErrorCode LamRecordWriterBegin(LamRecordWriter writer);
/* Commits n records (0: only gives a new file its name). `keys`: caller's number for each (sample index, state number).
   On return they are on the disk. */
LAM_EXPORT PetscErrorCode LamRecordWriterCommit(LamRecordWriter writer, PetscInt n, const PetscInt64 keys[],
                                                const LamResponse responses[]);
/* Number of records committed, and their keys (borrowed until the next commit). */
LAM_EXPORT PetscErrorCode LamRecordWriterGetKeys(LamRecordWriter writer, PetscInt *n, const PetscInt64 *keys[]);
/* Gives up the lock. A new file without a commit gets its name now if arrays or texts were written, else it vanishes.
 */
LAM_EXPORT PetscErrorCode LamRecordWriterClose(LamRecordWriter *writer);

/*
  Writes an array as dataset `name` ("/mesh/nodes", groups are made), replacing it where it exists (in place, with the
  unit it has, where the shape is the same); dims[rank],
  rank <= 4. For geometry, fields and tables beside the records; on return it is on the disk. `unit` is stored as
  attribute "unit" ("MPa", "apothem", "1"). LamRecordWriterText stores a UTF-8 string dataset.
*/
LAM_EXPORT PetscErrorCode LamRecordWriterReals(LamRecordWriter writer, const char name[], PetscInt rank,
                                               const PetscInt dims[], const PetscReal values[], const char unit[]);
LAM_EXPORT PetscErrorCode LamRecordWriterInts(LamRecordWriter writer, const char name[], PetscInt rank,
                                              const PetscInt dims[], const PetscInt values[]);
LAM_EXPORT PetscErrorCode LamRecordWriterText(LamRecordWriter writer, const char name[], const char text[]);

/* ---- reading ---- */

/*
  Checks the committed records, and loads what queries need of them. PETSC_ERR_USER_INPUT where the file is damaged, of
  another kind or format version.
*/
LAM_EXPORT PetscErrorCode LamDatabaseOpen(const char path[], LamDatabase *database);
/*
  The same with the first `first` records of the file alone, whatever has been added since; the other *n are handed out
  with their keys, the caller's to PetscFree. PETSC_ERR_USER_INPUT where the file has fewer.
*/
LAM_EXPORT PetscErrorCode LamDatabaseOpenFirst(const char path[], PetscInt first, LamDatabase *database, PetscInt *n,
                                               PetscInt64 *keys[], LamResponse *records[]);
LAM_EXPORT PetscErrorCode LamDatabaseCreateEmpty(const LamScene *scene, LamDatabase *database);
LAM_EXPORT PetscErrorCode LamDatabaseClose(LamDatabase *database);
/*
  All records, in the order of the file, those added in memory last; borrowed until the next LamDatabaseAdd. The first
  call that asks for `records` (not NULL) reads the file again, 1.9 kB a record: one thread at a time, and not while
  another adds. PETSC_ERR_USER_INPUT where the file has been replaced since.
*/
LAM_EXPORT PetscErrorCode LamDatabaseGetRecords(LamDatabase database, PetscInt *n, const LamResponse *records[],
                                                const PetscInt64 *keys[]);
/* Records number `from` and on, all of them added in memory; borrowed likewise. Reads no file. */
LAM_EXPORT PetscErrorCode LamDatabaseGetAdded(LamDatabase database, PetscInt from, PetscInt *n,
                                              const LamResponse *records[]);
/* The cells of *micro are borrowed from the database. */
LAM_EXPORT PetscErrorCode LamDatabaseGetMicrostructure(LamDatabase database, LamMicrostructure *micro,
                                                       LamScales *scales, const char *hash[]);
/* Provenance for `info`: JSON text, owned by the database. */
LAM_EXPORT PetscErrorCode LamDatabaseGetInfo(LamDatabase database, const char *json[]);
/* Read what the three functions above wrote; values are the caller's to PetscFree. *found tells whether `name` is
 * there. */
LAM_EXPORT PetscErrorCode LamFileReadReals(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                           PetscInt dims[4], PetscReal **values);
LAM_EXPORT PetscErrorCode LamFileReadInts(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                          PetscInt dims[4], PetscInt **values);
LAM_EXPORT PetscErrorCode LamFileReadText(const char path[], const char name[], PetscBool *found, char **text);
/*
  Reads all of a file, also behind damage. `json`, the caller's to free: file, sound, records (committed; null where the
  counter is damaged), sound_records (null where none can be looked at), damaged (a list: record, key and reason, or
  part and reason), unchecked (parts without a checksum), writer (host, process, since; or null). Errors only where the
  file is not there or not readable.
*/
LAM_EXPORT PetscErrorCode LamFileCheck(const char path[], PetscBool *sound, char **json);
/* The file's kind: "rve", "database", "fe2" or "map". */
LAM_EXPORT PetscErrorCode LamFileReadKind(const char path[], char kind[LAM_NAME_LENGTH]);

/* ---- merging ---- */

typedef struct {
  PetscBool salvage;       /* of damaged files the records whose checksum is right */
  PetscBool (*stop)(void); /* called now and then: whether to give up; NULL: never */
  /* Sentences for a person, one a call; may be NULL. */
  void (*tell)(void *ctx, const char words[]);
  void *ctx; /* of tell; borrowed */
} LamMergeOptions;

typedef struct {
  PetscInt records;      /* of the result */
  PetscInt64 duplicates; /* records whose question another one had answered */
  PetscInt64 differing;  /* of these: with other numbers, times aside */
  PetscReal difference;  /* largest LamStressError between two answers to a question */
  PetscInt64 left_out;   /* committed records that are damaged (salvage) */
  PetscBool stopped;     /* given up: nothing was written */
} LamMergeReport;

/*
  Makes `out` of all records of the files, databases of one microstructure and one grid (text of LAM_GRID_NAME), in
  their order; each question once: the same node, or the same load. Of two answers one that has converged is kept, else
  the first. Keys of a cache (LAM_CACHE_KEY) are given anew. Scales and scene are those of the first file, the accuracy
  is the smallest. Records of earlier types get the present one. Files are read block by block: 100 bytes a record stay
  in memory. Takes the lock of `out`, and gives it its name when it is complete and on the disk; it must not be there,
  or be one of the files. PETSC_ERR_USER_INPUT: files that do not belong together, or are damaged; PETSC_ERR_FILE_*.
*/
LAM_EXPORT PetscErrorCode LamDatabaseMerge(const char out[], PetscInt n, const char *const files[],
                                           const LamMergeOptions *options, LamMergeReport *report);

/*
  ---- the table: the potential interpolated on a grid of states ----

  States of the grid (nodes) are lattice strains, the logarithms of the stretches of the three lattice directions, and
  for contact tissue suction s = turgor + cohesion; docs/theory/database.md, The tabulated potential. A record is a node
  where its key says so (LamKeyIsNode). The grid is coarse to begin with and refined where it is asked for: which nodes
  there are decides what the table answers, and how well.
*/
typedef struct LamGrid_s *LamGrid;
typedef struct LamTable_s *LamTable;

/*
  The grid for a scene: the box of `sample`, else the loads that its turgor and cohesion say. Contact tissue needs
  `solver` for the states of cells that touch no one. Collective over nothing: make it on one rank, share its text.
*/
LAM_EXPORT PetscErrorCode LamGridCreate(const LamScene *scene, LamResponder *solver, LamGrid *grid);
LAM_EXPORT PetscErrorCode LamGridFromText(const char path[], const LamMicrostructure *micro, const char text[],
                                          LamGrid *grid);
LAM_EXPORT PetscErrorCode LamGridGetText(LamGrid grid, char **text); /* JSON; the caller frees it */
LAM_EXPORT PetscErrorCode LamGridDestroy(LamGrid *grid);
/* States that LamGridCreate solved (free cells): to be stored with their keys as the first records; borrowed. None in a
   grid that was read. */
LAM_EXPORT PetscErrorCode LamGridGetRecords(LamGrid grid, PetscInt *n, const PetscInt64 *keys[],
                                            const LamResponse *records[]);
/* The keys of those records, also of a grid that was read; and the records themselves, solved once more for it. */
LAM_EXPORT PetscErrorCode LamGridGetFreeKeys(LamGrid grid, PetscInt *n, const PetscInt64 *keys[]);
LAM_EXPORT PetscErrorCode LamGridSolveRecords(LamGrid grid, const LamMicrostructure *micro, LamResponder *solver);
#define LAM_GRID_NAME "/table/grid" /* LamRecordWriterText of it, before the first node */

/* Keys of nodes lie between those of samples and those of the cache. */
#define LAM_NODE_KEY ((PetscInt64)1 << 60)
LAM_EXPORT PetscBool LamKeyIsNode(PetscInt64 key);
/* Nodes that are free cells' states (LamGridGetRecords): there is no place in the grid for them, and no other solve. */
LAM_EXPORT PetscBool LamKeyIsFreeCell(PetscInt64 key);
/* The state of a node. */
LAM_EXPORT PetscErrorCode LamGridNodeLoad(LamGrid grid, PetscInt64 key, LamLoad *load);
/* How often the grid was halved until this node came in; 0: coarsest; -1: a state of cells that touch no one. */
LAM_EXPORT PetscInt LamGridNodeLevel(LamGrid grid, PetscInt64 key);
/* Where it lies: three lattice strains and the logarithm of suction, in edges of root cells. For distances. */
LAM_EXPORT void LamGridNodePlace(LamGrid grid, PetscInt64 key, PetscReal place[4]);
/* The node that a solve of this one may start from: the nearest of the next coarser level; -1: from the reference. */
LAM_EXPORT PetscInt64 LamGridNodeParent(LamGrid grid, PetscInt64 key);

/* Records in memory; they are answered from at once. keys: of nodes, or NULL: states of no grid. */
LAM_EXPORT PetscErrorCode LamDatabaseAdd(LamDatabase database, PetscInt n, const PetscInt64 keys[],
                                         const LamResponse records[]);
/* Takes over the grid of a database that has none. LamDatabaseGetGrid: NULL where it has none; borrowed. */
LAM_EXPORT PetscErrorCode LamDatabaseSetGrid(LamDatabase database, LamGrid *grid);
LAM_EXPORT PetscErrorCode LamDatabaseGetGrid(LamDatabase database, LamGrid *grid);

/*
  The table of all records so far. It never changes: what is added later is in another one. Each call adds a reference,
  LamTableDestroy drops it. The database must outlive it. NULL where the database has no grid.
*/
LAM_EXPORT PetscErrorCode LamDatabaseGetTable(LamDatabase database, LamTable *table);
LAM_EXPORT PetscErrorCode LamTableDestroy(LamTable *table);

/*
  An answer from the table where its estimated error is at most `accuracy` (PETSC_INFINITY: any), else status
  LAM_OUT_OF_REACH with a reason. Energy, in-plane stress and tangent and all derivatives with respect to turgor and
  cohesion come from one potential; P33 and its row of the tangent from an interpolation of its own. Indicators are
  interpolated between the nodes around, within their bounds; response->indicators_trusted tells whether the nodes
  agree. error_estimate is what LamStressError would be. Safe to call from several threads at once.
*/
LAM_EXPORT PetscErrorCode LamTableQuery(LamTable table, const LamLoad *load, PetscReal accuracy, LamResponse *response);
/*
  Keys of the nodes that the table lacks to answer this question to this accuracy, coarser ones first; *n = 0: no node
  helps (a change of branch, a failed node, the finest level, outside the grid), only a solve of the state itself.
*/
#define LAM_MAX_NEEDS 64
LAM_EXPORT PetscErrorCode LamTableNeeds(LamTable table, const LamLoad *load, PetscReal accuracy, PetscInt *n,
                                        PetscInt64 keys[LAM_MAX_NEEDS]);
/*
  The state that this question is a turned or mirrored image of, with F symmetric and its lattice strains in the order
  of those of nodes (rounded to 1e-10); *key: of the nodes around it the nearest whose solution it can start from, -1:
  none.
*/
LAM_EXPORT PetscErrorCode LamTableTurn(LamTable table, const LamLoad *load, LamLoad *turned, PetscInt64 *key);

/*
  The answer of the table, else of the records that belong to no grid: the question's own state, or a blend of
  second-order models of the nearest ones, which is trusted within a strain of 0.04 (query_scatter.c). Safe to call from
  several threads at once as long as none adds records, and where LamDatabaseGetTable, or a first question, has made the
  table since the last were added.
*/
LAM_EXPORT PetscErrorCode LamDatabaseQuery(LamDatabase database, const LamLoad *load, PetscReal accuracy,
                                           LamResponse *response);

LAM_C_END

#endif
