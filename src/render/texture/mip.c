/* Mip levels by a box filter, as spec/blit/shrink.h defines it. Routines compute those of bytes, a row at a
 * time. The staged language has no binary64, so the levels of numbers are computed here: their means are sums
 * of products in binary64, in the order of memory, divided once and rounded to binary32. */
#include "render/texture/texture.h"

#include <stdlib.h>

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

static void shrink_numbers(const struct larger *larger, struct cell *cell, unsigned z)
{
    const struct triptych_texture *texture = larger->texture;
    const struct texture_level *from = &texture->level[larger->level], *to = from + 1;
    struct texture_image image = texture_slice(texture, larger->face, larger->level + 1, z);
    for (uint32_t y = 0; y < (uint32_t)to->height; y++)
        for (uint32_t x = 0; x < (uint32_t)to->width; x++) {
            cell->x = taps_of(x, (uint32_t)from->width);
            cell->y = taps_of(y, (uint32_t)from->height);
            cell->total = total(&cell->x) * total(&cell->y) * total(&cell->z);
            average_floats(larger, cell, texture_texel(&image, x, y));
        }
}

/* --- Bytes, by routines --- */

/* Elements of a row's call. */
static size_t padded(int width)
{
    return ((size_t)width + LANES_MAXIMUM - 1) / LANES_MAXIMUM * LANES_MAXIMUM;
}

/* The room of a level: numbers of texels, their words, and copies of the rows that they read. */
struct room {
    uint32_t *index, *words, *copy;
};

static size_t room_words(const struct triptych_texture *texture)
{
    const struct texture_level *from = &texture->level[0];
    bool copied = texture->tiled || texture->format->compact;
    size_t copies = copied ? (size_t)BLIT_ROWS * (size_t)from->width : 0;
    return (2 * padded(from->width) + copies + LANES_MAXIMUM - 1) / LANES_MAXIMUM * LANES_MAXIMUM;
}

static struct room room_of(const struct triptych_texture *texture, const struct texture_mips *mips,
                           const struct texture_level *to)
{
    size_t count = padded(texture->level[0].width);
    struct room room = {mips->room, mips->room + count, mips->room + 2 * count};
    for (int i = 0; i < (int)padded(to->width); i++)
        room.index[i] = (uint32_t)(i < to->width ? i : to->width - 1);
    return room;
}

static const void *whole_row(const struct larger *larger, uint32_t slice, uint32_t y, uint32_t *copy)
{
    const struct texture_level *from = &larger->texture->level[larger->level];
    struct texture_image image = texture_slice(larger->texture, larger->face, larger->level, slice);
    if (texture_has_rows(&image))
        return texture_texel(&image, 0, y);
    texture_read_row(&image, 0, y, (size_t)from->width, copy);
    return copy;
}

/* The rows that row y of slice z covers. */
static struct blit_job rows_of(const struct larger *larger, const struct taps *y, const struct taps *z,
                               uint32_t *copy)
{
    const struct texture_level *from = &larger->texture->level[larger->level];
    struct taps x = taps_of(0, (uint32_t)from->width);
    struct blit_job job = {.half = from->width / 2, .total = (int32_t)(total(&x) * total(y) * total(z))};
    for (uint32_t k = 0, row = 0; k < z->count; k++)
        for (uint32_t j = 0; j < y->count; j++, row++) {
            job.row[row] = whole_row(larger, z->first + k, y->first + j, copy + row * (uint32_t)from->width);
            job.row_weight[row] = (int32_t)(z->weight[k] * y->weight[j]);
        }
    return job;
}

static void shrink_bytes(const struct larger *larger, const struct taps *z, unsigned slice,
                         const struct texture_mips *mips)
{
    const struct triptych_texture *texture = larger->texture;
    const struct texture_level *from = &texture->level[larger->level], *to = from + 1;
    struct texture_image image = texture_slice(texture, larger->face, larger->level + 1, slice);
    struct room room = room_of(texture, mips, to);
    for (uint32_t y = 0; y < (uint32_t)to->height; y++) {
        struct taps rows = taps_of(y, (uint32_t)from->height);
        struct blit_job job = rows_of(larger, &rows, z, room.copy);
        blit_run(mips->routine[larger->level + 1], &job, room.index, room.words, (uint32_t)padded(to->width));
        texture_write_row(&image, 0, y, (size_t)to->width, room.words);
    }
}

/* --- Levels --- */

static void shrink(const struct triptych_texture *texture, unsigned face, unsigned level,
                   const struct texture_mips *mips)
{
    const struct texture_level *from = &texture->level[level - 1], *to = from + 1;
    const struct larger larger = {texture, face, level - 1};
    struct cell cell;
    for (unsigned z = 0; z < (unsigned)to->depth; z++) {
        cell.z = taps_of(z, (uint32_t)from->depth);
        if (mips->routine[level])
            shrink_bytes(&larger, &cell.z, z, mips);
        else
            shrink_numbers(&larger, &cell, z);
        texture_close_rows(texture, face, level, z, 0, (size_t)to->height);
    }
}

static uint8_t tap_count(int size)
{
    return (uint8_t)taps_of(0, (uint32_t)size).count;
}

int texture_prepare_mips(const struct triptych_texture *texture, const struct blits *blits,
                         struct texture_mips *mips, struct error *error)
{
    bool bytes = texture->format->storage == STORAGE_RGBA8;
    *mips = (struct texture_mips){.room = bytes ? aligned_alloc(64, room_words(texture) * sizeof(uint32_t))
                                                : NULL};
    if (bytes && !mips->room)
        return error_set(error, "out of memory for mip levels");
    for (unsigned level = 1; bytes && level < texture->levels; level++) {
        const struct texture_level *from = &texture->level[level - 1];
        const struct blit_key key = {
            .operation = BLIT_SHRINK,
            .taps = {tap_count(from->width), tap_count(from->height), tap_count(from->depth)}};
        mips->routine[level] = blit_acquire(blits, key, error);
        if (!mips->routine[level]) {
            texture_drop_mips(blits, mips);
            return -1;
        }
    }
    return 0;
}

void texture_drop_mips(const struct blits *blits, struct texture_mips *mips)
{
    for (unsigned level = 0; level < TEXTURE_LEVELS; level++)
        blit_release(blits, mips->routine[level]);
    free(mips->room);
}

void texture_generate_mips(struct triptych_texture *texture, const struct texture_mips *mips)
{
    for (unsigned face = 0; face < texture->faces; face++)
        for (unsigned level = 1; level < texture->levels; level++)
            shrink(texture, face, level, mips);
    texture_blocks_all_stale(texture, 1);
}
