/* Properties that only pixel shaders have, in whole draws on every engine: position and face, several
 * outputs, depth, inputs that a loop's counter addresses, and the conversion of stored numbers. */
#include "tests/support/picture/drawn.h"

#include <math.h>
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

#define THROUGH "vs_3_0\ndcl_position v0\ndcl_position o0\nmov o0, v0\n"

static void draw_through(const char *pixel)
{
    use_shaders(THROUGH, pixel);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
}

/* --- Position and face --------------------------------------------------------------------------------- */

static void check_place(void)
{
    use_float_target();
    draw_through("ps_3_0\ndef c0, 0.5, 1, 7, 8\ndcl vPos.xy\nmov r0, c0\nmov r0.x, vPos.y\n"
                 "mad r0.y, vPos.x, c0.x, c0.y\nmov oC0, r0\n");
    read_numbers(0);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            expect_numbers(x, y, (const float[4]){(float)y, (float)x * 0.5f + 1, 7, 8}, "vPos");
}

static void test_the_position_is_in_whole_pixels_from_the_upper_left(void)
{
    on_every_engine(check_place);
}

static void check_face(void)
{
    static const char text[] = "ps_3_0\ndef c0, 2, 3, 0, 0\ndcl vFace\nmov r0, vFace\nmov r1, c0\n"
                               "cmp r0.yzw, vFace, r1.x, r1.y\nmov oC0, r0\n";
    use_float_target();
    draw_through(text);
    read_numbers(0);
    EXPECT_CENTRE("clockwise", 1, 2, 2, 2);
    for (int i = 0; i < 4; i++)
        drawn_position[i][0] = -drawn_position[i][0];
    draw_through(text);
    read_numbers(0);
    EXPECT_CENTRE("counterclockwise", -1, 3, 3, 3);
    drawn_begin();
}

static void test_the_face_is_1_or_minus_1(void)
{
    on_every_engine(check_face);
}

/* --- Outputs ------------------------------------------------------------------------------------------- */

static void use_four_targets(void)
{
    struct triptych_target_description description = {.width = SIZE, .height = SIZE};
    for (int t = 0; t < 4; t++)
        description.color_format[t] = TRIPTYCH_SURFACE_A32B32G32R32F;
    OK(triptych_set_target_description(device, &description));
}

static void check_outputs(void)
{
    static const char *const texts[] = {
        "ps_3_0\ndef c0, 1, 2, 3, 4\ndef c1, 10, 20, 30, 40\nmov oC0, c0\nmov oC1.xz, c1\nmov oC1.yw, "
        "c0\nmov oC2, -c0\n"
        "add oC3, c1, c1\n",
        "ps_2_0\ndef c0, 1, 2, 3, 4\ndef c1, 10, 20, 30, 40\nmov r0, c0\nmov r1, c1\nmov r1.yw, r0\nmov r2, "
        "-c0\n"
        "add r3, c1, c1\nmov oC3, r3\nmov oC1, r1\nmov oC2, r2\nmov oC0, r0\n"};
    for (int i = 0; i < 2; i++) {
        use_four_targets();
        use_shaders(i ? "vs_2_0\ndcl_position v0\nmov oPos, v0\n" : THROUGH, texts[i]);
        draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
        read_numbers(0);
        EXPECT_CENTRE("oC0", 1, 2, 3, 4);
        read_numbers(1);
        EXPECT_CENTRE("oC1", 10, 2, 30, 4);
        read_numbers(2);
        EXPECT_CENTRE("oC2", -1, -2, -3, -4);
        read_numbers(3);
        EXPECT_CENTRE("oC3", 20, 40, 60, 80);
    }
}

static void test_each_output_has_its_target(void)
{
    on_every_engine(check_outputs);
}

/* --- Depth --------------------------------------------------------------------------------------------- */

static float depth_for(const char *text, float value)
{
    static float depth[SIZE * SIZE];
    static const float black[4];
    const float constant[4] = {value, 1, 2, 3};
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "less");
    OK(triptych_clear(device, black, 0.75f));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, constant, 1));
    use_shaders(text[3] == '2' ? "vs_2_0\ndcl_position v0\nmov oPos, v0\n" : THROUGH, text);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    OK(triptych_read_depth(device, depth, sizeof depth));
    return depth[SIZE / 2 * SIZE + SIZE / 2];
}

