/*
  The result file of a macroscale run, OUT.h5, with OUT.xdmf and OUT.csv beside it; written by one rank.

  Kind "fe2", physical units, each array with its unit as attribute "unit":
    /macro/nodes            [node][2]      reference positions, mm
    /macro/elements, topology              node numbers, VTK's order of quadratic elements: xdmf.h
    /macro/boundaries                      names of the sides, one per line
    /macro/step/<k>/u       [node][3]      displacement, mm; the third component is 0
    /macro/step/<k>/F, P, cauchy [element][9]   means over the element, row-major; P and cauchy in MPa;
                                                cauchy over its present volume
    /macro/step/<k>/<name>  [element]      means (<name>) and largest values (<name>_max) of what points keep, and both
                                           over the scene's strengths (<name>_ratio, <name>_ratio_max): fe2_fields.h
    /macro/curve/<name>     [step]; /macro/curve/displacement, reaction [step][side][2], mm and N/mm: fe2_curve.h
    /macro/summary                         JSON, of the steps so far: fe2_summary.h
    /macro/steps            [step]         numbers of the complete steps; written last
    /macro/status                          how the run ended; absent where a kill or an error ended it
*/
#ifndef LAM_FE2_FILE_H
#define LAM_FE2_FILE_H

#include "fe2_summary.h"

typedef struct LamFE2File_s *LamFE2File;

/*
  Borrows the scene. CREATE: nothing is visible under `path` before the first step is complete; APPEND: goes on with a
  file of the same scene, whose steps LamFE2FileArchive tells. A kill leaves the file with complete steps.
*/
PetscErrorCode LamFE2FileOpen(const char path[], LamWriteMode mode, const LamScene *scene, LamFE2File *file);
/* Writes or reads what later steps need to know of the earlier ones; collective, `file` NULL but on rank 0. */
PetscErrorCode LamFE2FileArchive(LamFE2File file, LamArchive archive);
/* `summary` knows the step already. */
PetscErrorCode LamFE2FileAddStep(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields,
                                 const LamSummary *summary);
/* What else is written with each step, as one with it. */
void LamFE2FileSetBeside(LamFE2File file, PetscErrorCode (*write)(LamRecordWriter writer, void *ctx), void *ctx);
/* For what is written beside the steps; borrowed. */
LamRecordWriter LamFE2FileWriter(LamFE2File file);
/* `status`: "done", "stopped", or why the run did not converge; NULL after an error. */
PetscErrorCode LamFE2FileClose(LamFE2File *file, const char status[]);

#endif
