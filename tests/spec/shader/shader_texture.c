/* The lookups of texture instructions (docs/shader-semantics.md). The emulator's binding executes them for
 * one quad of registers at a time. They are compared with a second implementation of samplers, and at the
 * edges with values that are computed here. */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/quad.h"
#include "tests/support/picture/texture_model.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
    const struct triptych_options options = {.engine = "emulate", .threads = 1};
    random_begin();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
}

void tearDown(void)
{
    close_canvas();
}

static struct quad quad;
static struct quad_result result;
static struct model_texture texture;

static void shade(const char *text)
{
    quad_shade(device, text, &quad, &result);
}

static double lane_value(int r, int c, int lane)
{
    return (double)quad.v[r][c][lane];
}

/* --- Lookups ------------------------------------------------------------------------------------------- */

enum load { LOAD, LOAD_PROJECTED, LOAD_BIASED, LOAD_LEVEL, LOAD_CHANGES, LOADS };

static const char *const instruction[LOADS] = {"texld r0, v0, s2", "texldp r0, v0, s2", "texldb r0, v0, s2",
                                               "texldl r0, v0, s2", "texldd r0, v0, s2, r1, r2"};
static const char *const kind[] = {"2d", "cube", "volume"};

static const char *load_text(enum load load)
{
    static char text[400];
    const char *dcl = texture.type == TRIPTYCH_TEXTURE_2D     ? kind[0]
                      : texture.type == TRIPTYCH_TEXTURE_CUBE ? kind[1]
                                                              : kind[2];
    snprintf(text, sizeof text,
             "ps_3_0\ndcl_%s s2\ndcl_texcoord0 v0\ndcl_texcoord1 v1\ndcl_texcoord2 v2\nmov r1, v1\nmov r2, "
             "v2\n%s\nmov oC0, r0\n",
             dcl, instruction[load]);
    return text;
}

/* Makes coordinates that change evenly from lane to lane. On cubes all of them are on one face, and the major
 * component does not change. */
static void make_coordinates(double across[3], double down[3])
{
    double start[3];
    int cube = texture.type == TRIPTYCH_TEXTURE_CUBE, major = (int)(random_word() % 3);
    double reach = cube ? 0.1875 : random_word() % 4 ? 0.25 : 2;
    for (int a = 0; a < 3; a++) {
        start[a] = cube ? dyadic(-0.25, 0.25) : dyadic(-2, 2);
        across[a] = dyadic(-reach, reach);
        down[a] = dyadic(-reach, reach);
        if (cube && a == major) {
            start[a] = random_word() % 2 ? 1 : -1;
            across[a] = down[a] = 0;
        }
    }
    for (int lane = 0; lane < QUAD_LANES; lane++)
        for (int a = 0; a < 3; a++)
            quad.v[0][a][lane] = (float)(start[a] + lane % 2 * across[a] + lane / 2 * down[a]);
}

/* Converts the changes of a cube's vector to changes of the coordinates on its face. */
static void turn_changes(int lane, double change[3])
{
    double v[3], moved[3], first[2], second[2];
    if (texture.type != TRIPTYCH_TEXTURE_CUBE)
        return;
    for (int a = 0; a < 3; a++) {
        v[a] = lane_value(0, a, lane);
        moved[a] = v[a] + change[a];
    }
    model_face(v, first);
    model_face(moved, second);
    change[0] = second[0] - first[0];
    change[1] = second[1] - first[1];
    change[2] = 0;
}

/* The values of v0.w, or of v1 and v2, and the level that follows. */
static int prepare(enum load load, const struct model_sampler *sampler, const double even[2][3], int lane)
{
    double change[2][3];
    memcpy(change, even, sizeof change);
    double amount = lane_value(0, 3, lane);
    for (int i = 0; i < 2; i++) {
        for (int a = 0; a < 3 && load == LOAD_CHANGES; a++)
            change[i][a] = lane_value(1 + i, a, lane);
        turn_changes(lane, change[i]);
    }
    if (load == LOAD_LEVEL)
        return (int)rint(256 * (amount + sampler->bias));
    return model_lambda(&texture, sampler, change[0], change[1], load == LOAD_BIASED ? amount : 0);
}

