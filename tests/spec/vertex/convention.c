/* The conventions, on every engine: the pictures of Direct3D 9's rasterization rules, whose pixel centres are
 * at integers, and both ranges of clip depth. */
#include "tests/support/picture/shape.h"

#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static unsigned draw_count(float x0, float y0, float x1, float y1, float x2, float y2)
{
    struct shape_vertex v[3] = {
        {x0, y0, 0.5f, ~0u, 0, 0}, {x1, y1, 0.5f, ~0u, 0, 0}, {x2, y2, 0.5f, ~0u, 0, 0}};
    unsigned count = 0;
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_LIST, v, 3);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++)
        count += image[p] != 0;
    return count;
}

static void draw_rectangle(float x0, float y0, float x1, float y1)
{
    struct shape_vertex v[4] = {{x0, y0, 0.5f, ~0u, 0, 0},
                                {x1, y0, 0.5f, ~0u, 0, 0},
                                {x0, y1, 0.5f, ~0u, 0, 0},
                                {x1, y1, 0.5f, ~0u, 0, 0}};
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_STRIP, v, 4);
    read_shapes();
}

static void expect_rectangle(int x0, int y0, int x1, int y1, const char *what)
{
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            expect_pixel(x, y, x >= x0 && x < x1 && y >= y0 && y < y1 ? ~0u : 0, what);
}

/* With centres at integers, the documentation's rectangle from (0.5, 0.5) to (2.5, 4.5) and the one from (1,
 * 1) to (3, 5) cover the same pixels. With centres at halves they do not. */
static void check_pixel_centers(void)
{
    OK(triptych_set_convention(device, TRIPTYCH_PIXEL_CENTER, TRIPTYCH_PIXEL_CENTER_INTEGER));
    TEST_ASSERT_EQUAL_UINT(15, draw_count(0, 0, 5, 0, 5, 5));
    TEST_ASSERT_EQUAL_UINT(10, draw_count(0, 5, 0, 0, 5, 5));
    draw_rectangle(0, 0, 5, 5);
    expect_rectangle(0, 0, 5, 5, "from 0 to 5");
    draw_rectangle(0.5f, 0.5f, 2.5f, 4.5f);
    expect_rectangle(1, 1, 3, 5, "from a half");
    draw_rectangle(1, 1, 3, 5);
    expect_rectangle(1, 1, 3, 5, "from 1");
    draw_rectangle(0, 0, SIZE, SIZE);
    expect_rectangle(0, 0, SIZE, SIZE, "all of the target");
    OK(triptych_set_convention(device, TRIPTYCH_PIXEL_CENTER, TRIPTYCH_PIXEL_CENTER_HALF));
    draw_rectangle(0.5f, 0.5f, 2.5f, 4.5f);
    expect_rectangle(0, 0, 2, 4, "from a half, centres at halves");
    TEST_ASSERT_EQUAL_UINT(15, draw_count(0.5f, 0.5f, 5.5f, 0.5f, 5.5f, 5.5f));
}

static void test_pixel_centers_follow_the_convention(void)
{
    on_every_engine(check_pixel_centers);
}

/* Texture coordinates are interpolated to pixel centres. With centres at integers, a texture of the target's
 * size that is drawn from 0 to SIZE is sampled at the corners of texels. If it is drawn half a pixel further
 * up and left, it is sampled at their centres. */
static void check_texels(void)
{
    struct shape_vertex v[4] = {{-0.5f, -0.5f, 0, ~0u, 0, 0},
                                {SIZE - 0.5f, -0.5f, 0, ~0u, 1, 0},
                                {-0.5f, SIZE - 0.5f, 0, ~0u, 0, 1},
                                {SIZE - 0.5f, SIZE - 0.5f, 0, ~0u, 1, 1}};
    bind_random_texture(SIZE, SIZE);
    set_sampler(0, TRIPTYCH_SAMPLER_MAGFILTER, "linear");
    set_sampler(0, TRIPTYCH_SAMPLER_MINFILTER, "linear");
    OK(triptych_set_convention(device, TRIPTYCH_PIXEL_CENTER, TRIPTYCH_PIXEL_CENTER_INTEGER));
    clear_shapes();
    draw_shape(TRIPTYCH_TRIANGLE_STRIP, v, 4);
    read_shapes();
    TEST_ASSERT_EQUAL_HEX32_ARRAY(texel, image, SIZE * SIZE);
}

static void test_half_a_pixel_maps_texels_to_pixels(void)
{
    on_every_engine(check_texels);
}

/* A viewport at (8, 16) covers the same pixels with both conventions. */
static void check_viewport(void)
{
    for (unsigned centre = 0; centre < 2; centre++) {
        const struct triptych_viewport viewport = {8, 16, 24, 32, 0, 1};
        OK(triptych_set_convention(device, TRIPTYCH_PIXEL_CENTER, centre));
        OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, SIZE, SIZE, 0, 1}));
        clear_shapes();
        OK(triptych_set_viewport(device, &viewport));
        draw_square(0, ~0u, NULL, 0, 0, 1, 1);
        read_shapes();
        expect_rectangle(8, 16, 32, 48, "a viewport");
    }
}

static void test_viewports_keep_their_pixels(void)
{
    on_every_engine(check_viewport);
}

static void expect_depth(float z, float expected)
{
    clear_shapes();
    draw_square(z, ~0u, NULL, 0, 0, 1, 1);
    read_shapes();
    for (int p = 0; p < SIZE * SIZE; p++)
        TEST_ASSERT_EQUAL_FLOAT(expected, shape_depth[p]);
}

static void check_depth_ranges(void)
{
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    OK(triptych_set_convention(device, TRIPTYCH_DEPTH_RANGE, TRIPTYCH_DEPTH_RANGE_MINUS));
    expect_depth(-1, 0);
    expect_depth(-0.5f, 0.25f);
    expect_depth(0, 0.5f);
    expect_depth(1, 1);
    expect_depth(-1.0625f, 1); /* clipped: what the clear left */
    expect_depth(1.0625f, 1);
    OK(triptych_set_convention(device, TRIPTYCH_DEPTH_RANGE, TRIPTYCH_DEPTH_RANGE_ZERO));
    expect_depth(-0.5f, 1);
    expect_depth(0.25f, 0.25f);
}

static void test_both_ranges_of_clip_depth_become_depths_from_0_to_1(void)
{
    on_every_engine(check_depth_ranges);
}

static void check_errors(void)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_set_convention(device, TRIPTYCH_CONVENTION_COUNT, 0));
    TEST_ASSERT_EQUAL_STRING("convention 10: expected pixel center (0), depth range (1), multiply (2), "
                             "window origin (3), point clip (4), depth bias unit (5), provoking vertex (6), "
                             "cube address (7), magnify limit (8) or sprite origin (9)",
                             triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_convention(device, TRIPTYCH_DEPTH_RANGE, 2));
    TEST_ASSERT_EQUAL_STRING("convention depth range: value 2, expected zero (0) or minus (1)",
                             triptych_error(device));
}

static void test_other_values_are_refused(void)
{
    on_every_engine(check_errors);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_pixel_centers_follow_the_convention);
    RUN_TEST(test_half_a_pixel_maps_texels_to_pixels);
    RUN_TEST(test_viewports_keep_their_pixels);
    RUN_TEST(test_both_ranges_of_clip_depth_become_depths_from_0_to_1);
    RUN_TEST(test_other_values_are_refused);
    return UNITY_END();
}
