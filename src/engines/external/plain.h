/* The beginning of the texts of external:c=plain and c=portable: C11 for any compiler and any machine with
 * the needs below. The definitions of the operations follow it; they are printed from def/op.def (plain.c).
 * No C file includes it.
 *
 * A value is one lane, and an operation is a function of lanes. The routine has loops over the lanes of the
 * values; a value that two loops use is an array. There are no vector types, builtins, intrinsics or accesses
 * through another type: bits change their type by memcpy.
 *
 * The text needs:
 *   - binary32 and binary64 of IEEE 754, without excess precision (FLT_EVAL_METHOD 0), rounded to nearest
 *     even; fmaf with one rounding; products and sums that are not contracted
 *   - FLUSHES 1: operations on binary32 take denormal operands as zero and return zero for denormal results,
 *     tiny after rounding (FTZ and DAZ of x86-64); FLUSHES 0: operations that keep denormals, as ISO C has
 *     them. The text flushes by itself then
 *   - integers in two's complement, an arithmetic shift to the right, conversions modulo 2^32
 *   - little-endian words and pointers of 8 bytes: the offsets in the text are those of the renderer's
 *     structures
 *   - WIDTH lanes run together: a multiple of 4, because permute_f reads other lanes of a quad
 * It calls fmaf, floorf, rintf, sqrtf and memcpy, nothing else. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#pragma STDC FP_CONTRACT OFF

#ifndef WIDTH
#define WIDTH 8
#endif
#ifndef FLUSHES
#define FLUSHES 1
#endif

typedef float flt;
typedef int32_t itg;
typedef int32_t msk;  /* 0 or -1 */
typedef uint32_t fix; /* two integers of 16 bits */

/* Zero, but unknown to the compiler: another file could change it, and none does. Compilers fold constants
 * without flushing denormals, and replace x - 0 by x. The bits of floats therefore pass through it. */
uint32_t opaque_zero = 0;

static inline uint32_t bits_of_float(float a)
{
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}

