/* Half-space rasterization (Pineda, A Parallel Algorithm for Polygon Rasterization, 1988) of one triangle
 * into the 4x4 blocks of one 64x64 tile.
 *
 * In each row of blocks, a block is rejected or accepted by the pixels at which an edge function is largest
 * or smallest, four blocks at a time. The pixels of the others are tested one by one. Small triangles use
 * 16-bit edge functions, and test all pixels.
 *
 * An edge along an axis is on a side of the triangle's bounds, and a centre is within the bounds exactly if
 * it is inside of that edge by the rule below. So these edges are not evaluated: half a rectangle has one
 * edge left.
 *
 * Edge function of the edge from vertex p to vertex q, in 1/65536 square pixels, positive inside:
 *   E(x, y) = (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x)
 * A centre on the edge is covered only if the edge is a left one (the inside is to the right: q.y < p.y) or a
 * top one (horizontal, the inside is below: q.x > p.x). E is an integer, so the other edges require E - 1 >=
 * 0.
 *
 * One pixel is 256 units. With a = p.y - q.y, b = q.x - p.x and E0 the value, including the rule, at the
 * centre of pixel (0, 0), the pixel (i, j) is inside when E0 + 256 * (a i + b j) >= 0. As a i + b j is an
 * integer, this is equivalent to c + a i + b j >= 0 with c = floor(E0 / 256), which has eight bits less.
 *
 * Inside a tile 32 bits suffice. Window positions are at most 2^22 - 1 in magnitude, so |a|, |b| < 2^23,
 * and |a i + b j| < 63 * 2 * 2^23 < 2^30 with i, j from 0 to 63. Let c be the value at the tile's first
 * pixel, which may need 40 bits, and s = c limited to -2^30 to 2^30. If c > 2^30, both c + a i + b j and s
 * + a i + b j are positive for every pixel of the tile; if c < -2^30, both are negative; otherwise they are
 * equal. So all signs are right, and |s + a i + b j| < 2^31. The corners of blocks are pixels of the tile,
 * too.
 *
 * The signs are combined: the bitwise or of edge functions is negative where any of them is. */
#include "render/raster/raster_part.h"

enum {
    SATURATION = 1 << 30,
    PART_SIZE = 4 * BLOCK_SIZE,
    DIRECT_BLOCKS = 32 /* largest bounds of small triangles whose blocks are all tested pixel by pixel */
};

/* The blocks of a row less the value at its first pixel: the edge function at the pixel of each block where
 * it is largest; and the distance from there to where it is smallest. */
struct row_edge {
    __m128i most[ROW_BLOCKS / 4], fall;
};

/* Which of the blocks of a row. */
struct verdict {
    uint32_t touched; /* bit i: block i may have pixels inside */
    uint32_t whole;   /* bit i: all its pixels are inside */
};

/* One triangle in one tile. Pixels count from the tile's first. */
struct walk {
    __m128i pixel[3][4];      /* edge functions of a block, quad by quad, less the value at its first pixel */
    int edges;                /* that are not along an axis: the first ones of the arrays */
    int32_t c[3], a[3], b[3]; /* at the tile's first pixel, saturated; steps */
    struct rectangle bounds;  /* not empty, within the tile */
    int32_t x, y;             /* of the tile's first pixel in the window */
    uint16_t column[ROW_BLOCKS]; /* lanes of the blocks of each column that are within the bounds */
    __m128i same;                /* the part that all its entries share: the triangle */
    const struct raster_site *site;
    struct entry *next;
};

/* Functions whose last argument is the number of edges are compiled for each number. */
#define FOR_EDGES static inline __attribute__((always_inline))

static inline int32_t edge_value(const struct walk *w, int i, int32_t x, int32_t y)
{
    return w->c[i] + w->a[i] * x + w->b[i] * y;
}

static inline int32_t magnitude(int32_t step)
{
    return step < 0 ? -step : step;
}

FOR_EDGES void make_row_edges(const struct walk *w, struct row_edge edge[3], int edges)
{
    for (int i = 0; i < edges; i++) {
        int32_t a = w->a[i], b = w->b[i], step = a * BLOCK_SIZE, last = BLOCK_SIZE - 1;
        __m128i value = _mm_add_epi32(_mm_set_epi32(3 * step, 2 * step, step, 0),
                                      _mm_set1_epi32((max_i32(a, 0) + max_i32(b, 0)) * last));
        for (int part = 0; part < ROW_BLOCKS / 4; part++) {
            edge[i].most[part] = value;
            value = _mm_add_epi32(value, _mm_set1_epi32(4 * step));
        }
        edge[i].fall = _mm_set1_epi32((magnitude(a) + magnitude(b)) * last);
    }
}

