#include "bundle.h"
#include <string.h>

static size_t Padded(size_t size)
{
  return (size + 7) / 8 * 8;
}

PetscErrorCode LamBundleAppend(LamBundle *bundle, const LamBundleItem *item, const void *bytes)
{
  const size_t n = bundle->n + sizeof(*item) + Padded(item->size);

  PetscFunctionBeginUser;
  if (n > bundle->room) {
    bundle->room = PetscMax(2 * bundle->room, n);
    PetscCall(PetscRealloc(bundle->room, &bundle->bytes));
  }
  memset(bundle->bytes + bundle->n, 0, n - bundle->n); /* no byte of a message is left unset */
  memcpy(bundle->bytes + bundle->n, item, sizeof(*item));
  if (item->size) memcpy(bundle->bytes + bundle->n + sizeof(*item), bytes, item->size);
  bundle->n = n;
  PetscFunctionReturn(0);
}

PetscBool LamBundleNext(const LamBundle *bundle, size_t *at, LamBundleItem *item, const void **bytes)
{
  if (*at >= bundle->n) return PETSC_FALSE;
  memcpy(item, bundle->bytes + *at, sizeof(*item));
  *bytes = bundle->bytes + *at + sizeof(*item);
  *at += sizeof(*item) + Padded(item->size);
  return PETSC_TRUE;
}

PetscErrorCode LamBundleDestroy(LamBundle *bundle)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(bundle->bytes));
  *bundle = (LamBundle){0};
  PetscFunctionReturn(0);
}
