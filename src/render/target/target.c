#include "render/target/target.h"

#include "base/bits.h"
#include "base/minmax.h"
#include "machine/large.h"
#include "contract/lane.h"

#include <emmintrin.h>
#include <stdlib.h>
#include <string.h>

const struct format *target_format(const struct triptych_target_description *description, unsigned t)
{
    enum triptych_surface_format number = description->color_format[t];
    return format_find(number || t ? number : TRIPTYCH_SURFACE_A8R8G8B8);
}

static void place_colors(struct target *target, const struct triptych_target_description *description)
{
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        if (!format)
            continue;
        target->colors[t] =
            (struct target_color){format, (enum target_storage)format->target, target->planes};
        target->planes += storage_planes[target->colors[t].storage];
    }
}

int target_create(struct target *target, const struct triptych_target_description *description,
                  struct error *error)
{
    struct target t = {.width = description->width,
                       .height = description->height,
                       .samples = 1u << samples_exponent(description->samples),
                       .depth_format = description->depth_format};
    bool has_depth = depth_formats[t.depth_format].depth_bits;
    t.columns = (t.width + TILE_SIZE - 1) / TILE_SIZE;
    t.rows = (t.height + TILE_SIZE - 1) / TILE_SIZE;
    size_t tiles = (size_t)t.columns * t.rows;
    place_colors(&t, description);
    size_t planes = tiles * t.samples;
    t.color = large_allocate(planes * t.planes * TILE_PLANE_BYTES);
    t.depth = has_depth ? large_allocate(planes * TILE_PLANE_BYTES) : NULL;
    t.clear = malloc(tiles * sizeof *t.clear);
    if (!t.color || (has_depth && !t.depth) || !t.clear) {
        target_destroy(&t);
        return error_set(error, "out of memory for a target of %u x %u pixels (%zu MiB)", description->width,
                         description->height, planes * TILE_PLANE_BYTES * (t.planes + has_depth) >> 20);
    }
    struct tile_clear clear = {
        .depth = depth_encode(t.depth_format, 1), .color_pending = true, .depth_pending = true};
    clear.range = (struct depth_range){clear.depth, clear.depth};
    target_clear_words(&t, (const float[4]){0}, clear.color);
    for (size_t i = 0; i < tiles; i++)
        t.clear[i] = clear;
    *target = t;
    return 0;
}

void target_destroy(struct target *target)
{
    free(target->color);
    free(target->depth);
    free(target->clear);
    memset(target, 0, sizeof *target);
}

void target_describe(const struct target *target, struct triptych_target_description *description)
{
    *description = (struct triptych_target_description){.width = target->width,
                                                        .height = target->height,
                                                        .samples = target->samples,
                                                        .depth_format = target->depth_format};
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].format)
            description->color_format[t] = (enum triptych_surface_format)target->colors[t].format->number;
}

void target_clear_words(const struct target *target, const float color[4], uint32_t words[TARGET_PLANES])
{
    memset(words, 0, TARGET_PLANES * sizeof *words);
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].format) {
            uint32_t encoded[4];
            color_encode(target->colors[t].format, color, encoded);
            memcpy(words + target->colors[t].plane, encoded,
                   storage_planes[target->colors[t].storage] * sizeof *words);
        }
}

/* The tile's pixels as columns and rows of the target, the last tiles cut. */
static struct rectangle tile_area(const struct target *target, uint32_t tile)
{
    int32_t x = (int32_t)(tile % target->columns) * TILE_SIZE,
            y = (int32_t)(tile / target->columns) * TILE_SIZE;
    int32_t right = (int32_t)target->width, bottom = (int32_t)target->height;
    struct rectangle r = {x, y, x + TILE_SIZE < right ? x + TILE_SIZE : right,
                          y + TILE_SIZE < bottom ? y + TILE_SIZE : bottom};
    return r;
}

