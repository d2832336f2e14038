/* Small triangles with AVX2, eight at a time. Their edges are made together, where a lane is a triangle.
 * Tiny ones, which are within 2x2 blocks, get the masks of their rows in the same way. The pixels of
 * others are found one triangle after the other, in strips of eight rows, where a lane is a row. Entries
 * are stored last. So the work on one triangle does not wait for that on another.
 * render/raster/raster_rows.c explains crossings.
 *
 * Binary32 suffices for triangles whose vertices are less than MOST_PIXELS + 1 pixels apart. With v =
 * floor(E / 256), a row's first pixel after a crossing is ceil(-(v + 1/2) / a), and this quotient is at
 * least 1 / (2 |a|) away from integers. |a|, |b| <= 7424. At the first row and at pixel -1, centres are up
 * to 33 and 32 pixels away from vertices, so |v| < 65 * 7424 < 2^19. The quotient's errors are at most
 * 2^-22 of |v / a| in any rounding mode, the one of the sum of up to 31 steps 2^-22 of 2^18 / |a|, and the
 * last rounding 2^-23 of their sum. Together they are less than 1 / (3 |a|). */
#include "render/raster/raster_eight.h"

#include <string.h>

enum { MOST_PIXELS = 28, STRIP_ROWS = 8, STRIPS = 4, STRIP_COLUMNS = 32, STRIP_BLOCKS = 16 };

#define TWICE(...) _mm256_setr_epi8(__VA_ARGS__, __VA_ARGS__)

/* Edges that limit rows: the first and the last of the left ones, with a >= 0, and of the right ones. */
enum side { FIRST_LEFT, LAST_LEFT, FIRST_RIGHT, LAST_RIGHT, SIDES };

/* Of each lane: its crossings in its first row of blocks, and their differences from row to row; pixels from
 * the corner of its first block on; and this block. */
struct eight {
    alignas(32) float at[SIDES][LANES];
    alignas(32) float step[SIDES][LANES];
    alignas(32) float first[LANES], end[LANES];
    alignas(32) int32_t first_row[LANES], end_row[LANES];
    alignas(32) uint32_t column[LANES], row[LANES]; /* bytes before its part of entries in the site */
    uint32_t small;                                 /* bit i: lane i has all of this, */
    uint32_t tiny;                                  /* and it is within 2x2 blocks, and has these: */
    alignas(32) uint16_t coverage[LANES][4];        /* of its blocks, */
    alignas(32) uint8_t bytes[LANES][4]; /* and how many bytes of entries are before its second, third and
                                                 fourth block, and after it */
};

/* The coverages of two rows of eight blocks, and a bit for each that is not 0: 0 to 7, and 16 to 23. */
struct strip {
    alignas(32) uint16_t coverage[STRIP_BLOCKS];
};

struct strips {
    struct strip strip[LANES * STRIPS];
    uint32_t some[LANES * STRIPS];
};

/* --- Edges --- */

/* An edge of each lane: its crossing in the first row, and the difference from row to row. */
struct crossing {
    __m256 at, step;
    __m256 right; /* negative if a < 0 */
};

/* The edge from one vertex to the next. x, y: the centre of the pixel before the first, in the first row. */
EIGHT_INLINE struct crossing make_crossing(const struct corners *v, int vertex, int next, __m256i x,
                                           __m256i y)
{
    const __m256i a = _mm256_sub_epi32(v->y[vertex], v->y[next]);
    const __m256i b = _mm256_sub_epi32(v->x[next], v->x[vertex]);
    const __m256i dx = _mm256_sub_epi32(x, v->x[vertex]), dy = _mm256_sub_epi32(y, v->y[vertex]);
    const __m256i rule = _mm256_srai_epi32(a, 31); /* centres on an edge are inside of left ones */
    const __m256i sum = _mm256_add_epi32(_mm256_mullo_epi32(a, dx), _mm256_mullo_epi32(b, dy));
    const __m256i value = _mm256_srai_epi32(_mm256_add_epi32(sum, rule), SUBPIXEL_BITS);
    const __m256i divisor = _mm256_sub_epi32(a, _mm256_cmpeq_epi32(a, _mm256_setzero_si256()));
    const __m256 factor = _mm256_div_ps(_mm256_set1_ps(-1), _mm256_cvtepi32_ps(divisor));
    const __m256 centre = _mm256_add_ps(_mm256_cvtepi32_ps(value), _mm256_set1_ps(0.5f));
    return (struct crossing){_mm256_mul_ps(centre, factor), _mm256_mul_ps(_mm256_cvtepi32_ps(b), factor),
                             _mm256_castsi256_ps(a)};
}

