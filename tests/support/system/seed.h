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

/* Returns the number of random cases to try: `count`, or a quarter of it in a build with sanitizers. These do
 * not instrument generated code, and the plain build tries all cases. */
static inline unsigned test_share(unsigned count)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return (count + 3) / 4;
#else
    return count;
#endif
}

#endif
