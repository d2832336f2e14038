/* Shaders whose results depend on quads of pixels, in whole draws on every engine: differences between
 * neighbours, killed pixels, levels in divergent flow, and depth. The texture instructions of ps_1_x are
 * compared with quads of the emulator, which shader_texture_stage.c tests. Targets are binary32, so that they
 * contain the shader's results. */
#include "base/bits.h"
#include "contract/key.h"
#include "tests/spec/shader/sampling.h"
#include "tests/support/picture/quad.h"

#include <math.h>
#include <string.h>

void setUp(void)
{
    drawn_begin();
}

void tearDown(void)
{
    close_canvas();
}

/* --- ps_1_x -------------------------------------------------------------------------------------------- */

static const char *const instructions[] = {
    "ps_1_1\ntex t1\nmov r0, t1\n",
    "ps_1_1\ntex t2\nmov r0, t2\n",
    "ps_1_1\ntex t3\nmov r0, t3\n",
    "ps_1_1\ntexcoord t1\nmov r0, t1\n",
    "ps_1_1\ntex t0\ntexbem t1, t0\nmov r0, t1\n",
    "ps_1_1\ntex t0\ntexbeml t1, t0\nmov r0, t1\n",
    "ps_1_1\ntex t0\ntexreg2ar t1, t0\nmov r0, t1\n",
    "ps_1_1\ntex t0\ntexreg2gb t1, t0\nmov r0, t1\n",
    "ps_1_2\ntex t0\ntexreg2rgb t2, t0\nmov r0, t2\n",
    "ps_1_1\ntex t0\ntexm3x2pad t1, t0\ntexm3x2tex t2, t0\nmov r0, t2\n",
    "ps_1_2\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3 t3, t0\nmov r0, t3\n",
    "ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3tex t3, t0\nmov r0, t3\n",
    "ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3spec t3, t0, c1\nmov r0, t3\n",
    "ps_1_1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3vspec t3, t0\nmov r0, t3\n",
    "ps_1_2\ntex t0\ntexdp3 t1, t0\nmov r0, t1\n",
    "ps_1_2\ntex t0\ntexdp3tex t2, t0\nmov r0, t2\n",
    "ps_1_4\ntexcrd r0.xyz, t1\nmov r0.w, c1\n",
    "ps_1_4\ntexld r1, t1_dw.xyw\nmov r0, r1\n",
    "ps_1_4\ntexcrd r1.xyz, t2\nphase\ntexld r3, r1_dz\nmov r0, r3\n",
    "ps_1_4\ntexcrd r0.xyz, t0\ntexcrd r1.xyz, t1\nbem r2.xy, r0, r1\nphase\nmov r0.xy, r2\nmov r0.zw, c1\n",
    "ps_2_x\ndcl t1\ndsx r0, t1\nmov oC0, r0\n",
};

static struct model_texture bump, plane, cube;

static void set_real(unsigned stage, enum triptych_stage_state state, double value)
{
    float narrow = (float)value;
    uint32_t bits = bits_of_float(narrow);
    OK(triptych_set_stage_state(device, stage, state, bits));
}

/* Binds 2D textures, volumes, and a cube in the last stage, and sets every state that the instructions
 * read. */
static void make_stages(void)
{
    static const struct model_sampler linear = {.mag = 1, .min = 1, .mip = MODEL_MIP_LINEAR};
    model_make(&bump, device, 0, TRIPTYCH_TEXTURE_2D, 1);
    model_make(&plane, device, 1, TRIPTYCH_TEXTURE_2D, 0);
    model_make(&texture, device, 2, TRIPTYCH_TEXTURE_VOLUME, 1);
    model_make(&cube, device, 3, TRIPTYCH_TEXTURE_CUBE, 0);
    for (unsigned stage = 0; stage < 4; stage++) {
        model_set(device, stage, &linear);
        for (int state = TRIPTYCH_STAGE_BUMPENVMAT00; state <= TRIPTYCH_STAGE_BUMPENVMAT11; state++)
            set_real(stage, (enum triptych_stage_state)state, random_between(-1, 1));
        set_real(stage, TRIPTYCH_STAGE_BUMPENVLSCALE, random_between(-1, 1));
        set_real(stage, TRIPTYCH_STAGE_BUMPENVLOFFSET, random_between(0, 1));
    }
}

static const char pass[] =
    "vs_1_1\ndcl_position v0\ndcl_texcoord0 v1\ndcl_texcoord1 v2\ndcl_texcoord2 v3\ndcl_texcoord3 v4\n"
    "mov oPos, v0\nmov oT0, v1\nmov oT1, v2\nmov oT2, v3\nmov oT3, v4\n";

/* Draws with the same coordinates at all pixels, so that interpolation is exact. */
static void draw_quad(const char *text, struct quad *quad)
{
    static const char *const flags[] = {"disable", "count3_projected", "count4_projected",
                                        "disable_projected"};
    struct drawn_element element[4];
    memset(quad, 0, sizeof *quad);
    for (unsigned t = 0; t < 4; t++) {
        float v[4];
        unsigned flag = random_word() % 4;
        for (int c = 0; c < 4; c++) {
            v[c] = (float)dyadic(-2, 2);
            for (int lane = 0; lane < QUAD_LANES; lane++)
                quad->v[t][c][lane] = v[c];
        }
        element[t] = drawn_constant(TRIPTYCH_USAGE_TEXCOORD, t, v[0], v[1], v[2], v[3]);
        set_stage(t, TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS, flags[flag]);
        quad->projected[t] = flag ? PROJECTED_FOURTH : PROJECTED_NONE;
    }
    for (int c = 0; c < 4; c++)
        quad->constant[1][c] = (float)dyadic(-1, 1);
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 1, quad->constant[1], 1));
    use_shaders(pass, text);
    draw_declared(TRIPTYCH_USAGE_POSITION, element, 4);
    read_numbers(0);
}

