/* Triangles with AVX2: the covered pixels of a row are one range, because triangles are convex. Each row
 * of pixels gets a mask from the two ends of its range, and the masks of four rows are the coverages of
 * the blocks that they cross. So blocks without a covered pixel cost nothing, and blocks inside no more
 * than others. render/raster/raster_any.c explains edge functions and the rule for centres on an edge.
 *
 * Along a row, an edge's function is zero at one position, its crossing. Of an edge with a > 0 the pixels
 * after the crossing are inside, of another one with a < 0 those before it. An edge with a = 0 limits no
 * row within the bounds. A triangle's three a sum up to 0, so it has a left edge with a >= 0, a right one
 * with a < 0, and a third one of either kind. A centre on a left edge is inside, and one on a right edge
 * is not.
 *
 * With E the edge function including the rule, and E' = E + 1/2, the first pixel after the crossing is
 * ceil(-E' / (256 a)), with E at the pixel 0 of the row. E is an integer, so this quotient is at least 1 /
 * (512 |a|) away from every integer. The edge functions are therefore evaluated at pixel -1, which adds 1,
 * and the quotient, once limited to 0 and more, is truncated. This does not depend on the rounding mode.
 * Results are exact if the quotient's error is smaller than that distance:
 *
 * |a|, |b| < 2^23, and centres are less than 1.5 * 2^22 units away from vertices, so |E'| < 1.5 * 2^46 is
 * exact. The reciprocal of a and its product with E' are each rounded, by at most 2^-52 of their value in
 * any rounding mode; the fused step from row to row adds 2^-52 of the result and 2^-51 of the step. The
 * sum is less than 2^47 * 2^-50 / (256 |a|) = 1 / (2048 |a|).
 *
 * No operation here divides by zero or is invalid, so no exception can be raised in a thread that has
 * enabled these. */
#include "render/raster/raster_part.h"

#include <immintrin.h>
#include <string.h>

#define ROWS        __attribute__((target("avx2,fma")))
#define ROWS_INLINE ROWS static inline __attribute__((always_inline))

/* The edges by their signs: bit i of the index is set if edge i has a < 0. Words are the halves of the left,
 * the right and the third edge. One of the terms takes the third edge out of the left or right ones. */
struct order {
    alignas(32) int32_t half[8];
    double not_left, not_right;
};

#define ORDER(left, right, third, third_is_left)                                                             \
    {                                                                                                        \
        {2 * left, 2 * left + 1, 2 * right, 2 * right + 1, 2 * third, 2 * third + 1, 6, 7},                  \
            third_is_left ? 0 : -__builtin_inf(), third_is_left ? __builtin_inf() : 0                        \
    }

static const struct order orders[8] = {
    ORDER(0, 1, 2, true), /* this one and the last have no area */
    ORDER(1, 0, 2, true),  ORDER(0, 1, 2, true),  ORDER(2, 0, 1, false), ORDER(0, 2, 1, true),
    ORDER(1, 0, 2, false), ORDER(0, 1, 2, false), ORDER(0, 1, 2, true),
};

ROWS_INLINE __m128i next_vertex(__m128i v)
{
    return _mm_shuffle_epi32(v, _MM_SHUFFLE(3, 0, 2, 1));
}

struct edges {
    __m256d left, right, third_left, third_right; /* the crossings of four rows, */
    __m256d left_step, right_step, third_step;    /* and their differences from row to row */
};

