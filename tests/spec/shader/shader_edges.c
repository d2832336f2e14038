/* Edge cases of the results of pixel shaders, in whole draws on every engine: texkill, masked writes, the
 * range of registers of ps_1_x, depths, positions, and NaN in targets of every format with NaN. The expected
 * values are computed by hand. */
#include "base/bits.h"
#include "tests/spec/shader/edges.h"

#include <float.h>
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

/* --- texkill ------------------------------------------------------------------------------------------- */

static void expect_killed(int killed, const char *text, int c, float value)
{
    char what[200];
    snprintf(what, sizeof what, "%s, component %d, %g", text, c, (double)value);
    read_numbers(0);
    part_expect(killed ? (const float[4]){0.25f, 0.25f, 0.25f, 0.25f} : (const float[4]){1, 1, 1, 1}, what);
}

/* Constants may have any bits. Interpolated coordinates must be numbers. */
static void check_kills(void)
{
    static const struct {
        const char *text;
        int components, interpolated;
    } cases[] = {{"ps_1_1\ndef c1, 1, 1, 1, 1\ntexkill t0\nmov r0, c1\n", 3, 1},
                 {"ps_1_2\ndef c1, 1, 1, 1, 1\ntexkill t0\nmov r0, c1\n", 3, 1},
                 {"ps_1_3\ndef c1, 1, 1, 1, 1\ntex t1\ntexkill t0\nmov r0, c1\n", 3, 1},
                 {"ps_1_4\ndef c1, 1, 1, 1, 1\ntexcrd r1.xyz, t0\nphase\ntexkill r1\nmov r0, c1\n", 3, 1},
                 {"ps_1_4\ndef c1, 1, 1, 1, 1\nmov r1, c1\nphase\ntexkill t0\nmov r0, c1\n", 3, 1},
                 {"ps_2_0\ndef c1, 1, 1, 1, 1\ndcl t0\ntexkill t0\nmov oC0, c1\n", 4, 1},
                 {"ps_2_0\ndef c1, 1, 1, 1, 1\nmov r3, c0\ntexkill r3\nmov oC0, c1\n", 4, 0},
                 {"ps_2_x\ndef c1, 1, 1, 1, 1\nmov r3, c0\ntexkill r3\nmov oC0, c1\n", 4, 0},
                 {"ps_3_0\ndef c1, 1, 1, 1, 1\nmov r3, c0\ntexkill r3\nmov oC0, c1\n", 4, 0}};
    static const float values[] = {-1,       -1e-20f, -0.0f, 0,         1e-20f,
                                   -FLT_MIN, -1e-39f, NAN,   -INFINITY, INFINITY};
    static const int kills[] = {1, 1, 0, 0, 0, 1, 0, 0, 1, 0};
    part_begin();
    for (unsigned i = 0; i < COUNT(cases); i++) {
        use_shaders(cases[i].text[3] == '3' ? third : first, cases[i].text);
        for (int c = 0; c < 4; c++)
            for (unsigned v = 0; v < (cases[i].interpolated ? 5 : COUNT(values)); v++) {
                float at[4] = {0.5f, 0.5f, 0.5f, 0.5f};
                at[c] = values[v];
                OK(triptych_clear(device, (const float[4]){0.25f, 0.25f, 0.25f, 0.25f}, 1));
                set_pixel_constant(0, at[0], at[1], at[2], at[3]);
                part_draw(at, at);
                expect_killed(c < cases[i].components && kills[v], cases[i].text, c, values[v]);
            }
    }
}

static void test_components_below_zero_kill(void)
{
    on_every_engine(check_kills);
}

/* --- Written components -------------------------------------------------------------------------------- */

static void bind_value(unsigned sampler, float x, float y, float z, float w)
{
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A32B32G32R32F, 1, 1, 1, 1};
    triptych_texture *single;
    OK(triptych_texture_define(device, &description, &single));
    OK(triptych_texture_update(device, single, 0, 0, NULL, (const float[4]){x, y, z, w}, 16, 0));
    OK(triptych_set_texture(device, sampler, single));
}

/* Lookups and differences with masks, swizzles and predicates. The texel is 1 2 3 4, and the register
 * contains 5 6 7 8 before. */
