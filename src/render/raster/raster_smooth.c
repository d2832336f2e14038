/* Smooth primitives: triangles with smooth edges, lines and points. They cover the pixels whose squares have
 * area in common with the shape; of a triangle's edges that are not smooth, pixels must have their centres
 * inside, by the rule of render/raster/raster_any.c. The pixel routine computes the part of a pixel that is
 * covered (spec/pixel/coverage.h).
 *
 * A square touches a convex polygon if neither an edge of one nor of the other has the two on different
 * sides. For the square's own sides this is the bounding box.
 *
 * A line is the rectangle of spec/setup/setup_smooth.h, whose corners are computed in binary64. A point is a
 * circle, which touches a square if the square's nearest point is inside. */
#include "render/raster/raster_part.h"

#include <math.h>

/* --- Triangles --- */

/* Of the pixels whose squares meet the open range from `low` to `high`: the first, and the next one after. */
static inline int32_t first_touched(int32_t low)
{
    return low >> SUBPIXEL_BITS;
}

static inline int32_t end_touched(int32_t high)
{
    return (high + SUBPIXELS - 1) >> SUBPIXEL_BITS;
}

bool raster_smooth_bounds(const struct triangle_head *head, const struct rectangle *limit,
                          struct rectangle *bounds)
{
    struct rectangle window = window_bounds(head);
    *bounds = (struct rectangle){first_touched(window.x0), first_touched(window.y0), end_touched(window.x1),
                                 end_touched(window.y1)};
    return intersect(bounds, limit);
}

bool raster_smooth_prepare(struct raster *raster, const struct triangle_head *head,
                           const struct rectangle *scissor)
{
    if (!head->visible || !raster_smooth_bounds(head, scissor, &raster->bounds))
        return false;
    for (int i = 0; i < 3; i++)
        raster->c[i] = smooth_edge(head, i, 0, 0, &raster->a[i], &raster->b[i]);
    return true;
}

/* --- Blocks of other shapes --- */

/* A shape, and a function that returns true if it touches a square of `size` pixels with its corner at x, y
 * in the window. */
struct touching {
    const void *shape;
    bool (*meets)(const void *shape, int32_t x, int32_t y, int32_t size);
};

static uint32_t touched_lanes(const struct touching *t, int32_t x, int32_t y, const struct rectangle *bounds)
{
    uint32_t lanes =
        kept(columns_from, x, bounds->x0, bounds->x1) & kept(rows_from, y, bounds->y0, bounds->y1);
    for (int lane = 0; lane < BLOCK_PIXELS; lane++) {
        int32_t dx = (lane & 1) + (lane >> 1 & 2), dy = (lane >> 1 & 1) + (lane >> 2 & 2);
        if (lanes >> lane & 1 && !t->meets(t->shape, x + dx, y + dy, 1))
            lanes &= ~(1u << lane);
    }
    return lanes;
}

static uint32_t touched_blocks(const struct touching *t, const struct rectangle *bounds, uint32_t record,
                               struct entry *entries)
{
    struct entry *next = entries;
    for (int32_t y = bounds->y0 & -BLOCK_SIZE; y < bounds->y1; y += BLOCK_SIZE)
        for (int32_t x = bounds->x0 & -BLOCK_SIZE; x < bounds->x1; x += BLOCK_SIZE) {
            uint32_t lanes = t->meets(t->shape, x, y, BLOCK_SIZE) ? touched_lanes(t, x, y, bounds) : 0;
            if (lanes)
                *next++ = block_entry(x, y, lanes, record);
        }
    return (uint32_t)(next - entries);
}

/* --- Lines --- */

/* A line in 1/256 pixel. Products with its vector have the unit 1/65536 square pixel. */
struct band {
    double x, y, dx, dy;
    double half, length; /* half its width, and its length, times the length */
    double extent;       /* half of what a pixel's square takes across or along, times the length */
};

static struct band make_band(const struct triangle_head *head)
{
    struct band b = {head->x[0], head->y[0], head->x[1] - head->x[0], head->y[1] - head->y[0], 0, 0, 0};
    b.length = b.dx * b.dx + b.dy * b.dy;
    b.half = head->x[2] * sqrt(b.length) / 2;
    b.extent = CENTRE * (fabs(b.dx) + fabs(b.dy));
    return b;
}

/* Returns true if a square of `size` pixels with its corner at x, y is on no other side of an edge. */
static bool band_meets(const void *shape, int32_t x, int32_t y, int32_t size)
{
    const struct band *b = shape;
    double px = (double)x * SUBPIXELS + size * CENTRE - b->x,
           py = (double)y * SUBPIXELS + size * CENTRE - b->y;
    double across = b->dx * py - b->dy * px, along = b->dx * px + b->dy * py, extent = b->extent * size;
    return fabs(across) < b->half + extent && along > -extent && along < b->length + extent;
}

