/*
  Memory and strcmp of the C library for HDF5, those of the sanitizer for all else.

  HDF5 takes and frees thousands of blocks per input, and compares names of members as often; the sanitizer's malloc and
  strcmp take half of all time then. HDF5 is not what is tested: of its memory Lamella reads nothing but the names of
  members, and what HDF5 writes into Lamella's memory still goes through the sanitizer's memcpy and pread.
*/
#define _GNU_SOURCE /* RTLD_NEXT */
#include "hdf5_edits.h"
#include <dlfcn.h>
#include <link.h>
#include <malloc.h>
#include <string.h>

#define PLAIN __attribute__((no_sanitize("address", "undefined", "coverage")))

/* of the sanitizer */
void *__interceptor_malloc(size_t size);
void *__interceptor_calloc(size_t n, size_t size);
void *__interceptor_realloc(void *memory, size_t size);
void __interceptor_free(void *memory);
char *__interceptor_strdup(const char *text);
int __interceptor_strcmp(const char *a, const char *b);
int __sanitizer_get_ownership(const volatile void *memory);
/* of the C library */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *memory, size_t size);
void __libc_free(void *memory);

static uintptr_t begin, end; /* of HDF5's code */
static int (*compare)(const char *, const char *);

static int FindCode(struct dl_phdr_info *library, size_t size, void *ctx)
{
  const uintptr_t inside = (uintptr_t)ctx;

  for (int i = 0; i < library->dlpi_phnum; i++) {
    const ElfW(Phdr) *part = &library->dlpi_phdr[i];
    const uintptr_t from = library->dlpi_addr + part->p_vaddr;

    if (part->p_type != PT_LOAD || inside < from || inside >= from + part->p_memsz) continue;
    begin = from;
    end = from + part->p_memsz;
    return 1;
  }
  return 0;
}

void EditsFreeHDF5(void)
{
  compare = (int (*)(const char *, const char *))dlsym(RTLD_NEXT, "strcmp");
  dl_iterate_phdr(FindCode, dlsym(RTLD_DEFAULT, "H5open"));
  mallopt(M_MMAP_THRESHOLD, 16 << 20); /* pages that are there already */
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  FuzzCheck(compare && begin, "HDF5's code is not found");
}

#define FROM_HDF5 ((uintptr_t)__builtin_return_address(0) >= begin && (uintptr_t)__builtin_return_address(0) < end)

PLAIN void *malloc(size_t size)
{
  return FROM_HDF5 ? __libc_malloc(size) : __interceptor_malloc(size);
}

PLAIN void *calloc(size_t n, size_t size)
{
  return FROM_HDF5 ? __libc_calloc(n, size) : __interceptor_calloc(n, size);
}

/* HDF5 frees also what other functions have taken for it, or it itself before it was known. */
PLAIN void free(void *memory)
{
  if (FROM_HDF5 && !__sanitizer_get_ownership(memory))
    __libc_free(memory);
  else
    __interceptor_free(memory);
}

PLAIN void *realloc(void *memory, size_t size)
{
  return FROM_HDF5 && !__sanitizer_get_ownership(memory) ? __libc_realloc(memory, size)
                                                         : __interceptor_realloc(memory, size);
}

PLAIN char *strdup(const char *text)
{
  const size_t size = strlen(text) + 1;
  char *copy;

  if (!FROM_HDF5) return __interceptor_strdup(text);
  copy = __libc_malloc(size);
  return copy ? memcpy(copy, text, size) : NULL;
}

PLAIN int strcmp(const char *a, const char *b)
{
  return FROM_HDF5 ? compare(a, b) : __interceptor_strcmp(a, b);
}
