#include "random_key.h"

#include <string.h>

static uint64_t next_random(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return *seed * 0x2545f4914f6cdd1dull;
}

void key_random(enum unit unit, uint64_t *seed, union key *key)
{
    memset(key, 0, sizeof *key);
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++)
        for (unsigned j = 0; j < field[i].count; j++)
            ((uint8_t *)key)[field[i].offset + j] = (next_random(seed) >> 33) % field[i].radix;
}
