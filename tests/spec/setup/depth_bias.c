/* Depth bias, on every engine: m * slope + bias is added to the depth of every pixel of a triangle. m is the
 * greater of the triangle's depth gradients. Gradients here are exact in binary. */
#include "tests/support/picture/shape.h"

#include <math.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* Draws two triangles over the whole target. Depth changes by dx per pixel to the right and dy per pixel
 * down, and is z in the middle of the target. */
static void draw_slope(float z, float dx, float dy)
{
    struct shape_vertex v[4];
    for (int i = 0; i < 4; i++) {
        float x = (float)(i & 1) * SIZE, y = (float)(i >> 1) * SIZE;
        v[i] = (struct shape_vertex){x, y, z + (x - SIZE / 2) * dx + (y - SIZE / 2) * dy, ~0u, 0, 0};
    }
    draw_shape(TRIPTYCH_TRIANGLE_STRIP, v, 4);
}

static void check_offsets(void)
{
    static const float gradient[] = {0, 0x1p-9f, -0x1p-9f, 0x1p-8f, -0x1p-10f};
    static const float bias[] = {0, 0.125f, -0.125f, 0x1p-20f}, slope[] = {0, 1, -2, 16};
    set(TRIPTYCH_STATE_ZENABLE, "true");
    for (int i = 0; i < 25 * 16; i++) {
        float dx = gradient[i % 5], dy = gradient[i / 5 % 5], b = bias[i / 25 % 4], s = slope[i / 100];
        float m = fmaxf(fabsf(dx), fabsf(dy));
        set_real(TRIPTYCH_STATE_DEPTHBIAS, b);
        set_real(TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS, s);
        clear_shapes();
        draw_slope(0.5f, dx, dy);
        read_shapes();
        for (int p = 0; p < SIZE * SIZE; p += 7) {
            float x = (float)(p % SIZE) + 0.5f - SIZE / 2, y = (float)(p / SIZE) + 0.5f - SIZE / 2;
            float expected = 0.5f + x * dx + y * dy + (m * s + b);
            TEST_ASSERT_EQUAL_FLOAT(fminf(fmaxf(expected, 0), 1), shape_depth[p]);
        }
    }
}

static void test_the_offset_is_added_to_every_depth(void)
{
    on_every_engine(check_offsets);
}

/* The usual application: a decal on a surface, which a depth test of "less" would hide. */
static void check_decal(void)
{
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "less");
    for (int biased = 0; biased < 2; biased++) {
        static const float black[4];
        set_real(TRIPTYCH_STATE_DEPTHBIAS, 0);
        clear_shapes();
        draw_slope(0.5f, 0x1p-9f, 0);
        OK(triptych_clear(device, black, -1));
        set_real(TRIPTYCH_STATE_DEPTHBIAS, biased ? -0x1p-16f : 0);
        draw_slope(0.5f, 0x1p-9f, 0);
        read_shapes();
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, biased ? ~0u : 0, "a decal");
    }
}

static void test_a_bias_decides_between_equal_depths(void)
{
    on_every_engine(check_decal);
}

/* --- In the smallest differences of a format --- */

static void use_steps(enum triptych_depth_format format, float steps, float slope)
{
    struct triptych_target_description description = {.width = SIZE, .height = SIZE, .depth_format = format};
    OK(triptych_set_target_description(device, &description));
    OK(triptych_set_convention(device, TRIPTYCH_DEPTH_BIAS_UNIT, TRIPTYCH_DEPTH_BIAS_UNIT_SMALLEST));
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set_real(TRIPTYCH_STATE_DEPTHBIAS, steps);
    set_real(TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS, slope);
}

/* The depth of a level draw at z. */
static double stored(enum triptych_depth_format format, float z, float steps)
{
    use_steps(format, steps, 0);
    clear_shapes();
    draw_slope(z, 0, 0);
    read_shapes();
    return (double)shape_depth[SIZE * 5 + 5];
}

