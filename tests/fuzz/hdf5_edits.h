/*
  Files that someone has changed. Bytes changed at random die in HDF5's own checks, or at our checksums; who means harm
  writes checksums that are right. So the input of a target is no file but what to do to a sound one:

    file, question, then edits: what to do, with what, how

  one byte each, with numbers behind them where an edit takes some; of what is missing at the end all is 0. The sound
  files are tests/fuzz/files. Edits keep checksums right unless the highest bit of `question` is set.
*/
#ifndef LAM_HDF5_EDITS_H
#define LAM_HDF5_EDITS_H

#include "fuzz.h"
#include <hdf5.h>

/* names: of tests/fuzz/files, without .h5.gz. */
void EditsLoadFiles(int n, const char *const names[]);
/* Writes the file that the input describes. Returns its question, and in *file which of the sound files it was. Until
   it is released the file is open for reading, where HDF5 can open it. */
int EditsMakeFile(const uint8_t *input, size_t size, const char path[], int *file);
void EditsReleaseFile(void);
/* Behind an input. Every thousand leaks are looked for, and HDF5 begins anew. */
void EditsEndInput(void);
/* From here on HDF5 has its memory from the C library: hdf5_plain.c. */
void EditsFreeHDF5(void);
/* Files, types, spaces, lists and what else HDF5 has open. */
hsize_t EditsCountOpen(void);

#endif
