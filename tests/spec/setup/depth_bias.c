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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_offset_is_added_to_every_depth);
    RUN_TEST(test_a_bias_decides_between_equal_depths);
    return UNITY_END();
}
