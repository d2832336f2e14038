/* Discarded pixels and the depth that pixel shaders write, on every engine: the contents of colour, depth and
 * stencil, with every depth format. */
#include "tests/support/picture/drawn.h"

#include <math.h>

void setUp(void)
{
    drawn_begin();
}

void tearDown(void)
{
    close_canvas();
}

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const char plain[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\n";

static float depth[SIZE * SIZE];
static uint8_t stencil[SIZE * SIZE];

static void draw(void)
{
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
}

/* --- Discarded pixels ---------------------------------------------------------------------------------- */

/* The element by which shaders discard the left half: its x goes from -1 to 1. */
static const struct drawn_element sides = {
    TRIPTYCH_USAGE_TEXCOORD, 0, {{-1, 1, 1, 1}, {1, 1, 1, 1}, {-1, 1, 1, 1}, {1, 1, 1, 1}}};
static const char with_sides[] = "vs_2_0\ndcl_position v0\ndcl_texcoord v1\nmov oPos, v0\nmov oT0, v1\n";
static const char kills_1_1[] = "ps_1_1\ndef c0, 1, 0, 0, 1\ntexkill t0\nmov r0, c0\n";
static const char kills_1_4[] =
    "ps_1_4\ndef c0, 1, 0, 0, 1\ntexcrd r1.xyz, t0\nphase\ntexkill r1\nmov r0, c0\n";
static const char kills_2_0[] = "ps_2_0\ndef c0, 1, 0, 0, 1\ndcl t0\ntexkill t0\nmov oC0, c0\n";
static const char kills_3_0[] = "ps_3_0\ndef c0, 1, 0, 0, 1\ndcl_texcoord v0\nmov r0, v0\nif_lt v0.x, c0.y\n"
                                "texkill r0\nendif\nmov oC0, c0\n";
static const char *const killers[] = {kills_1_1, kills_1_4, kills_2_0, kills_3_0};

static void use_tests(unsigned samples)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .depth_format = TRIPTYCH_DEPTH_D24S8, .samples = samples};
    static const struct {
        enum triptych_state state;
        const char *word;
    } states[] = {{TRIPTYCH_STATE_ZENABLE, "true"},
                  {TRIPTYCH_STATE_STENCILENABLE, "true"},
                  {TRIPTYCH_STATE_STENCILPASS, "incr"},
                  {TRIPTYCH_STATE_STENCILZFAIL, "invert"}};
    OK(triptych_set_target_description(device, &description));
    for (unsigned i = 0; i < COUNT(states); i++)
        set(states[i].state, states[i].word);
}

static void clear_all(float to)
{
    float black[4] = {0};
    OK(triptych_clear_buffers(device, TRIPTYCH_CLEAR_COLOR | TRIPTYCH_CLEAR_DEPTH | TRIPTYCH_CLEAR_STENCIL,
                              black, to, 7));
}

static void expect_halves(const char *what)
{
    OK(triptych_read_color(device, image, sizeof image));
    OK(triptych_read_depth(device, depth, sizeof depth));
    OK(triptych_read_stencil(device, stencil, sizeof stencil));
    for (int p = 0; p < SIZE * SIZE; p++) {
        int kept = p % SIZE >= SIZE / 2;
        expect_pixel(p % SIZE, p / SIZE, kept ? 0xff0000ff : 0, what);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(kept ? 8 : 7, stencil[p], what);
        TEST_ASSERT_FLOAT_WITHIN_MESSAGE(1e-6f, kept ? 0.5f : 1, depth[p], what);
    }
}

static void check_kill(void)
{
    triptych_query *query;
    uint64_t passed;
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    for (unsigned samples = 1; samples <= 4; samples *= 4) {
        use_tests(samples);
        for (unsigned i = 0; i < COUNT(killers); i++) {
            use_shaders(with_sides, killers[i]);
            clear_all(1);
            OK(triptych_query_begin(device, query));
            draw_declared(TRIPTYCH_USAGE_POSITION, &sides, 1);
            OK(triptych_query_end(device, query));
            expect_halves(killers[i]);
            OK(triptych_query_result(device, query, &passed));
            TEST_ASSERT_EQUAL_UINT64(SIZE * SIZE / 2 * samples, passed);
            clear_all(0.25f);
            draw_declared(TRIPTYCH_USAGE_POSITION, &sides, 1);
            OK(triptych_read_stencil(device, stencil, sizeof stencil));
            TEST_ASSERT_EQUAL_UINT8(7, stencil[0]);
            TEST_ASSERT_EQUAL_UINT8(248, stencil[SIZE - 1]);
        }
    }
}

static void test_discarded_pixels_write_nothing(void)
{
    on_every_engine(check_kill);
}

