/* The same random numbers on every machine, for tests at random states. */
#ifndef LAM_SUPPORT_RANDOM_REALS_H
#define LAM_SUPPORT_RANDOM_REALS_H

#include <stdint.h>

/* Uniform in [low, high): a 64-bit linear congruential generator (Knuth's MMIX constants). */
double RandomReal(uint64_t *seed, double low, double high);

#endif