static void fill(void *words, uint32_t value)
{
    __m128i v = _mm_set1_epi32((int)value);
    for (int i = 0; i < TILE_PIXELS; i += 4)
        _mm_store_si128((__m128i *)((uint32_t *)words + i), v);
}

uint32_t *target_fill_color(struct target *target, uint32_t tile)
{
    uint32_t *words = target_tile_color(target, tile);
    uint32_t planes = target->clear[tile].color_pending ? target->samples * target->planes : 0;
    for (uint32_t p = 0; p < planes; p++)
        fill(words + p * TILE_PIXELS, target->clear[tile].color[p % target->planes]);
    target->clear[tile].color_pending = false;
    return words;
}

uint32_t *target_fill_depth(struct target *target, uint32_t tile)
{
    uint32_t *words = target_tile_depth(target, tile);
    uint32_t planes = target->clear[tile].depth_pending ? target->samples : 0;
    for (uint32_t p = 0; p < planes; p++)
        fill(words + p * TILE_PIXELS, target->clear[tile].depth);
    target->clear[tile].depth_pending = false;
    return words;
}

void target_forget_depth(struct target *target, uint32_t tile)
{
    target->clear[tile].range = (struct depth_range){0, depth_mask(target->depth_format)};
}

static void clear_part(struct target *target, uint32_t tile, const struct clear *clear,
                       const struct rectangle *part, const struct rectangle *whole)
{
    uint32_t *color = clear->set_color ? target_fill_color(target, tile) : NULL;
    uint32_t *depth = clear->depth_mask ? target_fill_depth(target, tile) : NULL;
    for (int32_t y = part->y0; y < part->y1; y++)
        for (int32_t x = part->x0; x < part->x1; x++) {
            uint32_t word = pixel_word((uint32_t)(x - whole->x0), (uint32_t)(y - whole->y0));
            for (uint32_t p = 0; color && p < target->samples * target->planes; p++)
                color[p * TILE_PIXELS + word] = clear->color[p % target->planes];
            for (uint32_t p = 0; depth && p < target->samples; p++) {
                uint32_t *at = depth + p * TILE_PIXELS + word;
                *at = (*at & ~clear->depth_mask) | clear->depth;
            }
        }
}

/* Returns true if every used bit of the words is set, so their old values do not matter. */
static bool sets_whole_word(const struct target *target, const struct clear *clear)
{
    enum triptych_depth_format format = target->depth_format;
    return clear->depth_mask == (depth_mask(format) | stencil_mask(format));
}

/* Updates the bounds of a tile's depth for a clear. The clear sets the bits `left` only in a part of the
 * tile, or pixel by pixel, and the others everywhere. */
static void note_cleared_depth(const struct target *target, const struct clear *clear,
                               struct tile_clear *tile, uint32_t left)
{
    uint32_t mask = depth_mask(target->depth_format), depth = clear->depth & mask;
    if (!(clear->depth_mask & mask))
        return;
    if (!(left & mask))
        tile->range = (struct depth_range){depth, depth};
    tile->range.least = depth < tile->range.least ? depth : tile->range.least;
    tile->range.most = depth > tile->range.most ? depth : tile->range.most;
}

void target_clear_tile(struct target *target, uint32_t tile, const struct clear *clear)
{
    struct rectangle whole = tile_area(target, tile);
    const struct rectangle *area = &clear->area;
    struct rectangle part = {max_i32(whole.x0, area->x0), max_i32(whole.y0, area->y0),
                             min_i32(whole.x1, area->x1), min_i32(whole.y1, area->y1)};
    struct tile_clear *pending = target->clear + tile;
    struct clear rest = *clear;
    if (part.x0 >= part.x1 || part.y0 >= part.y1)
        return;
    if (!memcmp(&part, &whole, sizeof part)) {
        if (clear->set_color) {
            memcpy(pending->color, clear->color, sizeof pending->color);
            pending->color_pending = true;
            rest.set_color = false;
        }
        if (clear->depth_mask && (pending->depth_pending || sets_whole_word(target, clear))) {
            pending->depth = (pending->depth & ~clear->depth_mask) | clear->depth;
            pending->depth_pending = true;
            rest.depth_mask = 0;
        }
    }
    note_cleared_depth(target, clear, pending, rest.depth_mask);
    if (rest.set_color || rest.depth_mask)
        clear_part(target, tile, &rest, &part, &whole);
}