static inline float bits_to_float(uint32_t bits)
{
    float a;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* --- One lane: the helpers of the expressions, as in contract/lane.h ------------------------------------ */

/* A denormal becomes a zero of its sign. */
static inline float lane_flush(float a)
{
    uint32_t bits = bits_of_float(a);
    return bits_to_float(bits & 0x7f800000u ? bits : bits & 0x80000000u);
}

static inline float lane_sqrt(float a)
{
    return sqrtf(a);
}

/* The second operand if either is NaN or if both are zeros. */
static inline float lane_min(float a, float b)
{
    return lane_flush(a < b ? a : b);
}

static inline float lane_max(float a, float b)
{
    return lane_flush(a > b ? a : b);
}

static inline float lane_floor(float a)
{
    return floorf(lane_flush(a));
}

/* INT32_MIN for NaN and for all that an int32_t does not hold. */
static inline int32_t lane_truncate(float a)
{
    return a >= -0x1p31f && a < 0x1p31f ? (int32_t)a : INT32_MIN;
}

static inline int32_t lane_round(float a)
{
    return lane_truncate(rintf(a));
}

/* To binary16, to nearest even, and back. */
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

static inline uint16_t lane_scale(uint16_t a, uint16_t b)
{
    return (uint16_t)(((int32_t)(int16_t)a * (int16_t)b + 0x4000) >> 15);
}

/* --- FLUSHES 0: arithmetic that flushes ----------------------------------------------------------------- */

/* Results are zero if they are tiny after rounding: rounded to 24 bits with an exponent of any size, they are
 * below 2^-126. That is so below TINY, which is halfway between 2^-126 and the next number below it. */
#define TINY (0x1p-126 - 0x1p-151)

static inline float signed_zero(double like)
{
    return copysignf(0.0f, (float)like);
}

static inline float flushed_add_f(float a, float b)
{
    return lane_flush(lane_flush(a) + lane_flush(b)); /* a sum that is tiny is exact */
}

static inline float flushed_sub_f(float a, float b)
{
    return lane_flush(lane_flush(a) - lane_flush(b));
}

static inline float flushed_mul_f(float a, float b)
{
    double product = (double)lane_flush(a) * lane_flush(b); /* exact */
    return fabs(product) < TINY ? signed_zero(product) : (float)product;
}

/* The quotient of two floats is not so close to TINY that rounding it to a double could pass it. */
static inline float flushed_div_f(float a, float b)
{
    double quotient = (double)lane_flush(a) / lane_flush(b);
    return fabs(quotient) < TINY ? signed_zero(quotient) : (float)quotient;
}

/* The sum is rounded; where that could pass TINY, the sign of the error decides. */
static inline float flushed_mad_f(float a, float b, float c)
{
    a = lane_flush(a), b = lane_flush(b), c = lane_flush(c);
    double product = (double)a * b, sum = product + c, part = sum - product;
    double error = (product - (sum - part)) + (c - part);
    int is_tiny = fabs(sum) < TINY || (fabs(sum) == TINY && (sum < 0 ? error > 0 : error < 0));
    return is_tiny ? signed_zero(sum) : fmaf(a, b, c);
}

static inline float flushed_sqrt_f(float a)
{
    return sqrtf(lane_flush(a));
}

static inline float flushed_min_f(float a, float b)
{
    return lane_min(lane_flush(a), lane_flush(b));
}

static inline float flushed_max_f(float a, float b)
{
    return lane_max(lane_flush(a), lane_flush(b));
}

static inline int32_t flushed_lt_f(float a, float b)
{
    return -(lane_flush(a) < lane_flush(b));
}

static inline int32_t flushed_le_f(float a, float b)
{
    return -(lane_flush(a) <= lane_flush(b));
}

static inline int32_t flushed_eq_f(float a, float b)
{
    return -(lane_flush(a) == lane_flush(b));
}

static inline int32_t flushed_ne_f(float a, float b)
{
    return -(lane_flush(a) != lane_flush(b));
}

/* --- Values --------------------------------------------------------------------------------------------- */

static inline itg all_lanes(uint32_t a)
{
    return (itg)a;
}

static inline flt literal_f(uint32_t bits)
{
    return bits_to_float(bits ^ opaque_zero);
}

/* The same bits as another type: TO_of_FROM. */
#define flt_of_itg(a) literal_f((uint32_t)(a))
#define flt_of_msk(a) literal_f((uint32_t)(a))
#define flt_of_fix(a) literal_f(a)
#define itg_of_flt(a) ((itg)bits_of_float(a))
#define itg_of_fix(a) ((itg)(a))
#define itg_of_msk(a) ((itg)(a))
#define fix_of_flt(a) bits_of_float(a)
#define fix_of_itg(a) ((fix)(a))
#define fix_of_msk(a) ((fix)(a))
#define msk_of_flt(a) ((msk)bits_of_float(a))
#define msk_of_itg(a) ((msk)(a))
#define msk_of_fix(a) ((msk)(a))

static inline fix two_halves(uint16_t low, uint16_t high)
{
    return low | (fix)high << 16;
}

/* Of arrays. */
static inline int any(const msk a[WIDTH])
{
    msk found = 0;
    for (int i = 0; i < WIDTH; i++)
        found |= a[i];
    return found != 0;
}

/* Of lane i; `a` is an array. */
#define permute_f(a, k) a[(i & ~3) + ((k) >> 2 * (i & 3) & 3)]

/* --- Memory --------------------------------------------------------------------------------------------- */

static inline int read_int(const char *at)
{
    int32_t word;
    memcpy(&word, at, sizeof word);
    return word;
}

static inline int read_short(const char *at)
{
    uint16_t word;
    memcpy(&word, at, sizeof word);
    return word;
}

static inline char *read_pointer(const char *at)
{
    char *pointer;
    memcpy(&pointer, at, sizeof pointer);
    return pointer;
}

static inline flt load_f(const char *at)
{
    flt a;
    memcpy(&a, at, sizeof a);
    return a;
}

#define load_i(at)                     ((itg)read_int(at))
#define uniform_f(at)                  load_f(at)
#define uniform_i(at)                  load_i(at)
#define gather_f(start, index, scale)  load_f((start) + (ptrdiff_t)(index) * (scale))
#define gather_i(start, index, scale)  load_i((start) + (ptrdiff_t)(index) * (scale))

static inline void store_f(char *at, flt a)
{
    memcpy(at, &a, sizeof a);
}

static inline void store_i(char *at, itg a)
{
    memcpy(at, &a, sizeof a);
}

/* --- The operations of def/op.def ----------------------------------------------------------------------- */

