/* Lines are compared with their definition (tests/support/picture/diamond.h): short and long lines, lines at
 * and near positions of ties, lines in parts, and lines that the binner's tests accept. */
#include "render/raster/raster.h"
#include "tests/render/raster/random.h"
#include "tests/support/picture/diamond.h"
#include "tests/support/system/seed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WINDOW_MAXIMUM = 4194303, AREA = 160, TILES = TARGET_SIZE_MAXIMUM / TILE_SIZE };

void setUp(void)
{
    random_begin();
}

void tearDown(void)
{
}

static bool covers(const struct triangle_head *h, int32_t x, int32_t y)
{
    struct diamond_line line = {h->x[0], h->y[0], h->x[1], h->y[1], h->x[2] < 0};
    return diamond_covers_wide(&line, 1 + (h->x[2] < 0 ? ~h->x[2] : h->x[2]), x, y);
}

/* --- Rasterizing as the renderer does --- */

static uint8_t count[AREA * AREA]; /* of the area whose first pixel is (area_x, area_y) */
static int32_t area_x, area_y;

static void fail_at(const struct triangle_head *h, int32_t x, int32_t y, const char *what)
{
    char text[200];
    snprintf(text, sizeof text, "%s: pixel (%d, %d), line (%d,%d) (%d,%d), last pixel %d", what, x, y,
             h->x[0], h->y[0], h->x[1], h->y[1], h->x[2]);
    TEST_FAIL_MESSAGE(text);
}

static void count_entry(const struct triangle_head *h, const struct rectangle *cut, const struct entry *e)
{
    for (int lane = 0; lane < BLOCK_PIXELS; lane++)
        if (e->coverage >> lane & 1) {
            int32_t x = (int32_t)(e->x + lane_table.x[lane] - .5f);
            int32_t y = (int32_t)(e->y + lane_table.y[lane] - .5f);
            if (x < cut->x0 || x >= cut->x1 || y < cut->y0 || y >= cut->y1)
                fail_at(h, x, y, "outside of the scissor rectangle");
            if (x >= area_x && x < area_x + AREA && y >= area_y && y < area_y + AREA)
                count[(y - area_y) * AREA + x - area_x]++;
        }
}

static void count_tile(const struct triangle_head *h, const struct rectangle *cut, int column, int row)
{
    struct entry entries[TILE_BLOCKS];
    uint32_t entry_count = raster_line_tile(h, cut, column, row, 77, entries);
    int last = -1;
    for (uint32_t i = 0; i < entry_count; i++) {
        const struct entry *e = &entries[i];
        if (!e->coverage || e->triangle != 77 || e->block <= last)
            fail_at(h, (int32_t)e->x, (int32_t)e->y, "an empty, foreign or unordered entry");
        TEST_ASSERT_EQUAL_FLOAT((float)(column * TILE_SIZE + e->block % 16 * 4), e->x);
        TEST_ASSERT_EQUAL_FLOAT((float)(row * TILE_SIZE + e->block / 16 * 4), e->y);
        last = e->block;
        count_entry(h, cut, e);
    }
}

static void count_line(const struct triangle_head *h, const struct rectangle *cut)
{
    struct raster r;
    if (!raster_line_prepare(&r, h, cut))
        return;
    struct rectangle tiles = raster_tiles(&r.bounds);
    for (int row = tiles.y0; row < tiles.y1; row++)
        for (int column = tiles.x0; column < tiles.x1; column++)
            if (raster_touches(&r, column, row))
                count_tile(h, cut, column, row);
}

static void expect_oracle(const struct triangle_head *h, const struct rectangle *cut)
{
    memset(count, 0, sizeof count);
    count_line(h, cut);
    for (int32_t y = area_y; y < area_y + AREA; y++)
        for (int32_t x = area_x; x < area_x + AREA; x++) {
            bool in = x >= cut->x0 && x < cut->x1 && y >= cut->y0 && y < cut->y1;
            if (count[(y - area_y) * AREA + x - area_x] != (in && covers(h, x, y)))
                fail_at(h, x, y, "coverage is not the definition's");
        }
}

static struct triangle_head line(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t last)
{
    return (struct triangle_head){.visible = -1, .x = {x0, x1, last}, .y = {y0, y1}};
}

static const struct rectangle whole = {0, 0, TARGET_SIZE_MAXIMUM, TARGET_SIZE_MAXIMUM};

/* A position in the area: any, or on the centres and borders of pixels, where ties occur. */
static int32_t position(int32_t first, int32_t pixels)
{
    static const int32_t grid[] = {1, 1, 32, 64, 128, 256};
    int32_t step = grid[draw() % 6];
    return first * 256 + between(0, pixels * 256) / step * step;
}

/* --- Tests --- */

