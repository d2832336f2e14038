/* Reading a target: tiles to rows of a linear image, samples resolved. */
#include "base/minmax.h"
#include "machine/cpu.h"
#include "render/target/pixels_tile.h"
#include "render/target/resolve.h"
#include "render/target/target.h"

#include <string.h>

/* --- Tiles to rows --- */

/* Quad order to rows:  0 1 4 5 | 2 3 6 7 | 8 9 12 13 | 10 11 14 15 */
static void block_rows(const uint32_t *block, uint32_t lower, __m128i row[BLOCK_SIZE])
{
    const __m128i *upper_quad = (const __m128i *)block, *lower_quad = (const __m128i *)(block + lower);
    row[0] = _mm_unpacklo_epi64(upper_quad[0], upper_quad[1]);
    row[1] = _mm_unpackhi_epi64(upper_quad[0], upper_quad[1]);
    row[2] = _mm_unpacklo_epi64(lower_quad[0], lower_quad[1]);
    row[3] = _mm_unpackhi_epi64(lower_quad[0], lower_quad[1]);
}

/* The first `columns` (1 to 4) words of a block's row. */
static inline void store_row(uint32_t *image, __m128i row, uint32_t columns)
{
    if (columns == BLOCK_SIZE)
        _mm_storeu_si128((__m128i *)image, row);
    else
        memcpy(image, &row, columns * sizeof *image);
}

/* A block, whose lower quads are `lower` words after it; `columns` and `rows` (1 to 4) of it lie in the
 * image. */
static inline void read_block(const uint32_t *block, uint32_t lower, uint32_t *image, size_t pitch,
                              uint32_t columns, uint32_t rows)
{
    __m128i row[BLOCK_SIZE];
    block_rows(block, lower, row);
    for (uint32_t y = 0; y < rows; y++)
        store_row(image + y * pitch, row[y], columns);
}

/* --- Pairs of blocks, with AVX2 --- */

__attribute__((target("avx2"), always_inline)) static inline void
store_halves(const uint32_t *a, const uint32_t *b, uint32_t *first, uint32_t *second)
{
    __m256i rows[2];
    pixels_pair_rows(a, b, rows, rows + 1);
    _mm256_storeu_si256((__m256i *)(void *)first, rows[0]);
    _mm256_storeu_si256((__m256i *)(void *)second, rows[1]);
}

/* Pairs of neighbouring blocks in a row of blocks. */
__attribute__((target("avx2"))) static void read_pairs(const struct tile_order *order, const uint32_t *block,
                                                       uint32_t pairs, uint32_t *image, size_t pitch)
{
    for (uint32_t i = 0; i < pairs; i++, block += 2 * order->block, image += 2 * BLOCK_SIZE) {
        const uint32_t *next = block + order->block;
        store_halves(block, next, image, image + pitch);
        store_halves(block + order->lower, next + order->lower, image + 2 * pitch, image + 3 * pitch);
    }
}

/* --- Tiles --- */

static uint32_t block_part(int32_t edge, int32_t start)
{
    return (uint32_t)min_i32(edge - start, BLOCK_SIZE);
}

/* The row of blocks of a tile that begins at row y of the image. */
static void read_blocks(const struct tile_order *order, const uint32_t *words, const struct rectangle *area,
                        int32_t y, uint32_t *image, size_t pitch)
{
    const uint32_t *block = words + tile_order_word(order, 0, (uint32_t)(y - area->y0));
    uint32_t *to = image + (size_t)y * pitch + (size_t)area->x0;
    const uint32_t rows = block_part(area->y1, y), columns = (uint32_t)(area->x1 - area->x0);
    uint32_t x = 0;
    if (rows == BLOCK_SIZE && cpu_has_avx2_fma()) {
        read_pairs(order, block, columns / (2 * BLOCK_SIZE), to, pitch);
        x = columns & ~(2u * BLOCK_SIZE - 1);
    }
    for (; x < columns; x += BLOCK_SIZE)
        read_block(block + x / BLOCK_SIZE * order->block, order->lower, to + x, pitch,
                   min_u32(columns - x, BLOCK_SIZE), rows);
}