static void check_written(void)
{
    static const struct {
        const char *line;
        float expected[4];
    } cases[] = {
        {"texldl r0.xz, r1, s1", {1, 6, 3, 8}},
        {"texldl r0.w, r1, s1", {5, 6, 7, 4}},
        {"texldl r0, r1, s1.wzyx", {4, 3, 2, 1}},
        {"texldl r0.yz, r1, s1.w", {5, 4, 4, 8}},
        {"(p0) texldl r0, r1, s1", {1, 6, 7, 4}},
        {"(!p0) texldl r0, r1, s1", {5, 2, 3, 8}},
        {"(p0.y) texldl r0, r1, s1", {5, 6, 7, 8}},
        {"(p0) texldl r0.zw, r1, s1.yyxx", {5, 6, 7, 1}},
        {"(p0) texldd r0, r1, s1, r1, r1", {1, 6, 7, 4}},
        {"texld r0, r1, s1.x", {1, 1, 1, 1}},
        {"texldb r0, r1, s1.yzwx", {2, 3, 4, 1}},
        {"texldp r0, r1, s1.zzzy", {3, 3, 3, 2}},
        {"dsx r0.yw, r2", {5, 2, 7, 2}},
        {"dsx_sat r0, -r2", {0, 0, 0, 0}},
        {"dsx_sat r0.x, r2", {1, 6, 7, 8}},
        {"dsy r0.x, r2_abs", {0, 6, 7, 8}},
    };
    part_begin();
    bind_value(1, 1, 2, 3, 4);
    for (unsigned i = 0; i < COUNT(cases); i++) {
        char text[400];
        snprintf(
            text, sizeof text,
            "ps_3_0\ndef c0, 5, 6, 7, 8\ndef c1, 1, -1, 0, 2\ndef c2, 0, 0, 0, 0\ndcl_2d s1\ndcl vPos.xy\n"
            "mov r0, c0\nmov r1, c1\nadd r2, vPos.x, vPos.x\nsetp_gt p0, r1, c2\n%s\nmov oC0, r0\n",
            cases[i].line);
        use_shaders(third, text);
        draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
        read_numbers(0);
        part_expect(cases[i].expected, cases[i].line);
    }
}

static void test_results_are_masked_swizzled_and_predicated(void)
{
    on_every_engine(check_written);
}

/* 0 times NaN or infinity is NaN, which becomes -8 in registers of ps_1_x. With legacy multiplication it is
 * 0. */
static void check_legacy(void)
{
    static const float nans[4] = {NAN, NAN, NAN, 1};
    part_begin();
    bind_value(0, 0, -0.0f, 0, 0);
    for (int legacy = 0; legacy < 2; legacy++) {
        float expected = legacy ? 0 : -8;
        OK(triptych_set_convention(device, TRIPTYCH_MULTIPLY,
                                   legacy ? TRIPTYCH_MULTIPLY_LEGACY : TRIPTYCH_MULTIPLY_IEEE));
        use_shaders(first, "ps_1_2\ntex t0\ntexdp3 t1, t0\nmov r0, t1\n");
        part_draw(nans, nans);
        part_expect((const float[4]){expected, expected, expected, expected}, "texdp3");
        use_shaders(first,
                    "ps_1_2\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3 t3, t0\nmov r0, t3\n");
        part_draw(nans, nans);
        read_numbers(0);
        part_expect((const float[4]){expected, 0, 0, 1}, "texm3x3");
    }
}

static void test_legacy_multiplication_holds_for_rows_of_stages(void)
{
    on_every_engine(check_legacy);
}

/* --- Registers of ps_1_x ------------------------------------------------------------------------------- */