/* Only depth is written, and pixels are discarded too. */
static void check_only_kill(void)
{
    set(TRIPTYCH_STATE_ZENABLE, "true");
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 0));
    use_shaders(with_sides, kills_2_0);
    clear_to(0);
    draw_declared(TRIPTYCH_USAGE_POSITION, &sides, 1);
    OK(triptych_read_depth(device, depth, sizeof depth));
    TEST_ASSERT_EQUAL_FLOAT(1, depth[5]);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, depth[SIZE - 5]);
    OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 15));
    set(TRIPTYCH_STATE_ZENABLE, "false");
    set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
    set(TRIPTYCH_STATE_ALPHAFUNC, "less");
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, 128));
    use_shaders(with_sides, "ps_2_0\ndcl t0\ndef c0, 0.5, 0.25, 1, 0\ntexkill t0\nmov r0, t0\nmov r1, c0.z\n"
                            "mad r1.w, r0.x, c0.x, c0.y\nmov oC0, r1\n");
    clear_to(0);
    draw_declared(TRIPTYCH_USAGE_POSITION, &sides, 1);
    OK(triptych_read_color(device, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32(0, image[SIZE / 2 - 1]);               /* discarded */
    TEST_ASSERT_EQUAL_HEX32(0xffffff, image[SIZE / 2] & 0xffffff); /* alpha 0.25 */
    TEST_ASSERT_EQUAL_HEX32(0xffffff, image[SIZE / 2 + 15] & 0xffffff);
    TEST_ASSERT_EQUAL_HEX32(0, image[SIZE / 2 + 17]); /* alpha 0.5 and more */
}

static void test_discarding_works_without_colour_and_with_the_alpha_test(void)
{
    on_every_engine(check_only_kill);
}

/* --- Depth --------------------------------------------------------------------------------------------- */

/* Depth goes from 0 to 1 over the target, exceeds this range at the ends, and is compared with 0.5. */
static const struct drawn_element slope = {
    TRIPTYCH_USAGE_TEXCOORD, 0, {{-0.5f, 1, 1, 1}, {1.5f, 1, 1, 1}, {-0.5f, 1, 1, 1}, {1.5f, 1, 1, 1}}};
static const char *const deep[] = {
    "ps_2_0\ndef c0, 1, 0, 0, 1\ndcl t0\nmov r0, t0\nmov oDepth, r0.x\nmov oC0, c0\n",
    "ps_3_0\ndef c0, 1, 0, 0, 1\ndcl_texcoord v0\nmov oDepth, v0.x\nmov oC0, c0\n"};

static float shaded_depth(int x)
{
    return fminf(fmaxf(-0.5f + 2 * ((float)x + 0.5f) / SIZE, 0), 1);
}

static void expect_depths(unsigned samples, const char *what)
{
    static float each[SIZE * SIZE];
    static uint8_t passed[SIZE * SIZE];
    OK(triptych_read_color(device, image, sizeof image));
    for (unsigned s = 0; s < samples; s++) {
        if (samples > 1)
            OK(triptych_read_sample(device, s, image, sizeof image, each, sizeof each, passed,
                                    sizeof passed));
        else {
            OK(triptych_read_depth(device, each, sizeof each));
            OK(triptych_read_stencil(device, passed, sizeof passed));
        }
        for (int p = 0; p < SIZE * SIZE; p++) {
            float expected = shaded_depth(p % SIZE);
            int kept = expected < 0.5f;
            TEST_ASSERT_FLOAT_WITHIN_MESSAGE(1e-6f, kept ? expected : 0.5f, each[p], what);
            TEST_ASSERT_EQUAL_UINT8_MESSAGE(kept ? 8 : 248, passed[p], what);
            expect_pixel(p % SIZE, p / SIZE, kept ? 0xff0000ff : 0, what);
        }
    }
}

static void check_depth(void)
{
    triptych_query *query;
    uint64_t passed;
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    set(TRIPTYCH_STATE_ZFUNC, "less");
    OK(triptych_set_state(device, TRIPTYCH_STATE_DEPTHBIAS, triptych_float_bits(0.25f))); /* of no account */
    for (unsigned samples = 1; samples <= 4; samples *= 4) {
        use_tests(samples);
        for (unsigned i = 0; i < COUNT(deep); i++) {
            use_shaders(with_sides, deep[i]);
            clear_all(0.5f);
            OK(triptych_query_begin(device, query));
            draw_declared(TRIPTYCH_USAGE_POSITION, &slope, 1);
            OK(triptych_query_end(device, query));
            expect_depths(samples, deep[i]);
            OK(triptych_query_result(device, query, &passed));
            TEST_ASSERT_EQUAL_UINT64(SIZE * SIZE / 2 * samples, passed);
        }
    }
}

static void test_depth_that_a_shader_writes_is_tested_and_stored(void)
{
    on_every_engine(check_depth);
}

/* Targets with depth formats without stencil, and a depth of NaN. */
static void check_only_depth(void)
{
    static const enum triptych_depth_format formats[] = {TRIPTYCH_DEPTH_D16, TRIPTYCH_DEPTH_D32F_LOCKABLE,
                                                         TRIPTYCH_DEPTH_D24FS8, TRIPTYCH_DEPTH_D32};
    set(TRIPTYCH_STATE_ZENABLE, "true");
    for (unsigned f = 0; f < COUNT(formats); f++) {
        struct triptych_target_description description = {
            .width = SIZE, .height = SIZE, .depth_format = formats[f]};
        OK(triptych_set_target_description(device, &description));
        use_shaders(with_sides, deep[0]);
        clear_to(0);
        draw_declared(TRIPTYCH_USAGE_POSITION, &slope, 1);
        OK(triptych_read_depth(device, depth, sizeof depth));
        for (int p = 0; p < SIZE; p++)
            TEST_ASSERT_FLOAT_WITHIN(1e-4f, shaded_depth(p), depth[p]);
    }
    use_shaders(plain, "ps_2_0\ndef c0, 0, -1, 0, 1\nrsq r0.x, c0.x\nadd r0.x, r0.x, r0.x\nmul r0.x, r0.x, "
                       "c0.x\nmov oDepth, r0.x\nmov oC0, c0\n");
    clear_to(0);
    draw(); /* infinity times 0 */
    OK(triptych_read_depth(device, depth, sizeof depth));
    TEST_ASSERT_EQUAL_FLOAT(0, depth[0]);
}

static void test_shaded_depth_has_every_format(void)
{
    on_every_engine(check_only_depth);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_discarded_pixels_write_nothing);
    RUN_TEST(test_discarding_works_without_colour_and_with_the_alpha_test);
    RUN_TEST(test_depth_that_a_shader_writes_is_tested_and_stored);
    RUN_TEST(test_shaded_depth_has_every_format);
    return UNITY_END();
}
