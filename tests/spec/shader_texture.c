/* What texture instructions compute (docs/shader-semantics.md), one quad of registers at a time under the emulator's binding: lookups
 * against a sampler written a second time, the rest against values worked out here. */
#include "draw/key.h"
#include "tests/support/canvas.h"
#include "tests/support/quad.h"
#include "tests/support/texture_model.h"

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

/* A multiple of 1/1024. */
static double dyadic(double low, double high)
{
    return floor(random_between(low, high) * 1024) / 1024;
}

static void expect_color(int lane, const float expected[4], const char *what)
{
    for (int c = 0; c < 4; c++) {
        char message[600];
        float got = result.color[c][lane];
        if (got == expected[c] || (isnan(got) && isnan(expected[c])))
            continue;
        snprintf(message, sizeof message, "%s: lane %d, component %c: expected %.9g, got %.9g", what, lane,
                 "xyzw"[c], (double)expected[c], (double)got);
        TEST_FAIL_MESSAGE(message);
    }
}

static void expect_all(const float expected[4], const char *what)
{
    for (int lane = 0; lane < QUAD_LANES; lane++)
        expect_color(lane, expected, what);
}

/* --- Lookups ----------------------------------------------------------------------------------------------
 */

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

/* Coordinates that change evenly from lane to lane; on cubes all on one face, whose major component stays. */
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

/* The changes of a place on a cube's face, from those of the vector. */
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

/* What is in v0.w, or in v1 and v2, and what the level is then. */
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
        expect_color(lane, expected, what);
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

/* --- Edges of lookups -------------------------------------------------------------------------------------
 */

enum { FAR_AWAY = 100000 };

static const struct model_sampler nearest_levels = {.mip = MODEL_MIP_POINT};

static void set_lanes(int r, int c, float value)
{
    for (int lane = 0; lane < QUAD_LANES; lane++)
        quad.v[r][c][lane] = value;
}

static void set_register(int r, float x, float y, float z, float w)
{
    const float v[4] = {x, y, z, w};
    for (int c = 0; c < 4; c++)
        set_lanes(r, c, v[c]);
}

/* The plane at v0's place in lane 0. */
static void expect_level(const char *text, int lambda, const struct model_sampler *sampler, const char *what)
{
    const double v[3] = {lane_value(0, 0, 0), lane_value(0, 1, 0), 0};
    float expected[4];
    model_sample(&texture, sampler, v, lambda, expected);
    shade(text);
    expect_color(0, expected, what);
}

static void make_plane(const struct model_sampler *sampler)
{
    memset(&quad, 0, sizeof quad);
    model_make(&texture, device, 2, TRIPTYCH_TEXTURE_2D, 1);
    model_set(device, 2, sampler);
    set_register(0, 0.3125f, 0.8125f, 0, 0);
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
        expect_all(black, instruction[load]);
    }
    for (unsigned i = 0; i < sizeof others / sizeof *others; i++) {
        shade(others[i]);
        expect_all(black, others[i]);
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
        set_lanes(0, 3, cases[i].bias);
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
            set_lanes(0, 3, cases[i].level);
            expect_level(load_text(LOAD_LEVEL), cases[i].lambda, &samplers[s], what);
        }
    }
}

/* Without changes nothing is anisotropic: it is filtered linearly, once. */
static void test_given_levels_are_not_anisotropic(void)
{
    const struct model_sampler sampler = {.min = 1, .mip = MODEL_MIP_LINEAR};
    make_plane(&sampler);
    set_sampler(2, TRIPTYCH_SAMPLER_minfilter, "anisotropic");
    OK(triptych_set_sampler_state(device, 2, TRIPTYCH_SAMPLER_maxanisotropy, 8));
    for (int lane = 0; lane < QUAD_LANES; lane++)
        quad.v[0][1][lane] = 0.8125f + (lane / 2 ? 0.5f : 0);
    set_lanes(0, 3, 1.25f);
    expect_level(load_text(LOAD_LEVEL), 320, &sampler, "texldl, anisotropic");
}

