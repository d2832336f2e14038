/* One lane's exact arithmetic, where C's own operators leave room: the helpers that def/op.def's expressions
 * use.
 *
 * Each is the scalar form of the vector instruction that the generated code uses, in C or baseline SSE2
 * intrinsics, so that rounding, NaN selection, denormal flushing (MXCSR) and out-of-range conversion agree on
 * every compiler and optimisation level. Source: Intel SDM volume 2, MINPS, MAXPS, CVTPS2DQ, CVTTPS2DQ,
 * VCVTPS2PH, PMADDWD. */
#ifndef DEF_LANE_H
#define DEF_LANE_H

#include <emmintrin.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static inline float lane_sqrt(float a)
{
    return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(a)));
}

static inline int32_t lane_round(float a)
{
    return _mm_cvtss_si32(_mm_set_ss(a));
}

static inline int32_t lane_truncate(float a)
{
    return _mm_cvttss_si32(_mm_set_ss(a));
}

static inline uint32_t lane_bits(float a)
{
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}

static inline float lane_from_bits(uint32_t bits)
{
    float a;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* What DAZ makes of an operand: a denormal is a zero of its sign. */
static inline float lane_flush(float a)
{
    uint32_t bits = lane_bits(a);
    return lane_from_bits(bits & 0x7f800000u ? bits : bits & 0x80000000u);
}

/* MINPS and MAXPS: the second operand when either is NaN and when both are zeros. Not by intrinsic: gcc takes
 * those for commutative when it folds constants. */
static inline float lane_min(float a, float b)
{
    return lane_flush(a < b ? a : b);
}

static inline float lane_max(float a, float b)
{
    return lane_flush(a > b ? a : b);
}

/* ROUNDPS; libm's portable floorf would see a denormal and return -1. */
static inline float lane_floor(float a)
{
    return floorf(lane_flush(a));
}

/* VCVTPS2PH to nearest even, then VCVTPH2PS. Below 2^-14 binary16 has multiples of 2^-24, whatever MXCSR says
 * of denormals; from 65520 on it is infinite; a NaN stays one with the upper bits of its payload. */
static inline float lane_half(float a)
{
    uint32_t bits = lane_bits(a), sign = bits & 0x80000000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u)
        return lane_from_bits((bits | 0x00400000u) & 0xffffe000u);
    if (magnitude >= 0x477ff000u)
        return lane_from_bits(sign | 0x7f800000u);
    if (magnitude >= 0x38800000u)
        return lane_from_bits(sign | ((magnitude + 0xfffu + (magnitude >> 13 & 1)) & 0xffffe000u));
    if (magnitude < 0x33000000u)
        return lane_from_bits(sign);
    uint32_t drop = 126 - (magnitude >> 23), fraction = (magnitude & 0x7fffffu) | 0x800000u;
    uint32_t units = (fraction + (1u << (drop - 1)) - 1 + (fraction >> drop & 1)) >> drop;
    return lane_from_bits(sign | lane_bits((float)units * 0x1p-24f));
}

static inline int32_t lane_dot(int32_t a, int32_t b)
{
    int32_t low = (int16_t)(a & 0xffff) * (int16_t)(b & 0xffff);
    int32_t high = (a >> 16) * (b >> 16);
    return (int32_t)((uint32_t)low + (uint32_t)high);
}

#endif