EIGHT_INLINE __m256 second_if(__m256 first, __m256 second, __m256 negative)
{
    return _mm256_blendv_ps(first, second, negative);
}

/* Some edge is left, and some edge is right. */
EIGHT_INLINE void store_sides(float to[SIDES][LANES], __m256 v0, __m256 v1, __m256 v2,
                              const struct crossing c[3])
{
    const __m256 r0 = c[0].right, r1 = c[1].right, r2 = c[2].right;
    _mm256_store_ps(to[FIRST_LEFT], second_if(v0, second_if(v1, v2, r1), r0));
    _mm256_store_ps(to[LAST_LEFT], second_if(v2, second_if(v1, v0, r1), r2));
    _mm256_store_ps(to[FIRST_RIGHT], second_if(second_if(v2, v1, r1), v0, r0));
    _mm256_store_ps(to[LAST_RIGHT], second_if(second_if(v0, v1, r1), v2, r2));
}

/* px, py: the corners of the lanes' first blocks. */
EIGHT_INLINE void make_sides(struct eight *to, const struct corners *v, __m256i px, __m256i py)
{
    const __m256i x = _mm256_sub_epi32(_mm256_slli_epi32(px, SUBPIXEL_BITS), _mm256_set1_epi32(CENTRE));
    const __m256i y = _mm256_add_epi32(_mm256_slli_epi32(py, SUBPIXEL_BITS), _mm256_set1_epi32(CENTRE));
    const struct crossing c[3] = {make_crossing(v, 0, 1, x, y), make_crossing(v, 1, 2, x, y),
                                  make_crossing(v, 2, 0, x, y)};
    store_sides(to->at, c[0].at, c[1].at, c[2].at, c);
    store_sides(to->step, c[0].step, c[1].step, c[2].step, c);
}

EIGHT_INLINE void store_lanes(void *to, __m256i v)
{
    _mm256_store_si256((__m256i *)to, v);
}

/* For the first pixels of blocks, and that of the tile along the same axis. */
EIGHT_INLINE __m256i place_bytes(__m256i pixel, int32_t tile)
{
    _Static_assert(sizeof(__m128i) == 4 * BLOCK_SIZE,
                   "bytes of a block in the site's lists of columns and rows");
    return _mm256_slli_epi32(_mm256_sub_epi32(pixel, _mm256_set1_epi32(tile)), 2);
}

EIGHT_INLINE void make_eight(struct eight *to, const struct raster_site *site, const struct corners *v)
{
    const struct range wide = range_of(v->x), high = range_of(v->y);
    const struct range x = cut(wide, box_x(site->limit.low), box_x(site->limit.high));
    const struct range y = cut(high, box_y(site->limit.low), box_y(site->limit.high));
    const __m256i corner = _mm256_set1_epi32(-BLOCK_SIZE);
    const __m256i px = _mm256_and_si256(x.first, corner), py = _mm256_and_si256(y.first, corner);
    const __m256i some =
        _mm256_and_si256(_mm256_cmpgt_epi32(x.end, x.first), _mm256_cmpgt_epi32(y.end, y.first));
    const __m256i large = _mm256_or_si256(exceeds(wide, MOST_PIXELS), exceeds(high, MOST_PIXELS));
    const struct range window_x = {px, x.end}, window_y = {py, y.end};
    const __m256i larger =
        _mm256_or_si256(exceeds(window_x, 2 * BLOCK_SIZE), exceeds(window_y, 2 * BLOCK_SIZE));
    to->small = bits_of(_mm256_andnot_si256(large, some));
    to->tiny = to->small & ~bits_of(larger);
    _mm256_store_ps(to->first, _mm256_cvtepi32_ps(_mm256_sub_epi32(x.first, px)));
    _mm256_store_ps(to->end, _mm256_cvtepi32_ps(_mm256_sub_epi32(x.end, px)));
    store_lanes(to->first_row, _mm256_sub_epi32(y.first, py));
    store_lanes(to->end_row, _mm256_sub_epi32(y.end, py));
    store_lanes(to->column, place_bytes(px, site->x));
    store_lanes(to->row, place_bytes(py, site->y));
    make_sides(to, v, px, py);
}

