/* Edge cases of textures in pixel shaders, in whole draws on every engine: levels and biases at their limits,
 * divisors of zero, and samplers without a texture. The expected values are computed by hand. */
#include "base/bits.h"
#include "tests/spec/shader/edges.h"
#include "tests/support/picture/texture_model.h"

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

/* --- Levels -------------------------------------------------------------------------------------------- */

/* Binds a texture of 8 x 8 texels. Texels of level n have n + 1 in all channels. */
static void bind_levels(unsigned sampler)
{
    static float texels[64][4];
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A32B32G32R32F, 8, 8, 1, 4};
    triptych_texture *levels;
    OK(triptych_texture_define(device, &description, &levels));
    for (unsigned level = 0; level < 4; level++) {
        for (int i = 0; i < 256; i++)
            texels[i / 4][i % 4] = (float)level + 1;
        OK(triptych_texture_update(device, levels, 0, level, NULL, texels, sizeof *texels * (8u >> level),
                                   0));
    }
    OK(triptych_set_texture(device, sampler, levels));
    set_sampler(sampler, TRIPTYCH_SAMPLER_MAGFILTER, "point");
    set_sampler(sampler, TRIPTYCH_SAMPLER_MINFILTER, "point");
    set_sampler(sampler, TRIPTYCH_SAMPLER_MIPFILTER, "point");
}

static void expect_level(float level, const char *what)
{
    part_expect((const float[4]){level + 1, level + 1, level + 1, level + 1}, what);
}

/* u changes by a power of two from pixel to pixel. Without a bias, the level is the exponent plus 3. */
static void check_biases(void)
{
    static const char *const texts[] = {"ps_2_0\ndcl_2d s2\ndcl t0\nmov r0, t0\nmov r0.w, c0.x\n"
                                        "texldb r0, r0, s2\nmov oC0, r0\n",
                                        "ps_2_x\ndcl_2d s2\ndcl t0\nmov r0, t0\nmov r0.w, c0.x\n"
                                        "texldb r0, r0, s2\nmov oC0, r0\n",
                                        "ps_3_0\ndcl_2d s2\ndcl_texcoord v0\nmov r0, v0\nmov r0.w, c0.x\n"
                                        "texldb r0, r0, s2\nmov oC0, r0\n"};
    static const struct {
        float bias, change, level[2]; /* of models 2, and of 3 */
    } cases[] = {{100, 0x1p-6f, {0, 3}},     {-100, 2, {1, 0}},      {3, 0x1p-4f, {2, 2}},
                 {4, 0x1p-4f, {2, 3}},       {-3, 1, {0, 0}},        {-4, 2, {1, 0}},
                 {15, 0x1p-16f, {0, 2}},     {16, 0x1p-16f, {0, 2}}, {INFINITY, 0x1p-16f, {0, 2}},
                 {-16, 0x1p15f, {3, 2}},     {-17, 0x1p15f, {3, 2}}, {-INFINITY, 0x1p15f, {3, 2}},
                 {NAN, 0x1p-16f, {0, 2}},    {NAN, 0x1p-4f, {2, 3}}, {-0.0f, 0.25f, {1, 1}},
                 {INFINITY, 0x1p-5f, {1, 3}}};
    part_begin();
    bind_levels(2);
    for (unsigned t = 0; t < COUNT(texts); t++) {
        use_shaders(t == 2 ? third : first, texts[t]);
        for (unsigned i = 0; i < COUNT(cases); i++) {
            struct drawn_element ramp = drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, 0, 0.5f, 0, 1);
            char what[100];
            for (int corner = 1; corner < 4; corner += 2)
                ramp.value[corner][0] = PART * cases[i].change;
            snprintf(what, sizeof what, "%.6s, bias %g of changes by %g", texts[t], (double)cases[i].bias,
                     (double)cases[i].change);
            set_pixel_constant(0, cases[i].bias, 0, 0, 0);
            draw_declared(TRIPTYCH_USAGE_POSITION, &ramp, 1);
            read_numbers(0);
            expect_level(cases[i].level[t == 2], what);
        }
    }
}

static void test_biases_end_at_the_limits_of_the_model(void)
{
    on_every_engine(check_biases);
}

/* The level of texldl, with maxmiplevel and mipmaplodbias. */
static const struct {
    float given;
    unsigned first;
    float bias, level;
} levels[] = {{0, 0, 0, 0},         {-1, 0, 0, 0},       {0.25f, 0, 0, 0},     {0.75f, 0, 0, 1},
              {1, 0, 0, 1},         {2.25f, 0, 0, 2},    {3, 0, 0, 3},         {7, 0, 0, 3},
              {1e30f, 0, 0, 3},     {INFINITY, 0, 0, 3}, {-INFINITY, 0, 0, 0}, {NAN, 0, 0, 3},
              {0, 2, 0, 2},         {-5, 2, 0, 2},       {1, 2, 0, 2},         {3, 2, 0, 3},
              {-INFINITY, 1, 0, 1}, {0, 9, 0, 3},        {1, 0, 1, 2},         {2, 0, -1, 1},
              {-1, 0, 3, 2},        {1, 1, -3, 1},       {18, 0, -16, 2}};