static void check_instructions(void)
{
    static struct quad quad;
    begin_part();
    make_stages();
    for (unsigned i = 0; i < sizeof instructions / sizeof *instructions; i++)
        for (int times = 0; times < 3; times++) {
            struct quad_result result;
            draw_quad(instructions[i], &quad);
            quad_shade(device, instructions[i], &quad, &result);
            for (int lane = 0; lane < QUAD_LANES; lane++) {
                float expected[4];
                for (int c = 0; c < 4; c++)
                    expected[c] = result.color[c][lane];
                expect_numbers(PART / 2 + lane % 2, PART / 2 + lane / 2, expected, instructions[i]);
            }
        }
}

static void test_instructions_of_ps_1_x(void)
{
    on_every_engine(check_instructions);
}

/* --- Neighbours, killed pixels, depth ------------------------------------------------------------------ */

/* Checks the differences of x * x and y * x in the quads of the target. */
static void check_differences(void)
{
    begin_part();
    use_shaders(NULL,
                "ps_3_0\ndcl vPos.xy\nmul r1.x, vPos.x, vPos.x\nmul r1.y, vPos.x, vPos.y\nmov r1.zw, vPos.x\n"
                "dsx r0.xz, r1.xyyw\ndsy r0.yw, r1.yyyx\nmov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    for (int y = 0; y < PART; y++)
        for (int x = 0; x < PART; x++) {
            int left = x & ~1;
            const float expected[4] = {(float)(2 * left + 1), (float)x, (float)y, 0};
            expect_numbers(x, y, expected, "differences");
        }
}

static void test_differences(void)
{
    on_every_engine(check_differences);
}

static void check_killed(void)
{
    begin_part();
    OK(triptych_clear(device, (const float[4]){0}, 1));
    use_shaders(NULL, "ps_3_0\ndcl vPos.xy\ndef c0, 1, 7, 5, 0.5\nmov r0, c0\nsub r0.xyz, r0.y, vPos.x\n"
                      "sub r1.x, c0.z, vPos.y\nif_gt r1.x, -c0.w\ntexkill r0\nendif\nmov oC0, c0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    for (int y = 0; y < PART; y++)
        for (int x = 0; x < PART; x++) {
            static const float kept[4] = {1, 7, 5, 0.5f}, nothing[4] = {0};
            expect_numbers(x, y, y <= 5 && x > 7 ? nothing : kept, "texkill");
        }
}

static void test_killed_pixels_stay(void)
{
    on_every_engine(check_killed);
}

/* Each row of pixels has its own level. Half of its pixels do not execute the lookup. */
static void check_divergent(void)
{
    static const struct model_sampler sampler = {.mip = MODEL_MIP_POINT};
    static const char text[] =
        "ps_3_0\ndcl vPos.xy\ndcl_2d s4\ndef c0, 7.5, 0.25, 0.0625, 3\nmul r0, vPos.xyyy, c0.z\n"
        "mul r0.w, vPos.y, c0.y\nmov r1, c0\nif_lt vPos.x, c0.x\ntexldl r1, r0, s4\nendif\n"
        "mov oC0, r1\n";
    begin_part();
    model_make(&texture, device, 4, TRIPTYCH_TEXTURE_2D, 1);
    model_set(device, 4, &sampler);
    use_shaders(NULL, text);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    for (int y = 0; y < PART; y++)
        for (int x = 0; x < PART; x++) {
            float expected[4] = {7.5f, 0.25f, 0.0625f, 3};
            const double v[3] = {x / 16.0, y / 16.0, 0};
            if (x < 8)
                model_sample(&texture, &sampler, v, 64 * y, expected);
            expect_numbers(x, y, expected, "levels in divergent flow");
        }
}

static void test_levels_in_divergent_flow(void)
{
    on_every_engine(check_divergent);
}

/* The depth that ps_1_x writes is clamped and stored. */
static void check_depth(void)
{
    static const char *const text[] = {
        "ps_1_4\ntexcrd r5.xyz, t3\nphase\ntexdepth r5\nmov r0, c0\n",
        "ps_1_3\ntexcoord t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmov r0, t0\n"};
    static const float depth[][3] = {{0.25f, 0.5f, 0.5f}, {1, 0, 1}, {3, 2, 1}, {-1, 2, 0}};
    begin_part();
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ZFUNC, "always");
    for (unsigned i = 0; i < 8; i++) {
        static float got[SIZE * SIZE];
        const float *d = depth[i / 2];
        const struct drawn_element element[] = {drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, 1, 0, 0, 1),
                                                drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 1, d[0], 0, 0, 1),
                                                drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 2, d[1], 0, 0, 1),
                                                drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 3, d[0], d[1], 0, 1)};
        use_shaders(pass, text[i % 2]);
        draw_declared(TRIPTYCH_USAGE_POSITION, element, 4);
        OK(triptych_read_depth(device, got, sizeof got));
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(d[2], got[PART / 2 * SIZE + PART / 2], text[i % 2]);
    }
}

static void test_depth_of_shaders(void)
{
    on_every_engine(check_depth);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_instructions_of_ps_1_x);
    RUN_TEST(test_differences);
    RUN_TEST(test_killed_pixels_stay);
    RUN_TEST(test_levels_in_divergent_flow);
    RUN_TEST(test_depth_of_shaders);
    return UNITY_END();
}