/* Bit i for each lane that is not negative. */
static inline uint32_t not_negative(__m128i v)
{
    return ~(uint32_t)_mm_movemask_ps(_mm_castsi128_ps(v)) & 15;
}

/* The blocks of the row at y, as far as they are in the parts of four blocks that the bounds meet. */
FOR_EDGES struct verdict judge(const struct walk *w, const struct row_edge edge[3], int32_t y, int edges)
{
    struct verdict v = {0, 0};
    __m128i value[3];
    for (int i = 0; i < edges; i++)
        value[i] = _mm_set1_epi32(edge_value(w, i, 0, y));
    for (int32_t part = w->bounds.x0 / PART_SIZE; part <= (w->bounds.x1 - 1) / PART_SIZE; part++) {
        __m128i most = _mm_add_epi32(value[0], edge[0].most[part]);
        __m128i least = _mm_sub_epi32(most, edge[0].fall);
        for (int i = 1; i < edges; i++) {
            __m128i at = _mm_add_epi32(value[i], edge[i].most[part]);
            most = _mm_or_si128(most, at);
            least = _mm_or_si128(least, _mm_sub_epi32(at, edge[i].fall));
        }
        v.touched |= not_negative(most) << 4 * part;
        v.whole |= not_negative(least) << 4 * part;
    }
    return v;
}

static inline void make_pixels(struct walk *w)
{
    for (int i = 0; i < w->edges; i++) {
        int32_t a = w->a[i], b = w->b[i];
        __m128i right = _mm_set1_epi32(2 * a);
        __m128i down = _mm_set1_epi32(2 * b);
        __m128i quad = _mm_set_epi32(a + b, b, a, 0);
        __m128i lower = _mm_add_epi32(quad, down);
        w->pixel[i][0] = quad;
        w->pixel[i][1] = _mm_add_epi32(quad, right);
        w->pixel[i][2] = lower;
        w->pixel[i][3] = _mm_add_epi32(lower, right);
    }
}

FOR_EDGES __m128i quad_signs(const struct walk *w, const __m128i value[3], int quad, int edges)
{
    __m128i signs = _mm_add_epi32(value[0], w->pixel[0][quad]);
    for (int i = 1; i < edges; i++)
        signs = _mm_or_si128(signs, _mm_add_epi32(value[i], w->pixel[i][quad]));
    return signs;
}

/* Lanes of a block that are inside, given the edge functions at its first pixel; packing saturates, so that
 * signs survive it. */
FOR_EDGES uint32_t block_coverage(const struct walk *w, const __m128i value[3], int edges)
{
    __m128i upper = _mm_packs_epi32(quad_signs(w, value, 0, edges), quad_signs(w, value, 1, edges));
    __m128i lower = _mm_packs_epi32(quad_signs(w, value, 2, edges), quad_signs(w, value, 3, edges));
    return ~(uint32_t)_mm_movemask_epi8(_mm_packs_epi16(upper, lower)) & WHOLE_BLOCK;
}

/* Which lanes of each column's blocks the bounds keep. */
static inline void make_columns(struct walk *w)
{
    for (int32_t x = w->bounds.x0 & -BLOCK_SIZE; x < w->bounds.x1; x += BLOCK_SIZE)
        w->column[x / BLOCK_SIZE] = (uint16_t)kept(columns_from, x, w->bounds.x0, w->bounds.x1);
}

static inline uint32_t row_lanes(const struct walk *w, int32_t y)
{
    return kept(rows_from, y, w->bounds.y0, w->bounds.y1);
}

/* An entry of a block of column i; `here` is the part that the blocks of a row share. */
static inline __m128i block_of(const struct walk *w, __m128i here, int i, uint32_t coverage)
{
    __m128i covered = _mm_slli_si128(_mm_cvtsi32_si128((int)coverage), offsetof(struct entry, coverage));
    return _mm_or_si128(_mm_or_si128(here, w->site->column[i]), covered);
}

/* The blocks i of the row at y whose bit is set in `blocks`, all within the bounds. An entry is always
 * written, and kept if it covers anything: there is room for one per block. */