/* Two taps at thirds of the way, each in the level of half the change. */
static void test_given_changes_can_be_anisotropic(void)
{
    const struct model_sampler sampler = {.min = 1, .mip = MODEL_MIP_LINEAR};
    float first[4], second[4], expected[4];
    make_plane(&sampler);
    set_sampler(2, TRIPTYCH_SAMPLER_minfilter, "anisotropic");
    OK(triptych_set_sampler_state(device, 2, TRIPTYCH_SAMPLER_maxanisotropy, 8));
    set_register(1, 0.75f, 0, 0, 0);
    set_register(2, 0, 0.375f, 0, 0);
    int lambda = (int)rint(256 * log2(3));
    model_sample(&texture, &sampler, (const double[]){0.3125 - 0.125, 0.8125, 0}, lambda, first);
    model_sample(&texture, &sampler, (const double[]){0.3125 + 0.125, 0.8125, 0}, lambda, second);
    shade(load_text(LOAD_CHANGES));
    for (int c = 0; c < 4; c++) {
        expected[c] = (first[c] + second[c]) / 2;
        TEST_ASSERT_FLOAT_WITHIN(0.05f, expected[c], result.color[c][0]);
    }
}

/* NaN is far away: the last level, a single texel. */
static void test_coordinates_that_are_no_numbers(void)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX};
    make_plane(&nearest_levels);
    for (unsigned i = 0; i < sizeof odd / sizeof *odd; i++) {
        set_register(0, 0.25f, 0.25f, 0, 1);
        quad.v[0][0][0] = odd[i];
        shade(load_text(LOAD));
        expect_color(0, texture.texel[MODEL_LEVELS - 1][0][0][0], "texld at no number");
    }
}

/* 0 times FLT_MAX is 0, everywhere alike: the first texel of the first level. */
static void test_projection_by_zero_multiplies_by_the_largest_number(void)
{
    make_plane(&nearest_levels);
    for (int sign = 0; sign < 2; sign++) {
        set_register(0, 0, 0, 0, sign ? -0.0f : 0.0f);
        shade(load_text(LOAD_PROJECTED));
        expect_all(texture.texel[0][0][0][0], "texldp by zero");
    }
    set_register(0, 0.25f, 0.5f, 0, -0.5f);
    shade(load_text(LOAD_PROJECTED));
    expect_all(texture.texel[0][0][0][4], "texldp by a negative number");
}