static void check_levels_at(unsigned sampler, enum triptych_shader_stage stage, const char *vertex,
                            const char *pixel)
{
    bind_levels(sampler);
    use_shaders(vertex, pixel);
    for (unsigned i = 0; i < COUNT(levels); i++) {
        char what[100];
        snprintf(what, sizeof what, "sampler %u, level %g, first %u, bias %g", sampler,
                 (double)levels[i].given, levels[i].first, (double)levels[i].bias);
        OK(triptych_set_sampler_state(device, sampler, TRIPTYCH_SAMPLER_MAXMIPLEVEL, levels[i].first));
        OK(triptych_set_sampler_state(device, sampler, TRIPTYCH_SAMPLER_MIPMAPLODBIAS,
                                      bits_of_float(levels[i].bias)));
        OK(triptych_set_shader_floats(device, stage, 0, (const float[4]){0.5f, 0.25f, 0, levels[i].given},
                                      1));
        draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
        read_numbers(0);
        expect_level(levels[i].level, what);
    }
}

static void check_levels(void)
{
    part_begin();
    check_levels_at(5, TRIPTYCH_SHADER_PIXEL, third,
                    "ps_3_0\ndcl_2d s5\nmov r0, c0\ntexldl r0, r0, s5\nmov oC0, r0\n");
    check_levels_at(TRIPTYCH_VERTEX_SAMPLER + 3, TRIPTYCH_SHADER_VERTEX,
                    "vs_3_0\ndcl_position v0\ndcl_2d s3\ndcl_position o0\ndcl_texcoord o1\nmov o0, v0\n"
                    "mov r0, c0\ntexldl o1, r0, s3\n",
                    "ps_3_0\ndcl_texcoord v0\nmov oC0, v0\n");
}

static void test_given_levels_are_limited_by_the_sampler(void)
{
    on_every_engine(check_levels);
}

/* texldd with the differences of the quad gives the bits of texld. The coordinates are not linear, so that
 * quads differ. */
static void check_changes(void)
{
    static const char *const texts[] = {
        "ps_3_0\ndcl_2d s2\ndcl_texcoord v0.xy\nmul r0.x, v0.x, v0.x\nmul r0.y, v0.x, v0.y\nmov r0.zw, v0.x\n"
        "dsx r1, r0\ndsy r2, r0\ntexld r3, r0, s2\ntexldd r4, r0, s2, r1, r2\nmov oC0, r3\nmov oC1, r4\n",
        "ps_2_x\ndcl_volume s2\ndcl t0.xy\nmul r0.x, t0.x, t0.x\nmul r0.y, t0.x, t0.y\nmov r0.zw, t0.x\n"
        "dsx r1, r0\ndsy r2, r0\ntexld r3, r0, s2\ntexldd r4, r0, s2, r1, r2\nmov oC0, r3\nmov oC1, r4\n"};
    static const char *const minification[] = {"point", "linear", "anisotropic"};
    static struct model_texture texture;
    static const struct model_sampler sampler = {.mag = 1, .min = 1, .mip = MODEL_MIP_LINEAR};
    static float implicit[SIZE * SIZE][4];
    struct triptych_target_description description = {
        .width = SIZE,
        .height = SIZE,
        .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F, TRIPTYCH_SURFACE_A32B32G32R32F}};
    OK(triptych_set_target_description(device, &description));
    for (int t = 0; t < 2; t++)
        for (unsigned filter = 0; filter < COUNT(minification); filter++) {
            struct drawn_element ramp = drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, -1, -0.5f, 0, 1);
            int several = 0;
            ramp.value[1][0] = ramp.value[3][0] = 3;
            ramp.value[2][1] = ramp.value[3][1] = 7;
            model_make(&texture, device, 2, t ? TRIPTYCH_TEXTURE_VOLUME : TRIPTYCH_TEXTURE_2D, 1);
            model_set(device, 2, &sampler);
            set_sampler(2, TRIPTYCH_SAMPLER_MINFILTER, minification[filter]);
            OK(triptych_set_sampler_state(device, 2, TRIPTYCH_SAMPLER_MAXANISOTROPY, 4));
            use_shaders(t ? first : third, texts[t]);
            draw_declared(TRIPTYCH_USAGE_POSITION, &ramp, 1);
            read_numbers(0);
            memcpy(implicit, drawn, sizeof drawn);
            read_numbers(1);
            for (int p = 0; p < SIZE * SIZE; p++) {
                expect_numbers(p % SIZE, p / SIZE, implicit[p], minification[filter]);
                several += memcmp(implicit[p], implicit[0], sizeof *implicit) != 0;
            }
            TEST_ASSERT_GREATER_THAN_INT(SIZE, several);
        }
}

static void test_given_changes_equal_those_of_the_quad(void)
{
    part_place();
    drawn_begin();
    on_every_engine(check_changes);
}

/* --- Divisors ------------------------------------------------------------------------------------------ */

