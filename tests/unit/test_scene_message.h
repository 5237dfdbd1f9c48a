/* For tests of scene reading: runs a call that should fail and keeps its message instead of printing it. */
#ifndef LAM_TEST_SCENE_MESSAGE_H
#define LAM_TEST_SCENE_MESSAGE_H

#include <lamella/scene.h>
#include <string.h>

static char scene_message[1024];

static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode error,
                                  PetscErrorType type, const char *message, void *ctx)
{
  if (type == PETSC_ERROR_INITIAL) snprintf(scene_message, sizeof(scene_message), "%s", message);
  return error;
}

/* Sets scene_message to what the call says, "" on success, and is the call's error. */
#define CATCH(call, error)                                                                                             \
  do {                                                                                                                 \
    PetscErrorHandlingInitialized = PETSC_TRUE; /* before PetscInitialize PETSc calls no handler else */               \
    scene_message[0] = '\0';                                                                                           \
    assert_int_equal(PetscPushErrorHandler(KeepMessage, NULL), 0);                                                     \
    (error) = (call);                                                                                                  \
    assert_int_equal(PetscPopErrorHandler(), 0);                                                                       \
  } while (0)

#endif
