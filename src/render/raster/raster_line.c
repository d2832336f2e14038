/* Lines, by the diamond rule of GDI's lines, which Direct3D 9 refers to for its own.
 *
 * The head of a line's record has the start in x[0] and y[0], the end in x[1] and y[1], in 1/256 pixel, and
 * in x[2] the number n of pixels across beyond the first, with its bits inverted if the last pixel is drawn.
 *
 * The diamond of a pixel are the points whose distances from its centre, across and down, sum up to less than
 * half a pixel; of the points at exactly half a pixel its two lower sides belong to it and the corner at the
 * bottom; the right corner does for steep lines (|dy| > |dx|); the corners at the left and the top do not. So
 * diamonds do not overlap. A line covers the pixels whose diamond it leaves on its way from the start to the
 * end, or meets in its last point if that is drawn: the pixel of the end's diamond is the last pixel. Lines
 * that follow one another without their last pixels cover no pixel twice where they meet, and a line drawn in
 * parts at its own points covers what the whole does.
 *
 * What follows from this for a line with |dx| >= |dy|, steep ones with x and y exchanged:
 *   - Where it crosses the middle of a column between its ends, at the height y, it is in the diamond of
 *     the pixel with top < y <= bottom: the boundary's lower corner belongs to the diamond, the upper does
 *     not. It has not left that diamond in the end only if the end is in it.
 *   - Anywhere else it can only leave a diamond that it started in: no line of at most 45 degrees crosses
 *     the half of a diamond beside the middle without crossing the middle.
 * Hence: the pixel at each middle strictly between the ends, and the one whose diamond the start is in, and
 * with or without the one whose diamond the end is in.
 *
 * The height at a middle is N / du with N = v0 * du + (middle - u0) * dv, where u is the longer axis, left to
 * right or top to bottom. All positions are integers, and its row, ceil(N / (256 * du)) - 1, is floor((N - 1)
 * / (256 * du)): a quotient and a remainder that are stepped from column to column (Bresenham 1965), exactly,
 * as |N| < 2^46.
 *
 * With n > 0 the line is moved by n / 2 pixels to smaller v, and each of its pixels becomes one with the n
 * that follow it along v: OpenGL ES 2.0, section 3.4.2. */
#include "render/raster/raster_part.h"

#include <stdlib.h>
#include <string.h>

/* A line along its longer axis u; v is the other. */
struct walk {
    int32_t u0, v0, du, dv; /* from the end with the smaller u: du >= |dv|, du >= 0 */
    bool steep;             /* u is y */
    int32_t extra;          /* pixels across beyond the first */
    struct rectangle limit; /* pixels that count, within one tile */
    uint16_t *coverage;     /* of the tile's blocks */
};

static inline int64_t floor_divide(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

/* The pixel whose diamond can have the window position in it: the other ones are too far away. */
static inline int32_t nearest(int32_t position)
{
    return (position - 1) >> SUBPIXEL_BITS;
}

static bool in_diamond(int32_t x, int32_t y, bool steep)
{
    int32_t dx = x - nearest(x) * SUBPIXELS - CENTRE, dy = y - nearest(y) * SUBPIXELS - CENTRE;
    int32_t distance = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy);
    if (distance != CENTRE)
        return distance < CENTRE;
    return dy > 0 || (dy == 0 && dx > 0 && steep);
}

