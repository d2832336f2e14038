/* Triangles: their bounds, the tiles that they touch, and their blocks in a tile.
 *
 * Tiny triangles are rasterized here, with 16-bit edge functions, where the processor allows it in
 * assembly; all others in render/raster/raster_any.c, which explains edge functions and the rule for
 * centres on an edge. */
#include "render/raster/raster_part.h"

#include "machine/cpu.h"

#include <assert.h>
#include <immintrin.h>

/* The bounding box of the centres that a visible triangle may cover, cut to the rectangle. Returns whether
 * anything is left. */
static bool raster_bounds(const struct triangle_head *head, const struct rectangle *limit,
                          struct rectangle *bounds)
{
    struct rectangle window = window_bounds(head);
    return bound(&window, limit, bounds);
}

bool raster_prepare(struct raster *raster, const struct triangle_head *head, const struct rectangle *scissor)
{
    if (!head->visible || !raster_bounds(head, scissor, &raster->bounds))
        return false;
    if (head->visible == HEAD_RECTANGLE) {
        for (int i = 0; i < 3; i++)
            raster->c[i] = raster->a[i] = raster->b[i] = 0;
        return true;
    }
    for (int i = 0; i < 3; i++)
        raster->c[i] = edge(head, i, i < 2 ? i + 1 : 0, 0, 0, &raster->a[i], &raster->b[i]);
    return true;
}

struct rectangle raster_tiles(const struct rectangle *b)
{
    return (struct rectangle){b->x0 / TILE_SIZE, b->y0 / TILE_SIZE, (b->x1 + TILE_SIZE - 1) / TILE_SIZE,
                              (b->y1 + TILE_SIZE - 1) / TILE_SIZE};
}

bool raster_touches(const struct raster *raster, int column, int row)
{
    for (int i = 0; i < 3; i++) {
        int64_t a = raster->a[i], b = raster->b[i];
        int64_t x = column * TILE_SIZE + (a > 0 ? TILE_SIZE - 1 : 0);
        int64_t y = row * TILE_SIZE + (b > 0 ? TILE_SIZE - 1 : 0);
        if (raster->c[i] + a * x + b * y < 0)
            return false;
    }
    return true;
}

bool raster_covers(const struct raster *raster, int column, int row)
{
    const struct rectangle *bounds = &raster->bounds;
    int x0 = column * TILE_SIZE, y0 = row * TILE_SIZE, last = TILE_SIZE - 1;
    if (bounds->x0 > x0 || bounds->y0 > y0 || bounds->x1 < x0 + TILE_SIZE || bounds->y1 < y0 + TILE_SIZE)
        return false;
    for (int i = 0; i < 3; i++) {
        int64_t a = raster->a[i], b = raster->b[i];
        int64_t x = x0 + (a < 0 ? last : 0), y = y0 + (b < 0 ? last : 0);
        if (raster->c[i] + a * x + b * y < 0)
            return false;
    }
    return true;
}

/* --- Tiny triangles ---
 *
 * Up to 21 pixels, |a| and |b| are less than 21 * 256 = 5376, and p = a i + b j with i, j from 0 to 3 is
 * between -P and P with P = 6 * 5376 = 32256. So 16 bits suffice, which gives eight signs with one
 * operation: let v be the value at a block's first pixel and s = v limited to 16 bits, 32767 at most and
 * -32768 at least, and the sum of s and p be limited in the same way, which keeps its sign. If v > 32767,
 * v + p and s + p > 32767 - P > 0; if v < -32768, both are less than P - 32768 < 0; otherwise they are
 * equal. */

enum {
    TINY_PIXELS =
        20, /* between the first centres after the vertices: the vertices are less than 21 pixels apart */
    TINY_BLOCKS = 6, /* of more, raster_rows() is faster */
    FEW = 3          /* of less, raster_one() is faster than raster_eight() */
};

struct tiny {
    __m128i
        pixel[3][2]; /* of the block's upper and lower half less the value at its first pixel, edge by edge */
    __m128i value;   /* of the edges at the first pixel of the row's first block */
    __m128i across, down; /* steps to the next block */
};

