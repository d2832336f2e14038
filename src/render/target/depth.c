#include "render/target/depth.h"

#include "base/bits.h"
#include "contract/lane.h"
#include "machine/cpu.h"

#include <immintrin.h>

enum { STENCIL_BITS = 8, FRACTION_BITS = 20, FRACTION_SHIFT = 23 - FRACTION_BITS };

const struct depth_format depth_formats[TRIPTYCH_DEPTH_COUNT] = {
#define DEPTH_FORMAT(name, word, storage, depth, stencil, meaning) {DEPTH_##storage, depth, stencil, #word},
#include "def/state/depth_format.def"
#undef DEPTH_FORMAT
};

uint32_t depth_mask(enum triptych_depth_format format)
{
    const struct depth_format *f = depth_formats + format;
    if (!f->depth_bits)
        return 0;
    return f->storage == DEPTH_UNORM || f->storage == DEPTH_FLOAT24 ? 0xffffff00 : 0xffffffff;
}

uint32_t stencil_mask(enum triptych_depth_format format)
{
    return (1u << depth_formats[format].stencil_bits) - 1;
}

float depth_maximum(enum triptych_depth_format format)
{
    const struct depth_format *f = depth_formats + format;
    return f->storage == DEPTH_UNORM ? (float)((1u << f->depth_bits) - 1) : 0;
}

static uint32_t encode_unorm32(float depth)
{
    float scaled = depth * 65536.0f;
    int32_t high = lane_truncate(scaled);
    int32_t low = lane_round((scaled - (float)high) * 65536.0f);
    return ((uint32_t)high << 16) + (uint32_t)low - (depth > 0.5f);
}

static uint32_t encode_float24(float depth)
{
    uint32_t bits = bits_of_float(depth);
    if (depth < DEPTH_FLOAT24_NORMAL)
        return (uint32_t)lane_round(depth * DEPTH_FLOAT24_UNITS);
    bits += (1u << (FRACTION_SHIFT - 1)) - 1 + (bits >> FRACTION_SHIFT & 1);
    return (bits - DEPTH_FLOAT24_BIAS) >> FRACTION_SHIFT;
}

uint32_t depth_encode(enum triptych_depth_format format, float depth)
{
    switch (depth_formats[format].storage) {
    case DEPTH_UNORM: return (uint32_t)lane_round(depth * depth_maximum(format)) << STENCIL_BITS;
    case DEPTH_UNORM32: return encode_unorm32(depth);
    case DEPTH_FLOAT24: return encode_float24(depth) << STENCIL_BITS;
    case DEPTH_FLOAT:
    case DEPTH_STORAGE_COUNT: break;
    }
    return bits_of_float(depth);
}

static float decode_float24(uint32_t code)
{
    if (!(code >> FRACTION_BITS))
        return (float)code / DEPTH_FLOAT24_UNITS;
    return bits_to_float((code << FRACTION_SHIFT) + DEPTH_FLOAT24_BIAS);
}

float depth_decode(enum triptych_depth_format format, uint32_t word)
{
    switch (depth_formats[format].storage) {
    case DEPTH_UNORM: return (float)((word >> STENCIL_BITS) / (double)depth_maximum(format));
    case DEPTH_UNORM32: return (float)(word / 4294967295.0);
    case DEPTH_FLOAT24: return decode_float24(word >> STENCIL_BITS);
    case DEPTH_FLOAT:
    case DEPTH_STORAGE_COUNT: break;
    }
    return bits_to_float(word);
}

static void fill_texel(float texel[4], float depth, bool opaque)
{
    __m128 all = _mm_set1_ps(depth);
    _mm_storeu_ps(texel, all);
    if (opaque)
        texel[3] = 1;
}

/* Texels of four depths: each depth in all channels of its texel, except an alpha of 1. */
__attribute__((target("avx2"), always_inline)) static inline void fill_four(__m128 depths, bool opaque,
                                                                            float *texels)
{
    enum { ALPHAS = 0x88 };
    const __m256 all = _mm256_castps128_ps256(depths), ones = _mm256_set1_ps(1);
    __m256 first = _mm256_permutevar8x32_ps(all, _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1));
    __m256 second = _mm256_permutevar8x32_ps(all, _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3));
    _mm256_storeu_ps(texels, opaque ? _mm256_blend_ps(first, ones, ALPHAS) : first);
    _mm256_storeu_ps(texels + 8, opaque ? _mm256_blend_ps(second, ones, ALPHAS) : second);
}

__attribute__((target("avx2"), always_inline)) static inline size_t
convert_fours(double inverse, const uint32_t *words, size_t count, bool opaque, float *texels)
{
    const __m256d factor = _mm256_set1_pd(inverse);
    size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        __m128i integers = _mm_loadu_si128((const __m128i *)(const void *)(words + i));
        integers = _mm_srli_epi32(integers, STENCIL_BITS);
        __m128 depths = _mm256_cvtpd_ps(_mm256_mul_pd(_mm256_cvtepi32_pd(integers), factor));
        fill_four(depths, opaque, texels + 4 * i);
    }
    return i;
}

/* The first fours of unorm_texels(); returns how many texels they are. */
__attribute__((target("avx2"))) static size_t unorm_fours(double inverse, const uint32_t *words, size_t count,
                                                          bool opaque, float *texels)
{
    return opaque ? convert_fours(inverse, words, count, true, texels)
                  : convert_fours(inverse, words, count, false, texels);
}

/* Depths of integers by the inverse of the largest one. For all integers of up to 24 bits the result is that
 * of the division (tests/render/target/depth_texels.c). */
static void unorm_texels(float maximum, const uint32_t *words, size_t count, bool opaque, float *texels)
{
    double inverse = 1 / (double)maximum;
    size_t i = cpu_has_avx2_fma() ? unorm_fours(inverse, words, count, opaque, texels) : 0;
    for (; i < count; i++)
        fill_texel(texels + 4 * i, (float)((words[i] >> STENCIL_BITS) * inverse), opaque);
}

void depth_texels(enum triptych_depth_format format, const uint32_t *words, size_t count, bool opaque,
                  float *texels)
{
    if (depth_formats[format].storage == DEPTH_UNORM) {
        unorm_texels(depth_maximum(format), words, count, opaque, texels);
        return;
    }
    for (size_t i = 0; i < count; i++)
        fill_texel(texels + 4 * i, depth_decode(format, words[i]), opaque);
}

uint32_t depth_valid(enum triptych_depth_format format, uint32_t word)
{
    uint32_t kept = word & (depth_mask(format) | stencil_mask(format));
    float depth = depth_decode(format, kept);
    if (depth_formats[format].storage != DEPTH_FLOAT && depth_formats[format].storage != DEPTH_FLOAT24)
        return kept;
    if (depth > 0 && depth <= 1)
        return kept;
    return (kept & stencil_mask(format)) | depth_encode(format, depth > 1 ? 1 : 0);
}