/* x and y: the window's pixel before the first column, in the first row. */
ROWS_INLINE struct edges make_edges(const struct triangle_head *head, int32_t x, int32_t y)
{
    const __m128i px = _mm_loadu_si128((const __m128i *)(const void *)head->x); /* the fourth is not used */
    const __m128i py = _mm_loadu_si128((const __m128i *)(const void *)head->y);
    const __m128i words = _mm_sub_epi32(py, next_vertex(py));
    const __m256d a = _mm256_cvtepi32_pd(words);
    const __m256d b = _mm256_cvtepi32_pd(_mm_sub_epi32(next_vertex(px), px));
    const __m256d dx = _mm256_cvtepi32_pd(_mm_sub_epi32(_mm_set1_epi32(x * SUBPIXELS + CENTRE), px));
    const __m256d dy = _mm256_cvtepi32_pd(_mm_sub_epi32(_mm_set1_epi32(y * SUBPIXELS + CENTRE), py));
    /* Half a unit is added on left edges, where centres are inside, and subtracted on right ones. */
    const __m256d rule =
        _mm256_or_pd(_mm256_and_pd(a, _mm256_set1_pd(-0.0)), _mm256_set1_pd(0.5 / SUBPIXELS));
    const __m256d value =
        _mm256_fmadd_pd(a, _mm256_mul_pd(dx, _mm256_set1_pd(1.0 / SUBPIXELS)),
                        _mm256_fmadd_pd(b, _mm256_mul_pd(dy, _mm256_set1_pd(1.0 / SUBPIXELS)), rule));
    const __m128i divisor = _mm_sub_epi32(words, _mm_cmpeq_epi32(words, _mm_setzero_si128()));
    const __m256d factor = _mm256_div_pd(_mm256_set1_pd(-1), _mm256_cvtepi32_pd(divisor));
    const struct order *order = orders + (_mm_movemask_ps(_mm_castsi128_ps(words)) & 7);
    const __m256i by_order = _mm256_load_si256((const __m256i *)(const void *)order->half);
    __m256d crossing = _mm256_mul_pd(value, factor), step = _mm256_mul_pd(b, factor);
    crossing = _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(crossing), by_order));
    step = _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(step), by_order));
    const __m256d third = _mm256_permute4x64_pd(crossing, 0xaa);
    return (struct edges){_mm256_permute4x64_pd(crossing, 0),
                          _mm256_permute4x64_pd(crossing, 0x55),
                          _mm256_add_pd(third, _mm256_set1_pd(order->not_left)),
                          _mm256_add_pd(third, _mm256_set1_pd(order->not_right)),
                          _mm256_permute4x64_pd(step, 0),
                          _mm256_permute4x64_pd(step, 0x55),
                          _mm256_permute4x64_pd(step, 0xaa)};
}

/* The pixels of four rows: of each, the columns from `first` on and before `end`, which has 0 in rows outside
 * of the bounds. */
ROWS_INLINE __m256i row_masks(const struct edges *e, __m256d row, __m256d first, __m256d end)
{
    const __m256i ones = _mm256_set1_epi64x(-1);
    __m256d left = _mm256_max_pd(_mm256_fmadd_pd(row, e->left_step, e->left),
                                 _mm256_fmadd_pd(row, e->third_step, e->third_left));
    __m256d right = _mm256_min_pd(_mm256_fmadd_pd(row, e->right_step, e->right),
                                  _mm256_fmadd_pd(row, e->third_step, e->third_right));
    left = _mm256_min_pd(_mm256_max_pd(left, first), _mm256_set1_pd(TILE_SIZE));
    right = _mm256_min_pd(_mm256_max_pd(right, _mm256_setzero_pd()), end);
    return _mm256_andnot_si256(_mm256_sllv_epi64(ones, _mm256_cvtepu32_epi64(_mm256_cvttpd_epi32(right))),
                               _mm256_sllv_epi64(ones, _mm256_cvtepu32_epi64(_mm256_cvttpd_epi32(left))));
}

/* Coverages of a tile's blocks, of rows from the first on, and a bit for each that is not 0. */
struct coverages {
    alignas(32) uint16_t block[TILE_BLOCKS];
    alignas(32) uint16_t some[ROW_BLOCKS];
};