void target_read_tile(const struct tile_order *order, const uint32_t *words, const struct rectangle *area,
                      uint32_t *image, size_t pitch)
{
    for (int32_t y = area->y0; y < area->y1; y += BLOCK_SIZE)
        read_blocks(order, words, area, y, image, pitch);
}

static void read_constant_blocks(uint32_t value, const struct rectangle *area, int32_t y, uint32_t *image,
                                 size_t pitch)
{
    const __m128i row = _mm_set1_epi32((int)value);
    const int32_t end = y + (int32_t)block_part(area->y1, y);
    for (; y < end; y++)
        for (int32_t x = area->x0; x < area->x1; x += BLOCK_SIZE)
            store_row(image + (size_t)y * pitch + (size_t)x, row, block_part(area->x1, x));
}

void target_read_constant(uint32_t value, const struct rectangle *area, uint32_t *image, size_t pitch)
{
    for (int32_t y = area->y0; y < area->y1; y += BLOCK_SIZE)
        read_constant_blocks(value, area, y, image, pitch);
}

/* --- Colours --- */

/* The record of a colour's tile. Colours of the format NULL have all channels 1. */
static const struct color_clear *remembered(const struct target *target, const struct target_color *color,
                                            uint32_t tile)
{
    static const struct color_clear nothing = {.word = {UINT32_MAX}, .pending = true};
    return color->clear ? color->clear + target_tile_in(target, color->columns, tile) : &nothing;
}

/* Where a tile's colours are: planes in an order, or the words of a clear that it only remembers. */
struct tile_colors {
    const struct color_clear *pending; /* or null */
    const struct tile_order *order;
    const uint32_t *words; /* the first plane */
};

/* `room` is for the planes of a tile whose samples are averaged. */
static struct tile_colors find_colors(const struct target_reading *reading, uint32_t tile, uint32_t *room)
{
    const struct target *target = reading->target;
    const struct target_color *color = target->colors + reading->t;
    const struct color_clear *clear = remembered(target, color, tile);
    if (clear->pending)
        return (struct tile_colors){.pending = clear};
    const struct tile_order *order = &target->color_order;
    const uint32_t *words = target_color_words(target, color, tile);
    if (!reading->resolve) {
        size_t sample = reading->sample < 0 ? 0 : (size_t)reading->sample;
        return (struct tile_colors){.order = order, .words = words + sample * target->planes * order->plane};
    }
    target_resolve_tile(reading->resolve, order, words, room);
    return (struct tile_colors){.order = &tile_order_alone, .words = room};
}

/* The words of a pixel, one for each plane. */
static void pixel_words(const struct tile_colors *colors, uint32_t planes, uint32_t x, uint32_t y,
                        uint32_t words[4])
{
    size_t place = colors->pending ? 0 : tile_order_word(colors->order, x, y);
    for (uint32_t p = 0; p < planes; p++)
        words[p] =
            colors->pending ? colors->pending->word[p] : colors->words[p * colors->order->plane + place];
}

/* The part of an image that a tile has: a word or a number of each channel, for each of its pixels. */
struct tile_image {
    struct rectangle area;
    uint32_t *bytes; /* or null */
    float *numbers;  /* or null */
    size_t pitch;
};

static void read_words(const struct tile_colors *colors, enum target_storage storage,
                       const struct tile_image *image)
{
    const struct rectangle *area = &image->area;
    for (int32_t y = area->y0; y < area->y1; y++)
        for (int32_t x = area->x0; x < area->x1; x++) {
            size_t pixel = (size_t)y * image->pitch + (size_t)x;
            uint32_t words[4];
            pixel_words(colors, storage_planes[storage], (uint32_t)(x - area->x0), (uint32_t)(y - area->y0),
                        words);
            if (image->bytes)
                image->bytes[pixel] = color_bytes(storage, words);
            else
                color_numbers(storage, words, image->numbers + 4 * pixel);
        }
}

enum { COLUMNS_MAXIMUM = TARGET_SIZE_MAXIMUM / TILE_SIZE };

/* Words that are the image's. A row of blocks is read from all tiles before the next one, so that the image
 * is written in four rows from their beginning to their end: its pages and lines follow each other. */