bool raster_smooth_line_bounds(const struct triangle_head *head, const struct rectangle *limit,
                               struct rectangle *bounds)
{
    const struct band b = make_band(head);
    if (b.length == 0)
        return false;
    double side_x = b.half * fabs(b.dy) / b.length, side_y = b.half * fabs(b.dx) / b.length;
    *bounds = (struct rectangle){(int32_t)floor((fmin(b.x, b.x + b.dx) - side_x) / SUBPIXELS),
                                 (int32_t)floor((fmin(b.y, b.y + b.dy) - side_y) / SUBPIXELS),
                                 (int32_t)ceil((fmax(b.x, b.x + b.dx) + side_x) / SUBPIXELS),
                                 (int32_t)ceil((fmax(b.y, b.y + b.dy) + side_y) / SUBPIXELS)};
    return intersect(bounds, limit);
}

/* Two of the edges are the long sides, moved outward by what a square takes. */
bool raster_smooth_line_prepare(struct raster *raster, const struct triangle_head *head,
                                const struct rectangle *scissor)
{
    if (!head->visible || !raster_smooth_line_bounds(head, scissor, &raster->bounds))
        return false;
    const struct band b = make_band(head);
    int32_t dx = head->x[1] - head->x[0], dy = head->y[1] - head->y[0];
    int64_t reach = (int64_t)ceil(b.half + b.extent);
    int64_t value = (int64_t)dx * (CENTRE - head->y[0]) - (int64_t)dy * (CENTRE - head->x[0]);
    *raster = (struct raster){.c = {(reach + value) >> SUBPIXEL_BITS, (reach - value) >> SUBPIXEL_BITS, 0},
                              .a = {-dy, dy, 0},
                              .b = {dx, -dx, 0},
                              .bounds = raster->bounds};
    return true;
}

uint32_t raster_smooth_line_tile(const struct triangle_head *head, const struct rectangle *scissor,
                                 int column, int row, uint32_t record, struct entry *entries)
{
    struct rectangle limit = tile_rectangle(column, row), b;
    const struct band band = make_band(head);
    const struct touching touching = {&band, band_meets};
    if (!head->visible || !intersect(&limit, scissor) || !raster_smooth_line_bounds(head, &limit, &b))
        return 0;
    return touched_blocks(&touching, &b, record, entries);
}

/* --- Points --- */

/* In 1/256 pixel; integers below 2^24. */
struct disc {
    double x, y, radius;
};

static struct disc make_disc(const struct triangle_head *head)
{
    const struct smooth_point *point =
        (const struct smooth_point *)(const void *)((const uint8_t *)head + RECORD_COVERAGE);
    return (struct disc){(double)head->origin_x * SUBPIXELS, (double)head->origin_y * SUBPIXELS,
                         (double)point->radius * SUBPIXELS};
}

static bool disc_meets(const void *shape, int32_t x, int32_t y, int32_t size)
{
    const struct disc *d = shape;
    double half = size * CENTRE, px = fabs((double)x * SUBPIXELS + half - d->x) - half,
           py = fabs((double)y * SUBPIXELS + half - d->y) - half;
    px = fmax(px, 0);
    py = fmax(py, 0);
    return px * px + py * py < d->radius * d->radius;
}

bool raster_smooth_point_bounds(const struct triangle_head *head, const struct rectangle *limit,
                                struct rectangle *bounds)
{
    const struct disc d = make_disc(head);
    if (!(d.radius > 0))
        return false;
    *bounds = (struct rectangle){
        (int32_t)floor((d.x - d.radius) / SUBPIXELS), (int32_t)floor((d.y - d.radius) / SUBPIXELS),
        (int32_t)ceil((d.x + d.radius) / SUBPIXELS), (int32_t)ceil((d.y + d.radius) / SUBPIXELS)};
    return intersect(bounds, limit);
}

bool raster_smooth_point_prepare(struct raster *raster, const struct triangle_head *head,
                                 const struct rectangle *scissor)
{
    *raster = (struct raster){.c = {0}};
    return head->visible && raster_smooth_point_bounds(head, scissor, &raster->bounds);
}

uint32_t raster_smooth_point_tile(const struct triangle_head *head, const struct rectangle *scissor,
                                  int column, int row, uint32_t record, struct entry *entries)
{
    struct rectangle limit = tile_rectangle(column, row), b;
    if (!head->visible || !intersect(&limit, scissor) || !raster_smooth_point_bounds(head, &limit, &b))
        return 0;
    const struct disc disc = make_disc(head);
    const struct touching touching = {&disc, disc_meets};
    return touched_blocks(&touching, &b, record, entries);
}
