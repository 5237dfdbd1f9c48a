/* The same random numbers on every machine, for tests at random states. */
#ifndef LAM_RANDOM_REALS_H
#define LAM_RANDOM_REALS_H

#include <stdint.h>

/* Uniform in [low, high): a 64-bit linear congruential generator (Knuth's MMIX constants). */
static inline double RandomReal(uint64_t *seed, double low, double high)
{
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * (double)(*seed >> 11) / 9007199254740992.0;
}

#endif