static void check_narrow(void)
{
    static const struct {
        const char *text;
        float texel[4], at[4], expected[4];
    } cases[] = {
        {"ps_1_1\ntex t1\nmov r0, t1\n", {100, -100, 7.5f, NAN}, {0}, {8, -8, 7.5f, -8}},
        {"ps_1_3\ntex t1\nmov r0, t1\n", {INFINITY, -INFINITY, 8, -8}, {0}, {8, -8, 8, -8}},
        {"ps_1_4\ntexld r1, t0\nmov r0, r1\n", {100, -100, 7.5f, NAN}, {0}, {8, -8, 7.5f, -8}},
        {"ps_1_4\ntexcrd r1.xyz, t0\nmov r0.xyz, r1\n+mov r0.w, c0.w\n",
         {0},
         {100, -100, 7.5f, 3},
         {8, -8, 7.5f, 0}},
        {"ps_1_4\ntexcrd r1.xy, t0_dw.xyw\nmov r0, c0\nmov r0.xy, r1\n",
         {0},
         {0.5f, -3, 1, 0},
         {8, -8, 0, 0}},
        {"ps_1_4\ntexcrd r1.xy, t0_dw.xyw\nmov r0, c0\nmov r0.xy, r1\n",
         {0},
         {0.5f, -3, 1, 2},
         {0.25f, -1.5f, 0, 0}},
        {"ps_1_1\ntexcoord t0\nmov r0, t0\n", {0}, {-0.5f, 0.25f, 7, 0.5f}, {0, 0.25f, 1, 1}},
        {"ps_1_3\ntexcoord t0\nmov r0, t0\n", {0}, {1e30f, -1e30f, -0.0f, -5}, {1, 0, 0, 1}},
        {"ps_1_2\ntex t1\ntexdp3 t2, t1\nmov r0, t2\n", {0}, {0}, {0, 0, 0, 0}},
        {"ps_1_1\ndef c1, 3, -3, 0.5, -1\nmov r0, c1\n", {0}, {0}, {1, -1, 0.5f, -1}},
        {"ps_1_4\ndef c1, 3, -3, 0.5, -1\nmov r0, c1\n", {0}, {0}, {1, -1, 0.5f, -1}},
    };
    part_begin();
    set_pixel_constant(0, 0, 0, 0, 0);
    for (unsigned i = 0; i < COUNT(cases); i++) {
        const float *texel = cases[i].texel;
        bind_value(1, texel[0], texel[1], texel[2], texel[3]);
        use_shaders(first, cases[i].text);
        part_draw(cases[i].at, cases[i].at);
        part_expect(cases[i].expected, cases[i].text);
    }
}

static void test_registers_of_ps_1_x_have_a_limited_range(void)
{
    on_every_engine(check_narrow);
}

/* --- Depth --------------------------------------------------------------------------------------------- */

/* Quotients by zeros of either sign are 1. Depths are clamped, and depth bias does not change them. */
static void check_depths(void)
{
    static const char *const texts[] = {
        "ps_1_4\ntexcrd r5.xyz, t1\nphase\ntexdepth r5\nmov r0, c0\n",
        "ps_1_3\ndef c1, 0, 0, 0, 0\ntexcoord t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmov r0, c1\n"};
    static const char vertex[] =
        "vs_1_1\ndcl_position v0\ndcl_texcoord0 v1\ndef c1, 1, 0, 0, 1\nmov oPos, v0\nmov oT0, c1\n"
        "mov oT1, v1\nmov oT2, v1.yxzw\n";
    static const float cases[][3] = {{0.25f, 0.5f, 0.5f}, {1, 4, 0.25f},  {1, 0, 1},    {-1, 0, 1},
                                     {0, 0, 1},           {-1, -0.0f, 1}, {3, 2, 1},    {-1, 2, 0},
                                     {-1, -4, 0.25f},     {0, 5, 0},      {5, 0.25f, 1}};
    struct triptych_target_description description = {.width = SIZE,
                                                      .height = SIZE,
                                                      .depth_format = TRIPTYCH_DEPTH_D32F_LOCKABLE,
                                                      .color_format = {TRIPTYCH_SURFACE_A8R8G8B8}};
    static float depth[SIZE * SIZE];
    OK(triptych_set_target_description(device, &description));
    part_place();
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    OK(triptych_set_state(device, TRIPTYCH_STATE_DEPTHBIAS, bits_of_float(0.125f)));
    for (unsigned t = 0; t < COUNT(texts); t++) {
        use_shaders(vertex, texts[t]);
        for (unsigned i = 0; i < COUNT(cases); i++) {
            const struct drawn_element quotient =
                drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, cases[i][0], cases[i][1], 0, 1);
            char what[100];
            draw_declared(TRIPTYCH_USAGE_POSITION, &quotient, 1);
            OK(triptych_read_depth(device, depth, sizeof depth));
            snprintf(what, sizeof what, "%.6s: %g by %g", texts[t], (double)cases[i][0], (double)cases[i][1]);
            TEST_ASSERT_EQUAL_FLOAT_MESSAGE(cases[i][2], depth[PART / 2 * SIZE + PART / 2], what);
        }
    }
}

static void test_depths_are_quotients(void)
{
    on_every_engine(check_depths);
}

/* --- Position and face --------------------------------------------------------------------------------- */

