/*
  Functions compiled for several processors, so that one binary is fast on each: registers of 128 and of 256 bits. Wider
  ones bring nothing to blocks of 2 x 2 and of 12 numbers. Functions that a clone calls are inlined into it, or they
  would not be compiled for its processor. Only static functions may have clones: a shared library would show others.
  The resolvers of clones run before a sanitizer is set up.
*/
#ifndef LAM_CLONES_H
#define LAM_CLONES_H

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(LAM_NO_CLONES)
#define LAM_CLONES __attribute__((target_clones("default", "arch=x86-64-v3")))
#define LAM_INLINE static inline __attribute__((always_inline))
#else
#define LAM_CLONES
#define LAM_INLINE static inline
#endif

#endif