/* The pairs (a, b) of one edge in 32-bit lanes: a dx + b dy of eight pixels, y being that of the first. */
static inline __m128i half_block(__m128i edge, int16_t y)
{
    int16_t z = (int16_t)(y + 1);
    __m128i left = _mm_madd_epi16(edge, _mm_set_epi16(z, 1, z, 0, y, 1, y, 0));
    return _mm_packs_epi32(left, _mm_madd_epi16(edge, _mm_set_epi16(z, 3, z, 2, y, 3, y, 2)));
}

static inline __m128i rotated(__m128i v)
{
    return _mm_shuffle_epi32(v, _MM_SHUFFLE(3, 0, 2, 1));
}

/* Pairs of the low halves of 32-bit lanes. */
static inline __m128i word_pairs(__m128i first, __m128i second)
{
    __m128i words = _mm_packs_epi32(first, second);
    return _mm_unpacklo_epi16(words, _mm_unpackhi_epi64(words, words));
}

/* `x` and `y`: the first pixel of the first block, in the window. */
static inline void make_tiny(struct tiny *t, const struct triangle_head *head, int32_t x, int32_t y)
{
    __m128i px = _mm_loadu_si128((const __m128i *)(const void *)head->x); /* the fourth lane is not used */
    __m128i py = _mm_loadu_si128((const __m128i *)(const void *)head->y);
    __m128i a = _mm_sub_epi32(py, rotated(py)), b = _mm_sub_epi32(rotated(px), px);
    __m128i dx = _mm_sub_epi32(_mm_set1_epi32(x * SUBPIXELS + CENTRE), px);
    __m128i dy = _mm_sub_epi32(_mm_set1_epi32(y * SUBPIXELS + CENTRE), py);
    __m128i zero = _mm_setzero_si128(), edges = word_pairs(a, b);
    __m128i top = _mm_and_si128(_mm_cmpeq_epi32(a, zero), _mm_cmpgt_epi32(b, zero));
    __m128i top_left = _mm_or_si128(_mm_cmpgt_epi32(a, zero), top);
    __m128i value = _mm_madd_epi16(edges, word_pairs(dx, dy)),
            rule = _mm_xor_si128(top_left, _mm_set1_epi32(-1));
    t->value = _mm_srai_epi32(_mm_add_epi32(value, rule), SUBPIXEL_BITS);
    t->across = _mm_slli_epi32(a, 2);
    t->down = _mm_slli_epi32(b, 2);
    t->pixel[0][0] = half_block(ALL_LANES(edges, 0), 0);
    t->pixel[0][1] = half_block(ALL_LANES(edges, 0), 2);
    t->pixel[1][0] = half_block(ALL_LANES(edges, 1), 0);
    t->pixel[1][1] = half_block(ALL_LANES(edges, 1), 2);
    t->pixel[2][0] = half_block(ALL_LANES(edges, 2), 0);
    t->pixel[2][1] = half_block(ALL_LANES(edges, 2), 2);
}

/* Signs of eight pixels, the edges' values at the block's first being in all lanes. */
static inline __m128i tiny_signs(const struct tiny *t, const __m128i at[3], int half)
{
    __m128i e0 = _mm_adds_epi16(at[0], t->pixel[0][half]);
    __m128i e1 = _mm_adds_epi16(at[1], t->pixel[1][half]);
    __m128i e2 = _mm_adds_epi16(at[2], t->pixel[2][half]);
    return _mm_or_si128(_mm_or_si128(e0, e1), e2);
}

static inline uint32_t tiny_coverage(const struct tiny *t, __m128i value)
{
    __m128i words = _mm_packs_epi32(value, value), pairs = _mm_unpacklo_epi16(words, words);
    __m128i at[3] = {ALL_LANES(pairs, 0), ALL_LANES(pairs, 1), ALL_LANES(pairs, 2)};
    __m128i signs = _mm_packs_epi16(tiny_signs(t, at, 0), tiny_signs(t, at, 1));
    return ~(uint32_t)_mm_movemask_epi8(signs) & WHOLE_BLOCK;
}

