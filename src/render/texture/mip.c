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

/* The larger level of a face. */
struct larger {
    const struct triptych_texture *texture;
    unsigned face, level;
};

/* The texels of a row that the cell reads: where they are, or a copy in `copy` if they are in tiles. */
static const void *cell_row(const struct larger *larger, const struct cell *cell, uint32_t j, uint32_t k,
                            uint32_t copy[12])
{
    struct texture_image image =
        texture_slice(larger->texture, larger->face, larger->level, cell->z.first + k);
    if (!image.tiled)
        return texture_texel(&image, cell->x.first, cell->y.first + j);
    texture_read_row(&image, cell->x.first, cell->y.first + j, cell->x.count, copy);
    return copy;
}

static uint32_t average_bytes(const struct larger *larger, const struct cell *cell)
{
    uint64_t sum[4] = {0};
    uint32_t copy[12];
    for (uint32_t k = 0; k < cell->z.count; k++)
        for (uint32_t j = 0; j < cell->y.count; j++) {
            const uint32_t *texel = cell_row(larger, cell, j, k, copy);
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

static void average_floats(const struct larger *larger, const struct cell *cell, float out[4])
{
    double sum[4] = {0};
    uint32_t copy[12];
    for (uint32_t k = 0; k < cell->z.count; k++)
        for (uint32_t j = 0; j < cell->y.count; j++) {
            const float *texel = cell_row(larger, cell, j, k, copy);
            for (uint32_t i = 0; i < cell->x.count; i++)
                for (int c = 0; c < 4; c++)
                    sum[c] += (double)cell->z.weight[k] * cell->y.weight[j] * cell->x.weight[i] *
                              (double)texel[4 * i + c];
        }
    for (int c = 0; c < 4; c++)
        out[c] = (float)(sum[c] / (double)cell->total);
}

static void shrink_texel(const struct larger *larger, const struct cell *cell, void *texel)
{
    if (larger->texture->format->storage == STORAGE_RGBA8)
        *(uint32_t *)texel = average_bytes(larger, cell);
    else
        average_floats(larger, cell, texel);
}

static void shrink_slice(const struct larger *larger, struct cell *cell, unsigned z)
{
    const struct triptych_texture *texture = larger->texture;
    const struct texture_level *from = &texture->level[larger->level], *to = from + 1;
    struct texture_image image = texture_slice(texture, larger->face, larger->level + 1, z);
    for (uint32_t y = 0; y < (uint32_t)to->height; y++)
        for (uint32_t x = 0; x < (uint32_t)to->width; x++) {
            cell->x = taps_of(x, (uint32_t)from->width);
            cell->y = taps_of(y, (uint32_t)from->height);
            cell->total = total(&cell->x) * total(&cell->y) * total(&cell->z);
            shrink_texel(larger, cell, texture_texel(&image, x, y));
        }
}

static void shrink(const struct triptych_texture *texture, unsigned face, unsigned level)
{
    const struct texture_level *from = &texture->level[level - 1], *to = from + 1;
    const struct larger larger = {texture, face, level - 1};
    struct cell cell;
    for (unsigned z = 0; z < (unsigned)to->depth; z++) {
        cell.z = taps_of(z, (uint32_t)from->depth);
        shrink_slice(&larger, &cell, z);
        texture_close_rows(texture, face, level, z, 0, (size_t)to->height);
    }
}

void texture_generate_mips(struct triptych_texture *texture)
{
    for (unsigned face = 0; face < texture->faces; face++)
        for (unsigned level = 1; level < texture->levels; level++)
            shrink(texture, face, level);
    texture_blocks_all_stale(texture, 1);
}