static void make_registers(enum load load, double even[2][3])
{
    memset(&quad, 0, sizeof quad);
    make_coordinates(even[0], even[1]);
    for (int lane = 0; lane < QUAD_LANES; lane++) {
        double amount = load == LOAD_BIASED ? dyadic(-3, 3) : dyadic(-2, 5);
        for (int i = 0; i < 2; i++)
            for (int a = 0; a < 3; a++)
                quad.v[1 + i][a][lane] = even[i][a] == 0 ? 0 : (float)dyadic(-0.25, 0.25);
        quad.v[0][3][lane] = (float)amount;
    }
    for (int lane = 0; lane < QUAD_LANES && load == LOAD_PROJECTED; lane++) {
        float divisor = random_word() % 2 ? 0.5f : 4;
        quad.v[0][3][lane] = divisor;
        for (int a = 0; a < 3; a++)
            quad.v[0][a][lane] *= divisor;
    }
}

static void check_load(enum load load, const struct model_sampler *sampler)
{
    double even[2][3];
    make_registers(load, even);
    shade(load_text(load));
    for (int lane = 0; lane < QUAD_LANES; lane++) {
        double divisor = load == LOAD_PROJECTED ? lane_value(0, 3, lane) : 1;
        double v[3];
        for (int a = 0; a < 3; a++) {
            v[a] = lane_value(0, a, lane) / divisor;
            quad.v[0][a][lane] = (float)v[a];
        }
        int lambda = prepare(load, sampler, (const double(*)[3])even, lane);
        float expected[4];
        char what[200];
        if (lambda == INT_MIN)
            continue;
        model_sample(&texture, sampler, v, lambda, expected);
        snprintf(what, sizeof what,
                 "%s, %s of %s, mag %d min %d mip %d first %d bias %g, at %g %g %g, lambda %d/256",
                 instruction[load],
                 kind[texture.type == TRIPTYCH_TEXTURE_2D     ? 0
                      : texture.type == TRIPTYCH_TEXTURE_CUBE ? 1
                                                              : 2],
                 texture.floats ? "floats" : "bytes", sampler->mag, sampler->min, sampler->mip,
                 sampler->first, sampler->bias, v[0], v[1], v[2], lambda);
        quad_expect(&result, lane, expected, what);
    }
}

static void check_filters(enum load load)
{
    for (int filters = 0; filters < 12; filters++)
        for (int i = 0; i < 3; i++) {
            const struct model_sampler sampler = {.mag = filters & 1,
                                                  .min = filters >> 1 & 1,
                                                  .mip = filters >> 2,
                                                  .first = filters >> 2 && i == 2,
                                                  .bias = i == 1 ? dyadic(-1, 1) : 0};
            model_set(device, 2, &sampler);
            check_load(load, &sampler);
        }
}

static void check_loads(enum triptych_texture_type type, int floats)
{
    model_make(&texture, device, 2, type, floats);
    for (enum load load = 0; load < LOADS; load++)
        check_filters(load);
}

static void test_lookups_in_planes(void)
{
    check_loads(TRIPTYCH_TEXTURE_2D, 0);
    check_loads(TRIPTYCH_TEXTURE_2D, 1);
}

static void test_lookups_in_cubes(void)
{
    check_loads(TRIPTYCH_TEXTURE_CUBE, 0);
    check_loads(TRIPTYCH_TEXTURE_CUBE, 1);
}

static void test_lookups_in_volumes(void)
{
    check_loads(TRIPTYCH_TEXTURE_VOLUME, 0);
    check_loads(TRIPTYCH_TEXTURE_VOLUME, 1);
}

/* --- Edges of lookups ---------------------------------------------------------------------------------- */

static const struct model_sampler nearest_levels = {.mip = MODEL_MIP_POINT};

/* Expects the texel of the 2D texture at v0 in lane 0. */
static void expect_level(const char *text, int lambda, const struct model_sampler *sampler, const char *what)
{
    const double v[3] = {lane_value(0, 0, 0), lane_value(0, 1, 0), 0};
    float expected[4];
    model_sample(&texture, sampler, v, lambda, expected);
    shade(text);
    quad_expect(&result, 0, expected, what);
}

static void make_plane(const struct model_sampler *sampler)
{
    memset(&quad, 0, sizeof quad);
    model_make(&texture, device, 2, TRIPTYCH_TEXTURE_2D, 1);
    model_set(device, 2, sampler);
    quad_set(&quad, 0, 0.3125f, 0.8125f, 0, 0);
}

