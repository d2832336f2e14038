/* Coverage of samples. A sample is covered if the pixel's centre is covered after the shape is moved by the
 * negative offset of the sample; the tests check this for each pixel. Bounds and tiles omit no covered
 * sample, and entries are in the order of blocks. */
#include "render/raster/raster_sample.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WIDTH = 3 * TILE_SIZE, HEIGHT = 2 * TILE_SIZE, SHAPES = 400 };

static struct entry_list list;
static uint8_t got[HEIGHT][WIDTH]; /* bit i: sample i */
static uint32_t seed = 77;

void setUp(void)
{
}

void tearDown(void)
{
}

static uint32_t word(void)
{
    seed = seed * 1664525 + 1013904223;
    return seed >> 8;
}

static int32_t place(int32_t limit)
{
    int32_t subpixels = limit * (1 << SUBPIXEL_BITS);
    return (int32_t)(word() % (uint32_t)(subpixels + 4096)) - 2048;
}

static struct triangle_head random_head(enum raster_shape shape)
{
    struct triangle_head head = {.visible = -1};
    int small = word() % 2;
    for (int i = 0; i < 3; i++) {
        head.x[i] = i && small ? head.x[0] + (int32_t)(word() % 2000) - 1000 : place(WIDTH);
        head.y[i] = i && small ? head.y[0] + (int32_t)(word() % 2000) - 1000 : place(HEIGHT);
    }
    int64_t area = (int64_t)(head.x[1] - head.x[0]) * (head.y[2] - head.y[0]) -
                   (int64_t)(head.x[2] - head.x[0]) * (head.y[1] - head.y[0]);
    if (shape == SHAPE_TRIANGLE) { /* clockwise; without area it is not visible */
        head.visible = area ? -1 : 0;
        int32_t x = head.x[1], y = head.y[1];
        if (area < 0) {
            head.x[1] = head.x[2];
            head.y[1] = head.y[2];
            head.x[2] = x;
            head.y[2] = y;
        }
    }
    if (shape == SHAPE_LINE)
        head.x[2] = word() % 2 ? -1 : 0;
    if (shape == SHAPE_POINT) {
        int32_t size = (int32_t)(word() % 3000);
        head.x[1] = head.x[0] + size;
        head.y[1] = head.y[0] + size;
    }
    return head;
}

/* Returns 1 if the shape covers the pixel's centre after it is moved so that the sample is at the centre. */
static int covers(const struct sampling *sampling, enum raster_shape shape, const struct triangle_head *head,
                  const struct rectangle *scissor, int sample, int x, int y)
{
    struct triangle_head moved = *head;
    struct rectangle one = {x, y, x + 1, y + 1};
    struct entry entry[TILE_BLOCKS];
    int corners = shape == SHAPE_TRIANGLE ? 3 : 2;
    for (int i = 0; i < corners && !sampling->centers; i++) {
        moved.x[i] -= layout_samples[sampling->samples][sample].x * 16;
        moved.y[i] -= layout_samples[sampling->samples][sample].y * 16;
    }
    int inside = x >= scissor->x0 && x < scissor->x1 && y >= scissor->y0 && y < scissor->y1;
    return inside && (sampling->mask >> sample & 1) &&
           raster_shapes[shape].tile(&moved, &one, x / TILE_SIZE, y / TILE_SIZE, 0, entry);
}

