/*
  The result file of a macroscale run, OUT.h5, and OUT.xdmf beside it; written by one rank.

  Kind "fe2", physical units, each array with its unit as attribute "unit":
    /macro/nodes            [node][2]      reference positions, mm
    /macro/elements         [element][9]   node numbers, VTK's biquadratic order
    /macro/boundaries                      names of the sides, one per line
    /macro/step/<k>/u       [node][3]      displacement, mm; the third component is 0
    /macro/step/<k>/F, P, cauchy [element][9]   means over the element, row-major; P and cauchy in MPa;
                                                cauchy over its present volume
    /macro/step/<k>/indicator [element][4] lumen, opening, debonded fraction, turgor (MPa); each also under its own name
    /macro/curve/load_factor, work [step]; /macro/curve/reaction [step][side][2], N/mm
    /macro/steps            [step]         numbers of the complete steps; written last
    /macro/status                          how the run ended; absent where a kill or an error ended it
*/
#ifndef LAM_FE2_FILE_H
#define LAM_FE2_FILE_H

#include <lamella/database.h>
#include <lamella/macro.h>

typedef struct LamFE2File_s *LamFE2File;

/*
  Borrows the scene. CREATE: nothing is visible under `path` before the first step is complete; APPEND: goes on with a
  file of the same scene, whose steps LamFE2FileArchive tells. A kill leaves the file with complete steps.
*/
PetscErrorCode LamFE2FileOpen(const char path[], LamWriteMode mode, const LamScene *scene, LamFE2File *file);
/* Writes or reads what later steps need to know of the earlier ones; collective, `file` NULL but on rank 0. */
PetscErrorCode LamFE2FileArchive(LamFE2File file, LamArchive archive);
PetscErrorCode LamFE2FileAddStep(LamFE2File file, const LamMacroStep *step, const LamMacroFields *fields);
/* `status`: "done", "stopped", or why the run did not converge; NULL after an error. */
PetscErrorCode LamFE2FileClose(LamFE2File *file, const char status[]);

#endif