static void check_depth(void)
{
    static const char *const texts[] = {"ps_2_0\nmov r0, c0\nmov oC0, r0\nmov oDepth, r0.x\n",
                                        "ps_3_0\nmov oC0, c0\nmov oDepth, c0.x\n"};
    /* Beyond the stored depth, 0.75, nothing changes. */
    static const float cases[][2] = {
        {0.25f, 0.25f}, {0, 0},     {-0.0f, 0}, {-1, 0},           {-INFINITY, 0},   {0.74f, 0.74f},
        {0.76f, 0.75f}, {1, 0.75f}, {5, 0.75f}, {INFINITY, 0.75f}, {1e-30f, 1e-30f}, {NAN, 0}};
    for (int t = 0; t < 2; t++)
        for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
            struct triptych_target_description description = {
                .width = SIZE,
                .height = SIZE,
                .depth_format = TRIPTYCH_DEPTH_D32F_LOCKABLE,
                .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
            OK(triptych_set_target_description(device, &description));
            TEST_ASSERT_EQUAL_FLOAT(cases[i][1], depth_for(texts[t], cases[i][0]));
        }
}

static void test_depth_of_the_shader_is_clamped_tested_and_stored(void)
{
    on_every_engine(check_depth);
}

/* --- Inputs by number ---------------------------------------------------------------------------------- */

static void check_indexed(void)
{
    struct drawn_element elements[3];
    for (unsigned i = 0; i < 3; i++)
        elements[i] = drawn_constant(TRIPTYCH_USAGE_TEXCOORD, i, 1 + (float)i, 10 + (float)i, 100, 0.5f);
    const int32_t loops[2][4] = {{3, 2, 1, 0}, {2, 60, 1, 0}};
    use_float_target();
    OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_PIXEL, 0, loops[0], 2));
    use_shaders(
        "vs_3_0\ndcl_position v0\ndcl_texcoord v1\ndcl_texcoord1 v2\ndcl_texcoord2 v3\ndcl_position o0\n"
        "dcl_texcoord o1\ndcl_texcoord1 o2\ndcl_texcoord2 o3\nmov o0, v0\nmov o1, v1\nmov o2, v2\nmov o3, "
        "v3\n",
        "ps_3_0\ndef c0, 10, 0, 0, 0\ndcl_texcoord v2\ndcl_texcoord1 v3\ndcl_texcoord2 v4\nmov r0, c0.y\n"
        "loop aL, i0\nmad r0, r0, c0.x, v[aL].xyzx\nendloop\nloop aL, i1\nadd r0, r0, v[aL]\nendloop\n"
        "mov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, elements, 3);
    read_numbers(0);
    EXPECT_CENTRE("v[aL]", 123, 1122, 11100, 123);
}

static void test_the_counter_addresses_inputs(void)
{
    on_every_engine(check_indexed);
}

/* --- Stored numbers ------------------------------------------------------------------------------------ */

static uint32_t stored_bits(int c)
{
    uint32_t bits;
    memcpy(&bits, &drawn[SIZE / 2 * SIZE + SIZE / 2][c], sizeof bits);
    return bits;
}

static void check_stored(void)
{
    static const uint32_t given[2][4] = {{0xffc12345, 0x7f812345, 0x7f800000, 0xff800000},
                                         {0x80000000, 0x00000000, 0x7f7fffff, 0x00400001}};
    use_float_target();
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, (const float *)(const void *)given, 2));
    draw_through("ps_3_0\nmov oC0, c0\n");
    read_numbers(0);
    TEST_ASSERT_EQUAL_HEX32(0x7fc00000, stored_bits(0));
    TEST_ASSERT_EQUAL_HEX32(0x7fc00000, stored_bits(1));
    TEST_ASSERT_EQUAL_HEX32(0x7f800000, stored_bits(2));
    TEST_ASSERT_EQUAL_HEX32(0xff800000, stored_bits(3));
    draw_through("ps_3_0\nmov oC0, c1\n");
    read_numbers(0);
    for (int c = 0; c < 4; c++)
        TEST_ASSERT_EQUAL_HEX32(given[1][c], stored_bits(c));
    draw_through("ps_3_0\nmov r0, c0\nmov r1, c1\nadd r2.x, r0.z, r0.w\nmul r2.y, r0.z, r1.y\nmad r2.z, "
                 "r0.w, r1.x, r0.x\n"
                 "frc r2.w, r0.z\nmov oC0, r2\n");
    read_numbers(0);
    for (int c = 0; c < 4; c++)
        TEST_ASSERT_EQUAL_HEX32(0x7fc00000, stored_bits(c));
}

static void test_every_nan_has_the_same_bits_and_other_bits_are_unchanged(void)
{
    on_every_engine(check_stored);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_position_is_in_whole_pixels_from_the_upper_left);
    RUN_TEST(test_the_face_is_1_or_minus_1);
    RUN_TEST(test_each_output_has_its_target);
    RUN_TEST(test_depth_of_the_shader_is_clamped_tested_and_stored);
    RUN_TEST(test_the_counter_addresses_inputs);
    RUN_TEST(test_every_nan_has_the_same_bits_and_other_bits_are_unchanged);
    return UNITY_END();
}
