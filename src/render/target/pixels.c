#include "render/target/pixels_tile.h"

#include "base/bits.h"
#include "base/minmax.h"

#include <emmintrin.h>
#include <string.h>

/* --- Rows of planes --- */

/* Four pixels of a row are two pairs, which begin four words apart. `block` is the distance of blocks. */
static void gather_blocks(const uint32_t *words, uint32_t block, uint32_t blocks, uint32_t *row)
{
    for (uint32_t i = 0; i < blocks; i++, words += block, row += BLOCK_SIZE) {
        __m128i left = _mm_loadl_epi64((const __m128i *)words);
        __m128i right = _mm_loadl_epi64((const __m128i *)(words + BLOCK_SIZE));
        _mm_storeu_si128((__m128i *)row, _mm_unpacklo_epi64(left, right));
    }
}

static void scatter_blocks(const uint32_t *row, uint32_t block, uint32_t blocks, uint32_t *words)
{
    for (uint32_t i = 0; i < blocks; i++, words += block, row += BLOCK_SIZE) {
        __m128i four = _mm_loadu_si128((const __m128i *)row);
        _mm_storel_epi64((__m128i *)words, four);
        _mm_storel_epi64((__m128i *)(words + BLOCK_SIZE), _mm_unpackhi_epi64(four, four));
    }
}

/* A part of a row of a tile, and of its blocks. */
struct part {
    size_t start; /* the first block's word in a plane */
    uint32_t skipped, count, blocks;
    uint32_t block; /* from a block to the next */
    size_t plane;   /* from a plane to the next */
};

static struct part part_of(const struct tile_order *order, uint32_t x, uint32_t y, uint32_t count)
{
    x %= TILE_SIZE;
    uint32_t skipped = x % BLOCK_SIZE;
    return (struct part){tile_order_word(order, x - skipped, y % TILE_SIZE), skipped,      count,
                         (skipped + count + BLOCK_SIZE - 1) / BLOCK_SIZE,    order->block, order->plane};
}

static void read_plane(const uint32_t *plane, const struct part *part, uint32_t *row)
{
    uint32_t whole[TILE_SIZE];
    if (part->blocks * BLOCK_SIZE == part->count) {
        gather_blocks(plane + part->start, part->block, part->blocks, row);
        return;
    }
    gather_blocks(plane + part->start, part->block, part->blocks, whole);
    memcpy(row, whole + part->skipped, part->count * sizeof *row);
}

static void write_plane(uint32_t *plane, const struct part *part, const uint32_t *row)
{
    uint32_t whole[TILE_SIZE];
    if (part->blocks * BLOCK_SIZE == part->count) {
        scatter_blocks(row, part->block, part->blocks, plane + part->start);
        return;
    }
    gather_blocks(plane + part->start, part->block, part->blocks, whole);
    memcpy(whole + part->skipped, row, part->count * sizeof *row);
    scatter_blocks(whole, part->block, part->blocks, plane + part->start);
}

/* Four planes and a row of four words a pixel. */
static void interleave(uint32_t plane[4][TILE_SIZE], uint32_t count, uint32_t *row)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t p = 0; p < 4; p++)
            row[4 * i + p] = plane[p][i];
}

static void separate(const uint32_t *row, uint32_t count, uint32_t plane[4][TILE_SIZE])
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t p = 0; p < 4; p++)
            plane[p][i] = row[4 * i + p];
}

/* --- Reading --- */

static void fill_row(const uint32_t *words, uint32_t planes, uint32_t count, uint32_t *row)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t p = 0; p < planes; p++)
            row[i * planes + p] = words[p];
}

static void read_words(const struct attachment *a, const uint32_t *words, const struct part *part,
                       uint32_t *row)
{
    uint32_t plane[4][TILE_SIZE];
    if (attachment_planes(a) == 1) {
        read_plane(words, part, row);
        return;
    }
    for (uint32_t p = 0; p < 4; p++)
        read_plane(words + p * part->plane, part, plane[p]);
    interleave(plane, part->count, row);
}

static void read_tiles(const struct attachment *a, uint32_t x, uint32_t y, uint32_t count, uint32_t *row)
{
    uint32_t tile = pixels_tile_of(a, x, y);
    const uint32_t *pending = pixels_pending_words(a, tile);
    if (pending) {
        fill_row(pending, attachment_planes(a), count, row);
        return;
    }
    struct part part = part_of(&a->memory->order, x, y, count);
    read_words(a, pixels_tile_words(a, tile), &part, row);
}

static void read_texels(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count, uint32_t *row)
{
    float texels[4 * PIXELS_ROW];
    if (pixels->format) {
        texture_read_row(&pixels->image, x, y, count, row);
        return;
    }
    texture_read_row(&pixels->image, x, y, count, texels);
    for (uint32_t i = 0; i < count; i++)
        row[i] = depth_encode(pixels->depth_format, texels[4 * i]);
}

bool pixels_are_cleared(const struct pixels *pixels, uint32_t x, uint32_t y)
{
    const struct attachment *a = pixels->tiles;
    return a && pixels_pending_words(a, pixels_tile_of(a, x, y));
}

void pixels_read_row(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count, uint32_t *row)
{
    if (pixels->tiles)
        read_tiles(pixels->tiles, x, y, count, row);
    else if (pixels->image.texels)
        read_texels(pixels, x, y, count, row);
    else
        memset(row, 0xff, count * sizeof *row);
}