static void test_samplers_can_be_swizzled(void)
{
    const struct model_sampler sampler = {0};
    float texel[4];
    make_plane(&sampler);
    model_sample(&texture, &sampler, (const double[]){0.3125, 0.8125, 0}, 0, texel);
    shade("ps_3_0\ndcl_2d s2\ndcl_texcoord v0\ntexld r0, v0, s2.wzxx\nmov oC0, r0\n");
    expect_all((const float[]){texel[3], texel[2], texel[0], texel[0]}, "swizzled");
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
        set_register(0, u, 0, reference, 0);
        shade(load_text(LOAD));
        expect_all(shadow ? shadowed : lit, "texld of depth");
        set_register(0, u * 4, 0, reference * 4, 4);
        shade(load_text(LOAD_PROJECTED));
        expect_all(shadow ? shadowed : lit, "texldp of depth");
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
    expect_all(second, "a dependent read");
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
            expect_color(lane, expected, text[which]);
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

/* --- Neighbours and discarded pixels ----------------------------------------------------------------------
 */

static void test_differences_are_those_of_the_quad(void)
{
    memset(&quad, 0, sizeof quad);
    for (int lane = 0; lane < QUAD_LANES; lane++)
        for (int c = 0; c < 4; c++)
            quad.v[0][c][lane] = (float)dyadic(-8, 8);
    for (int down = 0; down < 2; down++) {
        shade(down ? "ps_3_0\ndcl_texcoord v0\ndsy r0, v0\nmov oC0, r0\n"
                   : "ps_2_x\ndcl t0\ndsx r0, t0\nmov oC0, r0\n");
        for (int lane = 0; lane < QUAD_LANES; lane++) {
            int from = down ? lane & 1 : lane & 2, to = from + (down ? 2 : 1);
            float expected[4];
            for (int c = 0; c < 4; c++)
                expected[c] = quad.v[0][c][to] - quad.v[0][c][from];
            expect_color(lane, expected, down ? "dsy" : "dsx");
        }
    }
}

static void test_differences_take_modifiers_and_masks(void)
{
    memset(&quad, 0, sizeof quad);
    for (int lane = 0; lane < QUAD_LANES; lane++)
        quad.v[0][1][lane] = (float)(lane * lane);
    shade("ps_3_0\ndcl_texcoord v0\nmov r0, v0.x\ndsx_sat r0.yw, -v0.y\ndsy r0.z, v0.y\nmov oC0, r0\n");
    static const float expected[2][4] = {{0, 0, 4, 0}, {0, 0, 8, 0}};
    expect_color(0, expected[0], "dsx, dsy");
    expect_color(1, expected[1], "dsx, dsy");
}

static void test_negative_components_kill(void)
{
    static const struct {
        const char *text;
        int components, limited; /* of ps_1_x's registers, which hold no NaN */
    } cases[] = {{"ps_1_1\ntexkill t0\nmov r0, c0\n", 3, 0},
                 {"ps_1_3\ntex t1\ntexkill t0\nmov r0, t1\n", 3, 0},
                 {"ps_1_4\ntexcrd r0.xyz, t0\nphase\ntexkill r0\nmov r0, c0\n", 3, 1},
                 {"ps_1_4\ntexkill t0\nmov r0, c0\n", 3, 0},
                 {"ps_2_0\ndcl t0\ntexkill t0\nmov r0, t0\nmov oC0, r0\n", 4, 0},
                 {"ps_2_0\ndcl t0\nmov r3, t0\ntexkill r3\nmov oC0, r3\n", 4, 0},
                 {"ps_3_0\ndcl_texcoord v0\nmov r3, v0\ntexkill r3\nmov oC0, r3\n", 4, 0}};
    static const float values[] = {-1, -FLT_MIN, -1e-39f, -0.0f, 0, 1, NAN, -INFINITY};
    static const int kills[] = {1, 1, 0, 0, 0, 0, 0, 1};
    memset(&quad, 0, sizeof quad);
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int c = 0; c < 4; c++)
            for (unsigned v = 0; v < sizeof values / sizeof *values; v++) {
                char what[200];
                int lane = (int)(v % QUAD_LANES);
                if (cases[i].limited && isnan(values[v]))
                    continue;
                set_register(0, 0.5f, 0.5f, 0.5f, 0.5f);
                quad.v[0][c][lane] = values[v];
                shade(cases[i].text);
                snprintf(what, sizeof what, "%s, component %d, %g", cases[i].text, c, (double)values[v]);
                for (int l = 0; l < QUAD_LANES; l++)
                    TEST_ASSERT_EQUAL_INT_MESSAGE(l == lane && c < cases[i].components && kills[v],
                                                  result.killed[l] != 0, what);
            }
}

static void test_only_lanes_that_execute_are_killed(void)
{
    memset(&quad, 0, sizeof quad);
    set_register(0, -1, -1, -1, -1);
    quad.v[1][0][1] = quad.v[1][0][2] = 1;
    shade("ps_3_0\ndcl_texcoord0 v0\ndcl_texcoord1 v1\nmov r0, v0\nmov r1, v1\nif_gt r1.x, -r1.x\ntexkill "
          "r0\nendif\n"
          "mov oC0, r0\n");
    for (int lane = 0; lane < QUAD_LANES; lane++)
        TEST_ASSERT_EQUAL_INT(lane == 1 || lane == 2, result.killed[lane] != 0);
}