static void test_unbound_samplers_are_opaque_black(void)
{
    static const float black[4] = {0, 0, 0, 1};
    static const char *const others[] = {
        "ps_1_1\ntex t2\nmov r0, t2\n", "ps_1_4\ntexld r0, t2\n",
        "ps_2_0\ndcl_volume s15\ndcl t0\ntexld r0, t0, s15\nmov oC0, r0\n",
        ("vs_3_0\ndcl_2d s3\ndcl_texcoord v0\ndcl_position o0\ndcl_texcoord o1\nmov o0, v0\n"
         "texldl o1, v0, s3\n")};
    memset(&quad, 0, sizeof quad);
    texture.type = TRIPTYCH_TEXTURE_CUBE;
    for (enum load load = 0; load < LOADS; load++) {
        shade(load_text(load));
        quad_expect_all(&result, black, instruction[load]);
    }
    for (unsigned i = 0; i < sizeof others / sizeof *others; i++) {
        shade(others[i]);
        quad_expect_all(&result, black, others[i]);
    }
}

/* The changes are 1/64 of the plane to the right, so that lambda is -3, or 2 planes, so that it is 4. */
static void test_biases_are_limited_by_the_model(void)
{
    static const struct {
        const char *text;
        float bias, change;
        int lambda;
    } cases[] = {
        {"ps_2_0\ndcl_2d s2\ndcl t0\ntexldb r0, t0, s2\nmov oC0, r0\n", 100, 0.015625f, 0},
        {"ps_2_0\ndcl_2d s2\ndcl t0\ntexldb r0, t0, s2\nmov oC0, r0\n", -100, 2, 256},
        {"ps_2_0\ndcl_2d s2\ndcl t0\ntexldb r0, t0, s2\nmov oC0, r0\n", NAN, 0.0625f, 512},
        {"ps_2_x\ndcl_2d s2\ndcl t0\ntexldb r0, t0, s2\nmov oC0, r0\n", 2, 0.0625f, 256},
        {"ps_2_x\ndcl_2d s2\ndcl t0\ntexldb r0, t0, s2\nmov oC0, r0\n", INFINITY, 0.0625f, 512},
        {"ps_3_0\ndcl_2d s2\ndcl_texcoord v0\ntexldb r0, v0, s2\nmov oC0, r0\n", 5, 0.015625f, 512},
        {"ps_3_0\ndcl_2d s2\ndcl_texcoord v0\ntexldb r0, v0, s2\nmov oC0, r0\n", 100, 0x1p-16f, 512},
        {"ps_3_0\ndcl_2d s2\ndcl_texcoord v0\ntexldb r0, v0, s2\nmov oC0, r0\n", -100, 8192, 0},
        {"ps_3_0\ndcl_2d s2\ndcl_texcoord v0\ntexldb r0, v0, s2\nmov oC0, r0\n", -INFINITY, 32768, 512},
    };
    make_plane(&nearest_levels);
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        quad_set_lanes(&quad, 0, 3, cases[i].bias);
        for (int lane = 0; lane < QUAD_LANES; lane++)
            quad.v[0][0][lane] = 0.3125f + (lane % 2 ? cases[i].change : 0);
        expect_level(cases[i].text, cases[i].lambda, &nearest_levels, cases[i].text);
    }
}

static void test_levels_are_clamped(void)
{
    static const struct {
        float level;
        int lambda;
    } cases[] = {{0, 0},      {-1, -256},        {-1e30f, -256},    {1, 256},
                 {1.5f, 384}, {1.4990234f, 384}, {2, 512},          {3, 768},
                 {7, 1792},   {1e30f, 1792},     {-0.0f, 0},        {0.25f, 64},
                 {NAN, 1792}, {INFINITY, 1792},  {-INFINITY, -256}, {FLT_MIN, 0}};
    static const struct model_sampler samplers[] = {{.mip = MODEL_MIP_POINT},
                                                    {.mip = MODEL_MIP_LINEAR, .mag = 1},
                                                    {.mip = MODEL_MIP_LINEAR, .min = 1},
                                                    {.min = 1},
                                                    {.mip = MODEL_MIP_LINEAR, .first = 1, .mag = 1},
                                                    {.mip = MODEL_MIP_POINT, .first = 2}};
    for (unsigned s = 0; s < sizeof samplers / sizeof *samplers; s++) {
        make_plane(&samplers[s]);
        for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
            char what[100];
            snprintf(what, sizeof what, "sampler %u, level %g", s, (double)cases[i].level);
            quad_set_lanes(&quad, 0, 3, cases[i].level);
            expect_level(load_text(LOAD_LEVEL), cases[i].lambda, &samplers[s], what);
        }
    }
}