/* --- Writing --- */

uint32_t *pixels_open_tile(const struct attachment *a, uint32_t tile)
{
    uint32_t *words = pixels_tile_words(a, tile), planes = attachment_planes(a);
    const uint32_t *pending = pixels_pending_words(a, tile);
    for (uint32_t p = 0; pending && p < a->samples * planes; p++)
        tile_order_fill(&a->memory->order, words + p * a->memory->order.plane, pending[p % planes]);
    if (a->format) {
        a->color_clear[tile].pending = false;
        a->color_clear[tile].changed = true;
    } else {
        a->depth_clear[tile].pending = false;
        a->depth_clear[tile].range = (struct depth_range){0, depth_mask(a->depth_format)};
        a->depth_clear[tile].changed = true;
    }
    return words;
}

static void write_tiles(const struct attachment *a, uint32_t x, uint32_t y, uint32_t count,
                        const uint32_t *row)
{
    struct part part = part_of(&a->memory->order, x, y, count);
    uint32_t *words = pixels_open_tile(a, pixels_tile_of(a, x, y)), planes = attachment_planes(a),
             plane[4][TILE_SIZE];
    if (planes > 1)
        separate(row, count, plane);
    for (uint32_t p = 0; p < a->samples * planes; p++)
        write_plane(words + p * part.plane, &part, planes > 1 ? plane[p % planes] : row);
}

static void write_texels(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count,
                         const uint32_t *row)
{
    float texels[4 * PIXELS_ROW];
    if (pixels->format) {
        texture_write_row(&pixels->image, x, y, count, row);
        return;
    }
    depth_texels(pixels->depth_format, row, count, pixels->image.opaque, texels);
    texture_write_row(&pixels->image, x, y, count, texels);
}

void pixels_write_row(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count,
                      const uint32_t *row)
{
    if (pixels->tiles)
        write_tiles(pixels->tiles, x, y, count, row);
    else if (pixels->image.texels)
        write_texels(pixels, x, y, count, row);
}

/* Returns true if the part has all pixels of the tile that the attachment has. */
static bool is_whole_tile(const struct attachment *a, const struct triptych_rectangle *part)
{
    return part->x % TILE_SIZE == 0 && part->y % TILE_SIZE == 0 &&
           part->width == min_u32(TILE_SIZE, a->width - part->x) &&
           part->height == min_u32(TILE_SIZE, a->height - part->y);
}

/* The tile remembers the words, which are written when they are needed. */
static void clear_tile(const struct attachment *a, uint32_t tile, const uint32_t *words)
{
    if (a->format) {
        a->color_clear[tile].pending = a->color_clear[tile].changed = true;
        memcpy(a->color_clear[tile].word, words, attachment_planes(a) * sizeof *words);
        return;
    }
    uint32_t depth = *words & depth_mask(a->depth_format);
    a->depth_clear[tile] = (struct depth_clear){*words, {depth, depth}, .pending = true, .changed = true};
}

void pixels_fill(const struct pixels *pixels, const struct triptych_rectangle *part, const uint32_t *words)
{
    uint32_t row[4 * PIXELS_ROW];
    if (pixels->tiles && is_whole_tile(pixels->tiles, part)) {
        clear_tile(pixels->tiles, pixels_tile_of(pixels->tiles, part->x, part->y), words);
        return;
    }
    fill_row(words, pixels_words(pixels), part->width, row);
    for (uint32_t y = part->y; y < part->y + part->height; y++)
        pixels_write_row(pixels, part->x, y, part->width, row);
}

static bool is_same_kind(const struct attachment *a, const struct attachment *b)
{
    return a->format == b->format && a->depth_format == b->depth_format && a->samples == 1 && b->samples == 1;
}

bool pixels_copy_tile(const struct pixels *from, uint32_t from_x, uint32_t from_y, const struct pixels *to,
                      const struct triptych_rectangle *part)
{
    const struct attachment *a = from->tiles, *b = to->tiles;
    if (!a || !b || !is_same_kind(a, b) || from_x % TILE_SIZE || from_y % TILE_SIZE ||
        part->width < TILE_SIZE || part->height < TILE_SIZE)
        return false;
    uint32_t source = pixels_tile_of(a, from_x, from_y), target = pixels_tile_of(b, part->x, part->y);
    const uint32_t *pending = pixels_pending_words(a, source);
    if (a->format)
        b->color_clear[target] = (struct color_clear){.changed = true};
    else
        b->depth_clear[target] = a->depth_clear[source];
    if (!a->format)
        b->depth_clear[target].changed = true;
    if (pending)
        clear_tile(b, target, pending);
    for (uint32_t p = 0; !pending && p < attachment_planes(a); p++)
        tile_order_copy(&a->memory->order, pixels_tile_words(a, source) + p * a->memory->order.plane,
                        &b->memory->order, pixels_tile_words(b, target) + p * b->memory->order.plane);
    return true;
}

int pixels_prepare(const struct pixels *pixels, struct error *error)
{
    struct attachment *a = pixels->tiles;
    if (a && !a->memory)
        a->memory = attachment_memory_create(a->columns, a->rows, attachment_planes(a) * a->samples,
                                             pixels->quad_rows, error);
    return !a || a->memory ? 0 : -1;
}
