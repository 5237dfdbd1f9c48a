/*
  What other languages call: functions whose arguments are numbers, texts, arrays of numbers and handles. Values are SI.

  Each function that returns an int returns 0, or an error code; LamErrorMessage then has the message, and where it is
  about a scene its file, line, column and key. A state that has no answer is no error: its response says so.

  Loads are rows of 11 numbers: F row by row, turgor and cohesion. Where components of P are prescribed instead, F is
  NaN and a row of 9 numbers has P, NaN where F is given. Responses are rows of LamBindResponseSize() bytes, whose
  members LamBindMember tells.
*/
#ifndef LAMELLA_BIND_H
#define LAMELLA_BIND_H

#include <stddef.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Starts MPI and PETSc where the process has not, for this rank alone: no call here waits for other ranks. Keeps errors
   (error.h). May be called again. */
LAM_EXPORT int LamBindStart(void);
/* What LamBindStart has started in a job of several ranks: 0 nothing; 1 PETSc; 2 MPI, too, whose world is this rank. A
   program that uses them with its other ranks must start them before. */
LAM_EXPORT int LamBindStartedAlone(void);
/* What an error code means: 'i' a mistake in an input, 'f' a file that cannot be read or written, 'm' no memory, else '
 * '. */
LAM_EXPORT char LamBindErrorKind(int code);

LAM_EXPORT size_t LamBindResponseSize(void);
/* Member i of a response; NULL behind the last. type: 'f' double, 'i' int, 'b' int that is 0 or 1, 'e' int with names,
   's' text of `count` bytes. unit: "1", "Pa", "m", "s", ...; help: what it is. */
LAM_EXPORT const char *LamBindMember(int i, char *type, int *count, size_t *offset, const char **unit,
                                     const char **help);
/* The name of a value that member i, of type 'e', has in a response. */
LAM_EXPORT const char *LamBindMemberName(int i, int value);

/* A text such as "0.02 MPa", in SI units; dimension: 0 a length, 1 a stress, 2 an angle, 3 a time, 4 a temperature, -1
   any that scenes have. */
LAM_EXPORT int LamBindQuantity(const char *text, int dimension, double *value);

typedef struct LamBindScene_s *LamBindScene;
/* Of a file, or of `text`, if it is not NULL, which messages call `path`. */
LAM_EXPORT int LamBindSceneRead(const char *path, const char *text, LamBindScene *scene);
/* Apothem, m; C1 + C2, turgor and cohesion of block `rve`, Pa. */
LAM_EXPORT void LamBindSceneNumbers(LamBindScene scene, double numbers[4]);
/* The k-th file that it names, from 0, as it is opened; NULL behind the last. */
LAM_EXPORT const char *LamBindSceneFile(LamBindScene scene, int k);
/* Number of the states of block `load`, and their loads and P, if `loads` is not NULL. Both F and P are NaN on a ramp
   from an F that is found. */
LAM_EXPORT int LamBindSceneLoads(LamBindScene scene, double loads[], double P[]);
/* Why LamBindSceneLoads does not have the loads as they are solved; NULL: it has. */
LAM_EXPORT const char *LamBindSceneLoadsAreOpen(LamBindScene scene);
/* An error unless its tissue can be the material of another program: a patch is no material point, and the turgor of
   sealed cells is not prescribed. */
LAM_EXPORT int LamBindSceneIsMaterial(LamBindScene scene);
LAM_EXPORT void LamBindSceneDestroy(LamBindScene scene);

typedef struct LamBindRVE_s *LamBindRVE;
/* With the mesh that `lamella rve` chooses; the scene may be destroyed. */
LAM_EXPORT int LamBindRVECreate(LamBindScene scene, LamBindRVE *rve);
/* Solves n states, each from the last that converged. P: NULL where F is given in all. derivatives, estimate: 0 or 1,
   whether tangents and estimates of the error are wanted. */
LAM_EXPORT int LamBindRVESolve(LamBindRVE rve, int n, const double loads[], const double P[], int derivatives,
                               int estimate, void *responses);
/* Solves the loads of the scene from undeformed tissue, as `lamella rve`. responses: room for LamBindSceneLoads of
   them; *count: those solved. */
LAM_EXPORT int LamBindRVESolveOwnLoads(LamBindRVE rve, int derivatives, int estimate, void *responses, int *count);
/* What is read off the curve of the loads that LamBindRVESolveOwnLoads has solved last, as `lamella rve --readings
   --json` has it; NULL: there is no curve. Slopes are those of the curve only with derivatives. Valid until the next
   solve. */
LAM_EXPORT const char *LamBindRVEReadings(LamBindRVE rve);
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
/* Apothem, m; C1 + C2, and turgor and cohesion of queries without them, Pa; wanted accuracy. */
LAM_EXPORT void LamBindDatabaseNumbers(LamBindDatabase database, double numbers[5]);
/* Answers n loads; may be called by several threads at a time. accuracy: largest estimated relative error of P. */
LAM_EXPORT int LamBindDatabaseQuery(LamBindDatabase database, int n, const double loads[], double accuracy,
                                    void *responses);
/* The number of its records, in the order of the file; levels, if it is not NULL: of each the refinement of the node of
   the table that it is, 0 the coarsest, or -1: it is none. */
LAM_EXPORT int LamBindDatabaseLevels(LamBindDatabase database, int levels[]);
LAM_EXPORT void LamBindDatabaseClose(LamBindDatabase database);

LAM_C_END

#endif
