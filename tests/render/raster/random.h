/* Random numbers, the same in each run. */
#ifndef TESTS_RENDER_RASTER_RANDOM_H
#define TESTS_RENDER_RASTER_RANDOM_H

#include <stdint.h>

static uint64_t random_state;

/* Restarts the sequence. */
static inline void random_begin(void)
{
    random_state = 20240117;
}

static inline uint32_t draw(void) /* xorshift64* */
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (uint32_t)(random_state * 0x2545F4914F6CDD1DULL >> 32);
}

static inline int32_t between(int32_t low, int32_t high) /* both included */
{
    return low + (int32_t)(draw() % ((uint32_t)(high - low) + 1));
}

#endif
