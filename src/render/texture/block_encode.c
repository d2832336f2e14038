/* Compression of blocks, for texels that did not come from blocks, such as computed levels. Integers only, so
 * the result is the same on every machine.
 *
 * A block of colours has two end points and a code for each texel. Three pairs of end points are compared:
 * the corners of the texels' bounding box, the two texels that are farthest apart, and the same two moved
 * apart so that they become the thirds between the ends. Each texel gets the nearest colour. The pair with
 * the least sum of squared differences is the result, the first one of equal pairs. DXT1 compares both orders
 * of the ends, and uses transparent black for texels with alpha below 128.
 *
 * A block of values has two end bytes: the largest and the smallest value, or the smallest and largest ones
 * other than 0 and 255, which have codes of their own then. */
#include "base/minmax.h"
#include "render/texture/format.h"

#include <stdint.h>
#include <string.h>

enum { TEXELS = 16 };

static int channel(uint32_t texel, int c)
{
    return (int)(texel >> 8 * c & 255);
}

static unsigned distance(uint32_t a, uint32_t b)
{
    int sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (channel(a, c) - channel(b, c)) * (channel(a, c) - channel(b, c));
    return (unsigned)sum;
}

static bool is_clear(uint32_t texel)
{
    return texel >> 24 < 128;
}

/* --- Colours --- */

/* The texels that count, and the best block so far. */
struct colors {
    uint32_t texel[TEXELS];
    bool clear[TEXELS]; /* transparent in DXT1 */
    bool any_clear;
    bool punch;
    unsigned least;
    uint8_t block[8];
};

/* The end points of a pair: channels from 0 to 255. */
struct ends {
    int a[3], b[3];
};

static uint32_t word_565(const int c[3])
{
    return (uint32_t)((c[0] * 62 + 255) / 510 << 11 | (c[1] * 126 + 255) / 510 << 5 |
                      (c[2] * 62 + 255) / 510);
}

static unsigned choose_codes(const struct colors *colors, const uint32_t color[4], uint32_t *codes)
{
    unsigned sum = 0;
    *codes = 0;
    for (int i = 0; i < TEXELS; i++) {
        unsigned least = UINT32_MAX, code = 3;
        for (unsigned k = 0; k < 4 && !colors->clear[i]; k++) {
            unsigned d = color[k] >> 24 ? distance(colors->texel[i], color[k]) : UINT32_MAX;
            if (d < least) {
                least = d;
                code = k;
            }
        }
        sum += colors->clear[i] ? 0 : least;
        *codes |= code << 2 * i;
    }
    return sum;
}

static void try_words(struct colors *colors, uint32_t first, uint32_t second)
{
    uint8_t block[8] = {(uint8_t)first, (uint8_t)(first >> 8), (uint8_t)second, (uint8_t)(second >> 8)};
    uint32_t color[4], codes;
    block_colors(block, colors->punch, color);
    unsigned sum = choose_codes(colors, color, &codes);
    if (sum >= colors->least)
        return;
    colors->least = sum;
    for (int i = 0; i < 4; i++)
        block[4 + i] = (uint8_t)(codes >> 8 * i);
    memcpy(colors->block, block, sizeof block);
}

/* Four colours if the first word is the larger one. */
static void try_ends(struct colors *colors, const struct ends *ends)
{
    uint32_t a = word_565(ends->a), b = word_565(ends->b);
    uint32_t low = min_u32(a, b), high = max_u32(a, b);
    if (!colors->any_clear)
        try_words(colors, high, low);
    if (colors->punch)
        try_words(colors, low, high);
}

/* The corners of the bounding box on the diagonal on which red and the other channels grow together or in
 * opposite directions. */
static struct ends find_corners(const struct colors *colors)
{
    struct ends ends = {{255, 255, 255}, {0, 0, 0}};
    int count = 0, sum[3] = {0}, slope[3] = {0};
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < 3 && !colors->clear[i]; c++) {
            int v = channel(colors->texel[i], c);
            ends.a[c] = min_i32(ends.a[c], v);
            ends.b[c] = max_i32(ends.b[c], v);
            sum[c] += v;
            count += c == 0;
        }
    int lead = ends.b[0] - ends.a[0] >= ends.b[1] - ends.a[1] ? 0 : 1;
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < 3 && !colors->clear[i]; c++)
            slope[c] += (channel(colors->texel[i], c) * count - sum[c]) / 16 *
                        ((channel(colors->texel[i], lead) * count - sum[lead]) / 16);
    for (int c = 0; c < 3; c++)
        if (slope[c] < 0) {
            int low = ends.a[c];
            ends.a[c] = ends.b[c];
            ends.b[c] = low;
        }
    return ends;
}

