/* Random numbers of the fuzzer and of the tests: splitmix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom
 * Number Generators, OOPSLA 2014). A case's numbers depend only on the seed of the campaign and the number of
 * the case, so any case can be made again without those before it. */
#ifndef BASE_RANDOM_H
#define BASE_RANDOM_H

#include <stdbool.h>
#include <stdint.h>

struct random {
    uint64_t state;
};

static inline uint64_t random_u64(struct random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

/* The numbers of case `number` of campaign `seed`. */
static inline struct random random_start(uint64_t seed, uint64_t number)
{
    struct random first = {seed};
    struct random second = {random_u64(&first) ^ number};
    return (struct random){random_u64(&second)};
}

/* From 0 to limit - 1; limit is not 0. */
static inline uint32_t random_below(struct random *random, uint32_t limit)
{
    return (uint32_t)((random_u64(random) >> 32) * limit >> 32);
}

/* From least to most, both included. */
static inline int32_t random_between(struct random *random, int32_t least, int32_t most)
{
    return (int32_t)(least + (int64_t)random_below(random, (uint32_t)(most - least) + 1));
}

/* Returns true with probability 1 / one_in. */
static inline bool random_chance(struct random *random, uint32_t one_in)
{
    return random_below(random, one_in) == 0;
}

/* Uniform between the two, on a grid of 4096 steps: short in text. */
static inline float random_float(struct random *random, float least, float most)
{
    return least + (most - least) * (float)random_below(random, 4097) / 4096;
}

#endif
