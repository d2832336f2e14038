/* The seed of random tests and the number of their cases. Long runs (make soak) set the environment variable
 * TRIPTYCH_SEED; without it, the seed is the same in every run. */
#ifndef TESTS_SUPPORT_SYSTEM_SEED_H
#define TESTS_SUPPORT_SYSTEM_SEED_H

#include <stdint.h>
#include <stdlib.h>

/* Returns the seed, never 0. */
static inline uint64_t test_seed(void)
{
    const char *given = getenv("TRIPTYCH_SEED");
    uint64_t number = given ? strtoull(given, NULL, 10) : 0;
    return 0x9e3779b97f4a7c15 ^ number * 0xbf58476d1ce4e5b9;
}

/* A build with sanitizers tries every fourth case where the subject is generated code, which sanitizers do
 * not instrument; the plain build tries all. With the environment variable THOROUGH=1 all builds do. */
static inline unsigned test_stride(void)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return getenv("THOROUGH") ? 1 : 4;
#else
    return 1;
#endif
}

/* Returns the number of cases to try of `count`. */
static inline unsigned test_share(unsigned count)
{
    return (count + test_stride() - 1) / test_stride();
}

#endif
