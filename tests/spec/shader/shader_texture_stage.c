/* The results of texture instructions that are not lookups (docs/shader-semantics.md), compared with values
 * that are computed here: differences of neighbours, discarded pixels, and the instructions of ps_1_1 to
 * ps_1_4. The emulator's binding executes them for one quad of registers at a time. */
#include "contract/key.h"
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/quad.h"
#include "tests/support/picture/texture_model.h"

#include <float.h>
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

/* --- Neighbours and discarded pixels ------------------------------------------------------------------- */

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
            quad_expect(&result, lane, expected, down ? "dsy" : "dsx");
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
    quad_expect(&result, 0, expected[0], "dsx, dsy");
    quad_expect(&result, 1, expected[1], "dsx, dsy");
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
                quad_set(&quad, 0, 0.5f, 0.5f, 0.5f, 0.5f);
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
    quad_set(&quad, 0, -1, -1, -1, -1);
    quad.v[1][0][1] = quad.v[1][0][2] = 1;
    shade("ps_3_0\ndcl_texcoord0 v0\ndcl_texcoord1 v1\nmov r0, v0\nmov r1, v1\nif_gt r1.x, -r1.x\ntexkill "
          "r0\nendif\n"
          "mov oC0, r0\n");
    for (int lane = 0; lane < QUAD_LANES; lane++)
        TEST_ASSERT_EQUAL_INT(lane == 1 || lane == 2, result.killed[lane] != 0);
}

/* --- ps_1_1 to ps_1_3 ---------------------------------------------------------------------------------- */

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
    quad_expect_all(&result, expected, text);
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
        quad_set(&quad, 1, -0.5f, 0.25f, 7, 0.5f);
        shade(texts[i]);
        quad_expect_all(&result, (const float[]){0, 0.25f, 1, 1}, texts[i]);
        quad_set(&quad, 1, NAN, INFINITY, -INFINITY, -1);
        shade(texts[i]);
        quad_expect_all(&result, (const float[]){0, 1, 0, 1}, texts[i]);
    }
}

static void test_stages_divide_their_coordinates_where_they_are_projected(void)
{
    static const char text[] = "ps_1_2\ntex t2\nmov r0, t2\n";
    make_stage(2, TRIPTYCH_TEXTURE_2D);
    quad_set(&quad, 2, 0.75f, 0.5f, 2, 4);
    expect_texel(text, 0.75, 0.5, 0);
    quad.projected[2] = PROJECTED_THIRD;
    expect_texel(text, 0.375, 0.25, 0);
    quad.projected[2] = PROJECTED_FOURTH;
    expect_texel(text, 0.1875, 0.125, 0);
    quad_set(&quad, 2, 0, 0, 0, 0);
    expect_texel(text, 0, 0, 0);
}

static void set_matrix(unsigned stage, float m00, float m01, float m10, float m11, float scale, float offset)
{
    static const enum triptych_stage_state state[] = {
        TRIPTYCH_STAGE_BUMPENVMAT00, TRIPTYCH_STAGE_BUMPENVMAT01,  TRIPTYCH_STAGE_BUMPENVMAT10,
        TRIPTYCH_STAGE_BUMPENVMAT11, TRIPTYCH_STAGE_BUMPENVLSCALE, TRIPTYCH_STAGE_BUMPENVLOFFSET};
    const float value[] = {m00, m01, m10, m11, scale, offset};
    for (int i = 0; i < 6; i++) {
        uint32_t bits;
        memcpy(&bits, &value[i], sizeof bits);
        OK(triptych_set_stage_state(device, stage, state[i], bits));
    }
}

/* u + 0.5 * 0.25 - 0.25 * 0.5 = u, v + 1 * 0.25 + 0.125 * 0.5. The matrix is of the stage that is displaced.
 */
static void test_bumps_displace_by_the_matrix_of_the_stage(void)
{
    make_stage(1, TRIPTYCH_TEXTURE_2D);
    bind_value(0, 0.25f, 0.5f, 0.75f, 0);
    set_matrix(0, 9, 9, 9, 9, 9, 9);
    set_matrix(1, 0.5f, 1, -0.5f, 0.125f, 0.5f, 0.25f);
    quad_set(&quad, 1, 0.375f, 0.5f, 0, 1);
    double u = 0.375 + 0.5 * 0.25 - 0.5 * 0.5, v = 0.5 + 1 * 0.25 + 0.125 * 0.5;
    expect_texel("ps_1_1\ntex t0\ntexbem t1, t0\nmov r0, t1\n", u, v, 0);
    float expected[4];
    model_sample(&texture, &plain, (const double[]){u, v, 0}, 0, expected);
    for (int c = 0; c < 4; c++)
        expected[c] *= 0.75f * 0.5f + 0.25f;
    shade("ps_1_1\ntex t0\ntexbeml t1, t0\nmov r0, t1\n");
    quad_expect_all(&result, expected, "texbeml");
    quad.projected[1] = PROJECTED_FOURTH;
    quad_set(&quad, 1, 0.75f, 1, 0, 2);
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
    quad_expect_all(&result, expected, "luminance above 1");
    bind_value(0, 0, 0, -3, 0);
    shade("ps_1_1\ntex t0\ntexbeml t1, t0\nmov r0, t1\n");
    quad_expect_all(&result, (const float[4]){0}, "luminance below 0");
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
    quad_set(&quad, 1, 0.25f, 0.5f, 0, -0.5f);
    quad_set(&quad, 2, 0, 0.5f, -0.25f, 1);
    quad_set(&quad, 3, 2, 2, 1, 0.25f);
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
    quad_set(&quad, 2, 0, 4, 1, 0);
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
    quad_expect_all(&result, (const float[]){0.5f, 0.75f, 1, 1}, text[0]);
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
    quad_set(&quad, 1, 2, 4, 0, 0.375f);
    quad_set(&quad, 2, 0, 0, -2, 1);
    quad_set(&quad, 3, 2, -4, 0, -0.625f);
    expect_texel("ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3vspec t3, t0\nmov r0, t3\n", 1,
                 0.375, 0.625);
    expect_texel("ps_1_1\ndef c1, -0.25, 0.75, -1.0, 0.0\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\n"
                 "texm3x3spec t3, t0, c1\nmov r0, t3\n",
                 0.75, -0.25, 1);
    /* Without a normal, the result is the negative of the vector to the eye. */
    quad_set(&quad, 1, 0, 0, 0, 1);
    quad_set(&quad, 2, 0, 0, 0, 0.25f);
    quad_set(&quad, 3, 0, 0, 0, -0.5f);
    expect_texel("ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3vspec t3, t0\nmov r0, t3\n",
                 -1, -0.25, 0.5);
}

