/* Draws whose triangles have one colour each, and that replace what is there: one pixel of each triangle is
 * shaded, apart from the tile, and its words are stored wherever the triangle covers the tile.
 *
 * The routine computes the words, so they are its own bits, whatever they depend on. Which of them are stored
 * follows only from the coverage, as in the routine: there is no test. (render/tile/hidden.h has the traits
 * of such keys, and what happens where a triangle covers the whole tile.)
 *
 * The words are stored with AVX2. Without it, such draws are drawn as others. */
#include "machine/cpu.h"
#include "render/raster/raster_part.h"
#include "render/tile/hidden.h"
#include "render/tile/tile_part.h"

#include <immintrin.h>
#include <string.h>

#define WIDE __attribute__((target("avx2")))

enum {
    HALF_BLOCK = BLOCK_PIXELS / 2,
    FILL_SHARE = 2 /* of a list's triangles, each must have as many entries on average */
};

bool tile_may_fill(const struct tile_worker *worker, const struct round *round, const struct draw *draw)
{
    const unsigned needed = PIXEL_UNIFORM | PIXEL_OVERWRITES_ALL;
    unsigned traits = draw->routine[UNIT_PIXEL]->traits & (needed | PIXEL_WRITES_DEPTH);
    return traits == needed && tile_uses_uniform(round) && draw->shape == SHAPE_TRIANGLE &&
           !draw->sampling.samples && worker->target->samples == 1 && worker->target->planes <= FILL_PLANES &&
           worker->fill.wide;
}

/* --- Colours --- */

void tile_fill_begin_round(struct tile_fill *fill)
{
    memset(fill->known, 0, sizeof fill->known);
    fill->wide = cpu_has_avx2_fma();
}

/* Shades a pixel of each of the triangles: of number i, the words are those of block i of fill->words. */
static void shade(struct tile_worker *worker, const struct round *round, uint32_t count)
{
    const struct pixel_arguments call = {
        .job = worker->draw->job,
        .entries = worker->fill.entry,
        .triangles = round->arena.base,
        .lanes = &worker->lanes,
        .color = worker->fill.words,
        .depth = worker->fill.words, /* no such routine reads or writes depth */
        .count = count,
    };
    routine_run(worker->draw->routine[UNIT_PIXEL], &call, count);
    worker->pixel_calls++;
}

static struct entry entry_of(uint32_t number, uint32_t triangle)
{
    return (struct entry){.coverage = 1, .block = (uint16_t)number, .triangle = triangle};
}

/* The planes of a tile that the draw writes, and the same planes of fill->words; returns how many. */
struct planes {
    uint32_t *to[FILL_PLANES];
    const uint32_t *from[FILL_PLANES];
    uint32_t count;
};

static struct planes written_planes(const struct tile_worker *worker, uint32_t tile)
{
    const struct pixel_key *key = &worker->draw->routine[UNIT_PIXEL]->key.pixel;
    struct planes r = {.count = 0};
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct target_color *color = worker->target->colors + t;
        for (uint32_t p = 0; color->clear && key->write_mask[t] && p < storage_planes[color->storage]; p++) {
            size_t place = (size_t)(color->plane + p) * TILE_PIXELS;
            r.to[r.count] = target_tile_color(worker->target, tile) + place;
            r.from[r.count++] = worker->fill.words + place;
        }
    }
    return r;
}

/* --- Words --- */

/* The lanes of half a block whose bit is set. */
WIDE static inline __m256i lanes_of(uint32_t coverage, int half)
{
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i set = _mm256_set1_epi32((int)(coverage >> half * HALF_BLOCK));
    return _mm256_cmpeq_epi32(_mm256_and_si256(set, bits), bits);
}

WIDE static inline void store_lanes(uint32_t *words, __m256i lanes, __m256i value)
{
    __m256i *to = (__m256i *)(void *)words;
    _mm256_store_si256(to, _mm256_blendv_epi8(_mm256_load_si256(to), value, lanes));
}

/* Stores the lanes of `coverage` of `count` blocks that follow each other. */
WIDE static void fill_row(uint32_t *words, uint32_t count, uint32_t coverage, __m256i value)
{
    const uint32_t *end = words + (size_t)count * BLOCK_PIXELS;
    if (coverage == WHOLE_BLOCK) {
        for (; words < end; words += HALF_BLOCK)
            _mm256_store_si256((__m256i *)(void *)words, value);
        return;
    }
    const __m256i upper = lanes_of(coverage, 0), lower = lanes_of(coverage, 1);
    for (; words < end; words += BLOCK_PIXELS) {
        store_lanes(words, upper, value);
        store_lanes(words + HALF_BLOCK, lower, value);
    }
}

/* Stores the word in a rectangle of a plane. */
WIDE static void fill_box(uint32_t *plane, const struct rectangle *box, uint32_t word)
{
    const __m256i value = _mm256_set1_epi32((int)word);
    const int32_t left = box->x0 / BLOCK_SIZE, right = (box->x1 - 1) / BLOCK_SIZE;
    const uint32_t first = kept(columns_from, left * BLOCK_SIZE, box->x0, box->x1);
    const uint32_t last = kept(columns_from, right * BLOCK_SIZE, box->x0, box->x1);
    const int32_t from = left + (first != WHOLE_BLOCK), to = right - (last != WHOLE_BLOCK);
    for (int32_t y = box->y0 & -BLOCK_SIZE; y < box->y1; y += BLOCK_SIZE) {
        uint32_t rows = kept(rows_from, y, box->y0, box->y1), *row = plane + y * TILE_SIZE;
        if (from <= to)
            fill_row(row + from * BLOCK_PIXELS, (uint32_t)(to - from + 1), rows, value);
        if (from > left)
            fill_row(row + left * BLOCK_PIXELS, 1, rows & first, value);
        if (to < right && right >= from)
            fill_row(row + right * BLOCK_PIXELS, 1, rows & last, value);
    }
}

