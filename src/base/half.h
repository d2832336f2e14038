/* Conversion between IEEE 754 binary16 and binary32, with integer operations only: the result is the same on
 * every processor and in every floating-point environment.
 *
 * Every binary16 number, denormals included, is a normal binary32 number or zero. Conversion to binary16
 * rounds to nearest even. Magnitudes that round above 65504 become infinite; a NaN stays a NaN. */
#ifndef BASE_HALF_H
#define BASE_HALF_H

#include "base/bits.h"

#include <stdint.h>

static inline float half_to_float(uint16_t half)
{
    uint32_t sign = (uint32_t)(half & 0x8000) << 16, exponent = half >> 10 & 31, fraction = half & 0x3ff,
             bits;
    if (exponent == 31) {
        bits = 0x7f800000 | fraction << 13;
    } else if (exponent) {
        bits = (exponent + 112) << 23 | fraction << 13;
    } else if (fraction) {
        int shift = __builtin_clz(fraction) - 21;
        bits = (uint32_t)(113 - shift) << 23 | (fraction << shift & 0x3ff) << 13;
    } else {
        bits = 0;
    }
    bits |= sign;
    return bits_to_float(bits);
}

static inline uint16_t float_to_half(float value)
{
    uint32_t bits = bits_of_float(value);
    uint32_t sign = bits >> 16 & 0x8000, magnitude = bits & 0x7fffffff;
    if (magnitude > 0x7f800000)
        return (uint16_t)(sign | 0x7e00);
    if (magnitude >= 0x477ff000)
        return (uint16_t)(sign | 0x7c00);
    if (magnitude < 0x33000001) /* up to half of the smallest denormal */
        return (uint16_t)sign;
    uint32_t exponent = magnitude >> 23, fraction = (magnitude & 0x7fffff) | 0x800000;
    uint32_t drop = exponent < 113 ? 126 - exponent : 13;
    uint32_t kept = fraction >> drop, rest = fraction & ((1u << drop) - 1), half = 1u << (drop - 1);
    kept += rest > half || (rest == half && (kept & 1));
    return (uint16_t)(sign | (exponent < 113 ? kept : kept + ((exponent - 113) << 10)));
}

#endif
