/*
  Bundles: several pieces or results in one message.
*/
#ifndef LAM_BUNDLE_H
#define LAM_BUNDLE_H

#include <petscsys.h>

typedef struct {
  size_t n, room;
  char *bytes; /* [n]; owned */
} LamBundle;

/* What lies before the bytes of each item, which are padded to a multiple of 8. */
typedef struct {
  PetscInt64 piece;
  PetscReal cost; /* predicted */
  size_t size;    /* of the bytes */
} LamBundleItem;

PetscErrorCode LamBundleAppend(LamBundle *bundle, const LamBundleItem *item, const void *bytes);
/* Goes through a bundle: *at is 0 at first. PETSC_FALSE at the end. `bytes` point into the bundle. */
PetscBool LamBundleNext(const LamBundle *bundle, size_t *at, LamBundleItem *item, const void **bytes);
PetscErrorCode LamBundleDestroy(LamBundle *bundle);

#endif