FOR_EDGES void emit_partial(struct walk *w, int32_t y, uint32_t blocks, int edges)
{
    struct entry *next = w->next;
    uint32_t lanes = row_lanes(w, y);
    __m128i here = _mm_or_si128(w->same, w->site->row[y / BLOCK_SIZE]);
    int32_t value[3];
    for (int i = 0; i < edges; i++)
        value[i] = edge_value(w, i, 0, y);
    for (; blocks; blocks &= blocks - 1) {
        int i = __builtin_ctz(blocks);
        __m128i at[3];
        for (int k = 0; k < edges; k++)
            at[k] = _mm_set1_epi32(value[k] + w->a[k] * (i * BLOCK_SIZE));
        uint32_t coverage = block_coverage(w, at, edges) & lanes & w->column[i];
        _mm_storeu_si128((__m128i *)(void *)next, block_of(w, here, i, coverage));
        next += coverage != 0;
    }
    w->next = next;
}

/* The same for blocks that are inside altogether, and next to one another. */
static inline void emit_whole(struct walk *w, int32_t y, uint32_t blocks)
{
    struct entry *next = w->next;
    uint32_t lanes = row_lanes(w, y);
    __m128i here = _mm_or_si128(w->same, w->site->row[y / BLOCK_SIZE]);
    for (int i = __builtin_ctz(blocks); blocks >> i; i++)
        _mm_storeu_si128((__m128i *)(void *)next++, block_of(w, here, i, lanes & w->column[i]));
    w->next = next;
}

/* Triangles are convex: blocks that are inside altogether are one run of the row. */
FOR_EDGES void emit_row(struct walk *w, int32_t y, uint32_t blocks, uint32_t whole, int edges)
{
    uint32_t before = (whole & -whole) - 1; /* everything if nothing is whole */
    emit_partial(w, y, blocks & before, edges);
    if (!whole)
        return;
    emit_whole(w, y, whole);
    emit_partial(w, y, blocks & ~before & ~whole, edges);
}

/* `columns`: how many the bounds meet. */
FOR_EDGES void emit_rows(struct walk *w, int32_t columns, int edges)
{
    uint32_t blocks = ((1u << columns) - 1) << w->bounds.x0 / BLOCK_SIZE;
    struct row_edge edge[3];
    make_row_edges(w, edge, edges);
    for (int32_t y = w->bounds.y0 & -BLOCK_SIZE; y < w->bounds.y1; y += BLOCK_SIZE) {
        struct verdict v = judge(w, edge, y, edges);
        emit_row(w, y, v.touched & blocks, v.whole & blocks, edges);
    }
}

static inline int32_t saturate(int64_t c)
{
    c = c > SATURATION ? SATURATION : c;
    return (int32_t)(c < -SATURATION ? -SATURATION : c);
}

/* --- Small triangles ---
 *
 * Where a triangle's extent is below 64 pixels, steps and distances fit 16 bits and pmaddwd gives the
 * three edge functions with one instruction: a dx + b dy. Most triangles of a detailed mesh are small, and
 * most of these are tiny (render/raster/raster.c). */

enum { SMALL_EXTENT = 1 << 14 }; /* 1/256 pixel; a block's corner adds at most 3 pixels */

/* Edge functions of the block that is looked at, and their steps from pixel to pixel, one vector per edge. */
struct small {
    __m128i pixel[3][4];        /* of the block's pixels less the value at its first, quad by quad */
    __m128i value[3];           /* at the first pixel of the row's first block */
    __m128i across[3], down[3]; /* steps to the next block */
};

static inline __m128i pairs(__m128i low, __m128i high)
{
    return _mm_or_si128(_mm_and_si128(low, _mm_set1_epi32(0xffff)), _mm_slli_epi32(high, 16));
}

/* One edge's share, its value and steps being in all lanes. */
static inline void make_small_edge(struct small *s, int i, __m128i value, __m128i a, __m128i b)
{
    __m128i right = _mm_add_epi32(a, a), below = _mm_add_epi32(b, b);
    __m128i quad = _mm_add_epi32(_mm_and_si128(a, _mm_set_epi32(-1, 0, -1, 0)),
                                 _mm_and_si128(b, _mm_set_epi32(-1, -1, 0, 0)));
    __m128i lower = _mm_add_epi32(quad, below);
    s->pixel[i][0] = quad;
    s->pixel[i][1] = _mm_add_epi32(quad, right);
    s->pixel[i][2] = lower;
    s->pixel[i][3] = _mm_add_epi32(lower, right);
    s->value[i] = value;
    s->across[i] = _mm_add_epi32(right, right);
    s->down[i] = _mm_add_epi32(below, below);
}

