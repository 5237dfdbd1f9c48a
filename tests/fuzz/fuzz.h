/*
  What all targets of fuzzing share. A target is a function of bytes that someone hostile has chosen:

    int LLVMFuzzerInitialize(int *argc, char ***argv);                 once, before the first input
    int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);      0 each time; it aborts where something is wrong

  clang's libFuzzer links a main that invents inputs; standalone.c is one that only runs those that are kept.
*/
#ifndef LAM_FUZZ_H
#define LAM_FUZZ_H

#include <petscsys.h>
#include <stdint.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Ends the run; libFuzzer then keeps the input. */
#define FuzzCheck(condition, ...)                                                                                      \
  do {                                                                                                                 \
    if (!(condition)) FuzzFail(__FILE__, __LINE__, __VA_ARGS__);                                                       \
  } while (0)
void FuzzFail(const char file[], int line, const char format[], ...) __attribute__((noreturn, format(printf, 3, 4)));

/* Errors are what is provoked: their words are kept, not printed. An input that shows something is kept where the
   program was started, also where that was found in the folder below. */
void FuzzStart(int *argc, char ***argv);
const char *FuzzMessage(void); /* of the last error */

/* From here on, and before PETSc is initialised: memory that PetscMalloc gives and no one frees. */
void FuzzCountMemory(void);
size_t FuzzMemoryLeft(void);
void FuzzMemoryKeep(void); /* what has been taken so far is for the whole run */
/* A command that fails ends the program, which leaves its memory to the system; here the next input follows. */
void FuzzMemoryFree(void);

/* Of the libraries, for a target where libFuzzer gives up asking, as something always keeps memory. Slow. */
void FuzzLookForLeaks(void);

/* What the program prints is nowhere; sanitizers write to the descriptor, and are still read. */
void FuzzSilence(void);

/* A folder in memory, where there is one, that is the process's own and goes with it, becomes the working one. */
void FuzzEnterFolder(void);
void FuzzLeaveFolder(void);
void FuzzWriteFile(const char name[], const void *bytes, size_t size);

#endif