static void test_random_lines_cover_the_defined_pixels(void)
{
    for (unsigned i = 0; i < test_share_of(800, 8); i++) {
        int32_t size = i % 4 ? between(1, 8) : AREA - 1;
        area_x = between(0, 300);
        area_y = between(0, 300);
        int32_t x = area_x + between(0, AREA - 1 - size), y = area_y + between(0, AREA - 1 - size);
        struct triangle_head h = line(position(x, size), position(y, size), position(x, size),
                                      position(y, size), -(int32_t)(i & 1));
        struct rectangle cut = {area_x + between(0, 20), area_y + between(0, 20), area_x + between(60, 200),
                                area_y + between(60, 200)};
        expect_oracle(&h, i % 3 ? &whole : &cut);
    }
}

static void test_wide_lines_cover_columns_of_pixels(void)
{
    for (unsigned i = 0; i < test_share_of(300, 8); i++) {
        int32_t size = i % 2 ? between(1, 8) : 60, extra = between(1, i % 3 ? 5 : 40);
        area_x = between(0, 300);
        area_y = between(0, 300);
        int32_t x = area_x + between(0, AREA - 1 - size), y = area_y + between(0, AREA - 1 - size);
        struct triangle_head h = line(position(x, size), position(y, size), position(x, size),
                                      position(y, size), i & 1 ? ~extra : extra);
        struct rectangle cut = {area_x + between(0, 20), area_y + between(0, 20), area_x + between(60, 200),
                                area_y + between(60, 200)};
        expect_oracle(&h, i % 3 ? &whole : &cut);
    }
}

/* All lines between the points of a grid of quarter pixels, in a pixel and its neighbours. */
static void test_all_short_lines_on_a_grid_cover_the_defined_pixels(void)
{
    enum { STEP = 64, POINTS = 9 };
    area_x = area_y = 60; /* across the corner of four tiles */
    for (int i = 0; i < 2 * POINTS * POINTS * POINTS * POINTS; i += (int)test_stride_of(11)) {
        int last = i % 2, b = i / 2 % (POINTS * POINTS), a = i / 2 / (POINTS * POINTS);
        struct triangle_head h = line(63 * 256 + a % POINTS * STEP, 63 * 256 + a / POINTS * STEP,
                                      63 * 256 + b % POINTS * STEP, 63 * 256 + b / POINTS * STEP, -last);
        memset(count, 0, sizeof count);
        count_line(&h, &whole);
        for (int32_t y = 61; y < 68; y++)
            for (int32_t x = 61; x < 68; x++)
                if (count[(y - area_y) * AREA + x - area_x] != covers(&h, x, y))
                    fail_at(&h, x, y, "coverage is not the definition's");
    }
}

/* The ends have the largest possible positions. The test compares an area somewhere on the line. */
static void test_lines_from_far_away_are_exact(void)
{
    for (unsigned i = 0; i < test_share_of(250, 5); i++) {
        int32_t x = between(0, 8191 - AREA) * 256, y = between(0, 8191 - AREA) * 256;
        int32_t dx = between(-2000000, 2000000), dy = between(-2000000, 2000000);
        struct triangle_head h = line(x - dx, y - dy, x + dx, y + dy, -1);
        for (int k = 0; k < 2; k++) {
            h.x[k] = abs(h.x[k]) > WINDOW_MAXIMUM ? (h.x[k] < 0 ? -WINDOW_MAXIMUM : WINDOW_MAXIMUM) : h.x[k];
            h.y[k] = abs(h.y[k]) > WINDOW_MAXIMUM ? (h.y[k] < 0 ? -WINDOW_MAXIMUM : WINDOW_MAXIMUM) : h.y[k];
        }
        area_x = x / 256 > AREA / 2 ? x / 256 - AREA / 2 : 0;
        area_y = y / 256 > AREA / 2 ? y / 256 - AREA / 2 : 0;
        expect_oracle(&h, &whole);
    }
}

/* Exactly one part covers each pixel of the line, whichever way the line is cut. */
static void test_a_line_in_parts_covers_its_pixels_once(void)
{
    area_x = area_y = 0;
    for (unsigned i = 0; i < test_share_of(1000, 10); i++) {
        int32_t parts = between(1, 12), dx = between(-3000, 3000), dy = between(-3000, 3000);
        int32_t x = 20480 - dx * parts / 2, y = 20480 - dy * parts / 2;
        struct triangle_head all = line(x, y, x + parts * dx, y + parts * dy, 0);
        memset(count, 0, sizeof count);
        for (int32_t k = 0; k < parts; k++) {
            struct triangle_head part = line(x + k * dx, y + k * dy, x + (k + 1) * dx, y + (k + 1) * dy, 0);
            count_line(&part, &whole);
        }
        for (int32_t v = 0; v < AREA; v++)
            for (int32_t u = 0; u < AREA; u++)
                if (count[v * AREA + u] != covers(&all, u, v))
                    fail_at(&all, u, v, "not once");
    }
}