/* Blocks from first to last, of the tile, in columns and rows. */
struct blocks {
    uint32_t x0, y0, x1, y1;
};

/* Emits the blocks of a tiny triangle's bounds, which lie within the scissor. Returns the end of the
 * entries. */
static inline __attribute__((always_inline)) struct entry *emit_tiny(const struct raster_site *site,
                                                                     const struct triangle_head *head,
                                                                     const struct blocks *in,
                                                                     uint32_t triangle, struct entry *next)
{
    struct tiny t;
    make_tiny(&t, head, site->x + (int32_t)in->x0 * BLOCK_SIZE, site->y + (int32_t)in->y0 * BLOCK_SIZE);
    __m128i same = entry_triangle(triangle);
    const __m128i *last_row = site->row + in->y1, *last_column = site->column + in->x1;
    for (const __m128i *row = site->row + in->y0; row <= last_row; row++) {
        __m128i value = t.value, here = _mm_or_si128(same, *row);
        for (const __m128i *column = site->column + in->x0; column <= last_column; column++) {
            uint32_t coverage = tiny_coverage(&t, value);
            __m128i covered =
                _mm_slli_si128(_mm_cvtsi32_si128((int)coverage), offsetof(struct entry, coverage));
            _mm_storeu_si128((__m128i *)(void *)next, _mm_or_si128(_mm_or_si128(here, *column), covered));
            next += coverage != 0;
            value = _mm_add_epi32(value, t.across);
        }
        t.value = _mm_add_epi32(t.value, t.down);
    }
    return next;
}

/* Writes four entries, whose words are given word by word. */
static inline void write_four(__m128i *entries, __m128i x, __m128i y, __m128i third, __m128i triangle)
{
    static_assert(!offsetof(struct entry, x) && offsetof(struct entry, y) == 4,
                  "positions are the first words");
    static_assert(offsetof(struct entry, block) == 10, "a number is the upper half of the third word");
    const __m128i first = _mm_unpacklo_epi32(x, y), last = _mm_unpackhi_epi32(x, y);
    const __m128i low = _mm_unpacklo_epi32(third, triangle), high = _mm_unpackhi_epi32(third, triangle);
    _mm_storeu_si128(entries, _mm_unpacklo_epi64(first, low));
    _mm_storeu_si128(entries + 1, _mm_unpackhi_epi64(first, low));
    _mm_storeu_si128(entries + 2, _mm_unpacklo_epi64(last, high));
    _mm_storeu_si128(entries + 3, _mm_unpackhi_epi64(last, high));
}

/* The parts of entries for the columns and the rows of blocks, four of each at a time. */
static void write_places(struct raster_site *site)
{
    const __m128i zero = _mm_setzero_si128(), step = _mm_set1_epi32(4 * BLOCK_SIZE);
    __m128i x = _mm_add_epi32(_mm_set1_epi32(site->x), _mm_setr_epi32(0, 4, 8, 12));
    __m128i y = _mm_add_epi32(_mm_set1_epi32(site->y), _mm_setr_epi32(0, 4, 8, 12));
    __m128i number = _mm_setr_epi32(0, 1 << 16, 2 << 16, 3 << 16);
    for (int i = 0; i < ROW_BLOCKS; i += 4) {
        __m128i across = _mm_castps_si128(_mm_cvtepi32_ps(x)), down = _mm_castps_si128(_mm_cvtepi32_ps(y));
        write_four(site->column + i, across, zero, number, zero);
        write_four(site->row + i, zero, down, _mm_slli_epi32(number, 4), zero);
        x = _mm_add_epi32(x, step), y = _mm_add_epi32(y, step);
        number = _mm_add_epi32(number, _mm_set1_epi32(4 << 16));
    }
    site->row[ROW_BLOCKS] = zero;
}

void raster_enter(struct raster_site *site, const struct rectangle *scissor, int column, int row)
{
    struct rectangle tile = tile_rectangle(column, row), limit = *scissor;
    intersect(&limit, &tile);
    site->limit = box_of(&limit);
    site->scissor = *scissor;
    site->whole = limit.x0 == tile.x0 && limit.y0 == tile.y0 && limit.x1 == tile.x1 && limit.y1 == tile.y1;
    site->kernel = !cpu_lacks_avx512();
    site->rows = cpu_has_avx2_fma();
    site->x = tile.x0;
    site->y = tile.y0;
    write_places(site);
}