static void test_products_of_three(void)
{
    make_stage(1, TRIPTYCH_TEXTURE_2D);
    bind_value(0, 1, 0.5f, -2, 0.5f);
    quad_set(&quad, 1, 0.25f, 2, 0.5f, 9);
    shade("ps_1_2\ntex t0\ntexdp3 t1, t0\nmov r0, t1\n");
    quad_expect_all(&result, (const float[]){0.25f, 0.25f, 0.25f, 0.25f}, "texdp3");
    expect_texel("ps_1_2\ntex t0\ntexdp3tex t1, t0\nmov r0, t1\n", 0.25, 0, 0);
    quad_set(&quad, 1, 100, 0, 0, 0);
    shade("ps_1_2\ntex t0\ntexdp3 t1, t0\nmov r0, t1\n");
    quad_expect_all(&result, (const float[]){8, 8, 8, 8}, "texdp3, limited");
}

/* --- ps_1_4 -------------------------------------------------------------------------------------------- */

static void test_coordinates_are_taken_and_divided(void)
{
    memset(&quad, 0, sizeof quad);
    quad_set(&quad, 1, 0.5f, -3, 4, 2);
    shade("ps_1_4\ntexcrd r0.xyz, t1\nmov r0.w, c0\n");
    quad_expect_all(&result, (const float[]){0.5f, -3, 4, 0}, "texcrd");
    shade("ps_1_4\ntexcrd r0.xyz, t1.xyw\nmov r0.w, c0\n");
    quad_expect_all(&result, (const float[]){0.5f, -3, 2, 0}, "texcrd .xyw");
    shade("ps_1_4\ndef c0, 0, 0, 0, 0\nmov r0, c0\nphase\ntexcrd r0.xy, t1_dw.xyw\nmov r0.zw, c0\n");
    quad_expect_all(&result, (const float[]){0.25f, -1.5f, 0, 0}, "texcrd _dw");
}

static void test_samples_of_ps_1_4(void)
{
    make_stage(3, TRIPTYCH_TEXTURE_2D);
    quad_set(&quad, 1, 0.5f, 0.25f, 4, 2);
    expect_texel("ps_1_4\ntexld r3, t1\nmov r0, r3\n", 0.5, 0.25, 0);
    expect_texel("ps_1_4\ntexld r3, t1_dw.xyw\nmov r0, r3\n", 0.25, 0.125, 0);
    expect_texel("ps_1_4\ntexcrd r1.xyz, t1\nphase\ntexld r3, r1\nmov r0, r3\n", 0.5, 0.25, 0);
    expect_texel("ps_1_4\ntexcrd r1.xyz, t1\nphase\ntexld r3, r1_dz\nmov r0, r3\n", 0.125, 0.0625, 0);
    quad_set(&quad, 1, 0, 0, 0, 0);
    expect_texel("ps_1_4\ntexld r3, t1_dw.xyw\nmov r0, r3\n", 0, 0, 0);
}

/* 2 and -1 displaced by 0.25 and 0.5, with the matrix of stage 2, which r2 names. */
static void test_bumps_of_ps_1_4(void)
{
    memset(&quad, 0, sizeof quad);
    set_matrix(2, 0.5f, 1, -4, 0.125f, 0, 0);
    quad_set(&quad, 0, 2, -1, 0, 0);
    quad_set(&quad, 1, 0.25f, 0.5f, 0, 0);
    shade("ps_1_4\ntexcrd r0.xyz, t0\ntexcrd r1.xyz, t1\nbem r2.xy, r0, r1\nphase\nmov r0.xy, r2\nmov r0.zw, "
          "c0\n");
    quad_expect_all(&result, (const float[]){2 + 0.125f - 2, -1 + 0.25f + 0.0625f, 0, 0}, "bem");
}

static void test_depths_are_quotients(void)
{
    static const struct {
        float red, green, depth;
    } cases[] = {{0.25f, 0.5f, 0.5f}, {1, 4, 0.25f}, {3, 2, 1.5f},  {0, 0, 1},
                 {-1, 0, 1},          {1, -0.0f, 1}, {-1, 2, -0.5f}};
    memset(&quad, 0, sizeof quad);
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        quad_set(&quad, 1, cases[i].red, cases[i].green, 0, 0);
        shade("ps_1_4\ntexcrd r5.xyz, t1\nphase\ntexdepth r5\nmov r0, c0\n");
        for (int lane = 0; lane < QUAD_LANES; lane++)
            TEST_ASSERT_EQUAL_FLOAT(cases[i].depth, result.depth[lane]);
    }
}

int main(void)
{
    UNITY_BEGIN();
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