/* `x` and `y`: the first pixel of the first block, in the window. */
static inline void make_small(struct small *s, const struct triangle_head *head, int32_t x, int32_t y)
{
    __m128i px = _mm_loadu_si128((const __m128i *)(const void *)head->x); /* the fourth lane is not used */
    __m128i py = _mm_loadu_si128((const __m128i *)(const void *)head->y);
    __m128i a = _mm_sub_epi32(py, _mm_shuffle_epi32(py, _MM_SHUFFLE(3, 0, 2, 1)));
    __m128i b = _mm_sub_epi32(_mm_shuffle_epi32(px, _MM_SHUFFLE(3, 0, 2, 1)), px);
    __m128i dx = _mm_sub_epi32(_mm_set1_epi32(x * SUBPIXELS + CENTRE), px);
    __m128i dy = _mm_sub_epi32(_mm_set1_epi32(y * SUBPIXELS + CENTRE), py);
    __m128i zero = _mm_setzero_si128();
    __m128i top = _mm_and_si128(_mm_cmpeq_epi32(a, zero), _mm_cmpgt_epi32(b, zero));
    __m128i top_left = _mm_or_si128(_mm_cmpgt_epi32(a, zero), top);
    __m128i rule = _mm_xor_si128(top_left, _mm_set1_epi32(-1));
    __m128i value = _mm_add_epi32(_mm_madd_epi16(pairs(a, b), pairs(dx, dy)), rule);
    value = _mm_srai_epi32(value, SUBPIXEL_BITS);
    make_small_edge(s, 0, ALL_LANES(value, 0), ALL_LANES(a, 0), ALL_LANES(b, 0));
    make_small_edge(s, 1, ALL_LANES(value, 1), ALL_LANES(a, 1), ALL_LANES(b, 1));
    make_small_edge(s, 2, ALL_LANES(value, 2), ALL_LANES(a, 2), ALL_LANES(b, 2));
}

static inline __m128i small_signs(const struct small *s, const __m128i at[3], int quad)
{
    __m128i e0 = _mm_add_epi32(at[0], s->pixel[0][quad]);
    __m128i e1 = _mm_add_epi32(at[1], s->pixel[1][quad]);
    __m128i e2 = _mm_add_epi32(at[2], s->pixel[2][quad]);
    return _mm_or_si128(_mm_or_si128(e0, e1), e2);
}

/* Emits the blocks of `columns` x `rows` from the walk's bounds' first on, which lie within the scissor. */
static inline void emit_small(struct walk *w, const struct triangle_head *head, int32_t columns, int32_t rows)
{
    struct small s;
    struct entry *next = w->next;
    int32_t x0 = w->bounds.x0 & -BLOCK_SIZE, y0 = w->bounds.y0 & -BLOCK_SIZE;
    make_small(&s, head, w->x + x0, w->y + y0);
    for (int32_t row = 0, y = y0; row < rows; row++, y += BLOCK_SIZE) {
        __m128i at[3] = {s.value[0], s.value[1], s.value[2]};
        __m128i here = _mm_or_si128(w->same, w->site->row[y / BLOCK_SIZE]);
        for (int32_t i = x0 / BLOCK_SIZE; i < x0 / BLOCK_SIZE + columns; i++) {
            __m128i upper = _mm_packs_epi32(small_signs(&s, at, 0), small_signs(&s, at, 1));
            __m128i lower = _mm_packs_epi32(small_signs(&s, at, 2), small_signs(&s, at, 3));
            uint32_t coverage = ~(uint32_t)_mm_movemask_epi8(_mm_packs_epi16(upper, lower)) & WHOLE_BLOCK;
            _mm_storeu_si128((__m128i *)(void *)next, block_of(w, here, i, coverage));
            next += coverage != 0;
            for (int e = 0; e < 3; e++)
                at[e] = _mm_add_epi32(at[e], s.across[e]);
        }
        for (int e = 0; e < 3; e++)
            s.value[e] = _mm_add_epi32(s.value[e], s.down[e]);
    }
    w->next = next;
}

/* --- One triangle in one tile --- */