/* A lookup with a given level has no changes, so it is filtered linearly instead of anisotropically. */
static void test_given_levels_are_not_anisotropic(void)
{
    const struct model_sampler sampler = {.min = 1, .mip = MODEL_MIP_LINEAR};
    make_plane(&sampler);
    set_sampler(2, TRIPTYCH_SAMPLER_MINFILTER, "anisotropic");
    OK(triptych_set_sampler_state(device, 2, TRIPTYCH_SAMPLER_MAXANISOTROPY, 8));
    for (int lane = 0; lane < QUAD_LANES; lane++)
        quad.v[0][1][lane] = 0.8125f + (lane / 2 ? 0.5f : 0);
    quad_set_lanes(&quad, 0, 3, 1.25f);
    expect_level(load_text(LOAD_LEVEL), 320, &sampler, "texldl, anisotropic");
}

/* Two taps at thirds of the way, each in the level of half the change. */
static void test_given_changes_can_be_anisotropic(void)
{
    const struct model_sampler sampler = {.min = 1, .mip = MODEL_MIP_LINEAR};
    float first[4], second[4], expected[4];
    make_plane(&sampler);
    set_sampler(2, TRIPTYCH_SAMPLER_MINFILTER, "anisotropic");
    OK(triptych_set_sampler_state(device, 2, TRIPTYCH_SAMPLER_MAXANISOTROPY, 8));
    quad_set(&quad, 1, 0.75f, 0, 0, 0);
    quad_set(&quad, 2, 0, 0.375f, 0, 0);
    int lambda = (int)rint(256 * log2(3));
    model_sample(&texture, &sampler, (const double[]){0.3125 - 0.125, 0.8125, 0}, lambda, first);
    model_sample(&texture, &sampler, (const double[]){0.3125 + 0.125, 0.8125, 0}, lambda, second);
    shade(load_text(LOAD_CHANGES));
    for (int c = 0; c < 4; c++) {
        expected[c] = (first[c] + second[c]) / 2;
        TEST_ASSERT_FLOAT_WITHIN(0.05f, expected[c], result.color[c][0]);
    }
}

/* Coordinates of NaN give the last level, which has one texel. */
static void test_coordinates_that_are_not_numbers(void)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX};
    make_plane(&nearest_levels);
    for (unsigned i = 0; i < sizeof odd / sizeof *odd; i++) {
        quad_set(&quad, 0, 0.25f, 0.25f, 0, 1);
        quad.v[0][0][0] = odd[i];
        shade(load_text(LOAD));
        quad_expect(&result, 0, texture.texel[MODEL_LEVELS - 1][0][0][0], "texld at no number");
    }
}

/* 0 times FLT_MAX is 0 in all lanes, which gives the first texel of the first level. */
static void test_projection_by_zero_multiplies_by_the_largest_number(void)
{
    make_plane(&nearest_levels);
    for (int sign = 0; sign < 2; sign++) {
        quad_set(&quad, 0, 0, 0, 0, sign ? -0.0f : 0.0f);
        shade(load_text(LOAD_PROJECTED));
        quad_expect_all(&result, texture.texel[0][0][0][0], "texldp by zero");
    }
    quad_set(&quad, 0, 0.25f, 0.5f, 0, -0.5f);
    shade(load_text(LOAD_PROJECTED));
    quad_expect_all(&result, texture.texel[0][0][0][4], "texldp by a negative number");
}

static void test_samplers_can_be_swizzled(void)
{
    const struct model_sampler sampler = {0};
    float texel[4];
    make_plane(&sampler);
    model_sample(&texture, &sampler, (const double[]){0.3125, 0.8125, 0}, 0, texel);
    shade("ps_3_0\ndcl_2d s2\ndcl_texcoord v0\ntexld r0, v0, s2.wzxx\nmov oC0, r0\n");
    quad_expect_all(&result, (const float[]){texel[3], texel[2], texel[0], texel[0]}, "swizzled");
}

/* A sampler of depth compares the third coordinate, after the division. */
static void test_depth_is_compared_with_the_third_coordinate(void)
{
    static const uint32_t depths[4] = {0x40000000, 0x80000000, 0xc0000000, 0xffffff00};
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_D24S8, 4, 1, 1, 1};
    static const float lit[4] = {1, 1, 1, 1}, shadowed[4] = {0, 0, 0, 0};
    triptych_texture *map;
    OK(triptych_texture_define(device, &description, &map));
    OK(triptych_texture_update(device, map, 0, 0, NULL, depths, sizeof depths, 0));
    OK(triptych_set_texture(device, 2, map));
    memset(&quad, 0, sizeof quad);
    texture.type = TRIPTYCH_TEXTURE_2D;
    for (int i = 0; i < 8; i++) {
        float u = (float)(i / 2) * 0.25f + 0.125f,
              reference = (float)(i / 2 + 1) * 0.25f + (i % 2 ? 0.01f : -0.01f);
        int shadow = i % 2 && i < 6;
        quad_set(&quad, 0, u, 0, reference, 0);
        shade(load_text(LOAD));
        quad_expect_all(&result, shadow ? shadowed : lit, "texld of depth");
        quad_set(&quad, 0, u * 4, 0, reference * 4, 4);
        shade(load_text(LOAD_PROJECTED));
        quad_expect_all(&result, shadow ? shadowed : lit, "texldp of depth");
    }
}