static void take_entries(uint32_t count, int column, int row)
{
    int last = -1;
    for (uint32_t i = 0; i < count; i++) {
        const struct entry *entry = &list.entry[i];
        uint16_t any = 0;
        TEST_ASSERT_GREATER_THAN_INT(last, entry->block);
        last = entry->block;
        TEST_ASSERT_EQUAL_UINT32(99, entry->triangle);
        TEST_ASSERT_EQUAL_INT(column * TILE_SIZE + entry->block % 16 * 4, (int)entry->x);
        TEST_ASSERT_EQUAL_INT(row * TILE_SIZE + entry->block / 16 * 4, (int)entry->y);
        for (int s = 0; s < SAMPLES_MAXIMUM; s++)
            any |= list.coverage[i].sample[s];
        TEST_ASSERT_EQUAL_HEX16(any, entry->coverage);
        TEST_ASSERT_NOT_EQUAL(0, any);
        for (int lane = 0; lane < BLOCK_PIXELS; lane++)
            for (int s = 0; s < SAMPLES_MAXIMUM; s++)
                if (list.coverage[i].sample[s] >> lane & 1)
                    got[(int)(entry->y + lane_table.y[lane])][(int)(entry->x + lane_table.x[lane])] |=
                        (uint8_t)(1u << s);
    }
}

/* Rasterizes all tiles that the tests of bounds and tiles do not reject. */
static void rasterize(const struct sampling *sampling, enum raster_shape shape,
                      const struct triangle_head *head, const struct rectangle *scissor)
{
    struct rectangle bounds;
    struct sampled_raster raster;
    memset(got, 0, sizeof got);
    if (!head->visible || !raster_sampled_bounds(sampling, shape, head, scissor, &bounds))
        return;
    struct rectangle tiles = raster_tiles(&bounds);
    raster_sampled_prepare(&raster, sampling, shape, head, scissor);
    for (int row = tiles.y0; row < tiles.y1; row++)
        for (int column = tiles.x0; column < tiles.x1; column++)
            if (raster_sampled_touches(&raster, column, row))
                take_entries(raster_sampled_tile(sampling, shape, head, scissor, column, row, 99, &list, 0),
                             column, row);
}

static void check(enum raster_shape shape, int centers)
{
    for (int round = 0; round < SHAPES; round++) {
        struct sampling sampling = {.samples = (uint8_t)(1 + round % 3), .centers = centers};
        struct triangle_head head = random_head(shape);
        int32_t x = (int32_t)(word() % WIDTH), y = (int32_t)(word() % HEIGHT);
        struct rectangle scissor = {0, 0, WIDTH, HEIGHT};
        if (round % 4 == 0)
            scissor = (struct rectangle){x / 2, y / 2, x / 2 + WIDTH / 2, y / 2 + HEIGHT / 2};
        sampling.mask = (uint8_t)((round % 5 ? 0xff : word()) & ((1u << (1u << sampling.samples)) - 1));
        rasterize(&sampling, shape, &head, &scissor);
        for (int i = 0; i < 300; i++) {
            int px = (int)(word() % WIDTH), py = (int)(word() % HEIGHT);
            if (i % 2) { /* near a corner, where edges are */
                px = (head.x[i % 4 / 2] >> SUBPIXEL_BITS) + (int)(word() % 8) - 4;
                py = (head.y[i % 4 / 2] >> SUBPIXEL_BITS) + (int)(word() % 8) - 4;
            }
            if (px < 0 || py < 0 || px >= WIDTH || py >= HEIGHT)
                continue;
            uint8_t expected = 0;
            for (int s = 0; s < 1 << sampling.samples && head.visible; s++)
                expected |= (uint8_t)(covers(&sampling, shape, &head, &scissor, s, px, py) << s);
            TEST_ASSERT_EQUAL_HEX8(expected, got[py][px]);
        }
    }
}

static void samples_of_triangles(void)
{
    check(SHAPE_TRIANGLE, 0);
}

static void samples_of_lines(void)
{
    check(SHAPE_LINE, 0);
}

static void samples_of_points(void)
{
    check(SHAPE_POINT, 0);
}

static void samples_at_centres_are_alike(void)
{
    for (int shape = 0; shape <= SHAPE_POINT; shape++)
        check((enum raster_shape)shape, 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(samples_of_triangles);
    RUN_TEST(samples_of_lines);
    RUN_TEST(samples_of_points);
    RUN_TEST(samples_at_centres_are_alike);
    return UNITY_END();
}
