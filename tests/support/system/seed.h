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

/* Sanitizers check that the library accesses no memory wrongly and has no undefined behaviour. A few cases of
 * each kind show that. The plain build checks results. So a build with sanitizers tries every `stride`-th
 * case. The environment variable THOROUGH=1 makes all builds try all cases. With QUICK=1 the plain build
 * tries as few as those with sanitizers.
 *
 * A stride has no common divisor with the period of a loop whose cases differ in kind, or kinds are lost. */
static inline unsigned test_stride_of(unsigned stride)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return getenv("THOROUGH") ? 1 : stride;
#else
    return getenv("QUICK") ? stride : 1;
#endif
}

/* Returns the step of a loop over cases that other cases resemble: 1 with THOROUGH=1, and else `plain`, or
 * `stride` as above. */
static inline unsigned test_step(unsigned plain, unsigned stride)
{
    unsigned step = test_stride_of(stride);
    return step > 1 || getenv("THOROUGH") ? step : plain;
}

/* Returns the number of random cases to try of `count`: at most every fourth one, with sanitizers or QUICK=1
 * half of every `stride`-th, and all with THOROUGH=1. They are the same in each run, so more of them would
 * find little. `make soak` has others. */
static inline unsigned test_share_of(unsigned count, unsigned stride)
{
    unsigned part = test_stride_of(stride);
    if (part > 1)
        part *= 2;
    if (part < 4 && !getenv("THOROUGH"))
        part = 4;
    return (count + part - 1) / part;
}

/* The usual stride. Loops of very many cases have larger ones. */
static inline unsigned test_stride(void)
{
    return test_stride_of(4);
}

static inline unsigned test_share(unsigned count)
{
    return test_share_of(count, 4);
}

#endif