/* --- ps_1_1 to ps_1_3 -------------------------------------------------------------------------------------
 */

static const struct model_sampler plain = {0};

/* A texture of one texel. */
static void bind_value(unsigned stage, float x, float y, float z, float w)
{
    const float value[4] = {x, y, z, w};
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A32B32G32R32F, 1, 1, 1, 1};
    triptych_texture *single;
    OK(triptych_texture_define(device, &description, &single));
    OK(triptych_texture_update(device, single, 0, 0, NULL, value, sizeof value, 0));
    OK(triptych_set_texture(device, stage, single));
}

/* The texture of the stage at a place, limited as ps_1_x's results are. */
static void expect_texel(const char *text, double u, double v, double w)
{
    float expected[4];
    model_sample(&texture, &plain, (const double[]){u, v, w}, 0, expected);
    shade(text);
    expect_all(expected, text);
}

static void make_stage(unsigned stage, enum triptych_texture_type type)
{
    memset(&quad, 0, sizeof quad);
    model_make(&texture, device, stage, type, 1);
    model_set(device, stage, &plain);
}

static void test_coordinates_as_colors(void)
{
    static const char *const texts[] = {"ps_1_1\ntexcoord t1\nmov r0, t1\n",
                                        "ps_1_3\ntexcoord t1\nmov r0, t1\n"};
    memset(&quad, 0, sizeof quad);
    for (int i = 0; i < 2; i++) {
        set_register(1, -0.5f, 0.25f, 7, 0.5f);
        shade(texts[i]);
        expect_all((const float[]){0, 0.25f, 1, 1}, texts[i]);
        set_register(1, NAN, INFINITY, -INFINITY, -1);
        shade(texts[i]);
        expect_all((const float[]){0, 1, 0, 1}, texts[i]);
    }
}

static void test_stages_divide_their_coordinates_where_they_are_projected(void)
{
    static const char text[] = "ps_1_2\ntex t2\nmov r0, t2\n";
    make_stage(2, TRIPTYCH_TEXTURE_2D);
    set_register(2, 0.75f, 0.5f, 2, 4);
    expect_texel(text, 0.75, 0.5, 0);
    quad.projected[2] = PROJECTED_THIRD;
    expect_texel(text, 0.375, 0.25, 0);
    quad.projected[2] = PROJECTED_FOURTH;
    expect_texel(text, 0.1875, 0.125, 0);
    set_register(2, 0, 0, 0, 0);
    expect_texel(text, 0, 0, 0);
}

static void set_matrix(unsigned stage, float m00, float m01, float m10, float m11, float scale, float offset)
{
    static const enum triptych_stage_state state[] = {
        TRIPTYCH_STAGE_bumpenvmat00, TRIPTYCH_STAGE_bumpenvmat01,  TRIPTYCH_STAGE_bumpenvmat10,
        TRIPTYCH_STAGE_bumpenvmat11, TRIPTYCH_STAGE_bumpenvlscale, TRIPTYCH_STAGE_bumpenvloffset};
    const float value[] = {m00, m01, m10, m11, scale, offset};
    for (int i = 0; i < 6; i++) {
        uint32_t bits;
        memcpy(&bits, &value[i], sizeof bits);
        OK(triptych_set_stage_state(device, stage, state[i], bits));
    }
}