/* Lines to a point and back, without their last pixels. The ends of this closed strip are at centres of
 * pixels. It covers each inner pixel twice, and the pixel of each end once. */
static void test_corners_of_a_closed_strip_are_covered_once(void)
{
    static const int32_t corner[5][2] = {{10, 10}, {30, 10}, {30, 25}, {10, 25}, {10, 10}};
    area_x = area_y = 0;
    memset(count, 0, sizeof count);
    for (int k = 0; k < 4; k++) {
        struct triangle_head h = line(corner[k][0] * 256 + 128, corner[k][1] * 256 + 128,
                                      corner[k + 1][0] * 256 + 128, corner[k + 1][1] * 256 + 128, 0);
        count_line(&h, &whole);
    }
    for (int32_t y = 0; y < AREA; y++)
        for (int32_t x = 0; x < AREA; x++) {
            bool in = x >= 10 && x <= 30 && y >= 10 && y <= 25;
            bool frame = in && (x == 10 || x == 30 || y == 10 || y == 25);
            TEST_ASSERT_EQUAL_UINT8(frame, count[y * AREA + x]);
        }
}

/* Lines along borders of pixels belong to the pixels above or to the left. */
static void test_ties_go_up_and_to_the_left(void)
{
    struct triangle_head across = line(2 * 256, 5 * 256, 9 * 256, 5 * 256, 0);
    struct triangle_head down = line(5 * 256, 2 * 256, 5 * 256, 9 * 256, 0);
    area_x = area_y = 0;
    memset(count, 0, sizeof count);
    count_line(&across, &whole);
    for (int x = 0; x < 12; x++) {
        TEST_ASSERT_EQUAL_UINT8(x >= 2 && x < 9, count[4 * AREA + x]);
        TEST_ASSERT_EQUAL_UINT8(0, count[5 * AREA + x]);
    }
    memset(count, 0, sizeof count);
    count_line(&down, &whole);
    for (int y = 0; y < 12; y++) {
        TEST_ASSERT_EQUAL_UINT8(y >= 2 && y < 9, count[y * AREA + 4]);
        TEST_ASSERT_EQUAL_UINT8(0, count[y * AREA + 5]);
    }
}

static void test_invisible_lines_and_lines_without_length_cover_nothing(void)
{
    struct entry entries[TILE_BLOCKS];
    struct raster r;
    struct triangle_head h = line(100, 100, 100, 100, 0);
    TEST_ASSERT_EQUAL_UINT32(0, raster_line_tile(&h, &whole, 0, 0, 0, entries));
    h = line(128, 128, 128, 128, -1);
    TEST_ASSERT_EQUAL_UINT32(1, raster_line_tile(&h, &whole, 0, 0, 0, entries));
    TEST_ASSERT_EQUAL_HEX16(1, entries[0].coverage);
    h.visible = 0;
    TEST_ASSERT_EQUAL_UINT32(0, raster_line_tile(&h, &whole, 0, 0, 0, entries));
    TEST_ASSERT_FALSE(raster_line_prepare(&r, &h, &whole));
}

/* Tiles of a large target that the binner omits have no pixels. */
static void test_tiles_that_are_left_out_are_empty(void)
{
    for (unsigned i = 0; i < test_share_of(40, 8); i++) {
        struct entry entries[TILE_BLOCKS];
        struct raster r;
        struct triangle_head h = line(between(-300000, 2300000), between(-300000, 2300000),
                                      between(-300000, 2300000), between(-300000, 2300000), -1);
        bool may = raster_line_prepare(&r, &h, &whole);
        struct rectangle tiles = may ? raster_tiles(&r.bounds) : (struct rectangle){0, 0, 0, 0};
        for (int row = 0; row < TILES; row++)
            for (int column = 0; column < TILES; column++) {
                bool in = column >= tiles.x0 && column < tiles.x1 && row >= tiles.y0 && row < tiles.y1;
                if (!in || !raster_touches(&r, column, row))
                    TEST_ASSERT_EQUAL_UINT32(0, raster_line_tile(&h, &whole, column, row, 0, entries));
            }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_lines_cover_the_defined_pixels);
    RUN_TEST(test_wide_lines_cover_columns_of_pixels);
    RUN_TEST(test_all_short_lines_on_a_grid_cover_the_defined_pixels);
    RUN_TEST(test_lines_from_far_away_are_exact);
    RUN_TEST(test_a_line_in_parts_covers_its_pixels_once);
    RUN_TEST(test_corners_of_a_closed_strip_are_covered_once);
    RUN_TEST(test_ties_go_up_and_to_the_left);
    RUN_TEST(test_invisible_lines_and_lines_without_length_cover_nothing);
    RUN_TEST(test_tiles_that_are_left_out_are_empty);
    return UNITY_END();
}