static struct ends find_farthest(const struct colors *colors)
{
    struct ends ends;
    unsigned most = 0;
    int first = 0, second = 0;
    while (first < TEXELS - 1 && colors->clear[first])
        first++;
    second = first;
    for (int i = first, start = first; i < TEXELS; i++)
        for (int k = start; k < i; k++) {
            unsigned d = distance(colors->texel[i], colors->texel[k]);
            if (colors->clear[i] || colors->clear[k] || d <= most)
                continue;
            most = d;
            first = k;
            second = i;
        }
    for (int c = 0; c < 3; c++) {
        ends.a[c] = channel(colors->texel[first], c);
        ends.b[c] = channel(colors->texel[second], c);
    }
    return ends;
}

static struct ends move_apart(const struct ends *thirds)
{
    struct ends ends;
    for (int c = 0; c < 3; c++) {
        ends.a[c] = max_i32(0, min_i32(255, 2 * thirds->a[c] - thirds->b[c]));
        ends.b[c] = max_i32(0, min_i32(255, 2 * thirds->b[c] - thirds->a[c]));
    }
    return ends;
}

static void encode_colors(const uint32_t texels[TEXELS], bool punch, uint8_t *block)
{
    struct colors colors = {.punch = punch, .least = UINT32_MAX};
    for (int i = 0; i < TEXELS; i++) {
        colors.texel[i] = texels[i];
        colors.clear[i] = punch && is_clear(texels[i]);
        colors.any_clear |= colors.clear[i];
    }
    struct ends corners = find_corners(&colors), farthest = find_farthest(&colors);
    struct ends apart = move_apart(&farthest);
    try_ends(&colors, &farthest);
    try_ends(&colors, &corners);
    try_ends(&colors, &apart);
    memcpy(block, colors.block, sizeof colors.block);
}

/* --- Values --- */

static unsigned choose_values(const uint8_t values[TEXELS], unsigned a, unsigned b, uint64_t *codes)
{
    unsigned value[8], sum = 0;
    block_values(a, b, value);
    *codes = 0;
    for (int i = 0; i < TEXELS; i++) {
        int least = INT32_MAX;
        uint64_t code = 0;
        for (unsigned k = 0; k < 8; k++) {
            int d = ((int)value[k] - values[i]) * ((int)value[k] - values[i]);
            if (d < least) {
                least = d;
                code = k;
            }
        }
        sum += (unsigned)least;
        *codes |= code << 3 * i;
    }
    return sum;
}

static void encode_values(const uint8_t values[TEXELS], uint8_t *block)
{
    unsigned low = 255, high = 0, inner_low = 255, inner_high = 0;
    uint64_t eight, six;
    for (int i = 0; i < TEXELS; i++) {
        low = min_u32(low, values[i]);
        high = max_u32(high, values[i]);
        if (values[i] == 0 || values[i] == 255)
            continue;
        inner_low = min_u32(inner_low, values[i]);
        inner_high = max_u32(inner_high, values[i]);
    }
    if (inner_low > inner_high)
        inner_low = inner_high = 0;
    bool is_eight =
        choose_values(values, high, low, &eight) <= choose_values(values, inner_low, inner_high, &six);
    uint64_t codes = is_eight ? eight : six;
    block[0] = (uint8_t)(is_eight ? high : inner_low);
    block[1] = (uint8_t)(is_eight ? low : inner_high);
    for (int i = 0; i < 6; i++)
        block[2 + i] = (uint8_t)(codes >> 8 * i);
}

static void encode_channel(const uint32_t texels[TEXELS], int c, uint8_t *block)
{
    uint8_t values[TEXELS];
    for (int i = 0; i < TEXELS; i++)
        values[i] = (uint8_t)channel(texels[i], c);
    encode_values(values, block);
}

static void encode_explicit(const uint32_t texels[TEXELS], uint8_t *block)
{
    memset(block, 0, 8);
    for (int i = 0; i < TEXELS; i++)
        block[i / 2] |= (uint8_t)((channel(texels[i], 3) + 8) / 17 << 4 * (i % 2));
}

void block_encode(enum coding coding, const uint32_t texels[TEXELS], uint8_t *block)
{
    switch (coding) {
    case CODING_DXT1: encode_colors(texels, true, block); break;
    case CODING_DXT3:
        encode_explicit(texels, block);
        encode_colors(texels, false, block + 8);
        break;
    case CODING_DXT5:
        encode_channel(texels, 3, block);
        encode_colors(texels, false, block + 8);
        break;
    case CODING_ATI1: encode_channel(texels, 0, block); break;
    case CODING_ATI2:
        encode_channel(texels, 1, block);
        encode_channel(texels, 0, block + 8);
        break;
    case CODING_PACKED:
    case CODING_NORMAL: break;
    }
}