static void test_reads_can_depend_on_reads(void)
{
    const struct model_sampler sampler = {0};
    float first[4], second[4];
    make_plane(&sampler);
    model_sample(&texture, &sampler, (const double[]){0.3125, 0.8125, 0}, 0, first);
    model_sample(&texture, &sampler, (const double[]){(double)first[1], (double)first[0], 0}, 0, second);
    shade("ps_2_0\ndcl_2d s2\ndcl t0\ntexld r0, t0, s2\nmov r1.x, r0.y\nmov r1.y, r0.x\nmov r1.zw, r0\n"
          "texld r0, r1, s2\nmov oC0, r0\n");
    quad_expect_all(&result, second, "a dependent read");
}

static void check_vertices(enum triptych_texture_type type, int floats)
{
    static const char *const text[] = {"vs_3_0\ndcl_2d s1\ndcl_texcoord v0\ndcl_position o0\ndcl_texcoord "
                                       "o1\nmov o0, v0\ntexldl o1, v0, s1\n",
                                       "vs_3_0\ndcl_cube s1\ndcl_texcoord v0\ndcl_position o0\ndcl_texcoord "
                                       "o1\nmov o0, v0\ntexldl o1, v0, s1\n",
                                       "vs_3_0\ndcl_volume s1\ndcl_texcoord v0\ndcl_position "
                                       "o0\ndcl_texcoord o1\nmov o0, v0\ntexldl o1, v0, s1\n"};
    int which = type == TRIPTYCH_TEXTURE_2D ? 0 : type == TRIPTYCH_TEXTURE_CUBE ? 1 : 2;
    double even[2][3];
    model_make(&texture, device, TRIPTYCH_VERTEX_SAMPLER + 1, type, floats);
    for (int filters = 0; filters < 12; filters++) {
        const struct model_sampler sampler = {
            .mag = filters & 1, .min = filters >> 1 & 1, .mip = filters >> 2, .bias = 0.5};
        model_set(device, TRIPTYCH_VERTEX_SAMPLER + 1, &sampler);
        make_registers(LOAD_LEVEL, even);
        shade(text[which]);
        for (int lane = 0; lane < QUAD_LANES; lane++) {
            const double v[3] = {lane_value(0, 0, lane), lane_value(0, 1, lane), lane_value(0, 2, lane)};
            float expected[4];
            model_sample(&texture, &sampler, v, prepare(LOAD_LEVEL, &sampler, (const double(*)[3])even, lane),
                         expected);
            quad_expect(&result, lane, expected, text[which]);
        }
    }
}

static void test_vertices_have_samplers(void)
{
    for (int floats = 0; floats < 2; floats++) {
        check_vertices(TRIPTYCH_TEXTURE_2D, floats);
        check_vertices(TRIPTYCH_TEXTURE_CUBE, floats);
        check_vertices(TRIPTYCH_TEXTURE_VOLUME, floats);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lookups_in_planes);
    RUN_TEST(test_lookups_in_cubes);
    RUN_TEST(test_lookups_in_volumes);
    RUN_TEST(test_unbound_samplers_are_opaque_black);
    RUN_TEST(test_biases_are_limited_by_the_model);
    RUN_TEST(test_levels_are_clamped);
    RUN_TEST(test_given_levels_are_not_anisotropic);
    RUN_TEST(test_given_changes_can_be_anisotropic);
    RUN_TEST(test_coordinates_that_are_not_numbers);
    RUN_TEST(test_projection_by_zero_multiplies_by_the_largest_number);
    RUN_TEST(test_samplers_can_be_swizzled);
    RUN_TEST(test_depth_is_compared_with_the_third_coordinate);
    RUN_TEST(test_reads_can_depend_on_reads);
    RUN_TEST(test_vertices_have_samplers);
    return UNITY_END();
}
