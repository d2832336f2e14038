/* Reading a target: tiles to rows of a linear image, samples resolved. */
#include "base/bits.h"
#include "base/minmax.h"
#include "render/target/target.h"

#include <emmintrin.h>
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
static void read_block(const uint32_t *block, uint32_t lower, uint32_t *image, size_t pitch, uint32_t columns,
                       uint32_t rows)
{
    __m128i row[BLOCK_SIZE];
    block_rows(block, lower, row);
    for (uint32_t y = 0; y < rows; y++)
        store_row(image + y * pitch, row[y], columns);
}

static uint32_t block_part(int32_t edge, int32_t start)
{
    return (uint32_t)min_i32(edge - start, BLOCK_SIZE);
}

void target_read_tile(const struct tile_order *order, const uint32_t *words, const struct rectangle *area,
                      uint32_t *image, size_t pitch)
{
    for (int32_t y = area->y0; y < area->y1; y += BLOCK_SIZE)
        for (int32_t x = area->x0; x < area->x1; x += BLOCK_SIZE) {
            size_t word = tile_order_word(order, (uint32_t)(x - area->x0), (uint32_t)(y - area->y0));
            read_block(words + word, order->lower, image + (size_t)y * pitch + (size_t)x, pitch,
                       block_part(area->x1, x), block_part(area->y1, y));
        }
}

void target_read_constant(uint32_t value, const struct rectangle *area, uint32_t *image, size_t pitch)
{
    __m128i row = _mm_set1_epi32((int)value);
    for (int32_t y = area->y0; y < area->y1; y++)
        for (int32_t x = area->x0; x < area->x1; x += BLOCK_SIZE)
            store_row(image + (size_t)y * pitch + (size_t)x, row, block_part(area->x1, x));
}

/* --- Colours --- */

/* The record of a colour's tile. Colours of the format NULL have all channels 1. */
static const struct color_clear *remembered(const struct target *target, const struct target_color *color,
                                            uint32_t tile)
{
    static const struct color_clear nothing = {.word = {UINT32_MAX}, .pending = true};
    return color->clear ? color->clear + target_tile_in(target, color->columns, tile) : &nothing;
}

/* A sample of a colour with one plane, in a row of tiles. */
static void read_plane(const struct target *target, uint32_t sample, const struct target_color *color,
                       uint32_t tile_row, uint32_t *image, size_t pitch)
{
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = target_tile_area(target, tile);
        const struct color_clear *clear = remembered(target, color, tile);
        if (clear->pending)
            target_read_constant(clear->word[0], &area, image, pitch);
        else
            target_read_tile(&target->color_order,
                             target_color_words(target, color, tile) +
                                 sample * target->planes * target->color_order.plane,
                             &area, image, pitch);
    }
}

/* The words of a sample of pixel x, y of a colour, one for each of its planes. */
static void pixel_words(const struct target *target, const struct target_color *color, uint32_t sample,
                        uint32_t x, uint32_t y, uint32_t words[4])
{
    uint32_t tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    const struct color_clear *clear = remembered(target, color, tile);
    if (clear->pending) {
        memcpy(words, clear->word, storage_planes[color->storage] * sizeof *words);
        return;
    }
    const struct tile_order *order = &target->color_order;
    const uint32_t *place = target_color_words(target, color, tile) +
                            tile_order_word(order, x % TILE_SIZE, y % TILE_SIZE) +
                            sample * target->planes * order->plane;
    for (int p = 0; p < storage_planes[color->storage]; p++)
        words[p] = place[(size_t)p * order->plane];
}

static void resolve_bytes(const struct target *target, const struct target_color *color, uint32_t x,
                          uint32_t y, uint32_t *word)
{
    uint32_t sum[4] = {0};
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        pixel_words(target, color, sample, x, y, word);
        for (int c = 0; c < 4; c++)
            sum[c] += *word >> 8 * c & 255;
    }
    *word = 0;
    for (int c = 0; c < 4; c++)
        *word |= (sum[c] + target->samples / 2) / target->samples << 8 * c;
}

static void resolve_numbers(const struct target *target, const struct target_color *color, uint32_t x,
                            uint32_t y, uint32_t words[4])
{
    float sum[4] = {0};
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        pixel_words(target, color, sample, x, y, words);
        for (int c = 0; c < 4; c++)
            sum[c] += bits_to_float(words[c]);
    }
    for (int c = 0; c < 4; c++)
        words[c] = bits_of_float(sum[c] / (float)target->samples);
}

/* The value that is read of a pixel. */
static void read_words(const struct target *target, const struct target_color *color, int sample, uint32_t x,
                       uint32_t y, uint32_t words[4])
{
    if (sample != SAMPLE_RESOLVED || target->samples == 1)
        pixel_words(target, color, sample < 0 ? 0 : (uint32_t)sample, x, y, words);
    else if (storage_planes[color->storage] == 1)
        resolve_bytes(target, color, x, y, words);
    else
        resolve_numbers(target, color, x, y, words);
}

static uint32_t row_end(const struct target *target, uint32_t tile_row)
{
    uint32_t end = (tile_row + 1) * TILE_SIZE;
    return end < target->height ? end : target->height;
}

void target_read_color(const struct target *target, unsigned t, int sample, uint32_t tile_row,
                       uint32_t *image, size_t pitch)
{
    const struct target_color *color = target->colors + t;
    bool single = sample != SAMPLE_RESOLVED || target->samples == 1;
    if (storage_planes[color->storage] == 1 && single) {
        read_plane(target, sample < 0 ? 0 : (uint32_t)sample, color, tile_row, image, pitch);
        return;
    }
    for (uint32_t y = tile_row * TILE_SIZE; y < row_end(target, tile_row); y++)
        for (uint32_t x = 0; x < target->width; x++) {
            uint32_t words[4];
            read_words(target, color, sample, x, y, words);
            image[y * pitch + x] = color_bytes(color->storage, words);
        }
}

void target_read_numbers(const struct target *target, unsigned t, int sample, uint32_t tile_row, float *image,
                         size_t pitch)
{
    const struct target_color *color = target->colors + t;
    for (uint32_t y = tile_row * TILE_SIZE; y < row_end(target, tile_row); y++)
        for (uint32_t x = 0; x < target->width; x++) {
            uint32_t words[4];
            read_words(target, color, sample, x, y, words);
            color_numbers(color->storage, words, image + (y * pitch + x) * 4);
        }
}

/* --- Depth and stencil --- */

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
