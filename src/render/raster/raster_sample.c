#include "render/raster/raster_sample.h"

#include "base/minmax.h"

#include <string.h>

enum { BLOCK_WORDS = TILE_BLOCKS / 64, SIXTEENTH = (1 << SUBPIXEL_BITS) / 16 };

static bool is_single(const struct sampling *sampling)
{
    return !sampling->samples || sampling->centers;
}

/* The number of positions in x and y that a shape has: three corners, two ends or two sides. */
static struct triangle_head moved(const struct triangle_head *head, enum raster_shape shape,
                                  struct sample_position by)
{
    struct triangle_head r = *head;
    for (int i = 0; i < (shape == SHAPE_TRIANGLE ? 3 : 2); i++) {
        r.x[i] -= by.x * SIXTEENTH;
        r.y[i] -= by.y * SIXTEENTH;
    }
    return r;
}

bool raster_sampled_bounds(const struct sampling *sampling, enum raster_shape shape,
                           const struct triangle_head *head, const struct rectangle *limit,
                           struct rectangle *bounds)
{
    if (is_single(sampling))
        return raster_shapes[shape].bounds(head, limit, bounds);
    bool any = false;
    for (int i = 0; i < 1 << sampling->samples; i++) {
        struct triangle_head at = moved(head, shape, layout_samples[sampling->samples][i]);
        struct rectangle own;
        if (!(sampling->mask >> i & 1) || !raster_shapes[shape].bounds(&at, limit, &own))
            continue;
        if (any)
            own = (struct rectangle){min_i32(own.x0, bounds->x0), min_i32(own.y0, bounds->y0),
                                     max_i32(own.x1, bounds->x1), max_i32(own.y1, bounds->y1)};
        *bounds = own;
        any = true;
    }
    return any;
}

void raster_sampled_prepare(struct sampled_raster *raster, const struct sampling *sampling,
                            enum raster_shape shape, const struct triangle_head *head,
                            const struct rectangle *scissor)
{
    raster->count = 0;
    if (is_single(sampling)) {
        raster->count = raster_shapes[shape].prepare(&raster->raster[0], head, scissor);
        return;
    }
    for (int i = 0; i < 1 << sampling->samples; i++) {
        struct triangle_head at = moved(head, shape, layout_samples[sampling->samples][i]);
        raster->count += raster_shapes[shape].prepare(&raster->raster[raster->count], &at, scissor);
    }
}

bool raster_sampled_touches(const struct sampled_raster *raster, int column, int row)
{
    for (int i = 0; i < raster->count; i++)
        if (raster_touches(&raster->raster[i], column, row))
            return true;
    return false;
}

/* The coverage of the tile's blocks, sample by sample; those that no sample has touched are not filled in. */
struct blocks {
    uint64_t touched[BLOCK_WORDS];
    struct sample_coverage coverage[TILE_BLOCKS];
};

static void add_sample(struct blocks *blocks, int sample, const struct entry *entry, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t block = entry[i].block;
        if (!(blocks->touched[block / 64] >> block % 64 & 1))
            memset(&blocks->coverage[block], 0, sizeof blocks->coverage[block]);
        blocks->touched[block / 64] |= (uint64_t)1 << block % 64;
        blocks->coverage[block].sample[sample] = entry[i].coverage;
    }
}

static void fill_blocks(struct blocks *blocks, const struct sampling *sampling, enum raster_shape shape,
                        const struct triangle_head *head, const struct rectangle *scissor, int column,
                        int row)
{
    struct entry entry[TILE_BLOCKS];
    uint32_t count = 0;
    if (sampling->centers)
        count = raster_shapes[shape].tile(head, scissor, column, row, 0, entry);
    for (int i = 0; i < 1 << sampling->samples; i++) {
        if (!(sampling->mask >> i & 1))
            continue;
        if (!sampling->centers) {
            struct triangle_head at = moved(head, shape, layout_samples[sampling->samples][i]);
            count = raster_shapes[shape].tile(&at, scissor, column, row, 0, entry);
        }
        add_sample(blocks, i, entry, count);
    }
}

static struct entry make_entry(const struct sample_coverage *coverage, uint32_t block, int column, int row,
                               uint32_t record)
{
    uint32_t row_blocks = TILE_SIZE / BLOCK_SIZE;
    struct entry r = {.x = (float)((uint32_t)column * TILE_SIZE + block % row_blocks * BLOCK_SIZE),
                      .y = (float)((uint32_t)row * TILE_SIZE + block / row_blocks * BLOCK_SIZE),
                      .block = (uint16_t)block,
                      .triangle = record};
    for (int i = 0; i < SAMPLES_MAXIMUM; i++)
        r.coverage |= coverage->sample[i];
    return r;
}

uint32_t raster_sampled_tile(const struct sampling *sampling, enum raster_shape shape,
                             const struct triangle_head *head, const struct rectangle *scissor, int column,
                             int row, uint32_t record, struct entry_list *list, uint32_t first)
{
    if (!sampling->samples)
        return raster_shapes[shape].tile(head, scissor, column, row, record, list->entry + first);
    struct blocks blocks;
    uint32_t next = first;
    memset(blocks.touched, 0, sizeof blocks.touched);
    fill_blocks(&blocks, sampling, shape, head, scissor, column, row);
    for (int word = 0; word < BLOCK_WORDS; word++)
        for (uint64_t left = blocks.touched[word]; left; left &= left - 1) {
            uint32_t block = (uint32_t)(word * 64 + __builtin_ctzll(left));
            list->entry[next] = make_entry(&blocks.coverage[block], block, column, row, record);
            list->coverage[next++] = blocks.coverage[block];
        }
    return next - first;
}