/* A triangle with an area has an edge that is not along an axis. */
static inline void make_edges(struct walk *w, const struct triangle_head *head)
{
    w->edges = 0;
    for (int i = 0; i < 3; i++) {
        int32_t a, b;
        int64_t c = edge(head, i, i < 2 ? i + 1 : 0, w->x, w->y, &a, &b);
        if (!a || !b)
            continue;
        w->c[w->edges] = saturate(c);
        w->a[w->edges] = a;
        w->b[w->edges++] = b;
    }
}

/* The same for a triangle with smooth edges, whose bounds are not its own. */
static inline void make_smooth_edges(struct walk *w, const struct triangle_head *head)
{
    w->edges = 3;
    for (int i = 0; i < 3; i++)
        w->c[i] = saturate(smooth_edge(head, i, w->x, w->y, &w->a[i], &w->b[i]));
}

/* After make_edges. */
static void emit_any(struct walk *w, int32_t columns)
{
    make_pixels(w);
    make_columns(w);
    switch (w->edges) {
    case 1: emit_rows(w, columns, 1); break;
    case 2: emit_rows(w, columns, 2); break;
    default: emit_rows(w, columns, 3); break;
    }
}

/* Returns true if the blocks that the bounds touch lie within the scissor rectangle. */
static inline bool holds_blocks(const struct rectangle *scissor, const struct rectangle *bounds)
{
    return (bounds->x0 & -BLOCK_SIZE) >= scissor->x0 && (bounds->y0 & -BLOCK_SIZE) >= scissor->y0 &&
           ((bounds->x1 + BLOCK_SIZE - 1) & -BLOCK_SIZE) <= scissor->x1 &&
           ((bounds->y1 + BLOCK_SIZE - 1) & -BLOCK_SIZE) <= scissor->y1;
}

static inline void start_walk(struct walk *w, const struct raster_site *site, uint32_t triangle,
                              struct entry *entries)
{
    w->site = site;
    w->same = entry_triangle(triangle);
    w->x = site->x;
    w->y = site->y;
    w->next = entries;
}

static inline int32_t count_columns(const struct walk *w)
{
    return (w->bounds.x1 - 1) / BLOCK_SIZE - w->bounds.x0 / BLOCK_SIZE + 1;
}

static inline int32_t count_rows(const struct walk *w)
{
    return (w->bounds.y1 - 1) / BLOCK_SIZE - w->bounds.y0 / BLOCK_SIZE + 1;
}

uint32_t raster_any(const struct raster_site *site, const struct triangle_head *head, uint32_t triangle,
                    struct entry *entries)
{
    const struct rectangle *scissor = &site->scissor;
    struct walk w;
    start_walk(&w, site, triangle, entries);
    struct rectangle limit = {max_i32(scissor->x0, w.x), max_i32(scissor->y0, w.y),
                              min_i32(scissor->x1, w.x + TILE_SIZE), min_i32(scissor->y1, w.y + TILE_SIZE)};
    struct rectangle window = window_bounds(head), bounds;
    if (!head->visible || !bound(&window, &limit, &bounds))
        return 0;
    w.bounds = (struct rectangle){bounds.x0 - w.x, bounds.y0 - w.y, bounds.x1 - w.x, bounds.y1 - w.y};
    int32_t columns = count_columns(&w), rows = count_rows(&w);
    bool small = window.x1 - window.x0 < SMALL_EXTENT && window.y1 - window.y0 < SMALL_EXTENT;
    if (small && columns * rows <= DIRECT_BLOCKS && holds_blocks(scissor, &bounds))
        emit_small(&w, head, columns, rows);
    else {
        make_edges(&w, head);
        emit_any(&w, columns);
    }
    return (uint32_t)(w.next - entries);
}

uint32_t raster_smooth_tile(const struct triangle_head *head, const struct rectangle *scissor, int column,
                            int row, uint32_t record, struct entry *entries)
{
    struct raster_site site;
    struct walk w;
    struct rectangle limit = tile_rectangle(column, row), b;
    if (!head->visible || !intersect(&limit, scissor) || !raster_smooth_bounds(head, &limit, &b))
        return 0;
    raster_enter(&site, scissor, column, row);
    start_walk(&w, &site, record, entries);
    w.bounds = (struct rectangle){b.x0 - w.x, b.y0 - w.y, b.x1 - w.x, b.y1 - w.y};
    make_smooth_edges(&w, head);
    emit_any(&w, count_columns(&w));
    return (uint32_t)(w.next - entries);
}