/* The blocks from the one with the box's first pixel to the one with its last. */
static inline struct blocks blocks_of(const struct box *box)
{
    __m128i in_tile = _mm_set1_epi16(ROW_BLOCKS - 1), last = _mm_sub_epi16(box->high, _mm_set1_epi16(1));
    __m128i low = _mm_and_si128(_mm_srai_epi16(box->low, 2), in_tile);
    __m128i high = _mm_and_si128(_mm_srai_epi16(last, 2), in_tile);
    return (struct blocks){(uint32_t)_mm_extract_epi16(low, 0), (uint32_t)_mm_extract_epi16(low, 4),
                           (uint32_t)_mm_extract_epi16(high, 0), (uint32_t)_mm_extract_epi16(high, 4)};
}

struct entry *raster_one(const struct raster_site *site, const struct triangle_head *head, uint32_t triangle,
                         struct entry *entries)
{
    struct box window = whole_box(head), box = cut_box(&window, &site->limit);
    if (box_is_empty(&box))
        return entries;
    __m128i extent = _mm_subs_epi16(window.high, window.low);
    if (site->whole && of_both(_mm_cmplt_epi16(extent, _mm_set1_epi16(TINY_PIXELS + 1)))) {
        struct blocks in = blocks_of(&box);
        if (!site->rows || (in.x1 - in.x0 + 1) * (in.y1 - in.y0 + 1) <= TINY_BLOCKS)
            return emit_tiny(site, head, &in, triangle, entries);
    }
    if (site->rows)
        return raster_rows(site, head, &box, triangle, entries);
    return entries + raster_any(site, head, triangle, entries);
}

static struct raster_progress list_one_by_one(const struct raster_site *site, const uint8_t *records,
                                              const uint32_t *offset, uint32_t count, struct entry *next,
                                              const struct entry *last)
{
    for (; count && next <= last; offset++, count--)
        next =
            raster_one(site, (const struct triangle_head *)(const void *)(records + *offset), *offset, next);
    return (struct raster_progress){next, count};
}

/* Tiny triangles with AVX-512. */
static struct raster_progress list_with_kernel(const struct raster_site *site, const uint8_t *records,
                                               const uint32_t *offset, uint32_t count, struct entry *next,
                                               const struct entry *last)
{
    struct raster_progress now = {next, count};
    while (now.left && now.next <= last) {
        now = raster_tiny_avx512(site, records, offset + (count - now.left), (uint32_t)now.left, now.next,
                                 last);
        if (!now.left || now.next > last)
            break;
        uint32_t triangle = offset[count - now.left--];
        now.next = raster_one(site, (const struct triangle_head *)(const void *)(records + triangle),
                              triangle, now.next);
    }
    return now;
}

uint32_t raster_blocks(const struct raster_site *site, const uint8_t *records, uint32_t offset,
                       struct entry *entries)
{
    const struct triangle_head *head = (const struct triangle_head *)(const void *)(records + offset);
    return (uint32_t)(raster_one(site, head, offset, entries) - entries);
}

uint32_t raster_list(const struct raster_site *site, const uint8_t *records, const uint32_t *offset,
                     uint32_t count, struct entry *entries, uint32_t *used)
{
    struct entry *next = entries + *used;
    const struct entry *last = entries + PIXEL_ENTRIES - TILE_BLOCKS;
    struct raster_progress now;
    if (site->whole && site->kernel)
        now = list_with_kernel(site, records, offset, count, next, last);
    else if (site->rows && count >= FEW)
        now = raster_eight(site, records, offset, count, next, last);
    else
        now = list_one_by_one(site, records, offset, count, next, last);
    *used = (uint32_t)(now.next - entries);
    return count - (uint32_t)now.left;
}