/* Stores the word in the blocks of entries. */
WIDE static void fill_entries(uint32_t *plane, const struct entry *entry, const struct entry *end,
                              uint32_t word)
{
    const __m256i value = _mm256_set1_epi32((int)word);
    for (; entry < end; entry++) {
        uint32_t *words = plane + entry->block * BLOCK_PIXELS;
        store_lanes(words, lanes_of(entry->coverage, 0), value);
        store_lanes(words + HALF_BLOCK, lanes_of(entry->coverage, 1), value);
    }
}

/* --- Entries --- */

/* Takes triangles off a list of entries, whose entries follow each other; end[i] is where number i ends. */
static uint32_t take_triangles(struct tile_fill *fill, const struct entry *entry, const struct entry *last,
                               const struct entry *end[FILL_TRIANGLES])
{
    uint32_t count = 0;
    while (entry < last && count < FILL_TRIANGLES) {
        const uint32_t triangle = entry->triangle;
        fill->entry[count] = entry_of(count, triangle);
        do
            entry++;
        while (entry < last && entry->triangle == triangle);
        end[count++] = entry;
    }
    return count;
}

static void run_until(struct tile_worker *worker, const struct round *round, uint32_t tile,
                      const struct entry *begin, const struct entry *end)
{
    if (begin < end)
        tile_run_entries(worker, round, tile, begin, (uint32_t)(end - begin));
}

static void fill_triangles(struct tile_worker *worker, const struct round *round, const struct planes *planes,
                           const struct entry *at, const struct entry *const *end, uint32_t count)
{
    shade(worker, round, count);
    worker->pixels_shaded += tile_count_pixels(at, (uint32_t)(end[count - 1] - at));
    for (uint32_t i = 0; i < count; at = end[i++])
        for (uint32_t p = 0; p < planes->count; p++)
            fill_entries(planes->to[p], at, end[i], planes->from[p][i * BLOCK_PIXELS]);
}

/* Tiny triangles go through the routine, as those of other draws. */
void tile_fill_blocks(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (worker->count < FILL_SHARE) {
        tile_run_blocks(worker, round, tile);
        return;
    }
    const struct planes planes = written_planes(worker, tile);
    const struct entry *done = worker->entries.entry, *last = done + worker->count, *end[FILL_TRIANGLES];
    for (const struct entry *at = done; at < last;) {
        uint32_t count = take_triangles(&worker->fill, at, last, end);
        if (end[count - 1] - at >= FILL_SHARE * count) {
            run_until(worker, round, tile, done, at);
            fill_triangles(worker, round, &planes, at, end, count);
            done = end[count - 1];
        }
        at = end[count - 1];
    }
    run_until(worker, round, tile, done, last);
    worker->count = 0;
}

/* --- Rectangles --- */

/* The rectangle's pixels of the tile, from the tile's corner; returns whether there are any. */
static bool box_in_tile(const struct tile_worker *worker, const struct round *round, uint32_t triangle,
                        struct rectangle *in)
{
    const struct raster_site *site = &worker->site;
    const struct box box = triangle_box(
        (const struct triangle_head *)(const void *)(round->arena.base + triangle), &site->limit);
    *in = (struct rectangle){box_x(box.low) - site->x, box_y(box.low) - site->y, box_x(box.high) - site->x,
                             box_y(box.high) - site->y};
    return in->x0 < in->x1 && in->y0 < in->y1;
}

/* Makes the triangle's words those of block 0. A triangle meets many tiles, so the words of one plane are
 * kept, at a place that follows from the triangle. */
static void find_words(struct tile_worker *worker, const struct round *round, uint32_t triangle,
                       const struct planes *planes)
{
    struct tile_fill *fill = &worker->fill;
    struct known_word *known = fill->known + triangle / ARENA_ALIGNMENT % FILL_KNOWN;
    uint32_t *word = fill->words + (planes->count ? planes->from[0] - fill->words : 0);
    if (planes->count == 1 && known->triangle == triangle) {
        *word = known->word;
        return;
    }
    fill->entry[0] = entry_of(0, triangle);
    shade(worker, round, 1);
    *known = (struct known_word){triangle, *word};
}

void tile_fill_rectangles(struct tile_worker *worker, const struct round *round, uint32_t tile,
                          const uint32_t *binned, uint32_t count)
{
    const struct planes planes = written_planes(worker, tile);
    tile_shade(worker, round, tile);
    tile_fill_clear(worker, tile);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t triangle = binned[i] & ~(uint32_t)BIN_BITS;
        struct rectangle box;
        if (!box_in_tile(worker, round, triangle, &box))
            continue;
        find_words(worker, round, triangle, &planes);
        for (uint32_t p = 0; p < planes.count; p++)
            fill_box(planes.to[p], &box, *planes.from[p]);
        worker->pixels_shaded += (uint64_t)((box.x1 - box.x0) * (box.y1 - box.y0));
    }
}
