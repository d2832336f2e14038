#include "command/fuzz/case/wild.h"

#include "base/bits.h"

#include <math.h>

uint32_t wild_bits(struct random *random)
{
    static const uint32_t bits[] = {
        0x00000000, 0x80000000, 0x00000001, 0x807fffff, 0x00800000, 0x80800000, 0x3f800000, 0xbf800000,
        0x3f7fffff, 0x3f800001, 0x3f000000, 0x3effffff, 0x40000000, 0x437f0000, 0x47ffff80, 0x4b000000,
        0x4b800000, 0x4f000000, 0xcf000000, 0x4f800000, 0x5f000000, 0x7f000000, 0x7f7fffff, 0xff7fffff,
        0x7f800000, 0xff800000, 0x7fc00000, 0xffc00000, 0x7f800001, 0x33800000, 0x1e3ce508, 0x0da24260};
    return random_chance(random, 4) ? (uint32_t)random_u64(random)
                                    : bits[random_below(random, sizeof bits / sizeof *bits)];
}

float wild_float(struct random *random)
{
    float value;
    do
        value = bits_to_float(wild_bits(random));
    while (!isfinite(value));
    return value;
}