/* u + 0.5 * 0.25 - 0.25 * 0.5 = u, v + 1 * 0.25 + 0.125 * 0.5. The matrix is of the stage that is displaced. */
static void test_bumps_displace_by_the_matrix_of_the_stage(void)
{
    make_stage(1, TRIPTYCH_TEXTURE_2D);
    bind_value(0, 0.25f, 0.5f, 0.75f, 0);
    set_matrix(0, 9, 9, 9, 9, 9, 9);
    set_matrix(1, 0.5f, 1, -0.5f, 0.125f, 0.5f, 0.25f);
    set_register(1, 0.375f, 0.5f, 0, 1);
    double u = 0.375 + 0.5 * 0.25 - 0.5 * 0.5, v = 0.5 + 1 * 0.25 + 0.125 * 0.5;
    expect_texel("ps_1_1\ntex t0\ntexbem t1, t0\nmov r0, t1\n", u, v, 0);
    float expected[4];
    model_sample(&texture, &plain, (const double[]){u, v, 0}, 0, expected);
    for (int c = 0; c < 4; c++)
        expected[c] *= 0.75f * 0.5f + 0.25f;
    shade("ps_1_1\ntex t0\ntexbeml t1, t0\nmov r0, t1\n");
    expect_all(expected, "texbeml");
    quad.projected[1] = PROJECTED_FOURTH;
    set_register(1, 0.75f, 1, 0, 2);
    expect_texel("ps_1_1\ntex t0\ntexbem t1, t0\nmov r0, t1\n", u, v, 0);
}

static void test_luminance_is_limited(void)
{
    float expected[4];
    make_stage(1, TRIPTYCH_TEXTURE_2D);
    set_matrix(1, 0, 0, 0, 0, 2, 0.5f);
    model_sample(&texture, &plain, (const double[]){0, 0, 0}, 0, expected);
    bind_value(0, 0, 0, 3, 0);
    shade("ps_1_1\ntex t0\ntexbeml t1, t0\nmov r0, t1\n");
    expect_all(expected, "luminance above 1");
    bind_value(0, 0, 0, -3, 0);
    shade("ps_1_1\ntex t0\ntexbeml t1, t0\nmov r0, t1\n");
    expect_all((const float[4]){0}, "luminance below 0");
}

static void test_colors_as_coordinates(void)
{
    make_stage(1, TRIPTYCH_TEXTURE_2D);
    bind_value(0, 0.375f, 0.625f, 0.875f, 0.125f);
    expect_texel("ps_1_1\ntex t0\ntexreg2ar t1, t0\nmov r0, t1\n", 0.125, 0.375, 0);
    expect_texel("ps_1_1\ntex t0\ntexreg2gb t1, t0\nmov r0, t1\n", 0.625, 0.875, 0);
    expect_texel("ps_1_2\ntex t0\ntexreg2rgb t1, t0\nmov r0, t1\n", 0.375, 0.625, 0);
    make_stage(1, TRIPTYCH_TEXTURE_VOLUME);
    expect_texel("ps_1_2\ntex t0\ntexreg2rgb t1, t0\nmov r0, t1\n", 0.375, 0.625, 0.875);
}

/* The rows are coordinates of t1, t2 and t3, the vector is 1, 0.5, -2: products 0.5, 0.75 and 1. */
static void make_rows(void)
{
    bind_value(0, 1, 0.5f, -2, 0.5f);
    set_register(1, 0.25f, 0.5f, 0, -0.5f);
    set_register(2, 0, 0.5f, -0.25f, 1);
    set_register(3, 2, 2, 1, 0.25f);
}

static void test_products_with_a_matrix_of_two(void)
{
    make_stage(2, TRIPTYCH_TEXTURE_2D);
    make_rows();
    expect_texel("ps_1_1\ntex t0\ntexm3x2pad t1, t0\ntexm3x2tex t2, t0\nmov r0, t2\n", 0.5, 0.75, 0);
    /* 2a - 1 of the vector: 1, 0, -5 */
    expect_texel("ps_1_2\ntex t0\ntexm3x2pad t1, t0_bx2\ntexm3x2tex t2, t0_bx2\nmov r0, t2\n", 0.25, 1.25, 0);
    shade("ps_1_3\ntex t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmov r0, t0\n");
    for (int lane = 0; lane < QUAD_LANES; lane++)
        TEST_ASSERT_EQUAL_FLOAT(0.5f / 0.75f, result.depth[lane]);
    set_register(2, 0, 4, 1, 0);
    shade("ps_1_3\ntex t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmov r0, t0\n");
    for (int lane = 0; lane < QUAD_LANES; lane++)
        TEST_ASSERT_EQUAL_FLOAT(1, result.depth[lane]);
}

