/* Features that only pixels of the models of OpenGL have, in whole draws on every engine: the pixel's place
 * with depth and 1/w, the place within a point, discarded pixels, results that are written several times,
 * early returns, gradients where pixels of a quad are on different paths, and ten varyings. */
#include "tests/support/picture/drawn.h"

#include <stdio.h>
#include <string.h>

void setUp(void)
{
    drawn_begin();
}

void tearDown(void)
{
    close_canvas();
}

#define THROUGH "vs_gl\ndcl_position v0\ndcl_position o0\nmov o0, v0\n"

static void draw_through(const char *pixel)
{
    use_float_target();
    use_shaders(THROUGH, pixel);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
}

/* --- The place ------------------------------------------------------------------------------------------ */

/* w is 2 everywhere: the place and the depth are the same as with 1. */
static void check_place(void)
{
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 4; c++)
            drawn_position[i][c] *= 2;
    draw_through("ps_gl\ndcl vPos\nmov oC0, vPos\n");
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            expect_numbers(x, y, (const float[4]){(float)x + 0.5f, (float)y + 0.5f, 0.5f, 0.5f}, "vPos");
    draw_through("ps_gl\ndcl vPos\nmov oC0, vPos.w\n");
    EXPECT_CENTRE("vPos.w", 0.5f, 0.5f, 0.5f, 0.5f);
    draw_through("ps_gl\ndcl vPos\nmov oC0, vPos.yxyx\n");
    expect_numbers(3, 5, (const float[4]){5.5f, 3.5f, 5.5f, 3.5f}, "vPos.yx");
    drawn_begin();
}

static void test_the_place_is_the_centre_with_depth_and_1_over_w(void)
{
    on_every_engine(check_place);
}

/* A point of 8 pixels at the centre of the target. */
static void check_point(void)
{
    memcpy(drawn_position[0], (const float[4]){0, 0, 0.25f, 1}, sizeof drawn_position[0]);
    use_float_target();
    use_shaders("vs_gl\ndef c0, 8, 0, 0, 0\ndcl_position v0\ndcl_position o0\ndcl_psize o1.x\nmov o0, v0\n"
                "mov o1.x, c0.x\n",
                "ps_gl\ndcl vPoint\nmov oC0, vPoint\n");
    draw_points(NULL, 0);
    read_numbers(0);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            expect_numbers(SIZE / 2 - 4 + x, SIZE / 2 - 4 + y,
                           (const float[4]){((float)x + 0.5f) / 8, ((float)y + 0.5f) / 8, 0, 1}, "vPoint");
    drawn_begin();
}

static void test_points_have_coordinates_from_their_upper_left_corner(void)
{
    on_every_engine(check_point);
}

/* --- Results -------------------------------------------------------------------------------------------- */

/* The colour before a draw is that of use_float_target: 0. */
static void check_results(void)
{
    draw_through("ps_gl\ndef c0, 1, 2, 3, 4\ndef c1, 20, 40, 41, 5\ndcl vPos\nmov oC0, c0\n"
                 "if_lt vPos.x, c1.x\nkill\nendif\nkill_gt vPos.y, c1.y\nif_gt vPos.x, c1.z\n"
                 "mov oC0.yw, c1.w\nret\nendif\nmov oC0.x, c1.w\n");
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            const float left[4] = {5, 2, 3, 4}, right[4] = {1, 5, 3, 5}, none[4] = {0, 0, 0, 0};
            int killed = (float)x + 0.5f < 20 || (float)y + 0.5f > 40;
            expect_numbers(x, y, killed ? none : (float)x + 0.5f > 41 ? right : left, "results");
        }
}

static void test_pixels_are_discarded_and_return_by_themselves(void)
{
    on_every_engine(check_results);
}

/* In the quad of the columns 8 and 9, only 8 executes. */
static void check_gradient(void)
{
    draw_through("ps_gl\ndef c0, 9, -1, 0, 0\ndcl vPos\nmov oC0, c0.y\nif_lt vPos.x, c0.x\n"
                 "mul r0, vPos.x, vPos.x\ndsx oC0, r0\nendif\n");
    for (int x = 0; x < SIZE; x++) {
        float left = (float)(x & ~1) + 0.5f, right = left + 1;
        float expected = x > 8 ? -1 : right * right - left * left;
        expect_numbers(x, 7, (const float[4]){expected, expected, expected, expected}, "dsx");
    }
}

static void test_gradients_count_pixels_on_other_paths_with_the_values_of_this_path(void)
{
    on_every_engine(check_gradient);
}

/* --- Varyings ------------------------------------------------------------------------------------------- */

static void add_lines(char *text, size_t bytes, const char *format)
{
    for (unsigned i = 0; i < 10; i++) {
        size_t used = strlen(text);
        snprintf(text + used, bytes - used, format, i, i + 1, i, i);
    }
}

/* Varying i is i + (1, 10, 100, 1000), in output i + 1. */
static void check_varyings(void)
{
    char vertex[2048] = "vs_gl\ndef c0, 1, 10, 100, 1000\ndef c1, 1, 0, 0, 0\ndcl_position v0\n"
                        "dcl_position o0\n";
    char pixel[2048] = "ps_gl\n";
    add_lines(vertex, sizeof vertex, "dcl_texcoord%1$u o%2$u\n");
    strcat(vertex, "mov o0, v0\nmov r0, c0\nmov r1.x, c1.y\nwhile\nmova a0.x, r1.x\nmov o1[a0.x], r0\n"
                   "add r0, r0, c1.x\nadd r1.x, r1.x, c1.x\nbreak_gt r1.x, c0.y\nendwhile\n");
    add_lines(pixel, sizeof pixel, "dcl_texcoord%1$u v%1$u\n");
    strcat(pixel, "mov r0, v0\n");
    add_lines(pixel, sizeof pixel, "add r0, r0, v%1$u\n");
    strcat(pixel, "mov oC0, r0\n");
    use_float_target();
    use_shaders(vertex, pixel);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("sum", 56, 155, 1145, 11045);
}

static void test_ten_vectors_vary(void)
{
    on_every_engine(check_varyings);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_place_is_the_centre_with_depth_and_1_over_w);
    RUN_TEST(test_points_have_coordinates_from_their_upper_left_corner);
    RUN_TEST(test_pixels_are_discarded_and_return_by_themselves);
    RUN_TEST(test_gradients_count_pixels_on_other_paths_with_the_values_of_this_path);
    RUN_TEST(test_ten_vectors_vary);
    return UNITY_END();
}