/* --- Tiny triangles --- */

EIGHT_INLINE __m256 side_of(const struct eight *e, enum side side, __m256 row)
{
    return _mm256_fmadd_ps(row, _mm256_load_ps(e->step[side]), _mm256_load_ps(e->at[side]));
}

/* The pixels of a row of each lane. */
EIGHT_INLINE __m256i row_masks(const struct eight *e, int number)
{
    const __m256 row = _mm256_set1_ps((float)number);
    const __m256i ones = _mm256_set1_epi32(-1);
    __m256 left = _mm256_max_ps(side_of(e, FIRST_LEFT, row), side_of(e, LAST_LEFT, row));
    __m256 right = _mm256_min_ps(side_of(e, FIRST_RIGHT, row), side_of(e, LAST_RIGHT, row));
    left = _mm256_min_ps(_mm256_max_ps(left, _mm256_load_ps(e->first)), _mm256_set1_ps(STRIP_COLUMNS));
    right = _mm256_min_ps(_mm256_max_ps(right, _mm256_setzero_ps()), _mm256_load_ps(e->end));
    return _mm256_andnot_si256(_mm256_sllv_epi32(ones, _mm256_cvttps_epi32(right)),
                               _mm256_sllv_epi32(ones, _mm256_cvttps_epi32(left)));
}

/* Bytes: the pixels of four rows. */
EIGHT_INLINE __m256i four_rows(const struct eight *e, int number)
{
    const __m256i second = _mm256_slli_epi32(row_masks(e, number + 1), 8);
    const __m256i third = _mm256_slli_epi32(row_masks(e, number + 2), 16);
    const __m256i fourth = _mm256_slli_epi32(row_masks(e, number + 3), 24);
    return _mm256_or_si256(_mm256_or_si256(row_masks(e, number), second), _mm256_or_si256(third, fourth));
}

/* Of four rows as bytes, those from `first` on and before `end`. */
EIGHT_INLINE __m256i kept_rows(__m256i first, __m256i end)
{
    const __m256i ones = _mm256_set1_epi32(-1);
    return _mm256_andnot_si256(_mm256_sllv_epi32(ones, _mm256_slli_epi32(end, 3)),
                               _mm256_sllv_epi32(ones, _mm256_slli_epi32(first, 3)));
}

/* The coverage of a block from the nibbles of its four rows. */
EIGHT_INLINE __m256i block_of(__m256i nibbles)
{
    const __m256i lanes = TWICE(0, 1, 2, 3, 16, 17, 18, 19, 32, 33, 34, 35, 48, 49, 50, 51);
    nibbles = _mm256_shuffle_epi8(lanes, _mm256_and_si256(nibbles, _mm256_set1_epi8(15)));
    return _mm256_madd_epi16(_mm256_maddubs_epi16(nibbles, _mm256_set1_epi16(0x0401)),
                             _mm256_set1_epi32(0x01000001));
}

/* Adds the bytes of an entry where there is a coverage. */
EIGHT_INLINE __m256i after_entry(__m256i bytes, __m256i coverage)
{
    const __m256i none = _mm256_cmpeq_epi32(coverage, _mm256_setzero_si256());
    return _mm256_add_epi32(bytes, _mm256_andnot_si256(none, _mm256_set1_epi32(sizeof(struct entry))));
}