/* Makes row number `row` of them. */
ROWS_INLINE void cover_row(struct coverages *to, int32_t row, __m256i masks)
{
    const __m256i lanes = _mm256_setr_epi8(0, 1, 2, 3, 16, 17, 18, 19, 32, 33, 34, 35, 48, 49, 50, 51, 0, 1,
                                           2, 3, 16, 17, 18, 19, 32, 33, 34, 35, 48, 49, 50, 51);
    const __m256i nibble = _mm256_set1_epi8(15), low = _mm256_and_si256(masks, nibble),
                  high = _mm256_and_si256(_mm256_srli_epi16(masks, 4), nibble);
    /* Bytes: the blocks' pixels in rows 0 and 2, and those in rows 1 and 3. */
    const __m256i even = _mm256_shuffle_epi8(lanes, _mm256_unpacklo_epi8(low, high));
    const __m256i odd = _mm256_shuffle_epi8(_mm256_slli_epi16(lanes, 2), _mm256_unpackhi_epi8(low, high));
    const __m256i halves = _mm256_or_si256(even, odd);
    const __m128i upper = _mm256_castsi256_si128(halves), lower = _mm256_extracti128_si256(halves, 1);
    const __m128i none = _mm_cmpeq_epi8(_mm_or_si128(upper, lower), _mm_setzero_si128());
    __m128i *block = (__m128i *)(void *)(to->block + row * ROW_BLOCKS);
    _mm_store_si128(block, _mm_unpacklo_epi8(upper, lower));
    _mm_store_si128(block + 1, _mm_unpackhi_epi8(upper, lower));
    to->some[row] = (uint16_t)~_mm_movemask_epi8(none);
}

/* Of the four rows from the first on, those before `end`. */
ROWS_INLINE __m256d rows_before(int32_t end)
{
    static const int64_t rows[2 * BLOCK_SIZE] = {-1, -1, -1, -1, 0, 0, 0, 0};
    return _mm256_castsi256_pd(_mm256_loadu_si256((const __m256i *)(const void *)(rows + BLOCK_SIZE - end)));
}

/* Makes the coverages of the bounds, which are in pixels of the tile. Returns how many rows of blocks. */
ROWS_INLINE int32_t cover(struct coverages *to, const struct edges *edges, const struct rectangle *bounds)
{
    const int32_t y = bounds->y0 & -BLOCK_SIZE, rows = (bounds->y1 - y + BLOCK_SIZE - 1) / BLOCK_SIZE;
    const __m256d first = _mm256_set1_pd(bounds->x0), end = _mm256_set1_pd(bounds->x1);
    __m256d ends = _mm256_andnot_pd(rows_before(bounds->y0 - y), end);
    __m256d row = _mm256_setr_pd(0, 1, 2, 3);
    for (int32_t i = 0; i < rows - 1; i++) {
        cover_row(to, i, row_masks(edges, row, first, ends));
        row = _mm256_add_pd(row, _mm256_set1_pd(BLOCK_SIZE));
        ends = end;
    }
    ends = _mm256_and_pd(ends, rows_before(bounds->y1 - y - (rows - 1) * BLOCK_SIZE));
    cover_row(to, rows - 1, row_masks(edges, row, first, ends));
    return rows;
}

/* Entries of the blocks with a coverage. `row`: the parts of entries that depend on it, from the first on. */
ROWS_INLINE struct entry *store_entries(const struct coverages *from, int32_t rows, const __m128i *column,
                                        const __m128i *row, __m128i same, struct entry *next)
{
    const uint16_t *coverage = from->block;
    for (int32_t i = 0; i < rows; i += 4, row += 4, coverage += 4 * ROW_BLOCKS) {
        uint64_t left;
        memcpy(&left, from->some + i, sizeof left);
        for (; left; left &= left - 1) {
            const uint64_t block = (uint64_t)__builtin_ctzll(left);
            __m128i place = _mm_or_si128(column[block % ROW_BLOCKS], row[block / ROW_BLOCKS]);
            place = _mm_insert_epi16(_mm_or_si128(place, same), coverage[block], 4);
            _mm_storeu_si128((__m128i *)(void *)next++, place);
        }
    }
    return next;
}

ROWS struct entry *raster_rows(const struct raster_site *site, const struct triangle_head *head,
                               const struct box *box, uint32_t triangle, struct entry *next)
{
    struct coverages coverages;
    const struct rectangle bounds = {box_x(box->low) - site->x, box_y(box->low) - site->y,
                                     box_x(box->high) - site->x, box_y(box->high) - site->y};
    const struct edges edges = make_edges(head, site->x - 1, site->y + (bounds.y0 & -BLOCK_SIZE));
    _mm256_store_si256((__m256i *)(void *)coverages.some, _mm256_setzero_si256());
    const int32_t rows = cover(&coverages, &edges, &bounds);
    return store_entries(&coverages, rows, site->column, site->row + bounds.y0 / BLOCK_SIZE,
                         entry_triangle(triangle), next);
}
