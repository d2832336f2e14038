/* Exact arithmetic of one lane where C leaves the result open: the helpers of def/op.def's expressions.
 *
 * Each is the scalar form of the vector instruction that generated code uses, in C or baseline SSE2
 * intrinsics. So rounding, NaN selection, denormal flushing (MXCSR) and out-of-range conversion are the same
 * with every compiler and optimisation level. Source: Intel SDM volume 2, MINPS, MAXPS, CVTPS2DQ, CVTTPS2DQ,
 * VCVTPS2PH, PMADDWD, PMULHRSW. */
#ifndef CONTRACT_LANE_H
#define CONTRACT_LANE_H

#include "base/bits.h"

#include <emmintrin.h>
#include <math.h>
#include <stdint.h>

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

/* An operand with DAZ: a denormal becomes a zero of its sign. */
static inline float lane_flush(float a)
{
    uint32_t bits = bits_of_float(a);
    return bits_to_float(bits & 0x7f800000u ? bits : bits & 0x80000000u);
}

/* MINPS and MAXPS: the second operand if either is NaN or if both are zeros. Not by intrinsic, because gcc
 * treats the intrinsics as commutative when it folds constants. */
static inline float lane_min(float a, float b)
{
    return lane_flush(a < b ? a : b);
}

static inline float lane_max(float a, float b)
{
    return lane_flush(a > b ? a : b);
}

/* ROUNDPS; libm's portable floorf returns -1 for negative denormals. */
static inline float lane_floor(float a)
{
    return floorf(lane_flush(a));
}

/* VCVTPS2PH to nearest even, then VCVTPH2PS. Below 2^-14, binary16 has multiples of 2^-24; MXCSR does not
 * flush them. From 65520 on it is infinite. A NaN keeps the upper bits of its payload. */
static inline float lane_half(float a)
{
    uint32_t bits = bits_of_float(a), sign = bits & 0x80000000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u)
        return bits_to_float((bits | 0x00400000u) & 0xffffe000u);
    if (magnitude >= 0x477ff000u)
        return bits_to_float(sign | 0x7f800000u);
    if (magnitude >= 0x38800000u)
        return bits_to_float(sign | ((magnitude + 0xfffu + (magnitude >> 13 & 1)) & 0xffffe000u));
    if (magnitude < 0x33000000u)
        return bits_to_float(sign);
    uint32_t drop = 126 - (magnitude >> 23), fraction = (magnitude & 0x7fffffu) | 0x800000u;
    uint32_t units = (fraction + (1u << (drop - 1)) - 1 + (fraction >> drop & 1)) >> drop;
    return bits_to_float(sign | bits_of_float((float)units * 0x1p-24f));
}

static inline int32_t lane_dot(int32_t a, int32_t b)
{
    int32_t low = (int16_t)(a & 0xffff) * (int16_t)(b & 0xffff);
    int32_t high = (a >> 16) * (b >> 16);
    return (int32_t)((uint32_t)low + (uint32_t)high);
}

static inline int32_t lane_upper(int32_t a)
{
    return (int32_t)((uint32_t)a >> 16 | ((uint32_t)a & 0xffff0000u));
}

/* PMULHRSW: a half is a multiple of 2^-15, and the product is rounded to the nearest one, up if two are. */
static inline uint16_t lane_scale(uint16_t a, uint16_t b)
{
    return (uint16_t)(((int32_t)(int16_t)a * (int16_t)b + 0x4000) >> 15);
}

#endif