EIGHT_INLINE void store_blocks(struct eight *to, const __m256i block[4])
{
    const __m256i upper = _mm256_or_si256(block[0], _mm256_slli_epi32(block[1], 16));
    const __m256i lower = _mm256_or_si256(block[2], _mm256_slli_epi32(block[3], 16));
    const __m256i even = _mm256_unpacklo_epi32(upper, lower), odd = _mm256_unpackhi_epi32(upper, lower);
    __m256i *coverage = (__m256i *)(void *)to->coverage;
    _mm256_store_si256(coverage, _mm256_permute2x128_si256(even, odd, 0x20));
    _mm256_store_si256(coverage + 1, _mm256_permute2x128_si256(even, odd, 0x31));
    const __m256i second = after_entry(_mm256_setzero_si256(), block[0]);
    const __m256i third = after_entry(second, block[1]), fourth = after_entry(third, block[2]);
    const __m256i end = after_entry(fourth, block[3]);
    const __m256i low = _mm256_or_si256(second, _mm256_slli_epi32(third, 8));
    const __m256i high = _mm256_or_si256(_mm256_slli_epi32(fourth, 16), _mm256_slli_epi32(end, 24));
    _mm256_store_si256((__m256i *)(void *)to->bytes, _mm256_or_si256(low, high));
}

EIGHT_INLINE void make_tiny(struct eight *e)
{
    const __m256i first = _mm256_load_si256((const __m256i *)(const void *)e->first_row);
    const __m256i end = _mm256_load_si256((const __m256i *)(const void *)e->end_row);
    const __m256i zero = _mm256_setzero_si256();
    const __m256i rest = _mm256_max_epi32(_mm256_sub_epi32(end, _mm256_set1_epi32(BLOCK_SIZE)), zero);
    const __m256i upper = _mm256_and_si256(four_rows(e, 0), kept_rows(first, end));
    const __m256i lower = _mm256_and_si256(four_rows(e, BLOCK_SIZE), kept_rows(zero, rest));
    const __m256i block[4] = {block_of(upper), block_of(_mm256_srli_epi32(upper, 4)), block_of(lower),
                              block_of(_mm256_srli_epi32(lower, 4))};
    store_blocks(e, block);
}

/* --- Strips --- */

EIGHT_INLINE __m256 side_at(const struct eight *e, enum side side, uint32_t lane, __m256 row)
{
    return _mm256_fmadd_ps(row, _mm256_broadcast_ss(&e->step[side][lane]),
                           _mm256_broadcast_ss(&e->at[side][lane]));
}

/* Of eight rows, those before `end`. */
EIGHT_INLINE __m256 rows_before(int32_t end)
{
    static const int32_t rows[2 * STRIP_ROWS] = {-1, -1, -1, -1, -1, -1, -1, -1};
    return _mm256_castsi256_ps(_mm256_loadu_si256((const __m256i *)(const void *)(rows + STRIP_ROWS - end)));
}

/* The pixels of the strip that begins with row `start`: bits are columns. */
EIGHT_INLINE __m256i strip_masks(const struct eight *e, uint32_t lane, int32_t start)
{
    const __m256i ones = _mm256_set1_epi32(-1);
    const __m256 row = _mm256_add_ps(_mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_ps((float)start));
    __m256 end = _mm256_broadcast_ss(&e->end[lane]);
    end = _mm256_andnot_ps(rows_before(max_i32(e->first_row[lane] - start, 0)), end);
    end = _mm256_and_ps(rows_before(min_i32(e->end_row[lane] - start, STRIP_ROWS)), end);
    __m256 left = _mm256_max_ps(side_at(e, FIRST_LEFT, lane, row), side_at(e, LAST_LEFT, lane, row));
    __m256 right = _mm256_min_ps(side_at(e, FIRST_RIGHT, lane, row), side_at(e, LAST_RIGHT, lane, row));
    left = _mm256_max_ps(left, _mm256_broadcast_ss(&e->first[lane]));
    left = _mm256_min_ps(left, _mm256_set1_ps(STRIP_COLUMNS));
    right = _mm256_min_ps(_mm256_max_ps(right, _mm256_setzero_ps()), end);
    return _mm256_andnot_si256(_mm256_sllv_epi32(ones, _mm256_cvttps_epi32(right)),
                               _mm256_sllv_epi32(ones, _mm256_cvttps_epi32(left)));
}

