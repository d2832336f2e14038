/* Points: squares whose sides are parallel to the window's (Direct3D 9, Point Sprites).
 *
 * The head of a point's record has the square's left and top in x[0] and y[0], its right and bottom in x[1]
 * and y[1], in 1/256 pixel. A pixel is covered when its centre is inside, or on the left or the top side: the
 * rule of triangles for the square's two. */
#include "render/raster/raster_part.h"

bool raster_point_bounds(const struct triangle_head *head, const struct rectangle *limit,
                         struct rectangle *bounds)
{
    *bounds = (struct rectangle){pixel_from(head->x[0]), pixel_from(head->y[0]), pixel_from(head->x[1]),
                                 pixel_from(head->y[1])};
    return intersect(bounds, limit);
}

/* The bounds define the point; its three edges are nowhere negative. */
bool raster_point_prepare(struct raster *raster, const struct triangle_head *head,
                          const struct rectangle *scissor)
{
    *raster = (struct raster){.c = {0}};
    return head->visible && raster_point_bounds(head, scissor, &raster->bounds);
}

uint32_t raster_point_tile(const struct triangle_head *head, const struct rectangle *scissor, int column,
                           int row, uint32_t record, struct entry *entries)
{
    struct rectangle limit = tile_rectangle(column, row), b;
    struct entry *next = entries;
    if (!head->visible || !intersect(&limit, scissor) || !raster_point_bounds(head, &limit, &b))
        return 0;
    for (int32_t y = b.y0 & -BLOCK_SIZE; y < b.y1; y += BLOCK_SIZE) {
        uint32_t rows = kept(rows_from, y, b.y0, b.y1);
        for (int32_t x = b.x0 & -BLOCK_SIZE; x < b.x1; x += BLOCK_SIZE)
            *next++ = block_entry(x, y, rows & kept(columns_from, x, b.x0, b.x1), record);
    }
    return (uint32_t)(next - entries);
}
