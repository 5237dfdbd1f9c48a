/*
  64-bit FNV-1a (Fowler, Noll, Vo): an identifier, not cryptographic.
*/
#ifndef LAM_HASH_H
#define LAM_HASH_H

#include <stddef.h>
#include <stdint.h>

#define LAM_HASH_START 0xcbf29ce484222325u

static inline uint64_t LamHashBytes(uint64_t hash, const void *bytes, size_t n)
{
  for (const unsigned char *b = (const unsigned char *)bytes, *end = b + n; b < end; b++)
    hash = (hash ^ *b) * 0x100000001b3u;
  return hash;
}

#endif