EIGHT_INLINE __m256i strip_coverages(__m256i masks)
{
    const __m256i turned = TWICE(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
    const __m256i sorted = TWICE(0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15);
    const __m256i lanes = TWICE(0, 1, 2, 3, 16, 17, 18, 19, 32, 33, 34, 35, 48, 49, 50, 51);
    const __m256i upper_lower = _mm256_set1_epi16(0x0401), nibble = _mm256_set1_epi8(15);
    masks = _mm256_shuffle_epi8(masks, turned); /* bytes: two blocks in each of four rows */
    __m256i even = _mm256_shuffle_epi8(lanes, _mm256_and_si256(masks, nibble));
    __m256i odd = _mm256_shuffle_epi8(lanes, _mm256_and_si256(_mm256_srli_epi16(masks, 4), nibble));
    even = _mm256_maddubs_epi16(even, upper_lower);
    odd = _mm256_maddubs_epi16(odd, upper_lower);
    return _mm256_shuffle_epi8(_mm256_packus_epi16(even, odd), sorted);
}

EIGHT_INLINE uint32_t strips_of(const struct eight *e, uint32_t lane)
{
    return (uint32_t)(e->end_row[lane] + STRIP_ROWS - 1) / STRIP_ROWS;
}

/* Makes the strips of a lane from number `strip` on. Returns the next number. */
EIGHT_INLINE uint32_t make_strips(struct strips *to, uint32_t strip, const struct eight *e, uint32_t lane)
{
    for (uint32_t end = strip + strips_of(e, lane), start = 0; strip < end; strip++, start += STRIP_ROWS) {
        const __m256i coverages = strip_coverages(strip_masks(e, lane, (int32_t)start));
        const __m256i none = _mm256_cmpeq_epi16(coverages, _mm256_setzero_si256());
        _mm256_store_si256((__m256i *)(void *)to->strip[strip].coverage, coverages);
        to->some[strip] = ~(uint32_t)_mm256_movemask_epi8(_mm256_packs_epi16(none, none));
    }
    return strip;
}

/* --- Entries --- */

EIGHT_INLINE void store_entry(uint8_t *to, __m128i entry)
{
    _mm_storeu_si128((__m128i *)(void *)to, entry);
}

#define NO_WORD -1, -1, -1, -1, -1, -1, -1, -1

/* Entries of a tiny triangle. Those of blocks without a coverage are overwritten by the next ones. */
EIGHT_INLINE struct entry *store_tiny(const struct eight *e, uint32_t lane, const __m128i *column,
                                      const __m128i *row, uint32_t triangle, struct entry *next)
{
    const __m256i words =
        _mm256_setr_epi8(NO_WORD, 0, 1, -1, -1, -1, -1, -1, -1, NO_WORD, 2, 3, -1, -1, -1, -1, -1, -1);
    const __m256i lower_words =
        _mm256_setr_epi8(NO_WORD, 4, 5, -1, -1, -1, -1, -1, -1, NO_WORD, 6, 7, -1, -1, -1, -1, -1, -1);
    long long four;
    memcpy(&four, e->coverage[lane], sizeof four);
    const __m256i coverage = _mm256_set1_epi64x(four);
    const __m256i place = _mm256_blend_epi32(_mm256_loadu_si256((const __m256i *)(const void *)column),
                                             _mm256_set1_epi32((int)triangle), 0x88);
    __m256i upper = _mm256_or_si256(place, _mm256_broadcastsi128_si256(row[0]));
    __m256i lower = _mm256_or_si256(place, _mm256_broadcastsi128_si256(row[1]));
    upper = _mm256_or_si256(upper, _mm256_shuffle_epi8(coverage, words));
    lower = _mm256_or_si256(lower, _mm256_shuffle_epi8(coverage, lower_words));
    const uint8_t *bytes = e->bytes[lane];
    uint8_t *to = (uint8_t *)next;
    store_entry(to, _mm256_castsi256_si128(upper));
    store_entry(to + bytes[0], _mm256_extracti128_si256(upper, 1));
    store_entry(to + bytes[1], _mm256_castsi256_si128(lower));
    store_entry(to + bytes[2], _mm256_extracti128_si256(lower, 1));
    return (struct entry *)(void *)(to + bytes[3]);
}

/* Entries of the blocks with a coverage. */
EIGHT_INLINE struct entry *store_strip(const struct strip *strip, uint32_t some, const __m128i *column,
                                       const __m128i *row, __m128i same, struct entry *next)
{
    for (uint32_t left = some & 0x00ff00ff; left; left &= left - 1) {
        const uint32_t bit = (uint32_t)__builtin_ctz(left), lower = bit >> 4;
        const __m128i place = _mm_or_si128(_mm_or_si128(column[bit & 7], row[lower]), same);
        store_entry((uint8_t *)next, _mm_insert_epi16(place, strip->coverage[bit - 8 * lower], 4));
        next++;
    }
    return next;
}

EIGHT_INLINE const __m128i *place_at(const __m128i *places, uint32_t bytes)
{
    return (const __m128i *)(const void *)((const uint8_t *)places + bytes);
}

/* Entries of lane number `lane`, whose strips begin with number *strip. */
EIGHT_INLINE struct entry *store_lane(const struct strips *from, uint32_t *strip, const struct eight *e,
                                      uint32_t lane, const struct raster_site *site, uint32_t triangle,
                                      struct entry *next)
{
    const __m128i *column = place_at(site->column, e->column[lane]), *row = place_at(site->row, e->row[lane]);
    if (e->tiny >> lane & 1)
        return store_tiny(e, lane, column, row, triangle, next);
    for (uint32_t end = *strip + strips_of(e, lane); *strip < end; (*strip)++, row += 2)
        next = store_strip(from->strip + *strip, from->some[*strip], column, row, entry_triangle(triangle),
                           next);
    return next;
}

/* Entries of all `count` lanes, which are tiny: they are so few that there is room. */
EIGHT_INLINE struct entry *store_all_tiny(const struct eight *e, uint32_t count,
                                          const struct raster_site *site, const uint32_t *offset,
                                          struct entry *next)
{
    for (uint32_t i = 0; i < count; i++)
        next = store_tiny(e, i, place_at(site->column, e->column[i]), place_at(site->row, e->row[i]),
                          offset[i], next);
    return next;
}

EIGHT_INLINE void make_all_strips(struct strips *to, const struct eight *e)
{
    uint32_t strip = 0;
    for (uint32_t left = e->small & ~e->tiny; left; left &= left - 1)
        strip = make_strips(to, strip, e, (uint32_t)__builtin_ctz(left));
}

/* Entries of lanes of all kinds. Returns how many are done: less if *next is after `last`. */
EIGHT_INLINE uint32_t store_mixed(const struct eight *e, uint32_t count, const struct raster_site *site,
                                  const uint8_t *records, const uint32_t *offset, struct entry **next,
                                  const struct entry *last)
{
    struct strips strips;
    uint32_t i, strip = 0;
    make_all_strips(&strips, e);
    for (i = 0; i < count && *next <= last; i++)
        if (e->small >> i & 1)
            *next = store_lane(&strips, &strip, e, i, site, offset[i], *next);
        else
            *next = raster_one(site, (const struct triangle_head *)(const void *)(records + offset[i]),
                               offset[i], *next);
    return i;
}

/* The same of `count` triangles; lanes from there on repeat the last one. */
EIGHT_INLINE uint32_t draw_eight(const struct raster_site *site, const uint8_t *records,
                                 const uint32_t *offset, uint32_t count, struct entry **next,
                                 const struct entry *last)
{
    uint32_t padded[LANES];
    struct eight eight;
    for (uint32_t i = 0; i < LANES && count < LANES; i++)
        padded[i] = offset[i < count ? i : count - 1];
    const struct corners corners = load(records, count < LANES ? padded : offset);
    make_eight(&eight, site, &corners);
    eight.small &= (1u << count) - 1;
    eight.tiny &= eight.small;
    if (eight.tiny)
        make_tiny(&eight);
    if (eight.tiny != (1u << count) - 1)
        return store_mixed(&eight, count, site, records, offset, next, last);
    *next = store_all_tiny(&eight, count, site, offset, *next);
    return count;
}

EIGHT struct raster_progress raster_eight(const struct raster_site *site, const uint8_t *records,
                                          const uint32_t *offset, uint32_t count, struct entry *next,
                                          const struct entry *last)
{
    while (count && next <= last) {
        const uint32_t done = draw_eight(site, records, offset, count < LANES ? count : LANES, &next, last);
        offset += done;
        count -= done;
    }
    return (struct raster_progress){next, count};
}
