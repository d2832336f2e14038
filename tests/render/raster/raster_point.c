/* Points as rectangles: every centre is tested by itself. */
#include "render/raster/raster.h"

#include <string.h>
#include <unity.h>

enum { AREA = 256, SEED = 20240117 };

static uint64_t state = SEED;

void setUp(void)
{
}

void tearDown(void)
{
}

static int32_t between(int32_t low, int32_t high) /* both included, xorshift64* */
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    uint32_t word = (uint32_t)(state * 0x2545F4914F6CDD1DULL >> 32);
    return low + (int32_t)(word % ((uint32_t)(high - low) + 1));
}

static uint8_t count[AREA * AREA];

static void count_tile(const struct triangle_head *h, const struct rectangle *cut, int column, int row)
{
    struct entry entries[TILE_BLOCKS];
    uint32_t entry_count = raster_point_tile(h, cut, column, row, 5, entries);
    for (uint32_t i = 0; i < entry_count; i++) {
        const struct entry *e = &entries[i];
        TEST_ASSERT_TRUE(e->coverage);
        TEST_ASSERT_TRUE(!i || e->block > entries[i - 1].block);
        TEST_ASSERT_EQUAL_FLOAT((float)(column * TILE_SIZE + e->block % 16 * 4), e->x);
        TEST_ASSERT_EQUAL_FLOAT((float)(row * TILE_SIZE + e->block / 16 * 4), e->y);
        for (int lane = 0; lane < BLOCK_PIXELS; lane++)
            if (e->coverage >> lane & 1)
                count[(int)(e->y + lane_table.y[lane] - .5f) * AREA +
                      (int)(e->x + lane_table.x[lane] - .5f)]++;
    }
}

static void test_points_cover_the_centres_in_their_square(void)
{
    static const int32_t grid[] = {1, 64, 128, 256};
    for (int i = 0; i < 2000; i++) {
        int32_t step = grid[i % 4], size = i % 5 ? between(0, 20) * 64 : between(0, AREA * 256);
        int32_t x = between(-2000, AREA * 256) / step * step, y = between(-2000, AREA * 256) / step * step;
        struct triangle_head h = {.visible = -1, .x = {x - size, x + size}, .y = {y - size, y + size}};
        struct rectangle cut = {between(0, 60), between(0, 60), between(40, AREA), between(40, AREA)};
        struct raster r;
        memset(count, 0, sizeof count);
        bool may = raster_point_prepare(&r, &h, &cut);
        struct rectangle tiles = may ? raster_tiles(&r.bounds) : (struct rectangle){0, 0, 0, 0};
        for (int row = tiles.y0; row < tiles.y1; row++)
            for (int column = tiles.x0; column < tiles.x1; column++) {
                TEST_ASSERT_TRUE(raster_touches(&r, column, row));
                count_tile(&h, &cut, column, row);
            }
        for (int32_t v = 0; v < AREA; v++)
            for (int32_t u = 0; u < AREA; u++) {
                int32_t cx = u * 256 + 128, cy = v * 256 + 128;
                bool in = u >= cut.x0 && u < cut.x1 && v >= cut.y0 && v < cut.y1;
                bool square = cx >= x - size && cx < x + size && cy >= y - size && cy < y + size;
                TEST_ASSERT_EQUAL_UINT8(in && square, count[v * AREA + u]);
            }
    }
}

static void test_invisible_points_cover_nothing(void)
{
    struct triangle_head h = {.visible = 0, .x = {0, 2560}, .y = {0, 2560}};
    struct rectangle cut = {0, 0, 64, 64};
    struct entry entries[TILE_BLOCKS];
    struct raster r;
    TEST_ASSERT_FALSE(raster_point_prepare(&r, &h, &cut));
    TEST_ASSERT_EQUAL_UINT32(0, raster_point_tile(&h, &cut, 0, 0, 0, entries));
    h.visible = -1;
    TEST_ASSERT_EQUAL_UINT32(9, raster_point_tile(&h, &cut, 0, 0, 0, entries));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_points_cover_the_centres_in_their_square);
    RUN_TEST(test_invisible_points_cover_nothing);
    return UNITY_END();
}
