/* The rectangles of a clear, sorted by rows of tiles, so that a tile does not go through those of other rows.
 */
#include "base/minmax.h"
#include "render/target/target.h"

#include <string.h>

static int32_t first_row(const struct rectangle *r)
{
    return r->y0 / TILE_SIZE;
}

static int32_t end_row(const struct rectangle *r)
{
    return (r->y1 + TILE_SIZE - 1) / TILE_SIZE;
}

size_t target_clear_bytes(const struct rectangle *rectangles, uint32_t count)
{
    size_t parts = 0;
    for (uint32_t i = 0; i < count; i++)
        parts += (size_t)(end_row(rectangles + i) - first_row(rectangles + i));
    return sizeof(struct clear_parts) + parts * sizeof(struct clear_part);
}

/* Counts the parts of each row, then places them: begin[r + 1] is where the next part of row r is placed
 * until all are. */
void target_clear_sort(const struct rectangle *rectangles, uint32_t count, struct clear_parts *parts)
{
    uint32_t *next = parts->begin + 1, sum = 0;
    memset(parts->begin, 0, sizeof parts->begin);
    for (uint32_t i = 0; i < count; i++)
        for (int32_t row = first_row(rectangles + i); row < end_row(rectangles + i); row++)
            next[row]++;
    for (uint32_t row = 0; row < TARGET_ROWS_MAXIMUM; row++) {
        uint32_t in_row = next[row];
        next[row] = sum;
        sum += in_row;
    }
    for (uint32_t i = 0; i < count; i++) {
        const struct rectangle *r = rectangles + i;
        for (int32_t row = first_row(r); row < end_row(r); row++)
            parts->part[next[row]++] =
                (struct clear_part){(uint16_t)r->x0, (uint16_t)max_i32(r->y0, row * TILE_SIZE),
                                    (uint16_t)r->x1, (uint16_t)min_i32(r->y1, (row + 1) * TILE_SIZE)};
    }
}