static void test_products_with_a_matrix_of_three(void)
{
    static const char *const text[] = {
        "ps_1_2\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3 t3, t0\nmov r0, t3\n",
        "ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3tex t3, t0\nmov r0, t3\n"};
    make_stage(3, TRIPTYCH_TEXTURE_VOLUME);
    make_rows();
    shade(text[0]);
    expect_all((const float[]){0.5f, 0.75f, 1, 1}, text[0]);
    expect_texel(text[1], 0.5, 0.75, 1);
    make_stage(3, TRIPTYCH_TEXTURE_CUBE);
    make_rows();
    expect_texel(text[1], 0.5, 0.75, 1);
}

/* The normal is 4, 4, 0: the vector to the eye is reflected to its y, x and -z. */
static void test_reflections(void)
{
    make_stage(3, TRIPTYCH_TEXTURE_CUBE);
    bind_value(0, 1, 0.5f, -2, 0.5f);
    set_register(1, 2, 4, 0, 0.375f);
    set_register(2, 0, 0, -2, 1);
    set_register(3, 2, -4, 0, -0.625f);
    expect_texel("ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3vspec t3, t0\nmov r0, t3\n", 1,
                 0.375, 0.625);
    expect_texel("ps_1_1\ndef c1, -0.25, 0.75, -1.0, 0.0\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\n"
                 "texm3x3spec t3, t0, c1\nmov r0, t3\n",
                 0.75, -0.25, 1);
    /* No normal: what is left is the opposite of the vector to the eye. */
    set_register(1, 0, 0, 0, 1);
    set_register(2, 0, 0, 0, 0.25f);
    set_register(3, 0, 0, 0, -0.5f);
    expect_texel("ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3vspec t3, t0\nmov r0, t3\n",
                 -1, -0.25, 0.5);
}

static void test_products_of_three(void)
{
    make_stage(1, TRIPTYCH_TEXTURE_2D);
    bind_value(0, 1, 0.5f, -2, 0.5f);
    set_register(1, 0.25f, 2, 0.5f, 9);
    shade("ps_1_2\ntex t0\ntexdp3 t1, t0\nmov r0, t1\n");
    expect_all((const float[]){0.25f, 0.25f, 0.25f, 0.25f}, "texdp3");
    expect_texel("ps_1_2\ntex t0\ntexdp3tex t1, t0\nmov r0, t1\n", 0.25, 0, 0);
    set_register(1, 100, 0, 0, 0);
    shade("ps_1_2\ntex t0\ntexdp3 t1, t0\nmov r0, t1\n");
    expect_all((const float[]){8, 8, 8, 8}, "texdp3, limited");
}

/* --- ps_1_4 -----------------------------------------------------------------------------------------------
 */

static void test_coordinates_are_taken_and_divided(void)
{
    memset(&quad, 0, sizeof quad);
    set_register(1, 0.5f, -3, 4, 2);
    shade("ps_1_4\ntexcrd r0.xyz, t1\nmov r0.w, c0\n");
    expect_all((const float[]){0.5f, -3, 4, 0}, "texcrd");
    shade("ps_1_4\ntexcrd r0.xyz, t1.xyw\nmov r0.w, c0\n");
    expect_all((const float[]){0.5f, -3, 2, 0}, "texcrd .xyw");
    shade("ps_1_4\ndef c0, 0, 0, 0, 0\nmov r0, c0\nphase\ntexcrd r0.xy, t1_dw.xyw\nmov r0.zw, c0\n");
    expect_all((const float[]){0.25f, -1.5f, 0, 0}, "texcrd _dw");
}