/* Sets, or clears, the pixel (x, y) if it counts. */
static inline void mark_one(const struct walk *w, int32_t x, int32_t y, bool covered)
{
    if (x < w->limit.x0 || x >= w->limit.x1 || y < w->limit.y0 || y >= w->limit.y1)
        return;
    int32_t block = (y % TILE_SIZE / BLOCK_SIZE) * ROW_BLOCKS + x % TILE_SIZE / BLOCK_SIZE;
    int lane = (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
    if (covered)
        w->coverage[block] |= (uint16_t)(1 << lane);
    else
        w->coverage[block] &= (uint16_t) ~(1 << lane);
}

/* The same for all pixels across. */
static inline void mark(const struct walk *w, int32_t x, int32_t y, bool covered)
{
    for (int32_t i = 0; i <= w->extra; i++)
        mark_one(w, w->steep ? x + i : x, w->steep ? y : y + i, covered);
}

static int32_t extra_of(const struct triangle_head *head)
{
    return head->x[2] < 0 ? ~head->x[2] : head->x[2];
}

static bool is_steep(const struct triangle_head *head)
{
    int64_t dx = (int64_t)head->x[1] - head->x[0], dy = (int64_t)head->y[1] - head->y[0];
    return llabs(dy) > llabs(dx);
}

/* The line whose pixels are the first ones across. */
static struct triangle_head moved(const struct triangle_head *head)
{
    struct triangle_head m = *head;
    int32_t *v = is_steep(head) ? m.x : m.y, distance = extra_of(head) * CENTRE;
    v[0] -= distance;
    v[1] -= distance;
    return m;
}

static struct walk make_walk(const struct triangle_head *head)
{
    struct walk w = {.steep = is_steep(head), .extra = extra_of(head)};
    const int32_t *u = w.steep ? head->y : head->x, *v = w.steep ? head->x : head->y;
    int first = u[0] > u[1];
    w.u0 = u[first];
    w.v0 = v[first];
    w.du = u[!first] - u[first];
    w.dv = v[!first] - v[first];
    return w;
}

/* The pixels at the middles of the columns (rows, if steep) strictly between the ends. */
static void mark_middles(const struct walk *w)
{
    int32_t low = w->steep ? w->limit.y0 : w->limit.x0, high = w->steep ? w->limit.y1 : w->limit.x1;
    low = max_i32(low, (w->u0 + CENTRE) >> SUBPIXEL_BITS);
    high = min_i32(high, ((w->u0 + w->du - CENTRE - 1) >> SUBPIXEL_BITS) + 1);
    if (low >= high)
        return;
    int64_t divisor = (int64_t)w->du * SUBPIXELS;
    int64_t n = (int64_t)w->v0 * w->du + (int64_t)(low * SUBPIXELS + CENTRE - w->u0) * w->dv - 1;
    int64_t step = floor_divide(w->dv, w->du), advance = ((int64_t)w->dv - step * w->du) * SUBPIXELS;
    int64_t row = floor_divide(n, divisor), rest = n - row * divisor;
    for (int32_t u = low; u < high; u++) {
        mark(w, w->steep ? (int32_t)row : u, w->steep ? u : (int32_t)row, true);
        row += step;
        rest += advance;
        if (rest >= divisor) {
            rest -= divisor;
            row++;
        }
    }
}

static void mark_end(const struct walk *w, int32_t x, int32_t y, bool covered)
{
    if (in_diamond(x, y, w->steep))
        mark(w, nearest(x), nearest(y), covered);
}

bool raster_line_bounds(const struct triangle_head *head, const struct rectangle *limit,
                        struct rectangle *bounds)
{
    const struct triangle_head m = moved(head);
    const int32_t *x = m.x, *y = m.y, extra = extra_of(head);
    const bool steep = is_steep(head);
    *bounds = (struct rectangle){nearest(min_i32(x[0], x[1])), nearest(min_i32(y[0], y[1])),
                                 nearest(max_i32(x[0], x[1])) + 1 + (steep ? extra : 0),
                                 nearest(max_i32(y[0], y[1])) + 1 + (steep ? 0 : extra)};
    return intersect(bounds, limit);
}

/* A line that meets a pixel's diamond passes its centre at a distance, in terms of the edge function, of
 * at most half a pixel times the longer of |dx| and |dy|. Each pixel across beyond the first adds half a
 * pixel. So two of the edges are the line moved by that distance to either side. */
bool raster_line_prepare(struct raster *raster, const struct triangle_head *head,
                         const struct rectangle *scissor)
{
    if (!head->visible || !raster_line_bounds(head, scissor, &raster->bounds))
        return false;
    int32_t dx = head->x[1] - head->x[0], dy = head->y[1] - head->y[0];
    int64_t reach = CENTRE * (int64_t)max_i32(max_i32(dx, -dx), max_i32(dy, -dy)) * (1 + extra_of(head));
    int64_t value = (int64_t)dx * (CENTRE - head->y[0]) - (int64_t)dy * (CENTRE - head->x[0]);
    raster->c[0] = (reach + value) >> SUBPIXEL_BITS;
    raster->a[0] = -dy;
    raster->b[0] = dx;
    raster->c[1] = (reach - value) >> SUBPIXEL_BITS;
    raster->a[1] = dy;
    raster->b[1] = -dx;
    raster->c[2] = raster->a[2] = raster->b[2] = 0;
    return true;
}

/* Blocks of the limit with anything covered, in block order. */
static uint32_t emit(const struct walk *w, uint32_t record, struct entry *entries)
{
    struct entry *next = entries;
    for (int32_t y = w->limit.y0 & -BLOCK_SIZE; y < w->limit.y1; y += BLOCK_SIZE) {
        const uint16_t *coverage = w->coverage + y % TILE_SIZE / BLOCK_SIZE * ROW_BLOCKS;
        for (int32_t x = w->limit.x0 & -BLOCK_SIZE; x < w->limit.x1; x += BLOCK_SIZE)
            if (coverage[x % TILE_SIZE / BLOCK_SIZE])
                *next++ = block_entry(x, y, coverage[x % TILE_SIZE / BLOCK_SIZE], record);
    }
    return (uint32_t)(next - entries);
}

uint32_t raster_line_tile(const struct triangle_head *head, const struct rectangle *scissor, int column,
                          int row, uint32_t record, struct entry *entries)
{
    uint16_t coverage[TILE_BLOCKS];
    struct rectangle limit = tile_rectangle(column, row);
    const struct triangle_head first = moved(head);
    struct walk w = make_walk(&first);
    if (!head->visible || !intersect(&limit, scissor) || !raster_line_bounds(head, &limit, &w.limit))
        return 0;
    w.coverage = coverage;
    memset(coverage, 0, sizeof coverage);
    mark_middles(&w);
    mark_end(&w, first.x[0], first.y[0], true);
    mark_end(&w, first.x[1], first.y[1], head->x[2] < 0);
    return emit(&w, record, entries);
}