/* The entries of a tile's blocks, two at a time; `same` is the part that all have. */
__attribute__((target("avx2"))) static void write_whole_avx2(const struct raster_site *site, __m128i same,
                                                             struct entry *entries)
{
    __m256i *next = (__m256i *)(void *)entries;
    const __m256i *column = (const __m256i *)(const void *)site->column;
    for (int row = 0; row < ROW_BLOCKS; row++) {
        __m256i here = _mm256_broadcastsi128_si256(_mm_or_si128(same, site->row[row]));
#pragma GCC unroll 8
        for (int pair = 0; pair < ROW_BLOCKS / 2; pair++)
            _mm256_storeu_si256(next++, _mm256_or_si256(here, _mm256_loadu_si256(column + pair)));
    }
}

static void write_whole(const struct raster_site *site, __m128i same, struct entry *entries)
{
    __m128i *next = (__m128i *)(void *)entries;
    for (int row = 0; row < ROW_BLOCKS; row++) {
        __m128i here = _mm_or_si128(same, site->row[row]);
        for (int column = 0; column < ROW_BLOCKS; column++)
            _mm_storeu_si128(next++, _mm_or_si128(here, site->column[column]));
    }
}

/* The words that the entries of a triangle's whole blocks have in common. */
static __m128i entry_whole(uint32_t triangle)
{
    __m128i covered = _mm_slli_si128(_mm_cvtsi32_si128(WHOLE_BLOCK), offsetof(struct entry, coverage));
    return _mm_or_si128(entry_triangle(triangle), covered);
}

uint32_t raster_first_row(int column, int row, uint32_t triangle, struct entry *entries)
{
    const struct rectangle tile = tile_rectangle(column, row);
    const __m128i y = _mm_castps_si128(_mm_set1_ps((float)tile.y0)), record = _mm_set1_epi32((int)triangle);
    __m128i x = _mm_add_epi32(_mm_set1_epi32(tile.x0), _mm_setr_epi32(0, 4, 8, 12));
    __m128i third = _mm_add_epi32(_mm_set1_epi32(WHOLE_BLOCK), _mm_setr_epi32(0, 1 << 16, 2 << 16, 3 << 16));
    __m128i *next = (__m128i *)(void *)entries;
    for (int i = 0; i < ROW_BLOCKS; i += 4, next += 4) {
        write_four(next, _mm_castps_si128(_mm_cvtepi32_ps(x)), y, third, record);
        x = _mm_add_epi32(x, _mm_set1_epi32(4 * BLOCK_SIZE));
        third = _mm_add_epi32(third, _mm_set1_epi32(4 << 16));
    }
    return ROW_BLOCKS;
}

uint32_t raster_whole(const struct raster_site *site, uint32_t triangle, struct entry *entries)
{
    const __m128i same = entry_whole(triangle);
    if (site->rows)
        write_whole_avx2(site, same, entries);
    else
        write_whole(site, same, entries);
    return TILE_BLOCKS;
}

uint32_t raster_tile(const struct triangle_head *head, const struct rectangle *scissor, int column, int row,
                     uint32_t triangle, struct entry *entries)
{
    struct raster_site site;
    raster_enter(&site, scissor, column, row);
    if (head->visible == HEAD_RECTANGLE)
        return (uint32_t)(raster_rectangle(&site, head, triangle, entries) - entries);
    return head->visible ? (uint32_t)(raster_one(&site, head, triangle, entries) - entries) : 0;
}

const struct rasterizer raster_shapes[SHAPE_COUNT] = {
    [SHAPE_TRIANGLE] = {raster_bounds, raster_prepare, raster_tile},
    [SHAPE_LINE] = {raster_line_bounds, raster_line_prepare, raster_line_tile},
    [SHAPE_POINT] = {raster_point_bounds, raster_point_prepare, raster_point_tile},
    [SHAPE_SMOOTH_TRIANGLE] = {raster_smooth_bounds, raster_smooth_prepare, raster_smooth_tile},
    [SHAPE_SMOOTH_LINE] = {raster_smooth_line_bounds, raster_smooth_line_prepare, raster_smooth_line_tile},
    [SHAPE_SMOOTH_POINT] = {raster_smooth_point_bounds, raster_smooth_point_prepare,
                            raster_smooth_point_tile},
};
