/*
  What other languages call: functions whose arguments are numbers, texts, arrays of numbers and handles. Values are SI.

  Each function that returns an int returns 0, or an error code; LamErrorMessage then has the message, and where it is
  about a scene its file, line, column and key. A state that has no answer is no error: its response says so.

  Loads are rows of 11 numbers: F row by row, turgor and cohesion. Responses are rows of
  LamBindResponseSize() bytes, whose members LamBindMember tells.
*/
#ifndef LAMELLA_BIND_H
#define LAMELLA_BIND_H

#include <stddef.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Starts MPI and PETSc where the process has not, and keeps errors (error.h). May be called again. */
LAM_EXPORT int LamBindStart(void);
/* What an error code means: 'i' a mistake in an input, 'f' a file that cannot be read or written, 'm' no memory, else '
 * '. */
LAM_EXPORT char LamBindErrorKind(int code);

LAM_EXPORT size_t LamBindResponseSize(void);
/* Member i of a response; NULL behind the last. type: 'f' double, 'i' int, 'b' int that is 0 or 1, 'e' int with names,
   's' text of `count` bytes. unit: "1", "Pa", "s", "apothem", ...; help: what it is. */
LAM_EXPORT const char *LamBindMember(int i, char *type, int *count, size_t *offset, const char **unit,
                                     const char **help);
/* The name of a value that member i, of type 'e', has in a response. */
LAM_EXPORT const char *LamBindMemberName(int i, int value);

/* A text such as "0.02 MPa", in SI units; dimension: 0 a length, 1 a stress, 2 an angle, 3 a time, 4 a temperature. */
LAM_EXPORT int LamBindQuantity(const char *text, int dimension, double *value);

typedef struct LamBindScene_s *LamBindScene;
/* Of a file, or of `text`, if it is not NULL, which messages call `path`. */
LAM_EXPORT int LamBindSceneRead(const char *path, const char *text, LamBindScene *scene);
/* Units of the scene: apothem, m, and C1 + C2, Pa. */
LAM_EXPORT void LamBindSceneScales(LamBindScene scene, double scales[2]);
/* Number of the states of block `load`, and their loads, if `loads` is not NULL. */
LAM_EXPORT int LamBindSceneLoads(LamBindScene scene, double loads[]);
/* Its tissue as the material of another program: the cohesion, Pa. An error for a patch, which is no material point, and
   for sealed cells, whose turgor is not prescribed. */
LAM_EXPORT int LamBindSceneMaterial(LamBindScene scene, double *cohesion);
LAM_EXPORT void LamBindSceneDestroy(LamBindScene scene);

typedef struct LamBindRVE_s *LamBindRVE;
/* With the mesh that `lamella rve` chooses; the scene may be destroyed. */
LAM_EXPORT int LamBindRVECreate(LamBindScene scene, LamBindRVE *rve);
/* Solves n states, each from the last that converged. derivatives: 0 or 1, whether tangents are wanted. */
LAM_EXPORT int LamBindRVESolve(LamBindRVE rve, int n, const double loads[], int derivatives, void *responses);
/* The state that the next solve begins with, as bytes. */
LAM_EXPORT int LamBindRVEStateSize(LamBindRVE rve, size_t *bytes);
LAM_EXPORT int LamBindRVEGetState(LamBindRVE rve, void *bytes);
LAM_EXPORT int LamBindRVESetState(LamBindRVE rve, const void *bytes);
/* Forgets it: the next solve begins with undeformed tissue. */
LAM_EXPORT int LamBindRVEReset(LamBindRVE rve);
LAM_EXPORT void LamBindRVEDestroy(LamBindRVE rve);

typedef struct LamBindDatabase_s *LamBindDatabase;
/* An error for files of a patch, of sealed cells, and of tissue that has a history. */
LAM_EXPORT int LamBindDatabaseOpen(const char *path, LamBindDatabase *database);
LAM_EXPORT void LamBindDatabaseScales(LamBindDatabase database, double scales[2]);
/* Its tissue as the material of another program, as LamBindSceneMaterial. */
LAM_EXPORT void LamBindDatabaseMaterial(LamBindDatabase database, double *cohesion);
/* Answers n loads; may be called by several threads at a time. accuracy: largest estimated relative error of P. */
LAM_EXPORT int LamBindDatabaseQuery(LamBindDatabase database, int n, const double loads[], double accuracy,
                                    void *responses);
/* The number of its records, in the order of the file; levels, if it is not NULL: of each the refinement of the node of the
   table that it is, 0 the coarsest, or -1: it is none. */
LAM_EXPORT int LamBindDatabaseLevels(LamBindDatabase database, int levels[]);
LAM_EXPORT void LamBindDatabaseClose(LamBindDatabase database);

LAM_C_END

#endif
