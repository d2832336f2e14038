#include "covered.h"

#include <stdio.h>
#include <stdlib.h>
#include <unity.h>

struct covered covered_make(struct rectangle cut)
{
    struct covered a = {cut, cut.x1 - cut.x0, cut.y1 - cut.y0, NULL};
    a.count = calloc((size_t)a.width * (size_t)a.height + 1, 1);
    TEST_ASSERT_NOT_NULL(a.count);
    return a;
}

void covered_fail(const struct triangle_head *h, const struct rectangle *cut, int x, int y, const char *what)
{
    char text[256];
    snprintf(text, sizeof text,
             "%s: pixel (%d, %d), triangle (%d,%d) (%d,%d) (%d,%d), scissor %d,%d to %d,%d", what, x, y,
             h->x[0], h->y[0], h->x[1], h->y[1], h->x[2], h->y[2], cut->x0, cut->y0, cut->x1, cut->y1);
    TEST_FAIL_MESSAGE(text);
}

static void count_entry(struct covered *a, const struct triangle_head *h, const struct entry *e, int column,
                        int row)
{
    int x = column * TILE_SIZE + e->block % 16 * 4;
    int y = row * TILE_SIZE + e->block / 16 * 4;
    if (e->x != (float)x || e->y != (float)y)
        covered_fail(h, &a->cut, x, y, "the corner is not the block's");
    for (int lane = 0; lane < BLOCK_PIXELS; lane++)
        if (e->coverage >> lane & 1) {
            int px = (int)(lane_table.x[lane] - .5f) + x, py = (int)(lane_table.y[lane] - .5f) + y;
            if (px < a->cut.x0 || px >= a->cut.x1 || py < a->cut.y0 || py >= a->cut.y1)
                covered_fail(h, &a->cut, px, py, "outside of the scissor rectangle");
            a->count[(py - a->cut.y0) * a->width + px - a->cut.x0]++;
        }
}

void covered_count_tile(struct covered *a, const struct triangle_head *h, int column, int row)
{
    struct entry entries[TILE_BLOCKS];
    static uint32_t identity;
    identity += 0x9e3779b9;
    uint32_t count = raster_tile(h, &a->cut, column, row, identity, entries);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(TILE_BLOCKS, count);
    int last = -1;
    for (uint32_t i = 0; i < count; i++) {
        const struct entry *e = &entries[i];
        if (e->coverage == 0 || e->triangle != identity || e->block <= last || e->block >= TILE_BLOCKS)
            covered_fail(h, &a->cut, (int)e->x, (int)e->y, "an empty, foreign or unordered entry");
        last = e->block;
        count_entry(a, h, e, column, row);
    }
}

void covered_count(struct covered *a, const struct triangle_head *h)
{
    struct raster r;
    if (!raster_prepare(&r, h, &a->cut))
        return;
    struct rectangle tiles = raster_tiles(&r.bounds);
    TEST_ASSERT_TRUE(tiles.x0 < tiles.x1 && tiles.y0 < tiles.y1);
    for (int row = tiles.y0; row < tiles.y1; row++)
        for (int column = tiles.x0; column < tiles.x1; column++)
            if (raster_touches(&r, column, row))
                covered_count_tile(a, h, column, row);
}

bool covered_orient(struct triangle_head *h)
{
    int64_t area = (int64_t)(h->x[1] - h->x[0]) * (h->y[2] - h->y[0]) -
                   (int64_t)(h->x[2] - h->x[0]) * (h->y[1] - h->y[0]);
    if (area < 0) {
        int32_t x = h->x[1], y = h->y[1];
        h->x[1] = h->x[2];
        h->y[1] = h->y[2];
        h->x[2] = x;
        h->y[2] = y;
    }
    return area != 0;
}