static void test_samples_of_ps_1_4(void)
{
    make_stage(3, TRIPTYCH_TEXTURE_2D);
    set_register(1, 0.5f, 0.25f, 4, 2);
    expect_texel("ps_1_4\ntexld r3, t1\nmov r0, r3\n", 0.5, 0.25, 0);
    expect_texel("ps_1_4\ntexld r3, t1_dw.xyw\nmov r0, r3\n", 0.25, 0.125, 0);
    expect_texel("ps_1_4\ntexcrd r1.xyz, t1\nphase\ntexld r3, r1\nmov r0, r3\n", 0.5, 0.25, 0);
    expect_texel("ps_1_4\ntexcrd r1.xyz, t1\nphase\ntexld r3, r1_dz\nmov r0, r3\n", 0.125, 0.0625, 0);
    set_register(1, 0, 0, 0, 0);
    expect_texel("ps_1_4\ntexld r3, t1_dw.xyw\nmov r0, r3\n", 0, 0, 0);
}

/* 2 and -1 displaced by 0.25 and 0.5, with the matrix of stage 2, which r2 names. */
static void test_bumps_of_ps_1_4(void)
{
    memset(&quad, 0, sizeof quad);
    set_matrix(2, 0.5f, 1, -4, 0.125f, 0, 0);
    set_register(0, 2, -1, 0, 0);
    set_register(1, 0.25f, 0.5f, 0, 0);
    shade("ps_1_4\ntexcrd r0.xyz, t0\ntexcrd r1.xyz, t1\nbem r2.xy, r0, r1\nphase\nmov r0.xy, r2\nmov r0.zw, "
          "c0\n");
    expect_all((const float[]){2 + 0.125f - 2, -1 + 0.25f + 0.0625f, 0, 0}, "bem");
}

static void test_depths_are_quotients(void)
{
    static const struct {
        float red, green, depth;
    } cases[] = {{0.25f, 0.5f, 0.5f}, {1, 4, 0.25f}, {3, 2, 1.5f},  {0, 0, 1},
                 {-1, 0, 1},          {1, -0.0f, 1}, {-1, 2, -0.5f}};
    memset(&quad, 0, sizeof quad);
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        set_register(1, cases[i].red, cases[i].green, 0, 0);
        shade("ps_1_4\ntexcrd r5.xyz, t1\nphase\ntexdepth r5\nmov r0, c0\n");
        for (int lane = 0; lane < QUAD_LANES; lane++)
            TEST_ASSERT_EQUAL_FLOAT(cases[i].depth, result.depth[lane]);
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
    RUN_TEST(test_coordinates_that_are_no_numbers);
    RUN_TEST(test_projection_by_zero_multiplies_by_the_largest_number);
    RUN_TEST(test_samplers_can_be_swizzled);
    RUN_TEST(test_depth_is_compared_with_the_third_coordinate);
    RUN_TEST(test_reads_can_depend_on_reads);
    RUN_TEST(test_vertices_have_samplers);
    RUN_TEST(test_differences_are_those_of_the_quad);
    RUN_TEST(test_differences_take_modifiers_and_masks);
    RUN_TEST(test_negative_components_kill);
    RUN_TEST(test_only_lanes_that_execute_are_killed);
    RUN_TEST(test_coordinates_as_colors);
    RUN_TEST(test_stages_divide_their_coordinates_where_they_are_projected);
    RUN_TEST(test_bumps_displace_by_the_matrix_of_the_stage);
    RUN_TEST(test_luminance_is_limited);
    RUN_TEST(test_colors_as_coordinates);
    RUN_TEST(test_products_with_a_matrix_of_two);
    RUN_TEST(test_products_with_a_matrix_of_three);
    RUN_TEST(test_reflections);
    RUN_TEST(test_products_of_three);
    RUN_TEST(test_coordinates_are_taken_and_divided);
    RUN_TEST(test_samples_of_ps_1_4);
    RUN_TEST(test_bumps_of_ps_1_4);
    RUN_TEST(test_depths_are_quotients);
    return UNITY_END();
}
