/* Mip levels by a box filter.
 *
 * A texel of the smaller level is the mean of the texels that its area covers in the larger one, each
 * weighted with how much of it is covered. Along an axis of n texels that becomes m = max(1, n / 2):
 *
 *   n even   texels 2i and 2i + 1, weights 1 and 1
 *   n odd    texels 2i, 2i + 1 and 2i + 2, weights m - i, m and i + 1
 *            (Non-Power-of-Two Mipmap Creation, NVIDIA 2005)
 *   n = 1    the texel itself
 *
 * and a texel's weight is the product of the axes'. Stored texels are averaged as they are, whatever curve
 * their values mean. Means of 8-bit channels are exact and rounded to nearest, halves up; those of binary32
 * are sums of products in binary64, in the order of memory, divided once and rounded to binary32. */
#include "render/texture/texture.h"

#include <string.h>

/* The texels of the larger level that one index of the smaller level reads along an axis. */
struct taps {
    uint32_t first, count;
    uint32_t weight[3];
};

struct cell {
    struct taps x, y, z;
    uint64_t total; /* of all weights */
};

static struct taps taps_of(uint32_t i, uint32_t size)
{
    uint32_t half = size / 2;
    if (size == 1)
        return (struct taps){0, 1, {1}};
    if (size % 2 == 0)
        return (struct taps){2 * i, 2, {1, 1}};
    return (struct taps){2 * i, 3, {half - i, half, i + 1}};
}

static uint64_t total(const struct taps *taps)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < taps->count; i++)
        sum += taps->weight[i];
    return sum;
}

static uint32_t average_bytes(const struct texture_level *from, const struct cell *cell,
                              const uint32_t *texels)
{
    uint64_t sum[4] = {0};
    for (uint32_t k = 0; k < cell->z.count; k++)
        for (uint32_t j = 0; j < cell->y.count; j++) {
            size_t row = (size_t)(cell->z.first + k) * (size_t)from->height + cell->y.first + j;
            const uint32_t *texel = texels + row * (size_t)from->pitch + cell->x.first;
            for (uint32_t i = 0; i < cell->x.count; i++)
                for (int c = 0; c < 4; c++)
                    sum[c] += (uint64_t)cell->z.weight[k] * cell->y.weight[j] * cell->x.weight[i] *
                              (texel[i] >> 8 * c & 255);
        }
    uint32_t word = 0;
    for (int c = 0; c < 4; c++)
        word |= (uint32_t)((2 * sum[c] + cell->total) / (2 * cell->total)) << 8 * c;
    return word;
}

static void average_floats(const struct texture_level *from, const struct cell *cell, const float *texels,
                           float out[4])
{
    double sum[4] = {0};
    for (uint32_t k = 0; k < cell->z.count; k++)
        for (uint32_t j = 0; j < cell->y.count; j++) {
            size_t row = (size_t)(cell->z.first + k) * (size_t)from->height + cell->y.first + j;
            const float *texel = texels + 4 * (row * (size_t)from->pitch + cell->x.first);
            for (uint32_t i = 0; i < cell->x.count; i++)
                for (int c = 0; c < 4; c++)
                    sum[c] += (double)cell->z.weight[k] * cell->y.weight[j] * cell->x.weight[i] *
                              (double)texel[4 * i + c];
        }
    for (int c = 0; c < 4; c++)
        out[c] = (float)(sum[c] / (double)cell->total);
}

static void shrink(const struct triptych_texture *texture, unsigned face, unsigned level)
{
    const struct texture_level *from = &texture->level[level - 1], *to = &texture->level[level];
    const void *source = texture_level_texels(texture, face, level - 1);
    uint32_t *first = texture_level_texels(texture, face, level), *words = first;
    float *floats = (float *)(void *)first;
    struct cell cell;
    for (uint32_t z = 0; z < (uint32_t)to->depth; z++)
        for (uint32_t y = 0; y < (uint32_t)to->height; y++, words++, floats += 4)
            for (uint32_t x = 0; x < (uint32_t)to->width; x++) {
                cell.x = taps_of(x, (uint32_t)from->width);
                cell.y = taps_of(y, (uint32_t)from->height);
                cell.z = taps_of(z, (uint32_t)from->depth);
                cell.total = total(&cell.x) * total(&cell.y) * total(&cell.z);
                if (texture->format->storage == STORAGE_RGBA8)
                    *words++ = average_bytes(from, &cell, source);
                else
                    average_floats(from, &cell, source, floats);
                floats += 4;
            }
    texture_close_rows(texture, to, first, (size_t)(to->height * to->depth));
}

void texture_generate_mips(struct triptych_texture *texture)
{
    for (unsigned face = 0; face < texture->faces; face++)
        for (unsigned level = 1; level < texture->levels; level++)
            shrink(texture, face, level);
    texture_blocks_all_stale(texture, 1);
}
