/*
  Response records in HDF5, and answers from them.

  File: one extendible dataset of fixed-width records, a commit counter, the microstructures with their canonical
  description and hash, provenance. docs/file-format.md describes it for readers in other languages.
  One serial writer at a time, guarded by a lock file; it opens, appends, flushes, syncs and closes at each commit, so
  a kill at any instant loses nothing that was committed. Failed samples are kept with their status.
  Readers load into memory; queries call neither PETSc's parallel parts nor HDF5, and need no MPI.
*/
#ifndef LAMELLA_DATABASE_H
#define LAMELLA_DATABASE_H

#include <petscsys.h>
#include <lamella/scene.h>
#include <lamella/response.h>

typedef struct LamDatabase_s *LamDatabase;
typedef struct LamRecordWriter_s *LamRecordWriter;

/* Hash (16 hex digits) of the canonical, nondimensional description, and the description itself (JSON text). */
#define LAM_HASH_LENGTH 17
PetscErrorCode LamMicrostructureDescribe(const LamMicrostructure *micro, char **json, char hash[LAM_HASH_LENGTH]);

/*
  Keys of records in a database: below LAM_CACHE_KEY the number of the state in the scene's sample sequence; from it on
  (LAM_CACHE_KEY, LAM_CACHE_KEY + 1, ...) records from elsewhere, such as a cache of fe2, which belong to no sequence.
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
PetscErrorCode LamRecordWriterOpen(const char path[], const char kind[], LamWriteMode mode, const LamScene *scene,
                                   LamRecordWriter *writer);
/* Commits n records (0: only gives a new file its name). `keys`: caller's number for each (sample index, state number).
   On return they are on the disk. */
PetscErrorCode LamRecordWriterCommit(LamRecordWriter writer, PetscInt n, const PetscInt64 keys[],
                                     const LamResponse responses[]);
/* Number of records committed, and their keys (borrowed until the next commit). */
PetscErrorCode LamRecordWriterGetKeys(LamRecordWriter writer, PetscInt *n, const PetscInt64 *keys[]);
/* Gives up the lock. A new file without a commit gets its name now if arrays or texts were written, else it vanishes.
 */
PetscErrorCode LamRecordWriterClose(LamRecordWriter *writer);

/*
  Writes an array as dataset `name` ("/mesh/nodes", groups are made), replacing it where it exists (in place, with the
  unit it has, where the shape is the same); dims[rank],
  rank <= 4. For geometry, fields and tables beside the records; on return it is on the disk. `unit` is stored as
  attribute "unit" ("MPa", "apothem", "1"). LamRecordWriterText stores a UTF-8 string dataset.
*/
PetscErrorCode LamRecordWriterReals(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                                    const PetscReal values[], const char unit[]);
PetscErrorCode LamRecordWriterInts(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                                   const PetscInt values[]);
PetscErrorCode LamRecordWriterText(LamRecordWriter writer, const char name[], const char text[]);

/* ---- reading ---- */

/* Loads the committed records. PETSC_ERR_USER_INPUT where the file is damaged, of another kind or format version. */
PetscErrorCode LamDatabaseOpen(const char path[], LamDatabase *database);
PetscErrorCode LamDatabaseCreateEmpty(const LamScene *scene, LamDatabase *database);
PetscErrorCode LamDatabaseClose(LamDatabase *database);
PetscErrorCode LamDatabaseGetRecords(LamDatabase database, PetscInt *n, const LamResponse *records[],
                                     const PetscInt64 *keys[]);
/* The cells of *micro are borrowed from the database. */
PetscErrorCode LamDatabaseGetMicrostructure(LamDatabase database, LamMicrostructure *micro, LamScales *scales,
                                            const char *hash[]);
/* Provenance for `info`: JSON text, owned by the database. */
PetscErrorCode LamDatabaseGetInfo(LamDatabase database, const char *json[]);
/* Read what the three functions above wrote; values are the caller's to PetscFree. *found tells whether `name` is
 * there. */
PetscErrorCode LamFileReadReals(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                PetscInt dims[4], PetscReal **values);
PetscErrorCode LamFileReadInts(const char path[], const char name[], PetscBool *found, PetscInt *rank, PetscInt dims[4],
                               PetscInt **values);
PetscErrorCode LamFileReadText(const char path[], const char name[], PetscBool *found, char **text);
/* The file's kind: "rve", "database", "fe2" or "map". */
PetscErrorCode LamFileReadKind(const char path[], char kind[LAM_NAME_LENGTH]);

/* Adds solved records in memory (cache); they are answered from at once. */
PetscErrorCode LamDatabaseAdd(LamDatabase database, PetscInt n, const LamResponse records[]);

/*
  Answers from the nearest record by the second-order expansion of the potential in (C, turgor), with objectivity and
  the D6 symmetry of the cell. response->distance is the distance to the record; status LAM_OUT_OF_REACH with a reason
  where no usable record (converged, stable) lies within `radius` (PETSC_INFINITY: any). `hint`, where not NULL, is
  in/out: opaque, names the record and image that answered, to be preferred while within radius (-1: none), so that
  answers stay smooth during a load step.
  Energy, in-plane stress and tangent, lumen fraction and their turgor derivatives come from one potential; P33 and the
  opening fraction are of first order, their derivatives of zeroth; the tangent's entry 33,33 is the record's.
  Tractions, and for contact tissue gaps, shares of the interface and counts of cells, are the record's (faces renamed)
  where the question is its own state, else NaN and 0. Contact tissue is answered from records of the question's
  cohesion. error_estimate grows with the square of the distance and is LamTrustRadius's accuracy at its radius. Safe to
  call from several threads at once, each with its own hint, while nobody adds records.
*/
PetscErrorCode LamDatabaseQuery(LamDatabase database, const LamLoad *load, PetscReal radius, PetscInt *hint,
                                LamResponse *response);

/* Trust radius (strain) of the nearest-record expansion for a wanted accuracy; measured, docs/verification.md. */
PetscReal LamTrustRadius(PetscReal accuracy);

#endif
