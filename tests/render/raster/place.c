/* Triangles that are placed eight at a time are in the tiles that their bounds meet. */
#include "machine/cpu.h"
#include "render/raster/raster_part.h"

#include "base/random.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

enum { ROUNDS = 2000, RECORDS = 27, RECORD_BYTES = 64, PIXEL = 1 << SUBPIXEL_BITS, UNTOUCHED = 12345 };

static union {
    struct triangle_head head;
    uint8_t bytes[RECORD_BYTES];
} records[RECORDS];

static uint32_t offsets[RECORDS + RASTER_LIST_MARGIN];
static int32_t tiles[RECORDS + RASTER_LIST_MARGIN + 1];
static struct random source;

void setUp(void)
{
    source = random_start(test_seed(), 0);
}

void tearDown(void)
{
}

static int32_t below(int32_t count)
{
    return (int32_t)random_below(&source, (uint32_t)count);
}

/* Also without an area, outside of the window, with corners on centres, and at the border of a tile. */
static void make_record(struct triangle_head *head)
{
    const int32_t extents[] = {1, PIXEL / 2, 3 * PIXEL, 40 * PIXEL, 600 * PIXEL};
    int32_t extent = extents[below(5)], step = below(3) ? 1 : PIXEL / 2;
    int32_t x = below(2) ? below(700 * PIXEL) - 100 * PIXEL : below(8) * TILE_SIZE * PIXEL - extent / 2;
    int32_t y = below(2) ? below(700 * PIXEL) - 100 * PIXEL : below(8) * TILE_SIZE * PIXEL - extent / 2;
    memset(head, 0xff, sizeof *head);
    for (int i = 0; i < 3; i++) {
        head->x[i] = (x + below(extent)) / step * step;
        head->y[i] = (y + below(extent)) / step * step;
    }
}

static struct raster_window make_window(void)
{
    struct raster_window window = {
        {below(200), below(200), 0, 0}, below(2) ? INT32_MAX : below(60), 9 + below(8)};
    window.limit.x1 = window.limit.x0 + 1 + below(360);
    window.limit.y1 = window.limit.y0 + 1 + below(360);
    return window;
}

/* By the definition of bounds, one pixel after the other. */
static int32_t expected(const struct raster_window *window, const struct triangle_head *head)
{
    struct rectangle own = window_bounds(head), bounds;
    if (!bound(&own, &window->limit, &bounds))
        return RASTER_NOWHERE;
    int32_t column = bounds.x0 / TILE_SIZE, row = bounds.y0 / TILE_SIZE;
    bool alone = true,
         large = bounds.x1 - bounds.x0 > window->extent && bounds.y1 - bounds.y0 > window->extent;
    for (int32_t x = bounds.x0; x < bounds.x1; x++)
        alone &= x / TILE_SIZE == column;
    for (int32_t y = bounds.y0; y < bounds.y1; y++)
        alone &= y / TILE_SIZE == row;
    return alone && !large ? row * window->columns + column : RASTER_TILES;
}

static void check(const struct raster_window *window, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        offsets[i] = (uint32_t)below(RECORDS) * RECORD_BYTES;
    tiles[count + RASTER_LIST_MARGIN] = UNTOUCHED;
    raster_place_eight(window, records[0].bytes, offsets, count, tiles);
    for (uint32_t i = 0; i < count; i++)
        TEST_ASSERT_EQUAL_INT32(expected(window, &records[offsets[i] / RECORD_BYTES].head), tiles[i]);
    TEST_ASSERT_EQUAL_INT32(UNTOUCHED, tiles[count + RASTER_LIST_MARGIN]);
}

static void test_tiles_are_those_of_the_bounds(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("the processor has no AVX2");
    for (int round = 0; round < ROUNDS; round++) {
        const struct raster_window window = make_window();
        for (int i = 0; i < RECORDS; i++)
            make_record(&records[i].head);
        check(&window, 1 + (uint32_t)below(RECORDS));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_tiles_are_those_of_the_bounds);
    return UNITY_END();
}
