/*
  The result file of a macroscale run, OUT.h5, with OUT.xdmf and OUT.csv beside it; written by one rank.

  Kind "fe2", physical units, each array with its unit as attribute "unit":
    /macro/nodes            [node][2]      reference positions, mm
    /macro/gripped          [node]         LamMacroFields.gripped
    /macro/elements, topology              node numbers in VTK's order for quadratic elements: fe2_file.c
    /macro/boundaries                      names of the sides, one per line
    /macro/step/<k>/u       [node][3]      displacement, mm; the third component is 0
    /macro/step/<k>/F, P, cauchy [element][9]   means over the element, row-major; P and cauchy in MPa;
                                                cauchy over the deformed volume
    /macro/step/<k>/<name>  [element]      means (<name>) and largest values (<name>_max) over the material points, and
                                           their ratios to the strengths that the scene gives (<name>_ratio,
                                           <name>_ratio_max); ellipticity has <name>_min, its smallest value
    /macro/step/<k>/obstacles [o][6]       plates and indenters: LamMacroStep.obstacle, mm and 1
    /macro/curve/<name>     [step]; /macro/curve/displacement, reaction [step][side][2], mm and N/mm: fe2_curve.h
    /macro/summary                         JSON, for the steps so far: fe2_summary.h
    /macro/steps            [step]         numbers of the complete steps; written last
    /macro/status                          how the run ended; absent after a kill or an error
*/
#ifndef LAM_FE2_FILE_H
#define LAM_FE2_FILE_H

#include "fe2_summary.h"

typedef struct LamFE2File_s *LamFE2File;

/*
  Borrows the scene. CREATE: nothing is visible under `path` before the first step is complete. APPEND: extends a file
  of the same scene; LamFE2FileArchive restores the list of its steps. After a kill the file holds complete steps only.
*/
PetscErrorCode LamFE2FileOpen(const char path[], LamWriteMode mode, const LamScene *scene, LamFE2File *file);
/* Writes or reads the data of earlier steps that later steps need. Collective; `file` is NULL except on rank 0. */
PetscErrorCode LamFE2FileArchive(LamFE2File file, LamArchive archive);
/* `summary` must already contain the step. */
PetscErrorCode LamFE2FileAddStep(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields,
                                 const LamSummary *summary);
/* Sets a function that writes further data with each step, in the same commit. `ctx` is borrowed. */
void LamFE2FileSetBeside(LamFE2File file, PetscErrorCode (*write)(LamRecordWriter writer, void *ctx), void *ctx);
/* The writer, for data other than the steps; borrowed. */
LamRecordWriter LamFE2FileWriter(LamFE2File file);
/* `status`: "done", "stopped", or why the run did not converge; NULL after an error. */
PetscErrorCode LamFE2FileClose(LamFE2File *file, const char status[]);

#endif
