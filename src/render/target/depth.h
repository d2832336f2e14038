/* Depth and stencil as a target stores them: one 32-bit word per pixel, whatever the format.
 *
 *   FLOAT     binary32
 *   UNORM     depth of up to 24 bits above stencil of 8:  depth << 8 | stencil
 *   FLOAT24   the same, depth being floating point
 *   UNORM32   depth
 *
 * The conversions are those of spec/pixel/depth.h, where they are defined, for the values of clears and for
 * reading. */
#ifndef RENDER_TARGET_DEPTH_H
#define RENDER_TARGET_DEPTH_H

#include "contract/key.h"
#include "triptych.h"

struct depth_format {
    enum depth_storage storage;
    uint8_t depth_bits, stencil_bits;
    const char *name;
};

/* A row of def/state/depth_format.def. */
extern const struct depth_format depth_formats[TRIPTYCH_DEPTH_COUNT];

/* The bits of the word that are depth, and those that are stencil: none for a format without. */
uint32_t depth_mask(enum triptych_depth_format format);
uint32_t stencil_mask(enum triptych_depth_format format);

/* The largest integer that depth becomes, as the job has it; 0 for storage other than UNORM. */
float depth_maximum(enum triptych_depth_format format);

/* The word of a depth from 0 to 1 with stencil 0. Called in the contract's floating-point environment. */
uint32_t depth_encode(enum triptych_depth_format format, float depth);

/* The n of 2^n samples per pixel; 0 for 0 samples, which mean one; -1 when the number is not supported. */
static inline int samples_exponent(unsigned samples)
{
    for (int n = 0; n < SAMPLES_RADIX; n++)
        if (samples == 1u << n)
            return n;
    return samples ? -1 : 0;
}

/* A word's depth, rounded to nearest. */
float depth_decode(enum triptych_depth_format format, uint32_t word);

/* The texels of words' depths, four floats each: all channels, or three and an alpha of 1. */
void depth_texels(enum triptych_depth_format format, const uint32_t *words, size_t count, bool opaque,
                  float *texels);

/* A word as drawing can write it: without bits that the format lacks, and depth from 0 to 1. */
uint32_t depth_valid(enum triptych_depth_format format, uint32_t word);

#endif