/* Quad order to rows:  0 1 4 5 | 2 3 6 7 | 8 9 12 13 | 10 11 14 15 */
static void block_rows(const uint32_t *block, __m128i row[BLOCK_SIZE])
{
    const __m128i *quad = (const __m128i *)block;
    row[0] = _mm_unpacklo_epi64(quad[0], quad[1]);
    row[1] = _mm_unpackhi_epi64(quad[0], quad[1]);
    row[2] = _mm_unpacklo_epi64(quad[2], quad[3]);
    row[3] = _mm_unpackhi_epi64(quad[2], quad[3]);
}

/* The first `columns` (1 to 4) words of a block's row. */
static inline void store_row(uint32_t *image, __m128i row, uint32_t columns)
{
    if (columns == BLOCK_SIZE)
        _mm_storeu_si128((__m128i *)image, row);
    else
        memcpy(image, &row, columns * sizeof *image);
}

/* A block; `columns` and `rows` (1 to 4) of it lie in the image. */
static void read_block(const uint32_t *block, uint32_t *image, size_t pitch, uint32_t columns, uint32_t rows)
{
    __m128i row[BLOCK_SIZE];
    block_rows(block, row);
    for (uint32_t y = 0; y < rows; y++)
        store_row(image + y * pitch, row[y], columns);
}

static uint32_t block_part(int32_t edge, int32_t start)
{
    return (uint32_t)min_i32(edge - start, BLOCK_SIZE);
}

static void read_tile(const uint32_t *words, const struct rectangle *area, uint32_t *image, size_t pitch)
{
    for (int32_t y = area->y0; y < area->y1; y += BLOCK_SIZE)
        for (int32_t x = area->x0; x < area->x1; x += BLOCK_SIZE) {
            uint32_t word = pixel_word((uint32_t)(x - area->x0), (uint32_t)(y - area->y0));
            read_block(words + word, image + (size_t)y * pitch + (size_t)x, pitch, block_part(area->x1, x),
                       block_part(area->y1, y));
        }
}

static void read_cleared(uint32_t value, const struct rectangle *area, uint32_t *image, size_t pitch)
{
    __m128i row = _mm_set1_epi32((int)value);
    for (int32_t y = area->y0; y < area->y1; y++)
        for (int32_t x = area->x0; x < area->x1; x += BLOCK_SIZE)
            store_row(image + (size_t)y * pitch + (size_t)x, row, block_part(area->x1, x));
}

/* A sample's plane of a row of tiles. */
static void read_plane(const struct target *target, uint32_t sample, uint32_t plane, uint32_t tile_row,
                       uint32_t *image, size_t pitch)
{
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = tile_area(target, tile);
        const uint32_t *words =
            target_tile_color(target, tile) + (sample * target->planes + plane) * TILE_PIXELS;
        if (target->clear[tile].color_pending)
            read_cleared(target->clear[tile].color[plane], &area, image, pitch);
        else
            read_tile(words, &area, image, pitch);
    }
}

