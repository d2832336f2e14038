/* The target: the place of each pixel in its tile, clears of any part, and reading images of any size. */
#include "draw/target.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct target target;
static uint32_t *image;
static float *depth;

static const uint32_t sizes[][2] = {{1, 1}, {3, 2}, {64, 64}, {65, 63}, {130, 129}, {2, 200}, {191, 7}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static void open_target(const uint32_t size[2])
{
    TEST_ASSERT_EQUAL_INT(0, target_create(&target, size[0], size[1], NULL));
    image = malloc(sizeof *image * size[0] * size[1]);
    depth = malloc(sizeof *depth * size[0] * size[1]);
    TEST_ASSERT_TRUE(image && depth);
}

static void close_target(void)
{
    target_destroy(&target);
    free(image);
    free(depth);
    image = NULL;
    depth = NULL;
}

void setUp(void)
{
}

void tearDown(void)
{
    close_target();
}

static void read_all(void)
{
    for (uint32_t row = 0; row < target.rows; row++) {
        target_read_color(&target, row, image);
        target_read_depth(&target, row, depth);
    }
}

/* Where draw/call.h says that a pixel of the target is: tile, word in it. */
static uint32_t tile_of(uint32_t x, uint32_t y)
{
    return y / TILE_SIZE * target.columns + x / TILE_SIZE;
}

static uint32_t word_of(uint32_t x, uint32_t y)
{
    static const uint8_t lane[4][4] = {{0, 1, 4, 5}, {2, 3, 6, 7}, {8, 9, 12, 13}, {10, 11, 14, 15}};
    return (y % TILE_SIZE / 4 * 16 + x % TILE_SIZE / 4) * 16 + lane[y % 4][x % 4];
}

static void every_pixel_is_read_from_its_place(void)
{
    for (int s = 0; s < SIZES; s++) {
        open_target(sizes[s]);
        for (uint32_t y = 0; y < target.height; y++)
            for (uint32_t x = 0; x < target.width; x++) {
                target_fill_color(&target, tile_of(x, y))[word_of(x, y)] = y << 16 | x;
                target_fill_depth(&target, tile_of(x, y))[word_of(x, y)] = (float)(y * 1000 + x);
            }
        read_all();
        for (uint32_t y = 0; y < target.height; y++)
            for (uint32_t x = 0; x < target.width; x++) {
                TEST_ASSERT_EQUAL_HEX32(y << 16 | x, image[y * target.width + x]);
                TEST_ASSERT_EQUAL_FLOAT(y * 1000 + x, depth[y * target.width + x]);
            }
        close_target();
    }
}

static void apply(const struct clear *clear)
{
    for (uint32_t tile = 0; tile < target.columns * target.rows; tile++)
        target_clear_tile(&target, tile, clear);
}

/* Clears of random rectangles, of colour, depth or both, against pixels set one by one. */
static void clears_set_their_pixels_and_no_others(void)
{
    uint32_t seed = 9;
    for (int s = 0; s < SIZES; s++) {
        open_target(sizes[s]);
        uint32_t pixels = target.width * target.height;
        uint32_t *color = calloc(pixels, sizeof *color);
        float *z = malloc(pixels * sizeof *z);
        TEST_ASSERT_TRUE(color && z);
        for (uint32_t i = 0; i < pixels; i++)
            z[i] = 1;
        for (int n = 0; n < 20; n++) {
            int32_t edge[4];
            for (int i = 0; i < 4; i++) {
                seed = seed * 1664525 + 1013904223;
                edge[i] = (int32_t)((seed >> 8) % ((i & 1 ? target.height : target.width) + 1));
            }
            struct clear clear = {.area = {edge[0], edge[1], edge[2], edge[3]},
                                  .color = seed,
                                  .depth = (float)n,
                                  .set_color = n % 3 != 0,
                                  .set_depth = n % 3 != 1};
            if (n % 5 == 4)
                clear.area = (struct rectangle){0, 0, (int32_t)target.width, (int32_t)target.height};
            apply(&clear);
            for (int32_t y = clear.area.y0; y < clear.area.y1; y++)
                for (int32_t x = clear.area.x0; x < clear.area.x1; x++) {
                    uint32_t i = (uint32_t)y * target.width + (uint32_t)x;
                    color[i] = clear.set_color ? clear.color : color[i];
                    z[i] = clear.set_depth ? clear.depth : z[i];
                }
            read_all();
            TEST_ASSERT_EQUAL_MEMORY(color, image, pixels * sizeof *color);
            TEST_ASSERT_EQUAL_MEMORY(z, depth, pixels * sizeof *z);
        }
        free(color);
        free(z);
        close_target();
    }
}

static void whole_clears_touch_no_pixel_until_somebody_needs_them(void)
{
    open_target((uint32_t[2]){128, 64});
    target_fill_color(&target, 0)[5] = 77;
    apply(&(struct clear){.area = {0, 0, 128, 64}, .color = 3, .set_color = true});
    TEST_ASSERT_EQUAL_UINT32(77, target.color[5]);
    TEST_ASSERT_EQUAL_UINT32(3, target_fill_color(&target, 0)[5]);
    TEST_ASSERT_EQUAL_UINT32(3, target.color[5]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_pixel_is_read_from_its_place);
    RUN_TEST(clears_set_their_pixels_and_no_others);
    RUN_TEST(whole_clears_touch_no_pixel_until_somebody_needs_them);
    return UNITY_END();
}