/* If the divisor is zero, of either sign, coordinates are multiplied by FLT_MAX. 0 stays 0, and the smallest
 * number becomes the edge of the texture on the side of its sign. */
static void check_divisors(void)
{
    static const struct {
        float u, v, divisor;
        int x, y; /* the texel, of 8 x 8 */
    } cases[] = {{0, 0, 0, 0, 0},
                 {0, 0, -0.0f, 0, 0},
                 {0x1p-125f, -0x1p-125f, 0, 7, 0},
                 {0x1p-125f, -0x1p-125f, -0.0f, 7, 0},
                 {-0x1p-125f, 0x1p-125f, 0, 0, 7},
                 {-0.25f, -3, 0, 0, 0},
                 {0.125f, 0.25f, 0.5f, 2, 4},
                 {1, 2.5f, 4, 2, 5},
                 {-0.25f, -0.5f, -0.5f, 4, 7},
                 {0.25f, 0.5f, -0.5f, 0, 0},
                 {0.5f, 0.5f, INFINITY, 0, 0}};
    static const char *const texts[] = {
        "ps_2_0\ndcl_2d s3\nmov r0, c0\ntexldp r0, r0, s3\nmov oC0, r0\n",
        "ps_3_0\ndcl_2d s3\nmov r0, c0\ntexldp r0, r0, s3\nmov oC0, r0\n",
        "ps_1_4\ntexld r3, t0_dw.xyw\nmov r0, r3\n",
        "ps_1_4\ntexcrd r1.xyz, t0.xyw\nphase\ntexld r3, r1_dz\nmov r0, r3\n"};
    static struct model_texture texture;
    static const struct model_sampler nearest = {0};
    part_begin();
    model_make(&texture, device, 3, TRIPTYCH_TEXTURE_2D, 1);
    model_set(device, 3, &nearest);
    set_sampler(3, TRIPTYCH_SAMPLER_ADDRESSU, "clamp");
    set_sampler(3, TRIPTYCH_SAMPLER_ADDRESSV, "clamp");
    for (unsigned t = 0; t < COUNT(texts); t++) {
        use_shaders(t == 1 ? third : first, texts[t]);
        for (unsigned i = 0; i < COUNT(cases); i++) {
            const float at[4] = {cases[i].u, cases[i].v, 0, cases[i].divisor};
            char what[100];
            if (t >= 2 && isinf(cases[i].divisor))
                continue; /* interpolation makes it NaN */
            snprintf(what, sizeof what, "%.30s: %g, %g by %g", texts[t], (double)at[0], (double)at[1],
                     (double)at[3]);
            set_pixel_constant(0, at[0], at[1], at[2], at[3]);
            part_draw(at, at);
            part_expect(texture.texel[0][0][cases[i].y][cases[i].x], what);
        }
    }
}

static void test_divisors_of_zero_multiply_by_the_largest_number(void)
{
    on_every_engine(check_divisors);
}

/* --- Samplers without a texture ------------------------------------------------------------------------ */

static void check_unbound(void)
{
    static const char *const texts[] = {
        "ps_1_1\ntex t1\nmov r0, t1\n",
        "ps_1_1\ntex t0\ntexbem t1, t0\nmov r0, t1\n",
        "ps_1_1\ntex t0\ntexreg2ar t1, t0\nmov r0, t1\n",
        "ps_1_4\ntexld r2, t0\nmov r0, r2\n",
        "ps_2_0\ndcl_2d s4\ndcl t0\ntexld r0, t0, s4\nmov oC0, r0\n",
        "ps_2_0\ndcl_cube s4\ndcl t0\ntexldp r0, t0, s4\nmov oC0, r0\n",
        "ps_2_0\ndcl_volume s15\ndcl t0\ntexldb r0, t0, s15\nmov oC0, r0\n",
        "ps_3_0\ndcl_2d s4\ndcl_texcoord v0\ntexldl r0, v0, s4\nmov oC0, r0\n",
        "ps_3_0\ndcl_2d s4\ndcl_texcoord v0\nmov r1, v0\ntexldd r0, v0, s4, r1, r1\nmov oC0, r0\n",
    };
    part_begin();
    for (unsigned t = 0; t < COUNT(texts); t++) {
        use_shaders(texts[t][3] == '3' ? third : first, texts[t]);
        part_draw((const float[4]){0.5f, 0.25f, 2, 3}, (const float[4]){0.5f, 0.25f, 2, 3});
        part_expect((const float[4]){0, 0, 0, 1}, texts[t]);
    }
}

static void test_samplers_without_a_texture_return_opaque_black(void)
{
    on_every_engine(check_unbound);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_biases_end_at_the_limits_of_the_model);
    RUN_TEST(test_given_levels_are_limited_by_the_sampler);
    RUN_TEST(test_given_changes_equal_those_of_the_quad);
    RUN_TEST(test_divisors_of_zero_multiply_by_the_largest_number);
    RUN_TEST(test_samplers_without_a_texture_return_opaque_black);
    return UNITY_END();
}