/* The words of a sample of pixel x, y of a colour, one for each of its planes. */
static void pixel_words(const struct target *target, const struct target_color *color, uint32_t sample,
                        uint32_t x, uint32_t y, uint32_t words[4])
{
    uint32_t tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    const struct tile_clear *clear = target->clear + tile;
    const uint32_t *place = target_tile_color(target, tile) + pixel_word(x % TILE_SIZE, y % TILE_SIZE) +
                            sample * target->planes * TILE_PIXELS;
    for (int p = 0; p < storage_planes[color->storage]; p++)
        words[p] = clear->color_pending ? clear->color[color->plane + (uint32_t)p]
                                        : place[(color->plane + (uint32_t)p) * TILE_PIXELS];
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
        read_plane(target, sample < 0 ? 0 : (uint32_t)sample, color->plane, tile_row, image, pitch);
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

static const uint32_t *depth_plane(const struct target *target, uint32_t tile, int sample)
{
    return target_tile_depth(target, tile) + (sample < 0 ? 0 : sample) * TILE_PIXELS;
}

void target_read_depth(const struct target *target, int sample, uint32_t tile_row, float *image)
{
    uint32_t *words = (uint32_t *)(void *)image;
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = tile_area(target, tile);
        if (target->clear[tile].depth_pending)
            read_cleared(target->clear[tile].depth, &area, words, target->width);
        else
            read_tile(depth_plane(target, tile, sample), &area, words, target->width);
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
        struct rectangle area = tile_area(target, tile);
        const uint32_t *words = depth_plane(target, tile, sample);
        const struct tile_clear *clear = target->clear + tile;
        for (int32_t y = area.y0; y < area.y1; y++)
            for (int32_t x = area.x0; x < area.x1; x++) {
                uint32_t at = pixel_word((uint32_t)(x - area.x0), (uint32_t)(y - area.y0));
                uint32_t word = clear->depth_pending ? clear->depth : words[at];
                image[(size_t)y * target->width + (size_t)x] = (uint8_t)(word & mask);
            }
    }
}

/* Sets the words of all of a pixel's samples of one colour. */
static void write_words(struct target *target, const struct target_color *color, uint32_t x, uint32_t y,
                        const uint32_t words[4])
{
    uint32_t tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    uint32_t *place = target_fill_color(target, tile) + pixel_word(x % TILE_SIZE, y % TILE_SIZE);
    for (uint32_t sample = 0; sample < target->samples; sample++)
        for (int p = 0; p < storage_planes[color->storage]; p++)
            place[(sample * target->planes + color->plane + (uint32_t)p) * TILE_PIXELS] = words[p];
}

void target_write_texels(struct target *target, unsigned t, const void *texels, size_t pitch)
{
    const struct target_color *color = target->colors + t;
    size_t bytes = storage_planes[color->storage] * sizeof(uint32_t);
    const uint8_t *texel = texels;
    for (uint32_t y = 0; y < target->height; y++, texel += (pitch - target->width) * bytes)
        for (uint32_t x = 0; x < target->width; x++, texel += bytes) {
            uint32_t words[4];
            memcpy(words, texel, bytes);
            write_words(target, color, x, y, words);
        }
}

void target_write_numbers(struct target *target, unsigned t, const struct rectangle *part, const float *image)
{
    const struct target_color *color = target->colors + t;
    for (int32_t y = part->y0; y < part->y1; y++)
        for (int32_t x = part->x0; x < part->x1; x++, image += 4) {
            uint32_t words[4];
            color_encode(color->format, image, words);
            write_words(target, color, (uint32_t)x, (uint32_t)y, words);
        }
}

static size_t depth_place(const struct target *target, uint32_t x, uint32_t y, uint32_t *tile)
{
    *tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    return pixel_word(x % TILE_SIZE, y % TILE_SIZE);
}

uint32_t *target_depth_word(struct target *target, uint32_t x, uint32_t y)
{
    uint32_t tile;
    size_t place = depth_place(target, x, y, &tile);
    target_forget_depth(target, tile);
    return target_fill_depth(target, tile) + place;
}

uint32_t target_depth_at(const struct target *target, uint32_t x, uint32_t y)
{
    uint32_t tile;
    size_t place = depth_place(target, x, y, &tile);
    const struct tile_clear *clear = target->clear + tile;
    return clear->depth_pending ? clear->depth : target_tile_depth(target, tile)[place];
}