/* 0.75 is 49151.25 of 65535 and 12582911.25 of 16777215. */
static void check_integers(void)
{
    TEST_ASSERT_EQUAL_INT(49151, (int)rint(65535 * stored(TRIPTYCH_DEPTH_D16, 0.75f, 0)));
    TEST_ASSERT_EQUAL_INT(49152, (int)rint(65535 * stored(TRIPTYCH_DEPTH_D16, 0.75f, 1)));
    TEST_ASSERT_EQUAL_INT(49148, (int)rint(65535 * stored(TRIPTYCH_DEPTH_D16, 0.75f, -3)));
    TEST_ASSERT_EQUAL_INT(12582911, (int)rint(16777215 * stored(TRIPTYCH_DEPTH_D24X8, 0.75f, 0)));
    TEST_ASSERT_EQUAL_INT(12582912, (int)rint(16777215 * stored(TRIPTYCH_DEPTH_D24X8, 0.75f, 1)));
    TEST_ASSERT_EQUAL_INT(12582908, (int)rint(16777215 * stored(TRIPTYCH_DEPTH_D24S8, 0.75f, -3)));
    TEST_ASSERT_TRUE(0.75 + 0x3p-24 == stored(TRIPTYCH_DEPTH_D32, 0.75f, 3));
    TEST_ASSERT_TRUE(1 == stored(TRIPTYCH_DEPTH_D16, 0.75f, 70000));
    TEST_ASSERT_TRUE(0 == stored(TRIPTYCH_DEPTH_D24X8, 0.75f, -2e7f));
}

/* Steps are 2^-23 of the power of two below the depth in binary32. D24FS8 has steps of 2^-20 of it down to
 * 2^-14, and of 2^-34 below. */
static void check_floating_point(void)
{
    TEST_ASSERT_TRUE(0.75 + 0x3p-24 == stored(TRIPTYCH_DEPTH_D32F_LOCKABLE, 0.75f, 3));
    TEST_ASSERT_TRUE(0.25 + 0x3p-25 == stored(TRIPTYCH_DEPTH_D32F_LOCKABLE, 0.25f, 3));
    TEST_ASSERT_TRUE(0x1p-20 - 0x1p-43 == stored(TRIPTYCH_DEPTH_D32F_LOCKABLE, 0x1p-20f, -1));
    TEST_ASSERT_TRUE(0.75 + 0x3p-21 == stored(TRIPTYCH_DEPTH_D24FS8, 0.75f, 3));
    TEST_ASSERT_TRUE(0.25 - 0x5p-22 == stored(TRIPTYCH_DEPTH_D24FS8, 0.25f, -5));
    TEST_ASSERT_TRUE(0x1p-15 + 0x3p-34 == stored(TRIPTYCH_DEPTH_D24FS8, 0x1p-15f, 3));
    TEST_ASSERT_TRUE(1 == stored(TRIPTYCH_DEPTH_D32F_LOCKABLE, 0.75f, 1e9f));
}

/* The depths of the corners are 0.25 and 0.5; the second is the power of two for all pixels. The slope is
 * 2^-8. */
static void check_slope(void)
{
    for (int i = 0; i < 2; i++) {
        use_steps(TRIPTYCH_DEPTH_D32F_LOCKABLE, 4, (float)i);
        clear_shapes();
        draw_slope(0.375f, 0x1p-8f, 0);
        read_shapes();
        for (int x = 0; x < SIZE; x++)
            TEST_ASSERT_EQUAL_FLOAT(0.375f + ((float)x + 0.5f - SIZE / 2) * 0x1p-8f + 0x1p-22f +
                                        (float)i * 0x1p-8f,
                                    shape_depth[3 * SIZE + x]);
    }
}

static void test_a_bias_can_be_in_steps_of_the_depth_format(void)
{
    on_every_engine(check_integers);
    on_every_engine(check_floating_point);
    on_every_engine(check_slope);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_offset_is_added_to_every_depth);
    RUN_TEST(test_a_bias_decides_between_equal_depths);
    RUN_TEST(test_a_bias_can_be_in_steps_of_the_depth_format);
    return UNITY_END();
}