/* vPos consists of integers with any number of samples. Its z and w are x and y again. */
static void check_places(void)
{
    for (unsigned samples = 1; samples <= 4; samples *= 4) {
        struct triptych_target_description description = {.width = SIZE,
                                                          .height = SIZE,
                                                          .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F},
                                                          .samples = samples};
        OK(triptych_set_target_description(device, &description));
        part_place();
        use_shaders(third, "ps_3_0\ndcl vPos\nmov oC0, vPos\n");
        draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
        read_numbers(0);
        for (int y = 1; y < PART - 1; y++)
            for (int x = 1; x < PART - 1; x++)
                expect_numbers(x, y, (const float[4]){(float)x, (float)y, (float)x, (float)y}, "vPos");
    }
}

static void test_positions_are_integers(void)
{
    on_every_engine(check_places);
}

/* Lines have no back side, whatever their direction. */
static void check_lines(void)
{
    use_float_target();
    use_shaders(third, "ps_3_0\ndcl vFace\nmov oC0, vFace\n");
    for (int way = -1; way <= 1; way += 2) {
        int fronts = 0;
        OK(triptych_clear(device, (const float[4]){0}, 1));
        for (int i = 0; i < 4; i++)
            memcpy(drawn_position[i], (float[4]){i % 2 ? (float)way : (float)-way, 0.25f, 0.5f, 1},
                   sizeof drawn_position[i]);
        draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
        OK(triptych_draw(device, TRIPTYCH_LINE_LIST, 0, 1));
        read_numbers(0);
        for (int p = 0; p < SIZE * SIZE; p++) {
            TEST_ASSERT_TRUE(drawn[p][0] >= 0);
            fronts += drawn[p][0] == 1;
        }
        TEST_ASSERT_INT_WITHIN(1, SIZE, fronts);
    }
    drawn_begin();
}

static void test_lines_are_fronts(void)
{
    on_every_engine(check_lines);
}

/* --- NaN in targets ------------------------------------------------------------------------------------ */

static const struct {
    enum triptych_surface_format format;
    int channels; /* the others are 1 */
} formats[] = {{TRIPTYCH_SURFACE_R16F, 1},          {TRIPTYCH_SURFACE_G16R16F, 2},
               {TRIPTYCH_SURFACE_A16B16G16R16F, 4}, {TRIPTYCH_SURFACE_R32F, 1},
               {TRIPTYCH_SURFACE_G32R32F, 2},       {TRIPTYCH_SURFACE_A32B32G32R32F, 4}};

static void expect_one_nan(unsigned format, unsigned samples, const char *what)
{
    read_numbers(0);
    for (int p = 0; p < 2; p++)
        for (int c = 0; c < 4; c++) {
            char message[100];
            snprintf(message, sizeof message, "format %u, %u samples, %s, pixel %d, channel %d", format,
                     samples, what, p, c);
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(c < formats[format].channels ? 0x7fc00000 : 0x3f800000,
                                            bits_of_float(drawn[p * (SIZE + 1)][c]), message);
        }
}

static void check_nan_in(unsigned format, unsigned samples)
{
    static const uint32_t odd[4] = {0xffc12345, 0x7f812345, 0x7fffffff, 0xff800001};
    static const float zeros[4];
    float nans[4];
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {formats[format].format}, .samples = samples};
    memcpy(nans, odd, sizeof nans);
    OK(triptych_set_target_description(device, &description));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, nans, 1));
    use_shaders(third, "ps_3_0\nmov oC0, c0\n");
    OK(triptych_clear(device, zeros, 1));
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    expect_one_nan(format, samples, "stored");
    OK(triptych_clear(device, zeros, 1));
    use_shaders(third, "ps_3_0\nmov r0, c0\nsub r0, r0, c1\nmov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    expect_one_nan(format, samples, "computed");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_clear(device, nans, 1));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, "zero");
    set(TRIPTYCH_STATE_DESTBLEND, "one");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    expect_one_nan(format, samples, "blended");
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
}

static void check_nan(void)
{
    part_begin();
    for (unsigned format = 0; format < COUNT(formats); format++)
        for (unsigned samples = 1; samples <= 4; samples *= 4)
            check_nan_in(format, samples);
}

static void test_targets_store_every_nan_with_the_same_bits(void)
{
    on_every_engine(check_nan);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_components_below_zero_kill);
    RUN_TEST(test_results_are_masked_swizzled_and_predicated);
    RUN_TEST(test_legacy_multiplication_holds_for_rows_of_stages);
    RUN_TEST(test_registers_of_ps_1_x_have_a_limited_range);
    RUN_TEST(test_depths_are_quotients);
    RUN_TEST(test_positions_are_integers);
    RUN_TEST(test_lines_are_fronts);
    RUN_TEST(test_targets_store_every_nan_with_the_same_bits);
    return UNITY_END();
}