static void read_plain(const struct target_reading *reading, uint32_t tile_row, uint32_t *image, size_t pitch)
{
    const struct target *target = reading->target;
    struct tile_colors colors[COLUMNS_MAXIMUM];
    struct rectangle area[COLUMNS_MAXIMUM];
    for (uint32_t i = 0; i < target->columns; i++) {
        colors[i] = find_colors(reading, tile_row * target->columns + i, NULL);
        area[i] = target_tile_area(target, tile_row * target->columns + i);
    }
    for (int32_t y = area[0].y0; y < area[0].y1; y += BLOCK_SIZE)
        for (uint32_t i = 0; i < target->columns; i++)
            if (colors[i].pending)
                read_constant_blocks(colors[i].pending->word[0], area + i, y, image, pitch);
            else
                read_blocks(colors[i].order, colors[i].words, area + i, y, image, pitch);
}

static void read_colors(const struct target_reading *reading, uint32_t tile_row, struct tile_image image)
{
    const struct target *target = reading->target;
    enum target_storage storage = target->colors[reading->t].storage;
    if (image.bytes && storage_planes[storage] == 1 && !reading->resolve) {
        read_plain(reading, tile_row, image.bytes, image.pitch);
        return;
    }
    alignas(64) uint32_t room[4 * TILE_PIXELS];
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct tile_colors colors = find_colors(reading, tile, room);
        image.area = target_tile_area(target, tile);
        if (!image.bytes || storage_planes[storage] > 1)
            read_words(&colors, storage, &image);
        else if (colors.pending)
            target_read_constant(colors.pending->word[0], &image.area, image.bytes, image.pitch);
        else
            target_read_tile(colors.order, colors.words, &image.area, image.bytes, image.pitch);
    }
}

void target_read_color(const struct target_reading *reading, uint32_t tile_row, uint32_t *image, size_t pitch)
{
    read_colors(reading, tile_row, (struct tile_image){.bytes = image, .pitch = pitch});
}

void target_read_numbers(const struct target_reading *reading, uint32_t tile_row, float *image, size_t pitch)
{
    read_colors(reading, tile_row, (struct tile_image){.numbers = image, .pitch = pitch});
}

/* --- Depth and stencil --- */

static uint32_t row_end(const struct target *target, uint32_t tile_row)
{
    uint32_t end = (tile_row + 1) * TILE_SIZE;
    return end < target->height ? end : target->height;
}

static const uint32_t *depth_plane(const struct target *target, uint32_t tile, int sample)
{
    return target_tile_depth(target, tile) + (sample < 0 ? 0 : (size_t)sample) * target->depth_order.plane;
}

void target_read_depth(const struct target *target, int sample, uint32_t tile_row, float *image)
{
    uint32_t *words = (uint32_t *)(void *)image;
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = target_tile_area(target, tile);
        const struct depth_clear *clear = target_depth_clear(target, tile);
        if (clear->pending)
            target_read_constant(clear->word, &area, words, target->width);
        else
            target_read_tile(&target->depth_order, depth_plane(target, tile, sample), &area, words,
                             target->width);
    }
    if (depth_formats[target->depth_format].storage == DEPTH_FLOAT)
        return;
    size_t first = (size_t)tile_row * TILE_SIZE * target->width;
    for (size_t p = first; p < (size_t)row_end(target, tile_row) * target->width; p++)
        image[p] = depth_decode(target->depth_format, words[p]);
}

void target_read_stencil(const struct target *target, int sample, uint32_t tile_row, uint8_t *image)
{
    uint32_t mask = stencil_mask(target->depth_format);
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = target_tile_area(target, tile);
        const uint32_t *words = depth_plane(target, tile, sample);
        const struct depth_clear *clear = target_depth_clear(target, tile);
        for (int32_t y = area.y0; y < area.y1; y++)
            for (int32_t x = area.x0; x < area.x1; x++) {
                size_t at =
                    tile_order_word(&target->depth_order, (uint32_t)(x - area.x0), (uint32_t)(y - area.y0));
                uint32_t word = clear->pending ? clear->word : words[at];
                image[(size_t)y * target->width + (size_t)x] = (uint8_t)(word & mask);
            }
    }
}
